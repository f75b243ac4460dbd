//! The recording beside the motion before anything is fitted: the coarse delay, and the mounting where nothing is known of it.

use crate::chain::{ChainCorrections, SensorMount};
use crate::estimate::begin::start;
use crate::estimate::problem::parameters::place;
use crate::estimate::problem::unsolved::refused;
use crate::estimate::{MachineParameters, MachineProblem};
use crate::reference::{Carrier, Motion};
use calibrant_core::error::Result;
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Correlation of the magnitudes of rate (or force) below which recording and log are of different motions.
const SAME_MOTION: f64 = 0.5;
/// A gyroscope that reads more than this many times the rate of the motion, or less than the inverse, has another unit: degrees are 57 times radians.
const OTHER_UNIT: f64 = 5.0;
/// The delay is searched this many standard deviations about what is expected.
const SEARCHED: f64 = 4.0;

/// The sensor that tells time and direction best, in the units of what it measures, and the motion of the tip.
pub(crate) struct Placement<'a> {
    problem: &'a MachineProblem<'a>,
    motion: &'a Motion,
    covered: &'a [bool],
    carrier: Carrier,
    /// The gyroscope where there is one.
    sensor: SensorKind,
}

impl<'a> Placement<'a> {
    pub(crate) fn new(
        problem: &'a MachineProblem<'a>,
        motion: &'a Motion,
        covered: &'a [bool],
        gravity: Vector3<f64>,
    ) -> Self {
        let bare = SensorMount { lever_m: problem.setup.lever_m, ..SensorMount::identity() };
        let carrier = motion.carrier(gravity, bare, &ChainCorrections::none(motion.joints()));
        let found = |kind: &SensorKind| problem.recording.sensor(*kind).is_some();
        let sensor = SensorKind::ALL.into_iter().rev().find(found).unwrap_or(SensorKind::Gyroscope);
        Self { problem, motion, covered, carrier, sensor }
    }

    /// The recording in the units of what the sensor measures.
    fn recording(&self) -> Option<Recording> {
        let recording = self.problem.recording.sensor(self.sensor)?;
        let nominal = self.problem.nominal.sensor(self.sensor);
        let inverse = nominal.matrix.try_inverse().unwrap_or_else(Matrix3::identity);
        Some(recording.mapped(recording.unit(), |y| inverse * (y - nominal.bias)))
    }

    /// What a sensor in the axes of the tip would feel; `None` where the log says nothing.
    fn at(&self, time_s: f64) -> Option<Vector3<f64>> {
        let knots = self.motion.knots();
        if time_s < knots.start_s || time_s > knots.end_s() || !self.covered[knots.interval(time_s)] {
            return None;
        }
        let felt = self.motion.sensor(&knots.weights(time_s), &self.carrier, &mut Default::default());
        Some(match self.sensor {
            SensorKind::Accelerometer => felt.specific_force,
            SensorKind::Gyroscope => felt.rate,
        })
    }

    /// The delay by correlation, s.
    pub(crate) fn delay_s(&self) -> Result<f64> {
        let setup = self.problem.setup;
        let (Some(recording), true) = (self.recording(), setup.delay_sd_s > 0.0) else {
            return Ok(setup.delay_s);
        };
        let range_s = SEARCHED * setup.delay_sd_s;
        let found = start::delay(&recording, &|time_s| self.at(time_s), setup.delay_s, range_s);
        let Some((delay_s, correlation)) = found else {
            let ends = |times: &[f64]| format!("{:.3} to {:.3} s", times[0], times[times.len() - 1]);
            let message = format!(
                "the recording ({}) and the log ({}) hardly overlap",
                ends(recording.times_s()),
                ends(self.problem.log.times_s())
            );
            return Err(refused(
                message,
                "give clock.delay_s, the log's time less the recording's, in [machine]",
            ));
        };
        if correlation < SAME_MOTION {
            let message = format!(
                "the {} and the log are of different motions: the best correlation within {range_s:.2} s is {correlation:.2}",
                self.sensor
            );
            let help = "check that the files belong together, the order of the joints, the units, and clock.delay_s and delay_sd_s in [machine]";
            return Err(refused(message, help));
        }
        let ratio = self.rate_ratio(&recording, delay_s);
        if !(1.0 / OTHER_UNIT..OTHER_UNIT).contains(&ratio) {
            let message = format!("the gyroscope reads {ratio:.3} times the rate of the log's motion");
            return Err(refused(
                message,
                "check the units of both: degrees or radians, and the gain of counts",
            ));
        }
        Ok(delay_s)
    }

    /// Root mean square of the gyroscope's readings over that of the motion's rate; 1 for an accelerometer, which feels gravity above all.
    fn rate_ratio(&self, recording: &Recording, delay_s: f64) -> f64 {
        let samples = recording.times_s().iter().zip(recording.readings());
        let squares = samples.filter_map(|(time_s, reading)| {
            Some((reading.norm_squared(), self.at(time_s + delay_s)?.norm_squared()))
        });
        let (read, moved) = squares.fold((0.0, 0.0), |(a, b), (one, other)| (a + one, b + other));
        match self.sensor {
            SensorKind::Gyroscope if moved > 0.0 => (read / moved).sqrt(),
            _ => 1.0,
        }
    }

    /// The mounting that aligns the readings with the motion, with these delays.
    pub(crate) fn mounting(&self, parameters: &MachineParameters) -> UnitQuaternion<f64> {
        let delay_s = parameters.delays_s[place(self.sensor)];
        let recording = self.recording();
        let samples = recording.iter().flat_map(|of| of.times_s().iter().zip(of.readings()));
        let pairs: Vec<(Vector3<f64>, Vector3<f64>)> =
            samples.filter_map(|(time, reading)| Some((*reading, self.at(time + delay_s)?))).collect();
        start::rotation(&pairs).unwrap_or(parameters.mount.tip_from_sensor)
    }
}

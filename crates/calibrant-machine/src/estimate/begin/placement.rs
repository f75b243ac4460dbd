//! The recording beside the motion before anything is fitted: the coarse delay, and the mounting where nothing is known of it.

use crate::chain::{ChainCorrections, SensorMount};
use crate::estimate::problem::refused;
use crate::estimate::{MachineParameters, MachineProblem, MountingPrior};
use crate::reference::{Carrier, Motion};
use calibrant_core::error::Result;
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Correlation of the rates' magnitudes, or of the forces, below which recording and log are of different motions.
const SAME_MOTION: f64 = 0.5;
/// A gyroscope that reads more than this many times the rate of the motion, or less than the inverse, has another unit: degrees are 57 times radians.
const OTHER_UNIT: f64 = 5.0;
/// The delay is searched this many standard deviations about what is expected.
const SEARCHED: f64 = 4.0;
/// In a periodic motion, other delays correlate almost as well as the best. They are tried from this part of its correlation on,
const ALMOST: f64 = 0.8;
/// and at most this many delays in all.
const DELAYS: usize = 4;

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

    /// The delays by correlation, s: the best one, and others that are almost as good.
    pub(crate) fn delays_s(&self) -> Result<Vec<f64>> {
        let setup = self.problem.setup;
        let (Some(recording), true) = (self.recording(), setup.delay_sd_s > 0.0) else {
            return Ok(vec![setup.delay_s]);
        };
        let range_s = SEARCHED * setup.delay_sd_s;
        let at = |time_s| self.at(time_s);
        // a force that nothing turns hardly changes its magnitude; rates are compared by theirs, so that a mounting that was given wrongly is found out
        let is_force = self.sensor == SensorKind::Accelerometer && setup.mounting != MountingPrior::Unknown;
        let turned = |v: &Vector3<f64>| setup.tip_from_sensor * v;
        let found = match is_force {
            true => delays((&recording, &turned), (&at, &|v| *v), setup.delay_s, range_s),
            false => delays((&recording, &magnitude), (&at, &magnitude), setup.delay_s, range_s),
        };
        let Some(&(delay_s, correlation)) = found.first() else {
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
        let almost = found.iter().filter(|(_, other)| *other >= ALMOST * correlation);
        Ok(almost.take(DELAYS).map(|(delay_s, _)| *delay_s).collect())
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
        let delay_s = parameters.delays_s[self.sensor];
        let recording = self.recording();
        let samples = recording.iter().flat_map(|of| of.times_s().iter().zip(of.readings()));
        let pairs: Vec<(Vector3<f64>, Vector3<f64>)> =
            samples.filter_map(|(time, reading)| Some((*reading, self.at(time + delay_s)?))).collect();
        rotation(&pairs).unwrap_or(parameters.mount.tip_from_sensor)
    }
}

/// Time between the values that are correlated, s.
const STEP_S: f64 = 0.01;

/// What a reference says at a time; `None` where it says nothing.
pub(crate) trait At: Fn(f64) -> Option<Vector3<f64>> {}
impl<F: Fn(f64) -> Option<Vector3<f64>>> At for F {}

/// What is compared of a vector.
type View<'v> = &'v dyn Fn(&Vector3<f64>) -> Vector3<f64>;

/// The magnitude, which does not depend on the mounting.
pub(crate) fn magnitude(v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::x() * v.norm()
}

/// The delays at which the readings and the reference, each as it is compared, agree better than at those beside: motion time less sensor time, s; and the
/// correlation there. The best stands first.
///
/// The maxima are searched between `−range_s` and `range_s` about `around_s`.
pub(crate) fn delays(
    (recording, of_reading): (&Recording, View<'_>),
    (reference, of_reference): (&impl At, View<'_>),
    around_s: f64,
    range_s: f64,
) -> Vec<(f64, f64)> {
    let times = recording.times_s();
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return Vec::new() };
    let count = ((last - first) / STEP_S) as usize + 1;
    // the mean of the readings in each step
    let mut sums = vec![(Vector3::zeros(), 0_usize); count];
    for (time, reading) in times.iter().zip(recording.readings()) {
        let place = (((time - first) / STEP_S).round() as usize).min(count - 1);
        sums[place].0 += of_reading(reading);
        sums[place].1 += 1;
    }
    let sensor: Vec<Option<Vector3<f64>>> =
        sums.iter().map(|(sum, n)| (*n > 0).then(|| sum / *n as f64)).collect();
    let lags = (range_s / STEP_S).ceil() as usize;
    let start = first + around_s - lags as f64 * STEP_S;
    let of = |k: usize| reference(start + k as f64 * STEP_S).map(|v| of_reference(&v));
    let reference: Vec<Option<Vector3<f64>>> = (0..count + 2 * lags).map(of).collect();
    let scores: Vec<Option<f64>> =
        (0..=2 * lags).map(|lag| correlation(&sensor, &reference[lag..])).collect();
    let at = |k: usize| scores.get(k).copied().flatten();
    let peak = |k: usize| -> Option<(f64, f64)> {
        let (before, score, after) = (k.checked_sub(1).and_then(at), at(k)?, at(k + 1));
        let is_peak = before.is_none_or(|of| of < score) && after.is_none_or(|of| of <= score);
        // the top of the parabola through the three
        let refined = match (before, after) {
            (Some(a), Some(c)) if 2.0 * score - a - c > 0.0 => 0.5 * (c - a) / (2.0 * score - a - c),
            _ => 0.0,
        };
        let lag = k as f64 + refined.clamp(-0.5, 0.5) - lags as f64;
        is_peak.then_some((around_s + lag * STEP_S, score))
    };
    let mut peaks: Vec<(f64, f64)> = (0..scores.len()).filter_map(peak).collect();
    peaks.sort_by(|one, other| other.1.total_cmp(&one.1));
    peaks
}

/// Correlation coefficient where both have values; `None` for fewer than 50 of them, or no variation.
fn correlation(one: &[Option<Vector3<f64>>], other: &[Option<Vector3<f64>>]) -> Option<f64> {
    const FEWEST: usize = 50;
    let pairs: Vec<_> = one.iter().zip(other).filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
    if pairs.len() < FEWEST {
        return None;
    }
    let n = pairs.len() as f64;
    let zero = (Vector3::zeros(), Vector3::zeros());
    let (mean_a, mean_b) = pairs.iter().fold(zero, |(a, b), p| (a + p.0 / n, b + p.1 / n));
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        aa += (a - mean_a).norm_squared();
        bb += (b - mean_b).norm_squared();
        ab += (a - mean_a).dot(&(b - mean_b));
    }
    (aa * bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

/// The rotation from the frame of the readings to that of the reference which aligns them best, biases removed (`wahba1965`, `markley1988`).
pub(crate) fn rotation(pairs: &[(Vector3<f64>, Vector3<f64>)]) -> Option<UnitQuaternion<f64>> {
    if pairs.len() < 3 {
        return None;
    }
    let n = pairs.len() as f64;
    let (sum_a, sum_b) =
        pairs.iter().fold((Vector3::zeros(), Vector3::zeros()), |(a, b), p| (a + p.0, b + p.1));
    let (mean_a, mean_b) = (sum_a / n, sum_b / n);
    let attitude: Matrix3<f64> = pairs.iter().map(|(a, b)| (b - mean_b) * (a - mean_a).transpose()).sum();
    let svd = attitude.svd(true, true);
    let (u, vt) = (svd.u?, svd.v_t?);
    let sign = (u * vt).determinant();
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * vt;
    Some(UnitQuaternion::from_matrix(&rotation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::sensor::ReadingUnit;

    #[test]
    fn delay_and_rotation_are_found() {
        let motion =
            |t: f64| Vector3::new((2.0 * t).sin() + (5.1 * t).cos(), (3.3 * t).sin(), 0.4 * (7.0 * t).sin());
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -1.1, 2.0));
        let times_s: Vec<f64> = (0..2000).map(|k| 0.005 * k as f64).collect();
        let readings =
            times_s.iter().map(|t| turn.inverse() * motion(t + 0.1234) + Vector3::new(0.01, 0.0, -0.02));
        let unit = ReadingUnit::RadianPerSecond;
        let recording =
            Recording::new(times_s.clone(), readings.collect(), 3, unit).expect("samples in order");
        let at = |t| Some(motion(t));
        let found = delays((&recording, &magnitude), (&at, &magnitude), 0.0, 1.0);
        let (found, score) = *found.first().expect("it moves");
        // half a sample: the coarse delay is where the iteration begins
        assert!((found - 0.1234).abs() < 4e-3 && score > 0.99, "{found} {score}");
        let pairs: Vec<_> =
            times_s.iter().zip(recording.readings()).map(|(t, y)| (*y, motion(t + 0.1234))).collect();
        assert!(rotation(&pairs).expect("it turns").angle_to(&turn) < 1e-3);
    }
}

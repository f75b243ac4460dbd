//! Where the iteration begins: splines through the log, the coarse delay, the mounting, and a first guess of the noise.

use super::covered::covered;
use super::layout::Layout;
use super::log_equations::WeighedLog;
use super::model::{Model, State};
use super::parameters::TiltedGravity;
use super::reference_fit::ReferenceFit;
use super::stream::{Stream, white_noise};
use super::{MachineParameters, MachineProblem, MountingPrior, start};
use crate::chain::{ChainCorrections, SensorMount};
use crate::log::ReferenceLog;
use crate::reference::{Felt, Motion};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::Vector3;

/// Correlation of the magnitudes of rate (or force) below which recording and log are of different motions.
const SAME_MOTION: f64 = 0.5;
/// The delay is searched this many standard deviations about what is expected.
const SEARCHED: f64 = 4.0;

/// Model and state before the first step.
pub(super) struct Initial<'a> {
    pub(super) model: Model<'a>,
    pub(super) state: State,
    /// Outliers of each component of the log.
    pub(super) outliers: Vec<usize>,
}

impl<'a> Initial<'a> {
    /// On splines through the log. Without parameters to begin `from`, they are those of the setup, with the coarse delay.
    pub(super) fn on(
        problem: &MachineProblem<'a>,
        fit: ReferenceFit,
        from: Option<&MachineParameters>,
    ) -> Result<Self> {
        let setup = problem.setup;
        let sensors: Vec<SensorKind> =
            SensorKind::ALL.into_iter().filter(|kind| problem.recording.sensor(*kind).is_some()).collect();
        let Some(main) = sensors.last().and_then(|kind| problem.recording.sensor(*kind)) else {
            return Err(refused("the recording has no sensor", "record an accelerometer or a gyroscope"));
        };
        let ReferenceFit { motion, sd, outliers } = fit;
        let knots = motion.knots();
        let covered = covered(problem.log, &knots);
        let gravity = TiltedGravity::new(&setup.up);
        let mut nominal = MachineParameters::nominal(setup, *problem.nominal, motion.joints());
        let parameters = match from {
            Some(parameters) => {
                if setup.mounting == MountingPrior::Unknown {
                    nominal.mount.tip_from_sensor = parameters.mount.tip_from_sensor;
                }
                parameters.clone()
            }
            None => {
                let delay_s = place_in_time(problem, &motion, &covered, &gravity, &sensors, &mut nominal)?;
                MachineParameters { delays_s: [delay_s; 2], ..nominal.clone() }
            }
        };
        let layout = Layout::new(setup, &sensors, problem.quantities, nominal);
        let streams: Vec<Stream<'_>> = sensors
            .iter()
            .filter_map(|&sensor| {
                let recording = problem.recording.sensor(sensor)?;
                let sd = white_noise(recording);
                Some(Stream { sensor, recording, sd, growth: Vec::new() })
            })
            .collect();
        let middle_s = middle_s(main);
        let sd = setup.reference_noise.clone().unwrap_or(sd).iter().map(|sd| sd.max(1e-12)).collect();
        let log = WeighedLog { log: problem.log, sd, growth: Vec::new() };
        let model = Model { streams, log, layout, gravity, trust: setup.trust, middle_s, covered };
        Ok(Self { model, state: State { motion, parameters }, outliers })
    }
}

/// Middle of a recording, s.
pub(super) fn middle_s(recording: &Recording) -> f64 {
    0.5 * (recording.times_s[0] + recording.times_s[recording.len() - 1])
}

pub(super) fn refused(message: impl Into<String>, help: &str) -> Error {
    Error::recording(InputError::new(Refusal::MachineUnsolved, message, help))
}

/// The log has the joints of the chain, and samples.
pub(super) fn check_log(problem: &MachineProblem<'_>) -> Result<()> {
    let bad = |message: String, help: &str| {
        Err(Error::experiment(InputError::new(Refusal::MachineUnsuited, message, help)))
    };
    if let ReferenceLog::Joints(log) = problem.log {
        let Some(chain) = problem.chain else {
            return bad(
                "the log is of joints, and no machine is given".into(),
                "give [machine] urdf, base and tip",
            );
        };
        let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
        if log.names.len() != names.len() {
            let message = format!(
                "the log has {} joints, the machine {}: {}",
                log.names.len(),
                names.len(),
                names.join(", ")
            );
            return bad(message, "log every joint between base and tip");
        }
    }
    let noise = problem.setup.reference_noise.as_ref().map_or(0, Vec::len);
    let components = problem
        .chain
        .filter(|_| matches!(problem.log, ReferenceLog::Joints(_)))
        .map_or(6, |chain| chain.joints.len());
    if noise != 0 && noise != components {
        return bad(
            format!("reference_noise has {noise} values, the log {components} components"),
            "give one for each",
        );
    }
    if problem.log.times_s().len() < 8 {
        return Err(refused("the log has fewer than 8 samples", "log the whole motion"));
    }
    Ok(())
}

/// The coarse delay by correlation, and the mounting where nothing is known of it.
fn place_in_time(
    problem: &MachineProblem<'_>,
    motion: &Motion,
    covered: &[bool],
    gravity: &TiltedGravity,
    sensors: &[SensorKind],
    nominal: &mut MachineParameters,
) -> Result<f64> {
    let (setup, knots, columns) = (problem.setup, motion.knots(), motion.columns(false));
    let bare = SensorMount { lever_m: setup.lever_m, ..SensorMount::identity() };
    let carrier = motion.carrier(gravity.vector(nominal), bare, &ChainCorrections::none(motion.joints()));
    let at = |time_s: f64, sensor: SensorKind| -> Option<Vector3<f64>> {
        if time_s < knots.start_s || time_s > knots.end_s() || !covered[knots.interval(time_s)] {
            return None;
        }
        let mut felt = Felt::zeros(columns);
        motion.feel(&knots.weights(time_s), &carrier, columns, &mut felt);
        Some(match sensor {
            SensorKind::Accelerometer => felt.force,
            SensorKind::Gyroscope => felt.rate,
        })
    };
    let readings = |recording: &Recording, sensor: SensorKind| -> Recording {
        let nominal = problem.nominal.sensor(sensor);
        let inverse = nominal.matrix.try_inverse().unwrap_or_else(nalgebra::Matrix3::identity);
        let readings = recording.readings.iter().map(|y| inverse * (y - nominal.bias)).collect();
        Recording { readings, ..recording.clone() }
    };
    // the gyroscope tells the delay best
    let Some((sensor, recording)) = sensors
        .iter()
        .rev()
        .find_map(|kind| Some((*kind, readings(problem.recording.sensor(*kind)?, *kind))))
    else {
        return Ok(setup.delay_s);
    };
    let mut delay_s = setup.delay_s;
    if setup.delay_sd_s > 0.0 {
        let range_s = SEARCHED * setup.delay_sd_s;
        let found = start::delay(&recording, &|time_s| at(time_s, sensor), setup.delay_s, range_s);
        let Some((coarse_s, correlation)) = found else {
            let ends = |times: &[f64]| format!("{:.3} to {:.3} s", times[0], times[times.len() - 1]);
            let message = format!(
                "the recording ({}) and the log ({}) hardly overlap",
                ends(&recording.times_s),
                ends(problem.log.times_s())
            );
            return Err(refused(
                message,
                "give clock.delay_s, the log's time less the recording's, in [machine]",
            ));
        };
        if correlation < SAME_MOTION {
            let message = format!(
                "the {sensor} and the log are of different motions: the best correlation within {range_s:.2} s is {correlation:.2}"
            );
            let help = "check that the files belong together, the order of the joints, the units, and clock.delay_s and delay_sd_s in [machine]";
            return Err(refused(message, help));
        }
        delay_s = coarse_s;
    }
    if setup.mounting == MountingPrior::Unknown {
        let pairs: Vec<(Vector3<f64>, Vector3<f64>)> = (recording.times_s.iter().zip(&recording.readings))
            .filter_map(|(time, reading)| Some((*reading, at(time + delay_s, sensor)?)))
            .collect();
        if let Some(rotation) = start::rotation(&pairs) {
            nominal.mount.tip_from_sensor = rotation;
        }
    }
    Ok(delay_s)
}

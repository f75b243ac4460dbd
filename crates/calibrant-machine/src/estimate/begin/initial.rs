//! Where the iteration begins: splines through the log, the parameters, and a first guess of the noise.

use super::{MotionOfLog, Placement, covered};
use crate::estimate::least_squares::{Model, State, Stream, WeighedLog, white_noise};
use crate::estimate::problem::{Layout, TiltedGravity, refused};
use crate::estimate::{MachineParameters, MachineProblem, MountingPrior};
use crate::log::ReferenceLog;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Recording, SensorKind};

/// Delays that are nearer lead to the same minimum, s.
const APART_S: f64 = 0.02;

/// Model and state before the first step.
pub(crate) struct Initial<'a> {
    pub(crate) model: Model<'a>,
    pub(crate) state: State,
    /// Outliers of each component of the log.
    pub(crate) outliers: Vec<usize>,
}

impl<'a> Initial<'a> {
    /// On splines through the log. Without parameters to begin `from`, they are those of the setup, with the coarse delay.
    pub(crate) fn on(
        problem: &MachineProblem<'a>,
        fit: MotionOfLog,
        from: Option<&MachineParameters>,
    ) -> Result<Self> {
        let setup = problem.setup;
        let sensors: Vec<SensorKind> =
            SensorKind::ALL.into_iter().filter(|kind| problem.recording.sensor(*kind).is_some()).collect();
        let Some(main) = sensors.last().and_then(|kind| problem.recording.sensor(*kind)) else {
            return Err(refused("the recording has no sensor", "record an accelerometer or a gyroscope"));
        };
        let MotionOfLog { motion, sd, outliers, rounding_sd } = fit;
        let knots = motion.knots();
        let covered = covered(problem.log, &knots, 0.0);
        let gravity = TiltedGravity::new(&setup.up);
        let mut nominal = MachineParameters::nominal(setup, *problem.nominal, motion.joints());
        let placement = Placement::new(problem, &motion, &covered, gravity.vector(&nominal));
        let mut parameters = match from {
            Some(parameters) => parameters.clone(),
            None => MachineParameters { delays_s: [placement.delays_s()?[0]; 2].into(), ..nominal.clone() },
        };
        if setup.mounting == MountingPrior::Unknown {
            // a matrix that was found with other knots belongs to their mounting
            nominal.mount.tip_from_sensor = placement.mounting(&parameters);
            parameters.mount.tip_from_sensor = nominal.mount.tip_from_sensor;
            parameters.imu = nominal.imu;
        }
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
        let log = WeighedLog { log: problem.log, sd, rounding_sd, growth: Vec::new() };
        let model = Model { streams, log, layout, gravity, trust: setup.trust, middle_s, covered };
        Ok(Self { model, state: State { motion, parameters }, outliers })
    }

    /// Other places to begin: at the delays that correlate almost as well, if not better. A spline that is too smooth for the motion may have shown a wrong one.
    pub(crate) fn elsewhere(&self, problem: &MachineProblem<'a>) -> Vec<MachineParameters> {
        let Model { covered, gravity, layout, .. } = &self.model;
        let placement = Placement::new(problem, &self.state.motion, covered, gravity.vector(&layout.nominal));
        let found = placement.delays_s().unwrap_or_default().into_iter();
        let is_other = |delay_s: &f64| {
            self.state.parameters.delays_s.iter().all(|(_, own)| (own - delay_s).abs() > APART_S)
        };
        let from = |delay_s| MachineParameters { delays_s: [delay_s; 2].into(), ..layout.nominal.clone() };
        found.filter(is_other).map(from).collect()
    }
}

/// Middle of a recording, s.
pub(crate) fn middle_s(recording: &Recording) -> f64 {
    0.5 * (recording.times_s()[0] + recording.times_s()[recording.len() - 1])
}

/// The log has the joints of the chain, and samples.
pub(crate) fn check_log(problem: &MachineProblem<'_>) -> Result<()> {
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
    if let ReferenceLog::Poses(log) = problem.log
        && problem.recording[SensorKind::Accelerometer].is_some()
        && log.positions_m.iter().all(Option::is_none)
    {
        return Err(refused(
            "the log has orientations and no positions, and these an accelerometer needs",
            "log the positions, too; or take the accelerometer's columns out of the recording, and the gyroscope is calibrated alone",
        ));
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

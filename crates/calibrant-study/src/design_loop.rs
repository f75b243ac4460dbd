//! The design study, the thesis's loop (Figure 2) over many sensors: calibrate, design at the estimate,
//! calibrate again.

use super::simulated_recording::record;
use super::summary::{compare, traces, triples};
use super::{DesignOutcome, DesignStudy, MotionOutcome, StudySettings};
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, CalibrationProblem, Stimulus, calibrate};
use calibrant_core::information::Criterion;
use calibrant_core::motion::{
    CommandedMotion, JerkControlledMotion, KnownEnds, Limits, MotionClock, MotionGravity, Trust,
};
use calibrant_core::sensor::{Sensor, SensorKind, SensorParameters};
use calibrant_core::simulate::{Purpose, Rng, draw_sensor, initial_motion, stream};
use calibrant_design::{Design, DesignProblem, DesignSettings, DesignStatus, design, evaluate};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A population, and the design problem of its motions.
#[derive(Debug, Clone)]
pub struct DesignStudyProblem<'a> {
    /// The datasheet from which sensors are drawn; its noise must be given.
    pub sensor: &'a Sensor,
    /// Number of intervals of the motions.
    pub intervals: usize,
    /// Their duration, s.
    pub interval_s: f64,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// How far the motion is trusted.
    pub trust: Trust,
    /// Which ends of it are known.
    pub known_ends: KnownEnds,
    /// Gravity, where the sensors sense it beside the motion.
    pub gravity: Option<MotionGravity>,
    /// The clock of the recordings beside that of the motion.
    pub clock: MotionClock,
    /// The limits of the motion.
    pub limits: Limits,
    /// The criterion that the designs minimise.
    pub criterion: Criterion,
    /// The initial motion of all sensors; `None`: a random one for each.
    pub initial: Option<&'a JerkControlledMotion>,
    /// Number of sensors, at least one.
    pub sensors: usize,
    /// Number of the optimal motions that are shown together.
    pub motions_shown: usize,
}

impl<'a> DesignStudyProblem<'a> {
    /// The design at the guess `at`, with this information there already.
    #[must_use]
    pub fn design_at(&'a self, at: SensorParameters, prior: Option<DMatrix<f64>>) -> DesignProblem<'a> {
        DesignProblem {
            sensor: self.sensor,
            at,
            intervals: self.intervals,
            interval_s: self.interval_s,
            rate_hz: self.rate_hz,
            trust: self.trust,
            known_ends: self.known_ends,
            gravity: self.gravity,
            clock: self.clock,
            limits: &self.limits,
            criterion: self.criterion.clone(),
            prior,
        }
    }

    /// Why no motion can be designed; `None` where one can.
    #[must_use]
    pub fn obstacle(&self) -> Option<String> {
        if self.trust == Trust::Unknown {
            return Some("nothing is known of the motion but its ends, so none can be commanded".into());
        }
        let problem = self.design_at(self.sensor.nominal().unwrap_or_else(SensorParameters::identity), None);
        problem.check().err().map(|error| match error.input_error() {
            Some(input_error) => input_error.message.clone(),
            None => error.to_string(),
        })
    }
}

/// Sends every sensor round the loop, in parallel; `progress` is called with 1 after each sensor.
///
/// The result does not depend on the number of threads. Where it is interrupted, it has the sensors whose designs
/// are finished, and the first sensor in any case.
///
/// # Errors
/// As [`calibrate`] and [`design()`].
///
/// # References
/// `vamvaka2021`
pub fn run_design_study(
    problem: &DesignStudyProblem<'_>,
    settings: &StudySettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<DesignStudy> {
    let round = |index: u64| {
        let round = go_round(problem, settings, index)?;
        progress(1);
        Ok(round)
    };
    let interruption = &settings.design.interruption;
    let others = || -> Result<Vec<DesignOutcome>> {
        let outcome = |index| {
            if interruption.is_asked() {
                return None;
            }
            let finished =
                |(outcome, _): &(DesignOutcome, Design)| outcome.design_status != DesignStatus::Interrupted;
            match round(index) {
                Ok(round) => Some(round).filter(finished).map(|(outcome, _)| Ok(outcome)),
                Err(error) => Some(Err(error)),
            }
        };
        (1..problem.sensors as u64).into_par_iter().filter_map(outcome).collect()
    };
    // the first sensor's design is shown in full
    let (first, others) = rayon::join(|| round(0), others);
    let (first, design) = first?;
    let mut outcomes = vec![first];
    outcomes.extend(others?);
    Ok(DesignStudy {
        sensor: problem.sensor.clone(),
        parameters: design.parameters.clone(),
        intervals: problem.intervals,
        interval_s: problem.interval_s,
        rate_hz: problem.rate_hz,
        trust: problem.trust,
        known_ends: problem.known_ends,
        limits: design.limits.clone(),
        criterion: problem.criterion.clone(),
        datasheet_prior: settings.calibration.datasheet_prior,
        initial_given: problem.initial.is_some(),
        starts: settings.design.starts,
        seed: settings.seed,
        motions_shown: problem.motions_shown.min(outcomes.len()),
        summary: compare(
            &design.parameters,
            &triples(&outcomes, |outcome| &outcome.initial),
            &triples(&outcomes, |outcome| &outcome.optimal),
        ),
        trace: traces(&outcomes),
        outcomes,
        design,
    })
}

/// Sensor `index` round the loop.
fn go_round(
    problem: &DesignStudyProblem<'_>,
    settings: &StudySettings,
    index: u64,
) -> Result<(DesignOutcome, Design)> {
    let sensor = problem.sensor;
    let seed = seed_of(settings.seed, index);
    let mut rng = stream(settings.seed, Purpose::Sensor, index);
    let truth = draw_sensor(sensor, &mut rng);
    let nominal = sensor.nominal().unwrap_or_else(SensorParameters::identity);
    let first = match problem.initial {
        Some(motion) => motion.clone(),
        None => initial_motion(
            problem.intervals,
            problem.interval_s,
            sensor.axes,
            &problem.design_at(nominal, None).effective_limits(),
            &mut stream(seed, Purpose::Motion, 0),
        )?,
    };
    let before = calibrate_on(problem, settings, &truth, &first, &mut rng)?;

    let prior = settings
        .calibration
        .datasheet_prior
        .then(|| datasheet_information(sensor, &before.imu[SensorKind::Accelerometer]));
    let at_estimate = problem.design_at(before.imu[SensorKind::Accelerometer], prior);
    let how = DesignSettings {
        seed,
        certificate: settings.design.certificate && index == 0,
        ..settings.design.clone()
    };
    let mut design = design(&at_estimate, &how, &|_| ())?;
    design.initial = evaluate(&at_estimate, &first)?;

    let after = calibrate_on(problem, settings, &truth, &design.optimal.motion, &mut rng)?;
    let list = sensor.parameter_list();
    let truth: Vec<f64> = list.quantities().iter().map(|quantity| quantity.value(&truth)).collect();
    let outcome = DesignOutcome {
        initial: outcome(&truth, before, design.initial.motion.clone(), design.initial.value),
        optimal: outcome(&truth, after, design.optimal.motion.clone(), design.optimal.value),
        truth,
        design_status: design.status,
    };
    Ok((outcome, design))
}

fn calibrate_on(
    problem: &DesignStudyProblem<'_>,
    settings: &StudySettings,
    truth: &SensorParameters,
    motion: &JerkControlledMotion,
    rng: &mut Rng,
) -> Result<Calibration> {
    let sensor = problem.sensor;
    let command = CommandedMotion {
        motion: motion.clone(),
        trust: problem.trust,
        known_ends: problem.known_ends,
        gravity: problem.gravity,
        clock: problem.clock,
    };
    let (_, recording) = record(sensor, truth, &command, problem.rate_hz, rng)?;
    let problem = CalibrationProblem { sensor, recording: &recording, stimulus: Stimulus::Motion(&command) };
    calibrate(&problem, &settings.calibration)
}

fn outcome(
    truth: &[f64],
    calibration: Calibration,
    motion: JerkControlledMotion,
    predicted_criterion: f64,
) -> MotionOutcome {
    MotionOutcome {
        motion,
        predicted_criterion,
        sd: calibration.sd(),
        absolute_errors: truth
            .iter()
            .zip(&calibration.values)
            .map(|(truth, value)| (value - truth).abs())
            .collect(),
        trace: calibration.covariance.trace(),
        values: calibration.values,
        p_value: calibration.fit.p_value,
        status: calibration.status.name(),
    }
}

/// The information of the datasheet on the parameters.
fn datasheet_information(sensor: &Sensor, like: &SensorParameters) -> DMatrix<f64> {
    let parameters = sensor.parameter_list().describe(sensor, like);
    let weights = parameters.iter().map(|parameter| parameter.spread.map_or(0.0, |sd| sd.powi(-2)));
    DMatrix::from_diagonal(&DVector::from_iterator(parameters.len(), weights))
}

/// The seed of a sensor's initial motion and design. The first sensor has the study's, so that `design` under
/// that seed has the same initial motion. The others are far apart (the finaliser of SplitMix64, Steele et
/// al. 2014).
fn seed_of(seed: u64, index: u64) -> u64 {
    if index == 0 {
        return seed;
    }
    let mut z = seed.wrapping_add(index.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

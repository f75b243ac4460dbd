//! What is known beforehand, where the recording contradicts it: the fit without it tells which term it is.
//!
//! A term that is far off leaves no problem that is nearly linear, and where the fit with it ends, if it ends, hangs on the last digits. So what is absurd is told by the fit
//! without it alone, and is an error whatever the fit with it came to.

use super::solver;
use super::{ImuCalibration, ImuProblem, ImuSetup, KnownTerm, WhiteNoise};
use crate::error::{Complaint, Error, Result};
use crate::estimate::earth::unknown_latitude;
use crate::estimate::{CalibrationSettings, CalibrationStatus};
use crate::sensor::{Condition, ImuQuantity, Triad};
use nalgebra::Vector3;

/// Combined standard deviations beyond which a term contradicts the recording.
const CONTRADICTED: f64 = 6.0;
/// A term is absurd that pulls the readings of gravity, or of a slow turn, by this share of theirs. Up to there the fit with it was seen to converge.
const ABSURD: f64 = 0.2;
/// A slow turn by hand, rad/s.
const SLOW_RADPS: f64 = 0.5;
/// Smallest standard deviation of a prior: a smaller one leaves the other data no digits.
const LEAST_SD: f64 = 1e-12;

/// Calibrates an IMU.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where a sensor's recording is missing or is none, where gyroscope and accelerometer do not overlap, or where the
/// gyroscope's readings cannot be angular rates in the unit given; [`Error::Experiment`](crate::Error::Experiment) where the readings contradict the directions of
/// the holds or what is known beforehand; [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names what the holds or the rotations do not determine, and what would.
pub fn calibrate_imu(problem: &ImuProblem<'_>, settings: &CalibrationSettings) -> Result<ImuCalibration> {
    calibrate_imu_while(problem, settings, || problem.setup.white_noise)
}

/// The same where the gyroscope's white noise is still to be found: `white_noise` finds it while the accelerometer is fitted, which does not wait for it.
///
/// What it gives counts in place of [`ImuSetup::white_noise`]. Where no holds were found before ([`ImuSetup::found`]), sparks and wild readings are taken out first
/// ([`ImuRecording::without_sparks`](crate::sensor::ImuRecording::without_sparks)), and warnings say so.
///
/// # Errors
/// As [`calibrate_imu`].
pub fn calibrate_imu_while(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    let mut calibration = match problem.setup.found {
        Some(_) => of_clean(problem, settings, white_noise)?,
        None => with_sparks(problem, settings, white_noise)?,
    };
    calibration.warnings.extend(unknown_latitude(&calibration));
    Ok(calibration)
}

/// The same of a recording of which sparks are still to be taken out.
fn with_sparks(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    let (recording, sparks) = problem.recording.without_sparks();
    let mut calibration = of_clean(&ImuProblem { recording: &recording, ..*problem }, settings, white_noise)?;
    let unit = |triad: Triad| problem.recording.triad(triad).map_or("", |of| of.unit.symbol());
    let said = sparks.iter().map(|(triad, sparks)| sparks.words(*triad, unit(*triad)));
    calibration.warnings.splice(0..0, said);
    Ok(calibration)
}

/// The same of a recording without sparks.
fn of_clean(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    let known = &problem.setup.known;
    if known.is_empty() {
        return solver::calibrate_imu(problem, settings, white_noise);
    }
    known.iter().try_for_each(possible)?;
    let mut found_noise = None;
    let outcome = solver::calibrate_imu(problem, settings, || {
        found_noise = white_noise();
        found_noise
    });
    // what is fixed leaves no residual of its own
    let fixed = known.iter().any(|known| known.sd.is_none());
    if let Ok(found) = &outcome
        && !fixed
        && found.status == CalibrationStatus::Converged
        && found.warnings.is_empty()
    {
        return outcome;
    }
    let contradictions = contradictions(problem, settings, found_noise);
    let absurd = contradictions.iter().any(|term| term.absurd);
    let said = contradictions.into_iter().map(|term| term.words);
    match outcome {
        Ok(mut found) if !absurd => {
            found.warnings.splice(0..0, said);
            Ok(found)
        }
        Err(error) if said.len() == 0 => Err(error),
        _ => Err(Error::experiment(Complaint::new(
            said.collect::<Vec<_>>().join("; "),
            "correct the value in [known], its unit too, or leave it out and let the recording tell",
        ))),
    }
}

/// A term that the recording contradicts by far.
struct Contradiction {
    words: String,
    absurd: bool,
}

fn possible(known: &KnownTerm) -> Result<()> {
    let is_sd = |sd: f64| sd.is_finite() && sd >= LEAST_SD;
    if known.value.is_finite() && known.sd.is_none_or(is_sd) {
        return Ok(());
    }
    let sd = known.sd.map_or_else(String::new, |sd| format!(" ± {sd:?}"));
    Err(Error::experiment(Complaint::new(
        format!("{} cannot be known as {:?}{sd}", known.quantity.name(), known.value),
        format!("a prior has a standard deviation of {LEAST_SD:e} or more; without one the value is fixed"),
    )))
}

/// The terms that the recording contradicts by far, by the fit that knows of none.
fn contradictions(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: Option<WhiteNoise>,
) -> Vec<Contradiction> {
    let setup = ImuSetup { known: Vec::new(), ..problem.setup.clone() };
    let without = ImuProblem { setup: &setup, ..*problem };
    let Ok(without) = solver::calibrate_imu(&without, settings, || white_noise) else {
        return Vec::new();
    };
    if without.status != CalibrationStatus::Converged {
        return Vec::new();
    }
    let sds = without.sd();
    let contradiction = |known: &KnownTerm| {
        let place = without.quantities.iter().position(|quantity| *quantity == known.quantity)?;
        let (found, sd) = (known.quantity.of(&without.imu), sds[place]);
        let off = (found - known.value).abs();
        // the estimate is the mean of both, weighted
        let variance = known.sd.unwrap_or(0.0).powi(2);
        let pull = off * sd * sd / (sd * sd + variance);
        let gravity = problem.setup.holds.gravity.magnitude_mps2;
        (off > CONTRADICTED * sd.hypot(known.sd.unwrap_or(0.0))).then(|| Contradiction {
            words: format!(
                "the recording contradicts what [known] says of {}: {:?}, where the recording alone gives {found:.5} ± {sd:.1e}",
                known.quantity.name(),
                known.value
            ),
            absurd: pull * share(known.quantity, &without, gravity) > ABSURD,
        })
    };
    problem.setup.known.iter().filter_map(contradiction).collect()
}

/// By which share of the readings of gravity, or of a slow turn, one unit of a quantity moves them at most.
fn share(quantity: ImuQuantity, calibration: &ImuCalibration, gravity: f64) -> f64 {
    let imu = &calibration.imu;
    let size = match quantity.triad() {
        Triad::Accelerometer => gravity,
        Triad::Gyroscope => SLOW_RADPS,
    };
    // without temperatures nothing follows them
    let temperatures = calibration.hold_temperatures_c.as_deref().unwrap_or(&[0.0]);
    let moved = |(axis, temperature_c): (usize, f64)| {
        let along = Vector3::ith(axis, 1.0);
        let at = Condition { imu, stimulus: along * size, force: along * gravity, temperature_c };
        quantity.derivative(&at).norm()
    };
    let most =
        (0..3).flat_map(|axis| temperatures.iter().map(move |t| (axis, *t))).map(moved).fold(0.0, f64::max);
    most / (size * imu.triad(quantity.triad()).matrix.determinant().abs().cbrt())
}

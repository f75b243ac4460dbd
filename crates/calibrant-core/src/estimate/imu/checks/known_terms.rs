//! What is known beforehand, where the recording contradicts it: the fit without it tells which term it is.
//!
//! A given term that is far off makes the problem strongly nonlinear. Where the fit with it ends then depends on rounding.
//! So an absurd term is judged by the fit without it alone. It is an error, whatever the fit with it gives.

use crate::diagnostic::datasheet::KnownContradicted;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::result::Calibration;
use crate::sensor::{Condition, ImuQuantity, SensorKind};
use crate::solve::CalibrationStatus;
use nalgebra::Vector3;

/// Combined standard deviations beyond which a term contradicts the recording.
const CONTRADICTED: f64 = 6.0;

/// A term is absurd that pulls the readings of gravity, or of a slow turn, by this share of theirs. Up to there the fit with it was seen to converge.
const ABSURD: f64 = 0.2;

/// A slow turn by hand, rad/s.
const SLOW_RADPS: f64 = 0.5;

/// Smallest standard deviation of a prior: a smaller one leaves the other data no digits.
const LEAST_SD: f64 = 1e-12;

/// A term that the recording contradicts by far.
pub(crate) struct Contradiction {
    pub(crate) known: KnownContradicted,
    /// Is it so far off that no fit with it makes sense?
    pub(crate) is_absurd: bool,
}

/// Refuses a term that cannot be known.
pub(crate) fn check(known: &KnownTerm) -> Result<()> {
    let is_sd = |sd: f64| sd.is_finite() && sd >= LEAST_SD;
    if known.value.is_finite() && known.sd.is_none_or(is_sd) {
        return Ok(());
    }
    let sd = known.sd.map_or_else(String::new, |sd| format!(" ± {sd:?}"));
    Err(Error::experiment(InputError::new(
        Refusal::ValueInvalid,
        format!("{} cannot be known as {:?}{sd}", known.quantity.name(), known.value),
        format!("a prior has a standard deviation of {LEAST_SD:e} or more; without one the value is fixed"),
    )))
}

/// The terms that the recording contradicts by far. `without`: the calibration without any of them.
pub(crate) fn contradicted(known: &[KnownTerm], without: &Calibration) -> Vec<Contradiction> {
    if without.status != CalibrationStatus::Converged {
        return Vec::new();
    }
    let sds = without.sd();
    let contradiction = |known: &KnownTerm| {
        let place = without.quantities.iter().position(|quantity| *quantity == known.quantity)?;
        let (found, sd) = (known.quantity.value(&without.imu), sds[place]);
        let off = (found - known.value).abs();
        // the estimate is the mean of both, weighted
        let variance = known.sd.unwrap_or(0.0).powi(2);
        let pull = off * sd * sd / (sd * sd + variance);
        let gravity = without.holds()?.gravity.magnitude_mps2;
        (off > CONTRADICTED * sd.hypot(known.sd.unwrap_or(0.0))).then(|| Contradiction {
            known: KnownContradicted {
                parameter: known.quantity.name(),
                given: known.value,
                found,
                found_sd: sd,
            },
            is_absurd: pull * share(known.quantity, without, gravity) > ABSURD,
        })
    };
    known.iter().filter_map(contradiction).collect()
}

/// By which share of the readings of gravity, or of a slow turn, one unit of a quantity moves them at most.
fn share(quantity: ImuQuantity, calibration: &Calibration, gravity: f64) -> f64 {
    let imu = &calibration.imu;
    let size = match quantity.sensor_kind() {
        SensorKind::Accelerometer => gravity,
        SensorKind::Gyroscope => SLOW_RADPS,
    };
    // without temperatures nothing follows them
    let temperatures =
        calibration.holds().and_then(|holds| holds.temperatures_c.as_deref()).unwrap_or(&[0.0]);
    let moved = |(axis, temperature_c): (usize, f64)| {
        let along = Vector3::ith(axis, 1.0);
        let at = Condition { imu, stimulus: along * size, force: along * gravity, temperature_c };
        quantity.derivative(&at).norm()
    };
    let most =
        (0..3).flat_map(|axis| temperatures.iter().map(move |t| (axis, *t))).map(moved).fold(0.0, f64::max);
    most / (size * imu.sensor(quantity.sensor_kind()).matrix.determinant().abs().cbrt())
}

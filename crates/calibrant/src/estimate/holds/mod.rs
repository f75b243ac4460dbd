//! Static multi-position calibration: the sensor held still in several orientations, directions unknown, magnitude g.
//!
//! ```text
//! minimise over S, b, f_j:  Σ_j (ȳ_j − S f_j − b)ᵀ V_j⁻¹ (ȳ_j − S f_j − b)   with |f_j| = g
//! V_j = diag(σ_w²)/n_j + σ_b² diag(gain²)
//! ```
//!
//! The same arrowhead as for a motion, with one unknown direction (two numbers) for each hold instead of a chain; `S` in the gauge asked
//! for ([`Gauge`](crate::sensor::Gauge)). Each hold gives three numbers and takes two: with J holds and p parameters, J − p degrees of freedom.
//!
//! # Where the covariance comes from
//! Samples within a hold are correlated and share the hold's own error, so the scatter *between* holds decides. `σ_w` is the pooled scatter
//! within holds; `σ_b` is chosen such that χ² equals its degrees of freedom (Paule and Mandel 1982), zero if the noise within holds
//! already explains the scatter. So the covariance is the larger of the two, and [`HoldCalibration`] says which it was. Long holds count by
//! their length only as far as noise within holds matters.
//!
//! Gravity's own uncertainty is a common factor of `S`: it adds `(∂p/∂g)(∂p/∂g)ᵀ σ_g²`, with `∂S/∂g = −S/g`.
//!
//! # Bad holds
//! A robust fit (Tukey's biweight) finds candidates; a hold is left out when its studentised deletion residual is beyond the 1 %
//! point of Student's t, Bonferroni-corrected for the number of holds. Holds left out are listed with their residual. A hold in which the sensor stops at the end of
//! its range is left out before that (`clipped`).

mod changing;
mod clipped;
mod coverage;
mod detect;
mod expected;
mod filtered;
mod fit;
mod paused;
mod robust;
mod verdict;

use super::gravity::gravity_slope;
use super::one_sided::one_sided;
use super::quantisation::of_means;
use super::{
    Calibration, CalibrationProblem, CalibrationSettings, CoarseAxis, FitStatistics, HoldCalibration,
    HoldResult, Recovered, Uncalibrated, coarse_axes_in, statistics,
};
use crate::error::{Complaint, Error, Result};
use crate::motion::{Gravity, Hold};
use crate::sensor::{Gauge, ImuParameters, ImuQuantity, Recording, SensorModel, SensorParameters, Triad};
use nalgebra::{Matrix3, Vector3};
use robust::Robust;

pub(super) use clipped::{reason as clipped_reason, with_clipped};
pub(super) use robust::{critical, sphere};
pub(super) use verdict::left_out;

pub use clipped::clipped_holds;
pub use coverage::{Coverage, coverage};
pub(super) use detect::{as_recorded, beyond, find_holds_in, median};
pub use detect::{find_holds, holds_between};
pub use expected::{ExpectedCalibration, expected_calibration};
pub use filtered::holds_lost_to_filter;
pub(super) use filtered::with_filter;
pub(super) use paused::with_pauses;

/// What is known of the holds.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldsSetup {
    /// The magnitude of gravity.
    pub gravity: Gravity,
    /// The gauge of the result.
    pub gauge: Gauge,
    /// Holds given by the user as (start, end) in s; `None` to find them.
    pub intervals_s: Option<Vec<(f64, f64)>>,
    /// A shorter stillness is not a hold, s.
    pub minimum_hold_s: f64,
}

impl Default for HoldsSetup {
    fn default() -> Self {
        Self {
            gravity: Gravity { magnitude_mps2: 9.806_65, sd_mps2: 0.0 },
            gauge: Gauge::Upper,
            intervals_s: None,
            minimum_hold_s: 1.0,
        }
    }
}

/// Calibrates from holds, sparks taken out. `as_read` is the recording before anything was corrected in it, of the same samples: it tells which holds are clipped.
pub(super) fn calibrate(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    as_read: &Recording,
) -> Result<Calibration> {
    if problem.sensor.axes != 3 {
        return Err(Error::experiment(Complaint::new(
            "a static calibration needs three axes: only the magnitude of gravity is known, not its direction",
            "set sensor.axes = 3",
        )));
    }
    let holds = match &setup.intervals_s {
        Some(intervals) => holds_between(problem.recording, intervals)?,
        None => find_holds_in(problem.recording, setup.minimum_hold_s)?,
    };
    let clipped = clipped_holds(as_read, &holds);
    let sound: Vec<usize> = (0..holds.len()).filter(|&j| clipped[j].is_none()).collect();
    let coarse = coarse_axes_in(as_read, sound.iter().map(|&j| &holds[j]));
    let of_mean = of_means(&coarse);
    let one_sided = one_sided(problem.recording, Triad::Accelerometer, sound.iter().map(|&j| &holds[j]));
    let found = setup.intervals_s.is_none().then_some((problem.recording, setup.minimum_hold_s));
    let lost = found.and_then(|(recording, minimum_s)| holds_lost_to_filter(recording, &holds, minimum_s));
    let robust = match problem.sensor.model {
        SensorModel::ScaleBias => robust::fit::<6>(problem, setup, settings, &holds, sound, of_mean),
        SensorModel::Full => robust::fit::<9>(problem, setup, settings, &holds, sound, of_mean),
    }
    .map_err(|error| with_clipped(error, &clipped, as_read))
    .map_err(|error| match found {
        Some((recording, minimum_s)) => {
            with_pauses(with_filter(error, recording, &holds, minimum_s), recording)
        }
        None => error,
    })?;
    let reasons = clipped.iter().map(|end| end.map(|end| clipped_reason(&end, as_read))).collect();
    let mut calibration = assemble(problem, setup, holds, reasons, robust);
    calibration.warnings.extend(lost);
    calibration.warnings.extend(coarse_words(&coarse, as_read));
    calibration.warnings.extend(one_sided);
    calibration.warnings.extend(beyond(as_read, setup.intervals_s.as_deref().unwrap_or_default()));
    Ok(Calibration { datasheet_prior: settings.datasheet_prior, ..calibration })
}

/// Says which axes of an accelerometer come in coarse steps.
pub(super) fn coarse_words(coarse: &[CoarseAxis], recording: &Recording) -> Vec<String> {
    let help = "choose a smaller range, or more digits in the file";
    let words = |found: &CoarseAxis| found.words("accelerometer", recording.unit.symbol());
    coarse.iter().map(|found| format!("{}; {help}", words(found))).collect()
}

/// Root mean square of `|f| − g` over the holds that are used, m/s².
pub(super) fn magnitude_rms(holds: &[HoldResult]) -> f64 {
    let squares: Vec<f64> =
        holds.iter().filter(|hold| hold.used).map(|hold| hold.magnitude_residual_mps2.powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// Puts the result together.
fn assemble(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    holds: Vec<Hold>,
    reasons: Vec<Option<String>>,
    robust: Robust,
) -> Calibration {
    let list = setup.gauge.parameter_list(problem.sensor.model);
    let sensor = robust.sensor;
    let g = setup.gravity;
    let mut covariance = robust.covariance.clone();
    let quantities: Vec<ImuQuantity> =
        list.quantities().iter().map(|of| ImuQuantity::Of(Triad::Accelerometer, *of)).collect();
    let imu = ImuParameters { accelerometer: sensor, ..ImuParameters::identity() };
    let slope = gravity_slope(&quantities, &imu, &g);
    covariance += &slope * slope.transpose() * (g.sd_mps2 * g.sd_mps2);

    let results: Vec<HoldResult> = holds
        .into_iter()
        .zip(reasons)
        .enumerate()
        .map(|(j, (hold, reason))| HoldResult {
            force_mps2: robust.forces[j],
            magnitude_residual_mps2: robust.magnitudes[j].error,
            studentised_residual: robust.studentised[j],
            used: robust.used[j],
            reason,
            hold,
        })
        .collect();
    let used = || results.iter().filter(|result| result.used);
    let count = used().count();
    let mut residual_rms = Vector3::zeros();
    for result in used() {
        let residual = result.hold.mean - sensor.reading(&result.force_mps2);
        residual_rms += residual.component_mul(&residual) / count as f64;
    }
    let magnitude_rms = magnitude_rms(&results);
    let change = changing::change(&results, &robust.magnitudes, setup.gravity.magnitude_mps2);
    let degrees_of_freedom = robust.degrees_of_freedom;
    let fit = FitStatistics {
        chi2: robust.chi2,
        degrees_of_freedom,
        p_value: if robust.between_holds_sd > 0.0 {
            None
        } else {
            statistics::chi2_p_value(robust.chi2, degrees_of_freedom)
        },
        residual_rms: residual_rms.map(f64::sqrt),
        assumed_noise: problem.sensor.noise(&sensor.matrix.diagonal()),
        noise_estimate: Some(robust.within_sd),
        whiteness: Vec::new(),
    };
    let nominal = problem.sensor.nominal().unwrap_or(SensorParameters {
        bias: sensor.bias,
        matrix: Matrix3::from_diagonal(&sensor.matrix.diagonal()),
    });
    let mut calibration = Calibration {
        status: robust.status,
        iterations: robust.iterations,
        gradient_norm: robust.gradient_norm,
        parameters: list.describe(problem.sensor, &nominal),
        values: list.quantities().iter().map(|quantity| quantity.of(&sensor)).collect(),
        covariance,
        sensor,
        unit: problem.sensor.unit,
        fit,
        recovered: Recovered::Holds(HoldCalibration {
            holds: results,
            gravity: g,
            gauge: setup.gauge,
            between_holds_sd_mps2: robust.between_holds_sd,
            between_holds_dominates: robust.between_holds_sd > 0.0,
            tilt: None,
            magnitude_residual_rms_mps2: magnitude_rms,
            degrees_of_freedom,
            condition_number: robust.condition_number,
            detected: setup.intervals_s.is_none(),
            before: Uncalibrated::accelerometer(problem.sensor, &sensor),
            change: change.map(Box::new),
        }),
        residuals: Vec::new(),
        first_sample: 0,
        datasheet_prior: false,
        warnings: Vec::new(),
    };
    calibration.warnings = verdict::warnings(&calibration, &robust.weakest);
    calibration
}

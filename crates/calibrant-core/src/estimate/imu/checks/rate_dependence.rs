//! A gyroscope whose gain depends on the rate: it compresses, or its range is too small.
//!
//! With a gain that changes with the square of the rate, `ω = ω₀ (1 + κ |ω₀|²)` of the corrected rate `ω₀`. The fit is linear near its end, so one more least squares
//! over the rotations tells `κ` and how the other parameters would move with it:
//!
//! ```text
//! minimise over δ, κ:  Σ |e + J δ + (∂e/∂κ) κ|²
//! ```
//!
//! with the gravity residuals `e` of the fit and their derivatives `J` by the gyroscope's quantities. The residuals themselves tell the variance, so that what scatters for
//! other reasons is no evidence.

use crate::diagnostic::gyroscope::GainDependsOnRate;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::model::{ImuModel, RotationData, Samples, State};
use crate::sensor::{ImuQuantity, Quantity, SensorKind};
use nalgebra::{DMatrix, DVector, Vector2, Vector3};

/// `κ` in its standard deviations beyond which it is no chance: with ten degrees of freedom once in ten thousand.
const NO_CHANCE: f64 = 6.0;
/// Movement of a gain in its stated standard deviations that matters.
const MATTERS: f64 = 2.0;
/// Fewest degrees of freedom that tell a variance.
const FEWEST: usize = 8;

pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    dependence(evidence).into_iter().collect()
}

fn dependence(evidence: &Evidence<'_>) -> Option<crate::diagnostic::Diagnostic> {
    let (model, state) = (evidence.model, &evidence.fit.state);
    let columns: Vec<usize> = (0..model.quantities.len())
        .filter(|k| model.quantities[*k].sensor_kind() == SensorKind::Gyroscope)
        .collect();
    let counting: Vec<&RotationData<'_>> =
        model.rotations.iter().filter(|data| data.counts && data.used).collect();
    let peak_radps = counting.iter().map(|data| data.samples.path(&state.imu).peak_radps).fold(0.0, f64::max);
    let unknowns = columns.len() + 1;
    if 2 * counting.len() < unknowns + FEWEST || peak_radps <= 0.0 {
        return None;
    }
    // a share of the gain at the fastest rate: small, so that differences are derivatives
    let step = 1e-4 / peak_radps.powi(2);
    let mut rows = DMatrix::zeros(2 * counting.len(), unknowns);
    let mut errors = DVector::zeros(2 * counting.len());
    for (i, data) in counting.iter().enumerate() {
        let residual = model.gravity_residual(data, state)?;
        let moved = with_dependence(model, data, state, step)?;
        errors.fixed_rows_mut::<2>(2 * i).copy_from(&residual.error);
        for (place, column) in columns.iter().enumerate() {
            rows.view_mut((2 * i, place), (2, 1)).copy_from(&residual.by_parameters.column(*column));
        }
        rows.view_mut((2 * i, unknowns - 1), (2, 1)).copy_from(&((moved - residual.error) / step));
    }
    // unknowns of one size
    let sizes: Vec<f64> = rows.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
    rows.column_iter_mut().zip(&sizes).for_each(|(mut column, size)| column /= *size);
    let normal = rows.transpose() * &rows;
    let inverse = normal.cholesky()?.inverse();
    let solved = -(&inverse * rows.transpose() * &errors);
    let left = (&errors + &rows * &solved).norm_squared();
    let variance = left / (errors.len() - unknowns) as f64;
    let last = unknowns - 1;
    let deviations = solved[last].abs() / (variance * inverse[(last, last)]).sqrt();
    let kappa = solved[last] / sizes[last];
    let moved_sds = columns.iter().enumerate().filter_map(|(place, column)| {
        let quantity = model.quantities[*column];
        let is_gain = matches!(quantity, ImuQuantity::Of(_, Quantity::Scale(_)));
        let stated = evidence.calibration.quantities.iter().position(|of| *of == quantity)?;
        let sd = evidence.calibration.covariance[(stated, stated)].sqrt();
        is_gain.then(|| solved[place].abs() / sizes[place] / sd)
    });
    let moved_sds = moved_sds.fold(0.0, f64::max);
    let share = kappa * peak_radps * peak_radps;
    let matters = deviations > NO_CHANCE && moved_sds > MATTERS && share.abs() < 1.0;
    matters.then(|| GainDependsOnRate { share, peak_radps, moved_sds }.into())
}

/// The gravity residual with this `κ`.
fn with_dependence(
    model: &ImuModel<'_>,
    data: &RotationData<'_>,
    state: &State,
    kappa: f64,
) -> Option<Vector2<f64>> {
    let imu = state.imu.at(data.samples.temperature_c());
    let (matrix, bias) = (imu.gyroscope.matrix, imu.gyroscope.bias);
    let correction = matrix.try_inverse()?;
    let with = |reading: &Vector3<f64>| {
        let rate = correction * (reading - bias);
        reading + matrix * rate * (kappa * rate.norm_squared())
    };
    let readings: Vec<Vector3<f64>> = data.samples.readings.iter().map(with).collect();
    let samples = Samples { readings: &readings, ..data.samples };
    let moved = RotationData {
        from: data.from,
        samples,
        knocks: data.knocks.clone(),
        beside_means: data.beside_means,
        used: data.used,
        counts: data.counts,
    };
    Some(model.gravity_residual(&moved, state)?.error)
}

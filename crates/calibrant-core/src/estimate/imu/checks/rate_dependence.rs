//! A gyroscope whose gain depends on the rate: it compresses, or its range is too small.
//!
//! Each axis of a gyroscope compresses by itself: with its output `r` about the bias, `r + κ r³` is what a linear one had read. The fit is linear near its end, so one more
//! least squares over the rotations tells the three `κ` and how the other parameters would move with them:
//!
//! ```text
//! minimise over δ, κ:  Σ |e + J δ + (∂e/∂κ) κ|²
//! ```
//!
//! with the gravity residuals `e` of the fit and their derivatives `J` by the gyroscope's quantities. The residuals themselves tell the variance, so that what scatters for
//! other reasons is no evidence. The `κ` together are tested by Fisher's F.

use crate::diagnostic::gyroscope::GainDependsOnRate;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::model::{ImuModel, RotationData, Samples, State};
use crate::sensor::{ImuQuantity, Quantity, SensorKind};
use crate::solve::f_p_value;
use nalgebra::{DMatrix, DVector, Vector2, Vector3};

/// Probability of `κ` at least this large where the gains are constant.
const CHANCE: f64 = 1e-4;
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
    let rotations = model.rotations.iter().zip(&evidence.fit.residuals);
    let (counting, residuals): (Vec<&RotationData<'_>>, Vec<_>) =
        rotations.filter(|(data, _)| data.counts && data.used).unzip();
    let peaks_radps = peaks(&counting, state);
    let unknowns = columns.len() + 3;
    if 2 * counting.len() < unknowns + FEWEST || peaks_radps.min() <= 0.0 {
        return None;
    }
    let mut rows = DMatrix::zeros(2 * counting.len(), unknowns);
    let mut errors = DVector::zeros(2 * counting.len());
    for (i, (data, residual)) in counting.iter().zip(residuals).enumerate() {
        let residual = residual.as_ref()?;
        errors.fixed_rows_mut::<2>(2 * i).copy_from(&residual.error);
        for (place, column) in columns.iter().enumerate() {
            rows.view_mut((2 * i, place), (2, 1)).copy_from(&residual.by_parameters.column(*column));
        }
        for axis in 0..3 {
            // a share of the gain at the fastest rate: small, so that differences are derivatives
            let step = 1e-4 / peaks_radps[axis].powi(2);
            let moved = with_dependence(model, data, state, &Vector3::ith(axis, step))?;
            let slope = (moved - residual.error) / step;
            rows.view_mut((2 * i, columns.len() + axis), (2, 1)).copy_from(&slope);
        }
    }
    // unknowns of one size
    let sizes: Vec<f64> = rows.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
    rows.column_iter_mut().zip(&sizes).for_each(|(mut column, size)| column /= *size);
    let normal = rows.transpose() * &rows;
    let inverse = normal.cholesky()?.inverse();
    let solved = -(&inverse * rows.transpose() * &errors);
    let left = (&errors + &rows * &solved).norm_squared();
    let free = (errors.len() - unknowns) as f64;
    let of_kappa = inverse.fixed_view::<3, 3>(columns.len(), columns.len()).into_owned();
    let kappa = solved.fixed_rows::<3>(columns.len()).into_owned();
    let chi2 = kappa.dot(&of_kappa.cholesky()?.solve(&kappa)) / (left / free);
    let chance = f_p_value(chi2, 3, free)?;
    let moved_sds = columns.iter().enumerate().filter_map(|(place, column)| {
        let quantity = model.quantities[*column];
        let is_gain = matches!(quantity, ImuQuantity::Of(_, Quantity::Scale(_)));
        let stated = evidence.calibration.quantities.iter().position(|of| *of == quantity)?;
        let sd = evidence.calibration.covariance[(stated, stated)].sqrt();
        is_gain.then(|| solved[place].abs() / sizes[place] / sd)
    });
    let moved_sds = moved_sds.fold(0.0, f64::max);
    let share_of = |axis: usize| kappa[axis] / sizes[columns.len() + axis] * peaks_radps[axis].powi(2);
    let most = (0..3).max_by(|one, other| share_of(*one).abs().total_cmp(&share_of(*other).abs()))?;
    let (share, peak_radps) = (share_of(most), peaks_radps[most]);
    let matters = chance < CHANCE && moved_sds > MATTERS && share.abs() < 1.0;
    matters.then(|| GainDependsOnRate { share, peak_radps, moved_sds }.into())
}

/// The largest output of each axis about its bias, rad/s.
fn peaks(counting: &[&RotationData<'_>], state: &State) -> Vector3<f64> {
    let of = |data: &&RotationData<'_>| {
        let bias = state.imu.at(data.samples.temperature_c())[SensorKind::Gyroscope].bias;
        data.samples
            .readings
            .iter()
            .fold(Vector3::zeros(), |peak: Vector3<f64>, of| peak.sup(&(of - bias).abs()))
    };
    counting.iter().map(of).fold(Vector3::zeros(), |peak, of| peak.sup(&of))
}

/// The gravity residual with these `κ`.
fn with_dependence(
    model: &ImuModel<'_>,
    data: &RotationData<'_>,
    state: &State,
    kappa: &Vector3<f64>,
) -> Option<Vector2<f64>> {
    let bias = state.imu.at(data.samples.temperature_c())[SensorKind::Gyroscope].bias;
    let with = |reading: &Vector3<f64>| {
        let output = reading - bias;
        reading + output.component_mul(&output).component_mul(&output).component_mul(kappa)
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

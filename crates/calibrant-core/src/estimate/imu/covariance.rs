//! The covariance of the estimates.
//!
//! The noise gives the inverse of the information. The uncertainty of the sample rate, common errors by coarse steps, and the unknown part of the Earth's
//! rate add to it.

use crate::error::Result;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use crate::estimate::imu::variance_components::rotations::RotationWeights;
use crate::estimate::imu::variance_components::solution::Solution;
use crate::estimate::quantisation::CoarseAxis;
use crate::information;
use crate::sensor::{Condition, ImuParameters, ImuQuantity, SensorKind};
use crate::solve::{Uncertainty, VarianceSource};
use nalgebra::{DMatrix, DVector};

/// The uncertainty of the estimates of an IMU, before that of gravity.
pub(crate) struct ImuUncertainty {
    pub(crate) uncertainty: Uncertainty,
    /// Error of each estimate by one standard deviation of the Earth's rate about the vertical, if that is unknown.
    pub(crate) of_vertical: Option<DVector<f64>>,
    /// Root mean square of each component of the Earth's rate about the north, rad/s.
    pub(crate) north_rms_radps: f64,
}

impl ImuUncertainty {
    /// The covariance of a solution. `coarse`: the gyroscope's axes with coarse steps; `rate_sd`: relative uncertainty of the sample rate;
    /// `systematic`: errors of the estimates by one standard deviation of what all data share: the accelerometer's drift, the alignment of faces, the thermometer.
    pub(crate) fn of(
        model: &ImuModel<'_>,
        solution: &Solution,
        rate_sd: f64,
        (coarse, systematic): (&[CoarseAxis], Vec<(VarianceSource, DVector<f64>)>),
    ) -> Result<Self> {
        let imu = &solution.fit.state.imu;
        let covariance = information::covariance(&solution.fit.information).ok_or_else(singular)?;
        let weight = model.prior.as_ref().map(|(_, weight)| weight.as_slice());
        // coarse steps: holds with nearly the same reading have the same error, to which the estimates respond by the inverse of the information alone
        let of_steps = common_slopes(model, &solution.fit, coarse, &covariance);
        let mut uncertainty = Uncertainty::of(covariance, weight);
        for (slope, sd) in of_steps {
            uncertainty.add(VarianceSource::CoarseSteps, &slope, sd * sd);
        }
        for (source, error) in systematic {
            uncertainty.add(source, &error, 1.0);
        }
        uncertainty.add(VarianceSource::Timing, &rate_slope(model, imu), rate_sd * rate_sd);
        let (of_earth, of_vertical, north_rms_radps) = of_earth(model, &solution.weighed)?;
        uncertainty.add_covariance(VarianceSource::EarthRate, &of_earth);
        Ok(Self { uncertainty, of_vertical, north_rms_radps })
    }
}

/// Derivative of the estimates with respect to the logarithm of the sample rate: a faster clock makes turns shorter and gains larger.
fn rate_slope(model: &ImuModel<'_>, imu: &ImuParameters) -> DVector<f64> {
    let of_gyroscope = |quantity: &ImuQuantity| match quantity {
        ImuQuantity::Of(SensorKind::Gyroscope, _) if !quantity.is_of_bias() => quantity.value(imu),
        _ => 0.0,
    };
    DVector::from_iterator(model.quantities.len(), model.quantities.iter().map(of_gyroscope))
}

/// What the unknown part of the Earth's rate adds to the covariance: `D C Dᵀ`. `C` is the covariance of its unknowns, `D = −K C⁻¹` the derivative of the
/// estimates, and `K` the covariance of both.
///
/// Also the error of each estimate by one standard deviation of the rate about the vertical, if that is unknown, and the size of the rate about the north.
fn of_earth(
    model: &ImuModel<'_>,
    weighed: &RotationWeights,
) -> Result<(DMatrix<f64>, Option<DVector<f64>>, f64)> {
    let (places, all) = (model.gyroscope_places(), &weighed.covariance);
    let count = all.nrows() - places.len();
    let mut both = DMatrix::zeros(model.quantities.len(), count);
    for (row, &k) in places.iter().enumerate() {
        both.row_mut(k).copy_from(&all.view((row, places.len()), (1, count)));
    }
    let own = all.view((places.len(), places.len()), (count, count)).into_owned();
    let of_vertical =
        model.earth.has_vertical().then(|| both.column(0) / own[(0, 0)].max(f64::MIN_POSITIVE).sqrt());
    let north_rms_radps = model.earth.north_rms(&own);
    let follow = own.cholesky().ok_or_else(singular)?.solve(&both.transpose());
    Ok((both * follow, of_vertical, north_rms_radps))
}

/// The effect of rounding on the estimates, for each coarse axis of the gyroscope: derivatives with respect to common errors, and their size.
///
/// The means in the holds, or the readings in the rotations, have common errors. Holds with nearly the same reading are rounded alike. Rounding then
/// stretches or shrinks the effect of the force on the reading, and a part of the error follows the force.
fn common_slopes(
    model: &ImuModel<'_>,
    fit: &Fit,
    coarse: &[CoarseAxis],
    covariance: &DMatrix<f64>,
) -> Vec<(DVector<f64>, f64)> {
    let imu = &fit.state.imu;
    let of = |found: &CoarseAxis| {
        let axis = found.axis.index();
        // the same in all, and along each component of the force
        let mut of_holds: [DVector<f64>; 4] = std::array::from_fn(|_| DVector::zeros(model.quantities.len()));
        let mut of_rotations = of_holds[0].clone();
        for (i, (residual, data)) in fit.residuals.iter().zip(&model.rotations).enumerate() {
            let Some(residual) = residual.as_ref().filter(|_| data.counts) else { continue };
            let by_reading = residual.by_turn * residual.rotation.by_reading().column(axis);
            let weighted = model.rotation_weight(i, residual) * by_reading;
            for (k, by_parameter) in residual.by_parameters.column_iter().enumerate() {
                of_rotations[k] -= by_parameter.dot(&weighted);
            }
        }
        for (j, (hold, force)) in model.holds.iter().zip(&fit.state.forces).enumerate() {
            let Some((_, weight)) = &hold.gyroscope else { continue };
            let (stimulus, temperature_c) = (model.earth.rate(j, force), hold.temperature_c);
            let at = Condition { imu, stimulus, force: *force, temperature_c };
            let shapes = force.push(model.gravity) / model.gravity;
            for k in model.gyroscope_places() {
                let weighted = model.quantities[k].derivative(&at)[axis] * weight[axis];
                of_holds
                    .iter_mut()
                    .zip(shapes.iter())
                    .for_each(|(gradient, shape)| gradient[k] += weighted * shape);
            }
        }
        // an axis that hardly turns has the same error in the rotations as in the holds
        of_holds[0] += &of_rotations;
        let all = of_holds.into_iter().chain([of_rotations]);
        all.map(|gradient| (covariance * gradient, found.mean_sd)).collect::<Vec<_>>()
    };
    coarse.iter().flat_map(of).collect()
}

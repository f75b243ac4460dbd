//! The covariance of the estimates.
//!
//! The noise gives the inverse of the information. Gravity's uncertainty, coarse steps that many readings have in common, and the unknown rate of
//! the Earth add to it.

use crate::error::Result;
use crate::estimate::gravity_error::gravity_slope;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use crate::estimate::imu::variance_components::rotations::RotationWeights;
use crate::estimate::imu::variance_components::solution::Solution;
use crate::estimate::quantisation::CoarseAxis;
use crate::information;
use crate::motion::Gravity;
use crate::sensor::Condition;
use nalgebra::{DMatrix, DVector};

/// How uncertain the estimates are, and why.
pub(crate) struct Uncertainty {
    pub(crate) covariance: DMatrix<f64>,
    /// What share of each quantity's information came from what was known beforehand, 0 to 1.
    pub(crate) prior_share: Vec<f64>,
    /// How each estimate follows the Earth's rate about the vertical, by one standard deviation of that, where it is unknown.
    pub(crate) of_vertical: Option<DVector<f64>>,
    /// Root mean square of each component of the Earth's rate about the north, rad/s.
    pub(crate) north_rms_radps: f64,
}

impl Uncertainty {
    /// Of a solution. `coarse`: the axes of the gyroscope whose steps are coarse.
    pub(crate) fn of(
        model: &ImuModel<'_>,
        solution: &Solution,
        g: &Gravity,
        coarse: &[CoarseAxis],
    ) -> Result<Self> {
        let imu = &solution.fit.state.imu;
        let mut covariance = information::covariance(&solution.fit.information).ok_or_else(singular)?;
        let prior_share: Vec<f64> = (0..model.quantities.len())
            .map(|k| {
                model
                    .prior
                    .as_ref()
                    .map_or(0.0, |(_, weight)| (weight[k] * covariance[(k, k)]).clamp(0.0, 1.0))
            })
            .collect();
        // what gravity's own uncertainty adds
        let slope = gravity_slope(&model.quantities, imu, g);
        covariance += &slope * slope.transpose() * (g.sd_mps2 * g.sd_mps2);
        // what coarse steps add: holds that show nearly the same are off alike
        let of_noise = covariance.clone();
        for (slope, sd) in common_slopes(model, &solution.fit, coarse, &of_noise) {
            covariance += &slope * slope.transpose() * (sd * sd);
        }
        let (of_vertical, north_rms_radps) = add_earth(model, &solution.weighed, &mut covariance)?;
        Ok(Self { covariance, prior_share, of_vertical, north_rms_radps })
    }
}

/// What the unknown rate of the Earth adds to a covariance: `D C Dᵀ`, with `C` that of its unknowns and `D = −K C⁻¹` how the estimates follow them, `K` the covariance of both. Gives how each
/// estimate follows the rate about the vertical, by one standard deviation of that, where it is unknown, and how large that about the north is.
fn add_earth(
    model: &ImuModel<'_>,
    weighed: &RotationWeights,
    covariance: &mut DMatrix<f64>,
) -> Result<(Option<DVector<f64>>, f64)> {
    let (places, all) = (model.gyroscope_places(), &weighed.covariance);
    let count = all.nrows() - places.len();
    let mut both = DMatrix::zeros(covariance.nrows(), count);
    for (row, &k) in places.iter().enumerate() {
        both.row_mut(k).copy_from(&all.view((row, places.len()), (1, count)));
    }
    let own = all.view((places.len(), places.len()), (count, count)).into_owned();
    let of_vertical =
        model.earth.has_vertical().then(|| both.column(0) / own[(0, 0)].max(f64::MIN_POSITIVE).sqrt());
    let north_rms_radps = model.earth.north_rms(&own);
    let follow = own.cholesky().ok_or_else(singular)?.solve(&both.transpose());
    *covariance += both * follow;
    Ok((of_vertical, north_rms_radps))
}

/// For each coarse axis of the gyroscope: how the estimates follow errors that its means in the holds, or its readings in the rotations, have in common, and their size. Holds that read nearly the
/// same are rounded alike; what the force changes of the reading is then stretched or shrunk, so that a part of the error follows the force.
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
        for (residual, data) in fit.residuals.iter().zip(&model.rotations) {
            let Some(residual) = residual.as_ref().filter(|_| data.counts) else { continue };
            let by_reading = residual.by_turn * residual.rotation.by_reading().column(axis);
            let weighted = model.rotation_weight(residual) * by_reading;
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
        // an axis that hardly turns in the rotations is off by the same in these as in the holds
        of_holds[0] += &of_rotations;
        let all = of_holds.into_iter().chain([of_rotations]);
        all.map(|gradient| (covariance * gradient, found.mean_sd)).collect::<Vec<_>>()
    };
    coarse.iter().flat_map(of).collect()
}

//! A quantity that is known beforehand: `μ − p`, of the datasheet or of `[known]`.

use crate::estimate::imu::model::ImuModel;
use crate::estimate::imu::terms::term::{At, ByQuantities, Derivatives, Place, Residual, Term, Weight};
use nalgebra::{Matrix3xX, Vector3};

#[derive(Debug)]
pub(crate) struct Known;

impl Term for Known {
    fn rows(&self) -> usize {
        1
    }

    fn place(&self) -> Place {
        Place::Alone
    }

    fn count(&self, model: &ImuModel<'_>) -> usize {
        model.prior.as_ref().map_or(0, |(mean, _)| mean.len())
    }

    fn residual(&self, at: &At<'_>, k: usize) -> Option<Residual> {
        let (mean, weight) = at.model.prior.as_ref()?;
        let off = mean[k] - at.model.quantities[k].value(&at.state.imu);
        let of = |value: f64| Vector3::new(value, 0.0, 0.0);
        (weight[k] > 0.0).then(|| Residual { r: of(off), weight: Weight::Rows(of(weight[k])) })
    }

    fn derivatives(&self, _: &At<'_>, k: usize) -> Derivatives {
        let mut by_quantities = ByQuantities::zeros();
        by_quantities[(0, k)] = 1.0;
        Derivatives { by_directions: [None; 2], by_quantities }
    }

    fn by_earth(&self, at: &At<'_>, k: usize) -> Matrix3xX<f64> {
        let mut by = Matrix3xX::zeros(at.model.earth.unknowns().len());
        let taken = at.model.earth.taken_off(at.model.quantities[k], &at.state.imu);
        if taken != 0.0 {
            by[(0, 0)] = -taken;
        }
        by
    }
}

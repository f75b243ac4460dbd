//! A rotation between two holds: the arc from `f_k` to `Rᵀ (f_i + T ω_i × f_i)`, two numbers.
//!
//! `R` is the rotation by the gyroscope (`integration`) and `T` its duration, during which the Earth turns by `T ω_i`.

use crate::estimate::imu::least_squares::sphere_logarithm::Arc;
use crate::estimate::imu::model::{GravityResidual, GravityResiduals, ImuModel, RotationData, State};
use crate::estimate::imu::terms::term::{At, ByQuantities, Derivatives, Place, Residual, Term, Weight};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::SensorKind;
use nalgebra::{Matrix2, Matrix2xX, Matrix3, Matrix3xX};
use rayon::prelude::*;

#[derive(Debug)]
pub(crate) struct Rotation;

impl Term for Rotation {
    fn rows(&self) -> usize {
        2
    }

    fn place(&self) -> Place {
        Place::BetweenHolds
    }

    fn count(&self, model: &ImuModel<'_>) -> usize {
        model.rotations.len()
    }

    fn residual(&self, at: &At<'_>, k: usize) -> Option<Residual> {
        let residual = at.rotations[k].as_ref().filter(|_| at.model.rotations[k].counts)?;
        let weight = at.model.rotation_weight(k, residual).fixed_resize(0.0);
        Some(Residual { r: -residual.error.push(0.0), weight: Weight::Full(weight) })
    }

    fn derivatives(&self, at: &At<'_>, k: usize) -> Derivatives {
        let mut by_quantities = ByQuantities::zeros();
        let Some(of) = &at.rotations[k] else {
            return Derivatives { by_directions: [None; 2], by_quantities };
        };
        by_quantities.view_mut((0, 0), of.by_parameters.shape()).copy_from(&of.by_parameters);
        let by_directions = [of.by_from, of.by_to].map(|by| Some(by.fixed_resize(0.0)));
        Derivatives { by_directions, by_quantities }
    }

    fn by_earth(&self, at: &At<'_>, k: usize) -> Matrix3xX<f64> {
        let (model, state) = (at.model, at.state);
        let of = |residual: &GravityResidual| {
            model.earth.of_rotation(&model.rotations[k], residual, &state.imu, &state.forces)
        };
        let none = || Matrix2xX::zeros(model.earth.unknowns().len());
        at.rotations[k].as_ref().map_or_else(none, of).insert_row(2, 0.0)
    }
}

impl ImuModel<'_> {
    /// The residual of a rotation at a state. `None` if the gyroscope's matrix is singular.
    pub(crate) fn gravity_residual(&self, data: &RotationData<'_>, state: &State) -> Option<GravityResidual> {
        let rotation = data.samples.integrate(&state.imu, &self.gyroscope_noise.of_sample)?;
        let [before, to] = [0, 1].map(|end| state.forces[data.from + end] + data.beside_means[end]);
        // gravity after the Earth's rotation during this time
        let from = before + self.earth.rate(data.from, &before).cross(&before) * data.samples.duration_s();
        let back = rotation.start_from_end.transpose();
        let arc = Arc::of(&(back * from / self.gravity), &(to / self.gravity));
        let by_turn = arc.by_missing * back * (from / self.gravity).cross_matrix();
        let mut by_parameters = Matrix2xX::zeros(self.quantities.len());
        for (k, quantity) in self.quantities.iter().enumerate() {
            if quantity.sensor_kind() == SensorKind::Gyroscope {
                by_parameters.set_column(k, &(by_turn * rotation.derivative(*quantity, &state.imu)));
            }
        }
        // an axis that hardly turns reads as in a hold
        let by_reading = rotation.by_reading();
        let of_steps =
            by_reading * Matrix3::from_diagonal(&self.gyroscope_noise.of_mean) * by_reading.transpose();
        // a knock's attitude is not known well enough for the direction of its error
        let of_knocks =
            (rotation.correction * data.knocks.covariance * rotation.correction.transpose()).trace();
        Some(GravityResidual {
            error: arc.error,
            by_from: arc.by_missing * back * tangents(&before),
            by_to: arc.by_missed,
            by_turn,
            by_parameters,
            covariance: by_turn * (rotation.covariance + of_steps) * by_turn.transpose(),
            of_knocks: by_turn * by_turn.transpose() * of_knocks,
            rotation,
        })
    }

    /// Weight of a rotation.
    pub(crate) fn rotation_weight(&self, rotation: usize, residual: &GravityResidual) -> Matrix2<f64> {
        self.rotation_scatter.covariance(rotation, residual).try_inverse().unwrap_or_else(Matrix2::zeros)
    }

    /// The residuals of all rotations that can be integrated.
    pub(crate) fn gravity_residuals(&self, state: &State) -> Option<GravityResiduals> {
        self.rotations
            .par_iter()
            .map(|data| if data.used { self.gravity_residual(data, state).map(Some) } else { Some(None) })
            .collect()
    }
}

//! The residuals of the model at a state, and their χ². `gauss_newton` lists them.

use crate::estimate::imu::least_squares::sphere_logarithm::Arc;
use crate::estimate::imu::model::{GravityResidual, GravityResiduals, ImuModel, RotationData, State};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::SensorKind;
use nalgebra::{Matrix2, Matrix2xX, Matrix3, Vector3};
use rayon::prelude::*;

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

    pub(crate) fn chi2(&self, state: &State, residuals: &[Option<GravityResidual>]) -> f64 {
        let weighted = |r: Vector3<f64>, w: &Vector3<f64>| r.component_mul(&r).dot(w);
        let imu = &state.imu;
        let holds: f64 = self
            .holds
            .iter()
            .zip(&state.forces)
            .enumerate()
            .map(|(j, (hold, force))| {
                let imu = imu.at(hold.temperature_c);
                let r = hold.accelerometer - imu.accelerometer.reading(force);
                let own = r.dot(&(hold.accelerometer_weight * r));
                own + hold
                    .gyroscope
                    .as_ref()
                    .map_or(0.0, |(mean, weight)| weighted(mean - self.at_rest(j, &imu, force), weight))
            })
            .sum();
        let rotations: f64 = residuals
            .iter()
            .zip(&self.rotations)
            .enumerate()
            .filter(|(_, (_, data))| data.counts)
            .filter_map(|(i, (residual, _))| Some((i, residual.as_ref()?)))
            .map(|(i, residual)| residual.error.dot(&(self.rotation_weight(i, residual) * residual.error)))
            .sum();
        let turns: f64 =
            self.turns.iter().map(|turn| weighted(self.turn_residual(turn, imu), &turn.weight)).sum();
        let prior = self.prior.as_ref().map_or(0.0, |(mean, weight)| {
            let off = self.quantities.iter().zip(mean.iter().zip(weight));
            off.map(|(quantity, (mean, weight))| (mean - quantity.value(imu)).powi(2) * weight).sum()
        });
        holds + rotations + turns + prior
    }
}

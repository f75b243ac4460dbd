//! The Earth's rate in the rotations: the horizontal directions from hold to hold, and the effect on the rotation errors.
//!
//! See `earth_rate`.

use crate::estimate::imu::earth_rate::EarthRate;
use crate::estimate::imu::model::{GravityResidual, RotationData};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::ImuParameters;
use nalgebra::{DVector, Matrix2xX, Matrix3x2, Vector3};
use std::ops::AddAssign;

/// An unused rotation breaks the chain if its error exceeds this, rad. The heading may have the same error.
const BROKEN_RAD: f64 = 0.05;

impl EarthRate {
    /// Derivative of a rotation error.
    pub(crate) fn of_rotation(
        &self,
        data: &RotationData<'_>,
        residual: &GravityResidual,
        imu: &ImuParameters,
        forces: &[Vector3<f64>],
    ) -> Matrix2xX<f64> {
        let temperatures_c = data.samples.drift.map(|end| end.temperature_c);
        let ends = [0, 1].map(|k| {
            let hold = data.from + k;
            self.of_hold(hold, &imu.at(temperatures_c[k]), &forces[hold])
        });
        let mut by_angle = residual.rotation.by_readings_at_ends(&ends);
        if let Some((chain, horizontal)) = self.seen.get(data.from) {
            let mut north = by_angle.fixed_columns_mut::<2>(self.first_of(*chain));
            north -= horizontal * (self.north_sd * data.samples.duration_s());
        }
        if let Some(by_force) = self.by_force(&imu.at(data.samples.temperature_c())) {
            by_angle.column_mut(0).add_assign(&residual.rotation.by_g_sensitivity(&by_force));
        }
        residual.by_turn * by_angle
    }

    /// Propagates the horizontal directions from hold to hold. If the chains change, their rates become unknown.
    pub(crate) fn follow(
        &mut self,
        rotations: &[RotationData<'_>],
        residuals: &[Option<GravityResidual>],
        forces: &[Vector3<f64>],
    ) {
        if residuals.iter().all(Option::is_none) {
            return;
        }
        let mut seen: Vec<(usize, Matrix3x2<f64>)> = Vec::with_capacity(forces.len());
        for (j, force) in forces.iter().enumerate() {
            let propagated = seen.last().and_then(|(chain, horizontal)| {
                let residual = residuals[j - 1].as_ref()?;
                let is_whole = rotations[j - 1].counts || residual.error.norm() < BROKEN_RAD;
                let before = horizontal.column(0).into_owned();
                let turned = forces[j - 1].cross(&before)
                    * (self.vertical_rate() * rotations[j - 1].samples.duration_s());
                let east = residual.rotation.start_from_end.tr_mul(&(before + turned));
                let up = force.normalize();
                let east = (east - up * up.dot(&east)).try_normalize(0.5).filter(|_| is_whole)?;
                Some((*chain, Matrix3x2::from_columns(&[east, up.cross(&east)])))
            });
            let next = seen.last().map_or(0, |(chain, _)| chain + 1);
            seen.push(propagated.unwrap_or_else(|| (next, tangents(force))));
        }
        let chains =
            |seen: &[(usize, Matrix3x2<f64>)]| seen.iter().map(|(chain, _)| *chain).collect::<Vec<_>>();
        if chains(&seen) != chains(&self.seen) {
            let size = self.first_of(seen.last().map_or(0, |(chain, _)| chain + 1));
            let vertical = self.unknowns.get(0).copied().filter(|_| self.has_vertical());
            self.unknowns = DVector::zeros(size);
            if let Some(vertical) = vertical {
                self.unknowns[0] = vertical;
            }
        }
        self.seen = seen;
    }
}

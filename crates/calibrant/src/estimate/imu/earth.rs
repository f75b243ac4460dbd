//! The Earth's rate as far as it is not known: one vector of the world, which each hold sees in its own attitude.
//!
//! A sensor at rest turns by `κ f + E h`: `κ f` about the vertical, `κ = Ω sin φ/g` at the latitude φ, and `E h` about the north, with `E` two horizontal directions in the frame of the sensor. From hold
//! to hold the gyroscope itself carries them, `E_k = Rᵀ E_j` less the Earth's own turn, with gravity where the holds show it; where no rotation can be followed another chain of holds begins, whose heading has nothing to do with that
//! before. The unknowns are `h` (2 numbers for each chain) and, at an unknown latitude, `κ`, each in standard deviations of what is known of it beforehand:
//!
//! | latitude | rate about the vertical | each component of `h` |
//! |---|---|---|
//! | known | `Ω sin φ` | `0 ± Ω cos φ/√2` |
//! | unknown | `0 ± Ω/√3` | `0 ± Ω/√3` |
//!
//! A rate about the vertical looks like a g-sensitivity `S κ`. So where entries of `Γ` are estimated, what the readings tell is `Γ + S κ` of these, which stands for `Γ` in the linear problem: `κ` then
//! moves the readings only by the entries that are fixed, and what is known of `Γ` beforehand. `Γ` itself is had again by taking `S κ` off. Other variables would leave `κ` to rounding.
//!
//! In a rotation that lasts `T` the Earth turns gravity by `T E h` in the frame of the start. That is the angle `−T E h` for the gyroscope, to first order in `ΩT`, 1e-4. Turns of known angle know `κ` alone.

use super::ImuSetup;
use super::joint::{Miss, RotationData};
use crate::estimate::earth::UNKNOWN_SD_RADPS;
use crate::estimate::tangents::tangents;
use crate::sensor::{ImuParameters, ImuQuantity};
use nalgebra::{DMatrix, DVector, Matrix2xX, Matrix3, Matrix3x2, Matrix3xX, Vector3};
use std::ops::AddAssign;

/// A rotation that is left out breaks the chain where it misses gravity by more than this, rad: by as much the heading may be off.
const BROKEN: f64 = 0.05;

/// What is known of the Earth's rate.
#[derive(Debug, Clone)]
pub(super) struct Earth {
    gravity: f64,
    /// `κ` as it was given, 0 where it was not, (rad/s)/(m/s²).
    given: f64,
    /// Standard deviation of the rate about the vertical, where that is unknown, rad/s.
    vertical_sd: Option<f64>,
    /// Standard deviation of each component of the rate about the north, rad/s.
    north_sd: f64,
    /// 1 for the entries of the g-sensitivity that are not estimated, 0 for the others.
    fixed: Matrix3<f64>,
    /// The unknowns in standard deviations: the vertical one, where it is one, and two for each chain.
    unknowns: DVector<f64>,
    /// The chain of each hold and its horizontal directions; empty before any are carried.
    seen: Vec<(usize, Matrix3x2<f64>)>,
}

impl Earth {
    /// As it is known beforehand.
    pub(super) fn of(setup: &ImuSetup, quantities: &[ImuQuantity]) -> Self {
        let mut fixed = Matrix3::repeat(1.0);
        for quantity in quantities {
            if let ImuQuantity::GSensitivity(row, column) = quantity {
                fixed[(row.index(), column.index())] = 0.0;
            }
        }
        let vertical_sd = setup.latitude_deg.is_none().then_some(UNKNOWN_SD_RADPS);
        let place =
            Self::at_place(setup.vertical_rate(), setup.north_sd(), setup.holds.gravity.magnitude_mps2);
        Self { vertical_sd, fixed, unknowns: DVector::zeros(usize::from(vertical_sd.is_some())), ..place }
    }

    /// With this rate about the vertical over gravity, (rad/s)/(m/s²), and this standard deviation of each component of that about the north, rad/s.
    pub(super) fn at_place(given: f64, north_sd: f64, gravity: f64) -> Self {
        Self {
            gravity,
            given,
            vertical_sd: None,
            north_sd,
            fixed: Matrix3::zeros(),
            unknowns: DVector::zeros(0),
            seen: Vec::new(),
        }
    }

    /// `κ` as it was given, 0 where it was not, (rad/s)/(m/s²).
    pub(super) fn given(&self) -> f64 {
        self.given
    }

    /// `κ`, (rad/s)/(m/s²).
    pub(super) fn vertical_rate(&self) -> f64 {
        self.given + self.vertical_sd.map_or(0.0, |sd| self.unknowns[0] * sd / self.gravity)
    }

    /// The rate of the sensor in a hold with this specific force, rad/s.
    pub(super) fn rate(&self, hold: usize, force: &Vector3<f64>) -> Vector3<f64> {
        let north = self.seen.get(hold).map_or_else(Vector3::zeros, |(chain, horizontal)| {
            let first = self.first_of(*chain);
            horizontal * self.unknowns.fixed_rows::<2>(first) * self.north_sd
        });
        force * self.vertical_rate() + north
    }

    /// The same beyond what was given.
    pub(super) fn rate_found(&self, hold: usize, force: &Vector3<f64>) -> Vector3<f64> {
        self.rate(hold, force) - force * self.given
    }

    /// The unknowns, in standard deviations.
    pub(super) fn unknowns(&self) -> &DVector<f64> {
        &self.unknowns
    }

    /// Is the rate about the vertical the first of them?
    pub(super) fn has_vertical(&self) -> bool {
        self.vertical_sd.is_some()
    }

    /// Place of the first unknown of a chain.
    fn first_of(&self, chain: usize) -> usize {
        usize::from(self.has_vertical()) + 2 * chain
    }

    /// Derivative of what an IMU at its temperature reads in a hold with respect to the unknowns.
    pub(super) fn of_hold(&self, hold: usize, imu: &ImuParameters, force: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut by = self.of_turn(imu, force);
        if let Some((chain, horizontal)) = self.seen.get(hold) {
            let readings = imu.gyroscope.matrix * horizontal * self.north_sd;
            by.fixed_columns_mut::<2>(self.first_of(*chain)).copy_from(&readings);
        }
        by
    }

    /// Derivative of what its readings add up to in a turn whose specific force adds up to this, m/s.
    pub(super) fn of_turn(&self, imu: &ImuParameters, force: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut by = Matrix3xX::zeros(self.unknowns.len());
        if let Some(by_force) = self.by_force(imu) {
            by.set_column(0, &(by_force * force));
        }
        by
    }

    /// Derivative of what a rotation misses gravity by.
    pub(super) fn of_rotation(
        &self,
        data: &RotationData<'_>,
        miss: &Miss,
        imu: &ImuParameters,
        forces: &[Vector3<f64>],
    ) -> Matrix2xX<f64> {
        let temperatures_c = data.samples.drift.map(|end| end.temperature_c);
        let ends = [0, 1].map(|k| {
            let hold = data.from + k;
            self.of_hold(hold, &imu.at(temperatures_c[k]), &forces[hold])
        });
        let mut by_angle = miss.rotation.by_readings_at_ends(&ends);
        if let Some((chain, horizontal)) = self.seen.get(data.from) {
            let mut north = by_angle.fixed_columns_mut::<2>(self.first_of(*chain));
            north -= horizontal * (self.north_sd * data.samples.duration_s());
        }
        if let Some(by_force) = self.by_force(&imu.at(data.samples.temperature_c())) {
            by_angle.column_mut(0).add_assign(&miss.rotation.by_g_sensitivity(&by_force));
        }
        miss.by_turn * by_angle
    }

    /// The g-sensitivity that the rate about the vertical is, by one standard deviation, in the entries that are not estimated; `None` where that rate is known.
    fn by_force(&self, imu: &ImuParameters) -> Option<Matrix3<f64>> {
        let of_fixed = |sd: f64| imu.gyroscope.matrix.component_mul(&self.fixed) * (sd / self.gravity);
        self.vertical_sd.map(of_fixed)
    }

    /// What the first unknown takes off an estimated quantity.
    pub(super) fn taken_off(&self, quantity: ImuQuantity, imu: &ImuParameters) -> f64 {
        match (quantity, self.vertical_sd) {
            (ImuQuantity::GSensitivity(row, column), Some(sd)) => {
                imu.gyroscope.matrix[(row.index(), column.index())] * sd / self.gravity
            }
            _ => 0.0,
        }
    }

    /// Carries the horizontal directions from hold to hold. Where chains begin or end elsewhere than before, nothing is known of their rates any more.
    pub(super) fn follow(
        &mut self,
        rotations: &[RotationData<'_>],
        misses: &[Option<Miss>],
        forces: &[Vector3<f64>],
    ) {
        if misses.iter().all(Option::is_none) {
            return;
        }
        let mut seen: Vec<(usize, Matrix3x2<f64>)> = Vec::with_capacity(forces.len());
        for (j, force) in forces.iter().enumerate() {
            let carried = seen.last().and_then(|(chain, horizontal)| {
                let miss = misses[j - 1].as_ref()?;
                let is_whole = rotations[j - 1].counts || miss.error.norm() < BROKEN;
                let before = horizontal.column(0).into_owned();
                let turned = forces[j - 1].cross(&before)
                    * (self.vertical_rate() * rotations[j - 1].samples.duration_s());
                let east = miss.rotation.start_from_end.tr_mul(&(before + turned));
                let up = force.normalize();
                let east = (east - up * up.dot(&east)).try_normalize(0.5).filter(|_| is_whole)?;
                Some((*chain, Matrix3x2::from_columns(&[east, up.cross(&east)])))
            });
            let next = seen.last().map_or(0, |(chain, _)| chain + 1);
            seen.push(carried.unwrap_or_else(|| (next, tangents(force))));
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

    /// Root mean square of what each component of the rate about the north may be, as found with this covariance of the unknowns, rad/s.
    pub(super) fn north_rms(&self, covariance: &DMatrix<f64>) -> f64 {
        let first = self.first_of(0);
        let count = self.unknowns.len() - first;
        let square = |k: usize| self.unknowns[k].powi(2) + covariance[(k, k)];
        match count {
            0 => self.north_sd,
            _ => self.north_sd * ((first..first + count).map(square).sum::<f64>() / count as f64).sqrt(),
        }
    }

    /// Takes a step.
    pub(super) fn step(&mut self, step: impl Iterator<Item = f64>) {
        self.unknowns.iter_mut().zip(step).for_each(|(unknown, step)| *unknown += step);
    }
}

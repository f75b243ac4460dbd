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
//! How the directions are carried is in `least_squares/earth_rate.rs`.
//!
//! In a rotation that lasts `T` the Earth turns gravity by `T E h` in the frame of the start. That is the angle `−T E h` for the gyroscope, to first order in `ΩT`, 1e-4. Turns of known angle know `κ` alone.

use crate::estimate::earth::UNKNOWN_SD_RADPS;
use crate::estimate::imu::problem::ImuSetup;
use crate::sensor::{ImuParameters, ImuQuantity};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x2, Matrix3xX, Vector3};

/// What is known of the Earth's rate.
#[derive(Debug, Clone)]
pub(crate) struct EarthRate {
    pub(crate) gravity: f64,
    /// `κ` as it was given, 0 where it was not, (rad/s)/(m/s²).
    pub(crate) given: f64,
    /// Standard deviation of the rate about the vertical, where that is unknown, rad/s.
    pub(crate) vertical_sd: Option<f64>,
    /// Standard deviation of each component of the rate about the north, rad/s.
    pub(crate) north_sd: f64,
    /// 1 for the entries of the g-sensitivity that are not estimated, 0 for the others.
    pub(crate) fixed: Matrix3<f64>,
    /// The unknowns in standard deviations: the vertical one, where it is one, and two for each chain.
    pub(crate) unknowns: DVector<f64>,
    /// The chain of each hold and its horizontal directions; empty before any are carried.
    pub(crate) seen: Vec<(usize, Matrix3x2<f64>)>,
}

impl EarthRate {
    /// As it is known beforehand.
    pub(crate) fn of(setup: &ImuSetup, quantities: &[ImuQuantity]) -> Self {
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
    pub(crate) fn at_place(given: f64, north_sd: f64, gravity: f64) -> Self {
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
    pub(crate) fn given(&self) -> f64 {
        self.given
    }

    /// `κ`, (rad/s)/(m/s²).
    pub(crate) fn vertical_rate(&self) -> f64 {
        self.given + self.vertical_sd.map_or(0.0, |sd| self.unknowns[0] * sd / self.gravity)
    }

    /// The rate of the sensor in a hold with this specific force, rad/s.
    pub(crate) fn rate(&self, hold: usize, force: &Vector3<f64>) -> Vector3<f64> {
        let north = self.seen.get(hold).map_or_else(Vector3::zeros, |(chain, horizontal)| {
            let first = self.first_of(*chain);
            horizontal * self.unknowns.fixed_rows::<2>(first) * self.north_sd
        });
        force * self.vertical_rate() + north
    }

    /// The same beyond what was given.
    pub(crate) fn rate_found(&self, hold: usize, force: &Vector3<f64>) -> Vector3<f64> {
        self.rate(hold, force) - force * self.given
    }

    /// The unknowns, in standard deviations.
    pub(crate) fn unknowns(&self) -> &DVector<f64> {
        &self.unknowns
    }

    /// Is the rate about the vertical the first of them?
    pub(crate) fn has_vertical(&self) -> bool {
        self.vertical_sd.is_some()
    }

    /// Place of the first unknown of a chain.
    pub(crate) fn first_of(&self, chain: usize) -> usize {
        usize::from(self.has_vertical()) + 2 * chain
    }

    /// Derivative of what an IMU at its temperature reads in a hold with respect to the unknowns.
    pub(crate) fn of_hold(&self, hold: usize, imu: &ImuParameters, force: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut by = self.of_turn(imu, force);
        if let Some((chain, horizontal)) = self.seen.get(hold) {
            let readings = imu.gyroscope.matrix * horizontal * self.north_sd;
            by.fixed_columns_mut::<2>(self.first_of(*chain)).copy_from(&readings);
        }
        by
    }

    /// Derivative of what its readings add up to in a turn whose specific force adds up to this, m/s.
    pub(crate) fn of_turn(&self, imu: &ImuParameters, force: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut by = Matrix3xX::zeros(self.unknowns.len());
        if let Some(by_force) = self.by_force(imu) {
            by.set_column(0, &(by_force * force));
        }
        by
    }

    /// The g-sensitivity that the rate about the vertical is, by one standard deviation, in the entries that are not estimated; `None` where that rate is known.
    pub(crate) fn by_force(&self, imu: &ImuParameters) -> Option<Matrix3<f64>> {
        let of_fixed = |sd: f64| imu.gyroscope.matrix.component_mul(&self.fixed) * (sd / self.gravity);
        self.vertical_sd.map(of_fixed)
    }

    /// What the first unknown takes off an estimated quantity.
    pub(crate) fn taken_off(&self, quantity: ImuQuantity, imu: &ImuParameters) -> f64 {
        match (quantity, self.vertical_sd) {
            (ImuQuantity::GSensitivity(row, column), Some(sd)) => {
                imu.gyroscope.matrix[(row.index(), column.index())] * sd / self.gravity
            }
            _ => 0.0,
        }
    }

    /// Root mean square of what each component of the rate about the north may be, as found with this covariance of the unknowns, rad/s.
    pub(crate) fn north_rms(&self, covariance: &DMatrix<f64>) -> f64 {
        let first = self.first_of(0);
        let count = self.unknowns.len() - first;
        let square = |k: usize| self.unknowns[k].powi(2) + covariance[(k, k)];
        match count {
            0 => self.north_sd,
            _ => self.north_sd * ((first..first + count).map(square).sum::<f64>() / count as f64).sqrt(),
        }
    }

    /// Takes a step.
    pub(crate) fn step(&mut self, step: impl Iterator<Item = f64>) {
        self.unknowns.iter_mut().zip(step).for_each(|(unknown, step)| *unknown += step);
    }
}

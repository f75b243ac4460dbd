//! The unknown part of the Earth's rate: one vector in the world, which each hold sees in its own attitude.
//!
//! A sensor at rest turns by `κ f + E h`. `κ f` is the rate about the vertical, with `κ = Ω sin φ/g` at the latitude φ. `E h` is the rate about the north, with
//! `E` two horizontal directions in the frame of the sensor. The gyroscope propagates them from hold to hold, `E_k = Rᵀ E_j` less the Earth's own rotation,
//! with gravity from the holds. If a rotation cannot be followed, a new chain of holds begins, with an independent heading. The unknowns are `h` (2 numbers
//! for each chain) and, at an unknown latitude, `κ`. Each is in its prior standard deviations:
//!
//! | latitude | rate about the vertical | each component of `h` |
//! |---|---|---|
//! | known | `Ω sin φ` | `0 ± Ω cos φ/√2` |
//! | unknown | `0 ± Ω/√3` | `0 ± Ω/√3` |
//!
//! A rate about the vertical looks like a g-sensitivity `S κ`. If entries of `Γ` are estimated, the readings determine `Γ + S κ`, which replaces `Γ` in the
//! linear problem. `κ` then acts only through the fixed entries and the prior of `Γ`. Subtracting `S κ` gives `Γ` again. With other variables, rounding
//! would decide `κ`.
//!
//! `least_squares/earth_rate.rs` propagates the directions.
//!
//! In a rotation of duration `T` the Earth turns gravity by `T E h` in the frame of the start. For the gyroscope this is the angle `−T E h`, to first order
//! in `ΩT`, 1e-4. Turns of known angle depend on `κ` only.

use crate::estimate::earth::UNKNOWN_SD_RADPS;
use crate::estimate::imu::problem::ImuSetup;
use crate::sensor::{ImuParameters, ImuQuantity, SensorKind};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x2, Matrix3xX, Vector3};

/// The Earth's rate: given values and unknowns.
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
    /// The chain of each hold and its horizontal directions. Empty before the first propagation.
    pub(crate) seen: Vec<(usize, Matrix3x2<f64>)>,
}

impl EarthRate {
    /// The prior.
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

    /// The rate in a hold beyond the given one, rad/s.
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

    /// Derivative of an IMU's reading in a hold with respect to the unknowns, at its temperature.
    pub(crate) fn of_hold(&self, hold: usize, imu: &ImuParameters, force: &Vector3<f64>) -> Matrix3xX<f64> {
        let mut by = self.of_turn(imu, force);
        if let Some((chain, horizontal)) = self.seen.get(hold) {
            let readings = imu[SensorKind::Gyroscope].matrix * horizontal * self.north_sd;
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

    /// The g-sensitivity that looks like one standard deviation of the rate about the vertical, in the fixed entries. `None` if that rate is known.
    pub(crate) fn by_force(&self, imu: &ImuParameters) -> Option<Matrix3<f64>> {
        let of_fixed =
            |sd: f64| imu[SensorKind::Gyroscope].matrix.component_mul(&self.fixed) * (sd / self.gravity);
        self.vertical_sd.map(of_fixed)
    }

    /// The part of an estimated quantity that belongs to the first unknown.
    pub(crate) fn taken_off(&self, quantity: ImuQuantity, imu: &ImuParameters) -> f64 {
        match (quantity, self.vertical_sd) {
            (ImuQuantity::GSensitivity(row, column), Some(sd)) => {
                imu[SensorKind::Gyroscope].matrix[(row.index(), column.index())] * sd / self.gravity
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

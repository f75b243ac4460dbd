//! The end of a fit against gravity at rest: of holds, of known faces, of an IMU by hand.

use super::budget::BudgetRow;
use super::hold_result::HoldCalibration;
use super::result::{Calibration, FitStatistics, Recovered};
use crate::sensor::{ImuParameters, ImuQuantity, Parameter, PerSensor, ReadingUnit};
use crate::solve::{CalibrationStatus, Uncertainty};

/// What a fit found.
pub(super) struct AtRest {
    pub(super) quantities: Vec<ImuQuantity>,
    pub(super) parameters: Vec<Parameter>,
    pub(super) units: PerSensor<Option<ReadingUnit>>,
    pub(super) imu: ImuParameters,
    /// That of the estimates, before that of gravity.
    pub(super) uncertainty: Uncertainty,
    pub(super) holds: HoldCalibration,
    pub(super) fit: FitStatistics,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

impl AtRest {
    /// The result, of which nothing is judged.
    pub(super) fn calibration(self) -> Calibration {
        let Self { quantities, imu, mut uncertainty, holds, .. } = self;
        // means alone show no noise of a sample
        let shows_noise = holds.holds.iter().any(|result| result.hold.samples() > 1);
        let noise_estimate = self.fit.noise_estimate.filter(|_| shows_noise);
        let slope = uncertainty.add_gravity(&quantities, &imu, &holds.gravity);
        Calibration {
            status: self.status,
            iterations: self.iterations,
            gradient_norm: self.gradient_norm,
            parameters: self.parameters,
            values: quantities.iter().map(|quantity| quantity.value(&imu)).collect(),
            budget: BudgetRow::all(&uncertainty, &quantities),
            prior_share: uncertainty.prior_share().unwrap_or_default(),
            covariance: uncertainty.covariance,
            gravity_slope: slope.iter().copied().collect(),
            datasheet_prior: false,
            quantities,
            imu,
            units: self.units,
            counts_per_unit: PerSensor::default(),
            fit: FitStatistics { noise_estimate, ..self.fit },
            recovered: Recovered::Holds(holds),
            gyroscope: None,
            soak: None,
            soak_prior: Vec::new(),
            changes: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

//! The calibration of an outcome: by holds or a commanded motion, or on a machine.

use calibrant_core::estimate::Calibration;
use calibrant_io::{MachineLogInput, MachineResult};
use calibrant_machine::estimate::{MachineCalibration, MachineSetup, MachineValidation};

/// What was calibrated, and how.
#[derive(Debug, Clone)]
pub enum Calibrated {
    /// By holds or a commanded motion.
    Sensors(Box<Calibration>),
    /// On a machine whose motion was logged.
    OnMachine(Box<MachineOutcome>),
}

impl Calibrated {
    /// The sensors' parameters, their covariance, and what judges them, whatever moved the sensors.
    #[must_use]
    pub fn sensors(&self) -> &Calibration {
        match self {
            Self::Sensors(calibration) => calibration,
            Self::OnMachine(machine) => &machine.calibration.sensors,
        }
    }

    pub(crate) fn sensors_mut(&mut self) -> &mut Calibration {
        match self {
            Self::Sensors(calibration) => calibration,
            Self::OnMachine(machine) => &mut machine.calibration.sensors,
        }
    }

    /// What was found of the machine, where the calibration is on one.
    #[must_use]
    pub fn machine(&self) -> Option<&MachineOutcome> {
        match self {
            Self::Sensors(_) => None,
            Self::OnMachine(machine) => Some(machine),
        }
    }
}

/// A calibration on a machine, with what was known of the machine.
#[derive(Debug, Clone)]
pub struct MachineOutcome {
    /// The calibration.
    pub calibration: MachineCalibration,
    /// What was known beforehand.
    pub setup: MachineSetup,
    /// The log of the motion.
    pub log: MachineLogInput,
    /// How it fares with other data, where the options ask for it.
    pub validations: Vec<MachineValidation>,
}

impl MachineOutcome {
    /// As files take it.
    #[must_use]
    pub fn result(&self) -> MachineResult<'_> {
        let Self { calibration, setup, log, validations } = self;
        MachineResult { calibration, setup, log, validations }
    }
}

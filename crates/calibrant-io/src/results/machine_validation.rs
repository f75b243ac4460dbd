//! A validation on a machine as JSON: how far the parameters move with other data.

use calibrant_core::json::{if_any, if_some};
use calibrant_core::json_object;
use calibrant_machine::estimate::{FailedBlock, MachineValidation, MachineValidationSource, ParameterShift};
use std::collections::BTreeMap;

/// A validation, with the names of the joints.
pub(crate) struct ValidationOf<'a> {
    pub(crate) validation: &'a MachineValidation,
    pub(crate) joints: &'a [String],
}

json_object! {
    /// How far the parameters of each sensor move with other data.
    ValidationOf<'_> as of {
        /// The other recording.
        file: if_some(of.recording()),
        /// Number of blocks of time.
        folds: if_some(of.blocks().map(|(folds, ..)| folds)),
        /// Length of a block.
        block_s: if_some(of.blocks().map(|(_, length_s, _)| length_s)),
        /// Blocks without which there is no calibration.
        failed_folds: if_any(of.blocks().map_or(&[][..], |(.., failed)| failed)),
        /// Of each sensor, by its name.
        parameters: of.shifts(),
    }
}

/// The movement of one sensor's parameters, with the names of the joints.
struct ShiftOf<'a> {
    shift: &'a ParameterShift,
    joints: &'a [String],
}

json_object! {
    /// The movement of one sensor's parameters beside what their covariance predicts.
    ShiftOf<'_> as of {
        /// χ² of the movement, with its predicted covariance.
        chi2: of.shift.chi2,
        /// Its degrees of freedom.
        degrees_of_freedom: of.shift.degrees_of_freedom,
        /// By how much the standard deviations are too small.
        factor: of.shift.factor,
        /// The 99 % confidence interval of the factor.
        factor_interval_99: <[f64; 2]>::from(of.shift.factor_interval),
        /// What follows of the covariance.
        verdict: of.shift.verdict.name(),
        /// The parameter that moves most.
        largest: LargestOf { shift: of.shift, joints: of.joints },
    }
}

struct LargestOf<'a> {
    shift: &'a ParameterShift,
    joints: &'a [String],
}

json_object! {
    LargestOf<'_> as of {
        /// Which parameter it is.
        parameter: of.shift.largest.quantity.name(of.joints),
        /// In the unit of the parameter.
        shift: of.shift.largest.shift,
        /// In predicted standard deviations.
        in_sd: of.shift.largest.in_sd,
        /// Beginning of the block that was left out.
        without_s: if_some(of.shift.largest.without_s),
    }
}

impl<'a> ValidationOf<'a> {
    /// By what a file names it.
    pub(crate) fn name(validation: &MachineValidation) -> &'static str {
        match validation.source {
            MachineValidationSource::Recording { .. } => "recording",
            MachineValidationSource::Blocks { .. } => "folds",
        }
    }

    fn recording(&self) -> Option<&'a str> {
        match &self.validation.source {
            MachineValidationSource::Recording { name } => Some(name),
            MachineValidationSource::Blocks { .. } => None,
        }
    }

    fn blocks(&self) -> Option<(usize, f64, &'a [FailedBlock])> {
        match &self.validation.source {
            MachineValidationSource::Blocks { folds, length_s, failed } => Some((*folds, *length_s, failed)),
            MachineValidationSource::Recording { .. } => None,
        }
    }

    fn shifts(&self) -> BTreeMap<&'static str, ShiftOf<'a>> {
        let joints = self.joints;
        self.validation.shifts.iter().map(|shift| (shift.sensor.name(), ShiftOf { shift, joints })).collect()
    }
}

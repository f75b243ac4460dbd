//! Validation by blocks of time, and on another recording.

mod cross_validation;
mod machine_validation;

pub use cross_validation::{check_folds, cross_validate_on_machine};
pub use machine_validation::{
    FailedBlock, LargestShift, MachineValidation, MachineValidationSource, ParameterShift, compare_on_machine,
};
pub(crate) use machine_validation::{Movement, judged, widened};

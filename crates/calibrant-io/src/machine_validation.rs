//! The fields of a validation on a machine: how far the parameters move with other data.

use calibrant_machine::estimate::{MachineValidation, MachineValidationSource, ParameterShift};
use serde::Serialize;
use std::collections::BTreeMap;

/// `validation`: its data (`recording`, `folds`) and the results.
pub(super) type ValidationFields = BTreeMap<&'static str, SourceFields>;

#[derive(Serialize)]
pub(super) struct SourceFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    folds: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    block_s: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed_folds: Vec<FailedFields>,
    /// Of each sensor, by its name.
    parameters: BTreeMap<String, ShiftFields>,
}

#[derive(Serialize)]
struct FailedFields {
    start_s: f64,
    end_s: f64,
    reason: String,
}

#[derive(Serialize)]
struct ShiftFields {
    chi2: f64,
    degrees_of_freedom: usize,
    factor: f64,
    factor_interval_99: [f64; 2],
    verdict: &'static str,
    largest: LargestFields,
}

#[derive(Serialize)]
struct LargestFields {
    parameter: String,
    shift: f64,
    in_sd: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    without_s: Option<f64>,
}

/// All validations; `None` where there is none.
pub(super) fn validation_fields(
    validations: &[MachineValidation],
    joints: &[String],
) -> Option<ValidationFields> {
    let fields: ValidationFields = validations.iter().map(|of| named(of, joints)).collect();
    (!fields.is_empty()).then_some(fields)
}

fn named(validation: &MachineValidation, joints: &[String]) -> (&'static str, SourceFields) {
    let of_sensor = |of: &ParameterShift| (of.sensor.to_string(), ShiftFields::of(of, joints));
    let none = SourceFields {
        file: None,
        folds: None,
        block_s: None,
        failed_folds: Vec::new(),
        parameters: validation.shifts.iter().map(of_sensor).collect(),
    };
    match &validation.source {
        MachineValidationSource::Recording { name } => {
            ("recording", SourceFields { file: Some(name.clone()), ..none })
        }
        MachineValidationSource::Blocks { folds, length_s, failed } => {
            let failed = failed.iter().map(|block| FailedFields {
                start_s: block.start_s,
                end_s: block.end_s,
                reason: block.reason.clone(),
            });
            let (folds, block_s) = (Some(*folds), Some(*length_s));
            ("folds", SourceFields { folds, block_s, failed_folds: failed.collect(), ..none })
        }
    }
}

impl ShiftFields {
    fn of(shift: &ParameterShift, joints: &[String]) -> Self {
        let largest = &shift.largest;
        Self {
            chi2: shift.chi2,
            degrees_of_freedom: shift.degrees_of_freedom,
            factor: shift.factor,
            factor_interval_99: shift.factor_interval.into(),
            verdict: shift.verdict.name(),
            largest: LargestFields {
                parameter: largest.quantity.name(joints),
                shift: largest.shift,
                in_sd: largest.in_sd,
                without_s: largest.without_s,
            },
        }
    }
}

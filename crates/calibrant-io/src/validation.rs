//! The fields of a calibration's validation in its JSON file: its errors on data that it did not use.

use super::shared_fields::per_axis;
use calibrant_core::estimate::{
    BiasShift, Caveat, LikelyExplanation, ParameterPart, UnusedError, ValidatedErrors, Validation,
    ValidationSource,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// `validation`: its data (`recording`, `folds`) and the results.
pub(super) type ValidationFields = BTreeMap<&'static str, SourceFields>;

/// The result on one kind of data; the kinds of errors by their names.
#[derive(Serialize)]
pub(super) struct SourceFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    folds: Option<usize>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed_folds: Vec<FailedFields>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    noise_ratio: BTreeMap<String, Vec<f64>>,
    /// The quantisation step in the unit of the readings.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    coarse_step: BTreeMap<String, f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gyroscope_bias_shift: Option<ShiftFields>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "likely_reasons")]
    likely_explanations: Vec<ReasonFields>,
    #[serde(flatten)]
    kinds: BTreeMap<&'static str, KindFields>,
}

/// A likely explanation, and its numbers by their names.
#[derive(Serialize)]
struct ReasonFields {
    reason: &'static str,
    #[serde(flatten)]
    numbers: BTreeMap<&'static str, Vec<f64>>,
}

#[derive(Serialize)]
struct FailedFields {
    first_hold_index: usize,
    last_hold_index: usize,
    reason: String,
}

#[derive(Serialize)]
struct ShiftFields {
    shift_radps: Vec<f64>,
    shift_sd_radps: Vec<f64>,
    p_value: f64,
    moved: bool,
}

#[derive(Serialize)]
struct KindFields {
    unit: &'static str,
    errors: usize,
    counted: usize,
    distinct: usize,
    rms: f64,
    predicted_rms: f64,
    chi2: f64,
    degrees_of_freedom: usize,
    p_value: f64,
    factor: f64,
    factor_interval_99: [f64; 2],
    verdict: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    #[serde(rename = "doubt")]
    caveat: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<PartFields>,
    table: Vec<ErrorFields>,
}

#[derive(Serialize)]
struct PartFields {
    chi2: f64,
    degrees_of_freedom: usize,
    p_value: f64,
    factor: f64,
    /// An entry is `null` where the data leave the bound open.
    factor_interval_99: [Option<f64>; 2],
}

#[derive(Serialize)]
struct ErrorFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    from_hold_index: Option<usize>,
    hold_index: usize,
    start_s: f64,
    end_s: f64,
    fold_index: usize,
    error: Vec<f64>,
    predicted_sd: Vec<f64>,
    in_sd: f64,
    counts: bool,
}

/// All validations of a calibration; `None` where there is none.
pub(super) fn validation_fields(validations: &[Validation]) -> Option<ValidationFields> {
    let fields: ValidationFields = validations.iter().map(named).collect();
    (!fields.is_empty()).then_some(fields)
}

fn named(validation: &Validation) -> (&'static str, SourceFields) {
    let kinds = validation.kinds.iter().map(|errors| (errors.kind.name(), KindFields::of(errors))).collect();
    let gyroscope_bias_shift = validation.bias_shift.as_ref().map(ShiftFields::of);
    let ratios = validation.noise.iter();
    let steps = ratios
        .clone()
        .filter_map(|noise| Some((noise.sensor_kind.to_string(), noise.coarse.map(|of| of.step)?)));
    let none = SourceFields {
        file: None,
        folds: None,
        failed_folds: Vec::new(),
        coarse_step: steps.collect(),
        noise_ratio: ratios.map(|noise| (noise.sensor_kind.to_string(), per_axis(&noise.axes, 3))).collect(),
        gyroscope_bias_shift,
        likely_explanations: validation.reasons.iter().map(ReasonFields::of).collect(),
        kinds,
    };
    match &validation.source {
        ValidationSource::Recording { name } => {
            ("recording", SourceFields { file: Some(name.clone()), ..none })
        }
        ValidationSource::Folds { folds, failed } => {
            let failed = failed.iter().map(|fold| FailedFields {
                first_hold_index: fold.holds.0,
                last_hold_index: fold.holds.1,
                reason: fold.reason.clone(),
            });
            ("folds", SourceFields { folds: Some(*folds), failed_folds: failed.collect(), ..none })
        }
    }
}

impl ReasonFields {
    fn of(reason: &LikelyExplanation) -> Self {
        let numbers = match reason {
            LikelyExplanation::Temperature { calibrated_c, here_c } => {
                vec![("calibrated_mean_c", vec![*calibrated_c]), ("mean_c", vec![*here_c])]
            }
            LikelyExplanation::BeyondTemperatures { calibrated_c, here_c } => {
                vec![("calibrated_range_c", calibrated_c.to_vec()), ("range_c", here_c.to_vec())]
            }
            LikelyExplanation::AccelerometerBias { shift_mps2, sd_mps2 } => {
                vec![("shift_mps2", per_axis(shift_mps2, 3)), ("shift_sd_mps2", per_axis(sd_mps2, 3))]
            }
            LikelyExplanation::AccelerometerGain { change, sd }
            | LikelyExplanation::GyroscopeGain { change, sd } => {
                vec![("change", per_axis(change, 3)), ("change_sd", per_axis(sd, 3))]
            }
            LikelyExplanation::AccelerometerBiasAndGain { shift_mps2, shift_sd_mps2, change, change_sd } => {
                vec![
                    ("shift_mps2", per_axis(shift_mps2, 3)),
                    ("shift_sd_mps2", per_axis(shift_sd_mps2, 3)),
                    ("change", per_axis(change, 3)),
                    ("change_sd", per_axis(change_sd, 3)),
                ]
            }
            LikelyExplanation::AngularUnit { factor } => vec![("factor", vec![*factor])],
        };
        Self { reason: reason.name(), numbers: numbers.into_iter().collect() }
    }
}

impl ShiftFields {
    fn of(shift: &BiasShift) -> Self {
        Self {
            shift_radps: per_axis(&shift.shift_radps, 3),
            shift_sd_radps: per_axis(&shift.sd_radps, 3),
            p_value: shift.p_value,
            moved: shift.moved,
        }
    }
}

impl KindFields {
    fn of(errors: &ValidatedErrors) -> Self {
        Self {
            unit: errors.kind.unit(),
            errors: errors.errors.len(),
            counted: errors.counted(),
            distinct: errors.distinct,
            rms: errors.rms,
            predicted_rms: errors.predicted_rms,
            chi2: errors.chi2,
            degrees_of_freedom: errors.degrees_of_freedom,
            p_value: errors.p_value,
            factor: errors.factor,
            factor_interval_99: [errors.factor_interval.0, errors.factor_interval.1],
            verdict: errors.verdict.name(),
            caveat: errors.caveat.as_ref().map(Caveat::name),
            parameters: errors.parameters.as_ref().map(PartFields::of),
            table: errors.errors.iter().map(ErrorFields::of).collect(),
        }
    }
}

impl PartFields {
    fn of(part: &ParameterPart) -> Self {
        let (low, high) = part.factor_interval;
        Self {
            chi2: part.chi2,
            degrees_of_freedom: part.degrees_of_freedom,
            p_value: part.p_value,
            factor: part.factor,
            factor_interval_99: [low, high].map(|limit| limit.is_finite().then_some(limit)),
        }
    }
}

impl ErrorFields {
    fn of(error: &UnusedError) -> Self {
        Self {
            from_hold_index: error.from_hold,
            hold_index: error.hold,
            start_s: error.start_s,
            end_s: error.end_s,
            fold_index: error.fold,
            error: error.error.iter().copied().collect(),
            predicted_sd: error.predicted_sd.iter().copied().collect(),
            in_sd: error.in_sd,
            counts: error.counts,
        }
    }
}

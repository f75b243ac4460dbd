//! The fields of a calibration study: truth and estimate of a population of simulated sensors.

use crate::shared_fields::{FitFields, MotionFields, axes_of};
use calibrant_core::estimate::Recovered;
use calibrant_core::sensor::{Parameter, ParameterList};
use calibrant_study::{ParameterSummary, SensorOutcome, SingleCase, Study};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct StudyFields<'a> {
    seed: u64,
    trust: &'static str,
    rate_hz: f64,
    reading_unit: &'static str,
    parameters: Vec<ParameterFields<'a>>,
    motion: MotionFields,
    summary: Vec<SummaryFields<'a>>,
    sensors: Vec<OutcomeFields<'a>>,
    single: CaseFields,
    fine: CaseFields,
}

#[derive(Serialize)]
pub(super) struct ParameterFields<'a> {
    name: &'a str,
    unit: &'static str,
    nominal: Option<f64>,
    spread_sd: Option<f64>,
}

#[derive(Serialize)]
pub(super) struct SummaryFields<'a> {
    name: &'a str,
    unit: &'static str,
    predicted_sd: f64,
    realised_rms: f64,
    mean_error: f64,
    coverage_95: f64,
}

/// Values in the order and the units of the parameters.
#[derive(Serialize)]
struct OutcomeFields<'a> {
    status: &'static str,
    p_value: Option<f64>,
    truth: &'a [f64],
    value: &'a [f64],
    sd: &'a [f64],
}

#[derive(Serialize)]
struct CaseFields {
    rate_hz: f64,
    samples: usize,
    status: &'static str,
    parameters: Vec<CaseParameter>,
    fit: FitFields,
    true_motion: MotionFields,
    recovered_motion: Option<MotionFields>,
}

#[derive(Serialize)]
struct CaseParameter {
    name: String,
    unit: &'static str,
    truth: f64,
    value: f64,
    sd: f64,
}

impl<'a> StudyFields<'a> {
    pub(super) fn of(study: &'a Study) -> Self {
        let axes = axes_of(&study.parameters);
        let list = study.sensor.parameter_list();
        let outcome = |outcome: &'a SensorOutcome| OutcomeFields {
            status: outcome.status,
            p_value: outcome.p_value,
            truth: &outcome.truth,
            value: &outcome.values,
            sd: &outcome.sd,
        };
        Self {
            seed: study.seed,
            trust: study.trust,
            rate_hz: study.rate_hz,
            reading_unit: study.sensor.unit.symbol(),
            parameters: study.parameters.iter().map(ParameterFields::of).collect(),
            motion: MotionFields::of(&study.motion, axes, None),
            summary: study.summary.iter().map(SummaryFields::of).collect(),
            sensors: study.outcomes.iter().map(outcome).collect(),
            single: CaseFields::of(&study.single, &list, axes),
            fine: CaseFields::of(&study.fine, &list, axes),
        }
    }
}

impl<'a> ParameterFields<'a> {
    pub(super) fn of(parameter: &'a Parameter) -> Self {
        Self {
            name: &parameter.name,
            unit: parameter.unit,
            nominal: parameter.nominal,
            spread_sd: parameter.spread,
        }
    }
}

impl<'a> SummaryFields<'a> {
    pub(super) fn of(summary: &'a ParameterSummary) -> Self {
        Self {
            name: &summary.name,
            unit: summary.unit,
            predicted_sd: summary.predicted_sd,
            realised_rms: summary.realised_rms,
            mean_error: summary.mean_error,
            coverage_95: summary.coverage_95,
        }
    }
}

impl CaseFields {
    fn of(case: &SingleCase, list: &ParameterList, axes: usize) -> Self {
        let calibration = &case.calibration;
        let estimates = calibration.values.iter().zip(calibration.sd());
        let parameters = list
            .quantities()
            .iter()
            .zip(estimates)
            .map(|(quantity, (&value, sd))| CaseParameter {
                name: quantity.name(),
                unit: quantity.unit(calibration.accelerometer_unit),
                truth: quantity.value(&case.truth),
                value,
                sd,
            })
            .collect();
        Self {
            rate_hz: case.recording.rate_hz(),
            samples: case.recording.len(),
            status: calibration.status.name(),
            parameters,
            fit: FitFields::of(&calibration.fit, calibration.accelerometer_unit, axes),
            true_motion: MotionFields::of(&case.true_motion, axes, None),
            recovered_motion: match &calibration.recovered {
                Recovered::Motion(recovered) => {
                    Some(MotionFields::of(&recovered.motion, axes, Some(&recovered.acceleration_sd_mps2)))
                }
                Recovered::Holds(_) => None,
            },
        }
    }
}

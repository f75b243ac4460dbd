//! The fields of a design study: initial against optimal motion, sensor by sensor.

use super::calibration::{ParameterFields, SummaryFields};
use crate::design::{CertificateFields, EvaluationFields, InputNoiseFields, LimitsFields};
use crate::shared_fields::{MotionFields, axes_of};
use calibrant_core::motion::{KnownEnds, Trust};
use calibrant_study::{DesignOutcome, DesignStudy, Factor, Improvement, MotionOutcome, TraceRange};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct DesignStudyFields<'a> {
    seed: u64,
    trust: &'static str,
    known_ends: &'static str,
    input_noise: Option<InputNoiseFields>,
    intervals: usize,
    interval_s: f64,
    rate_hz: f64,
    reading_unit: &'static str,
    limits: LimitsFields,
    criterion: &'static str,
    criterion_formula: &'static str,
    starts: usize,
    datasheet_prior: bool,
    initial_given: bool,
    parameters: Vec<ParameterFields<'a>>,
    summary: Vec<ImprovementFields<'a>>,
    trace: TraceFields,
    motions_shown: usize,
    sensors: Vec<OutcomeFields<'a>>,
    first_design: DesignFields<'a>,
}

/// Factors are initial over optimal: above 1 the optimal motion is better.
#[derive(Serialize)]
struct ImprovementFields<'a> {
    initial: SummaryFields<'a>,
    optimal: SummaryFields<'a>,
    predicted_factor: f64,
    predicted_factor_standard_error: Option<f64>,
    realised_factor: f64,
    realised_factor_standard_error: Option<f64>,
}

#[derive(Serialize)]
struct TraceFields {
    initial: RangeFields,
    optimal: RangeFields,
}

#[derive(Serialize)]
struct RangeFields {
    least: f64,
    median: f64,
    most: f64,
}

/// Values in the order and the units of the parameters.
#[derive(Serialize)]
struct OutcomeFields<'a> {
    truth: &'a [f64],
    initial: MotionOutcomeFields<'a>,
    optimal: MotionOutcomeFields<'a>,
    design_status: &'static str,
}

#[derive(Serialize)]
struct MotionOutcomeFields<'a> {
    status: &'static str,
    p_value: Option<f64>,
    value: &'a [f64],
    sd: &'a [f64],
    absolute_error: Vec<f64>,
    trace: f64,
    predicted_criterion: f64,
    motion: MotionFields,
}

/// The design of the first sensor.
#[derive(Serialize)]
struct DesignFields<'a> {
    status: &'static str,
    starts: usize,
    starts_converged: usize,
    iterations: usize,
    certificate: Option<CertificateFields<'a>>,
    initial: EvaluationFields<'a>,
    optimal: EvaluationFields<'a>,
}

impl<'a> DesignStudyFields<'a> {
    pub(super) fn of(study: &'a DesignStudy) -> Self {
        let axes = axes_of(&study.parameters);
        let design = &study.design;
        let evaluation =
            |evaluation| EvaluationFields::of(evaluation, &design.criterion, &design.parameters, axes);
        Self {
            seed: study.seed,
            trust: study.trust.name(),
            known_ends: match study.known_ends {
                KnownEnds::Start => "start",
                KnownEnds::Both => "both",
            },
            input_noise: match study.trust {
                Trust::Noisy(noise) => Some(InputNoiseFields::of(&noise)),
                Trust::Known | Trust::Unknown => None,
            },
            intervals: study.intervals,
            interval_s: study.interval_s,
            rate_hz: study.rate_hz,
            reading_unit: study.sensor.unit.symbol(),
            limits: LimitsFields::of(&study.limits, axes),
            criterion: study.criterion.letter(),
            criterion_formula: study.criterion.formula(),
            starts: study.starts,
            datasheet_prior: study.datasheet_prior,
            initial_given: study.initial_given,
            parameters: study.parameters.iter().map(ParameterFields::of).collect(),
            summary: study.summary.iter().map(ImprovementFields::of).collect(),
            trace: TraceFields {
                initial: RangeFields::of(&study.trace.initial),
                optimal: RangeFields::of(&study.trace.optimal),
            },
            motions_shown: study.motions_shown,
            sensors: study.outcomes.iter().map(|outcome| OutcomeFields::of(outcome, axes)).collect(),
            first_design: DesignFields {
                status: design.status.name(),
                starts: design.starts.len(),
                starts_converged: design.starts_converged(),
                iterations: design.iterations,
                certificate: design
                    .certificate
                    .as_ref()
                    .map(|certificate| CertificateFields::of(certificate, &design.parameters)),
                initial: evaluation(&design.initial),
                optimal: evaluation(&design.optimal),
            },
        }
    }
}

impl<'a> ImprovementFields<'a> {
    fn of(improvement: &'a Improvement) -> Self {
        let Improvement { initial, optimal, predicted, realised } = improvement;
        let error = |factor: &Factor| factor.standard_error;
        Self {
            initial: SummaryFields::of(initial),
            optimal: SummaryFields::of(optimal),
            predicted_factor: predicted.value,
            predicted_factor_standard_error: error(predicted),
            realised_factor: realised.value,
            realised_factor_standard_error: error(realised),
        }
    }
}

impl RangeFields {
    fn of(range: &TraceRange) -> Self {
        Self { least: range.least, median: range.median, most: range.most }
    }
}

impl<'a> OutcomeFields<'a> {
    fn of(outcome: &'a DesignOutcome, axes: usize) -> Self {
        let fields = |motion: &'a MotionOutcome| MotionOutcomeFields {
            status: motion.status,
            p_value: motion.p_value,
            value: &motion.values,
            sd: &motion.sd,
            absolute_error: motion.absolute_errors(&outcome.truth),
            trace: motion.trace,
            predicted_criterion: motion.predicted_criterion,
            motion: MotionFields::of(&motion.motion, axes, None),
        };
        Self {
            truth: &outcome.truth,
            initial: fields(&outcome.initial),
            optimal: fields(&outcome.optimal),
            design_status: outcome.design_status.name(),
        }
    }
}

//! Writes `design.json`: a design with everything needed to repeat it, to judge it and to drive the arm.

use super::json;
use super::reach::{ReachFields, Reached};
use super::shared_fields::{InUnit, MotionFields, matrix_rows, per_axis};
use calibrant_core::error::{Result, UndeterminedGroup};
use calibrant_core::information::Criterion;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, Rest, Trust};
use calibrant_core::sensor::{Parameter, SensorModel};
use calibrant_design::{
    Certificate, Design, DesignProblem, DesignSettings, Evaluation, LimitUse, StartOutcome, limit_use,
};
use nalgebra::{DMatrix, Vector3};
use serde::Serialize;
use std::path::Path;

/// Writes `design.json`.
///
/// The same design gives the same bytes. Arrays over axes have 1 or 3 entries. Entry (i, j) of a covariance
/// is in the unit of parameter i times that of parameter j. It is `null` where the motion does not determine
/// the parameters.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_design(
    path: &Path,
    design: &Design,
    reached: Option<&Reached>,
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
) -> Result<()> {
    json::write_json(path, &DesignFile::of(design, reached, problem, settings))
}

/// The text that [`write_design`] writes.
#[must_use]
pub fn design_json(
    design: &Design,
    reached: Option<&Reached>,
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
) -> String {
    json::to_json(&DesignFile::of(design, reached, problem, settings))
}

#[derive(Serialize)]
struct DesignFile<'a> {
    schema: u32,
    program: String,
    status: &'static str,
    statement: String,
    #[serde(flatten)]
    optimal: EvaluationFields<'a>,
    certificate: Option<CertificateFields<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    floor: Option<FloorFields<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reach: Option<ReachFields>,
    limits: LimitsFields,
    limit_use: Vec<LimitUseFields>,
    initial: EvaluationFields<'a>,
    solver: SolverFields,
    setting: SettingFields,
}

impl<'a> DesignFile<'a> {
    fn of(
        design: &'a Design,
        reached: Option<&Reached>,
        problem: &DesignProblem<'_>,
        settings: &DesignSettings,
    ) -> Self {
        let names: Vec<String> = design.parameters.iter().map(|parameter| parameter.name.clone()).collect();
        let axes = problem.sensor.axes;
        Self {
            schema: 1,
            program: crate::atomic_output::program(),
            status: design.status.name(),
            statement: design.statement(),
            optimal: EvaluationFields::of(&design.optimal, &design.criterion, &design.parameters, axes),
            certificate: design
                .certificate
                .as_ref()
                .map(|certificate| CertificateFields::of(certificate, &design.parameters)),
            floor: FloorFields::of(design),
            reach: reached.map(|reached| ReachFields::of(reached, &names)),
            limits: LimitsFields::of(&design.limits, axes),
            limit_use: LimitUseFields::all(&limit_use(&design.limits, axes, &design.optimal.motion)),
            initial: EvaluationFields::of(&design.initial, &design.criterion, &design.parameters, axes),
            solver: SolverFields::of(design),
            setting: SettingFields::of(problem, settings),
        }
    }
}

/// A motion and the information that it gives.
#[derive(Serialize)]
pub(super) struct EvaluationFields<'a> {
    criterion: CriterionFields,
    parameters: Vec<PredictedFields<'a>>,
    covariance: Option<Vec<Vec<f64>>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    undetermined: Vec<UndeterminedFields<'a>>,
    motion: MotionFields,
}

impl<'a> EvaluationFields<'a> {
    pub(super) fn of(
        evaluation: &'a Evaluation,
        criterion: &Criterion,
        parameters: &'a [Parameter],
        axes: usize,
    ) -> Self {
        let predicted = |(parameter, sd): (&'a Parameter, f64)| PredictedFields {
            name: &parameter.name,
            unit: parameter.unit,
            nominal: parameter.nominal,
            spread_sd: parameter.spread,
            sd,
        };
        Self {
            criterion: CriterionFields {
                name: criterion.letter(),
                formula: criterion.formula(),
                value: evaluation.value,
            },
            parameters: parameters.iter().zip(evaluation.sd()).map(predicted).collect(),
            covariance: evaluation.covariance.as_ref().map(matrix_rows),
            undetermined: evaluation.undetermined.iter().map(UndeterminedFields::of).collect(),
            motion: MotionFields::of(&evaluation.motion, axes, None),
        }
    }
}

#[derive(Serialize)]
struct CriterionFields {
    name: &'static str,
    formula: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct PredictedFields<'a> {
    name: &'a str,
    unit: &'static str,
    nominal: Option<f64>,
    spread_sd: Option<f64>,
    sd: f64,
}

/// Parameters that the data cannot separate.
#[derive(Serialize)]
struct UndeterminedFields<'a> {
    parameters: &'a [String],
    free_combinations: usize,
    reason: &'a str,
    remedy: &'a str,
}

impl<'a> UndeterminedFields<'a> {
    fn of(group: &'a UndeterminedGroup) -> Self {
        Self {
            parameters: &group.parameters,
            free_combinations: group.free_combinations,
            reason: &group.reason,
            remedy: &group.remedy,
        }
    }
}

/// The lower bound.
#[derive(Serialize)]
pub(super) struct CertificateFields<'a> {
    lower_bound: f64,
    gap: f64,
    sd_lower_bounds: Vec<SdBoundFields<'a>>,
    explanation: &'a str,
}

#[derive(Serialize)]
struct SdBoundFields<'a> {
    name: &'a str,
    unit: &'static str,
    sd_lower_bound: f64,
}

impl<'a> CertificateFields<'a> {
    pub(super) fn of(certificate: &'a Certificate, parameters: &'a [Parameter]) -> Self {
        let bound = |(parameter, &sd_lower_bound): (&'a Parameter, &f64)| SdBoundFields {
            name: &parameter.name,
            unit: parameter.unit,
            sd_lower_bound,
        };
        Self {
            lower_bound: certificate.lower_bound,
            gap: certificate.gap,
            sd_lower_bounds: parameters.iter().zip(&certificate.sd_lower_bound).map(bound).collect(),
            explanation: &certificate.explanation,
        }
    }
}

/// What no motion changes: the share of gravity's tilt. The gap of the certificate is taken above it.
#[derive(Serialize)]
struct FloorFields<'a> {
    criterion_value: f64,
    sd: Vec<SdFloorFields<'a>>,
}

#[derive(Serialize)]
struct SdFloorFields<'a> {
    name: &'a str,
    unit: &'static str,
    sd: f64,
}

impl<'a> FloorFields<'a> {
    fn of(design: &'a Design) -> Option<Self> {
        let of_parameter = |(parameter, &sd): (&'a Parameter, &f64)| SdFloorFields {
            name: &parameter.name,
            unit: parameter.unit,
            sd,
        };
        let sd: Vec<_> = design.parameters.iter().zip(&design.floor_sd).map(of_parameter).collect();
        (!sd.is_empty()).then_some(Self { criterion_value: design.floor, sd })
    }
}

/// The given limits, with the sensor's range among them.
#[derive(Serialize)]
pub(super) struct LimitsFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    acceleration_mps2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    jerk_mps3: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    intercept_mps2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    velocity_mps: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    displacement_m: Option<Vec<f64>>,
    rest: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    start_acceleration_mps2: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    end_acceleration_mps2: Option<Vec<f64>>,
}

impl LimitsFields {
    pub(super) fn of(limits: &Limits, axes: usize) -> Self {
        let of = |limit: &Option<Vector3<f64>>| limit.as_ref().map(|limit| per_axis(limit, axes));
        Self {
            acceleration_mps2: of(&limits.acceleration_mps2),
            jerk_mps3: of(&limits.jerk_mps3),
            intercept_mps2: of(&limits.intercept_mps2),
            velocity_mps: of(&limits.velocity_mps),
            displacement_m: of(&limits.displacement_m),
            rest: match limits.rest {
                Rest::None => "none",
                Rest::Start => "start",
                Rest::Both => "both",
            },
            start_acceleration_mps2: of(&limits.start_acceleration_mps2),
            end_acceleration_mps2: of(&limits.end_acceleration_mps2),
        }
    }
}

/// How far a motion goes towards a limit. Value and limit are in the unit in which the limit's key ends.
#[derive(Serialize)]
pub(super) struct LimitUseFields {
    axis: String,
    limit: &'static str,
    unit: &'static str,
    time_s: f64,
    value: f64,
    allowed: f64,
    violation: f64,
    violated: bool,
}

impl LimitUseFields {
    pub(super) fn all(found: &[LimitUse]) -> Vec<Self> {
        let fields = |found: &LimitUse| Self {
            axis: found.axis.to_string(),
            limit: found.kind.key(),
            unit: found.kind.unit(),
            time_s: found.time_s,
            value: found.value,
            allowed: found.limit,
            violation: found.violation,
            violated: found.is_violated(),
        };
        found.iter().map(fields).collect()
    }
}

#[derive(Serialize)]
struct SolverFields {
    #[serde(skip_serializing_if = "Option::is_none")]
    gap_goal: Option<GapGoalFields>,
    starts: usize,
    starts_converged: usize,
    iterations: usize,
    outcomes: Vec<StartFields>,
}

/// The gap that the search was to reach.
#[derive(Serialize)]
struct GapGoalFields {
    gap: f64,
    reached: bool,
    most_starts: usize,
}

#[derive(Serialize)]
struct StartFields {
    axes: Vec<String>,
    number: usize,
    initial_value: f64,
    value: f64,
    iterations: usize,
    status: &'static str,
}

impl SolverFields {
    fn of(design: &Design) -> Self {
        let fields = |start: &StartOutcome| StartFields {
            axes: start.axes.iter().map(ToString::to_string).collect(),
            number: start.number,
            initial_value: start.initial_value,
            value: start.value,
            iterations: start.iterations,
            status: start.status.name(),
        };
        Self {
            gap_goal: design.gap_goal.map(|goal| GapGoalFields {
                gap: goal.gap,
                reached: design.gap_is_reached() == Some(true),
                most_starts: goal.most_starts,
            }),
            starts: design.starts.len(),
            starts_converged: design.starts_converged(),
            iterations: design.iterations,
            outcomes: design.starts.iter().map(fields).collect(),
        }
    }
}

/// The conditions of the experiment that was designed for.
#[derive(Serialize)]
pub(super) struct SettingFields {
    axes: usize,
    model: &'static str,
    reading_unit: &'static str,
    #[serde(flatten)]
    noise: InUnit<Option<Vec<f64>>>,
    intervals: usize,
    interval_s: f64,
    rate_hz: f64,
    trust: &'static str,
    known_ends: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    input_noise: Option<InputNoiseFields>,
    guess: Vec<f64>,
    prior_information: Option<Vec<Vec<f64>>>,
    starts: usize,
    seed: u64,
    certificate: bool,
    max_iterations: usize,
}

#[derive(Serialize)]
pub(super) struct InputNoiseFields {
    floor_mps3: f64,
    ratio: f64,
}

impl InputNoiseFields {
    pub(super) fn of(noise: &InputNoise) -> Self {
        Self { floor_mps3: noise.floor_mps3, ratio: noise.ratio }
    }
}

impl SettingFields {
    pub(super) fn of(problem: &DesignProblem<'_>, settings: &DesignSettings) -> Self {
        let sensor = problem.sensor;
        let noise = sensor.noise(&problem.at.matrix.diagonal().abs());
        let list = sensor.parameter_list();
        Self {
            axes: sensor.axes,
            model: match sensor.model {
                SensorModel::ScaleBias => "scale-bias",
                SensorModel::Full => "full",
            },
            reading_unit: sensor.unit.symbol(),
            noise: InUnit::new("noise", sensor.unit, noise.map(|noise| per_axis(&noise, sensor.axes))),
            intervals: problem.intervals,
            interval_s: problem.interval_s,
            rate_hz: problem.rate_hz,
            trust: problem.trust.name(),
            known_ends: match problem.known_ends {
                KnownEnds::Start => "start",
                KnownEnds::Both => "both",
            },
            input_noise: match problem.trust {
                Trust::Noisy(noise) => Some(InputNoiseFields::of(&noise)),
                Trust::Known | Trust::Unknown => None,
            },
            guess: list.quantities().iter().map(|quantity| quantity.value(&problem.at)).collect(),
            prior_information: problem.prior.as_ref().map(|prior: &DMatrix<f64>| matrix_rows(prior)),
            starts: settings.starts,
            seed: settings.seed,
            certificate: settings.certificate,
            max_iterations: settings.max_iterations,
        }
    }
}

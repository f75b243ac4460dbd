//! Writes the best poses, `design.json`, and the evaluation of holds.

use super::atomic_output::program;
use super::json;
use super::reach::{ReachFields, Reached};
use super::shared_fields::matrix_rows;
use calibrant_core::error::Result;
use calibrant_core::sensor::ReadingUnit;
use calibrant_design::poses::{DirectionKnowledge, PoseBound, PoseDesign, PoseEvaluation, PoseProblem};
use nalgebra::{DMatrix, Vector3};
use serde::Serialize;
use std::path::Path;

/// Writes the `design.json` of poses. The same design gives the same bytes.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_pose_design(
    path: &Path,
    design: &PoseDesign,
    reached: Option<&Reached>,
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> Result<()> {
    json::write_json(path, &design_file(design, reached, problem, unit))
}

/// The text that [`write_pose_design`] writes.
#[must_use]
pub fn pose_design_json(
    design: &PoseDesign,
    reached: Option<&Reached>,
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> String {
    json::to_json(&design_file(design, reached, problem, unit))
}

/// Writes the `evaluation.json` of holds.
///
/// # Errors
/// As [`write_pose_design`].
pub fn write_pose_evaluation(
    path: &Path,
    evaluation: &PoseEvaluation,
    directions: &[Vector3<f64>],
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> Result<()> {
    json::write_json(path, &evaluation_file(evaluation, directions, problem, unit))
}

/// The text that [`write_pose_evaluation`] writes.
#[must_use]
pub fn pose_evaluation_json(
    evaluation: &PoseEvaluation,
    directions: &[Vector3<f64>],
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> String {
    json::to_json(&evaluation_file(evaluation, directions, problem, unit))
}

#[derive(Serialize)]
struct PoseFile {
    schema: u32,
    program: String,
    kind: &'static str,
    status: &'static str,
    criterion: CriterionFields,
    parameters: Vec<PredictedFields>,
    covariance: Vec<Vec<f64>>,
    /// The direction that is up in each pose, in the sensor's axes.
    poses: Vec<[f64; 3]>,
    efficiency: f64,
    certificate: CertificateFields,
    #[serde(skip_serializing_if = "Option::is_none")]
    solver: Option<SolverFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reach: Option<ReachFields>,
    setting: SettingFields,
}

#[derive(Serialize)]
struct CriterionFields {
    name: &'static str,
    formula: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct PredictedFields {
    name: String,
    unit: &'static str,
    nominal: f64,
    sd: f64,
}

/// The bound, and the approximate design that gives it.
#[derive(Serialize)]
struct CertificateFields {
    lower_bound: f64,
    gap: f64,
    directions: Vec<[f64; 3]>,
    shares: Vec<f64>,
}

#[derive(Serialize)]
struct SolverFields {
    starts: usize,
    starts_at_best: usize,
}

#[derive(Serialize)]
struct SettingFields {
    poses: usize,
    gravity_mps2: f64,
    mean_sd: [f64; 3],
    directions: &'static str,
    direction_sd_rad: Option<f64>,
    has_prior: bool,
    gravity_sd_mps2: f64,
    bias_drift_sd: [f64; 3],
}

fn design_file(
    design: &PoseDesign,
    reached: Option<&Reached>,
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> PoseFile {
    let solver = SolverFields { starts: design.starts, starts_at_best: design.starts_at_best };
    PoseFile {
        kind: "poses",
        status: if design.interrupted { "interrupted" } else { "converged" },
        efficiency: design.efficiency(&problem.criterion),
        solver: Some(solver),
        reach: reached.map(|reached| ReachFields::of(reached, &problem.list.names())),
        ..file((&design.covariance, design.value, &design.bound), &design.directions, problem, unit)
    }
}

fn evaluation_file(
    evaluation: &PoseEvaluation,
    directions: &[Vector3<f64>],
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> PoseFile {
    PoseFile {
        kind: "evaluation of poses",
        efficiency: evaluation.efficiency,
        ..file((&evaluation.covariance, evaluation.value, &evaluation.bound), directions, problem, unit)
    }
}

/// The fields that a design and an evaluation share.
fn file(
    (covariance, value, bound): (&DMatrix<f64>, f64, &PoseBound),
    directions: &[Vector3<f64>],
    problem: &PoseProblem,
    unit: ReadingUnit,
) -> PoseFile {
    let rows = |vectors: &[Vector3<f64>]| vectors.iter().map(components).collect();
    let predicted = |(k, quantity): (usize, &calibrant_core::sensor::Quantity)| PredictedFields {
        name: quantity.name(),
        unit: quantity.unit(unit),
        nominal: quantity.value(&problem.at),
        sd: covariance[(k, k)].sqrt(),
    };
    let criterion = &problem.criterion;
    PoseFile {
        schema: 1,
        program: program(),
        kind: "",
        status: "converged",
        criterion: CriterionFields { name: criterion.letter(), formula: criterion.formula(), value },
        parameters: problem.list.quantities().iter().enumerate().map(predicted).collect(),
        covariance: matrix_rows(covariance),
        poses: rows(directions),
        efficiency: 0.0,
        certificate: CertificateFields {
            lower_bound: bound.value,
            gap: criterion.gap(value, bound.value),
            directions: rows(&bound.directions),
            shares: bound.shares.clone(),
        },
        solver: None,
        reach: None,
        setting: SettingFields {
            poses: directions.len(),
            gravity_mps2: problem.gravity_mps2,
            mean_sd: components(&problem.mean_sd),
            directions: match problem.directions {
                DirectionKnowledge::Unknown => "unknown",
                DirectionKnowledge::Known { .. } => "known",
            },
            direction_sd_rad: match problem.directions {
                DirectionKnowledge::Unknown => None,
                DirectionKnowledge::Known { sd_rad } => Some(sd_rad),
            },
            has_prior: problem.prior.is_some(),
            gravity_sd_mps2: problem.nuisance.gravity_sd_mps2,
            bias_drift_sd: components(&problem.nuisance.drift_sd),
        },
    }
}

fn components(v: &Vector3<f64>) -> [f64; 3] {
    [v.x, v.y, v.z]
}

//! Writes `evaluation.json`: a motion of the user's own, beside the best one and the limits.

use super::design::{CertificateFields, EvaluationFields, LimitUseFields, SettingFields};
use super::json;
use calibrant_core::error::Result;
use calibrant_design::{Assessment, DesignProblem, DesignSettings};
use serde::Serialize;
use std::path::Path;

/// Writes `evaluation.json`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_evaluation(
    path: &Path,
    assessment: &Assessment,
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
) -> Result<()> {
    json::write_json(path, &EvaluationFile::of(assessment, problem, settings))
}

/// The text that [`write_evaluation`] writes.
#[must_use]
pub fn evaluation_json(
    assessment: &Assessment,
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
) -> String {
    json::to_json(&EvaluationFile::of(assessment, problem, settings))
}

#[derive(Serialize)]
struct EvaluationFile<'a> {
    schema: u32,
    program: String,
    admissible: bool,
    determined: bool,
    efficiency: Option<f64>,
    efficiency_against_bound: Option<f64>,
    #[serde(flatten)]
    own: EvaluationFields<'a>,
    limit_use: Vec<LimitUseFields>,
    same_setting_as_experiment: bool,
    optimal: Option<EvaluationFields<'a>>,
    no_optimum_because: Option<&'a str>,
    certificate: Option<CertificateFields<'a>>,
    setting: SettingFields,
}

impl<'a> EvaluationFile<'a> {
    fn of(
        assessment: &'a Assessment,
        problem: &DesignProblem<'_>,
        settings: &DesignSettings,
    ) -> EvaluationFile<'a> {
        let axes = problem.sensor.axes;
        let fields = |evaluation| {
            EvaluationFields::of(evaluation, &assessment.criterion, &assessment.parameters, axes)
        };
        let optimum = assessment.optimum.as_ref().ok();
        Self {
            schema: 1,
            program: crate::atomic_output::program(),
            admissible: assessment.violations().is_empty(),
            determined: assessment.evaluation.covariance.is_some(),
            efficiency: assessment.efficiency(),
            efficiency_against_bound: assessment.certain_efficiency(),
            own: fields(&assessment.evaluation),
            limit_use: LimitUseFields::all(&assessment.limits),
            same_setting_as_experiment: assessment.other_setting.is_none(),
            optimal: optimum.map(|design| fields(&design.optimal)),
            no_optimum_because: assessment.optimum.as_ref().err().map(String::as_str),
            certificate: optimum
                .and_then(|design| design.certificate.as_ref())
                .map(|certificate| CertificateFields::of(certificate, &assessment.parameters)),
            setting: SettingFields::of(problem, settings),
        }
    }
}

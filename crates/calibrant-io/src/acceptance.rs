//! Verdict and limits as `calibration.json` states them.

use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::Verdict;
use serde::Serialize;

/// The verdict on a result.
#[derive(Serialize)]
pub(super) struct VerdictFields {
    usability: &'static str,
    codes: Vec<&'static str>,
}

impl VerdictFields {
    pub(super) fn of(verdict: &Verdict) -> Self {
        Self { usability: verdict.usability.name(), codes: verdict.code_names() }
    }
}

/// A figure beside its limit.
#[derive(Serialize)]
pub(super) struct LimitFields {
    name: String,
    value: Option<f64>,
    sd: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    largest_sd: Option<f64>,
    decision: &'static str,
}

impl LimitFields {
    pub(super) fn of(limit: &CheckedLimit) -> Self {
        Self {
            name: limit.figure.name.clone(),
            value: Some(limit.figure.value).filter(|value| value.is_finite()),
            sd: limit.figure.sd.filter(|sd| sd.is_finite()),
            range: limit.range.map(|(least, most)| [least, most]),
            largest_sd: limit.largest_sd,
            decision: limit.decision.name(),
        }
    }
}

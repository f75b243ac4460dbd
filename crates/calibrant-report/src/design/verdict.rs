//! The verdict on a design: how good is the motion, and what is the evidence?

use super::criterion::{excess_in_words, gap_in_words};
use super::limits::uses;
use super::predicted_sd::times;
use crate::About;
use crate::figure::DisplayUnit;
use crate::number_format::{capitalised, percent, significant};
use crate::sheet::{Grade, SheetVerdict};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::design::{SearchInterrupted, SearchNotConverged};
use calibrant_core::information::Criterion;
use calibrant_core::sensor::Parameter;
use calibrant_design::{Certificate, Design, DesignStatus, Evaluation, LimitKind, LimitUse};

/// A standard deviation within this share of its lower bound counts as optimal.
const PROVED: f64 = 0.01;
/// A motion within this factor of the bound leaves nothing to gain.
const NOTHING_TO_GAIN: f64 = 1.02;
/// Within this distance, the bound is still informative.
const NEAR: f64 = 0.1;

/// The verdict and everything that qualifies it.
pub(super) fn verdict(design: &Design, about: &About) -> SheetVerdict {
    let uses = uses(&design.limits, &design.parameters, &design.optimal.motion);
    let broken: Vec<String> = uses.iter().filter(|found| found.is_violated()).map(broken_limit).collect();
    let (grade, word, sentences) = judge(design, &broken);
    SheetVerdict::new(grade, word, sentences.join(" "))
        .with("Broken limits", broken)
        .with("Undetermined", undetermined_items(&design.optimal))
        .with("Findings", about.findings.clone())
}

fn judge(design: &Design, broken: &[String]) -> (Grade, String, Vec<String>) {
    if design.optimal.covariance.is_none() {
        let what = "No recording of this motion can calibrate the sensor: it leaves parameters undetermined. Loosen the limits, or \
                    move the named axes.";
        return (Grade::Bad, "✗ Useless for calibration.".into(), vec![what.to_string()]);
    }
    let mut sentences: Vec<String> =
        unfinished(design.status).map(|found| found.sentence()).into_iter().collect();
    let nearest = design.certificate.as_ref().map(|certificate| bound(design, certificate, &mut sentences));
    if design.certificate.is_none() {
        sentences.push(
            "The design has no lower bound, so a better motion is not ruled out. The only evidence is how many starts of the search agree."
                .to_string(),
        );
    }
    sentences.extend(gap_goal(design));
    sentences.extend(tilt(design));
    sentences.extend(improvement(design));
    let (grade, word) = match nearest {
        _ if !broken.is_empty() => (Grade::Bad, "✗ Not admissible.".into()),
        _ if design.status == DesignStatus::Interrupted => (Grade::Caution, "! Interrupted.".into()),
        _ if design.status != DesignStatus::Converged => (Grade::Caution, "! Not converged.".into()),
        Some(excess) if excess < 5e-5 => (Grade::Good, "✓ Proved optimal.".into()),
        Some(excess) if excess <= NEAR => {
            (Grade::Good, format!("✓ Proved optimal to within {}.", percent(excess)))
        }
        _ => (Grade::Good, "✓ Converged.".into()),
    };
    (grade, word, sentences)
}

fn unfinished(status: DesignStatus) -> Option<Diagnostic> {
    match status {
        DesignStatus::Converged => None,
        DesignStatus::Interrupted => Some(SearchInterrupted { are_poses: false }.into()),
        _ => Some(SearchNotConverged { at: None, status: status.name() }.into()),
    }
}

/// Adds what the certificate proves. Returns the distance of the worst parameter from its bound.
fn bound(design: &Design, certificate: &Certificate, sentences: &mut Vec<String>) -> f64 {
    let excess: Vec<(&Parameter, f64, f64)> = design
        .parameters
        .iter()
        .zip(design.optimal.sd())
        .zip(&certificate.sd_lower_bound)
        .filter(|(_, bound)| **bound > 0.0)
        .map(|((parameter, sd), &bound)| (parameter, sd, bound))
        .collect();
    let Some(&(parameter, sd, least)) = excess.iter().max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2)))
    else {
        sentences.push(format!(
            "No admissible motion can bring criterion {} below {}; this motion is at most {} above it.",
            design.criterion.letter(),
            significant(certificate.lower_bound, 5),
            excess_in_words(&design.criterion, certificate.gap)
        ));
        return if matches!(design.criterion, Criterion::D(_)) { f64::INFINITY } else { certificate.gap };
    };
    let unit = DisplayUnit::suited(parameter.unit, sd);
    let shown = |value: f64| unit.text(value, 4);
    sentences.push(format!(
        "No motion within the limits can give {} a standard deviation below {}; this motion gives {}, {}.",
        parameter.name,
        shown(least),
        shown(sd),
        match sd / least - 1.0 {
            excess if excess < 5e-5 => "less than 0.01 % above the bound".to_string(),
            excess if excess < 1.0 => format!("{} above the bound", percent(excess)),
            excess => format!("{} times the bound", significant(1.0 + excess, 2)),
        }
    ));
    if excess.len() < design.parameters.len() {
        sentences.push("The parameters without a bound may be improved.".to_string());
    } else if excess.len() > 1 {
        sentences.push("All other parameters are at least as near to their bounds.".to_string());
    }
    let farthest = if excess.len() < design.parameters.len() { f64::INFINITY } else { sd / least - 1.0 };
    if farthest > PROVED {
        sentences.push(
            "The bound itself may be lower than any motion can reach (see below). A better motion need not exist."
                .to_string(),
        );
    }
    farthest
}

/// The gap that was asked for, and the gap that there is; `None` where none was asked for.
fn gap_goal(design: &Design) -> Option<String> {
    let goal = design.gap_goal?;
    let shown = |gap: f64| gap_in_words(&design.criterion, gap);
    let (asked, starts) =
        (shown(goal.gap), format!("{} of {} starts", design.starts.len(), goal.most_starts));
    Some(match (&design.certificate, design.gap_is_reached()) {
        (None, _) => format!("The gap of {asked} that was asked for is NOT proved: there is no bound."),
        (Some(certificate), Some(true)) => format!(
            "The gap of {asked} that was asked for is proved: it is {}, reached after {starts}.",
            shown(certificate.gap)
        ),
        (Some(certificate), _) => format!(
            "The gap of {asked} that was asked for is NOT reached: it is {} after {starts}. Either a better motion exists, or the \
             bound is loose.",
            shown(certificate.gap)
        ),
    })
}

/// What the tilt of gravity gives to the biases.
fn tilt(design: &Design) -> Option<String> {
    let floor = design.parameters.iter().zip(&design.floor_sd).filter(|(_, sd)| **sd > 0.0);
    let named: Vec<String> = floor
        .map(|(parameter, sd)| format!("{} {} {}", parameter.name, significant(*sd, 4), parameter.unit))
        .collect();
    (!named.is_empty()).then(|| {
        format!(
            "Whatever the motion, the tilt and the magnitude of gravity alone give an sd of {}.",
            named.join(", ")
        )
    })
}

fn improvement(design: &Design) -> Option<String> {
    let (name, before) = design.baseline();
    let (the, a) = match name {
        "shuttle" => ("the shuttle", "a shuttle at the limits"),
        _ => ("the initial motion", "the initial motion, a random one"),
    };
    let Some(information) = design.information_over_baseline() else {
        return Some(format!(
            "{} leaves parameters undetermined; this one determines them all.",
            capitalised(a)
        ));
    };
    let factors = design.parameters.iter().zip(before.sd()).zip(design.optimal.sd());
    let factors: Vec<(&str, f64)> =
        factors.map(|((parameter, old), new)| (parameter.name.as_str(), old / new)).collect();
    let least = factors.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let most = factors.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut sentence = format!(
        "The motion has {} times the information of {a}: standard deviations shrink by a factor of {} ({}) to {} ({}).",
        significant(information, 3),
        times(least.1).trim_end_matches(" ×"),
        least.0,
        times(most.1).trim_end_matches(" ×"),
        most.0
    );
    let bounds = design.certificate.as_ref().map(|certificate| &certificate.sd_lower_bound);
    let exhausted: Vec<&str> = bounds
        .into_iter()
        .flatten()
        .zip(before.sd())
        .zip(&factors)
        .filter(|((bound, before), _)| **bound > 0.0 && before / **bound < NOTHING_TO_GAIN)
        .map(|(_, factor)| factor.0)
        .collect();
    if !exhausted.is_empty() && exhausted.len() < factors.len() {
        sentence.push_str(&format!(
            " No motion improves {} by more than 2 %: {the} is already near the bound.",
            exhausted.join(", ")
        ));
    }
    if least.1 < 0.995 {
        sentence.push_str(
            " A factor below 1 means that this parameter gets worse, because the criterion weights the others more.",
        );
    }
    Some(sentence)
}

/// One item for each group of parameters that a motion leaves undetermined.
pub(crate) fn undetermined_items(evaluation: &Evaluation) -> Vec<String> {
    evaluation
        .undetermined
        .iter()
        .map(|group| {
            let what = group.what().map_or_else(String::new, |what| what + ": ");
            let remedy = if group.remedy.is_empty() { String::new() } else { format!(" ({})", group.remedy) };
            format!("{what}{}{remedy}", group.reason)
        })
        .collect()
}

/// A broken limit, and by how much.
pub(crate) fn broken_limit(found: &LimitUse) -> String {
    let (name, axis, unit) = (found.kind.name(), found.axis, found.kind.unit());
    let number = |value: f64| significant(value, 4);
    let (value, limit) = (number(found.value), number(found.limit));
    match found.kind {
        LimitKind::RestAtEnd => format!("axis {axis} still moves at the end, at {value} {unit}"),
        LimitKind::StartAcceleration | LimitKind::EndAcceleration => {
            format!("{name} of axis {axis} is {value} {unit}, prescribed is {limit}")
        }
        _ => format!(
            "{name} of axis {axis} is {value} {unit} at {} s, {} beyond the limit of {limit} ({} %)",
            number(found.time_s),
            number(found.excess()),
            significant(100.0 * found.violation, 3)
        ),
    }
}

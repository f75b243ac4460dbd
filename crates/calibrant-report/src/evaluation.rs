//! The sheet of a user's motion, compared with the best motion and the limits.

use super::design::{
    axes, broken_limit, confidence_section, criterion_in_words, criterion_with_formula, motion_section,
    promised_table, times, undetermined_items,
};
use super::figure::Drawn;
use super::report_context::{About, READINGS};
use crate::number_format::{UNKNOWN, counted, short, significant};
use crate::sheet::{Cell, Grade, Section, Sheet, SheetVerdict, Table};
use calibrant_core::motion::Limits;
use calibrant_design::{Assessment, Design, LimitKind, LimitUse, OtherSetting};
use nalgebra::Vector3;

/// A motion is as good as the best if all its standard deviations are within this factor.
const AS_GOOD: f64 = 1.05;
/// An efficiency above this may hide large improvements of single parameters.
const BLIND: f64 = 0.8;
/// A better motion is worth the effort beyond this factor.
const WORTH_IT: f64 = 1.5;

/// A user's motion as a sheet: a verdict, and its predicted standard deviations beside those of the best motion
/// found. It lists broken limits and undetermined parameters.
#[must_use]
pub fn evaluation_sheet<'a>(assessment: &'a Assessment, about: &'a About) -> Sheet<'a> {
    let (own, parameters) = (&assessment.evaluation, &assessment.parameters);
    let optimum = assessment.optimum.as_ref().ok();
    let mut motions = vec![Drawn::before("your motion", &own.motion)];
    motions.extend(optimum.map(|design| Drawn::after("optimal", &design.optimal.motion)));
    let motion = motion_section(
        "The motion of the arm on each axis, with the limits.",
        "Jerk (a) and acceleration (b)",
        motions,
        axes(parameters),
        drawn_limits(&assessment.limits),
        (&assessment.limits, "motion"),
    );
    let best = optimum.map(|design| ("optimal", &design.optimal));
    let confidence = confidence_section(parameters, ("your motion", own), best, own);
    let sections = vec![predicted(assessment), motion, confidence];
    about.sheet("Evaluation of a motion", verdict(assessment, about), sections, READINGS)
}

fn predicted(assessment: &Assessment) -> Section<'_> {
    let optimum = assessment.optimum.as_ref().ok();
    let mut section = Section::new("Predicted standard deviations")
        .lead("A calibration from a recording of the motion has these standard deviations.");
    section.line(format!(
        "{}: {} own, {} optimal",
        criterion_in_words(&assessment.criterion),
        significant(assessment.evaluation.value, 5),
        optimum.map_or_else(|| UNKNOWN.into(), |design| significant(design.optimal.value, 5))
    ));
    section.table(promised_table(
        &assessment.parameters,
        ("own", &assessment.evaluation),
        optimum.map(|design| ("optimal", &design.optimal)),
        optimum
            .and_then(|design| design.certificate.as_ref())
            .map(|certificate| certificate.sd_lower_bound.as_slice()),
    ));
    section.table(criterion_table(assessment).on_page());
    if let Some(other) = &assessment.other_setting {
        section.line(not_alike(other));
    }
    efficiency(assessment).into_iter().for_each(|line| section.line(line));
    let broken = assessment.violations();
    if broken.is_empty() {
        section.line("all limits are kept, at all times");
    }
    broken.iter().for_each(|found| section.line(format!("BROKEN: {}", broken_limit(found))));
    section
}

/// The efficiency, and what it means.
fn efficiency(assessment: &Assessment) -> Option<String> {
    let efficiency = assessment.efficiency()?;
    let certain = assessment.certain_efficiency().map_or_else(String::new, |certain| {
        format!(" (at least {} % of any admissible motion)", significant(100.0 * certain, 3))
    });
    let meaning = if efficiency > 1.0 + 1e-6 {
        "the motion is better than the best one found within the limits".into()
    } else if efficiency > 0.99 {
        "the search found none that is more than 1 % better".into()
    } else {
        format!(
            "{} recordings of this motion give as much information as one of the best found",
            significant(1.0 / efficiency, 3)
        )
    };
    let percent = significant(100.0 * efficiency, 3);
    Some(format!("Efficiency {percent} % of the best motion found{certain}: {meaning}."))
}

/// The verdict of the page. Terminals show its sentences below the table.
fn verdict(assessment: &Assessment, about: &About) -> SheetVerdict {
    let broken: Vec<String> = assessment.violations().iter().map(broken_limit).collect();
    let mut sentences = Vec::new();
    let determined = assessment.evaluation.covariance.is_some();
    let factor = match &assessment.optimum {
        Ok(design) if determined => compared(assessment, design, &mut sentences),
        Ok(_) => None,
        Err(why) => {
            sentences.push(format!("No best motion is available for a comparison: {why}."));
            None
        }
    };
    if let Some(other) = &assessment.other_setting {
        sentences.push(not_alike(other));
    }
    let (grade, word) = match factor {
        _ if !determined => {
            sentences.insert(
                0,
                "No recording of this motion can calibrate the sensor: it leaves parameters undetermined."
                    .into(),
            );
            (Grade::Bad, "✗ Useless for calibration.")
        }
        _ if !broken.is_empty() => (Grade::Bad, "✗ Breaks limits."),
        Some(factor) if factor <= AS_GOOD => (Grade::Good, "✓ As good as the best motion found."),
        Some(factor) if factor <= WORTH_IT => (Grade::Good, "✓ Usable, a little better is possible."),
        Some(_) => (Grade::Caution, "! Usable, but a better motion is worth the effort."),
        None => (Grade::Good, "✓ Usable."),
    };
    SheetVerdict::new(grade, word, sentences.join(" "))
        .with("Broken limits", broken)
        .with("Undetermined", undetermined_items(&assessment.evaluation))
        .with("Findings", about.findings.clone())
        .on_terminal("")
}

/// Adds the comparison with the best motion. Returns the largest factor of improvement.
fn compared(assessment: &Assessment, design: &Design, sentences: &mut Vec<String>) -> Option<f64> {
    let factors =
        assessment.evaluation.sd().into_iter().zip(design.optimal.sd()).map(|(own, best)| own / best);
    let (parameter, most) = assessment
        .parameters
        .iter()
        .zip(factors)
        .filter(|(_, factor)| factor.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    sentences.push(if most <= AS_GOOD {
        "The best motion found improves no parameter by more than a few per cent.".to_string()
    } else {
        format!(
            "The best motion found makes the standard deviation of {} {} times smaller. Other parameters improve at most as much.",
            parameter.name,
            times(most).trim_end_matches(" ×")
        )
    });
    sentences.extend(efficiency(assessment));
    if assessment.efficiency().is_some_and(|efficiency| efficiency > BLIND && most > WORTH_IT) {
        sentences.push(
            "The criterion hardly shows the difference, since parameters that improve little dominate it. Judge by the standard \
             deviations."
                .to_string(),
        );
    }
    Some(most)
}

fn not_alike(other: &OtherSetting) -> String {
    format!(
        "The motion takes {} s in {}, but the best motion is for the experiment's {} s in {}.",
        short(other.duration_s),
        counted(other.intervals, "interval"),
        short(other.experiment_duration_s),
        counted(other.experiment_intervals, "interval")
    )
}

fn criterion_table(assessment: &Assessment) -> Table {
    let name = criterion_with_formula(&assessment.criterion);
    let mut table = Table::new([name.as_str(), "value", "efficiency of your motion"]);
    let mut row = |name: &str, value: f64, efficiency: Option<f64>| {
        let efficiency = efficiency.map_or(Cell::Missing, Cell::percent);
        table.row(vec![Cell::name(name), Cell::significant(value, 6), efficiency]);
    };
    row("your motion", assessment.evaluation.value, None);
    if let Ok(design) = &assessment.optimum {
        row("optimal motion", design.optimal.value, assessment.efficiency());
        if let Some(certificate) = &design.certificate {
            row("lower bound", certificate.lower_bound, assessment.certain_efficiency());
        }
    }
    table
}

fn drawn_limits(uses: &[LimitUse]) -> Limits {
    let mut limits = Limits::default();
    for found in uses {
        let slot = match found.kind {
            LimitKind::Acceleration => &mut limits.acceleration_mps2,
            LimitKind::Jerk => &mut limits.jerk_mps3,
            LimitKind::Intercept => &mut limits.intercept_mps2,
            LimitKind::Velocity => &mut limits.velocity_mps,
            LimitKind::Displacement => &mut limits.displacement_m,
            LimitKind::RestAtEnd | LimitKind::StartAcceleration | LimitKind::EndAcceleration => continue,
        };
        slot.get_or_insert_with(Vector3::zeros)[found.axis.index()] = found.limit;
    }
    limits
}

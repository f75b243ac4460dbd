//! The settings of a study of initial against optimal motions, as a table.

use crate::number_format;
use crate::sheet::{Cell, Table};
use calibrant_core::motion::{KnownEnds, Rest, Trust};
use calibrant_core::sensor::Axis;
use calibrant_study::DesignStudy;
use nalgebra::Vector3;

/// Settings in two columns.
pub(super) fn settings(study: &DesignStudy) -> Table {
    let axes = study.sensor.active_axes();
    let mut table = Table::new(["setting", "value"]);
    let mut row =
        |name: &str, value: String| table.row(vec![Cell::Name(name.to_string()), Cell::Text(value)]);
    row("sensors", number_format::count(study.outcomes.len()));
    row(
        "motion",
        format!(
            "{} intervals of {} s, sampled at {} Hz",
            study.intervals,
            number_format::short(study.interval_s),
            number_format::short(study.rate_hz)
        ),
    );
    row("trust in the motion", trust(study));
    row("limits", limits(study, axes));
    row(
        "criterion",
        format!(
            "criterion {}, {}{}",
            study.criterion.letter(),
            study.criterion.formula(),
            study.criterion.scaling()
        ),
    );
    let initial = if study.initial_given {
        "given, the same for all sensors"
    } else {
        "random, one for each sensor: within a tenth of the limits"
    };
    row("initial motion", initial.to_string());
    row("starts of each design", study.starts.to_string());
    row("prior", if study.datasheet_prior { "the datasheet" } else { "none" }.to_string());
    row("seed", study.seed.to_string());
    table.on_page()
}

fn trust(study: &DesignStudy) -> String {
    let ends = match study.known_ends {
        KnownEnds::Start => "the acceleration at the start is known",
        KnownEnds::Both => "the accelerations at both ends are known",
    };
    match study.trust {
        Trust::Known => "known: the arm makes exactly the commanded motion".to_string(),
        Trust::Noisy(noise) => format!(
            "noisy: noise of sd {} m/s³ + {} |u| on the jerk; {ends}",
            number_format::short(noise.floor_mps3),
            number_format::short(noise.ratio)
        ),
        Trust::Unknown => format!("unknown: only {ends}"),
    }
}

fn limits(study: &DesignStudy, axes: &[Axis]) -> String {
    let per_axis = |values: &Vector3<f64>| {
        let mut texts: Vec<String> =
            axes.iter().map(|axis| number_format::short(values[axis.index()])).collect();
        if texts.windows(2).all(|pair| pair[0] == pair[1]) {
            texts.truncate(1);
        }
        texts.join(", ")
    };
    let limits = &study.limits;
    let all = [
        ("acceleration", &limits.acceleration_mps2, "m/s²"),
        ("jerk", &limits.jerk_mps3, "m/s³"),
        ("state x", &limits.intercept_mps2, "m/s²"),
        ("velocity", &limits.velocity_mps, "m/s"),
        ("displacement", &limits.displacement_m, "m"),
    ];
    let mut texts: Vec<String> = all
        .into_iter()
        .filter_map(|(name, limit, unit)| limit.as_ref().map(|l| format!("{name} ± {} {unit}", per_axis(l))))
        .collect();
    match limits.rest {
        Rest::None => {}
        Rest::Start => texts.push("at rest at the start".to_string()),
        Rest::Both => texts.push("at rest at both ends".to_string()),
    }
    if limits.start_acceleration_mps2.is_some() || limits.end_acceleration_mps2.is_some() {
        texts.push("prescribed acceleration at an end".to_string());
    }
    texts.join("; ")
}

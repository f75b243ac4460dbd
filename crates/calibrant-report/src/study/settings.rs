//! The settings of a study of initial against optimal motions, as a table.

use crate::design::criterion_with_formula;
use crate::number_format::{count, short};
use crate::sheet::{Cell, Table};
use calibrant_core::motion::{KnownEnds, Rest, Trust};
use calibrant_core::sensor::Axis;
use calibrant_study::DesignStudy;
use nalgebra::Vector3;

/// Settings in two columns, for pages.
pub(super) fn setting_table<const N: usize>(rows: [(&str, String); N]) -> Table {
    let mut table = Table::new(["setting", "value"]);
    rows.into_iter().for_each(|(name, value)| table.row(vec![Cell::name(name), Cell::Text(value)]));
    table.on_page()
}

/// A number of each axis; one where all are the same.
pub(super) fn per_axis(values: &Vector3<f64>, axes: &[Axis]) -> String {
    let mut texts: Vec<String> = axes.iter().map(|axis| short(values[axis.index()])).collect();
    if texts.windows(2).all(|pair| pair[0] == pair[1]) {
        texts.truncate(1);
    }
    texts.join(", ")
}

pub(super) fn settings(study: &DesignStudy) -> Table {
    let [interval_s, rate_hz] = [study.interval_s, study.rate_hz].map(short);
    let initial = match study.initial_given {
        true => "given, the same for all sensors",
        false => "random, one for each sensor: within a tenth of the limits",
    };
    setting_table([
        ("sensors", count(study.outcomes.len())),
        ("motion", format!("{} intervals of {interval_s} s, sampled at {rate_hz} Hz", study.intervals)),
        ("trust in the motion", trust(study)),
        ("limits", limits(study, study.sensor.active_axes())),
        ("criterion", criterion_with_formula(&study.criterion)),
        ("initial motion", initial.to_string()),
        ("starts of each design", study.starts.to_string()),
        ("prior", if study.datasheet_prior { "the datasheet" } else { "none" }.to_string()),
        ("seed", study.seed.to_string()),
    ])
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
            short(noise.floor_mps3),
            short(noise.ratio)
        ),
        Trust::Unknown => format!("unknown: only {ends}"),
    }
}

fn limits(study: &DesignStudy, axes: &[Axis]) -> String {
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
        .filter_map(|(name, limit, unit)| {
            limit.as_ref().map(|l| format!("{name} ± {} {unit}", per_axis(l, axes)))
        })
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

//! The tables of a calibration on stdout.

use super::machine::on_machine;
use super::table::table;
use super::validation::validations;
use calibrant::estimate::{Calibration, GyroscopeInHolds, HoldCalibration};
use calibrant::pipeline::{Calibrated, Outcome};
use calibrant::report::{
    calibration_quality, limit_rows, nuisances_in_words, number_format, over_the_gain, temperature_in_words,
    used_in_words,
};
use calibrant::sensor::{Axis, SensorKind};
use nalgebra::Vector3;

/// The verdict, the used data, the parameters, their quality, the validation, and the limits.
pub(crate) fn calibration(outcome: &Outcome) -> String {
    let verdict = format!("verdict: {}\n\n", outcome.verdict());
    let text = match &outcome.calibrated {
        Calibrated::Sensors(calibration) => of_calibration(calibration),
        Calibrated::OnMachine(machine) => on_machine(machine),
    };
    verdict + &text + &validations(&outcome.validations) + &limits(outcome)
}

/// What is accepted, and the decision on each limit.
fn limits(outcome: &Outcome) -> String {
    if outcome.limits.is_empty() {
        return String::new();
    }
    let (header, rows) = limit_rows(&outcome.limits);
    let rows: Vec<Vec<String>> = rows.into_iter().map(Vec::from).collect();
    format!("\n{}", table(&header, &rows))
}

fn of_calibration(calibration: &Calibration) -> String {
    let mut text = indented(used(calibration));
    for &sensor_kind in calibration.sensor_kinds() {
        text.push('\n');
        text.push_str(&parameters(calibration, sensor_kind));
    }
    text.push('\n');
    let conditions = calibration.holds().map(|holds| [conditions(holds), uncertainty(holds)]);
    let lines = temperature_in_words(calibration).into_iter().chain(calibration_quality(calibration));
    let lines = lines
        .chain(nuisances_in_words(calibration))
        .chain(conditions.into_iter().flatten())
        .chain(noise(calibration));
    text + &indented(lines.chain([fit(calibration)]))
}

fn indented(lines: impl IntoIterator<Item = String>) -> String {
    lines.into_iter().map(|line| format!("  {line}\n")).collect()
}

/// Holds, rotations and turns, and which of them were not used.
fn used(calibration: &Calibration) -> Vec<String> {
    let (rotations, turns) = (calibration.rotations(), calibration.turns());
    let count = |used: usize, what: &str, left_out: Vec<String>| {
        let all = number_format::counted(used + left_out.len(), what);
        match left_out.len() {
            0 => format!("{all}, all used"),
            _ => format!("{all}, {used} used; not used: {}", left_out.join(", ")),
        }
    };
    let Some(holds) = calibration.holds() else { return vec![used_in_words(calibration)] };
    let bad = (0..holds.holds.len()).filter(|&k| !holds.holds[k].used).map(|k| (k + 1).to_string());
    let mut lines = vec![count(holds.used().count(), "hold", bad.collect())];
    if !rotations.is_empty() {
        let bad = rotations.iter().filter(|rotation| !rotation.used);
        let bad = bad.map(|rotation| format!("{} → {}", rotation.from_hold + 1, rotation.to_hold + 1));
        let good = calibration.used_rotations().count();
        lines.push(count(good, "rotation", bad.collect()));
    }
    if !turns.is_empty() {
        lines.push(format!("{} of known angle", number_format::counted(turns.len(), "turn")));
    }
    lines
}

/// The parameters of a sensor, with their nominal values and priors.
fn parameters(calibration: &Calibration, sensor_kind: SensorKind) -> String {
    let places = calibration.places_of(sensor_kind);
    let any = |known: &dyn Fn(usize) -> bool| places.iter().any(|&k| known(k));
    let with_nominal = any(&|k| calibration.parameters[k].nominal.is_some());
    let with_spread = any(&|k| calibration.parameters[k].spread.is_some());
    let with_prior = any(&|k| calibration.known_beforehand(k).is_some());
    let optional = [(with_nominal, "nominal"), (with_spread, "datasheet sd"), (with_prior, "from prior")];
    let mut header = vec!["parameter", "estimate ± sd", "unit", "over the gain"];
    header.extend(optional.iter().filter(|(there, _)| *there).map(|(_, name)| *name));
    let sd = calibration.sd();
    let rows: Vec<Vec<String>> = places
        .into_iter()
        .map(|k| {
            let parameter = &calibration.parameters[k];
            let cells = [
                parameter.nominal.map(|nominal| number_format::significant(nominal, 6)),
                parameter.spread.map(|spread| number_format::significant(spread, 3)),
                calibration.known_beforehand(k).map(|share| format!("{:.0} %", 100.0 * share)),
            ];
            let cells = cells.into_iter().zip(&optional).filter(|(_, (there, _))| *there);
            let mut row = vec![
                parameter.name.clone(),
                number_format::with_sd(calibration.values[k], sd[k]),
                parameter.unit.to_owned(),
                over_the_gain(calibration, calibration.quantities[k], sd[k]),
            ];
            row.extend(cells.map(|(cell, _)| cell.unwrap_or_else(|| "–".to_owned())));
            row
        })
        .collect();
    table(&header, &rows)
}

/// Gravity, and how evenly the holds determine the accelerometer.
fn conditions(holds: &HoldCalibration) -> String {
    format!(
        "gravity {} m/s²; condition number of the {} holds {}",
        number_format::with_sd_or_exact(holds.gravity.magnitude_mps2, holds.gravity.sd_mps2),
        if holds.detected { "detected" } else { "given" },
        number_format::significant(holds.condition_number, 3),
    )
}

/// The source of the standard deviations of an accelerometer.
fn uncertainty(holds: &HoldCalibration) -> String {
    match holds.between_holds_dominates {
        true => format!(
            "the scatter between holds decides the standard deviations: {} mm/s² beyond the noise within them",
            number_format::significant(1e3 * holds.between_holds_sd_mps2, 3)
        ),
        false => {
            "the noise within holds explains the scatter between them, and decides the standard deviations"
                .into()
        }
    }
}

/// Noise of a sample of each sensor.
fn noise(calibration: &Calibration) -> Vec<String> {
    let axes = &Axis::ALL[..calibration.axes()];
    let list = |noise: &Vector3<f64>, sensor_kind: SensorKind| {
        let numbers: Vec<String> =
            axes.iter().map(|axis| number_format::significant(noise[axis.index()], 3)).collect();
        format!("{} {}", numbers.join(", "), calibration.unit(sensor_kind).symbol())
    };
    let of_accelerometer = calibration.fit.noise_estimate.map(|found| {
        let found = list(&found, SensorKind::Accelerometer);
        let assumed = calibration.fit.assumed_noise.map_or_else(String::new, |noise| {
            format!(" (assumed {})", list(&noise, SensorKind::Accelerometer))
        });
        format!("noise of an accelerometer sample {found}{assumed}")
    });
    let of_gyroscope = calibration.gyroscope.as_ref().map(|gyroscope| {
        let GyroscopeInHolds { noise, noise_source, .. } = &gyroscope.still;
        format!("noise of a gyroscope sample {}, from: {noise_source}", list(noise, SensorKind::Gyroscope))
    });
    of_accelerometer.into_iter().chain(of_gyroscope).collect()
}

/// How the estimation ended.
fn fit(calibration: &Calibration) -> String {
    let fit = &calibration.fit;
    format!(
        "{} after {}; χ² {} with {} degrees of freedom{}",
        calibration.status.name(),
        number_format::counted(calibration.iterations, "iteration"),
        number_format::significant(fit.chi2, 5),
        number_format::count(fit.degrees_of_freedom),
        if fit.p_value.is_some() { "" } else { ", weights from the data" }
    )
}

#[cfg(test)]
mod tests;

//! The table of a whole IMU's calibration on stdout.

use super::table::table;
use calibrant::estimate::ImuCalibration;
use calibrant::report::{imu_quality, number_format, over_the_gain, temperature_in_words};
use calibrant::sensor::SensorKind;

/// The data that were used, the parameters of both sensors, and their quality.
pub(crate) fn imu_calibration(calibration: &ImuCalibration) -> String {
    let mut text = used(calibration);
    for sensor_kind in SensorKind::ALL {
        text.push('\n');
        text.push_str(&parameters(calibration, sensor_kind));
    }
    if let Some(line) = temperature_in_words(calibration) {
        text.push_str(&format!("\n  {line}\n"));
    }
    text.push('\n');
    imu_quality(calibration).split("; ").for_each(|part| text.push_str(&format!("  {part}\n")));
    text.push_str(&format!("  {}\n", sample_noise(calibration)));
    text.push_str(&format!(
        "  {} after {}; χ² {} with {} degrees of freedom, weights from the data\n",
        calibration.status.name(),
        number_format::counted(calibration.iterations, "iteration"),
        number_format::significant(calibration.chi2, 4),
        number_format::count(calibration.degrees_of_freedom),
    ));
    text
}

/// Noise of a gyroscope's sample, and its source.
fn sample_noise(calibration: &ImuCalibration) -> String {
    let still = &calibration.still;
    let axes: Vec<String> = still.noise.iter().map(|&sd| number_format::significant(sd, 3)).collect();
    format!(
        "noise of a gyroscope sample {} {}, from: {}",
        axes.join(", "),
        calibration.gyroscope_unit.symbol(),
        still.noise_source
    )
}

/// Holds, rotations and turns, and which of them were not used.
fn used(calibration: &ImuCalibration) -> String {
    let (holds, rotations) = (&calibration.holds.holds, &calibration.rotations);
    let count = |used: usize, what: &str, left_out: Vec<String>| {
        let all = used + left_out.len();
        match left_out.len() {
            0 => format!("  {}, all used\n", number_format::counted(all, what)),
            _ => {
                format!(
                    "  {}, {used} used; left out: {}\n",
                    number_format::counted(all, what),
                    left_out.join(", ")
                )
            }
        }
    };
    let bad_holds = (0..holds.len()).filter(|&k| !holds[k].used).map(|k| (k + 1).to_string());
    let good_holds = holds.iter().filter(|hold| hold.used).count();
    let mut text = count(good_holds, "hold", bad_holds.collect());
    if !rotations.is_empty() {
        let bad = rotations.iter().filter(|rotation| !rotation.used);
        let bad = bad.map(|rotation| format!("{} → {}", rotation.from_hold + 1, rotation.to_hold + 1));
        let good = rotations.iter().filter(|rotation| rotation.used).count();
        text.push_str(&count(good, "rotation", bad.collect()));
    }
    if !calibration.turns.is_empty() {
        text.push_str(&format!(
            "  {} of known angle\n",
            number_format::counted(calibration.turns.len(), "turn")
        ));
    }
    text
}

fn parameters(calibration: &ImuCalibration, sensor_kind: SensorKind) -> String {
    let places = calibration.places_of(sensor_kind);
    let with_prior = places.iter().any(|&k| calibration.known_beforehand(k).is_some());
    let mut header = vec!["parameter", "estimate ± sd", "unit", "over the gain"];
    if with_prior {
        header.push("known beforehand");
    }
    let sd = calibration.sd();
    let rows: Vec<Vec<String>> = places
        .into_iter()
        .map(|k| {
            let quantity = calibration.quantities[k];
            let mut row = vec![
                quantity.name(),
                number_format::with_sd(calibration.values[k], sd[k]),
                calibration.unit_of(quantity).to_owned(),
                over_the_gain(calibration, quantity, sd[k]),
            ];
            if with_prior {
                let share = calibration.known_beforehand(k);
                row.push(share.map_or_else(|| "–".to_owned(), |share| format!("{:.0} %", 100.0 * share)));
            }
            row
        })
        .collect();
    table(&header, &rows)
}

#[cfg(test)]
mod tests;

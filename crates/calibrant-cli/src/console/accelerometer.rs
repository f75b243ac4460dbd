//! The calibration of an accelerometer on stdout.

use super::table::table;
use calibrant::estimate::{Calibration, HoldCalibration, Recovered};
use calibrant::report::number_format;

/// The holds, where there are some, the parameters, and how well the model fits.
pub(crate) fn accelerometer_calibration(calibration: &Calibration) -> String {
    let mut text = String::new();
    if let Recovered::Holds(found) = &calibration.recovered {
        text.push_str(&holds(found));
        text.push('\n');
    }
    text + &parameters(calibration) + &fit(calibration)
}

/// The parameters of a calibration.
fn parameters(calibration: &Calibration) -> String {
    let rows: Vec<_> = calibration
        .parameters
        .iter()
        .zip(calibration.values.iter().zip(calibration.sd()))
        .map(|(parameter, (value, sd))| {
            vec![
                parameter.name.clone(),
                number_format::with_sd(*value, sd),
                parameter.unit.to_owned(),
                parameter
                    .nominal
                    .map_or_else(|| "–".into(), |nominal| number_format::significant(nominal, 6)),
                parameter.spread.map_or_else(|| "–".into(), |spread| number_format::significant(spread, 3)),
            ]
        })
        .collect();
    table(&["parameter", "estimate ± sd", "unit", "nominal", "datasheet sd"], &rows)
}

/// How well the model fits, in a few lines.
fn fit(calibration: &Calibration) -> String {
    let fit = &calibration.fit;
    let p = fit.p_value.map_or_else(String::new, |p| format!(", p-value {}", number_format::probability(p)));
    let mut text = format!(
        "  {} after {} iteration{}; χ² {} with {} degrees of freedom{p}\n",
        calibration.status.name(),
        calibration.iterations,
        if calibration.iterations == 1 { "" } else { "s" },
        number_format::significant(fit.chi2, 5),
        number_format::count(fit.degrees_of_freedom),
    );
    if let Some(found) = fit.noise_estimate {
        let axes = calibration
            .fit
            .whiteness
            .len()
            .max(if matches!(calibration.recovered, Recovered::Holds(_)) { 3 } else { 1 });
        let list = |noise: &dyn Fn(usize) -> f64| {
            (0..axes).map(|axis| number_format::significant(noise(axis), 3)).collect::<Vec<_>>().join(", ")
        };
        let assumed = fit
            .assumed_noise
            .map_or_else(String::new, |noise| format!(" (assumed {})", list(&|axis| noise[axis])));
        text.push_str(&format!(
            "  noise of one sample: {} {}{assumed}\n",
            list(&|axis| found[axis]),
            calibration.unit.symbol()
        ));
    }
    text
}

/// The holds of a static calibration.
fn holds(holds: &HoldCalibration) -> String {
    let rows: Vec<_> = holds
        .holds
        .iter()
        .enumerate()
        .map(|(k, result)| {
            let mut row = vec![
                (k + 1).to_string(),
                format!("{:.2}", result.hold.start_s),
                format!("{:.2}", result.hold.end_s),
                result.hold.samples().to_string(),
            ];
            row.extend(result.force_mps2.iter().map(|f| format!("{f:.3}")));
            row.push(format!("{:+.2}", 1e3 * result.magnitude_residual_mps2));
            row.push(format!("{:+.1}", result.studentised_residual));
            row.push(if result.used { "yes".into() } else { "NO".into() });
            row
        })
        .collect();
    let header = [
        "hold",
        "start s",
        "end s",
        "samples",
        "fx m/s²",
        "fy m/s²",
        "fz m/s²",
        "|f|−g mm/s²",
        "in sd",
        "used",
    ];
    let mut text = table(&header, &rows);
    let magnitudes = match holds.degrees_of_freedom {
        0 => "|f| is g exactly: nothing left to check".into(),
        _ => {
            let rms = number_format::significant(1e3 * holds.magnitude_residual_rms_mps2, 3);
            format!("rms of |f| − g {rms} mm/s²")
        }
    };
    text.push_str(&format!(
        "  {} holds {}, gravity {} m/s²; {magnitudes}; condition number {}\n",
        holds.holds.len(),
        if holds.detected { "found" } else { "given" },
        number_format::with_sd_or_exact(holds.gravity.magnitude_mps2, holds.gravity.sd_mps2),
        number_format::significant(holds.condition_number, 3),
    ));
    text.push_str(&if holds.between_holds_dominates {
        format!(
            "  standard deviations follow from the scatter between holds ({} mm/s² beyond the noise within them)\n",
            number_format::significant(1e3 * holds.between_holds_sd_mps2, 3)
        )
    } else {
        "  standard deviations follow from the noise within holds, which explains the scatter between them\n".into()
    });
    text
}

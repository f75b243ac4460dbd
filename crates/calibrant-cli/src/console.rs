//! What people see: tables on stdout, errors, notes and progress on stderr.

mod imu;
mod table;
mod validation;

pub(crate) use imu::imu_calibration;
pub(crate) use table::table;
pub(crate) use validation::validations;

use calibrant::Error;
use calibrant::estimate::{Calibration, HoldCalibration, Recovered};
use calibrant::io::Finding;
use calibrant::report::number_format;
use calibrant::sensor::{CalibratedImu, Thermal};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use std::io::Write;
use std::path::Path;

/// Prints to stdout; a reader that has gone away (`| head`) is no error.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            let _ = writeln!(std::io::stderr(), "error: cannot write to standard output: {error}");
            std::process::exit(2);
        }
        _ => {}
    }
}

/// Prints a note to stderr.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}

/// Prints a warning to stderr.
pub(crate) fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// Prints to stderr that a diagnostic of this code occurred, which is denied.
pub(crate) fn denied(code: &str, text: &str) {
    let _ = writeln!(std::io::stderr(), "error: denied: {code}: {text}");
}

/// Says what was noticed in a recording: a note, or a warning where results become doubtful.
pub(crate) fn finding(file: &str, finding: &Finding) {
    let say = if finding.is_warning() { warn } else { note };
    say(&format!("{file}: {finding}"));
}

/// Findings of a recording, each with the name of the file that it is about: that of the gyroscope, where it has one.
pub(crate) fn findings(findings: &[Finding], file: &str, gyroscope: Option<&str>) {
    for found in findings {
        let name = if found.in_second_file { gyroscope.unwrap_or(file) } else { file };
        finding(name, found);
    }
}

/// Warns where temperatures lie far beyond those at which a calibration was made.
pub(crate) fn warn_beyond(imu: &CalibratedImu, range_c: [f64; 2]) {
    if let Some(words) = beyond(&imu.parameters.thermal, range_c) {
        warn(&words);
    }
}

/// Temperatures far beyond those at which a calibration was made, in words.
pub(crate) fn beyond(thermal: &Thermal, [coldest, hottest]: [f64; 2]) -> Option<String> {
    let [low, high] = thermal.range_c?;
    let given = match coldest == hottest {
        true => format!("{coldest:.1}"),
        false => format!("{coldest:.1} to {hottest:.1}"),
    };
    (thermal.extrapolates_to(coldest) || thermal.extrapolates_to(hottest)).then(|| {
        format!(
            "the calibration was made at {low:.1} to {high:.1} °C: its polynomials are extrapolated to {given} °C"
        )
    })
}

/// Prints an error to stderr, with the place in the file underlined where it is known.
pub(crate) fn error(error: &Error) {
    let _ = match error.input_error() {
        Some(input_error) if input_error.excerpt.is_some() => {
            let (text, range) = input_error.excerpt.clone().unwrap_or_default();
            let mut title = input_error.clone();
            (title.excerpt, title.help) = (None, String::new());
            let mut diagnostic =
                MietteDiagnostic::new(title.to_string()).with_label(LabeledSpan::at(range, "here"));
            if !input_error.help.is_empty() {
                diagnostic = diagnostic.with_help(input_error.help.clone());
            }
            let name = input_error
                .file
                .as_ref()
                .map_or_else(|| "experiment".into(), |file| file.display().to_string());
            let report = Report::new(diagnostic).with_source_code(NamedSource::new(name, text));
            writeln!(std::io::stderr(), "error: {report:?}")
        }
        _ => writeln!(std::io::stderr(), "error: {error}"),
    };
}

/// Prints an error about this recording to stderr: one that does not name it gets its name.
pub(crate) fn error_in(found: &Error, recording: &Path) {
    if found.is_not_identifiable() {
        let _ = writeln!(std::io::stderr(), "error: {}: {found}", recording.display());
    } else {
        error(found);
    }
}

/// A progress bar on stderr; invisible where stderr is not a terminal.
pub(crate) fn progress(length: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    let template = format!("{{spinner}} {what} [{{bar:30}}] {{human_pos}}/{{human_len}} {{per_sec}} {{eta}}");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// The parameters of a calibration.
pub(crate) fn parameters(calibration: &Calibration) -> String {
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
pub(crate) fn fit(calibration: &Calibration) -> String {
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
pub(crate) fn holds(holds: &HoldCalibration) -> String {
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

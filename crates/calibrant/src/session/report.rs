//! The head of a report: where the calibration comes from.

use super::options::SessionOptions;
use super::recorded::Recorded;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::sensor::SensorKind;
use calibrant_io::Input;
use calibrant_report::About;
use calibrant_report::number_format::significant;

/// The head of the report of a calibration of `what`, with further facts.
pub(crate) fn about(
    what: &str,
    further: impl IntoIterator<Item = (&'static str, String)>,
    recorded: &Recorded,
    inputs: &[Input],
    options: &SessionOptions,
) -> About {
    let files = joined(inputs, |input| input.file.clone());
    let mut facts = vec![
        ("Recording", files.clone()),
        ("Format", recorded.format.map_or_else(String::new, |format| format.name().into())),
        ("SHA-256", joined(inputs, |input| input.sha256.clone())),
        ("Samples", joined(inputs, Input::samples_in_words) + &times(recorded)),
        ("Experiment", options.experiment_file.display().to_string()),
    ];
    facts.extend(further);
    facts.retain(|(_, fact)| !fact.is_empty());
    About {
        title: format!("Calibration of {what} from {files}"),
        facts: facts.into_iter().map(|(label, fact)| (label.to_owned(), fact)).collect(),
        findings: recorded.findings.iter().map(Diagnostic::without_file).collect(),
        ..About::default()
    }
}

/// From when to when the accelerometer was recorded.
fn times(recorded: &Recorded) -> String {
    let times = recorded.recording[SensorKind::Accelerometer]
        .as_ref()
        .map_or(&[][..], |recording| recording.times_s());
    let ends = times.first().zip(times.last());
    ends.map_or_else(String::new, |(first, last)| {
        format!(", {} to {} s", significant(*first, 6), significant(*last, 6))
    })
}

fn joined(inputs: &[Input], say: impl Fn(&Input) -> String) -> String {
    inputs.iter().map(say).collect::<Vec<_>>().join(" and ")
}

//! The head of a report: where the calibration comes from.

use super::options::PipelineOptions;
use super::recorded::Recorded;
use super::source::Source;
use calibrant_core::estimate::CalibrationSettings;
use calibrant_io::{FileFormat, Input, file_name};
use calibrant_report::About;
use calibrant_report::number_format::{count, significant};

/// The head of the report of an accelerometer.
pub(crate) fn about_accelerometer(
    source: &Source,
    recorded: &Recorded,
    inputs: &[Input],
    options: &PipelineOptions,
    settings: &CalibrationSettings,
) -> About {
    let times = recorded.recording.accelerometer.as_ref().map_or(&[][..], |recording| &recording.times_s);
    let time = |time: Option<&f64>| significant(time.copied().unwrap_or(0.0), 6);
    let samples =
        |input: &Input| format!("{}, {} to {} s", in_samples(input), time(times.first()), time(times.last()));
    About {
        title: format!("Calibration from {}", file_name(&source.recording)),
        facts: vec![
            ("Recording".into(), source.recording.display().to_string()),
            ("SHA-256".into(), joined(inputs, |input| input.sha256.clone())),
            ("Samples".into(), joined(inputs, samples)),
            ("Experiment".into(), options.experiment_file.display().to_string()),
            ("Prior".into(), if settings.datasheet_prior { "datasheet".into() } else { "none".into() }),
        ],
        ..head(recorded)
    }
}

/// The head of the report of an IMU.
pub(crate) fn about_imu(recorded: &Recorded, inputs: &[Input], options: &PipelineOptions) -> About {
    let files = joined(inputs, |input| input.file.clone());
    About {
        title: format!("Calibration of an IMU from {files}"),
        facts: vec![
            ("Recording".into(), files),
            ("Format".into(), recorded.format.map_or("", FileFormat::name).into()),
            ("SHA-256".into(), joined(inputs, |input| input.sha256.clone())),
            ("Samples".into(), joined(inputs, in_samples)),
            ("Experiment".into(), options.experiment_file.display().to_string()),
        ],
        ..head(recorded)
    }
}

fn head(recorded: &Recorded) -> About {
    About {
        findings: recorded.findings.iter().map(ToString::to_string).collect(),
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    }
}

fn joined(inputs: &[Input], say: impl Fn(&Input) -> String) -> String {
    inputs.iter().map(say).collect::<Vec<_>>().join(" and ")
}

fn in_samples(input: &Input) -> String {
    format!("{} at {} Hz", count(input.samples), significant(input.rate_hz, 5))
}

//! What comes of a recording with a defect.

use super::kind::Kind;
use crate::common::draw_imu;
use crate::common::hand::ByHand;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::motion::IntervalsDiffer;
use calibrant::diagnostic::reader::{ClockSource, TimesFromFirst};
use calibrant::io::{Experiment, preset, write_imu_recording, write_recording};
use calibrant::sensor::{ImuParameters, ImuRecording, Recording, SensorKind};
use calibrant::session::{Outcome, Session, SessionOptions, Source};
use calibrant::simulate::{Purpose, stream};
use std::fmt::Write;
use std::path::Path;

/// A result is wrong from here on, in standard deviations.
const WRONG: f64 = 5.0;

/// What came of a recording.
#[derive(Debug)]
#[allow(dead_code)] // the rest is printed where a test fails
pub(super) struct Fate {
    number: u64,
    pub(super) kind: Kind,
    /// From 0, hardly visible, to 3, gross.
    pub(super) size: usize,
    sensor_kind: SensorKind,
    is_imu: bool,
    /// The parameter with the largest error from the mean over the recording of what the sensor was, and the
    /// error in standard deviations. `None` where the recording is refused.
    worst: Option<(String, f64)>,
    /// The refusal, the warnings of the calibration, and the findings of the reader.
    said: Vec<String>,
}

impl Fate {
    /// Simulates and calibrates the recording of this number. Whole IMUs by hand and accelerometers alone in
    /// poses alternate, and so do the sensors of an IMU.
    pub(super) fn of(number: u64) -> Self {
        let kind = Kind::ALL[(number % 9) as usize];
        let size = (number / 9 % 4) as usize;
        let is_imu = (number / 36).is_multiple_of(2);
        let is_gyroscope = is_imu && (kind == Kind::Clock || number / 72 % 2 == 1);
        let sensor_kind = SensorKind::ALL[usize::from(is_gyroscope)];
        let mut rng = stream(121, Purpose::Sensor, number);
        let mut truth = draw_imu(&mut rng);
        let hand = ByHand { knocks: true, filtered: true, ..ByHand::default() };
        let mut recording = hand.record(&truth, &mut rng);
        recording[SensorKind::Gyroscope] = recording[SensorKind::Gyroscope].clone().filter(|_| is_imu);
        kind.spoil(size, sensor_kind, &mut recording, &mut truth, &mut rng);
        let (outcome, mut said) = calibrated(&recording);
        let worst = outcome.map(|outcome| {
            let codes =
                outcome.warnings().iter().filter(|warning| warning.code().name() != "latitude-unknown");
            said.extend(codes.map(|warning| format!("{warning:?}")));
            worst(&outcome, &truth)
        });
        let refused = |error: calibrant::Error| said.push(format!("{:?}: {error}", error.code()));
        let worst = worst.map_err(refused).ok();
        Self { number, kind, size, sensor_kind, is_imu, worst, said }
    }

    pub(super) fn is_refused(&self) -> bool {
        self.worst.is_none()
    }

    pub(super) fn is_wrong(&self) -> bool {
        self.worst.as_ref().is_none_or(|(_, error)| *error > WRONG)
    }

    pub(super) fn is_silent(&self) -> bool {
        self.said.is_empty()
    }

    /// Does something that is said name the kind?
    pub(super) fn is_named(&self) -> bool {
        self.said.iter().any(|said| self.kind.words().iter().any(|word| said.contains(word)))
    }
}

/// Calibrates from files, with the experiment file that users begin with, and what is said of the recording.
fn calibrated(recording: &ImuRecording) -> (calibrant::Result<Outcome>, Vec<String>) {
    let directory = tempfile::tempdir().expect("a directory");
    let source = written(recording, directory.path());
    let text = preset(if recording[SensorKind::Gyroscope].is_some() { "imu" } else { "static-poses" })
        .expect("a preset");
    // the gauge of the simulated sensors
    let experiment = Experiment::parse(&text.replace("\"lower\"", "\"upper\""), None).expect("valid");
    let options = SessionOptions { report: false, ..SessionOptions::default() };
    let session = Session::with(experiment.clone(), options).expect("valid");
    let mut notes = Vec::new();
    let outcome = session.calibrate_noting(&source, &mut notes);
    let harmless = [ClockSource::CODE, TimesFromFirst::CODE, IntervalsDiffer::CODE];
    let said = notes.iter().filter(|found| !harmless.contains(&found.code()));
    (outcome, said.map(|found| format!("{found:?}")).collect())
}

/// The parameter with the largest error, and the error in standard deviations.
fn worst(outcome: &Outcome, truth: &ImuParameters) -> (String, f64) {
    let found = outcome.calibration();
    let errors = found.quantities.iter().zip(found.values.iter().zip(found.sd()));
    let errors = errors.map(|(quantity, (value, sd))| (quantity, (value - quantity.value(truth)).abs() / sd));
    let (quantity, error) = errors.max_by(|a, b| a.1.total_cmp(&b.1)).expect("parameters");
    (quantity.name(), error)
}

/// Writes a recording: one file, or two where each sensor has times of its own.
fn written(recording: &ImuRecording, directory: &Path) -> Source {
    let mut source = Source::from_file(directory.join("recording.csv"));
    let accelerometer = recording[SensorKind::Accelerometer].as_ref().expect("recorded");
    match &recording[SensorKind::Gyroscope] {
        Some(gyroscope) if gyroscope.times_s() != accelerometer.times_s() => {
            let path = directory.join("gyroscope.csv");
            write_recording(source.recording.path(), accelerometer).expect("written");
            std::fs::write(&path, gyroscope_csv(gyroscope)).expect("written");
            source.gyroscope = Some(path.into());
        }
        Some(_) => write_imu_recording(source.recording.path(), recording).expect("written"),
        None => write_recording(source.recording.path(), accelerometer).expect("written"),
    }
    source
}

fn gyroscope_csv(recording: &Recording) -> String {
    let mut text = String::from("t_s,gx_radps,gy_radps,gz_radps\n");
    for (t, rate) in recording.times_s().iter().zip(recording.readings()) {
        writeln!(text, "{t:?},{:?},{:?},{:?}", rate.x, rate.y, rate.z).expect("a string");
    }
    text
}

//! A recording as it was read.

use super::duplicates::{Readings, are_the_same};
use super::source::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::holds::RecordingUnused;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{HoldResult, recording_at};
use calibrant_core::sensor::{ImuRecording, PerSensor, Recording, SensorKind};
use calibrant_io::{FileFormat, ImuFile, ImuReadOptions, Input, Origin, UtcTime};

/// The samples of one sensor or of both, and where they come from.
#[derive(Default)]
pub(crate) struct Recorded {
    pub(crate) recording: ImuRecording,
    /// The format of an IMU's file.
    pub(crate) format: Option<FileFormat>,
    /// What the reader noticed, each with the name of its file.
    pub(crate) findings: Vec<Diagnostic>,
    /// Relative standard deviation of the sample rate, if that is nominal; 0 if a clock was recorded.
    pub(crate) rate_sd: f64,
    /// The sensitivity by which counts became readings.
    pub(crate) counts_per_unit: PerSensor<Option<f64>>,
    /// The time from which the times count, ns, where they count from their first and the file has another.
    pub(crate) counted_from_ns: Option<i128>,
    /// SHA-256 of each file.
    pub(crate) sha256: Vec<String>,
    /// When each further recording of the same sensors begins, s.
    pub(crate) further_from_s: Vec<f64>,
    /// The files, where there are further recordings.
    joined: Vec<Input>,
}

/// What was noticed in a file, or in both files of a pair, with their names.
fn findings_of(file: &ImuFile, source: &Source) -> Vec<Diagnostic> {
    file.findings_in(&source.name(false), Some(&source.name(true)))
}

/// Pause between two recordings that are calibrated together, s. Any that is a gap does: nothing crosses it.
const PAUSE_S: f64 = 60.0;

impl Recorded {
    /// Reads an accelerometer alone.
    pub(crate) fn accelerometer_from(source: &Source, options: &ImuReadOptions) -> Result<Self> {
        let file = source.recording.read(options)?;
        let findings = findings_of(&file, source);
        let counts_per_unit = file.counts_per_unit();
        let ImuFile { recording, sha256, counted_from_ns, .. } = file;
        Ok(Self { recording, findings, counts_per_unit, counted_from_ns, sha256, ..Self::default() })
    }

    /// Reads an IMU from its file or its two files.
    pub(crate) fn imu_from(source: &Source, options: &ImuReadOptions) -> Result<Self> {
        let file = source.read_imu(options)?;
        let findings = findings_of(&file, source);
        let counts_per_unit = file.counts_per_unit();
        let ImuFile { recording, format, sha256, counted_from_ns, rate_sd_ppm, .. } = file;
        let rate_sd = 1e-6 * rate_sd_ppm.unwrap_or(0.0);
        let format = Some(format);
        let of_clock = Self { rate_sd, counted_from_ns, ..Self::default() };
        Ok(Self { recording, format, findings, counts_per_unit, sha256, ..of_clock })
    }

    /// The accelerometer's samples.
    pub(crate) fn accelerometer(&self) -> Result<&Recording> {
        self.recording[SensorKind::Accelerometer].as_ref().ok_or_else(|| {
            let message = format!("the recording has no {}", SensorKind::Accelerometer);
            Error::recording(InputError::new(Refusal::SensorMissing, message, "choose another file"))
        })
    }

    /// Adds a further recording of the same sensors.
    pub(crate) fn join(&mut self, other: Self, source: &Source, further: &Source) -> Result<()> {
        let refused = |sensor_kind, refusal, message: String, help| {
            let path = further.path_of(sensor_kind);
            Err(Error::recording(InputError::new(refusal, message, help).in_file(path)))
        };
        let (one, added) = (&self.recording, &other.recording);
        for sensor_kind in SensorKind::ALL {
            let (message, help) = match (one.sensor(sensor_kind), added.sensor(sensor_kind)) {
                (Some(one), Some(added)) if (one.unit(), one.axes()) != (added.unit(), added.axes()) => (
                    format!(
                        "the unit or number of axes of its {sensor_kind} is not that of the first recording"
                    ),
                    "record one sensor in one unit, or calibrate the recordings one by one",
                ),
                (Some(_), None) | (None, Some(_)) => (
                    format!("only one of it and the first recording has a {sensor_kind}"),
                    "record the same sensors each time, or calibrate the recordings one by one",
                ),
                _ => continue,
            };
            return refused(sensor_kind, Refusal::RecordingsUnlike, message, help);
        }
        if one.temperature_c.is_some() != added.temperature_c.is_some() {
            let message = "only one of it and the first recording has a temperature".to_owned();
            let help = "record the temperature each time, or leave its column out of all recordings";
            return refused(SensorKind::Accelerometer, Refusal::RecordingsUnlike, message, help);
        }
        for (sensor_kind, _) in added.sensors() {
            if are_the_same(&self.readings(sensor_kind), &other.readings(sensor_kind)) {
                let message = "its samples are in a recording before it: they would count twice".to_owned();
                let help = "give each recording once";
                return refused(sensor_kind, Refusal::RecordingRepeated, message, help);
            }
        }
        if self.joined.is_empty() {
            self.joined = self.inputs(source);
        }
        self.joined.extend(other.inputs(further));
        self.further_from_s.push(self.recording.append(&other.recording, PAUSE_S));
        self.rate_sd = self.rate_sd.max(other.rate_sd);
        self.sha256.extend(other.sha256);
        Ok(())
    }

    /// The recordings without a hold that is used, where there are several.
    pub(crate) fn unused(&self, holds: &[HoldResult]) -> Vec<Diagnostic> {
        let of = |hold: &HoldResult| recording_at(&self.further_from_s, hold.hold.start_s);
        let is_used = |recording: &usize| holds.iter().any(|hold| hold.used && of(hold) == *recording);
        let recordings = if self.further_from_s.is_empty() { 0 } else { self.further_from_s.len() + 1 };
        let unused = (0..recordings).filter(|recording| !is_used(recording));
        unused.map(|recording| RecordingUnused { recording: recording + 1 }.into()).collect()
    }

    /// The readings of a sensor, with the hash of all files.
    pub(crate) fn readings(&self, sensor_kind: SensorKind) -> Readings<'_> {
        Readings { sha256: self.sha256.concat(), recording: self.recording.sensor(sensor_kind) }
    }

    /// The files, and when they were recorded, where their times are those of a clock since 1970.
    pub(crate) fn origin(&self, source: &Source) -> Origin {
        /// The year 2000: the times of earlier clocks count from something else.
        const SINCE_S: i64 = 946_684_800;
        let first_s = || {
            let times = SensorKind::ALL.map(|sensor_kind| self.recording.sensor(sensor_kind));
            times.into_iter().flatten().find_map(|recording| recording.times_s().first().copied())
        };
        let seconds = match self.counted_from_ns {
            Some(counted_from_ns) => i64::try_from(counted_from_ns.div_euclid(1_000_000_000)).ok(),
            None => first_s().map(|first_s| first_s.floor() as i64),
        };
        let recorded = seconds.filter(|seconds| *seconds >= SINCE_S).map(UtcTime::from_seconds);
        Origin { recorded, ..Origin::of_inputs(self.inputs(source)) }
    }

    /// The files, as `calibration.json` names them.
    fn inputs(&self, source: &Source) -> Vec<Input> {
        if !self.joined.is_empty() {
            return self.joined.clone();
        }
        source.inputs(&self.sha256, &self.recording, SensorKind::Accelerometer)
    }
}

//! A recording as it was read.

use super::duplicates::{Readings, are_the_same};
use super::source::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};
use calibrant_io::{FileFormat, ImuFile, ImuReadOptions, Input, Origin, UtcTime};
use std::path::Path;

/// The samples of one sensor or of both, and where they come from.
pub(crate) struct Recorded {
    pub(crate) recording: ImuRecording,
    /// The format of an IMU's file.
    pub(crate) format: Option<FileFormat>,
    /// What the reader noticed, each with the name of its file.
    pub(crate) findings: Vec<Diagnostic>,
    /// Relative standard deviation of the sample rate, if that is nominal; 0 if a clock was recorded.
    pub(crate) rate_sd: f64,
    /// The time from which the times count, ns, where they count from their first and the file has another.
    pub(crate) counted_from_ns: Option<i128>,
    /// SHA-256 of each file.
    pub(crate) sha256: Vec<String>,
    /// The files, where there are further recordings of the sensor.
    joined: Vec<Input>,
}

/// What was noticed in a file, or in both files of a pair, with their names.
fn findings_of(file: &ImuFile, source: &Source) -> Vec<Diagnostic> {
    file.findings_in(&source.name(false), Some(&source.name(true)))
}

/// Pause between two recordings of a sensor that are calibrated together, s.
const PAUSE_S: f64 = 60.0;

impl Recorded {
    /// Reads an accelerometer alone.
    pub(crate) fn accelerometer_from(source: &Source, options: &ImuReadOptions) -> Result<Self> {
        let file = source.recording.read(options)?;
        let findings = findings_of(&file, source);
        let ImuFile { recording, sha256, counted_from_ns, .. } = file;
        let (format, rate_sd, joined) = (None, 0.0, Vec::new());
        Ok(Self { recording, format, findings, rate_sd, counted_from_ns, sha256, joined })
    }

    /// Reads an IMU from its file or its two files.
    pub(crate) fn imu_from(source: &Source, options: &ImuReadOptions) -> Result<Self> {
        let file = source.read_imu(options)?;
        let findings = findings_of(&file, source);
        let ImuFile { recording, format, sha256, counted_from_ns, rate_sd_ppm, .. } = file;
        let rate_sd = 1e-6 * rate_sd_ppm.unwrap_or(0.0);
        let (format, joined) = (Some(format), Vec::new());
        Ok(Self { recording, format, findings, rate_sd, counted_from_ns, sha256, joined })
    }

    /// The accelerometer's samples.
    pub(crate) fn accelerometer(&self) -> Result<&Recording> {
        self.recording.accelerometer.as_ref().ok_or_else(|| {
            let message = format!("the recording has no {}", SensorKind::Accelerometer);
            Error::recording(InputError::new(Refusal::SensorMissing, message, "choose another file"))
        })
    }

    /// Adds a further recording of the accelerometer.
    pub(crate) fn join(&mut self, other: Self, source: &Source, path: &Path) -> Result<()> {
        let kind = SensorKind::Accelerometer;
        let refused = |refusal, message, help| {
            Err(Error::recording(InputError::new(refusal, message, help).in_file(path)))
        };
        if are_the_same(&self.readings(kind), &other.readings(kind)) {
            let message = "its samples are in a recording before it: they would count twice";
            return refused(Refusal::RecordingRepeated, message, "give each recording once");
        }
        if self.joined.is_empty() {
            self.joined = self.inputs(source);
        }
        let added = other.accelerometer().map_err(|error| error.in_recording(path))?;
        self.joined.push(Input::of(path, &other.sha256.concat(), Some(added)));
        if let Some(recording) = &mut self.recording.accelerometer {
            if (recording.unit(), recording.axes()) != (added.unit(), added.axes()) {
                let message = "its unit or number of axes is not that of the first recording";
                let help = "record one sensor in one unit, or calibrate the recordings one by one";
                return refused(Refusal::RecordingsUnlike, message, help);
            }
            recording.append(added, PAUSE_S);
        }
        self.sha256.extend(other.sha256);
        Ok(())
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

//! The log of a machine's motion: its joints in the order of the chain, or its poses.

use super::motion_source::MotionSource;
use super::source::Readings;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::PositionsFilled;
use calibrant_core::diagnostic::machine::PosesInterpolated;
use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_io::{
    MachineLogInput, ReferenceLogFile, ReferenceLogOptions, file_name, is_reference_log, unusable_log,
};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::log::{ReferenceLog, leave_out_filled, recover_interpolated};
use std::path::PathBuf;

/// A log as its file holds it.
pub(crate) struct LogFile {
    path: PathBuf,
    file: ReferenceLogFile,
}

impl LogFile {
    /// Reads a log.
    pub(crate) fn read(
        source: &MotionSource,
        options: &ReferenceLogOptions,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let (file, path) = (source.logged(options)?, source.path());
        notes.extend(file.findings.iter().map(|found| found.clone().in_file(file_name(path))));
        Ok(Self { path: path.to_path_buf(), file })
    }

    /// Reads the log that lies in the file of the recording, as in a bag. Where it does not, the `option` names a file.
    pub(crate) fn read_beside(
        recording: &Readings,
        options: &ReferenceLogOptions,
        option: TaskOption,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        if recording.is_file() && is_reference_log(recording.path(), options) {
            return Self::read(&MotionSource::File(recording.path().into()), options, notes);
        }
        if let Some(why) = unusable_log(recording.path(), options).filter(|_| recording.is_file()) {
            return Err(why);
        }
        let help = format!(
            "add {option} FILE: a CSV with t_s and a column for each joint (elbow_rad), or poses of the body"
        );
        let message = "a [machine] experiment needs the log of the machine's motion";
        Err(Error::experiment(InputError::new(Refusal::KeyMissing, message, help).answered_by(option, [])))
    }

    /// Distance of the knots of its splines, s, where the file states it.
    pub(crate) fn knot_step_s(&self) -> Option<f64> {
        self.file.knot_step_s
    }

    /// The log on the clock of a recording: the joints of the chain in their order, or poses that were measured.
    pub(crate) fn for_recording(
        &self,
        chain: Option<&KinematicChain>,
        counted_from_ns: Option<i128>,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<(ReferenceLog, MachineLogInput)> {
        let mut file = self.file.clone();
        file.put_on_clock_of(counted_from_ns);
        let mut recovered_rate_hz = None;
        let mut log = file.of_machine(chain, &self.path)?;
        if let ReferenceLog::Poses(poses) = &log
            && let Some(stream) = recover_interpolated(poses)
        {
            let (rate_hz, samples) = (stream.rate_hz(), stream.log.times_s.len());
            let found = Diagnostic::from(PosesInterpolated { rate_hz, samples });
            notes.push(found.in_file(file_name(&self.path)));
            recovered_rate_hz = Some(stream.rate_hz());
            log = ReferenceLog::Poses(stream.log);
        }
        if let ReferenceLog::Poses(poses) = &mut log {
            let (rows, all) = (leave_out_filled(poses), poses.times_s.len());
            if rows > 0 {
                let found = Diagnostic::from(PositionsFilled { rows, share: rows as f64 / all as f64 });
                notes.push(found.in_file(file_name(&self.path)));
            }
        }
        let input = MachineLogInput {
            file: file_name(&self.path),
            sha256: file.sha256,
            format: file.format.name(),
            samples: log.times_s().len(),
            recovered_rate_hz,
        };
        Ok((log, input))
    }
}

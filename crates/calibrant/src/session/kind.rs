//! The kinds of calibrations: what an experiment says of the motion in every recording.

use super::sections::{setup_of, unused_face_sd};
use super::setup::{Faces, Setup};
use super::source::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::samples::GyroscopeMissing;
use calibrant_core::error::Result;
use calibrant_core::motion::CommandedMotion;
use calibrant_core::sensor::{ImuRecording, SensorKind};
use calibrant_io::{HoldsPlan, ImuPlan};

/// A kind of calibration.
pub(crate) enum Kind<'e> {
    /// An accelerometer on a commanded motion.
    Motion(&'e CommandedMotion),
    /// An accelerometer that is held still.
    Holds(&'e HoldsPlan),
    /// An IMU that is held still and turned.
    Imu(&'e ImuPlan, &'e HoldsPlan),
}

impl<'e> Kind<'e> {
    /// That of a sensor which is held still.
    pub(crate) fn held(holds: &'e HoldsPlan, imu: Option<&'e ImuPlan>) -> Self {
        imu.map_or(Self::Holds(holds), |imu| Self::Imu(imu, holds))
    }

    /// What the recording lacks of this kind.
    pub(crate) fn missing(&self, recording: &ImuRecording) -> Vec<Diagnostic> {
        let without = matches!(self, Self::Imu(..)) && recording[SensorKind::Gyroscope].is_none();
        without.then_some(GyroscopeMissing {}.into()).into_iter().collect()
    }

    /// What is known of one recording.
    pub(crate) fn setup(
        &self,
        source: &Source,
        recording: &ImuRecording,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Setup<'e>> {
        Ok(match self {
            Self::Motion(command) => Setup::Motion((*command).clone()),
            Self::Holds(plan) => held(plan, notes)?,
            // it cannot be lost unnoticed: the calibration gets a diagnostic
            Self::Imu(_, plan) if recording[SensorKind::Gyroscope].is_none() => held(plan, notes)?,
            Self::Imu(plan, holds) => {
                Setup::Imu(&plan.gyroscope, Box::new(setup_of(plan, holds, source, recording, notes)?))
            }
        })
    }
}

/// An accelerometer that is held still.
fn held<'e>(plan: &HoldsPlan, notes: &mut Vec<Diagnostic>) -> Result<Setup<'e>> {
    let (holds, face_sd_rad) = (plan.setup()?, plan.face_sd_rad());
    Ok(match plan.directions() {
        Some(directions) => Setup::Faces(Faces { holds, directions, face_sd_rad }),
        None => {
            notes.extend(unused_face_sd(face_sd_rad));
            Setup::Holds(holds)
        }
    })
}

//! Both recordings of an IMU, checked: three axes, expected units, usable samples.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::problem::{CalibrationProblem, Stimulus, sound};
use crate::sensor::{Axis, Recording, SensorKind};

/// Both recordings, with three axes and the expected units.
pub(in crate::estimate) fn recordings<'a>(
    problem: &ImuProblem<'a>,
) -> Result<(&'a Recording, &'a Recording)> {
    let need = |sensor_kind: SensorKind| {
        problem.recording.sensor(sensor_kind).filter(|recording| recording.len() > 1).ok_or_else(|| {
            Error::recording(InputError::new(
                Refusal::SensorMissing,
                format!("the recording has no {sensor_kind}"),
                "an IMU needs both sensors; kind = \"accelerometer\" calibrates that one alone",
            ))
        })
    };
    let moves = |sensor_kind: SensorKind| {
        let recording = need(sensor_kind)?;
        match Axis::ALL.into_iter().find(|&axis| recording.constant(axis).is_some()) {
            None => Ok(recording),
            Some(axis) => Err(Error::recording(InputError::new(
                Refusal::AxisConstant,
                format!("axis {axis} of the {sensor_kind} never changes"),
                "is it connected, and are the columns right?",
            ))),
        }
    };
    let (accelerometer, gyroscope) = (moves(SensorKind::Accelerometer)?, moves(SensorKind::Gyroscope)?);
    let stimulus = Stimulus::Holds(&problem.setup.holds);
    let alone = CalibrationProblem { sensor: problem.accelerometer, recording: accelerometer, stimulus };
    let (one, other) = rayon::join(|| alone.validate(), || sound(gyroscope));
    one.and(other)?;
    if gyroscope.unit != problem.gyroscope.unit {
        return Err(Error::recording(InputError::new(
            Refusal::UnitContradicted,
            format!(
                "the gyroscope's readings are in {}, the experiment expects {}",
                gyroscope.unit.symbol(),
                problem.gyroscope.unit.symbol()
            ),
            "set gyroscope.unit",
        )));
    }
    Ok((accelerometer, gyroscope))
}

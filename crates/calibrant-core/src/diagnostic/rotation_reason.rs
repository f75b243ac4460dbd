//! Why a rotation is not used.

use super::parts::neither;
use crate::sensor::{Axis, SensorKind};
use std::fmt;

/// Why a rotation was left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RotationReason {
    /// The gyroscope's recording begins only then, s.
    GyroscopeBegins(f64),
    /// The gyroscope's recording ends then, s.
    GyroscopeEnds(f64),
    /// The gyroscope pauses for this time, s.
    GyroscopePauses(f64),
    /// The gyroscope has too few samples in it.
    SamplesMissing,
    /// An axis of a sensor saturates in it.
    Saturated(SensorKind, Axis),
    /// It misses gravity.
    GravityMissed {
        /// By this angle, rad.
        error_rad: f64,
        /// The same in standard deviations expected of it.
        deviations: f64,
    },
    /// It does not fit.
    Unfit,
}

/// As files state it.
impl fmt::Display for RotationReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::GyroscopeBegins(start_s) => {
                write!(f, "the gyroscope's recording begins only at {start_s:.1} s")
            }
            Self::GyroscopeEnds(end_s) => write!(f, "the gyroscope's recording ends at {end_s:.1} s"),
            Self::GyroscopePauses(pause_s) => write!(f, "the gyroscope pauses for {pause_s:.3} s in it"),
            Self::SamplesMissing => f.write_str("the gyroscope has too few samples in it"),
            Self::Saturated(sensor_kind, axis) => {
                write!(f, "axis {axis} of the {sensor_kind} saturates in it")?;
                match sensor_kind {
                    SensorKind::Accelerometer => {
                        f.write_str(", and the specific force for the g-sensitivity is unknown")
                    }
                    SensorKind::Gyroscope => Ok(()),
                }
            }
            Self::GravityMissed { error_rad, deviations } => write!(
                f,
                "it misses gravity by {:.2}°, {deviations:.1} standard deviations",
                error_rad.to_degrees()
            ),
            Self::Unfit => f.write_str("it does not fit"),
        }
    }
}

neither!(RotationReason);

//! The quantities that a calibration on a machine estimates beside the sensor's.

use calibrant_core::estimate::VarianceSource;
use calibrant_core::sensor::{Axis, ImuQuantity, SensorKind};

/// One unknown: of the sensor, or of what carries it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MachineQuantity {
    /// A parameter of the IMU.
    Imu(ImuQuantity),
    /// Lever arm from the tip to the sensor, in the axes of the tip, m.
    Lever(Axis),
    /// Rotation of the sensor about its own axis, beside the mounting that was given, rad.
    Mounting(Axis),
    /// Tilt of gravity against the base: 0 or 1, rad.
    Tilt(usize),
    /// Magnitude of gravity, m/s².
    Gravity,
    /// Delay of a sensor: motion time less IMU time, s.
    Delay(SensorKind),
    /// Rate of the reference's clock against the IMU's, less 1.
    ClockRate,
    /// Zero offset of a joint, rad or m.
    Zero(usize),
    /// Correction of a joint's transform: joint; 0 to 2 translation in m, 3 to 5 rotation in rad.
    Geometry(usize, usize),
}

impl MachineQuantity {
    /// All quantities but the sensor's, in the order of a result.
    pub(crate) fn of_machine(sensors: &[SensorKind], joints: usize) -> Vec<Self> {
        let mut all = Axis::ALL.map(Self::Lever).to_vec();
        all.extend(Axis::ALL.map(Self::Mounting));
        all.extend([Self::Tilt(0), Self::Tilt(1), Self::Gravity]);
        all.extend(sensors.iter().map(|sensor| Self::Delay(*sensor)));
        all.push(Self::ClockRate);
        all.extend((0..joints).map(Self::Zero));
        all.extend((0..joints).flat_map(|j| (0..6).map(move |k| Self::Geometry(j, k))));
        all
    }

    /// Its name in files, tables and messages. A joint is named by the caller's list.
    #[must_use]
    pub fn name(self, joints: &[String]) -> String {
        let joint = |j: usize| joints.get(j).map_or_else(|| format!("joint{j}"), Clone::clone);
        match self {
            Self::Imu(quantity) => quantity.name(),
            Self::Lever(axis) => format!("lever.{axis}"),
            Self::Mounting(axis) => format!("mounting.{axis}"),
            Self::Tilt(axis) => format!("tilt.{}", ["x", "y"][axis]),
            Self::Gravity => "gravity".into(),
            Self::Delay(sensor) => format!("delay.{sensor}"),
            Self::ClockRate => "clock_rate".into(),
            Self::Zero(j) => format!("zero.{}", joint(j)),
            Self::Geometry(j, k) => format!("geometry.{}.{}", joint(j), ["x", "y", "z", "rx", "ry", "rz"][k]),
        }
    }

    /// Its unit, with the unit of each joint's position. `None` for a parameter of the IMU, whose unit follows from that of the readings.
    #[must_use]
    pub fn unit(self, joints: &[&'static str]) -> Option<&'static str> {
        Some(match self {
            Self::Imu(_) => return None,
            Self::Lever(_) => "m",
            Self::Mounting(_) | Self::Tilt(_) => "rad",
            Self::Gravity => "m/s²",
            Self::Delay(_) => "s",
            Self::ClockRate => "1",
            Self::Zero(j) => joints.get(j).copied().unwrap_or("rad"),
            Self::Geometry(_, k) => ["m", "rad"][k / 3],
        })
    }

    /// The source whose prior knowledge it has.
    #[must_use]
    pub fn source(self) -> VarianceSource {
        match self {
            Self::Imu(_) => VarianceSource::SensorPrior,
            Self::Lever(_) | Self::Mounting(_) => VarianceSource::Mounting,
            Self::Tilt(_) | Self::Gravity => VarianceSource::Gravity,
            Self::Delay(_) | Self::ClockRate => VarianceSource::Timing,
            Self::Zero(_) | Self::Geometry(..) => VarianceSource::Geometry,
        }
    }
}

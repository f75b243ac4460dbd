//! A value for each kind of sensor.

use super::SensorKind;
use std::ops::{Index, IndexMut};

/// A value for each kind of sensor.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{PerSensor, SensorKind};
/// let rates_hz = PerSensor::from_fn(|sensor_kind| if sensor_kind == SensorKind::Gyroscope { 200.0 } else { 100.0 });
/// assert_eq!(rates_hz[SensorKind::Gyroscope], 200.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PerSensor<T>([T; SensorKind::ALL.len()]);

impl<T> PerSensor<T> {
    /// The value of each kind, from the kind.
    pub fn from_fn(of: impl FnMut(SensorKind) -> T) -> Self {
        Self(SensorKind::ALL.map(of))
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = (SensorKind, &T)> {
        SensorKind::ALL.into_iter().zip(&self.0)
    }

    /// The values, to be changed.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.0.iter_mut()
    }
}

impl<T> PerSensor<Option<T>> {
    /// Of one sensor alone.
    pub fn only(sensor_kind: SensorKind, value: T) -> Self {
        let mut only = Self::from_fn(|_| None);
        only[sensor_kind] = Some(value);
        only
    }

    /// Those that are there.
    pub fn present(&self) -> impl Iterator<Item = (SensorKind, &T)> {
        self.iter().filter_map(|(sensor_kind, value)| Some((sensor_kind, value.as_ref()?)))
    }
}

/// Of the accelerometer, and of the gyroscope.
impl<T> From<[T; 2]> for PerSensor<T> {
    fn from(values: [T; 2]) -> Self {
        Self(values)
    }
}

impl<T> Index<SensorKind> for PerSensor<T> {
    type Output = T;

    fn index(&self, sensor_kind: SensorKind) -> &T {
        &self.0[sensor_kind as usize]
    }
}

impl<T> IndexMut<SensorKind> for PerSensor<T> {
    fn index_mut(&mut self, sensor_kind: SensorKind) -> &mut T {
        &mut self.0[sensor_kind as usize]
    }
}

/// Lets a type be indexed by the kind of sensor: by its field `sensors`.
macro_rules! indexed_by_sensor {
    ($type:ty, $of:ty) => {
        impl std::ops::Index<SensorKind> for $type {
            type Output = $of;

            fn index(&self, sensor_kind: SensorKind) -> &$of {
                &self.sensors[sensor_kind]
            }
        }

        impl std::ops::IndexMut<SensorKind> for $type {
            fn index_mut(&mut self, sensor_kind: SensorKind) -> &mut $of {
                &mut self.sensors[sensor_kind]
            }
        }

        impl $type {
            /// The same with this of one sensor.
            #[must_use]
            pub fn with(mut self, sensor_kind: SensorKind, value: $of) -> Self {
                self.sensors[sensor_kind] = value;
                self
            }
        }
    };
}
pub(super) use indexed_by_sensor;

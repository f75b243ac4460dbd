//! What may be wrong with a recording: nine kinds, each in four sizes, from hardly visible to gross.

use crate::common::{normal, retimed};
use calibrant::sensor::{Gauge, ImuParameters, ImuRecording, Recording, SensorKind};
use calibrant::simulate::Rng;
use nalgebra::{Matrix3, Vector3};
use rand::RngExt;

/// A kind of defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    BiasStep,
    GainChange,
    TemperatureDrift,
    SwappedAxes,
    Saturation,
    Clock,
    LostSamples,
    Vibration,
    GluedAxis,
}

impl Kind {
    pub(super) const ALL: [Self; 9] = [
        Self::BiasStep,
        Self::GainChange,
        Self::TemperatureDrift,
        Self::SwappedAxes,
        Self::Saturation,
        Self::Clock,
        Self::LostSamples,
        Self::Vibration,
        Self::GluedAxis,
    ];

    /// Its sizes for a sensor.
    fn sizes(self, sensor_kind: SensorKind) -> [f64; 4] {
        let is_gyroscope = sensor_kind == SensorKind::Gyroscope;
        match self {
            // m/s² or rad/s
            Self::BiasStep | Self::TemperatureDrift if is_gyroscope => [5e-4, 2e-3, 1e-2, 5e-2],
            Self::BiasStep | Self::TemperatureDrift => [2e-3, 1e-2, 5e-2, 0.2],
            Self::Vibration if is_gyroscope => [3e-3, 1e-2, 5e-2, 0.3],
            Self::Vibration => [0.03, 0.1, 0.5, 3.0],
            // of the gain
            Self::GainChange => [5e-4, 2e-3, 1e-2, 5e-2],
            // of the recording's time
            Self::SwappedAxes | Self::GluedAxis => [0.05, 0.2, 0.5, 1.0],
            // of the samples
            Self::Saturation => [1e-3, 1e-2, 0.05, 0.2],
            Self::LostSamples => [1e-3, 5e-3, 2e-2, 0.1],
            // of the rate
            Self::Clock => [1e-4, 5e-4, 2e-3, 1e-2],
        }
    }

    /// Parts of diagnostics, findings and refusals that name it.
    pub(super) fn words(self) -> &'static [&'static str] {
        match self {
            Self::BiasStep | Self::TemperatureDrift => {
                &["its bias s", "its bias c", "its bias d", "its bias (or", "(or its bias)"]
            }
            Self::GainChange => {
                &["its gains s", "its gains c", "its gains d", "its gains (or", "(or its gains)"]
            }
            Self::SwappedAxes => {
                &["axes-in-other-order", "gyroscope-turned", "its axes (against", "or its axes"]
            }
            Self::Saturation => &["Saturat", "saturat"],
            Self::Clock => &["clock-skew", "time-offset", "Clocks", "RecordingsUnlike"],
            Self::LostSamples => {
                &["SamplesMissing", "samples-missing", "sampling-gap", "sampling-irregular", "samples-lost"]
            }
            Self::Vibration => &["noise-vibration", "noise-not-as-given"],
            Self::GluedAxis => &["axes-equal", "axis-stuck"],
        }
    }

    /// Spoils a recording by one of the four sizes. `truth` becomes the mean over the recording of what the
    /// sensor was.
    pub(super) fn spoil(
        self,
        size: usize,
        sensor_kind: SensorKind,
        recording: &mut ImuRecording,
        truth: &mut ImuParameters,
        rng: &mut Rng,
    ) {
        let size = self.sizes(sensor_kind)[size];
        let is_alone = recording[SensorKind::Gyroscope].is_none();
        if self == Self::LostSamples {
            return lose(recording, size, rng);
        }
        let (sensor, parameters) = match sensor_kind {
            SensorKind::Accelerometer => {
                (&mut recording[SensorKind::Accelerometer], &mut truth[SensorKind::Accelerometer])
            }
            SensorKind::Gyroscope => {
                (&mut recording[SensorKind::Gyroscope], &mut truth[SensorKind::Gyroscope])
            }
        };
        let sensor = sensor.as_mut().expect("recorded");
        let (axis, count) = (rng.random_range(0..3), sensor.len());
        let other = (axis + 1) % 3;
        let onset = (rng.random_range(0.3..0.7) * count as f64) as usize;
        let later = 1.0 - onset as f64 / count as f64;
        match self {
            Self::BiasStep => {
                sensor.readings_mut()[onset..].iter_mut().for_each(|y| y[axis] += size);
                parameters.bias[axis] += size * later;
            }
            Self::GainChange => {
                sensor.readings_mut()[onset..].iter_mut().for_each(|y| y[axis] *= 1.0 + size);
                let mut mean = Matrix3::identity();
                mean[(axis, axis)] += size * later;
                parameters.matrix = mean * parameters.matrix;
                parameters.bias = mean * parameters.bias;
            }
            // it warms up, a third of the recording long
            Self::TemperatureDrift => {
                let direction = Vector3::from_fn(|_, _| normal(rng)).normalize();
                let warmed = |k: usize| 1.0 - (-3.0 * k as f64 / count as f64).exp();
                (0..count).for_each(|k| sensor.readings_mut()[k] += direction * (size * warmed(k)));
                parameters.bias += direction * (size * (0..count).map(warmed).sum::<f64>() / count as f64);
            }
            Self::SwappedAxes => {
                let first = ((1.0 - size) * count as f64) as usize;
                sensor.readings_mut()[first..].iter_mut().for_each(|y| y.swap_rows(axis, other));
                // gravity alone cannot tell a sensor from one whose axes are named otherwise
                if is_alone && first == 0 {
                    parameters.bias.swap_rows(axis, other);
                    parameters.matrix.swap_rows(axis, other);
                    parameters.matrix.swap_columns(axis, other);
                    *parameters = Gauge::Upper.apply(parameters);
                }
            }
            Self::Saturation => {
                let mut sizes: Vec<f64> = sensor.readings().iter().map(|y| y[axis].abs()).collect();
                sizes.sort_unstable_by(f64::total_cmp);
                let limit = sizes[((1.0 - size) * count as f64) as usize];
                sensor.readings_mut().iter_mut().for_each(|y| y[axis] = y[axis].clamp(-limit, limit));
            }
            Self::Clock => *sensor = retimed(sensor, |t| t * (1.0 + size)),
            Self::LostSamples => {}
            Self::Vibration => {
                let direction = Vector3::from_fn(|_, _| normal(rng)).normalize();
                let turns_per_s = std::f64::consts::TAU * rng.random_range(10.0..45.0);
                for (t, y) in sensor.samples_mut() {
                    *y += direction * (size * (turns_per_s * t).sin());
                }
            }
            // an axis stays where it was, or repeats another
            Self::GluedAxis => {
                let first = ((1.0 - size) * count as f64) as usize;
                let (stays, value) = (rng.random::<bool>(), sensor.readings()[first][axis]);
                sensor.readings_mut()[first..]
                    .iter_mut()
                    .for_each(|y| y[axis] = if stays { value } else { y[other] });
            }
        }
    }
}

/// Loses a share of the samples; the times of the others are those of an even rate.
fn lose(recording: &mut ImuRecording, share: f64, rng: &mut Rng) {
    let count = recording[SensorKind::Accelerometer].as_ref().map_or(0, Recording::len);
    let kept: Vec<bool> = (0..count).map(|_| rng.random::<f64>() >= share).collect();
    for kind in SensorKind::ALL {
        let Some(sensor) = &mut recording[kind] else { continue };
        let mut number = 0..;
        let mut readings = sensor.readings().to_vec();
        readings.retain(|_| kept[number.next().expect("endless")]);
        let times_s = sensor.times_s()[..readings.len()].to_vec();
        *sensor = Recording::new(times_s, readings, 3, sensor.unit()).expect("samples in order");
    }
}

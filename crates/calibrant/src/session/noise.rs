//! The noise of an IMU in its longest hold: the noise of a sample where the experiment does not say it, and a section of the report.

use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, HoldsSetup, WhiteNoise, WhiteNoiseSearch};
use calibrant_core::motion::Hold;
use calibrant_core::noise::{Moments, Segment, SensorNoise};
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// A shorter hold says too little of the noise, s. So does what is left of a hold between gaps.
const LONG_HOLD_S: f64 = 20.0;

/// What the longest hold shows.
#[derive(Default)]
pub(crate) struct NoiseInHold {
    accelerometer: Option<SensorNoise>,
    pub(crate) gyroscope: Option<SensorNoise>,
    /// The gyroscope's white noise, where it is understood.
    pub(crate) white_noise: Option<WhiteNoise>,
}

/// Calibrates and finds the noise beside it. The gyroscope's is found while the accelerometer is fitted. The accelerometer's, which only the report
/// shows, follows beside the fit of the rotations: that leaves a processor idle at times.
pub(crate) fn calibrated_with_noise<T: Send>(
    recording: &ImuRecording,
    holds: &HoldsSetup,
    of_accelerometer: bool,
    calibrate: impl FnOnce(&WhiteNoiseSearch<'_>) -> T + Send,
) -> (T, NoiseInHold) {
    let longest = LongestHold::of(holds, recording);
    let noise = &|sensor_kind: SensorKind| longest.as_ref()?.noise(sensor_kind, recording);
    let mut found = NoiseInHold::default();
    let NoiseInHold { accelerometer, gyroscope, white_noise } = &mut found;
    let accelerometer = of_accelerometer.then_some(accelerometer);
    let calibrated = rayon::scope(|scope| {
        let search = WhiteNoiseSearch::new(|| {
            *gyroscope = noise(SensorKind::Gyroscope);
            if let Some(accelerometer) = accelerometer {
                scope.spawn(move |_| *accelerometer = noise(SensorKind::Accelerometer));
            }
            *white_noise = longest.as_ref()?.white_noise(gyroscope.as_ref()?);
            *white_noise
        });
        calibrate(&search)
    });
    (calibrated, found)
}

impl NoiseInHold {
    /// The noise of both sensors in m/s² and rad/s.
    pub(crate) fn physical(
        self,
        calibration: &Calibration,
        recording: &ImuRecording,
    ) -> Result<Vec<SensorNoise>> {
        let sensors: Vec<SensorNoise> = self.accelerometer.into_iter().chain(self.gyroscope).collect();
        sensors.into_par_iter().map(|noise| physical(noise, calibration, recording)).collect()
    }
}

/// The longest hold, where it is long enough.
struct LongestHold {
    /// Its number, from 0.
    number: usize,
    hold: Hold,
    /// For the samples of a sensor in it: most often the other has as many.
    moments: Moments,
}

impl LongestHold {
    /// A recording without holds has none; the calibration says so.
    fn of(holds: &HoldsSetup, recording: &ImuRecording) -> Option<Self> {
        let holds = holds.found.as_deref()?;
        let number = Hold::longest(holds)?;
        let hold = holds[number].clone();
        let segment = |sensor_kind| long_segment(recording.sensor(sensor_kind)?, &hold);
        let segment = segment(SensorKind::Gyroscope).or_else(|| segment(SensorKind::Accelerometer))?;
        Some(Self { number, moments: Moments::of(segment.samples()), hold })
    }

    /// The noise of a sensor in it; `None` where its samples do not determine it.
    fn noise(&self, sensor_kind: SensorKind, recording: &ImuRecording) -> Option<SensorNoise> {
        let recording = recording.sensor(sensor_kind)?;
        let segment = long_segment(recording, &self.hold)?;
        if segment.samples() == self.moments.samples() {
            SensorNoise::with_moments(sensor_kind, recording, segment, &self.moments).ok()
        } else {
            SensorNoise::of(sensor_kind, recording, segment).ok()
        }
    }

    /// A gyroscope's white noise, where it is determined on all axes and the noise is understood.
    fn white_noise(&self, gyroscope: &SensorNoise) -> Option<WhiteNoise> {
        let sd = gyroscope
            .white_noise_per_sample()
            .filter(|_| gyroscope.explains() && gyroscope.caveat.is_none())?;
        Some(WhiteNoise { sd, hold: self.number, duration_s: gyroscope.segment.duration_s() })
    }
}

/// The samples of a hold without a gap, where they last long enough.
fn long_segment(recording: &Recording, hold: &Hold) -> Option<Segment> {
    let segment = Segment::between(recording, hold.start_s, hold.end_s).ok()?;
    (segment.duration_s() + segment.interval_s >= LONG_HOLD_S).then_some(segment)
}

/// The noise of a sensor in m/s² or rad/s.
fn physical(noise: SensorNoise, calibration: &Calibration, recording: &ImuRecording) -> Result<SensorNoise> {
    let matrix = calibration.imu.sensor(noise.sensor_kind).matrix;
    let gain = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
    match recording.sensor(noise.sensor_kind) {
        Some(recording) => noise.with_gain(recording, &gain),
        None => Ok(noise),
    }
}

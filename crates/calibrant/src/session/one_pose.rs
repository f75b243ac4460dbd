//! A recording in one pose while the temperature changes: a warm-up, or a freezer to the desk. Pieces of it are soaks, whose mean readings are the biases but for what gravity shows.

use super::reader::Reader;
use super::run::Session;
use super::source::Source;
use crate::CampaignCalibration;
use calibrant_campaign::fit::{FittedCampaign, SoakCalibration, fit};
use calibrant_core::diagnostic::campaign::GainInBias;
use calibrant_core::error::Result;
use calibrant_core::estimate::SoakTemperature;
use calibrant_core::sensor::{
    Axis, CalibratedImu, ImuParameters, ImuQuantity, ImuRecording, Quantity, ReadingUnit, Recording,
    SensorKind,
};
use calibrant_io::Origin;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Most pieces, and fewest.
const PIECES: [usize; 2] = [48, 12];
/// Least change of temperature, K.
const LEAST_K: f64 = 5.0;
/// In one pose the mean readings of the pieces stay within this share of their size.
const ONE_POSE: f64 = 0.05;
/// What the Earth turns, rad/s: a gyroscope at rest shows it.
const EARTH_RADPS: f64 = 7.292e-5;

impl Session {
    /// Biases over temperature from a recording in one pose whose temperature changes; `None` where it is none, or where the experiment asks for no bias that
    /// follows temperature.
    ///
    /// # Errors
    /// Where the recording cannot be read. As [`fit`] where it does not determine the orders.
    pub fn one_pose(&self, source: &Source) -> Result<Option<CampaignCalibration>> {
        let experiment = self.experiment();
        let Some(imu) = &experiment.imu else { return Ok(None) };
        if imu.thermal.accelerometer_bias + imu.thermal.gyroscope_bias == 0 || !source.further.is_empty() {
            return Ok(None);
        }
        let recorded = Reader::of(experiment, self.options()).read(source)?;
        let (recording, _) = recorded.recording.without_spikes();
        let gains =
            [(experiment.sensor.unit, experiment.sensor.gain), (imu.gyroscope.unit, imu.gyroscope.gain)];
        let gains = gains
            .map(|(unit, gain)| if unit == ReadingUnit::Counts { gain } else { Some(Vector3::repeat(1.0)) });
        let (Some(accelerometer), Some(gyroscope), [Some(gain_a), Some(gain_g)]) =
            (&recording[SensorKind::Accelerometer], &recording[SensorKind::Gyroscope], gains)
        else {
            return Ok(None);
        };
        let mut pieces = PIECES[0];
        loop {
            let soaks = cut(&recording, [accelerometer, gyroscope], [gain_a, gain_g], pieces)?;
            let Some(up) = one_direction(&soaks) else { return Ok(None) };
            let range = soaks.iter().map(|soak| [soak.temperature.mean_c; 2]);
            let range = range.reduce(|[low, high], [t, _]| [low.min(t), high.max(t)]);
            let ramp = soaks.iter().map(|soak| soak.temperature.rate_k_per_min.abs()).fold(0.0, f64::max);
            let Some(range_c) = range.filter(|[low, high]| high - low >= LEAST_K && ramp > 0.0) else {
                return Ok(None);
            };
            let Some(model) = experiment.one_pose_model(range_c, ramp) else { return Ok(None) };
            let mut fitted = fit(&model, &soaks)?;
            // residuals that go together are fewer than they seem
            if go_together(&fitted) && pieces / 2 >= PIECES[1] {
                pieces /= 2;
                continue;
            }
            fitted.imu = without_level(&fitted.imu);
            fitted.with_gain = Some(up);
            fitted.warnings.insert(0, GainInBias { axis: up }.into());
            let named = self.options().naming.of(source.path())?;
            let origin = recorded.origin(source);
            let origin = Origin {
                sensor: Some(named.sensor),
                station: named.station,
                recorded: named.recorded.or(origin.recorded),
                experiment: Some(experiment.origin()),
                ..origin
            };
            let what = ("Pieces", format!("{} of one recording", soaks.len()));
            let title = "Biases over temperature, in one pose";
            return Ok(Some(CampaignCalibration::of(
                title,
                what,
                (fitted, model),
                origin,
                &self.options().allowed,
            )));
        }
    }
}

/// The pieces of a recording, each as the calibration of a soak: its mean readings, which are biases and what gravity shows.
fn cut(
    recording: &ImuRecording,
    sensors: [&Recording; 2],
    gains: [Vector3<f64>; 2],
    pieces: usize,
) -> Result<Vec<SoakCalibration>> {
    let times = sensors[0].times_s();
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Ok(Vec::new()) };
    let length_s = (last - first) / pieces as f64;
    let spans: Vec<(f64, f64)> =
        (0..pieces).map(|k| (first + k as f64 * length_s, first + (k + 1) as f64 * length_s)).collect();
    let temperatures = SoakTemperature::each(recording, spans.iter().copied())?;
    let quantities: Vec<ImuQuantity> = SensorKind::ALL
        .into_iter()
        .flat_map(|kind| Axis::ALL.map(|axis| ImuQuantity::Of(kind, Quantity::Bias(axis))))
        .collect();
    let piece = |(k, (span, temperature)): (usize, (&(f64, f64), SoakTemperature))| {
        let mut parameters = ImuParameters::identity();
        let mut covariance = DMatrix::zeros(6, 6);
        for (number, (kind, (sensor, gain))) in
            SensorKind::ALL.into_iter().zip(sensors.into_iter().zip(gains)).enumerate()
        {
            let (mean, variance) = mean_between(sensor, *span)?;
            parameters[kind].bias = mean;
            parameters[kind].matrix = Matrix3::from_diagonal(&gain);
            for axis in 0..3 {
                covariance[(3 * number + axis, 3 * number + axis)] = variance[axis];
            }
        }
        let units = sensors.map(|sensor| Some(sensor.unit()));
        let imu = CalibratedImu {
            covariance: Some(covariance),
            ..CalibratedImu::new(parameters, units, quantities.clone(), FRAME)
        };
        Some(SoakCalibration { name: format!("piece {}", k + 1), imu, temperature, prior: Vec::new() })
    };
    Ok(spans.iter().zip(temperatures).enumerate().filter_map(piece).collect())
}

/// The frame in words.
const FRAME: &str = "that of each sensor: one pose shows no axis";

/// Mean of the readings between two times, and its variance for white noise; `None` with fewer than two samples.
fn mean_between(sensor: &Recording, (start_s, end_s): (f64, f64)) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let first = sensor.times_s().partition_point(|t| *t < start_s);
    let end = sensor.times_s().partition_point(|t| *t < end_s);
    let readings = sensor.readings().get(first..end).filter(|readings| readings.len() > 1)?;
    let count = readings.len() as f64;
    let steps = readings.windows(2).map(|pair| (pair[1] - pair[0]).map(|step| 0.5 * step * step));
    let noise = steps.sum::<Vector3<f64>>() / (count - 1.0);
    // readings that never change are rounded
    let least = readings[0].map(|value| (value.abs() * f64::EPSILON).powi(2) + f64::MIN_POSITIVE);
    Some((readings.iter().sum::<Vector3<f64>>() / count, (noise / count).zip_map(&least, f64::max)))
}

/// The axis that is up, where all pieces are in one pose.
fn one_direction(soaks: &[SoakCalibration]) -> Option<Axis> {
    let forces: Vec<Vector3<f64>> =
        soaks.iter().map(|soak| soak.imu.parameters[SensorKind::Accelerometer].bias).collect();
    let mean = forces.iter().sum::<Vector3<f64>>() / forces.len() as f64;
    let stays = forces.len() >= PIECES[1]
        && forces.iter().all(|force| (force - mean).norm() < ONE_POSE * mean.norm());
    stays.then(|| Axis::ALL[mean.iamax()])
}

/// Does the residual of a piece tell that of the next?
fn go_together(fitted: &FittedCampaign) -> bool {
    let (mut product, mut square, mut count) = (0.0, 0.0, 0.0);
    for pair in fitted.soaks.windows(2) {
        for channel in 0..fitted.channels.len() {
            for axis in 0..3 {
                let off = |k: usize| {
                    pair[k].residuals[channel][axis]
                        / pair[k].residual_sds[channel][axis].max(f64::MIN_POSITIVE)
                };
                product += off(0) * off(1);
                square += 0.5 * (off(0).powi(2) + off(1).powi(2));
                count += 1.0;
            }
        }
    }
    // under independence the correlation has the standard deviation 1/√n
    product > 2.5 * square / f64::sqrt(count)
}

/// The result without the level of the accelerometer, which is not its bias alone, and with what the Earth turns in the variance of the gyroscope's.
fn without_level(imu: &CalibratedImu) -> CalibratedImu {
    let is_level = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Of(SensorKind::Accelerometer, _));
    let kept: Vec<usize> = (0..imu.quantities.len()).filter(|k| !is_level(&imu.quantities[*k])).collect();
    let mut found = imu.clone();
    found.quantities = kept.iter().map(|k| imu.quantities[*k]).collect();
    found.parameters[SensorKind::Accelerometer].bias = Vector3::zeros();
    if let Some(sigma) = &imu.covariance {
        let mut covariance = DMatrix::from_fn(kept.len(), kept.len(), |i, j| sigma[(kept[i], kept[j])]);
        for (k, quantity) in found.quantities.iter().enumerate() {
            if let ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(axis)) = quantity {
                let gain = found.parameters[SensorKind::Gyroscope].matrix[(axis.index(), axis.index())];
                covariance[(k, k)] += (EARTH_RADPS * gain).powi(2) / 3.0;
            }
        }
        found.covariance = Some(covariance);
    }
    found
}

//! The gyroscope in the stationary intervals: its means, its noise, and the holds in which it turns.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::datasheet::noise_not_as_given;
use crate::estimate::imu::model::GyroscopeNoise;
use crate::estimate::imu::problem::{Gyroscope, ImuProblem, NoiseSource, WhiteNoise};
use crate::estimate::imu::stationary::motion::turning_rates;
use crate::estimate::imu::stationary::scatter::mean_in_hold;
use crate::estimate::quantisation::{CoarseAxis, coarse_axes_in};
use crate::motion::Hold;
use crate::sensor::{MeanReading, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// The gyroscope in the holds that are used.
pub(crate) struct StationaryGyroscope {
    /// Mean reading in each hold. `None` for a hold in which it turns or has no samples.
    pub(crate) readings: Vec<Option<MeanReading>>,
    /// Mean reading in each hold, including those in which it turns.
    pub(crate) measured: Vec<Option<MeanReading>>,
    /// The rate of each hold in which it turns, in the unit of the readings.
    pub(crate) turning: Vec<Option<f64>>,
    pub(crate) noise: GyroscopeNoise,
    /// Source of the noise of a sample, in words.
    pub(crate) noise_source: NoiseSource,
    /// Axes whose steps are coarse.
    pub(crate) coarse: Vec<CoarseAxis>,
    /// Standard deviation of a sample about the mean of its hold.
    pub(crate) scatter: Vector3<f64>,
}

impl StationaryGyroscope {
    /// Computes its means in these holds. `white_noise`: that of a sample, from a long hold.
    pub(crate) fn measure(
        problem: &ImuProblem<'_>,
        gyroscope: &Recording,
        holds: &[&Hold],
        white_noise: Option<WhiteNoise>,
    ) -> Result<Self> {
        let measured: Vec<Option<MeanReading>> =
            holds.par_iter().map(|hold| mean_in_hold(gyroscope, hold)).collect();
        if measured.iter().flatten().count() == 0 {
            return Err(Error::recording(InputError::new(
                Refusal::RecordingsUnlike,
                "the gyroscope has no samples in the holds of the accelerometer",
                "both need the same clock: are these files of one recording?",
            )));
        }
        let turning = turning_rates(&measured, gyroscope, problem.setup.thermal.gyroscope_bias > 0);
        let calm = |(mean, turns): (&Option<MeanReading>, &Option<f64>)| mean.filter(|_| turns.is_none());
        let readings: Vec<Option<MeanReading>> = measured.iter().zip(&turning).map(calm).collect();
        let (noise, noise_source) = sample_noise(problem.gyroscope, white_noise, &readings);
        let at_rest = holds.iter().zip(&readings).filter(|(_, mean)| mean.is_some());
        let coarse = coarse_axes_in(gyroscope, at_rest.map(|(hold, _)| *hold));
        Ok(Self {
            noise: GyroscopeNoise::of(noise, &coarse),
            noise_source,
            scatter: MeanReading::pooled_sd(readings.iter().flatten()),
            readings,
            measured,
            turning,
            coarse,
        })
    }

    /// The places of the holds in which it turns.
    pub(crate) fn turning_places(&self) -> impl Iterator<Item = usize> {
        (0..self.turning.len()).filter(|&j| self.turning[j].is_some())
    }
}

/// Noise of a gyroscope's sample: from the datasheet unless the holds contradict it, else from a long hold, else the scatter within holds.
fn sample_noise(
    gyroscope: &Gyroscope,
    white_noise: Option<WhiteNoise>,
    readings: &[Option<MeanReading>],
) -> (Vector3<f64>, NoiseSource) {
    let scatter = MeanReading::pooled_sd(readings.iter().flatten());
    let given =
        gyroscope.noise.filter(|given| noise_not_as_given(SensorKind::Gyroscope, &scatter, given).is_none());
    match (given, white_noise) {
        (Some(noise), _) => (noise, NoiseSource::Datasheet),
        (None, Some(white)) => {
            (white.sd, NoiseSource::AllanDeviation { hold: white.hold, duration_s: white.duration_s })
        }
        (None, None) => (scatter, NoiseSource::ScatterWithinHolds),
    }
}

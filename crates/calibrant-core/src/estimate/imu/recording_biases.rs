//! The gyroscope's bias in each of several recordings, from its means in their holds, and what biases that are not known do to the estimates.

use crate::error::Result;
use crate::estimate::holds::median;
use crate::estimate::imu::initial::accelerometer::{InitialAccelerometer, UsedHolds};
use crate::estimate::imu::initial::gyroscope::explained_means;
use crate::estimate::imu::model::{Fit, ImuModel, Prior, singular};
use crate::estimate::imu::problem::{ImuProblem, WhiteNoise};
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::estimate::imu::stationary::scatter::mean_in_hold;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::imu::variance_components::between_holds::of_recordings;
use crate::estimate::recording_biases::{RecordingBiases, recording_at};
use crate::motion::Hold;
use crate::sensor::{Axis, ImuQuantity, Quantity, Recording, SensorKind};
use nalgebra::{DMatrix, DVector, Vector3};

/// The gyroscope's biases in the recordings before the last; `None` where there is one recording, or one bias.
pub(crate) fn gyroscope_biases(
    problem: &ImuProblem<'_>,
    first: (&InitialAccelerometer, &RecordingTemperature<'_>),
    used: &UsedHolds<'_>,
    (recording, white_noise): (&Recording, Option<WhiteNoise>),
    quantities: (&[ImuQuantity], Option<&Prior>),
) -> Result<Option<RecordingBiases>> {
    let further_from_s = &problem.setup.holds.further_from_s;
    if further_from_s.is_empty() {
        return Ok(None);
    }
    let roughly = medians(recording, &used.holds, further_from_s);
    let gyroscope =
        StationaryGyroscope::measure(problem, &roughly.taken_out_of(recording), &used.holds, white_noise)?;
    let mut means = explained_means(problem, first, used, &gyroscope, quantities);
    means.by.recordings = roughly.recordings(&used.holds);
    Ok(of_recordings(&means).and_then(|mut told| {
        let taken_out = roughly.values.iter().flat_map(|value| value.iter().copied());
        told.weighted += &told.information * DVector::from_iterator(told.weighted.len(), taken_out);
        RecordingBiases::of(further_from_s, &told, &Vector3::repeat(1.0))
    }))
}

/// The medians of the means in the holds of each recording, less those of the last.
fn medians(recording: &Recording, holds: &[&Hold], further_from_s: &[f64]) -> RecordingBiases {
    let means: Vec<(usize, Vector3<f64>)> = holds
        .iter()
        .filter_map(|hold| {
            Some((recording_at(further_from_s, hold.start_s), mean_in_hold(recording, hold)?.mean))
        })
        .collect();
    let of = |r: usize| {
        let axis = |axis: usize| {
            median(means.iter().filter(|(of, _)| *of == r).map(|(_, mean)| mean[axis]).collect())
        };
        means.iter().any(|(of, _)| *of == r).then(|| Vector3::from_fn(|k, _| axis(k)))
    };
    let earlier = further_from_s.len();
    let last = of(earlier);
    let value = |r: usize| of(r).zip(last).map_or_else(Vector3::zeros, |(value, last)| value - last);
    RecordingBiases {
        further_from_s: further_from_s.to_vec(),
        values: (0..earlier).map(value).collect(),
        covariance: DMatrix::zeros(3 * earlier, 3 * earlier),
    }
}

/// By how much the estimates change with one standard deviation of each combination of the biases of a sensor in earlier recordings: a step with other data.
pub(crate) fn recording_bias_errors(
    model: &ImuModel<'_>,
    fit: &Fit,
    holds: &[&Hold],
    (sensor_kind, biases): (SensorKind, &RecordingBiases),
) -> Result<Vec<DVector<f64>>> {
    let step = |errors: &[Vector3<f64>]| {
        let (mut moved, mut residuals) = (model.clone(), fit.residuals.clone());
        let error = |hold: usize| {
            errors.get(recording_at(&biases.further_from_s, holds[hold].start_s)).copied().unwrap_or_default()
        };
        for (j, hold) in moved.holds.iter_mut().enumerate() {
            match (sensor_kind, &mut hold.gyroscope) {
                (SensorKind::Accelerometer, _) => hold.accelerometer -= error(j),
                (SensorKind::Gyroscope, Some((mean, _))) => *mean -= error(j),
                (SensorKind::Gyroscope, None) => {}
            }
        }
        let of_axis = |quantity: &ImuQuantity| match quantity {
            ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(axis))
                if sensor_kind == SensorKind::Gyroscope =>
            {
                Some(*axis)
            }
            _ => None,
        };
        let places: Vec<(usize, Axis)> =
            model.quantities.iter().enumerate().filter_map(|(k, of)| Some((k, of_axis(of)?))).collect();
        for (rotation, residual) in model.rotations.iter().zip(&mut residuals) {
            let Some(residual) = residual else { continue };
            for (k, axis) in &places {
                residual.error += residual.by_parameters.column(*k) * error(rotation.from)[axis.index()];
            }
        }
        moved.step(&fit.state, &residuals).ok_or_else(singular)
    };
    let rest = step(&[])?;
    biases.errors().iter().map(|errors| Ok(step(errors)? - &rest)).collect()
}

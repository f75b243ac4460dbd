//! What a claim predicts of a hold: the magnitude of gravity, and no rotation.
//!
//! With `C = S⁻¹`: `f̂ = C_a (ȳ_a − b_a)`, `ω̂ = C_g (ȳ_g − b_g − Γ f̂) − κ f̂`, where `κ f̂` is the Earth's rate about the vertical at a known latitude. An error of the parameters moves them by
//! `df̂ = −C_a Σ_k ∂y_a/∂p_k dp_k` and `dω̂ = −C_g (Σ_k ∂y_g/∂p_k dp_k + Γ df̂) − κ df̂`.

use super::noise_comparison::NoiseRatio;
use super::predicted_error::{Item, Place, Scattered};
use super::prediction::Prediction;
use crate::estimate::hold_variance::{between_variance, noise_variance};
use crate::estimate::imu::StationaryMean;
use crate::motion::Hold;
use crate::sensor::{Condition, Correction, SensorKind};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Below these errors nothing is told apart: rounding.
const FLOOR_MPS2: f64 = 1e-9;
const FLOOR_RADPS: f64 = 1e-12;

/// A hold as the calibration corrects it.
pub(super) struct HoldPrediction {
    pub(super) force: Vector3<f64>,
    /// Derivative of the force with respect to the parameters, 3 × p.
    pub(super) by_parameters: DMatrix<f64>,
    /// Its covariance from the samples' noise, and with the scatter between holds.
    noise: Matrix3<f64>,
    pub(super) own: Matrix3<f64>,
    /// What takes raw readings to rates, with the rates' noise and own covariance; where the gyroscope was recorded.
    rate: Option<Rate>,
    /// How many times the variance of a mean by noise was in the calibration's holds what it is in this one.
    more_noise: f64,
    place: Place,
}

struct Rate {
    value: Vector3<f64>,
    by_parameters: DMatrix<f64>,
    own: Matrix3<f64>,
    /// Variances of the mean reading from noise, and with the scatter between holds.
    of_mean: (Vector3<f64>, Vector3<f64>),
    more_noise: Vector3<f64>,
}

impl HoldPrediction {
    /// Corrects a hold. `within`: standard deviation of an accelerometer sample; `of_mean`: variance of a mean that coarse steps leave, however many samples there are; `noise`: of the
    /// sensors, beside the calibration's. `None` where a matrix is singular.
    pub(super) fn of(
        prediction: &Prediction,
        number: usize,
        hold: &Hold,
        temperature_c: f64,
        (within, of_mean, noise): (&Vector3<f64>, &Vector3<f64>, &[NoiseRatio]),
        still: Option<&StationaryMean>,
    ) -> Option<Self> {
        let imu = &prediction.imu.at(temperature_c);
        let at = |stimulus: Vector3<f64>, force: Vector3<f64>| Condition {
            imu: &prediction.imu,
            stimulus,
            force,
            temperature_c,
        };
        let size = prediction.quantities.len();
        let of_accelerometer = Correction::of(&imu[SensorKind::Accelerometer])?;
        let force = of_accelerometer.apply(&hold.mean);
        let correction = of_accelerometer.by_reading(&imu[SensorKind::Accelerometer], &force);
        let mut by_parameters = DMatrix::zeros(3, size);
        for (k, quantity) in prediction.quantities.iter().enumerate() {
            if quantity.sensor_kind() == SensorKind::Accelerometer {
                by_parameters.set_column(k, &(-(correction * quantity.derivative(&at(force, force)))));
            }
        }
        let spread = |variance: Vector3<f64>, by: &Matrix3<f64>| {
            by * Matrix3::from_diagonal(&variance) * by.transpose()
        };
        let of_noise = noise_variance(hold, within, of_mean);
        let of_scatter =
            between_variance(prediction.between_holds_sd_mps2, &imu[SensorKind::Accelerometer].matrix);
        let by_noise = spread(of_noise, &correction);
        let own = by_noise + spread(of_scatter, &correction);
        // the variance of a mean goes with the duration of the hold
        let shorter = hold.duration_s() * prediction.inverse_hold_s;
        let rate = match (still, noise.get(1)) {
            (Some(still), Some(ratio)) => {
                let correction = imu[SensorKind::Gyroscope].matrix.try_inverse()?;
                let turning =
                    correction * (still.mean - imu[SensorKind::Gyroscope].bias - imu.g_sensitivity * force);
                let by_force =
                    -(correction * imu.g_sensitivity) - Matrix3::identity() * prediction.vertical_rate;
                let mut by_parameters =
                    DMatrix::from_column_slice(3, 3, by_force.as_slice()) * &by_parameters;
                for (k, quantity) in prediction.quantities.iter().enumerate() {
                    if quantity.sensor_kind() == SensorKind::Gyroscope {
                        by_parameters
                            .set_column(k, &(-(correction * quantity.derivative(&at(turning, force)))));
                    }
                }
                let through_force = by_force * own * by_force.transpose();
                let of_mean = (
                    still.variance,
                    still.variance + prediction.still_sd.component_mul(&prediction.still_sd),
                );
                Some(Rate {
                    value: turning - force * prediction.vertical_rate,
                    by_parameters,
                    own: spread(of_mean.1, &correction) + through_force,
                    of_mean,
                    more_noise: ratio.axes.map(|ratio| shorter / (ratio * ratio)),
                })
            }
            _ => None,
        };
        let place = Place {
            hold: number,
            from_hold: None,
            start_s: hold.start_s,
            end_s: hold.end_s,
            fold: 0,
            along: vec![force.normalize()],
        };
        let more_noise = shorter / noise.first().map_or(1.0, |noise| noise.overall().powi(2));
        Some(Self { force, by_parameters, noise: by_noise, own, rate, more_noise, place })
    }

    /// Direction of the specific force.
    pub(super) fn along(&self) -> Vector3<f64> {
        self.force.normalize()
    }

    /// `|f̂| − g` and what is predicted of it.
    pub(super) fn magnitude(&self, prediction: &Prediction) -> Item {
        let along = self.along();
        let row = DMatrix::from_row_slice(1, 3, along.as_slice());
        let variance = |of: &Matrix3<f64>| (of * along).dot(&along);
        let [noise, own] = [&self.noise, &self.own].map(|of| variance(of) + FLOOR_MPS2.powi(2));
        Item {
            place: self.place.clone(),
            error: DVector::from_element(1, self.force.norm() - prediction.gravity_mps2),
            by_parameters: row * &self.by_parameters,
            own: DMatrix::from_element(1, 1, own),
            with_previous: None,
            knock_share: 0.0,
            scatters: vec![scattered(noise, own, self.more_noise)],
        }
    }

    /// `ω̂`, which is zero, and what is predicted of it.
    pub(super) fn rate(&self) -> Option<Item> {
        let rate = self.rate.as_ref()?;
        let own = rate.own + Matrix3::identity() * FLOOR_RADPS.powi(2);
        Some(Item {
            place: self.place.clone(),
            error: DVector::from_column_slice(rate.value.as_slice()),
            by_parameters: rate.by_parameters.clone(),
            own: DMatrix::from_column_slice(3, 3, own.as_slice()),
            with_previous: None,
            knock_share: 0.0,
            scatters: (0..3)
                .map(|axis| scattered(rate.of_mean.0[axis], rate.of_mean.1[axis], rate.more_noise[axis]))
                .collect(),
        })
    }
}

/// `more_noise`: how many times the noise of the calibration's holds was this one.
fn scattered(noise: f64, own: f64, more_noise: f64) -> Scattered {
    Scattered { scatter: own - noise, calibrated_noise: more_noise * noise, own }
}

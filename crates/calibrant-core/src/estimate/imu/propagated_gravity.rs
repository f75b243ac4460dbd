//! Gravity that the gyroscope propagates through the rotations of a recording, with a given calibration.

use crate::estimate::imu::earth_rate::EarthRate;
use crate::estimate::imu::model::{
    GravityResidual, GyroscopeNoise, HoldData, ImuModel, RotationScatter, State,
};
use crate::estimate::imu::rotations::felt_force::interpolated_forces;
use crate::estimate::imu::rotations::gravity_at_ends::{TurnsInHolds, gravity_at_ends};
use crate::estimate::imu::rotations::spans::{Integrable, rotation_spans};
use crate::estimate::imu::stationary::scatter::{mean_in_hold, usual_scatter};
use crate::estimate::imu::variance_components::between_holds::set_gyroscope_means;
use crate::estimate::imu::variance_components::bias_drift::follow_drift;
use crate::estimate::quantisation::coarse_axes_in;
use crate::motion::Hold;
use crate::sensor::{ImuParameters, ImuQuantity, MeanReading, Recording, SensorKind};
use nalgebra::{DMatrix, Matrix2, Matrix2x3, Matrix3, Vector2, Vector3};

/// The gyroscope in a hold.
#[derive(Debug, Clone, Copy)]
pub(in crate::estimate) struct StationaryMean {
    /// Mean reading.
    pub(in crate::estimate) mean: Vector3<f64>,
    /// Variance of the mean from the noise of its samples.
    pub(in crate::estimate) variance: Vector3<f64>,
}

/// The gyroscope's means in holds.
pub(in crate::estimate) struct GyroscopeAtRest {
    /// In each hold; `None` where it turns or has no samples there.
    readings: Vec<Option<MeanReading>>,
    /// Noise of one sample, and the part of coarse steps that differs between holds.
    noise: GyroscopeNoise,
    /// Variance of the common error of all means by coarse steps.
    of_steps: Vector3<f64>,
}

impl GyroscopeAtRest {
    /// `turns`: does it turn in the hold at this place? `noise_of`: the noise of a sample, by how its samples scatter in these holds.
    pub(in crate::estimate) fn of(
        gyroscope: &Recording,
        holds: &[&Hold],
        turns: impl Fn(usize) -> bool,
        noise_of: impl FnOnce(&Vector3<f64>) -> Vector3<f64>,
    ) -> Self {
        let mean = |(place, hold): (usize, &&Hold)| mean_in_hold(gyroscope, hold).filter(|_| !turns(place));
        let readings: Vec<_> = holds.iter().enumerate().map(mean).collect();
        let coarse = coarse_axes_in(gyroscope, holds.iter().copied());
        let scatter = GyroscopeNoise::of(usual_scatter(&readings, gyroscope), &coarse).of_sample;
        let noise = GyroscopeNoise::of(noise_of(&scatter), &coarse);
        Self { readings, noise, of_steps: Vector3::zeros() }
    }

    /// Allows for the rounding errors of another recording than the calibration's. At a constant true rate, they are the same in all holds. They differ
    /// as far as the means differ by more than their noise and the scatter of the calibration.
    pub(in crate::estimate) fn with_steps_in_common(self, between_sd: &Vector3<f64>) -> Self {
        let means: Vec<MeanReading> = self.readings.iter().copied().flatten().collect();
        let of_steps = self.noise.of_mean;
        let noise = GyroscopeNoise { of_mean: Vector3::zeros(), ..self.noise };
        let apart = Vector3::from_fn(|axis, _| {
            let of: Vec<f64> = means.iter().map(|mean| mean.mean[axis]).collect();
            let middle = of.iter().sum::<f64>() / of.len().max(1) as f64;
            let squares = of.iter().map(|y| (y - middle).powi(2)).sum::<f64>();
            let by_noise = means.iter().map(|mean| noise.variance(mean.samples)[axis]).sum::<f64>();
            let beyond = squares / of.len().saturating_sub(1).max(1) as f64
                - by_noise / of.len().max(1) as f64
                - between_sd[axis].powi(2);
            beyond.clamp(0.0, of_steps[axis])
        });
        Self { noise: GyroscopeNoise { of_mean: apart, ..noise }, of_steps, ..self }
    }

    /// Variance of the common error of all means by coarse steps.
    pub(in crate::estimate) fn of_steps(&self) -> &Vector3<f64> {
        &self.of_steps
    }

    /// The gyroscope in each hold, `None` where it turns or has no samples there.
    pub(in crate::estimate) fn holds(&self) -> impl Iterator<Item = Option<StationaryMean>> {
        self.readings.iter().map(|still| {
            still.map(|still| StationaryMean {
                mean: still.mean,
                variance: self.noise.variance(still.samples),
            })
        })
    }
}

/// Propagated gravity from one hold to the next.
#[derive(Debug, Clone)]
pub(in crate::estimate) struct PropagatedGravity {
    /// Place of the hold that it begins with.
    pub(in crate::estimate) from: usize,
    /// Begin and end, s.
    pub(in crate::estimate) start_s: f64,
    pub(in crate::estimate) end_s: f64,
    /// Rotation error across gravity, rad.
    pub(in crate::estimate) error: Vector2<f64>,
    /// Derivative with respect to the gyroscope's quantities, 2 × p; zero for those of the accelerometer.
    pub(in crate::estimate) by_parameters: DMatrix<f64>,
    /// Derivative with respect to the specific forces before and after.
    pub(in crate::estimate) by_from: Matrix2x3<f64>,
    pub(in crate::estimate) by_to: Matrix2x3<f64>,
    /// Covariance of the error from the gyroscope's noise.
    pub(in crate::estimate) noise: Matrix2<f64>,
    /// That from knocks.
    pub(in crate::estimate) of_knocks: Matrix2<f64>,
    /// Covariance of the error from the Earth's rate about the north, at an unknown heading.
    pub(in crate::estimate) of_earth: Matrix2<f64>,
    /// Covariance of the noise's error with that of the rotation before, which ends with the same hold. Zero without one.
    pub(in crate::estimate) noise_with_previous: Matrix2<f64>,
}

/// The given values of the rotations.
pub(in crate::estimate) struct GravityPropagation<'a> {
    pub(in crate::estimate) imu: &'a ImuParameters,
    pub(in crate::estimate) quantities: &'a [ImuQuantity],
    pub(in crate::estimate) gravity_mps2: f64,
    /// The Earth's rate about the vertical over gravity, (rad/s)/(m/s²), if it is known.
    pub(in crate::estimate) vertical_rate: f64,
    /// Standard deviation of each component of the Earth's rate about the north, rad/s.
    pub(in crate::estimate) north_sd_radps: f64,
    /// Root mean square of the calibration's knock factors.
    pub(in crate::estimate) knock_rms: f64,
    /// Turns within the holds of the calibration.
    pub(in crate::estimate) turns_in_holds: TurnsInHolds,
    /// Scatter of the gyroscope's bias between holds, in the unit of its readings.
    pub(in crate::estimate) between: Vector3<f64>,
    pub(in crate::estimate) accelerometer: &'a Recording,
    pub(in crate::estimate) gyroscope: &'a Recording,
    pub(in crate::estimate) at_rest: &'a GyroscopeAtRest,
}

impl GravityPropagation<'_> {
    /// Propagates gravity through every rotation between consecutive holds that can be integrated. `forces`: the corrected specific force in each hold.
    /// `temperatures_c`: their temperatures, °C. `None` if a matrix is singular.
    pub(in crate::estimate) fn through(
        &self,
        holds: &[&Hold],
        forces: &[Vector3<f64>],
        temperatures_c: &[f64],
    ) -> Option<Vec<PropagatedGravity>> {
        let g = self.gravity_mps2;
        let GyroscopeAtRest { readings, noise, .. } = self.at_rest;
        let mut data: Vec<HoldData> = holds
            .iter()
            .zip(temperatures_c)
            .map(|(hold, &temperature_c)| HoldData {
                temperature_c,
                ..HoldData::of_accelerometer(hold.mean, Matrix3::zeros())
            })
            .collect();
        set_gyroscope_means(&mut data, readings, noise, &self.between);
        let with_forces =
            self.quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::GSensitivity(..)))
                || self.imu.g_sensitivity.amax() > 0.0;
        let mean_c = temperatures_c.iter().sum::<f64>() / temperatures_c.len().max(1) as f64;
        let felt = with_forces
            .then(|| {
                interpolated_forces(
                    self.accelerometer,
                    self.gyroscope,
                    &self.imu.at(mean_c)[SensorKind::Accelerometer],
                )
            })
            .flatten();
        let spans = rotation_spans(self.gyroscope, holds, &[]);
        let integrable = Integrable::of(self.gyroscope, with_forces.then_some(self.accelerometer));
        let sensor = &self.imu.at(mean_c)[SensorKind::Accelerometer];
        let (at_ends, _) = gravity_at_ends(self.accelerometer, sensor, holds, Some(self.turns_in_holds));
        let rotations = integrable.rotations(felt.as_deref(), &spans, (&data, &at_ends));
        let mut model = ImuModel {
            quantities: self.quantities.to_vec(),
            gravity: g,
            earth: EarthRate::at_place(self.vertical_rate, self.north_sd_radps, g),
            holds: data,
            rotations,
            turns: Vec::new(),
            gyroscope_noise: *noise,
            rotation_scatter: RotationScatter::none(),
            turns_in_holds: self.turns_in_holds,
            prior: None,
        };
        let forces =
            forces.iter().map(|f| f.try_normalize(1e-300).map(|u| u * g)).collect::<Option<Vec<_>>>()?;
        let state = State { imu: *self.imu, forces };
        follow_drift(&mut model, &state, &self.between);
        let residuals = model.gravity_residuals(&state)?;
        model.earth.follow(&model.rotations, &residuals, &state.forces);
        let found = residuals.iter().enumerate().filter_map(|(from, residual)| {
            let (span, data) = (&spans[from], &model.rotations[from]);
            let ends = (span.start_s, span.end_s);
            let previous = from.checked_sub(1).and_then(|before| residuals[before].as_ref());
            residual.as_ref().map(|residual| {
                let by_earth = model.earth.of_rotation(data, residual, &state.imu, &state.forces);
                let of_earth = &by_earth * by_earth.transpose();
                PropagatedGravity { of_earth, ..self.propagated(from, ends, &state, residual, previous) }
            })
        });
        Some(found.collect())
    }

    fn propagated(
        &self,
        from: usize,
        (start_s, end_s): (f64, f64),
        state: &State,
        residual: &GravityResidual,
        previous: Option<&GravityResidual>,
    ) -> PropagatedGravity {
        let (by_from, by_to) =
            residual.by_forces(&state.forces[from], &state.forces[from + 1], self.gravity_mps2);
        PropagatedGravity {
            from,
            start_s,
            end_s,
            error: residual.error,
            by_parameters: DMatrix::from_fn(2, self.quantities.len(), |row, k| {
                residual.by_parameters[(row, k)]
            }),
            by_from,
            by_to,
            noise: residual.covariance,
            of_knocks: residual.of_knocks * self.knock_rms.powi(2),
            of_earth: Matrix2::zeros(),
            noise_with_previous: previous.map_or_else(Matrix2::zeros, |previous| {
                residual.by_turn
                    * residual.rotation.noise_with(&previous.rotation)
                    * previous.by_turn.transpose()
            }),
        }
    }
}

//! The model of an IMU's recording: what the stages of the calibration hand to each other.
//!
//! A recording gives means in the holds ([`HoldData`]), rotations between them ([`RotationData`]) and turns of known angle ([`TurnData`]).
//! [`ImuModel`] holds them with their weights, [`State`] the unknowns. `solver` lists the stages; none of them is used here.

use crate::error::{Error, InputError, Refusal};
use crate::estimate::imu::earth_rate::EarthRate;
use crate::estimate::imu::rotations::gravity_at_ends::TurnsInHolds;
use crate::estimate::imu::rotations::knocks::Knocks;
use crate::estimate::quantisation::{CoarseAxis, of_means};
use crate::estimate::tangent_plane::tangents;
use crate::sensor::{ImuParameters, ImuQuantity, SensorKind};
use crate::solve::CalibrationStatus;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x3, Matrix2xX, Matrix3, Vector2, Vector3};

/// Degrees of freedom of Student's distribution of the errors by knocks.
pub(in crate::estimate) const KNOCK_DEGREES: f64 = 5.0;

/// Knock factor of sensors that filter little: half-sines of one to six sample steps give 0.35 to 0.9 without a filter, and 0.1 to 0.3 with one.
pub(crate) const USUAL_KNOCK_FACTOR: f64 = 0.3;

/// The readings of a rotation.
#[derive(Clone, Copy)]
pub(crate) struct Samples<'a> {
    pub(crate) times_s: &'a [f64],
    pub(crate) readings: &'a [Vector3<f64>],
    /// Specific force at these times, for a gyroscope with g-sensitivity.
    pub(crate) forces: Option<&'a [Vector3<f64>]>,
    /// The bias in the holds before and after. In between it is linear in time.
    pub(crate) drift: [LocalBias; 2],
}

/// The bias at one end of a rotation: `b + share ∘ (mean − b − Γ f − S ω)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LocalBias {
    /// Mean reading of the hold.
    pub(crate) mean: Vector3<f64>,
    /// Specific force in it.
    pub(crate) force: Vector3<f64>,
    /// Angular rate in it: the Earth's, rad/s.
    pub(crate) rate: Vector3<f64>,
    /// Weight of this hold against the mean bias of all, 0 to 1: the share of its variance that is a true deviation.
    pub(crate) share: Vector3<f64>,
    /// Variance of the mean from the noise of its samples.
    pub(crate) variance: Vector3<f64>,
    /// Temperature of the hold, °C.
    pub(crate) temperature_c: f64,
}

impl LocalBias {
    /// The mean bias of all holds.
    pub(crate) fn none(temperature_c: f64) -> Self {
        Self {
            temperature_c,
            mean: Vector3::zeros(),
            force: Vector3::zeros(),
            rate: Vector3::zeros(),
            share: Vector3::zeros(),
            variance: Vector3::zeros(),
        }
    }

    /// The bias of an IMU there.
    pub(crate) fn at(&self, imu: &ImuParameters) -> Vector3<f64> {
        let gyroscope = imu.at(self.temperature_c)[SensorKind::Gyroscope];
        let deviation = self.mean - gyroscope.reading(&self.rate) - imu.g_sensitivity * self.force;
        gyroscope.bias + self.share.component_mul(&deviation)
    }
}

impl Samples<'_> {
    /// Mean temperature of the holds before and after, °C.
    pub(crate) fn temperature_c(&self) -> f64 {
        mean_temperature_c(&self.drift)
    }

    /// Duration, s.
    pub(crate) fn duration_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1] - self.times_s[0]
    }
}

/// Mean temperature of the holds before and after a rotation, °C.
pub(crate) fn mean_temperature_c(ends: &[LocalBias; 2]) -> f64 {
    0.5 * (ends[0].temperature_c + ends[1].temperature_c)
}

/// The noise of the gyroscope at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GyroscopeNoise {
    /// Standard deviation of one sample.
    pub(crate) of_sample: Vector3<f64>,
    /// Variance of a hold's mean that does not depend on its number of samples: that of coarse steps.
    pub(crate) of_mean: Vector3<f64>,
}

impl GyroscopeNoise {
    /// None.
    pub(crate) fn none() -> Self {
        Self { of_sample: Vector3::zeros(), of_mean: Vector3::zeros() }
    }

    /// Noise of a sample in these holds. With coarse steps, at least their own scatter.
    pub(crate) fn of(of_sample: Vector3<f64>, coarse: &[CoarseAxis]) -> Self {
        let mut of_sample = of_sample;
        for found in coarse {
            let sample = &mut of_sample[found.axis.index()];
            *sample = sample.max(found.step / 12.0_f64.sqrt());
        }
        Self { of_sample, of_mean: of_means(coarse) }
    }

    /// Variance of the mean of this number of samples.
    pub(crate) fn variance(&self, samples: usize) -> Vector3<f64> {
        self.of_sample.component_mul(&self.of_sample) / samples as f64 + self.of_mean
    }
}

/// A hold with its weights.
#[derive(Debug, Clone)]
pub(crate) struct HoldData {
    pub(crate) accelerometer: Vector3<f64>,
    /// Inverse covariance of the mean.
    pub(crate) accelerometer_weight: Matrix3<f64>,
    /// Mean reading of the gyroscope and its inverse variances.
    pub(crate) gyroscope: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Specific force, where its direction is known.
    pub(crate) known: Option<Vector3<f64>>,
    pub(crate) temperature_c: f64,
}

impl HoldData {
    /// Without a gyroscope, in an unknown direction.
    pub(in crate::estimate) fn of_accelerometer(mean: Vector3<f64>, weight: Matrix3<f64>) -> Self {
        Self {
            accelerometer: mean,
            accelerometer_weight: weight,
            gyroscope: None,
            known: None,
            temperature_c: 0.0,
        }
    }

    /// Without a gyroscope, in a known direction.
    pub(crate) fn on_face(mean: Vector3<f64>, weight: Matrix3<f64>, force: Vector3<f64>) -> Self {
        Self { known: Some(force), ..Self::of_accelerometer(mean, weight) }
    }
}

/// A rotation from one hold to the next one used.
#[derive(Clone)]
pub(crate) struct RotationData<'a> {
    /// Place among the holds of the one it begins with.
    pub(crate) from: usize,
    pub(crate) samples: Samples<'a>,
    pub(crate) knocks: Knocks,
    /// Specific force at its begin less the mean over the hold before, and at its end less that over the hold after, m/s².
    pub(crate) beside_means: [Vector3<f64>; 2],
    /// Can it be integrated?
    pub(crate) used: bool,
    /// Is it used, or an outlier?
    pub(crate) counts: bool,
}

/// A turn of known angle about an axis that is fixed in the sensor.
#[derive(Debug, Clone)]
pub(crate) struct TurnData {
    /// `∫ y_g dt` and the duration.
    pub(crate) integral: Vector3<f64>,
    pub(crate) duration_s: f64,
    /// `∫ f dt`.
    pub(crate) force: Vector3<f64>,
    /// `φ e`, rad.
    pub(crate) angle: Vector3<f64>,
    /// Inverse variances of the integral.
    pub(crate) weight: Vector3<f64>,
    pub(crate) temperature_c: f64,
}

impl TurnData {
    /// The integral of the gyroscope's readings beyond its bias, in the unit of its readings times s.
    pub(crate) fn beyond_bias(&self, imu: &ImuParameters) -> Vector3<f64> {
        self.integral - imu.at(self.temperature_c)[SensorKind::Gyroscope].bias * self.duration_s
    }
}

/// An integrated rotation.
#[derive(Debug, Clone)]
pub(crate) struct IntegratedRotation {
    /// Takes vectors of the sensor's frame at the end to that at the start.
    pub(crate) start_from_end: Matrix3<f64>,
    /// `∫ R(t) e_r ω_c dt`: column r of entry c.
    pub(crate) by_rate: [Matrix3<f64>; 3],
    /// `∫ R(t) (1 − x) dt` and `∫ R(t) x dt` with x from 0 to 1: the effects of the bias in the holds before and after.
    pub(crate) by_start: Matrix3<f64>,
    pub(crate) by_end: Matrix3<f64>,
    pub(crate) drift: [LocalBias; 2],
    /// `∫ R(t) e_r f_c dt`.
    pub(crate) by_force: [Matrix3<f64>; 3],
    /// `M`.
    pub(crate) correction: Matrix3<f64>,
    /// Covariance of `δθ` from the noise of the samples.
    pub(crate) covariance: Matrix3<f64>,
}

/// The residual of a rotation at a state, and its derivatives.
#[derive(Clone)]
pub(crate) struct GravityResidual {
    /// The arc from `f_k` to propagated gravity, rad.
    pub(crate) error: Vector2<f64>,
    pub(crate) by_from: Matrix2<f64>,
    pub(crate) by_to: Matrix2<f64>,
    /// Derivative with respect to a rotation of the start's frame.
    pub(crate) by_turn: Matrix2x3<f64>,
    pub(crate) by_parameters: Matrix2xX<f64>,
    /// Covariance of the error from the gyroscope's noise.
    pub(crate) covariance: Matrix2<f64>,
    /// That from knocks, for a knock factor of 1.
    pub(crate) of_knocks: Matrix2<f64>,
    pub(crate) rotation: IntegratedRotation,
}

/// The scatter of the rotation errors beyond the noise of the samples.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RotationScatter {
    /// Between-rotation standard deviation `σ_r`, rad per axis.
    pub(crate) between_sd_rad: f64,
    /// Knock factor `κ`: the error of a knock's integral over the fourth difference of its samples times their step.
    pub(crate) knock_factor: f64,
    /// Root mean square of the factors of all rotations.
    pub(crate) knock_rms: f64,
    /// The factor of each rotation, larger where its error is. Empty where it is that of all.
    pub(crate) own_factors: Vec<f64>,
}

impl RotationScatter {
    /// Noise alone. The knock factor is the usual one.
    pub(crate) fn none() -> Self {
        let knock_factor = USUAL_KNOCK_FACTOR;
        let knock_rms = knock_factor * (KNOCK_DEGREES / (KNOCK_DEGREES - 2.0)).sqrt();
        Self { between_sd_rad: 0.0, knock_factor, knock_rms, own_factors: Vec::new() }
    }

    /// Covariance of the error of this rotation.
    pub(crate) fn covariance(&self, rotation: usize, residual: &GravityResidual) -> Matrix2<f64> {
        let factor = self.own_factors.get(rotation).copied().unwrap_or(self.knock_factor);
        residual.covariance
            + residual.of_knocks * factor.powi(2)
            + Matrix2::identity() * (self.between_sd_rad.powi(2) + 1e-18)
    }
}

/// The residual of each rotation at a state. `None` for those that cannot be integrated.
pub(crate) type GravityResiduals = Vec<Option<GravityResidual>>;

impl GravityResidual {
    /// Derivative of the error with respect to the specific forces before and after the rotation, across which they may turn.
    pub(crate) fn by_forces(
        &self,
        from: &Vector3<f64>,
        to: &Vector3<f64>,
        gravity: f64,
    ) -> (Matrix2x3<f64>, Matrix2x3<f64>) {
        let across = |force: &Vector3<f64>| tangents(force).transpose() / gravity;
        (self.by_from * across(from), self.by_to * across(to))
    }
}

/// A point of the iteration.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) imu: ImuParameters,
    pub(crate) forces: Vec<Vector3<f64>>,
}

/// The prior: mean and inverse variance of each quantity, 0 without one.
pub(crate) type Prior = (Vec<f64>, Vec<f64>);

/// The problem for given weights.
#[derive(Clone)]
pub(crate) struct ImuModel<'a> {
    pub(crate) quantities: Vec<ImuQuantity>,
    pub(crate) gravity: f64,
    pub(crate) earth: EarthRate,
    pub(crate) holds: Vec<HoldData>,
    pub(crate) rotations: Vec<RotationData<'a>>,
    pub(crate) turns: Vec<TurnData>,
    /// Noise of the gyroscope's samples, and of its coarse steps.
    pub(crate) gyroscope_noise: GyroscopeNoise,
    /// Scatter of the rotation errors beyond this noise.
    pub(crate) rotation_scatter: RotationScatter,
    /// Turns within the holds, as the accelerometer shows them.
    pub(crate) turns_in_holds: TurnsInHolds,
    pub(crate) prior: Option<Prior>,
}

impl ImuModel<'static> {
    /// An IMU without a gyroscope.
    pub(in crate::estimate) fn of_accelerometer(
        quantities: Vec<ImuQuantity>,
        gravity: f64,
        holds: Vec<HoldData>,
        prior: Option<Prior>,
    ) -> Self {
        Self {
            quantities,
            gravity,
            earth: EarthRate::at_place(0.0, 0.0, gravity),
            holds,
            rotations: Vec::new(),
            turns: Vec::new(),
            gyroscope_noise: GyroscopeNoise::none(),
            rotation_scatter: RotationScatter::none(),
            turns_in_holds: TurnsInHolds::default(),
            prior,
        }
    }
}

impl ImuModel<'_> {
    /// Number of quantities with a prior.
    pub(crate) fn priors(&self) -> usize {
        self.prior.as_ref().map_or(0, |(_, weight)| weight.iter().filter(|weight| **weight > 0.0).count())
    }

    /// Places of the gyroscope's quantities.
    pub(crate) fn gyroscope_places(&self) -> Vec<usize> {
        (0..self.quantities.len())
            .filter(|&k| self.quantities[k].sensor_kind() == SensorKind::Gyroscope)
            .collect()
    }
}

/// The end of the iteration.
pub(crate) struct Fit {
    pub(crate) state: State,
    pub(crate) residuals: GravityResiduals,
    pub(crate) information: DMatrix<f64>,
    /// Diagonal of the information before the directions were eliminated.
    pub(crate) unreduced: DVector<f64>,
    pub(crate) chi2: f64,
    pub(crate) status: CalibrationStatus,
    pub(crate) iterations: usize,
    pub(crate) gradient_norm: f64,
}

/// The error that an estimated matrix is or becomes singular.
pub(crate) fn singular() -> Error {
    Error::recording(InputError::new(
        Refusal::FitFailed,
        "the fit of the rotations breaks down: an estimated matrix becomes singular",
        "check the units of both sensors and that the files belong together",
    ))
}

//! Made-up results: simulated readings, fitted only as far as a picture needs it.

use super::{estimate, motion, sensor, study};
use calibrant_core::diagnostic::holds::HoldLeftOut;
use calibrant_core::diagnostic::{Diagnostic, HoldReason, HoldSpan};
use estimate::{
    Calibration, CalibrationStatus, FitStatistics, HoldCalibration, HoldResult, Recovered, RecoveredClock,
    RecoveredMotion, Uncalibrated, Whiteness,
};
use motion::{Gravity, Hold, JerkControlledMotion};
use nalgebra::{DMatrix, Matrix3, Vector3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use sensor::{
    Gauge, ImuParameters, ImuRecording, PerSensor, Quantity, ReadingUnit, Recording, Sensor, SensorKind,
    SensorModel, SensorParameters,
};
use study::SingleCase;

/// Noise of one sample, m/s².
const NOISE: f64 = 2e-4;

pub(crate) struct Dice(ChaCha8Rng);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub(crate) fn normal(&mut self, sd: f64) -> f64 {
        let z: f64 = StandardNormal.sample(&mut self.0);
        sd * z
    }

    fn vector(&mut self, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal(sd))
    }
}

/// One sensor on a random motion of `intervals` intervals of 5 s.
pub(crate) fn motion_case(axes: usize, intervals: usize, rate_hz: f64, seed: u64) -> SingleCase {
    let mut dice = Dice::new(seed);
    let datasheet = Sensor { axes, ..Sensor::memsic_mxd2020u() };
    let active = Vector3::from_fn(|i, _| if i < axes { 1.0 } else { 0.0 });
    let mut node: Vector3<f64> = dice.vector(1.0).component_mul(&active);
    let mut nodes = vec![node];
    for _ in 0..intervals {
        node = node * 0.8 + dice.vector(1.5).component_mul(&active);
        nodes.push(node);
    }
    let true_motion = JerkControlledMotion::uniform(5.0, nodes.clone()).expect("valid motion");
    let truth = SensorParameters {
        bias: dice.vector(0.1).component_mul(&active),
        matrix: Matrix3::from_diagonal(&(Vector3::repeat(1.0) + dice.vector(0.005))),
        ..SensorParameters::identity()
    };
    let samples = (intervals as f64 * 5.0 * rate_hz) as usize + 1;
    let times_s: Vec<f64> = (0..samples).map(|j| j as f64 / rate_hz).collect();
    let readings: Vec<_> = times_s
        .iter()
        .map(|&t| {
            (truth.reading(&true_motion.acceleration_at(t)) + dice.vector(NOISE)).component_mul(&active)
        })
        .collect();
    let unit = ReadingUnit::MetrePerSecondSquared;
    let recording = Recording::new(times_s, readings, axes, unit).expect("samples in order");
    let calibration = calibrated(&datasheet, &truth, &true_motion, &recording, &mut dice);
    SingleCase { truth, true_motion, recording, calibration }
}

fn calibrated(
    datasheet: &Sensor,
    truth: &SensorParameters,
    true_motion: &JerkControlledMotion,
    recording: &Recording,
    dice: &mut Dice,
) -> Calibration {
    let axes = recording.axes();
    let list = datasheet.parameter_list();
    let p = list.len();
    let (sd_bias, sd_scale, rho) = (7e-5, 6e-5, -0.35);
    let mut covariance = DMatrix::zeros(p, p);
    let mut estimate = *truth;
    for i in 0..axes {
        covariance[(i, i)] = sd_bias * sd_bias;
        covariance[(axes + i, axes + i)] = sd_scale * sd_scale;
        covariance[(i, axes + i)] = rho * sd_bias * sd_scale;
        covariance[(axes + i, i)] = rho * sd_bias * sd_scale;
        estimate.bias[i] += dice.normal(sd_bias);
        estimate.matrix[(i, i)] += dice.normal(sd_scale);
    }
    // the motion that explains the readings with these parameters, as an estimator would find it
    let last = true_motion.intervals();
    let nodes = true_motion.acceleration_mps2().iter().enumerate().map(|(k, a)| {
        let moved = Vector3::from_fn(|i, _| {
            (truth.matrix[(i, i)] * a[i] + truth.bias[i] - estimate.bias[i]) / estimate.matrix[(i, i)]
        });
        if k == 0 || k == last { *a } else { moved + dice.vector(6e-5) }
    });
    let motion =
        JerkControlledMotion::new(true_motion.times_s().to_vec(), nodes.collect()).expect("valid motion");
    let sd = |k: usize| if k == 0 || k == last { 0.0 } else { 1.1e-4 };
    let acceleration_sd_mps2 = (0..=last).map(|k| Vector3::repeat(sd(k))).collect();
    let residuals: Vec<Vector3<f64>> = recording
        .times_s()
        .iter()
        .zip(recording.readings())
        .map(|(&t, y)| y - estimate.reading(&motion.acceleration_at(t)))
        .collect();
    let rms = Vector3::from_fn(|i, _| {
        (residuals.iter().map(|r| r[i] * r[i]).sum::<f64>() / residuals.len() as f64).sqrt()
    });
    let degrees_of_freedom = axes * (residuals.len() - last - 1);
    Calibration {
        status: CalibrationStatus::Converged,
        iterations: 5,
        gradient_norm: 3.2e-11,
        quantities: list.of_accelerometer(),
        parameters: list.describe_accelerometer(datasheet, &SensorParameters::identity()),
        values: list.quantities().iter().map(|quantity| quantity.value(&estimate)).collect(),
        covariance,
        budget: Vec::new(),
        prior_share: Vec::new(),
        gravity_slope: Vec::new(),
        datasheet_prior: false,
        imu: ImuParameters::identity().with(SensorKind::Accelerometer, estimate),
        units: PerSensor::only(SensorKind::Accelerometer, recording.unit()),
        counts_per_unit: PerSensor::default(),
        fit: FitStatistics {
            chi2: degrees_of_freedom as f64 * 1.013,
            degrees_of_freedom,
            p_value: Some(0.417),
            residual_rms: Some(rms),
            assumed_noise: Some(Vector3::repeat(NOISE)),
            noise_estimate: Some(rms * 1.02),
            whiteness: vec![Whiteness { statistic: 17.3, lags: 20, p_value: 0.63 }; axes],
        },
        recovered: Recovered::Motion(RecoveredMotion {
            motion,
            acceleration_sd_mps2,
            trust: "unknown",
            gravity: None,
            clock: RecoveredClock::default(),
            residuals,
            first_sample: 0,
        }),
        gyroscope: None,
        soak: None,
        soak_prior: Vec::new(),
        changes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// A static calibration of a sensor in counts: 38 holds, one of them bad.
pub(crate) fn hold_case(count: usize, samples_per_hold: usize) -> (Calibration, ImuRecording) {
    let mut dice = Dice::new(38);
    let mut datasheet = Sensor::triaxial(SensorModel::Full);
    datasheet.unit = ReadingUnit::Counts;
    let matrix = Matrix3::new(414.46, 1.4, 3.7, 0.0, 412.01, 8.8, 0.0, 0.0, 414.65);
    let bias = Vector3::new(33124.18, 33275.18, 32364.42);
    let truth = Gauge::Upper.apply(&SensorParameters::linear(bias, matrix));
    let (rate, between) = (100.0, samples_per_hold / 3);
    let mut recording = Recording::new(Vec::new(), Vec::new(), 3, ReadingUnit::Counts).expect("no samples");
    let mut holds = Vec::new();
    let mut previous = Vector3::new(0.0, 0.0, 9.81);
    for number in 0..count {
        let force = dice.vector(1.0).normalize() * 9.81744;
        for step in 0..between {
            let swing = previous.lerp(&force, step as f64 / between as f64) + dice.vector(1.5);
            push(&mut recording, truth.reading(&swing), rate);
        }
        let first = recording.len();
        let disturbance = if number == 17 { 0.02 } else { 0.001 };
        let mean = truth.reading(&(force * (1.0 + dice.normal(disturbance) / 9.8)));
        for _ in 0..samples_per_hold {
            let noisy = mean + dice.vector(3.3);
            push(&mut recording, noisy, rate);
        }
        let end = recording.len();
        let time = |k: usize| recording.times_s()[k];
        let residual = if number == 17 { 0.021 } else { dice.normal(0.001) };
        holds.push(HoldResult {
            hold: Hold {
                first,
                end,
                start_s: time(first),
                end_s: time(end - 1),
                mean,
                sd: Vector3::repeat(3.3),
            },
            force_mps2: force,
            magnitude_residual_mps2: residual,
            magnitude_sd_mps2: 0.001,
            studentised_residual: residual / 0.001,
            used: number != 17,
            reason: None,
        });
        previous = force;
    }
    let nothing_given = Sensor { gain: None, offset: None, ..datasheet.clone() };
    let list = Gauge::Upper.parameter_list(SensorModel::Full);
    let p = list.len();
    let sd = [0.25, 0.14, 0.15, 0.027, 0.014, 0.016, 0.055, 0.2, 0.05];
    let covariance = DMatrix::from_fn(p, p, |i, j| {
        let correlation = if i == j { 1.0 } else { 0.9 * ((i * 7 + j * 7 + i * j) as f64).sin() };
        correlation * sd[i] * sd[j]
    });
    let by_gravity =
        |of: &Quantity| if matches!(of, Quantity::Bias(_)) { 0.0 } else { -of.value(&truth) / 9.81744 };
    let calibration = Calibration {
        status: CalibrationStatus::Converged,
        iterations: 6,
        gradient_norm: 4e-9,
        quantities: list.of_accelerometer(),
        parameters: list.describe_accelerometer(&datasheet, &truth),
        values: list.quantities().iter().map(|quantity| quantity.value(&truth)).collect(),
        covariance,
        budget: Vec::new(),
        prior_share: Vec::new(),
        gravity_slope: list.quantities().iter().map(by_gravity).collect(),
        datasheet_prior: false,
        imu: ImuParameters::identity().with(SensorKind::Accelerometer, truth),
        units: PerSensor::only(SensorKind::Accelerometer, ReadingUnit::Counts),
        counts_per_unit: PerSensor::default(),
        fit: FitStatistics {
            chi2: 28.0,
            degrees_of_freedom: count.saturating_sub(10),
            p_value: None,
            residual_rms: Some(Vector3::repeat(0.42)),
            assumed_noise: None,
            noise_estimate: Some(Vector3::repeat(3.3)),
            whiteness: Vec::new(),
        },
        recovered: Recovered::Holds(HoldCalibration {
            holds,
            gravity: Gravity { magnitude_mps2: 9.81744, sd_mps2: 3.5e-4 },
            gauge: Gauge::Upper,
            between_holds_sd_mps2: 0.00098,
            between_holds_dominates: true,
            drift: None,
            recording_biases: None,
            tilt: None,
            magnitude_residual_rms_mps2: 0.00096,
            degrees_of_freedom: 9,
            condition_number: 17.4,
            detected: true,
            before: Uncalibrated::accelerometer(&nothing_given, &truth),
            temperatures_c: None,
            thermometer: None,
            change: None,
        }),
        gyroscope: None,
        soak: None,
        soak_prior: Vec::new(),
        changes: Vec::new(),
        warnings: vec![Diagnostic::from(HoldLeftOut {
            hold: HoldSpan { number: 18, start_s: 170.0, end_s: 175.0 },
            why: HoldReason::MagnitudeOff { residual_mps2: 0.1, studentised: 21.0 },
        })],
    };
    (calibration, recording.into())
}

fn push(recording: &mut Recording, reading: Vector3<f64>, rate: f64) {
    recording.push(recording.len() as f64 / rate, reading.map(f64::round)).expect("samples in order");
}

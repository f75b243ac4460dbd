//! A whole IMU turned by hand: simulated readings, really calibrated.

use super::{estimate, motion, sensor};
use estimate::{
    Calibration, CalibrationSettings, Gyroscope, HoldsSetup, ImuProblem, ImuSetup, KnownTerm, Turn,
    calibrate_imu,
};
use motion::Gravity;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use sensor::{
    Axis, Gauge, ImuParameters, ImuQuantity, ImuRecording, ReadingUnit, Recording, Sensor, SensorKind,
    SensorModel, SensorParameters, Thermal,
};

/// Sample rate, Hz.
const RATE_HZ: f64 = 50.0;
/// Duration of a hold, s.
const HOLD_S: f64 = 2.0;
/// Duration of a turn, s.
const TURN_S: f64 = 2.0;
/// Gravity where the IMU is calibrated.
const GRAVITY: Gravity = Gravity { magnitude_mps2: 9.81, sd_mps2: 3.5e-4 };
/// The rotation that is disturbed.
pub(crate) const DISTURBED: usize = 5;

/// The recording and its calibration.
pub(crate) struct ImuCase {
    pub(crate) recording: ImuRecording,
    pub(crate) calibration: Calibration,
}

/// An IMU in counts through this number of holds. A disturbance falls into one rotation, the last rotation is
/// a known turn about z, and one entry of the g-sensitivity has a prior.
pub(crate) fn imu_case(holds: usize, seed: u64) -> ImuCase {
    let truth = truth();
    let mut hand = Hand::new(&truth, seed);
    let (mut intervals_s, mut turns) = (Vec::new(), Vec::new());
    for number in 0..holds {
        let start_s = hand.time_s();
        hand.turn(&Vector3::zeros(), HOLD_S, Vector3::zeros());
        intervals_s.push((start_s + 0.1, hand.time_s() - 0.1));
        let start_s = hand.time_s();
        if number + 2 == holds {
            let axis = Vector3::z();
            let angle_rad = std::f64::consts::TAU;
            hand.turn(&(axis * angle_rad), TURN_S, Vector3::zeros());
            let end_s = hand.time_s();
            turns.push(Turn {
                name: None,
                start_s,
                end_s,
                axis,
                angle_rad,
                angle_sd_rad: 0.01,
                axis_sd_rad: None,
            });
        } else if number + 1 < holds {
            let axis = Unit::new_normalize(hand.vector(1.0));
            let angle = 1.5 + hand.vector(0.3).x;
            let knock = if number == DISTURBED { 600.0 } else { 0.0 };
            hand.turn(&(axis.into_inner() * angle), TURN_S, Vector3::repeat(knock));
        }
    }
    let recording = hand.recording;
    let gain = Some(Vector3::repeat(4778.0));
    let gyroscope =
        Gyroscope { unit: ReadingUnit::Counts, gain, g_sensitivity: true, ..Gyroscope::default() };
    let known =
        KnownTerm { quantity: ImuQuantity::GSensitivity(Axis::X, Axis::X), value: 0.0, sd: Some(0.08) };
    let setup = ImuSetup {
        holds: HoldsSetup {
            gravity: GRAVITY,
            gauge: Gauge::Upper,
            intervals_s: Some(intervals_s),
            bias_drift_sd_mps2: 0.0,
            ..HoldsSetup::default()
        },
        turns,
        known: vec![known],
        ..ImuSetup::default()
    };
    let accelerometer =
        Sensor { unit: ReadingUnit::Counts, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) };
    let problem = ImuProblem {
        accelerometer: &accelerometer,
        gyroscope: &gyroscope,
        recording: &recording,
        setup: &setup,
    };
    let calibration =
        calibrate_imu(&problem, &CalibrationSettings::default()).expect("turned about all axes");
    ImuCase { recording, calibration }
}

fn truth() -> ImuParameters {
    ImuParameters {
        sensors: [
            SensorParameters {
                bias: Vector3::new(33124.0, 33275.0, 32364.0),
                matrix: Matrix3::new(414.5, 1.4, 3.7, 0.0, 412.0, 8.8, 0.0, 0.0, 414.7),
                ..SensorParameters::identity()
            },
            SensorParameters {
                bias: Vector3::new(32777.0, 32459.0, 32511.0),
                matrix: Matrix3::new(4778.0, -25.0, 60.0, 18.0, 4764.0, -31.0, 44.0, 9.0, 4766.0),
                ..SensorParameters::identity()
            },
        ]
        .into(),
        g_sensitivity: Matrix3::new(0.1, 0.3, -0.1, 0.0, 0.2, 0.1, -0.2, 0.1, 0.4),
        thermal: Thermal::none(),
    }
}

/// Turns the IMU and records it.
struct Hand<'a> {
    truth: &'a ImuParameters,
    rng: ChaCha8Rng,
    /// True frame of the sensor in the world's.
    world_from_sensor: Rotation3<f64>,
    recording: ImuRecording,
}

impl<'a> Hand<'a> {
    fn new(truth: &'a ImuParameters, seed: u64) -> Self {
        let empty = Recording::new(Vec::new(), Vec::new(), 3, ReadingUnit::Counts).expect("no samples");
        Self {
            truth,
            rng: ChaCha8Rng::seed_from_u64(seed),
            world_from_sensor: Rotation3::identity(),
            recording: ImuRecording {
                sensors: [Some(empty.clone()), Some(empty)].into(),
                temperature_c: None,
            },
        }
    }

    fn vector(&mut self, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| {
            let z: f64 = StandardNormal.sample(&mut self.rng);
            sd * z
        })
    }

    fn time_s(&self) -> f64 {
        self.recording[SensorKind::Gyroscope]
            .as_ref()
            .map_or(0.0, |gyroscope| gyroscope.len() as f64 / RATE_HZ)
    }

    /// Turns by this angle about a fixed axis, beginning and ending at rest. `knock` adds to the gyroscope's
    /// readings in the quickest part.
    fn turn(&mut self, angle: &Vector3<f64>, duration_s: f64, knock: Vector3<f64>) {
        let start = self.world_from_sensor;
        let samples = (duration_s * RATE_HZ) as usize;
        for k in 0..samples {
            let x = k as f64 / samples as f64;
            let share = x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x);
            let rate = angle * (30.0 * (x * (1.0 - x)).powi(2) / duration_s);
            let force =
                (start * Rotation3::new(angle * share)).inverse() * Vector3::z() * GRAVITY.magnitude_mps2;
            let knocked = if (0.4..0.6).contains(&x) { knock } else { Vector3::zeros() };
            let accelerometer = self.truth[SensorKind::Accelerometer].reading(&force) + self.vector(3.3);
            let gyroscope = self.truth[SensorKind::Gyroscope].reading(&rate)
                + self.truth.g_sensitivity * force
                + knocked
                + self.vector(20.0);
            let time_s = self.time_s();
            for (sensor_kind, reading) in SensorKind::ALL.into_iter().zip([accelerometer, gyroscope]) {
                if let Some(recording) = &mut self.recording[sensor_kind] {
                    recording.push(time_s, reading).expect("samples in order");
                }
            }
        }
        self.world_from_sensor = start * Rotation3::new(*angle);
    }
}

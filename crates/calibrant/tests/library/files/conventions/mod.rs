//! Tests of calibrations in every convention: there and back again, into a C program, and every fault of a
//! file.

mod broken;
mod c_header;
mod exports;
mod nonlinearity;
mod round_trips;
mod temperature;
mod warnings;

use calibrant::io::{
    CalibratedImuFile, ConventionOptions, ImuFormat, Input, calibrated_imu_texts, parse_calibrated_imu,
};
use calibrant::sensor::{
    CalibratedImu, ImuCorrection, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorParameters,
    Thermal,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A whole IMU in some true frame with everything in it, covariance and g-sensitivity too.
pub(crate) fn imu(unit: [ReadingUnit; 2], g_sensitivity: bool) -> CalibratedImu {
    let counts = |unit| unit == ReadingUnit::Counts;
    let (gain_a, zero_a) = if counts(unit[0]) { (414.5, 33124.0) } else { (1.0, 0.1) };
    let (gain_g, zero_g) = if counts(unit[1]) { (4778.0, 32777.0) } else { (1.0, -0.02) };
    let shape = Matrix3::new(1.003, 0.004, 0.009, -0.005, 0.994, 0.021, 0.001, 0.007, 1.0006);
    let parameters = ImuParameters {
        sensors: [
            SensorParameters {
                bias: Vector3::new(zero_a, 1.004 * zero_a, 0.97 * zero_a),
                matrix: shape * gain_a,
                ..SensorParameters::identity()
            },
            SensorParameters {
                bias: Vector3::new(zero_g, 0.99 * zero_g, 1.01 * zero_g),
                matrix: shape.transpose()
                    * Matrix3::new(1.0, 0.0, 0.01, 0.02, 0.997, 0.0, 0.0, -0.03, 0.998)
                    * gain_g,
                ..SensorParameters::identity()
            },
        ]
        .into(),
        g_sensitivity: if g_sensitivity {
            Matrix3::new(1e-4, -2e-4, 3e-5, 4e-5, 1.5e-4, -6e-5, 7e-5, 8e-5, 9e-5) * gain_g
        } else {
            Matrix3::zeros()
        },
        thermal: Thermal::none(),
    };
    let quantities = ImuQuantity::full_list(true, true, g_sensitivity);
    let n = quantities.len();
    let root = DMatrix::from_fn(n, n, |i, j| {
        if i == j { 1e-3 } else { 1e-5 * f64::from(u8::try_from((3 * i + 5 * j) % 7).expect("small")) }
    });
    let frame = "the plate's: x along its long edge; z \"up\" # */ ";
    CalibratedImu {
        covariance: Some(&root * root.transpose()),
        ..CalibratedImu::new(parameters, unit.map(Some), quantities, frame)
    }
}

/// Readings in SI units.
pub(crate) const SI: [ReadingUnit; 2] = [ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond];
/// Readings in counts.
pub(crate) const COUNTS: [ReadingUnit; 2] = [ReadingUnit::Counts, ReadingUnit::Counts];

pub(crate) fn file(imu: CalibratedImu) -> CalibratedImuFile {
    let input =
        Input { file: "recording.csv".into(), sha256: "ab".repeat(32), samples: 123_456, rate_hz: 100.0 };
    CalibratedImuFile {
        imu,
        noise: None,
        inputs: vec![input],
        station: None,
        format: ImuFormat::CalibrantJson,
        findings: Vec::new(),
    }
}

/// Reads back the written calibration, one file for each text.
pub(crate) fn there_and_back(file: &CalibratedImuFile, format: ImuFormat) -> Vec<CalibratedImuFile> {
    let texts =
        calibrated_imu_texts(file, format).unwrap_or_else(|error| panic!("{}: {error}", format.name()));
    texts
        .iter()
        .map(|(_, text)| {
            parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default())
                .unwrap_or_else(|error| panic!("{}: {error}\n{text}", format.name()))
        })
        .collect()
}

/// Readings of an IMU at random stimuli within ±20 m/s² and ±10 rad/s, with the stimuli.
pub(crate) fn readings(imu: &CalibratedImu, count: usize, seed: u64) -> Vec<[Vector3<f64>; 2]> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut random = |range: f64| Vector3::from_fn(|_, _| rng.random_range(-range..range));
    (0..count)
        .map(|_| {
            let (force, rate) = (random(20.0), random(10.0));
            let p = &imu.parameters;
            [
                p[SensorKind::Accelerometer].reading(&force),
                p[SensorKind::Gyroscope].reading(&rate) + p.g_sensitivity * force,
            ]
        })
        .collect()
}

/// Largest difference between two corrections of these readings, relative to 1 m/s² and 1 rad/s; the frames must be the same.
pub(crate) fn largest_difference(
    a: &CalibratedImu,
    b: &CalibratedImu,
    readings: &[[Vector3<f64>; 2]],
) -> f64 {
    let [one, other] = [a, b].map(|imu| ImuCorrection::of(imu).expect("regular"));
    let mut largest = 0.0_f64;
    for [y_a, y_g] in readings {
        let zero = Vector3::zeros();
        if let (Some(x), Some(y)) = (one.force(y_a), other.force(y_a)) {
            largest = largest.max((x - y).amax());
        }
        let force = |c: &ImuCorrection| c.force(y_a).unwrap_or(zero);
        if let (Some(x), Some(y)) = (one.rate(y_g, &force(&one)), other.rate(y_g, &force(&other))) {
            largest = largest.max((x - y).amax());
        }
    }
    largest
}

/// The IMU with one of its sensors only.
pub(crate) fn alone(imu: &CalibratedImu, sensor_kind: SensorKind) -> CalibratedImu {
    let mut alone = CalibratedImu {
        units: [
            imu.unit(SensorKind::Accelerometer).filter(|_| sensor_kind == SensorKind::Accelerometer),
            imu.unit(SensorKind::Gyroscope).filter(|_| sensor_kind == SensorKind::Gyroscope),
        ]
        .into(),
        quantities: ImuQuantity::full_list(
            sensor_kind == SensorKind::Accelerometer,
            sensor_kind == SensorKind::Gyroscope,
            false,
        ),
        covariance: None,
        degrees_of_freedom: None,
        shared: None,
        ..imu.clone()
    };
    alone.parameters.g_sensitivity = Matrix3::zeros();
    match sensor_kind {
        SensorKind::Accelerometer => alone.parameters[SensorKind::Gyroscope] = SensorParameters::identity(),
        SensorKind::Gyroscope => alone.parameters[SensorKind::Accelerometer] = SensorParameters::identity(),
    }
    alone
}

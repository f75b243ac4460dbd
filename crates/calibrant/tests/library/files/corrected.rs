//! Tests of a corrected recording as CSV: its numbers against the model of the readings, solved anew, and
//! against drawn calibrations.

use super::conventions::{SI, imu};
use calibrant::io::{ImuUnit, write_corrected_recording};
use calibrant::sensor::{
    CalibratedImu, ImuCorrection, ImuParameters, ImuRecording, ReadingUnit, Recording, SensorKind,
};
use calibrant::simulate::{Purpose, Rng, stream};
use nalgebra::{DVector, Vector3};
use rand_distr::{Distribution, StandardNormal};
use std::collections::BTreeMap;

/// A row of the file by the names of its columns, without empty fields.
fn rows(text: &str) -> Vec<BTreeMap<String, f64>> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| {
            let fields = line.split(',');
            let filled = header.iter().zip(fields).filter(|(_, field)| !field.is_empty());
            filled.map(|(name, field)| ((*name).to_owned(), field.parse().expect("a number"))).collect()
        })
        .collect()
}

fn vector(row: &BTreeMap<String, f64>, name: &str) -> Vector3<f64> {
    Vector3::from_fn(|k, _| row[&name.replace('?', ["x", "y", "z"][k])])
}

/// The `f` and `ω` for which this IMU gives these readings: `y_a = S_a f + b_a`, `y_g = S_g ω + b_g + Γ f`,
/// solved by LU.
fn solved(p: &ImuParameters, y_a: &Vector3<f64>, y_g: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let force = p[SensorKind::Accelerometer]
        .matrix
        .lu()
        .solve(&(y_a - p[SensorKind::Accelerometer].bias))
        .expect("regular");
    let felt = p.g_sensitivity * force;
    (
        force,
        p[SensorKind::Gyroscope]
            .matrix
            .lu()
            .solve(&(y_g - p[SensorKind::Gyroscope].bias - felt))
            .expect("regular"),
    )
}

fn drawn(imu: &CalibratedImu, rng: &mut Rng) -> ImuParameters {
    let root = imu.covariance.as_ref().expect("known").clone().cholesky().expect("positive").l();
    let step = root * DVector::from_fn(imu.quantities.len(), |_, _| StandardNormal.sample(rng));
    let mut parameters = imu.parameters;
    imu.quantities
        .iter()
        .zip(step.iter())
        .for_each(|(quantity, step)| quantity.add_to(&mut parameters, *step));
    parameters
}

#[test]
fn both_sensors_columns_are_the_solved_model_and_their_sd_that_of_drawn_calibrations() {
    let imu = imu(SI, true);
    let (times, readings_a) = (
        vec![0.0, 0.01, 0.02],
        vec![Vector3::new(0.3, -9.1, 2.0), Vector3::new(1.3, -8.1, 3.0), Vector3::new(2.0, -7.0, 5.0)],
    );
    // the second sample of the gyroscope falls between two of the accelerometer, which has none of its own there
    let (times_g, readings_g) = (
        vec![0.0, 0.013, 0.02],
        vec![Vector3::new(1.5, -0.4, 0.8), Vector3::new(-2.5, 3.0, 0.1), Vector3::new(0.0, 0.1, -4.0)],
    );
    let sensor_kind = |times_s: &Vec<f64>, readings: &Vec<Vector3<f64>>, unit: ReadingUnit| {
        Recording::new(times_s.clone(), readings.clone(), 3, unit).expect("samples in order")
    };
    let recording = ImuRecording {
        sensors: [
            Some(sensor_kind(&times, &readings_a, SI[0])),
            Some(sensor_kind(&times_g, &readings_g, SI[1])),
        ]
        .into(),
        temperature_c: None,
    };
    let corrected = ImuCorrection::of(&imu).expect("regular").apply(&recording).expect("both");
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("corrected.csv");
    let units = [ImuUnit::MetrePerSecondSquared, ImuUnit::RadianPerSecond].into();
    write_corrected_recording(&path, &corrected, "imu.json", units).expect("written");
    let text = std::fs::read_to_string(&path).expect("readable");
    let refused = calibrant::io::check_not_corrected(&path).expect_err("corrected").to_string();
    assert!(refused.contains("corrected already, with imu.json"), "{refused}");
    assert!(text.starts_with(
        "t_s,ax_mps2,ay_mps2,az_mps2,ax_sd_mps2,ay_sd_mps2,az_sd_mps2,gx_radps,gy_radps,gz_radps,gx_sd_radps,gy_sd_radps,gz_sd_radps\n"
    ));
    let rows = rows(&text);
    let at: Vec<f64> = rows.iter().map(|row| row["t_s"]).collect();
    assert_eq!(at, [0.0, 0.01, 0.013, 0.02]);
    assert!(!rows[1].contains_key("gx_radps") && !rows[2].contains_key("az_sd_mps2"), "no sample, no number");

    // the correction is linear in the reading: the interpolated force is that of the interpolated reading
    let between = readings_a[1].lerp(&readings_a[2], 0.3);
    let draws = 20_000;
    for (row, y_a, y_g) in
        [(0, readings_a[0], readings_g[0]), (2, between, readings_g[1]), (3, readings_a[2], readings_g[2])]
    {
        let (force, rate) = solved(&imu.parameters, &y_a, &y_g);
        assert!((vector(&rows[row], "g?_radps") - rate).amax() < 1e-12, "row {row}");
        let mut rng = stream(17, Purpose::Sensor, row as u64);
        let (mut squares_a, mut squares_g) = (Vector3::zeros(), Vector3::zeros());
        for _ in 0..draws {
            let (f, w) = solved(&drawn(&imu, &mut rng), &y_a, &y_g);
            squares_a += (f - force).map(|error| error * error) / f64::from(draws);
            squares_g += (w - rate).map(|error| error * error) / f64::from(draws);
        }
        // the standard deviation of this number of draws is known to 0.5 %
        let near = |stated: Vector3<f64>, squares: Vector3<f64>| {
            let ratio = stated.component_div(&squares.map(f64::sqrt));
            assert!(ratio.iter().all(|ratio| (ratio - 1.0).abs() < 0.025), "row {row}: {ratio}");
        };
        near(vector(&rows[row], "g?_sd_radps"), squares_g);
        if row != 2 {
            assert!((vector(&rows[row], "a?_mps2") - force).amax() < 1e-12, "row {row}");
            near(vector(&rows[row], "a?_sd_mps2"), squares_a);
        }
    }
}

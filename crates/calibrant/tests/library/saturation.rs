//! Tests of an accelerometer that stops at the end of its range: its readings there are not used, and a
//! warning says so.

use crate::common::{WORDS, messages};
use crate::common::{draw_imu, normal};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::diagnostic::RotationReason;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, CalibrationStatus, Gyroscope, HoldResult,
    ImuProblem, ImuSetup, Recovered, Stimulus, Turn, calibrate, calibrate_imu,
};
use calibrant::io::{CalibrationFile, Input, Origin, to_json};
use calibrant::sensor::{
    Axis, ImuParameters, ImuRecording, ReadingUnit, Recording, Sensor, SensorKind, SensorModel,
};
use calibrant::simulate::{
    ImuSimulation, Purpose, Rng, TableAction, TableStep, simulate_imu, simulate_table, stream,
};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// An IMU of the size of MEMS errors, with g-sensitivity.
fn draw(rng: &mut Rng) -> ImuParameters {
    ImuParameters { g_sensitivity: Matrix3::from_fn(|_, _| 2e-4 * normal(rng)), ..draw_imu(rng) }
}

/// Limits axis x of the accelerometer.
fn clip(recording: &mut ImuRecording, limit: f64) {
    let readings = recording[SensorKind::Accelerometer].as_mut().expect("there").readings_mut();
    readings.iter_mut().for_each(|y| y.x = y.x.clamp(-limit, limit));
}

fn run(recording: &ImuRecording, gyroscope: &Gyroscope, setup: &ImuSetup) -> calibrant::Result<Calibration> {
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

/// For each 95 % interval, the share of simulated recordings with this limit in which it covers the truth.
fn coverage(count: u64, limit: f64) -> (Vec<f64>, Vec<f64>) {
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let errors: Vec<Vec<f64>> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(21, Purpose::Sensor, number);
            let truth = draw(&mut rng);
            let simulation = ImuSimulation { poses: 36, ..ImuSimulation::default() };
            let mut recording = simulate_imu(&truth, &simulation, &mut rng);
            clip(&mut recording, limit);
            let calibration = run(&recording, &gyroscope, &steady_imu()).expect("determined");
            assert_eq!(calibration.status, CalibrationStatus::Converged, "{number}");
            let pairs = calibration.quantities.iter().zip(calibration.values.iter().zip(calibration.sd()));
            pairs.map(|(quantity, (value, sd))| (value - quantity.value(&truth)) / sd).collect()
        })
        .collect();
    let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..errors[0].len()).map(|k| errors.iter().map(|z| f(z[k])).sum::<f64>() / count as f64).collect()
    };
    (of(&|z| f64::from(u8::from(z.abs() < 1.959_964))), of(&|z| z * z).iter().map(|v| v.sqrt()).collect())
}

#[test]
fn intervals_cover_the_truth_where_the_accelerometer_saturates() {
    for limit in [7.84, 9.3] {
        let (covered, rms) = coverage(200, limit);
        println!("{limit}: {covered:.3?}\n{rms:.2?}");
        // 200 recordings: one standard deviation of a share is 1.5 %, of the mean of thirty somewhat below 1 %
        let least = covered.iter().copied().fold(1.0, f64::min);
        let mean = covered.iter().sum::<f64>() / covered.len() as f64;
        assert!(least > 0.90 && (0.935..0.97).contains(&mean), "{limit} m/s²: least {least}, mean {mean}");
    }
}

/// A hold is cut off where its readings would go beyond the limit.
fn is_cut(whole: &Recording, (start_s, end_s): (f64, f64), limit: f64) -> bool {
    let inside = whole.times_s().iter().zip(whole.readings()).filter(|(t, _)| (start_s..=end_s).contains(*t));
    inside.filter(|(_, y)| y.x.abs() >= limit).count() > 1
}

#[test]
fn holds_and_rotations_in_which_the_accelerometer_saturates_are_left_out_and_named() {
    let limit = 7.84;
    let mut rng = stream(22, Purpose::Sensor, 0);
    let truth = draw(&mut rng);
    let simulation = ImuSimulation { poses: 30, ..ImuSimulation::default() };
    let mut recording = simulate_imu(&truth, &simulation, &mut rng);
    let whole = recording[SensorKind::Accelerometer].clone().expect("there");
    clip(&mut recording, limit);
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let calibration = run(&recording, &gyroscope, &steady_imu()).expect("determined");
    let mut left_out = 0;
    for (number, result) in (1..).zip(calibration.hold_results()) {
        let cut = is_cut(&whole, (result.hold.start_s, result.hold.end_s), limit);
        assert_eq!(!result.used, cut, "hold {number}");
        let message = messages(&calibration.warnings).iter().any(|warning| {
            warning.starts_with(&format!("hold {number} ("))
                && warning.contains("is not used: axis x of the accelerometer saturates at ")
                && warning.contains("7.84 m/s²; record with a larger range, or tilt that axis")
        });
        assert_eq!(message, cut, "hold {number}: {:?}", calibration.warnings);
        left_out += usize::from(cut);
    }
    assert!((2..15).contains(&left_out), "{left_out}: the test needs both kinds");
    let is_named = |reason: &Option<RotationReason>| {
        *reason == Some(RotationReason::Saturated(SensorKind::Accelerometer, Axis::X))
    };
    for rotation in calibration.rotations() {
        let cut = is_cut(&whole, (rotation.start_s, rotation.end_s), limit);
        // a touch of less than 0.05 s is none
        assert!(cut || !is_named(&rotation.reason), "{rotation:?}");
        assert_eq!(rotation.used, rotation.reason.is_none(), "{rotation:?}");
    }
    assert!(calibration.rotations().iter().filter(|rotation| is_named(&rotation.reason)).count() > 5);
    // a gyroscope without g-sensitivity is not affected: the rotations stay
    let calibration = run(&recording, &unfeeling_gyroscope(), &steady_imu()).expect("determined");
    assert!(calibration.rotations().iter().all(|rotation| !is_named(&rotation.reason)));
}

#[test]
fn too_few_holds_that_are_not_cut_off_are_an_error_that_says_so() {
    let mut rng = stream(23, Purpose::Sensor, 0);
    let mut recording =
        simulate_imu(&draw(&mut rng), &ImuSimulation { poses: 14, ..ImuSimulation::default() }, &mut rng);
    clip(&mut recording, 3.0);
    let error = run(&recording, &unfeeling_gyroscope(), &steady_imu()).expect_err("too few holds");
    assert!(error.is_not_identifiable(), "{error}");
    let message = error.to_string();
    assert!(
        message.contains("were left out since the accelerometer saturates in them, axis x at"),
        "{message}"
    );
    assert!(message.contains("record with a larger range"), "{message}");

    // the accelerometer alone
    let sensor = Sensor::triaxial(SensorModel::Full);
    let setup = steady_holds();
    let accelerometer = recording[SensorKind::Accelerometer].clone().expect("there");
    let problem =
        CalibrationProblem { sensor: &sensor, recording: &accelerometer, stimulus: Stimulus::Holds(&setup) };
    let error = calibrate(&problem, &CalibrationSettings::default()).expect_err("too few holds");
    assert!(error.to_string().contains("since the accelerometer saturates in them"), "{error}");
}

#[test]
fn known_faces_that_are_cut_off_are_left_out_too() {
    let mut rng = stream(24, Purpose::Sensor, 0);
    let truth = draw(&mut rng);
    let mut directions: Vec<Vector3<f64>> = Axis::ALL
        .into_iter()
        .flat_map(|axis| [1.0, -1.0].map(|sign| Vector3::ith(axis.index(), sign)))
        .collect();
    for sign in [1.0, -1.0] {
        directions.extend([[0.5, sign, 0.0], [-0.5, 0.0, sign]].map(|v| Vector3::from(v).normalize()));
    }
    let mut steps = Vec::new();
    for (k, direction) in directions.iter().enumerate() {
        let start_s = 8.0 * k as f64;
        steps.push(TableStep { start_s, end_s: start_s + 3.0, action: TableAction::Hold(*direction) });
        // about x with y up, about -y and z as they are up: the readings of x do not reach the limit
        if let 2..=4 = k {
            let (axis, angle_rad) = (Axis::ALL[k - 2], std::f64::consts::TAU);
            let axis = Vector3::ith(axis.index(), 1.0);
            let action = TableAction::Turn { axis, angle_rad, angle_sd_rad: 1e-3, axis_sd_rad: None };
            steps.push(TableStep { start_s: start_s + 3.0, end_s: start_s + 6.0, action });
        }
    }
    let mut setup = ImuSetup { directions: Some(directions), ..steady_imu() };
    let mut intervals = Vec::new();
    for TableStep { start_s, end_s, action } in &steps {
        match *action {
            TableAction::Hold(_) => intervals.push((*start_s, *end_s)),
            TableAction::Turn { axis, angle_rad, angle_sd_rad, .. } => {
                setup.turns.push(Turn {
                    name: None,
                    start_s: *start_s,
                    end_s: *end_s,
                    axis,
                    angle_rad,
                    angle_sd_rad,
                    axis_sd_rad: None,
                });
            }
        }
    }
    setup.holds.intervals_s = Some(intervals);
    let mut recording = simulate_table(&truth, &steps, &ImuSimulation::default(), &mut rng);
    clip(&mut recording, 8.0);
    let calibration = run(&recording, &unfeeling_gyroscope(), &setup).expect("determined");
    let used: Vec<bool> = calibration.hold_results().iter().map(|hold| hold.used).collect();
    assert_eq!(used, [false, false, true, true, true, true, true, true, true, true]);
    let error =
        (calibration.imu[SensorKind::Accelerometer].matrix - truth[SensorKind::Accelerometer].matrix).amax();
    assert!(error < 1e-3, "{error}");

    // where the gyroscope senses the force, a turn with an unknown force is refused
    let axis = Vector3::x();
    setup.turns.push(Turn {
        name: None,
        start_s: 0.0,
        end_s: 3.0,
        axis,
        angle_rad: 1.0,
        angle_sd_rad: 1e-3,
        axis_sd_rad: None,
    });
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let error = run(&recording, &gyroscope, &setup).expect_err("not known").to_string();
    assert!(
        error.contains("turn 4 (0.0 to 3.0 s) cannot be integrated: axis x of the accelerometer saturates"),
        "{error}"
    );
}

/// A quiet sensor in counts repeats its value in a hold. The largest value may well have the longest
/// repetition, since a recording often begins with a long hold.
#[test]
fn a_long_quiet_hold_at_the_largest_count_is_not_cut_off() {
    let mut rng = stream(25, Purpose::Sensor, 0);
    let mut largest = 0;
    for sd in [0.05, 0.1, 0.2, 0.3, 0.5, 1.0] {
        for number in 0..20 {
            let turn =
                nalgebra::Rotation3::from_euler_angles(normal(&mut rng) * 0.02, normal(&mut rng) * 0.02, 0.0);
            let offset = Vector3::from_fn(|_, _| normal(&mut rng));
            let mut readings = Vec::new();
            for (pose, axis) in [2, 0, 1, 2, 0, 1].into_iter().enumerate() {
                let sign = if pose < 3 { 1.0 } else { -1.0 };
                let force = turn * Vector3::ith(axis, sign * 1000.0) + offset;
                for _ in 0..if pose == 0 { 3000 } else { 300 } {
                    readings.push((force + Vector3::from_fn(|_, _| sd * normal(&mut rng))).map(f64::round));
                }
            }
            let times_s = (0..readings.len()).map(|k| k as f64 * 0.01).collect();
            let recording =
                Recording::new(times_s, readings, 3, ReadingUnit::Counts).expect("samples in order");
            let found = recording.saturations();
            assert!(found.is_empty(), "noise {sd} counts, {number}: {found:?}");
            largest += recording.readings().iter().filter(|y| y.z == recording.readings()[0].z).count();
        }
    }
    assert!(largest > 6 * 20 * 1000, "the test needs repeated values");
}

#[test]
fn the_xsens_recording_does_not_saturate() {
    let Some((recording, _)) = crate::common::xsens() else { return };
    for sensor in [recording[SensorKind::Accelerometer].clone(), recording[SensorKind::Gyroscope].clone()] {
        assert!(sensor.expect("there").saturations().is_empty());
    }
}

#[test]
fn the_accelerometer_alone_leaves_them_out_as_well() {
    let mut rng = stream(26, Purpose::Sensor, 0);
    let truth = draw(&mut rng);
    let mut recording =
        simulate_imu(&truth, &ImuSimulation { poses: 30, ..ImuSimulation::default() }, &mut rng);
    clip(&mut recording, 7.84);
    let sensor = Sensor::triaxial(SensorModel::Full);
    let setup = steady_holds();
    let accelerometer = recording[SensorKind::Accelerometer].clone().expect("there");
    let problem =
        CalibrationProblem { sensor: &sensor, recording: &accelerometer, stimulus: Stimulus::Holds(&setup) };
    let calibration = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
    let Recovered::Holds(holds) = &calibration.recovered else { panic!("holds") };
    let reason = |hold: &HoldResult| hold.reason.map(|reason| reason.to_string());
    let cut: Vec<String> = holds.holds.iter().filter_map(reason).collect();
    assert!(
        cut.len() > 2 && cut.iter().all(|reason| reason.contains("axis x of the accelerometer saturates"))
    );
    // and the file has it, too
    let input = Input { file: "x.csv".into(), sha256: String::new(), samples: 0, rate_hz: 100.0 };
    let json: serde_json::Value = serde_json::from_str(&to_json(&CalibrationFile::of(
        &calibration,
        &[],
        &Origin::of_inputs([input]),
        &WORDS,
    )))
    .expect("JSON");
    let table = json["holds"]["table"].as_array().expect("a table");
    for (row, hold) in table.iter().zip(&holds.holds) {
        assert_eq!(row["reason"].as_str(), reason(hold).as_deref());
        assert_eq!(row.get("reason").is_none(), row["used"] == true);
    }
    for (value, (sd, quantity)) in calibration
        .values
        .iter()
        .zip(calibration.sd().into_iter().zip(setup.gauge.parameter_list(SensorModel::Full).quantities()))
    {
        let off = (value - quantity.value(&truth[SensorKind::Accelerometer])) / sd;
        assert!(off.abs() < 4.0, "{}: {off:.1} standard deviations", quantity.name());
    }
    assert!(holds.between_holds_sd_mps2 < 2e-3, "{}", holds.between_holds_sd_mps2);
}

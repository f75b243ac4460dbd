//! Tests of given holds, turns and directions that the recording contradicts.

use crate::common::draw_imu;
use crate::common::messages;
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{Calibration, CalibrationSettings, ImuProblem, ImuSetup, Turn, calibrate_imu};
use calibrant::sensor::{ImuParameters, ImuRecording, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{ImuSimulation, Purpose, TableAction, TableStep, simulate_table, stream};
use nalgebra::Vector3;

fn run(recording: &ImuRecording, setup: &ImuSetup) -> calibrant::Result<Calibration> {
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let gyroscope = unfeeling_gyroscope();
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

/// Six faces, and a turn about each axis.
fn table() -> (ImuParameters, ImuRecording, ImuSetup) {
    let mut steps = Vec::new();
    let mut setup = steady_imu();
    let (mut intervals, mut directions) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let (up, from_s) = (Vector3::ith(axis, 1.0), 22.0 * axis as f64);
        for (start_s, direction) in [(from_s, up), (from_s + 14.0, -up)] {
            steps.push(TableStep { start_s, end_s: start_s + 5.0, action: TableAction::Hold(direction) });
            intervals.push((start_s, start_s + 5.0));
            directions.push(direction);
        }
        let (start_s, end_s, angle_rad, angle_sd_rad) =
            (from_s + 6.0, from_s + 11.0, std::f64::consts::TAU, 1e-3);
        let action = TableAction::Turn { axis: up, angle_rad, angle_sd_rad, axis_sd_rad: None };
        steps.insert(steps.len() - 1, TableStep { start_s, end_s, action });
        setup.turns.push(Turn {
            name: None,
            start_s,
            end_s,
            axis: up,
            angle_rad,
            angle_sd_rad,
            axis_sd_rad: None,
        });
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(directions);
    let mut rng = stream(41, Purpose::Sensor, 0);
    let truth = draw_imu(&mut rng);
    let recording = simulate_table(&truth, &steps, &ImuSimulation::default(), &mut rng);
    (truth, recording, setup)
}

#[test]
fn a_given_hold_in_which_the_sensor_turns_about_the_vertical_is_named_and_tells_no_bias() {
    for (rate, during) in [(0.05, 19.0..24.1), (1.5, 15.0..16.5)] {
        let (truth, mut recording, setup) = table();
        let clean = run(&recording, &setup).expect("determined");
        assert!(
            messages(&clean.warnings).iter().all(|warning| !warning.contains("turns in hold")),
            "{:?}",
            clean.warnings
        );
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
        // in the second hold, with -x up, from 14 to 19 s
        let (start_s, end_s) = if rate < 0.1 { (13.0, 20.0) } else { (during.start, during.end) };
        for (t, y) in gyroscope.samples_mut() {
            if (start_s..end_s).contains(t) {
                *y += truth[SensorKind::Gyroscope].matrix.column(0) * rate;
            }
        }
        let calibration = run(&recording, &setup).expect("determined");
        let message: Vec<String> = messages(&calibration.warnings)
            .into_iter()
            .filter(|warning| warning.contains("turns in hold"))
            .collect();
        assert_eq!(message.len(), 1, "{:?}", calibration.warnings);
        assert!(
            message[0].starts_with("the gyroscope turns in hold 2 (14.0 to 19.0 s), by "),
            "{}",
            message[0]
        );
        assert!(message[0].contains("Correct holds.intervals_s"), "{}", message[0]);
        let off = (calibration.imu[SensorKind::Gyroscope].bias - truth[SensorKind::Gyroscope].bias).amax();
        assert!(off < 1e-3, "{rate}: the bias is off by {off}");
        let bias_sd = calibration.sd()[12];
        assert!(bias_sd < 2.0 * clean.sd()[12], "{bias_sd} in place of {}", clean.sd()[12]);
    }
}

#[test]
fn a_hold_that_reaches_beyond_the_recording_is_named() {
    let (_, recording, mut setup) = table();
    let within = run(&recording, &setup).expect("determined");
    let intervals = setup.holds.intervals_s.as_mut().expect("given");
    intervals[5].1 = 7600.0;
    let calibration = run(&recording, &setup).expect("determined");
    let is_stated = |calibration: &Calibration| {
        let message = "hold 6 is given from 58 to 7600 s, but the recording lasts from -1 to 64 s. Only 6.0 s of the hold count";
        messages(&calibration.warnings).iter().filter(|warning| warning.contains(message)).count()
    };
    assert_eq!((is_stated(&within), is_stated(&calibration)), (0, 1), "{:?}", calibration.warnings);
    setup.holds.intervals_s.as_mut().expect("given")[5] = (7000.0, 7600.0);
    let error = run(&recording, &setup).expect_err("not there").to_string();
    assert!(error.contains("hold 6 from 7000 to 7600 s has 0 samples"), "{error}");
}

#[test]
fn a_turn_that_is_given_twice_is_refused() {
    let (_, recording, mut setup) = table();
    let again = Turn { start_s: setup.turns[1].start_s + 0.5, ..setup.turns[1].clone() };
    setup.turns.push(again);
    let error = run(&recording, &setup).expect_err("twice").to_string();
    assert!(error.contains(") and turn 4 ("), "{error}");
}

#[test]
fn faces_that_are_all_turned_alike_are_named() {
    let (_, recording, mut setup) = table();
    let named = |calibration: &Calibration| {
        let warnings = messages(&calibration.warnings).into_iter();
        warnings
            .filter(|warning| warning.contains("All directions are rotated in the same way"))
            .collect::<Vec<_>>()
    };
    assert!(named(&run(&recording, &setup).expect("determined")).is_empty());
    for direction in setup.directions.as_mut().expect("given") {
        *direction = Vector3::new(direction.z, direction.x, direction.y);
    }
    let message = named(&run(&recording, &setup).expect("determined"));
    assert_eq!(message.len(), 1);
    let first = "hold 1 (0.0 to 5.0 s) is given with y up, but the accelerometer shows x up; hold 2 (14.0 to 19.0 s) is given with -y up";
    assert!(message[0].starts_with(first), "{message:?}");
    assert!(message[0].contains("hold 6"), "{message:?}");
}

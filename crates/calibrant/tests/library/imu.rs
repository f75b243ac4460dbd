//! Tests of a whole IMU: against other programs on real recordings, and against the truth on simulated ones.

use crate::common::{draw_feeling_imu, run_imu};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{Calibration, CalibrationStatus, Gyroscope, HoldsSetup, ImuSetup, Turn};
use calibrant::io::{ImuReadOptions, ImuUnit, SectionKind, read_imu_recording, read_sections};
use calibrant::motion::earth_rate;
use calibrant::sensor::{ReadingUnit, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::Matrix3;
use rayon::prelude::*;

fn xsens(g_sensitivity: bool) -> Option<Calibration> {
    let (recording, gravity) = crate::common::xsens()?;
    let unit = ReadingUnit::Counts;
    let setup = ImuSetup { holds: HoldsSetup { gravity, ..steady_holds() }, ..steady_imu() };
    let gyroscope = Gyroscope { unit, g_sensitivity, ..Gyroscope::default() };
    Some(run_imu(&recording, &gyroscope, &setup, unit).expect("determined"))
}

/// imu_tk 2016, gains `1/K` of `ω = T K (y − b)`: 4777.956, 4764.207, 4773.657 counts/(rad/s). imu-calib 0.3.1: 0.76° rms.
#[test]
fn xsens_mti_agrees_with_imu_tk_and_leaves_less_error_after_each_rotation() {
    for g_sensitivity in [false, true] {
        let Some(calibration) = xsens(g_sensitivity) else { return };
        assert_eq!(calibration.status, CalibrationStatus::Converged);
        assert_eq!(calibration.rotations().len(), 37);
        let correction = calibration.imu[SensorKind::Gyroscope].matrix.try_inverse().expect("regular");
        for (axis, gain) in [4777.956, 4764.207, 4773.657].into_iter().enumerate() {
            let own = 1.0 / correction[(axis, axis)];
            assert!((own / gain - 1.0).abs() < 3e-3, "axis {axis}: {own} beside {gain}");
        }
        let rms = calibration.rotation_rms_rad().to_degrees();
        let best = if g_sensitivity { 0.13 } else { 0.31 };
        assert!(rms < best, "{rms}° rms");
    }
}

/// The gyroscope's axes in the frame of the accelerometer's: angles between them do not depend on a gauge.
/// The factory states the alignment with two decimals.
#[test]
fn xsens_mti_has_the_misalignment_that_the_factory_states() {
    let Some(calibration) = xsens(true) else { return };
    let accelerometer = Matrix3::new(1.0, 0.0, -0.01, 0.01, 1.0, 0.01, 0.02, 0.01, 1.0);
    let gyroscope = Matrix3::new(1.0, -0.01, -0.02, 0.0, 1.0, 0.04, -0.01, 0.01, 1.0);
    let cosine = |a: &Matrix3<f64>, i: usize, b: &Matrix3<f64>, j: usize| {
        a.row(i).dot(&b.row(j)) / (a.row(i).norm() * b.row(j).norm())
    };
    for i in 0..3 {
        for j in 0..3 {
            let own = cosine(
                &calibration.imu[SensorKind::Accelerometer].matrix,
                i,
                &calibration.imu[SensorKind::Gyroscope].matrix,
                j,
            );
            let factory = cosine(&accelerometer, i, &gyroscope, j);
            // the factory rounds each entry to 0.01
            assert!((own - factory).abs() < 0.02, "accelerometer {i}, gyroscope {j}: {own} beside {factory}");
        }
    }
}

/// imucal 2.6.0 on the same session. Its `K` are the norms of the rows of `S`.
#[test]
fn a_ferraris_session_agrees_with_imucal() {
    let Some(path) = crate::common::shared_data("imucal-ferraris/example_ferraris_session.csv") else {
        return;
    };
    let Some(list) = crate::common::shared_data("imucal-ferraris/example_ferraris_session_list.json") else {
        return;
    };
    let options = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::MetrePerSecondSquared),
        gyroscope_unit: Some(ImuUnit::DegreePerSecond),
        rate_hz: Some(102.4),
        ..ImuReadOptions::default()
    };
    let recording = read_imu_recording(&path, &options).expect("readable").recording;
    let times = recording[SensorKind::Accelerometer].as_ref().expect("there").times_s().to_vec();
    let mut setup = steady_imu();
    setup.holds.gravity.magnitude_mps2 = 9.81;
    let (mut intervals, mut directions) = (Vec::new(), Vec::new());
    for section in read_sections(&list).expect("readable") {
        let (start_s, end_s) = (times[section.start], times[section.end - 1]);
        match section.kind {
            SectionKind::Face(direction) => {
                intervals.push((start_s, end_s));
                directions.push(direction);
            }
            SectionKind::Turn(axis) => {
                let angle_rad = -std::f64::consts::TAU;
                setup.turns.push(Turn {
                    name: None,
                    start_s,
                    end_s,
                    axis,
                    angle_rad,
                    angle_sd_rad: 0.5_f64.to_radians(),
                    axis_sd_rad: None,
                });
            }
        }
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(directions);
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
    let sd = |name: &str| {
        let place = calibration.quantities.iter().position(|quantity| quantity.name() == name).expect(name);
        calibration.sd()[place]
    };
    let tilt = calibration.holds().expect("held").tilt.expect("faces");
    let imu = &calibration.imu;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let gain = imu[SensorKind::Accelerometer].matrix.row(axis).norm();
        // a tilted face shows less than gravity: theirs is too small by the square of the tilt
        let theirs = [0.996_745_865_1, 1.002_437_618_6, 1.023_395_347_5][axis] / (1.0 - tilt.sd_rad.powi(2));
        assert!((gain - theirs).abs() < 1e-6, "K_a {name}: {gain} beside {theirs}");
        let gain = imu[SensorKind::Gyroscope].matrix.row(axis).norm();
        let theirs = [1.027_924_326_4, 0.982_427_773_8, 0.998_310_487_4][axis];
        // imucal multiplies the sum of samples by 1/rate, calibrant integrates from the first sample to the last
        let scale = sd(&format!("gyroscope.scale.{name}"));
        assert!((gain - theirs).abs() < 0.1 * scale, "K_g {name}: {gain} beside {theirs}, sd {scale}");
        let bias = imu[SensorKind::Accelerometer].bias[axis];
        let theirs = [0.537_117_424_4, -0.616_202_993_1, 0.398_867_342_4][axis];
        let bias_sd = sd(&format!("accelerometer.bias.{name}"));
        assert!((bias - theirs).abs() < 2.0 * bias_sd, "b_a {name}: {bias} beside {theirs}, sd {bias_sd}");
        // both take the middle of two faces. A tilt leaks into the reading across them through the cross-axis
        // terms. There calibrant corrects it
        let faces = &calibration.hold_results()[2 * axis..2 * axis + 2];
        let middle = 0.5 * (faces[0].hold.mean + faces[1].hold.mean);
        assert!((middle[axis] - theirs).abs() < 1e-8, "b_a {name}: {} beside {theirs}", middle[axis]);
        let left = imu[SensorKind::Accelerometer].matrix.try_inverse().expect("regular")
            * (middle - imu[SensorKind::Accelerometer].bias);
        assert!(left[axis].abs() < 0.05 * bias_sd, "b_a {name}: {left}, sd {bias_sd}");
    }
    // face alignment by hand: between a tenth of a degree and two
    assert!((0.1..2.0).contains(&tilt.sd_rad.to_degrees()), "{tilt:?}");
    let cross = (tilt.sd_rad * (6.0 / 4.0 / 2.0_f64).sqrt()).hypot(tilt.shared_sd_rad);
    assert!(
        (sd("accelerometer.matrix.xy") / cross - 1.0).abs() < 0.05,
        "the tilt of the faces is in the covariance"
    );
    // an axis aligned to half a degree has that share of the turn, beside what all faces may share
    let (turned, found) = (0.5_f64.to_radians().hypot(tilt.shared_sd_rad), sd("gyroscope.matrix.xy"));
    assert!((found / turned - 1.0).abs() < 0.05, "{found} beside {turned}");
}

#[test]
fn intervals_of_800_simulated_imus_cover_the_truth() {
    let simulation = ImuSimulation { earth_rate_radps: earth_rate(48.1), ..ImuSimulation::default() };
    let setup = ImuSetup { latitude_deg: Some(48.1), ..steady_imu() };
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let (count, unit) = (800, ReadingUnit::MetrePerSecondSquared);
    let inside: Vec<Vec<f64>> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(11, Purpose::Sensor, number);
            let truth = draw_feeling_imu(&mut rng);
            let recording = simulate_imu(&truth, &simulation, &mut rng);
            let calibration = run_imu(&recording, &gyroscope, &setup, unit).expect("determined");
            assert_eq!(calibration.status, CalibrationStatus::Converged, "{number}");
            let sd = calibration.sd();
            let pairs = calibration.quantities.iter().zip(calibration.values.iter().zip(sd));
            pairs.map(|(quantity, (value, sd))| (value - quantity.value(&truth)) / sd).collect()
        })
        .collect();
    let quantities = inside[0].len();
    assert_eq!(quantities, 30);
    let mut off: Vec<String> = Vec::new();
    for k in 0..quantities {
        let covered = inside.iter().filter(|z| z[k].abs() < 1.959_964).count() as f64 / count as f64;
        let mean = inside.iter().map(|z| z[k]).sum::<f64>() / count as f64;
        let rms = (inside.iter().map(|z| z[k] * z[k]).sum::<f64>() / count as f64).sqrt();
        println!("{k}: {covered:.4} covered, mean {mean:+.3}, rms {rms:.3}");
        // 0.8 % is one standard deviation. The wander between holds is estimated, too, though here there is
        // none: quantities that depend on it are off by up to 2 % either way
        if !(0.925..0.975).contains(&covered) || mean.abs() > 0.10 {
            off.push(format!("quantity {k}: {covered} covered, mean {mean:+.3}"));
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

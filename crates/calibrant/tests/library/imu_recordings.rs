//! Tests of faulty recordings of an IMU, whose fault is named, and of known quantities, which are used.

use crate::common::messages;
use crate::common::{draw_feeling_imu, normal, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::diagnostic::RotationReason;
use calibrant::error::Error;
use calibrant::estimate::{CalibrationStatus, Gyroscope, ImuSetup, KnownTerm, NoiseSource, Turn, WhiteNoise};
use calibrant::sensor::{ImuParameters, ImuRecording, ReadingUnit, Recording, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use nalgebra::{Matrix3, Rotation3, Vector3};

fn small() -> (ImuParameters, ImuRecording) {
    let mut rng = stream(3, Purpose::Sensor, 0);
    let truth = draw_feeling_imu(&mut rng);
    let recording = simulate_imu(&truth, &ImuSimulation::default(), &mut rng);
    (truth, recording)
}

fn fails(recording: &ImuRecording, gyroscope: &Gyroscope) -> Error {
    run_imu(recording, gyroscope, &steady_imu(), ReadingUnit::MetrePerSecondSquared).expect_err("refused")
}

#[test]
fn degrees_that_are_called_radians_are_named() {
    let (_, mut recording) = small();
    let readings = recording[SensorKind::Gyroscope].as_mut().expect("there").readings_mut();
    readings.iter_mut().for_each(|reading| *reading *= 180.0 / std::f64::consts::PI);
    let message = fails(&recording, &unfeeling_gyroscope()).to_string();
    assert!(message.contains("in deg/s, not rad/s"), "{message}");
}

#[test]
fn counts_of_an_unknown_gain_and_axes_in_another_order_are_found() {
    let (truth, mut recording) = small();
    let order = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0) * 1000.0;
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    *gyroscope = gyroscope.mapped(ReadingUnit::Counts, |reading| order * reading + Vector3::repeat(32768.0));
    let model = Gyroscope { unit: ReadingUnit::Counts, ..unfeeling_gyroscope() };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &model, &steady_imu(), unit).expect("found");
    let error =
        (calibration.imu[SensorKind::Gyroscope].matrix - order * truth[SensorKind::Gyroscope].matrix).amax();
    assert!(error < 5.0, "{error} of 1000");
    assert!(
        messages(&calibration.warnings)
            .iter()
            .any(|warning| warning.contains("the gyroscope's axes are in another order"))
    );
}

#[test]
fn axes_of_a_gyroscope_in_si_may_be_in_another_order_too() {
    let (truth, mut recording) = small();
    let order = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    gyroscope.readings_mut().iter_mut().for_each(|reading| *reading = order * *reading);
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &steady_imu(), unit).expect("found");
    let error =
        (calibration.imu[SensorKind::Gyroscope].matrix - order * truth[SensorKind::Gyroscope].matrix).amax();
    assert!(error < 5e-3, "{error}");
    let warning = "along x, y and z of the accelerometer lie y, -x and -z of the gyroscope";
    assert!(
        messages(&calibration.warnings).iter().any(|found| found.contains(warning)),
        "{:?}",
        calibration.warnings
    );
}

/// A rotation whose rate saturated shows nothing, however well the others fit.
#[test]
fn rotations_in_which_the_gyroscope_saturates_are_left_out() {
    let (truth, mut recording) = small();
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    let limit = 1.6;
    let whole = gyroscope.readings().to_vec();
    gyroscope
        .readings_mut()
        .iter_mut()
        .for_each(|reading| *reading = reading.map(|rate| rate.clamp(-limit, limit)));
    let is_cut = |from: f64, to: f64| {
        let within = |t: &f64| (from..=to).contains(t);
        let times = recording[SensorKind::Gyroscope].as_ref().expect("there").times_s();
        times.iter().zip(&whole).filter(|(t, _)| within(t)).filter(|(_, rate)| rate.amax() > limit).count()
            > 2
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &steady_imu(), unit).expect("found");
    let cut: Vec<bool> = calibration.rotations().iter().map(|r| is_cut(r.start_s, r.end_s)).collect();
    let cuts = cut.iter().filter(|cut| **cut).count();
    assert!((5..18).contains(&cuts), "{cuts} of {}: the test needs both kinds", cut.len());
    for (rotation, cut) in calibration.rotations().iter().zip(cut) {
        let saturates = matches!(rotation.reason, Some(RotationReason::Saturated(..)));
        assert_eq!(saturates, cut, "{rotation:?}");
    }
    let error = (calibration.imu[SensorKind::Gyroscope].matrix - truth[SensorKind::Gyroscope].matrix).amax();
    assert!(error < 5e-3, "{error}");
}

/// The noise of an axis that never turns looks like small rotations. So no combination of parameters is
/// exactly free.
#[test]
fn an_axis_about_which_nothing_turns_is_named() {
    let (rate_hz, steps) = (100.0, 200);
    let mut rng = stream(4, Purpose::Sensor, 0);
    let mut sensor_from_world = Rotation3::from_euler_angles(0.4, 0.3, 0.2);
    let (mut forces, mut rates) = (Vec::new(), Vec::new());
    for pose in 0..20 {
        for _ in 0..300 {
            forces.push(sensor_from_world * Vector3::new(0.0, 0.0, 9.806_65));
            rates.push(Vector3::zeros());
        }
        let axis = Vector3::ith(pose % 2, 1.0);
        let rate = (0.8 + 0.1 * f64::from(pose as u32 % 7)) * if pose % 3 == 0 { -1.0 } else { 1.0 };
        for _ in 0..steps {
            // half before, half after the sample: the rate is constant
            let half = Rotation3::new(-axis * rate * 0.5 / rate_hz);
            sensor_from_world = half * sensor_from_world;
            forces.push(sensor_from_world * Vector3::new(0.0, 0.0, 9.806_65));
            rates.push(axis * rate);
            sensor_from_world = half * sensor_from_world;
        }
    }
    let mut noisy = |of: &[Vector3<f64>], sd: f64, unit: ReadingUnit| {
        let times_s = (0..of.len()).map(|k| k as f64 / rate_hz).collect();
        let readings = of.iter().map(|y| y + Vector3::from_fn(|_, _| sd * normal(&mut rng))).collect();
        Recording::new(times_s, readings, 3, unit).expect("samples in order")
    };
    let recording = ImuRecording {
        sensors: [
            Some(noisy(&forces, 0.01, ReadingUnit::MetrePerSecondSquared)),
            Some(noisy(&rates, 2e-3, ReadingUnit::RadianPerSecond)),
        ]
        .into(),
        temperature_c: None,
    };
    let error = fails(&recording, &unfeeling_gyroscope());
    assert!(error.is_not_identifiable(), "{error}");
    let message = error.to_string();
    assert!(message.contains("gyroscope.scale.z") && !message.contains("gyroscope.scale.x"), "{message}");
}

#[test]
fn an_axis_that_is_not_connected_is_named() {
    let (_, mut recording) = small();
    let readings = recording[SensorKind::Gyroscope].as_mut().expect("there").readings_mut();
    readings.iter_mut().for_each(|reading| reading.y = 0.0);
    let message = fails(&recording, &unfeeling_gyroscope()).to_string();
    assert!(message.contains("axis y of the gyroscope never changes"), "{message}");
}

#[test]
fn a_gyroscope_of_another_recording_is_refused() {
    let (_, mut recording) = small();
    let other = simulate_imu(
        &ImuParameters::identity(),
        &ImuSimulation::default(),
        &mut stream(9, Purpose::Sensor, 1),
    );
    recording[SensorKind::Gyroscope] = other[SensorKind::Gyroscope].clone();
    let message = fails(&recording, &unfeeling_gyroscope()).to_string();
    assert!(message.contains("do not fit the accelerometer's"), "{message}");
}

#[test]
fn a_gyroscope_that_ends_early_leaves_named_parameters_undetermined() {
    let (_, mut recording) = small();
    // it ends in the second hold
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    *gyroscope = gyroscope.only(|k| k < 690);
    let error = fails(&recording, &unfeeling_gyroscope());
    assert!(error.is_not_identifiable(), "{error}");
    assert!(error.to_string().contains("gyroscope.scale"), "{error}");
}

/// Holds of 2.5 s and turns of 2 s. Those beside the time at which the gyroscope ends or begins are not used,
/// by their own times.
#[test]
fn rotations_that_the_gyroscope_does_not_cover_are_named_by_their_times() {
    let (_, whole) = small();
    let unit = ReadingUnit::MetrePerSecondSquared;
    for (covered, says) in [
        (0..6001, "the gyroscope's recording ends at 60.0 s"),
        (6000..10_600, "the gyroscope's recording begins only at 60.0 s"),
    ] {
        let mut recording = whole.clone();
        let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
        *gyroscope = gyroscope.only(|k| covered.contains(&k));
        let calibration = run_imu(&recording, &unfeeling_gyroscope(), &steady_imu(), unit).expect("found");
        let holds = &calibration.hold_results();
        let (from_s, to_s) = (covered.start as f64 / 100.0, covered.end as f64 / 100.0);
        let mut left_out = 0;
        for rotation in calibration.rotations() {
            let (from, to) = (&holds[rotation.from_hold].hold, &holds[rotation.to_hold].hold);
            let ends = (from.end_s, to.start_s);
            // it reaches 0.3 s into the holds, or a quarter of a hold that was cut short
            let margin = |duration_s: f64| (0.25 * duration_s).min(0.3);
            let beside = (
                rotation.start_s - ends.0 + margin(from.duration_s()),
                rotation.end_s - ends.1 - margin(to.duration_s()),
            );
            assert!(beside.0.abs() < 0.02 && beside.1.abs() < 0.02, "{rotation:?} of {ends:?}");
            let is_covered = ends.0 > from_s && ends.1 < to_s;
            let reason = rotation.reason.map(|reason| reason.to_string());
            assert_eq!(reason.as_deref(), (!is_covered).then_some(says), "{rotation:?}");
            left_out += usize::from(!is_covered);
        }
        assert!((8..14).contains(&left_out), "{left_out}");
    }
}

#[test]
fn a_known_bias_is_kept_and_a_prior_shares() {
    let (truth, recording) = small();
    let quantity = |name: &str| {
        calibrant::sensor::ImuQuantity::full_list(true, true, true)
            .into_iter()
            .find(|quantity| quantity.name() == name)
            .expect(name)
    };
    let known = |name: &str, sd: Option<f64>| KnownTerm {
        quantity: quantity(name),
        value: quantity(name).value(&truth),
        sd,
    };
    let setup = ImuSetup {
        known: vec![known("gyroscope.bias.x", None), known("gyroscope.scale.y", Some(1e-6))],
        ..steady_imu()
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
    assert_eq!(calibration.quantities.len(), 20);
    assert_eq!(calibration.imu[SensorKind::Gyroscope].bias.x, truth[SensorKind::Gyroscope].bias.x);
    let place =
        calibration.quantities.iter().position(|known| known.name() == "gyroscope.scale.y").expect("there");
    assert!(calibration.prior_share[place] > 0.99 && calibration.sd()[place] < 1e-6);
    assert!(calibration.warnings.is_empty(), "{:?}", calibration.warnings);

    // a value that the data contradict is kept, with a warning
    let fixed = KnownTerm { quantity: quantity("gyroscope.scale.x"), value: 0.9, sd: None };
    let setup = ImuSetup { known: vec![fixed], ..steady_imu() };
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
    assert_eq!(calibration.imu[SensorKind::Gyroscope].matrix.m11, 0.9);
    let message = messages(&calibration.warnings).join("; ");
    assert!(message.contains("gyroscope.scale.x in [known]: the given value is 0.9"), "{message}");
    let prior = KnownTerm { quantity: quantity("gyroscope.bias.x"), value: 0.1, sd: Some(1e-4) };
    let setup = ImuSetup { known: vec![prior], ..steady_imu() };
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
    let message = messages(&calibration.warnings).join("; ");
    assert!(
        message.contains("the recording contradicts gyroscope.bias.x in [known]: the given value is 0.1"),
        "{message}"
    );
    assert!(message.contains("degrees of freedom: the data refute a given value"), "{message}");

    // a value far off is refused whatever the fit with it would give; a third of that converges, with a
    // warning
    for (name, absurd) in [
        ("accelerometer.bias.x", 4.0),
        ("accelerometer.scale.x", -0.4),
        ("accelerometer.matrix.xy", 0.4),
        ("gyroscope.bias.x", 0.2),
        ("gyroscope.scale.x", -0.4),
        ("gyroscope.matrix.xy", 0.4),
    ] {
        for share in [1.0 / 3.0, 1.0, 1e9] {
            for sd in if share == 1.0 { vec![None, Some(1e-9)] } else { vec![None] } {
                let fixed = quantity(name);
                let known = KnownTerm { quantity: fixed, value: fixed.value(&truth) + share * absurd, sd };
                let setup = ImuSetup { known: vec![known], ..steady_imu() };
                let found = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit);
                let says = format!(
                    "the recording contradicts {name} in [known]: the given value is {:?}",
                    known.value
                );
                let message = match &found {
                    Ok(calibration) => messages(&calibration.warnings).join("; "),
                    Err(error) => error.to_string(),
                };
                assert!(message.contains(&says), "{message}");
                match found {
                    Ok(calibration) => assert!(
                        share < 1.0 && calibration.status == CalibrationStatus::Converged,
                        "{name} {share} {sd:?}: {:?}",
                        calibration.status
                    ),
                    Err(error) => assert!(share >= 1.0 && error.is_invalid_experiment(), "{error}"),
                }
            }
        }
    }
}

#[test]
fn a_turn_that_was_not_made_is_named() {
    let (_, recording) = small();
    let turn = Turn {
        name: None,
        start_s: 10.0,
        end_s: 14.0,
        axis: Vector3::x(),
        angle_rad: std::f64::consts::TAU,
        angle_sd_rad: 0.01,
        axis_sd_rad: None,
    };
    let setup = ImuSetup { turns: vec![turn], ..steady_imu() };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &unfeeling_gyroscope(), &setup, unit).expect("determined");
    let message = messages(&calibration.warnings).join("; ");
    assert!(
        message.contains("turn 1 (10.0 to 14.0 s) is given as 360.0° about x, but the gyroscope shows"),
        "{message}"
    );
}

#[test]
fn the_noise_of_a_sample_is_the_datasheets_then_that_of_a_long_hold_then_the_scatter() {
    let (_, recording) = small();
    let unit = ReadingUnit::MetrePerSecondSquared;
    let white = WhiteNoise { sd: Vector3::repeat(1.9e-3), hold: 3, duration_s: 42.0 };
    let examined = ImuSetup { white_noise: Some(white), ..steady_imu() };
    let given = Gyroscope { noise: Some(Vector3::repeat(2.1e-3)), ..unfeeling_gyroscope() };
    let still = |gyroscope: &Gyroscope, setup: &ImuSetup| {
        run_imu(&recording, gyroscope, setup, unit).expect("determined").gyroscope.expect("an IMU").still
    };
    let found = still(&given, &examined);
    assert_eq!((found.noise, found.noise_source), (Vector3::repeat(2.1e-3), NoiseSource::Datasheet));
    let found = still(&unfeeling_gyroscope(), &examined);
    assert_eq!(found.noise, Vector3::repeat(1.9e-3));
    assert_eq!(found.noise_source.to_string(), "Allan deviation of hold 4 (42.0 s)");
    let found = still(&unfeeling_gyroscope(), &steady_imu());
    assert_eq!(found.noise_source, NoiseSource::ScatterWithinHolds);
    // 24 holds of 250 samples determine it to 1 %: four standard deviations
    assert!(found.noise.iter().all(|sd| (0.96..1.04).contains(&(sd / 2e-3))), "{}", found.noise);
}

#[test]
fn a_turned_gyroscope_is_found_in_the_accelerometers_frame() {
    let (mut truth, _) = small();
    truth[SensorKind::Gyroscope].matrix *= Rotation3::from_euler_angles(0.02, -0.03, 0.05).matrix();
    let recording = simulate_imu(&truth, &ImuSimulation::default(), &mut stream(4, Purpose::Sensor, 7));
    let gyroscope = Gyroscope { g_sensitivity: true, ..Gyroscope::default() };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let calibration = run_imu(&recording, &gyroscope, &steady_imu(), unit).expect("determined");
    assert!(
        (calibration.imu[SensorKind::Gyroscope].matrix - truth[SensorKind::Gyroscope].matrix).amax() < 3e-3
    );
}

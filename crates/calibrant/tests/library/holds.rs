//! Tests of static multi-position calibration: against another program on a real recording, and on difficult
//! recordings.

use crate::common::steady_holds;
use crate::common::{messages, read_accelerometer, shared_data};
use calibrant::diagnostic::holds::{GainDependsOnSign, ResponseTermOpen, SecondOrderResponse};
use calibrant::diagnostic::{Check, Diagnostic};
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, CalibrationStatus, HoldCalibration, HoldsSetup,
    Recovered, Stimulus, calibrate, find_holds,
};
use calibrant::motion::Gravity;
use calibrant::sensor::{
    Correction, Gauge, ImuParameters, NonlinearTerm, Nonlinearity, ReadingUnit, Recording, Sensor,
    SensorKind, SensorModel, SensorParameters,
};
use calibrant::simulate::{HoldsSimulation, Purpose, draw_sensor, simulate_holds, stream};
use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::RngExt;

fn sensor(model: SensorModel) -> Sensor {
    Sensor {
        model,
        noise_mps2: Some(Vector3::repeat(0.01)),
        bias_sd_mps2: Some(Vector3::repeat(0.1)),
        scale_sd: Some(Vector3::repeat(0.005)),
        cross_axis_sd: Some(0.01),
        ..Sensor::triaxial(model)
    }
}

fn simulate(poses: usize, seed: u64) -> (SensorParameters, Recording) {
    simulate_bent(poses, seed, |_| {})
}

fn simulate_bent(poses: usize, seed: u64, bend: impl Fn(&mut Nonlinearity)) -> (SensorParameters, Recording) {
    let mut rng = stream(seed, Purpose::Sensor, 0);
    let mut truth = Gauge::Upper.apply(&draw_sensor(&sensor(SensorModel::Full), &mut rng));
    bend(&mut truth.nonlinearity);
    let simulation = HoldsSimulation {
        poses,
        hold_s: 4.0,
        turn_s: 1.5,
        rate_hz: 100.0,
        gravity_mps2: 9.80665,
        between_holds_sd_mps2: 1e-3,
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let (recording, _) = simulate_holds(&truth, &Vector3::repeat(0.01), unit, &simulation, &mut rng);
    (truth, recording)
}

fn run(sensor: &Sensor, recording: &Recording, setup: &HoldsSetup) -> calibrant::Result<Calibration> {
    let problem = CalibrationProblem { sensor, recording, stimulus: Stimulus::Holds(setup) };
    calibrate(&problem, &CalibrationSettings::default())
}

fn holds(calibration: &Calibration) -> &HoldCalibration {
    match &calibration.recovered {
        Recovered::Holds(holds) => holds,
        _ => panic!("holds"),
    }
}

/// imu_tk 2016 on the same file (raw counts, g = 9.81744): gains 1/K, biases, T.
#[test]
fn xsens_mti_agrees_with_imu_tk_within_two_standard_deviations() {
    let Some(path) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let recording = read_accelerometer(&path, 3, ReadingUnit::Counts);
    let sensor =
        Sensor { unit: ReadingUnit::Counts, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) };
    let setup = HoldsSetup { gravity: Gravity { magnitude_mps2: 9.81744, sd_mps2: 0.0 }, ..steady_holds() };
    let calibration = run(&sensor, &recording, &setup).expect("identifiable");
    assert_eq!(calibration.status, CalibrationStatus::Converged);
    let found = holds(&calibration);
    assert_eq!(found.holds.len(), 38);
    assert!(found.holds.iter().all(|hold| hold.used));
    assert!(found.between_holds_dominates);
    assert!(
        (found.magnitude_residual_rms_mps2 - 1.0e-3).abs() < 0.05e-3,
        "about 1 mm/s² over the hold means"
    );

    let correction = Correction::of(&calibration.imu[SensorKind::Accelerometer]).expect("regular");
    let gains = correction.scale().map(|k| 1.0 / k);
    let t = correction.misalignment();
    // standard deviations of a refit on hold means, by another program
    let against = [
        ("gain x", gains.x, 414.458_874, 0.027),
        ("gain y", gains.y, 412.010_468, 0.014),
        ("gain z", gains.z, 414.648_662, 0.016),
        ("bias x", correction.bias.x, 33_124.182_6, 0.25),
        ("bias y", correction.bias.y, 33_275.179_4, 0.14),
        ("bias z", correction.bias.z, 32_364.415_6, 0.15),
        ("T xy", t[(0, 1)], -0.003_359_30, 1.3e-4),
        ("T xz", t[(0, 2)], -0.008_906_39, 4.8e-4),
        ("T yz", t[(1, 2)], -0.021_334_12, 1.2e-4),
    ];
    for (name, ours, theirs, sd) in against {
        assert!((ours - theirs).abs() < 2.0 * sd, "{name}: {ours} against {theirs} ± {sd}");
    }
    // and our own standard deviations equal those of that refit
    for (k, sd) in [0.25, 0.14, 0.15, 0.027, 0.014, 0.016].into_iter().enumerate() {
        assert!(
            (calibration.sd()[k] / sd - 1.0).abs() < 0.05,
            "{}: {}",
            calibration.parameters[k].name,
            calibration.sd()[k]
        );
    }
}

/// Positive readings of every axis are larger by 1 %: the bias would be wrong by tens of mm/s², with standard deviations of a few.
#[test]
fn a_gain_that_depends_on_the_sign_is_found() {
    let found = |difference: f64, seed: u64| -> Vec<Diagnostic> {
        let (truth, mut recording) = simulate(24, seed);
        for reading in recording.readings_mut() {
            *reading = reading.zip_map(&truth.bias, |y, bias| y + difference * (y - bias).max(0.0));
        }
        let calibration = run(&Sensor::triaxial(SensorModel::Full), &recording, &steady_holds());
        let warnings = calibration.expect("identifiable").warnings;
        warnings.into_iter().filter(|of| of.code() == GainDependsOnSign::CODE).collect()
    };
    for seed in 1..=3 {
        assert_eq!(found(0.0, seed), [], "{seed}");
        let warnings = found(0.01, seed);
        let difference = warnings[0].number("difference").expect("a number");
        assert!((difference - 0.01).abs() < 4e-3, "{seed}: {difference}");
    }
}

/// A parabola and two gains: named where they are not estimated; where they are, standard deviations hold and nothing is left to say.
#[test]
fn terms_that_bend_the_response_are_estimated() {
    let both = HoldsSetup { nonlinearity: NonlinearTerm::ALL.to_vec(), ..steady_holds() };
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 1..=4 {
        let (truth, recording) = simulate_bent(36, seed, |bends| {
            *bends.of_mut(NonlinearTerm::SecondOrder) = Vector3::new(2e-4, -1e-4, 1.5e-4);
            *bends.of_mut(NonlinearTerm::GainBySign) = Vector3::new(0.005, 0.005, -0.003);
        });
        let linear =
            run(&Sensor::triaxial(SensorModel::Full), &recording, &steady_holds()).expect("identifiable");
        let is_named =
            |of: &Diagnostic| [GainDependsOnSign::CODE, SecondOrderResponse::CODE].contains(&of.code());
        assert!(linear.warnings.iter().any(is_named), "{seed}: {:?}", messages(&linear.warnings));
        let calibration = run(&Sensor::triaxial(SensorModel::Full), &recording, &both).expect("identifiable");
        assert_eq!(messages(&calibration.warnings), Vec::<String>::new(), "{seed}");
        let truth = ImuParameters::identity().with(SensorKind::Accelerometer, truth);
        for ((quantity, value), sd) in
            calibration.quantities.iter().zip(&calibration.values).zip(calibration.sd().iter())
        {
            squares += ((value - quantity.value(&truth)) / sd).powi(2);
            count += 1.0;
        }
    }
    // 60 of them, correlated within a recording
    let rms = f64::sqrt(squares / count);
    assert!((0.75..1.25).contains(&rms), "{rms}");
}

/// With the wrong term alone biases are many standard deviations off: it is said.
#[test]
fn a_term_that_looks_like_another_is_not_taken_for_it() {
    for (seed, truth, wrong) in [
        (1, NonlinearTerm::SecondOrder, NonlinearTerm::GainBySign),
        (2, NonlinearTerm::GainBySign, NonlinearTerm::SecondOrder),
    ] {
        let size = if truth == NonlinearTerm::SecondOrder { 2e-4 } else { 0.005 };
        let (_, recording) = simulate_bent(24, seed, |bends| *bends.of_mut(truth) = Vector3::repeat(size));
        let setup = HoldsSetup { nonlinearity: vec![wrong], ..steady_holds() };
        let calibration =
            run(&Sensor::triaxial(SensorModel::Full), &recording, &setup).expect("identifiable");
        let said = |of: &Diagnostic| {
            [ResponseTermOpen::CODE, GainDependsOnSign::CODE, SecondOrderResponse::CODE].contains(&of.code())
        };
        assert!(calibration.warnings.iter().any(said), "{truth:?}: {:?}", messages(&calibration.warnings));
    }
}

#[test]
fn every_gauge_describes_the_same_sensor() {
    let (_, recording) = simulate(24, 1);
    let results = [Gauge::Lower, Gauge::Upper, Gauge::Symmetric].map(|gauge| {
        let setup = HoldsSetup { gauge, ..steady_holds() };
        (gauge, run(&sensor(SensorModel::Full), &recording, &setup).expect("identifiable"))
    });
    for (_, one) in &results {
        for (gauge, other) in &results {
            let converted = gauge.apply(&one.imu[SensorKind::Accelerometer]);
            assert!(
                (converted.matrix - other.imu[SensorKind::Accelerometer].matrix).amax() < 1e-8,
                "to {gauge:?}"
            );
            assert!(
                (converted.bias - other.imu[SensorKind::Accelerometer].bias).amax() < 1e-8,
                "{}",
                converted.bias - other.imu[SensorKind::Accelerometer].bias
            );
            assert!((one.fit.chi2 - other.fit.chi2).abs() < 1e-6, "the fit does not depend on the gauge");
        }
    }
}

#[test]
fn scale_bias_is_the_full_model_without_cross_axis_terms() {
    let (_, recording) = simulate(24, 2);
    let calibration =
        run(&sensor(SensorModel::ScaleBias), &recording, &steady_holds()).expect("identifiable");
    assert_eq!(calibration.parameters.len(), 6);
    assert_eq!(
        calibration.imu[SensorKind::Accelerometer].matrix,
        Matrix3::from_diagonal(&calibration.imu[SensorKind::Accelerometer].matrix.diagonal())
    );
}

#[test]
fn bad_holds_are_found_and_left_out_with_a_word() {
    let (truth, clean) = simulate(24, 3);
    let reference = run(&sensor(SensorModel::Full), &clean, &steady_holds()).expect("identifiable");
    let spans: Vec<_> =
        find_holds(&clean, 1.0).expect("fine").iter().map(|hold| (hold.first, hold.end)).collect();
    for (size, bad) in [(0.02, vec![5]), (0.5, vec![5, 11, 17]), (-3.0, vec![0, 23])] {
        let mut recording = clean.clone();
        for &hold in &bad {
            // a sensor that bumped against the table, was magnetised, or leaned on a hand: the magnitude is
            // wrong
            for reading in &mut recording.readings_mut()
                [spans[hold].0.saturating_sub(30)..(spans[hold].1 + 30).min(clean.len())]
            {
                let along = (*reading - truth.bias).normalize();
                *reading += along * size;
            }
        }
        let calibration = run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect("identifiable");
        let left_out: Vec<usize> = (0..24).filter(|&k| !holds(&calibration).holds[k].used).collect();
        assert_eq!(left_out, bad, "size {size}");
        for &hold in &bad {
            let word = format!("hold {} (", hold + 1);
            assert!(
                messages(&calibration.warnings).iter().any(|warning| warning.starts_with(&word)),
                "{:?}",
                calibration.warnings
            );
        }
        for k in 0..9 {
            let off = (calibration.values[k] - reference.values[k]).abs() / reference.sd()[k];
            assert!(off < 3.0, "{}: {off} sd away from the clean fit", calibration.parameters[k].name);
        }
    }
}

#[test]
fn clean_recordings_rarely_lose_a_hold() {
    let lost: usize = (0..100)
        .map(|seed| {
            let (_, recording) = simulate(20, 100 + seed);
            let calibration =
                run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect("identifiable");
            usize::from(holds(&calibration).holds.iter().any(|hold| !hold.used))
        })
        .sum();
    // one in a hundred recordings by the test's own level, and a margin for the robust start
    assert!(lost <= 4, "{lost} of 100 clean recordings lost a hold");
}

#[test]
fn holds_that_do_not_spread_are_named() {
    // few holds
    let (_, recording) = simulate(6, 4);
    let error =
        run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect_err("six holds, nine parameters");
    assert!(error.is_not_identifiable());
    assert!(error.to_string().contains("6 holds give 6 equations"), "{error}");

    // no holds
    let (_, mut recording) = simulate(12, 4);
    for (k, reading) in recording.readings_mut().iter_mut().enumerate() {
        *reading = Rotation3::from_euler_angles(0.013 * k as f64, 0.007 * k as f64, 0.02 * k as f64)
            * Vector3::new(0.0, 0.0, 9.81)
            * (1.0 + 0.1 * (0.1 * k as f64).sin());
    }
    let error = run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect_err("always moving");
    assert!(error.is_not_identifiable(), "{error}");

    // many holds on one circle: gravity never leaves the x-y plane
    let (mut times_s, mut readings) = (vec![], vec![]);
    for k in 0..12 * 400 {
        let angle = (k / 400) as f64 * 0.5 + if k % 400 < 300 { 0.0 } else { (k % 400 - 300) as f64 * 0.005 };
        let wiggle = 0.01 * ((k * 7919 % 1000) as f64 / 500.0 - 1.0);
        times_s.push(k as f64 * 0.01);
        readings.push(Vector3::new(9.81 * angle.cos() + wiggle, 9.81 * angle.sin() - wiggle, 0.0));
    }
    let mut flat =
        Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared).expect("samples in order");
    let error = run(&sensor(SensorModel::Full), &flat, &steady_holds()).expect_err("one circle");
    assert!(error.is_not_identifiable(), "{error}");
    let text = error.to_string();
    assert!(text.contains("do not spread enough") && text.contains("scale.z"), "{text}");
    assert!(text.contains("on one circle, turned about the sensor's axis z only"), "{text}");
    // always the same orientation, turned about the vertical
    flat.readings_mut()
        .iter_mut()
        .for_each(|reading| *reading = Vector3::new(reading.z, reading.z, 9.81) + *reading * 1e-4);
    let error = run(&sensor(SensorModel::ScaleBias), &flat, &steady_holds()).expect_err("one point");
    assert!(error.to_string().contains("all are in the same orientation"), "{error}");
}

#[test]
fn poor_spread_is_a_warning_with_the_missing_side_named() {
    // the upper half of the sphere only
    let (_, recording) = simulate(60, 6);
    let calibration = run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect("identifiable");
    let up: Vec<(f64, f64)> = holds(&calibration)
        .holds
        .iter()
        .filter(|hold| hold.force_mps2.z > 4.0)
        .map(|hold| (hold.hold.start_s, hold.hold.end_s))
        .collect();
    let setup = HoldsSetup { intervals_s: Some(up), ..steady_holds() };
    let calibration = run(&sensor(SensorModel::Full), &recording, &setup).expect("identifiable");
    assert!(!holds(&calibration).detected);
    let words = messages(&calibration.warnings).join("\n");
    assert!(words.contains("the z axis pointing down"), "{words}");
    assert!(words.contains("are too similar"), "{words}");
}

#[test]
fn one_hold_more_than_parameters_is_said_so() {
    let (_, recording) = simulate(10, 3);
    let setup = steady_holds();
    let calibration = run(&sensor(SensorModel::Full), &recording, &setup).expect("determined");
    let words = messages(&calibration.warnings).join("\n");
    assert_eq!(calibration.fit.degrees_of_freedom, 1);
    assert!(words.contains("only one hold more than parameters. "), "{words}");
}

#[test]
fn given_holds_are_used_as_given_and_checked() {
    let (_, recording) = simulate(24, 7);
    let found = find_holds(&recording, 1.0).expect("fine");
    let intervals: Vec<_> = found.iter().map(|hold| (hold.start_s, hold.end_s)).collect();
    let setup = HoldsSetup { intervals_s: Some(intervals.clone()), ..steady_holds() };
    let given = run(&sensor(SensorModel::Full), &recording, &setup).expect("identifiable");
    let detected = run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect("identifiable");
    assert_eq!(given.values, detected.values);
    for (intervals, word) in [
        (vec![(1e6, 2e6)], "hold 1 from 1000000 to 2000000 s has 0 samples"),
        (vec![(0.5, 3.0), (2.0, 3.5)], "holds 1 and 2 overlap"),
    ] {
        let setup = HoldsSetup { intervals_s: Some(intervals), ..steady_holds() };
        let error = run(&sensor(SensorModel::Full), &recording, &setup).expect_err("nonsense");
        assert!(error.to_string().contains(word), "{error}");
    }
}

#[test]
fn the_uncertainty_of_gravity_is_a_common_scale() {
    let (_, recording) = simulate(24, 8);
    let at = |sd_mps2| {
        let setup = HoldsSetup { gravity: Gravity { magnitude_mps2: 9.80665, sd_mps2 }, ..steady_holds() };
        run(&sensor(SensorModel::Full), &recording, &setup).expect("identifiable")
    };
    let (exact, uncertain) = (at(0.0), at(0.01));
    for k in 0..9 {
        let added = (uncertain.covariance[(k, k)] - exact.covariance[(k, k)]).sqrt();
        let expected = if k < 3 { 0.0 } else { exact.values[k].abs() * 0.01 / 9.80665 };
        assert!((added - expected).abs() < 1e-9, "{}", exact.parameters[k].name);
    }
    assert!(uncertain.correlation()[(3, 4)] > 0.99, "the scale factors share gravity's error");
}

#[test]
fn holds_are_found_at_any_noise_and_unit() {
    for (noise, gain, rate) in [
        (1e-5, 1.0, 100.0),
        (0.1, 1.0, 100.0),
        (0.01, 16_384.0 / 9.81, 50.0),
        (0.02, 415.0, 400.0),
        (0.0, 1.0, 100.0),
    ] {
        let mut rng = stream(9, Purpose::Sensor, 0);
        let simulation = HoldsSimulation {
            poses: 15,
            hold_s: 3.0,
            turn_s: 1.0,
            rate_hz: rate,
            gravity_mps2: 9.81,
            between_holds_sd_mps2: 0.0,
        };
        let truth = SensorParameters {
            bias: Vector3::new(10.0, -20.0, 5.0) * gain,
            matrix: Matrix3::identity() * gain,
            ..SensorParameters::identity()
        };
        let (recording, _) = simulate_holds(
            &truth,
            &Vector3::repeat(noise * gain),
            ReadingUnit::Counts,
            &simulation,
            &mut rng,
        );
        let found = find_holds(&recording, 1.0).expect("fine");
        assert_eq!(found.len(), 15, "noise {noise}, gain {gain}, {rate} Hz");
        for (k, hold) in found.iter().enumerate() {
            let start = k as f64 * 4.0;
            assert!(
                hold.start_s >= start - 0.05 && hold.end_s <= start + 3.05,
                "{} {}",
                hold.start_s,
                hold.end_s
            );
            assert!(hold.duration_s() > 2.0);
        }
    }
}

/// Times at 400 Hz: in whole milliseconds, late by 3 ms on average, with three samples in ten lost, or all of
/// these.
#[test]
fn holds_are_found_whatever_became_of_the_times() {
    let simulation = HoldsSimulation {
        poses: 14,
        hold_s: 3.0,
        turn_s: 1.5,
        rate_hz: 400.0,
        gravity_mps2: 9.80665,
        between_holds_sd_mps2: 0.0,
    };
    let unit = ReadingUnit::MetrePerSecondSquared;
    let identity = SensorParameters::identity();
    for [coarse, late, lost] in
        [[true, false, false], [false, true, false], [false, false, true], [true, true, true]]
    {
        let mut rng = stream(31, Purpose::Sensor, 0);
        let (even, _) = simulate_holds(&identity, &Vector3::repeat(0.01), unit, &simulation, &mut rng);
        let arrival = |t: f64, share: f64| if late { t - 0.003 * share.ln() } else { t };
        let tick = |t: f64| if coarse { (1e3 * t).round() / 1e3 } else { t };
        let mut arrived: Vec<f64> =
            even.times_s().iter().map(|t| tick(arrival(*t, rng.random_range(1e-6..1.0)))).collect();
        arrived.sort_by(f64::total_cmp);
        let (mut times_s, mut readings) = (Vec::new(), Vec::new());
        for (t, reading) in arrived.into_iter().zip(even.readings()) {
            let is_new = times_s.last().is_none_or(|last| t > *last);
            if is_new && !(lost && rng.random_bool(0.3)) {
                times_s.push(t);
                readings.push(*reading);
            }
        }
        let recording = Recording::new(times_s, readings, 3, unit).expect("samples in order");
        let found = find_holds(&recording, 1.0).expect("fast enough");
        let rate = recording.rate_hz();
        assert_eq!(found.len(), 14, "{coarse} {late} {lost}: {rate} Hz");
        if !(late && lost) {
            assert!((rate / 400.0 - 1.0).abs() < 0.02, "{coarse} {late} {lost}: {rate} Hz");
        }
        let seconds: f64 = found.iter().map(|hold| hold.duration_s()).sum();
        assert!(seconds > 0.8 * 14.0 * 3.0, "{coarse} {late} {lost}: {seconds} s");
    }
}

#[test]
fn six_faces_do_not_determine_cross_axis_terms() {
    let mut rng = stream(12, Purpose::Sensor, 0);
    let truth = draw_sensor(&sensor(SensorModel::ScaleBias), &mut rng);
    let (mut times_s, mut readings) = (vec![], vec![]);
    let faces = [Vector3::x(), -Vector3::x(), Vector3::y(), -Vector3::y(), Vector3::z(), -Vector3::z()];
    for k in 0..24 * 500 {
        let (pose, next) = (faces[(k / 500) % 6], faces[(k / 500 + 1) % 6]);
        // four seconds still, one second of turning
        let done = ((k % 500) as f64 / 100.0 - 4.0).max(0.0);
        let force = (pose * (1.0 - done) + next * done + Vector3::new(0.2, 0.1, 0.3) * (done * (1.0 - done)))
            * 9.80665;
        let noise =
            Vector3::from_fn(|axis, _| 0.02 * (((k * 7919 + axis * 104_729) % 1009) as f64 / 1009.0 - 0.5));
        times_s.push(k as f64 * 0.01);
        readings.push(truth.reading(&force) + noise);
    }
    let recording =
        Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared).expect("samples in order");
    let error = run(&sensor(SensorModel::Full), &recording, &steady_holds()).expect_err("faces only");
    assert!(error.is_not_identifiable(), "{error}");
    let text = error.to_string();
    assert!(text.contains("matrix.x") && text.contains("use model = \"scale-bias\""), "{text}");
    let calibration =
        run(&sensor(SensorModel::ScaleBias), &recording, &steady_holds()).expect("identifiable");
    for k in 0..3 {
        assert!((calibration.values[3 + k] - truth.matrix[(k, k)]).abs() < 5.0 * calibration.sd()[3 + k]);
    }
}

#[test]
fn a_gyroscope_is_not_calibrated_as_an_accelerometer() {
    let Some(path) = shared_data("xsens-mti-static/xsens_gyro.mat") else { return };
    let recording = read_accelerometer(&path, 3, ReadingUnit::Counts);
    let sensor =
        Sensor { unit: ReadingUnit::Counts, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) };
    let error = run(&sensor, &recording, &steady_holds()).expect_err("no gravity in there");
    assert!(error.is_not_identifiable() || error.is_invalid_recording(), "{error}");
}

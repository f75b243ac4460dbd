//! Tests of an IMU whose bias and gain follow temperature: against the truth on simulated ones, and where the
//! data do not determine it.

use crate::common::WORDS;
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{
    Calibration, CalibrationSettings, CalibrationStatus, Comparison, ImuProblem, ImuSetup, KnownTerm,
    ThermalModel, ThermometerLag, Turn, calibrate_imu,
};
use calibrant::io::{CalibrationFile, ConventionOptions, Origin, parse_calibrated_imu, to_json};
use calibrant::sensor::{
    CalibratedImu, Gauge, ImuCorrection, ImuParameters, ImuQuantity, ImuRecording, Sensor, SensorKind,
    SensorModel, SensorParameters, Temperatures, Thermal,
};
use calibrant::simulate::{
    ImuSimulation, Purpose, Rng, TableAction, TableStep, draw_thermal, simulate_imu, simulate_table, stream,
};
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

fn normal(rng: &mut Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// A model in which everything follows temperature to second order.
const ALL_TO_2: ThermalModel = ThermalModel {
    reference_c: None,
    accelerometer_bias: 2,
    accelerometer_scale: 2,
    gyroscope_bias: 2,
    gyroscope_scale: 2,
};

/// A MEMS IMU of the middle class: over 25 K its bias moves by some 10 mm/s² and 0.1 °/s, its gain by 0.1 %.
fn draw(model: &ThermalModel, rng: &mut Rng) -> ImuParameters {
    let mut sensor = |bias: f64, spread: f64| SensorParameters {
        bias: Vector3::from_fn(|_, _| bias * normal(rng)),
        matrix: Matrix3::identity() + Matrix3::from_fn(|_, _| spread * normal(rng)),
        ..SensorParameters::identity()
    };
    let accelerometer = Gauge::Upper.apply(&sensor(0.1, 0.01));
    let gyroscope = sensor(0.02, 0.01);
    let g_sensitivity = Matrix3::zeros();
    let mut imu =
        ImuParameters { sensors: [accelerometer, gyroscope].into(), g_sensitivity, thermal: Thermal::none() };
    imu.thermal.reference_c = 32.0;
    draw_thermal(&mut imu, &model.quantities(), [Vector3::repeat(1.0); 2], rng);
    imu
}

fn run(recording: &ImuRecording, setup: &ImuSetup) -> calibrant::Result<Calibration> {
    let (accelerometer, gyroscope) = (Sensor::triaxial(SensorModel::Full), unfeeling_gyroscope());
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope: &gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default())
}

fn setup(model: ThermalModel) -> ImuSetup {
    ImuSetup {
        thermal: ThermalModel { reference_c: Some(32.0), ..model },
        thermometer: ThermometerLag { lag_s: 0.0, sd_s: 0.0 },
        ..steady_imu()
    }
}

fn ramp(poses: usize) -> ImuSimulation {
    ImuSimulation { poses, temperature_c: Some([20.0, 45.0]), ..ImuSimulation::default() }
}

/// Mean and coverage of every quantity over IMUs turned by hand; returns those that are off.
fn off(model: ThermalModel, poses: usize, count: u64) -> Vec<String> {
    let simulation = ramp(poses);
    off_in(&setup(model), count, &|truth, rng| simulate_imu(truth, &simulation, rng))
}

/// The same, with these conditions of the recording.
fn off_in(
    setup: &ImuSetup,
    count: u64,
    record: &(dyn Fn(&ImuParameters, &mut Rng) -> ImuRecording + Sync),
) -> Vec<String> {
    let found: Vec<(Vec<ImuQuantity>, Vec<f64>)> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut rng = stream(12, Purpose::Sensor, number);
            let truth = draw(&setup.thermal, &mut rng);
            let recording = record(&truth, &mut rng);
            let calibration = run(&recording, setup).expect("determined");
            assert_eq!(calibration.status, CalibrationStatus::Converged, "{number}");
            let sd = calibration.sd();
            let pairs = calibration.quantities.iter().zip(calibration.values.iter().zip(sd));
            let z = pairs.map(|(quantity, (value, sd))| (value - quantity.value(&truth)) / sd).collect();
            (calibration.quantities, z)
        })
        .collect();
    let mut off = Vec::new();
    let n = count as f64;
    for (k, quantity) in found[0].0.iter().enumerate() {
        let z = || found.iter().map(|(_, z)| z[k]);
        let covered = z().filter(|z| z.abs() < 1.959_964).count() as f64 / n;
        let mean = z().sum::<f64>() / n;
        let rms = (z().map(|z| z * z).sum::<f64>() / n).sqrt();
        println!("{}: {covered:.4} covered, mean {mean:+.3}, rms {rms:.3}", quantity.name());
        // four standard deviations of a share and of a mean; and 2.5 % for the scatter between holds, which
        // is zero here but estimated, too
        let band = 4.0 * (0.95 * 0.05 / n).sqrt() + 0.025;
        if (covered - 0.95).abs() > band || mean.abs() > 4.0 / n.sqrt() {
            off.push(format!("{}: {covered} covered, mean {mean:+.3}", quantity.name()));
        }
    }
    off
}

#[test]
fn intervals_of_200_imus_with_linear_terms_cover_the_truth() {
    let model = ThermalModel {
        accelerometer_bias: 1,
        accelerometer_scale: 1,
        gyroscope_bias: 1,
        gyroscope_scale: 1,
        ..ThermalModel::default()
    };
    let off = off(model, 36, 200);
    assert!(off.is_empty(), "{off:#?}");
}

#[test]
fn intervals_of_200_imus_with_quadratic_terms_cover_the_truth() {
    let off = off(ALL_TO_2, 48, 200);
    assert!(off.is_empty(), "{off:#?}");
}

/// On a turntable that warms up: three times each of six faces, and a turn there and back about each axis.
/// Angles are exact within 0.1°.
#[test]
fn intervals_of_200_imus_turned_by_known_angles_cover_the_truth() {
    let model = ThermalModel { gyroscope_bias: 1, gyroscope_scale: 1, ..ThermalModel::default() };
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let faces: Vec<Vector3<f64>> = (0..3).flat_map(|_| axes).flat_map(|axis| [axis, -axis]).collect();
    let (mut steps, mut setup) = (Vec::new(), setup(model));
    let mut intervals = Vec::new();
    for (k, face) in faces.iter().enumerate() {
        let start_s = 8.0 * k as f64;
        let (hold, turn) = ((start_s, start_s + 3.0), (start_s + 3.0, start_s + 6.0));
        intervals.push((hold.0 + 0.02, hold.1 - 0.02));
        steps.push(TableStep { start_s: hold.0, end_s: hold.1, action: TableAction::Hold(*face) });
        // there on a face, back on the opposite one
        let (axis, angle_rad, angle_sd_rad) = (*face, std::f64::consts::TAU, 0.1_f64.to_radians());
        let action = TableAction::Turn { axis, angle_rad, angle_sd_rad, axis_sd_rad: None };
        steps.push(TableStep { start_s: turn.0, end_s: turn.1, action });
        setup.turns.push(Turn {
            name: None,
            start_s: turn.0,
            end_s: turn.1,
            axis,
            angle_rad,
            angle_sd_rad,
            axis_sd_rad: None,
        });
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(faces);
    let warming = ramp(0);
    let off = off_in(&setup, 200, &|truth, rng| simulate_table(truth, &steps, &warming, rng));
    assert!(off.is_empty(), "{off:#?}");
}

/// The same polynomials, derived by hand: `ω = S⁻¹ D⁻¹ (y − b − b_1 τ − b_2 τ²)`.
#[test]
fn the_correction_of_each_sample_is_that_at_its_temperature() {
    let mut rng = stream(5, Purpose::Sensor, 1);
    let truth = draw(&ALL_TO_2, &mut rng);
    let quiet = ImuSimulation { accelerometer_noise: 0.0, gyroscope_noise: 0.0, ..ramp(4) };
    let recording = simulate_imu(&truth, &quiet, &mut rng);
    let units = [Some(quiet.accelerometer_unit), Some(quiet.gyroscope_unit)];
    let imu = CalibratedImu::new(truth, units, Vec::new(), "");
    let corrected = ImuCorrection::of(&imu).and_then(|of| of.apply(&recording)).expect("regular");
    let temperature = recording.temperature_c.as_ref().expect("simulated");
    for (sensor_kind, found) in [
        (SensorKind::Accelerometer, corrected.accelerometer.expect("there")),
        (SensorKind::Gyroscope, corrected.gyroscope.expect("there")),
    ] {
        let (sensor, terms) = (truth.sensor(sensor_kind), truth.thermal.sensor(sensor_kind));
        for (k, reading) in recording.sensor(sensor_kind).expect("there").readings().iter().enumerate() {
            let tau = temperature[k] - 32.0;
            let mut left = reading - sensor.bias - terms.bias[0] * tau - terms.bias[1] * tau * tau;
            for axis in 0..3 {
                left[axis] /= 1.0 + terms.scale[0][axis] * tau + terms.scale[1][axis] * tau * tau;
            }
            let expected = sensor.matrix.lu().solve(&left).expect("regular");
            assert!((found.values[k] - expected).amax() < 1e-12, "{sensor_kind} {k}");
        }
    }
    let last = temperature.len() - 1;
    assert!((temperature[last] - 45.0).abs() < 1e-9, "13 K from the reference");
}

fn quantity(name: &str) -> ImuQuantity {
    let all = ImuQuantity::all_thermal(true, true);
    all.into_iter().find(|quantity| quantity.name() == name).expect(name)
}

fn place(calibration: &Calibration, name: &str) -> usize {
    calibration.quantities.iter().position(|quantity| quantity.name() == name).expect(name)
}

/// A model in which only the gyroscope's bias follows temperature, to first order.
const GYROSCOPE_BIAS: ThermalModel = ThermalModel {
    reference_c: None,
    accelerometer_bias: 0,
    accelerometer_scale: 0,
    gyroscope_bias: 1,
    gyroscope_scale: 0,
};

fn recorded(model: &ThermalModel, temperature_c: [f64; 2]) -> (ImuParameters, ImuRecording) {
    let mut rng = stream(6, Purpose::Sensor, 3);
    let truth = draw(model, &mut rng);
    let simulation = ImuSimulation { temperature_c: Some(temperature_c), ..ImuSimulation::default() };
    let recording = simulate_imu(&truth, &simulation, &mut rng);
    (truth, recording)
}

#[test]
fn a_temperature_in_whole_degrees_is_noted_where_something_follows_it() {
    let (_, mut recording) = recorded(&GYROSCOPE_BIAS, [20.0, 45.0]);
    let step = |recording: &ImuRecording, setup: &ImuSetup| -> Option<String> {
        let calibration = run(recording, setup).expect("determined");
        let coarse = calibration.warnings.iter().find(|of| of.code().name() == "thermometer-coarse");
        coarse.map(ToString::to_string)
    };
    let follows = setup(GYROSCOPE_BIAS);
    assert_eq!(step(&recording, &follows), None);
    recording.temperature_c.iter_mut().flatten().for_each(|celsius| *celsius = celsius.round());
    let said = step(&recording, &follows).expect("noted");
    assert!(said.contains("steps of 1 K") && said.contains("0.29 K"), "{said}");
    assert_eq!(step(&recording, &steady_imu()), None);
}

#[test]
fn a_constant_temperature_is_named_and_a_prior_alone_determines_a_term() {
    let (_, recording) = recorded(&ThermalModel::default(), [30.0, 30.2]);
    let error = run(&recording, &setup(GYROSCOPE_BIAS)).expect_err("not determined");
    assert!(error.is_not_identifiable(), "{error}");
    let message = error.to_string();
    assert!(message.contains("gyroscope.bias_per_k.x"), "{message}");
    assert!(message.contains("the temperature of the holds changed by 0.2 K only"), "{message}");
    assert!(message.contains("wider range"), "{message}");

    let known = |axis: &str, sd: Option<f64>| KnownTerm {
        quantity: quantity(&format!("gyroscope.bias_per_k.{axis}")),
        value: 3e-5,
        sd,
    };
    let setup = ImuSetup {
        known: ["x", "y", "z"].map(|axis| known(axis, Some(2e-5))).to_vec(),
        ..setup(GYROSCOPE_BIAS)
    };
    let calibration = run(&recording, &setup).expect("known beforehand");
    for axis in ["x", "y", "z"] {
        let k = place(&calibration, &format!("gyroscope.bias_per_k.{axis}"));
        assert!(calibration.prior_share[k] > 0.99, "{}", calibration.prior_share[k]);
        let (value, sd) = (calibration.values[k], calibration.sd()[k]);
        assert!((sd / 2e-5 - 1.0).abs() < 5e-3, "{sd}");
        // the data pull by their share of the information
        let pull = (1.0 - calibration.prior_share[k]).sqrt() * 2e-5;
        assert!((value - 3e-5).abs() < 4.0 * pull, "{value} ± {sd}, pulled by {pull}");
    }

    let setup = ImuSetup { known: ["x", "y", "z"].map(|axis| known(axis, None)).to_vec(), ..setup };
    let fixed = run(&recording, &setup).expect("fixed");
    assert!(fixed.quantities.iter().all(|quantity| !matches!(quantity, ImuQuantity::Thermal(..))));
    assert_eq!(fixed.imu.thermal[SensorKind::Gyroscope].bias[0], Vector3::repeat(3e-5));
    // the bias at 32 °C is the one at 30.1 °C and 1.9 K more
    let (a, b) = (&calibration.imu, &fixed.imu);
    let terms = a.thermal[SensorKind::Gyroscope].bias[0] - b.thermal[SensorKind::Gyroscope].bias[0];
    let expected = 1.9 * terms;
    // the weights are not quite the same: those with a prior come from a fit with free terms
    let sd = calibration.sd()[place(&calibration, "gyroscope.bias.x")];
    let difference = a[SensorKind::Gyroscope].bias - b[SensorKind::Gyroscope].bias - expected;
    assert!(difference.amax() < 0.05 * sd, "{difference} {sd}");
}

#[test]
fn two_temperatures_do_not_determine_a_parabola() {
    let (_, mut recording) = recorded(&GYROSCOPE_BIAS, [20.0, 45.0]);
    let times = recording[SensorKind::Accelerometer].as_ref().expect("there").times_s();
    // it jumps in the rotation from 52 to 54 s
    recording.temperature_c = Some(times.iter().map(|t| if *t < 53.0 { 20.0 } else { 45.0 }).collect());
    let parabola = ThermalModel { gyroscope_bias: 2, ..GYROSCOPE_BIAS };
    let error = run(&recording, &setup(parabola)).map(|_| ()).expect_err("not determined");
    assert!(error.is_not_identifiable(), "{error}");
    let message = error.to_string();
    assert!(message.contains("have 2 temperatures") && message.contains("order 2 need 3"), "{message}");
    run(&recording, &setup(GYROSCOPE_BIAS)).expect("a straight line");
}

#[test]
fn what_is_no_temperature_is_said() {
    let (_, mut recording) = recorded(&GYROSCOPE_BIAS, [20.0, 45.0]);
    recording.temperature_c.as_mut().expect("simulated")[7] = 4000.0;
    let message = run(&recording, &setup(GYROSCOPE_BIAS)).expect_err("4000 °C").to_string();
    assert!(message.contains("the temperature is 4000 °C at 0.07 s"), "{message}");
    recording.temperature_c = None;
    let message = run(&recording, &setup(GYROSCOPE_BIAS)).expect_err("none").to_string();
    assert!(message.contains("the recording has none") && message.contains("[columns]"), "{message}");
}

/// Six holds of thirty are 25 K warmer than the rest. The bias of each axis moves by 0.1 m/s², 158 times the
/// noise of a hold's mean.
#[test]
fn no_hold_is_thrown_away_for_its_temperature_and_a_bad_one_still_is() {
    let model = ThermalModel { accelerometer_bias: 1, accelerometer_scale: 1, ..ThermalModel::default() };
    let (mut truth, _) = recorded(&model, [20.0, 45.0]);
    truth.thermal[SensorKind::Accelerometer].bias[0] = Vector3::new(4e-3, -4e-3, 4e-3);
    // the same stream: the same motion and noise at both temperatures, which jump in the turn from 106 to 108 s
    let at = |temperature_c: f64| {
        let simulation = ImuSimulation { temperature_c: Some([temperature_c; 2]), ..ramp(30) };
        simulate_imu(&truth, &simulation, &mut stream(6, Purpose::Sensor, 4))
    };
    let (mut recording, warm) = (at(20.0), at(45.0));
    let jump = recording[SensorKind::Accelerometer]
        .as_ref()
        .expect("there")
        .times_s()
        .partition_point(|t| *t < 107.0);
    for (sensor_kind, warm) in warm.sensors() {
        let cold = recording[sensor_kind].as_mut().expect("there");
        cold.readings_mut()[jump..].copy_from_slice(&warm.readings()[jump..]);
    }
    recording.temperature_c.as_mut().expect("simulated")[jump..].fill(45.0);
    let left_out = |calibration: &Calibration| -> Vec<usize> {
        let holds = calibration.hold_results().iter().enumerate();
        holds.filter_map(|(j, hold)| (!hold.used).then_some(j)).collect()
    };
    // the warm ones do not fit a calibration without terms
    let blind = run(&recording, &steady_imu()).expect("determined");
    assert_eq!(left_out(&blind), [24, 25, 26, 27, 28, 29]);
    let clean = run(&recording, &setup(model)).expect("determined");
    assert!(clean.hold_results().iter().all(|hold| hold.used));
    assert!(
        clean.holds().expect("held").between_holds_sd_mps2 < 1e-3,
        "{}",
        clean.holds().expect("held").between_holds_sd_mps2
    );
    for quantity in model.quantities() {
        let k = place(&clean, &quantity.name());
        let z = (clean.values[k] - quantity.value(&truth)) / clean.sd()[k];
        assert!(z.abs() < 4.0, "{}: {z}", quantity.name());
    }
    assert_eq!(clean.imu.thermal.range_c.expect("known").map(f64::round), [20.0, 45.0]);

    let bad = &clean.hold_results()[11].hold;
    let accelerometer = recording[SensorKind::Accelerometer].as_mut().expect("there");
    for (t, reading) in accelerometer.samples_mut() {
        if (bad.start_s..=bad.end_s).contains(t) {
            *reading *= 1.01;
        }
    }
    let calibration = run(&recording, &setup(model)).expect("determined");
    assert_eq!(left_out(&calibration), [11]);
}

/// The thermometer is that of another chip, and lags by 20 s.
#[test]
fn a_lag_of_the_thermometer_is_in_the_standard_deviations() {
    let model = ThermalModel { accelerometer_bias: 1, gyroscope_bias: 1, ..ThermalModel::default() };
    let worst = |thermometer: ThermometerLag| {
        let setup = ImuSetup { thermometer, ..setup(model) };
        let of = |number: u64| {
            let mut rng = stream(13, Purpose::Sensor, number);
            let truth = draw(&model, &mut rng);
            let mut recording = simulate_imu(&truth, &ramp(24), &mut rng);
            let of_chip = Temperatures::of(&recording).expect("possible").expect("there");
            let late = of_chip.times_s.iter().map(|t| of_chip.at(t - 20.0)).collect();
            recording.temperature_c = Some(late);
            let found = run(&recording, &setup).expect("determined");
            let values = found.quantities.iter().zip(found.values.iter().zip(found.sd()));
            values.map(|(of, (value, sd))| ((value - of.value(&truth)) / sd).abs()).fold(0.0, f64::max)
        };
        (0..8).into_par_iter().map(of).reduce(|| 0.0, f64::max)
    };
    let [unknown, denied, stated] = [
        ThermometerLag::default(),
        ThermometerLag { lag_s: 0.0, sd_s: 0.0 },
        ThermometerLag { lag_s: 20.0, sd_s: 1.0 },
    ]
    .map(worst);
    assert!(unknown < 4.5 && denied > 10.0 && stated < 4.5, "{unknown} {denied} {stated}");
}

/// Its file, its corrections at the holds, and its comparison with a calibration at another reference.
#[test]
fn a_calibration_keeps_its_terms_in_its_file() {
    let (_, recording) = recorded(&ALL_TO_2, [20.0, 45.0]);
    let linear = ThermalModel { accelerometer_bias: 1, ..GYROSCOPE_BIAS };
    let calibration = run(&recording, &setup(linear)).expect("determined");
    let text = to_json(&CalibrationFile::of(&calibration, &[], &Origin::default(), &WORDS));
    let back = parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default()).expect("ours");
    assert_eq!(back.imu, calibration.calibrated());
    let message = text.replace("\"reference_c\": 32.0", "\"reference_c\": 3200.0");
    let error = parse_calibrated_imu(message.as_bytes(), &ConventionOptions::default()).expect_err("hot");
    assert!(error.to_string().contains("not between -273.15 and 1000"), "{error}");

    let other = run(&recording, &ImuSetup { thermal: linear, ..steady_imu() }).expect("determined");
    assert_eq!(other.imu.thermal.reference_c, 33.0, "the mean over the holds, to the degree");
    let other = ThermalModel { reference_c: Some(25.0), ..linear };
    let other =
        run(&recording, &ImuSetup { thermal: other, ..steady_imu() }).expect("determined").calibrated();
    let comparison = Comparison::of(&calibration.calibrated(), &other);
    // the same data, only given at another temperature
    for row in &comparison.quantities {
        let in_sd = row.in_sd.unwrap_or(0.0);
        assert!(in_sd.abs() < 0.02, "{}: {in_sd}", row.invariant.name());
    }
    assert!(comparison.quantities.iter().any(|row| row.invariant.name() == "gyroscope.bias_per_k.z"));
    assert!(
        comparison.notes.iter().any(|note| note.message().contains("as they are at 32 °C")),
        "{:?}",
        comparison.notes
    );
}

/// The directions of the holds are known, as on a turntable: the same motion of a perfect IMU without noise
/// gives them.
#[test]
fn terms_are_found_where_the_directions_of_the_holds_are_known() {
    let model =
        ThermalModel { accelerometer_bias: 2, accelerometer_scale: 1, gyroscope_bias: 1, ..GYROSCOPE_BIAS };
    let mut truth = draw(&model, &mut stream(7, Purpose::Sensor, 1));
    truth.thermal[SensorKind::Accelerometer].bias[0] = Vector3::new(4e-3, -4e-3, 4e-3);
    let simulation = ramp(30);
    let recording = simulate_imu(&truth, &simulation, &mut stream(7, Purpose::Sensor, 2));
    let quiet = ImuSimulation { accelerometer_noise: 0.0, gyroscope_noise: 0.0, ..simulation.clone() };
    let exact = simulate_imu(&ImuParameters::identity(), &quiet, &mut stream(7, Purpose::Sensor, 2));
    let forces = exact[SensorKind::Accelerometer].clone().expect("there");
    let period = simulation.hold_s + simulation.turn_s;
    let starts: Vec<f64> = (0..30).map(|k| f64::from(k) * period).collect();
    let mut setup = setup(model);
    setup.holds.intervals_s = Some(starts.iter().map(|start| (start + 0.1, start + 2.4)).collect());
    let at = |time: f64| forces.readings()[forces.times_s().partition_point(|&t| t < time)];
    setup.directions = Some(starts.iter().map(|start| at(start + 1.0).normalize()).collect());
    setup.face_sd_rad = Some(1e-6);
    let calibration = run(&recording, &setup).expect("determined");
    assert!(calibration.quantities.len() == 12 + 12 + 9 + 3, "{}", calibration.quantities.len());
    assert!(
        calibration.holds().expect("held").between_holds_sd_mps2 < 1e-3,
        "{}",
        calibration.holds().expect("held").between_holds_sd_mps2
    );
    let sd = calibration.sd();
    let z = calibration.quantities.iter().zip(&calibration.values).zip(&sd);
    let z: Vec<f64> = z.map(|((quantity, value), sd)| (value - quantity.value(&truth)) / sd).collect();
    assert!(z.iter().all(|z| z.abs() < 4.5), "{z:?}");
    let rms = (z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64).sqrt();
    assert!((0.6..1.5).contains(&rms), "{rms}");
}

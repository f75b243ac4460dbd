//! Tests of gravity beside a commanded motion: against dense least squares, Monte Carlo, and readings that contradict it.

use crate::common::case::Case;
use calibrant::design::{DesignProblem, evaluate};
use calibrant::error::Refusal;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, Recovered, RecoveredGravity, Stimulus, calibrate,
};
use calibrant::information::Criterion;
use calibrant::information::criterion::{AOptimality, DOptimality};
use calibrant::io::{Experiment, preset};
use calibrant::motion::{CommandedMotion, InputNoise, KnownEnds, Limits, MotionClock, MotionGravity, Trust};
use calibrant::sensor::{Recording, Sensor, SensorKind, SensorModel, SensorParameters};
use calibrant::simulate::{
    Purpose, draw_gravity, draw_sensor, initial_motion, sample_times, simulate_recording, stream,
};
use calibrant::study::{StudyProblem, StudySettings, run_study};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

const NOISY: Trust = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });

fn upright() -> MotionGravity {
    MotionGravity::of_force(Vector3::new(0.0, 0.0, 9.806_65))
}

fn slanted() -> MotionGravity {
    MotionGravity { sd_mps2: 0.01, ..MotionGravity::of_force(Vector3::new(3.0, -4.0, 8.4)) }
}

/// A case whose recording contains a constant force, with this gravity given.
fn with_force(case: &Case, force: Vector3<f64>, gravity: Option<MotionGravity>) -> Case {
    let mut case = case.clone();
    let constant = case.truth.matrix * force;
    case.recording.readings_mut().iter_mut().for_each(|y| *y += constant);
    case.command.gravity = gravity;
    case
}

fn recovered(calibration: &Calibration) -> RecoveredGravity {
    let Recovered::Motion(motion) = &calibration.recovered else { panic!("a motion") };
    motion.gravity.expect("given")
}

/// Dense least squares of parameters and offset together: rows of the readings, of the offset's prior and of the datasheet's.
fn dense(
    case: &Case,
    gravity: &MotionGravity,
    matrix: &Matrix3<f64>,
    prior: bool,
) -> (DVector<f64>, DMatrix<f64>) {
    let list = case.sensor.parameter_list();
    let (p, m) = (list.len(), case.recording.len());
    let mut information = DMatrix::zeros(p + 3, p + 3);
    let mut right = DVector::zeros(p + 3);
    for k in 0..m {
        let force = case.command.motion.acceleration_at(case.recording.times_s()[k]) + gravity.force_mps2;
        let mut rows = DMatrix::zeros(3, p + 3);
        for (place, quantity) in list.quantities().iter().enumerate() {
            rows.column_mut(place).copy_from(&quantity.derivative(&SensorParameters::identity(), &force));
        }
        rows.columns_mut(p, 3).copy_from(matrix);
        rows /= 2e-4;
        information += rows.transpose() * &rows;
        right += rows.transpose() * case.recording.readings()[k] / 2e-4;
    }
    let mut own = information.view_mut((p, p), (3, 3));
    own += gravity.offset_covariance().try_inverse().expect("regular");
    if prior {
        let nominal = case.sensor.nominal().expect("known");
        for (place, parameter) in list.describe(&case.sensor, &nominal).iter().enumerate() {
            let weight = parameter.spread.expect("given").powi(-2);
            information[(place, place)] += weight;
            right[place] += weight * parameter.nominal.expect("given");
        }
    }
    let covariance = calibrant::information::covariance(&information).expect("regular");
    (&covariance * right, covariance)
}

#[test]
fn a_known_motion_with_gravity_equals_dense_least_squares() {
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        for gravity in [upright(), slanted()] {
            let case = Case::new(model, Trust::Known, 14, 5.0, 2.0, 3);
            let case = with_force(&case, gravity.force_mps2 + Vector3::new(0.05, -0.03, 1e-4), Some(gravity));
            for datasheet_prior in [false, true] {
                let settings = CalibrationSettings { datasheet_prior, ..CalibrationSettings::default() };
                let calibration = calibrate(&case.problem(), &settings).expect("identifiable");
                let matrix = calibration.imu[SensorKind::Accelerometer].matrix;
                let (values, covariance) = dense(&case, &gravity, &matrix, datasheet_prior);
                let p = calibration.values.len();
                let sd = calibration.sd();
                for k in 0..p {
                    // the normal equations of the dense solution lose digits; with a prior the offset is linear at another S
                    let off = (calibration.values[k] - values[k]) / sd[k];
                    assert!(off.abs() < 1e-4, "{model:?} {datasheet_prior} {k}: {off}");
                    let ratio = sd[k] / covariance[(k, k)].sqrt() - 1.0;
                    assert!(ratio.abs() < 1e-5, "{model:?} {datasheet_prior} {k}: {ratio}");
                }
                let offset = recovered(&calibration);
                for k in 0..3 {
                    let expected = covariance[(p + k, p + k)];
                    let own = offset.offset_covariance[(k, k)];
                    assert!((own / expected - 1.0).abs() < 1e-5, "{own} {expected}");
                    assert!((offset.offset_mps2[k] - values[p + k]).abs() < 1e-4 * own.sqrt());
                }
                let correlation = calibration.correlation();
                let own = covariance[(2, 5)] / (covariance[(2, 2)] * covariance[(5, 5)]).sqrt();
                // the dense rows are linear where the offset is zero, and the estimate where it is
                let apart = offset.offset_mps2.norm() / gravity.force_mps2.norm();
                let difference = (correlation[(2, 5)] - own).abs();
                assert!(difference < 1e-6 + apart, "bias.z and scale.z: {difference}, {apart}");
            }
        }
    }
}

#[test]
fn gravity_changes_the_bias_and_nothing_else() {
    for (model, trust) in [
        (SensorModel::ScaleBias, Trust::Unknown),
        (SensorModel::ScaleBias, NOISY),
        (SensorModel::Full, NOISY),
    ] {
        let without = Case::new(model, trust, 14, 5.0, 2.0, 5);
        let gravity = MotionGravity { tilt_sd_rad: 0.0, sd_mps2: 0.0, ..slanted() };
        let with = with_force(&without, gravity.force_mps2, Some(gravity));
        let (one, other) = (without.calibrate().expect("good"), with.calibrate().expect("good"));
        let (Recovered::Motion(a), Recovered::Motion(b)) = (&one.recovered, &other.recovered) else {
            panic!()
        };
        // the iterations of both end within a small part of a standard deviation of the optimum
        const CONVERGED: f64 = 1e-4;
        let nodes = a.motion.acceleration_mps2().iter().zip(b.motion.acceleration_mps2());
        for ((a, b), sd) in nodes.zip(&a.acceleration_sd_mps2) {
            assert!(
                (a - b).amax() < 1e-9 + CONVERGED * sd.amax(),
                "{:e}, sd {:e}",
                (a - b).amax(),
                sd.amax()
            );
        }
        let noise = one.fit.assumed_noise.expect("given").amax();
        for (a, b) in a.residuals.iter().zip(&b.residuals) {
            assert!((a - b).amax() < 1e-9 + CONVERGED * noise);
        }
        // the constant was made with the true S, and is taken out with the estimated one
        let shift = (with.truth.matrix - other.imu[SensorKind::Accelerometer].matrix) * gravity.force_mps2;
        for k in 0..one.values.len() {
            let expected = one.values[k] + if k < 3 { shift[k] } else { 0.0 };
            let off = (other.values[k] - expected) / one.sd()[k];
            assert!(off.abs() < 1e-4, "{model:?} {trust:?} {k}: {off}");
        }
        // b = r − S γ: its variance is that of r, less twice the covariance, plus g² that of S
        let (list, c) = (with.sensor.parameter_list(), &one.covariance);
        let mut row = DVector::zeros(list.len());
        for (place, quantity) in list.quantities().iter().enumerate() {
            row[place] = if place == 2 {
                1.0
            } else if place < 3 {
                0.0
            } else {
                -quantity.derivative(&SensorParameters::identity(), &gravity.force_mps2)[2]
            };
        }
        let expected = row.dot(&(c * &row));
        assert!((other.covariance[(2, 2)] / expected - 1.0).abs() < 1e-5, "{expected}");
    }
}

/// Number of simulated sensors.
const SENSORS: usize = 1000;

/// True tilts are turned exactly and not to first order, so the bias that is up has an error that is no Gaussian.
#[test]
fn tilts_from_their_prior_are_covered() {
    for (trust, gravity) in [(Trust::Known, upright()), (Trust::Known, slanted()), (NOISY, upright())] {
        let sensor =
            Sensor { model: SensorModel::Full, cross_axis_sd: Some(0.005), ..Sensor::memsic_mxd2020u() };
        let limits = Limits {
            acceleration_mps2: Some(Vector3::repeat(20.0)),
            jerk_mps3: Some(Vector3::repeat(20.0)),
            ..Limits::default()
        };
        let motion = initial_motion(10, 1.0, 3, &limits, &mut stream(1, Purpose::Motion, 0)).expect("valid");
        let command = CommandedMotion {
            motion,
            trust,
            known_ends: KnownEnds::Start,
            gravity: Some(gravity),
            clock: MotionClock::default(),
        };
        let problem = StudyProblem { sensor: &sensor, command: &command, rate_hz: 10.0, sensors: SENSORS };
        for datasheet_prior in [false, true] {
            let calibration = CalibrationSettings { datasheet_prior, ..CalibrationSettings::default() };
            let settings = StudySettings { seed: 20, calibration, ..StudySettings::default() };
            let study = run_study(&problem, &settings, &|_| ()).expect("identifiable");
            for row in &study.summary {
                let error = (0.95 * 0.05 / SENSORS as f64).sqrt();
                assert!((row.coverage_95 - 0.95).abs() < 5.0 * error, "{}: {}", row.name, row.coverage_95);
                // the square of a tilt is exponential: its mean square scatters √5 and not √2 in one sample
                let ratio = row.realised_rms / row.predicted_sd;
                assert!(
                    (ratio - 1.0).abs() < 5.0 * 5.0_f64.sqrt() / 2.0 / (SENSORS as f64).sqrt(),
                    "{}: {ratio}",
                    row.name
                );
            }
        }
    }
}

/// The datasheet's prior of the biases tells the tilt from them, as far as it goes.
#[test]
fn the_tilt_is_estimated_where_the_datasheet_is_a_prior() {
    let sensor = Sensor { bias_sd_mps2: Some(Vector3::repeat(0.02)), ..Sensor::memsic_mxd2020u() };
    let gravity = upright();
    let settings = CalibrationSettings { datasheet_prior: true, ..CalibrationSettings::default() };
    let (mut squares, mut prior, mut count) = (0.0, 0.0, 0.0);
    for index in 0..300 {
        let mut rng = stream(9, Purpose::Sensor, index);
        let truth = draw_sensor(&sensor, &mut rng);
        let at_rest = draw_gravity(&gravity, &mut rng);
        let motion = initial_motion(10, 1.0, 3, &Limits::default(), &mut stream(2, Purpose::Motion, 0))
            .expect("valid");
        let sensed = motion.plus(&at_rest.force_mps2).expect("finite");
        let times = sample_times(&motion, 10.0);
        let noise = Vector3::repeat(2e-4);
        let recording = simulate_recording(&truth, &noise, sensor.unit, 3, &sensed, &times, &mut rng);
        let command = CommandedMotion {
            motion,
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity: Some(gravity),
            clock: MotionClock::default(),
        };
        let problem = CalibrationProblem {
            sensor: &sensor,
            recording: &recording,
            stimulus: Stimulus::Motion(&command),
        };
        let found = recovered(&calibrate(&problem, &settings).expect("identifiable"));
        let (tilt, sd) = (found.tilt_rad(), found.tilt_sd_rad());
        assert_eq!(
            found.tilts().iter().map(|(name, ..)| name.as_str()).collect::<Vec<_>>(),
            ["tilt.x", "tilt.y"]
        );
        for k in 0..2 {
            squares += ((tilt[k] - at_rest.tilt_rad[k]) / sd[k]).powi(2);
            prior += sd[k] / gravity.tilt_sd_rad;
            count += 1.0;
        }
    }
    assert!((squares / count - 1.0).abs() < 5.0 * (2.0_f64 / count).sqrt(), "{}", squares / count);
    // σ_θ g = 0.0856 beside 0.02: what is left is 0.0195/0.0856
    assert!((prior / count - 0.2277).abs() < 1e-3, "{}", prior / count);
}

fn refusal(case: &Case) -> (Refusal, String, String) {
    let error = case.calibrate().expect_err("contradicted");
    assert!(error.is_invalid_recording(), "{error}");
    let input = error.input_error().expect("an input error").clone();
    (input.code, input.message, input.help)
}

#[test]
fn gravity_that_is_not_given_is_refused_with_the_key_that_gives_it() {
    for (model, trust) in [
        (SensorModel::ScaleBias, Trust::Known),
        (SensorModel::Full, NOISY),
        (SensorModel::ScaleBias, Trust::Unknown),
    ] {
        let case = Case::new(model, trust, 14, 5.0, 2.0, 7);
        let (code, message, help) = refusal(&with_force(&case, Vector3::new(0.1, 0.0, 9.81), None));
        assert_eq!(code, Refusal::GravityContradicted);
        assert!(
            message.starts_with("the readings contain gravity on axis z, which [motion] does not give"),
            "{message}"
        );
        assert!(help.contains("gravity_mps2 = [0.0, 0.0, 9.80665]"), "{help}");
    }
    let case = Case::new(SensorModel::Full, Trust::Known, 14, 5.0, 2.0, 7);
    let (.., help) = refusal(&with_force(&case, Vector3::new(-9.81, 0.0, 0.0), None));
    assert!(help.contains("gravity_mps2 = [-9.80665, 0.0, 0.0]"), "{help}");
    let (_, message, help) = refusal(&with_force(&case, Vector3::new(6.0, 0.0, -7.76), None));
    assert!(message.contains("gravity of (") && help.contains("gravity_mps2 = ["), "{message} {help}");
    // a datasheet that allows such a bias is believed
    let mut wide = with_force(&case, Vector3::new(0.0, 0.0, 9.81), None);
    wide.sensor.bias_sd_mps2 = Some(Vector3::repeat(2.0));
    assert!(wide.calibrate().is_ok());
}

#[test]
fn gravity_that_the_readings_lack_or_have_elsewhere_is_refused() {
    let case = Case::new(SensorModel::Full, Trust::Known, 14, 5.0, 2.0, 7);
    let (code, message, help) = refusal(&with_force(&case, Vector3::zeros(), Some(upright())));
    assert_eq!(code, Refusal::GravityContradicted);
    assert!(message.starts_with("[motion] gives gravity, which the readings do not contain"), "{message}");
    assert!(help.contains("leave gravity out"), "{help}");
    let (_, message, help) = refusal(&with_force(&case, Vector3::new(9.81, 0.0, 0.0), Some(upright())));
    assert!(message.starts_with("gravity in the readings is on axis x and not where"), "{message}");
    assert!(help.contains("gravity_mps2 = [9.80665, 0.0, 0.0]"), "{help}");
    let (_, message, _) = refusal(&with_force(&case, Vector3::new(0.0, 0.0, -9.81), Some(upright())));
    assert!(message.contains("on axis -z"), "{message}");
    // three times the tilt's deviation is a tilt
    let turned = nalgebra::Rotation3::new(Vector3::new(0.026, 0.0, 0.0)) * upright().force_mps2;
    assert!(with_force(&case, turned, Some(upright())).calibrate().is_ok());
}

#[test]
fn an_axis_that_reads_gravity_alone_leaves_bias_and_scale_undetermined() {
    let mut case = Case::new(SensorModel::ScaleBias, Trust::Known, 14, 5.0, 2.0, 7);
    let nodes = case.command.motion.acceleration_mps2().iter().map(|a| Vector3::new(a.x, a.y, 0.0)).collect();
    case.command.motion = calibrant::motion::JerkControlledMotion::uniform(5.0, nodes).expect("valid");
    let error =
        with_force(&case, upright().force_mps2, Some(upright())).calibrate().expect_err("still").to_string();
    assert!(
        error.contains("bias.z") && error.contains("scale.z") && error.contains("axis z does not move"),
        "{error}"
    );
}

#[test]
fn criteria_see_gravity_as_they_should() {
    let sensor = Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() };
    let limits = Limits::default();
    let motion = initial_motion(10, 1.0, 3, &limits, &mut stream(1, Purpose::Motion, 0)).expect("valid");
    let scale = DVector::repeat(12, 1.0);
    let of = |criterion: Criterion, gravity: Option<MotionGravity>| {
        let problem = DesignProblem {
            sensor: &sensor,
            at: SensorParameters::identity(),
            intervals: 10,
            interval_s: 1.0,
            rate_hz: 10.0,
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity,
            clock: MotionClock::default(),
            limits: &limits,
            criterion,
            prior: None,
        };
        (evaluate(&problem, &motion).expect("determined").value, problem.floor())
    };
    let exact = MotionGravity { tilt_sd_rad: 0.0, ..upright() };
    // a shift of the bias changes no determinant
    let d = || Criterion::D(DOptimality { scale: scale.clone() });
    assert!((of(d(), None).0 - of(d(), Some(exact)).0).abs() < 1e-9);
    assert!(of(d(), Some(upright())).0 > of(d(), Some(exact)).0 + 1.0);
    let a = || Criterion::A(AOptimality { scale: scale.clone() });
    let ((plain, none), (shifted, zero), (tilted, floor)) =
        (of(a(), None), of(a(), Some(exact)), of(a(), Some(upright())));
    assert!(none == 0.0 && zero == 0.0 && shifted > 2.0 * plain);
    assert!(((tilted - floor) / shifted - 1.0).abs() < 1e-5, "{tilted} {floor} {shifted}");
}

#[test]
fn the_keys_of_gravity_are_read_and_their_errors_point_at_the_line() {
    let with = |lines: &str| {
        let text = preset("report")
            .expect("a preset")
            .replace("known_ends = \"start\"", &format!("known_ends = \"start\"\n{lines}\n#"));
        Experiment::parse(&text, None)
    };
    let force = |lines: &str| {
        let experiment = with(lines).expect(lines);
        let calibrant::io::Plan::Motion(plan) = experiment.plan else { panic!("a motion") };
        plan.gravity.expect("given")
    };
    let given = force("gravity_mps2 = [0.0, 0.0, 9.80665]");
    assert_eq!(given, upright());
    let named = force("gravity = \"-x\"\nlatitude_deg = 45.0\nheight_m = 0.0\ntilt_sd_deg = 0.0");
    assert!((named.force_mps2 - Vector3::new(-9.806_197_769, 0.0, 0.0)).amax() < 1e-8);
    assert_eq!((named.sd_mps2, named.tilt_sd_rad), (calibrant::motion::Gravity::ANOMALY_SD_MPS2, 0.0));
    assert_eq!(force("gravity = \"z\"\ngravity_mps2 = 9.80665"), upright());
    assert_eq!(
        force("gravity = \"z\"").sd_mps2,
        calibrant::motion::Gravity::SOMEWHERE.sd_mps2,
        "nobody gave it"
    );
    for (lines, message) in [
        ("gravity_mps2 = 9.80665", "nothing says which axis is up"),
        ("gravity_mps2 = [0.0, 9.8]", "a force has three numbers, this has 2"),
        ("gravity_mps2 = [0.0, 0.0, 981.0]", "981.0 is out of range"),
        ("gravity_mps2 = [0.0, 0.0, 0.0]", "a force of 0 m/s² is out of range"),
        ("gravity_mps2 = [0.0, 0.0, nan]", "a finite number is needed here"),
        ("gravity = \"up\"\ngravity_mps2 = 9.8", "\"up\" is no direction"),
        ("gravity = \"z\"\ngravity_mps2 = [0.0, 0.0, 9.8]", "the direction of gravity is given twice"),
        ("gravity_mps2 = [0.0, 0.0, 9.8]\nlatitude_deg = 45.0", "gravity is given twice"),
        ("tilt_sd_deg = 0.5", "no gravity is given to which this belongs"),
        ("gravity_mps2 = [0.0, 0.0, 9.8]\ntilt_sd_deg = 20.0", "20.0 is out of range"),
        ("gravity_mps2 = [0.0, 0.0, 9.8]\ntilt_sd_deg = -1.0", "-1.0 is out of range"),
        ("gravity_mps3 = [0.0, 0.0, 9.8]", "unknown key"),
    ] {
        let error = with(lines).expect_err(lines).to_string();
        assert!(error.contains(message), "{lines}: {error}");
        assert!(error.contains("line") || error.contains(':'), "{error}");
    }
    let small = preset("report").expect("a preset").replace("axes = 3", "axes = 3\nrange_mps2 = 5.0 #");
    let small = small
        .replace("known_ends = \"start\"", "known_ends = \"start\"\ngravity = \"z\"\ngravity_mps2 = 9.8\n#");
    let error = Experiment::parse(&small, None).expect_err("beyond").to_string();
    assert!(error.contains("gravity alone, 9.80 m/s² on axis z, exceeds sensor.range_mps2 = 5"), "{error}");
}

#[test]
fn a_sensor_of_one_axis_takes_one_number() {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let gravity = MotionGravity::of_force(Vector3::new(9.8, 0.0, 0.0));
    let motion =
        initial_motion(10, 1.0, 1, &Limits::default(), &mut stream(1, Purpose::Motion, 0)).expect("valid");
    let mut rng = stream(4, Purpose::Sensor, 0);
    let truth = draw_sensor(&sensor, &mut rng);
    let at_rest = draw_gravity(&gravity, &mut rng);
    let times = sample_times(&motion, 10.0);
    let sensed = motion.plus(&at_rest.force_mps2).expect("finite");
    let recording: Recording =
        simulate_recording(&truth, &Vector3::repeat(2e-4), sensor.unit, 1, &sensed, &times, &mut rng);
    let of = |gravity| {
        let command = CommandedMotion {
            motion: motion.clone(),
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity,
            clock: MotionClock::default(),
        };
        let problem = CalibrationProblem {
            sensor: &sensor,
            recording: &recording,
            stimulus: Stimulus::Motion(&command),
        };
        calibrate(&problem, &CalibrationSettings::default())
    };
    let calibration = of(Some(gravity)).expect("identifiable");
    let error = calibration.values[0] - truth.bias.x;
    assert!(error.abs() < 4.0 * calibration.sd()[0], "{error} {:?}", calibration.sd());
    // along the axis a tilt acts to second order only
    assert!(calibration.sd()[0] < 2e-3, "{:?}", calibration.sd());
    let refused = of(None).expect_err("gravity").to_string();
    assert!(refused.contains("gravity_mps2 = 9.80665"), "{refused}");
}

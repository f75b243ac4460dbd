//! Tests of good experiment files: their values arrive, and missing keys have their defaults.

use calibrant::design::SurfaceSettings;
use calibrant::estimate::{Gyroscope, ImuSetup};
use calibrant::io::{
    CriterionLetter, DATASHEETS, Datasheet, Experiment, ExperimentFile, HashedFile, HoldsPlan, ImuUnit,
    MotionPlan, NoisyVariant, PRESETS, Plan, Preset, Prior, ScaleBy, experiment_keys, preset,
};
use calibrant::motion::{Gravity, InputNoise, KnownEnds, Limits, MotionClock, Trust};
use calibrant::sensor::{Gauge, ReadingUnit, Sensor, SensorModel};
use nalgebra::Vector3;

fn parse(text: &str) -> Experiment {
    Experiment::parse(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn motion(experiment: &Experiment) -> &MotionPlan {
    match &experiment.plan {
        Plan::Motion(plan) => plan,
        other => panic!("{}", other.section()),
    }
}

fn holds(experiment: &Experiment) -> &HoldsPlan {
    match &experiment.plan {
        Plan::Holds(plan) => plan,
        other => panic!("{}", other.section()),
    }
}

fn gravity(experiment: &Experiment) -> Gravity {
    holds(experiment).gravity().expect("given")
}

#[test]
fn every_preset_is_valid_also_with_its_commented_keys_switched_on_one_by_one() {
    for Preset { name, text, .. } in PRESETS {
        parse(text);
        assert_eq!(preset(name), Some(*text));
        for (at, line) in text.lines().enumerate() {
            let Some(key) = line.strip_prefix("# ").filter(|line| line.contains(" = ")) else { continue };
            let with = |key: &str| {
                let lines = text.lines().enumerate().map(|(i, line)| if i == at { key } else { line });
                Experiment::parse(&lines.collect::<Vec<_>>().join("\n"), None)
            };
            // a height belongs to a latitude, an uncertainty to a value, a noise density to its bandwidth
            let in_company =
                ["height_m", "gravity_sd_mps2", "noise_ug_per", "noise_mdps_per", "noise_bandwidth"];
            let alone = !in_company.iter().any(|of| key.starts_with(of));
            match with(key) {
                Ok(_) => assert!(alone, "{name}: {key}"),
                Err(error) => {
                    assert!(!alone && error.to_string().contains("is missing"), "{name}: {key}: {error}")
                }
            }
        }
    }
}

#[test]
fn the_report_preset_is_the_report() {
    let experiment = parse(preset("report").expect("known"));
    assert_eq!(experiment.sensor, Sensor::memsic_mxd2020u());
    let expected = MotionPlan {
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust: Trust::Known,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
    };
    assert_eq!(*motion(&experiment), expected);
    let bounds = |bound: f64| Limits {
        intercept_mps2: Some(Vector3::repeat(bound)),
        jerk_mps3: Some(Vector3::repeat(bound)),
        ..Limits::default()
    };
    assert_eq!(experiment.limits, bounds(30.0));
    let study = &experiment.study;
    assert_eq!((study.sensors, study.seed, study.motions, study.starts), (30, 1, 10, None));
    let surface =
        SurfaceSettings { jerk_mps3: 0.5, points: 41, start_mps2: 0.0, interval_s: 1.0, rate_hz: 10.0 };
    let base = motion(&experiment);
    assert_eq!(study.surface(base).expect("valid"), Some(surface));
    let unknown = study.unknown(base, 3).expect("valid").expect("there");
    assert_eq!((unknown.sensors, unknown.detail_rate_hz), (50, Some(10.0)));
    let expected = MotionPlan {
        intervals: 14,
        interval_s: 5.0,
        rate_hz: 2.0,
        trust: Trust::Unknown,
        known_ends: KnownEnds::Both,
        gravity: None,
        clock: MotionClock::default(),
    };
    assert_eq!(unknown.plan, expected);
    let noise = InputNoise { floor_mps3: 0.01, ratio: 0.01 };
    let noisy = NoisyVariant { noise, limits: Some(bounds(20.0)) };
    assert_eq!(study.noisy(base, 3).expect("valid"), Some(noisy));
    assert_eq!((experiment.design.criterion, experiment.design.starts), (CriterionLetter::A, 30));
    assert_eq!(experiment.calibrate.prior, Prior::None);

    let unknown = parse(preset("report-unknown").expect("known"));
    assert_eq!((motion(&unknown).trust, motion(&unknown).known_ends), (Trust::Unknown, KnownEnds::Both));
    assert_eq!((motion(&unknown).intervals, unknown.study.sensors), (14, 50));
    let noisy = parse(preset("report-noisy").expect("known"));
    assert_eq!(motion(&noisy).trust.name(), "noisy");
    assert_eq!(noisy.limits.jerk_mps3, Some(Vector3::repeat(20.0)));
}

#[test]
fn static_presets_are_for_si_and_for_counts() {
    let si = parse(preset("static-poses").expect("known"));
    assert_eq!((si.sensor.unit, si.sensor.model), (ReadingUnit::MetrePerSecondSquared, SensorModel::Full));
    let counts = parse(preset("static-poses-counts").expect("known"));
    assert_eq!(
        (counts.sensor.unit, counts.sensor.gain, counts.sensor.offset),
        (ReadingUnit::Counts, None, None)
    );
    // no preset contains a value that nobody gave
    assert_eq!(gravity(&counts), Gravity::SOMEWHERE);
    assert_eq!(holds(&counts).gauge, Gauge::Upper);
}

/// A short experiment file with holds.
const HOLDS: &str =
    "schema = 1\n[sensor]\nkind = 'accelerometer'\naxes = 3\nmodel = 'full'\n[holds]\ngauge = 'lower'\n";

#[test]
fn gravity_comes_from_latitude_and_height() {
    let experiment = parse(&format!("{HOLDS}latitude_deg = 52.2\nheight_m = 30\n"));
    assert_eq!(gravity(&experiment), Gravity::from_latitude(52.2, 30.0));
    let experiment = parse(&format!("{HOLDS}latitude_deg = 52.2\nheight_m = 30\ngravity_sd_mps2 = 1e-3\n"));
    assert_eq!(gravity(&experiment).sd_mps2, 1e-3);
    let experiment = parse(&format!("{HOLDS}latitude_deg = 52.2\n"));
    assert_eq!(gravity(&experiment), Gravity::at_latitude(52.2));
    assert_eq!(gravity(&parse(HOLDS)), Gravity::SOMEWHERE);
}

#[test]
fn a_latitude_beside_the_gravity_of_an_imu_is_for_the_rate_of_the_earth() {
    let imu = preset("imu").expect("known");
    let (commented, gravity) = ("# gravity_mps2 = 9.80665 ", "gravity_mps2 = 9.80665 ");
    let experiment = parse(&imu.replace(commented, &format!("latitude_deg = -33.9\n{gravity}")));
    let plan = holds(&experiment);
    assert_eq!(plan.gravity().expect("given").magnitude_mps2, 9.80665);
    let setup = experiment.imu.as_ref().expect("an IMU").setup(plan).expect("valid");
    assert_eq!(setup.latitude_deg, Some(-33.9));
    // the height is unused there
    let both = imu.replace(commented, &format!("height_m = 30.0\nlatitude_deg = -33.9\n{gravity}"));
    let error = Experiment::parse(&both, None).expect_err("twice").to_string();
    assert!(error.contains("`holds.height_m`: gravity is given twice"), "{error}");
    assert!(error.contains("latitude_deg alone may stand beside it, for the Earth's rate"), "{error}");
}

#[test]
fn what_holds_leaves_out_has_its_default() {
    let experiment = parse(&format!("{HOLDS}gravity_mps2 = 9.81\n"));
    let plan = holds(&experiment);
    assert_eq!((plan.poses, plan.hold_s, plan.rate_hz, plan.minimum_hold_s), (24, 5.0, 100.0, 1.0));
    assert_eq!((gravity(&experiment).sd_mps2, &plan.intervals_s), (0.0, &None));
    let experiment = parse(&format!("{HOLDS}gravity_mps2 = 9.81\nintervals_s = [[-1, 2.5], [2.5, 7]]\n"));
    assert_eq!(holds(&experiment).intervals_s, Some(vec![(-1.0, 2.5), (2.5, 7.0)]));
}

/// A short experiment file with a motion.
const MOTION: &str = "schema = 1\nsensor = { kind = 'accelerometer', axes = 3, model = 'full', noise_mps2 = [1e-4, 2, 3], \
                      bias_sd_mps2 = 0.1, scale_sd = [0.1, 0.2, 0.3], cross_axis_sd = 0.01 }\n\
                      [motion]\nintervals = 0x0A\ninterval_s = 5\nrate_hz = 2\n";

#[test]
fn numbers_may_be_given_per_axis() {
    let experiment = parse(&format!("{MOTION}trust = 'known'\n[limits]\njerk_mps3 = [1, 2, 3]\n"));
    assert_eq!(experiment.sensor.noise_mps2, Some(Vector3::new(1e-4, 2.0, 3.0)));
    assert_eq!(experiment.sensor.scale_sd, Some(Vector3::new(0.1, 0.2, 0.3)));
    assert_eq!(experiment.limits.jerk_mps3, Some(Vector3::new(1.0, 2.0, 3.0)));
    assert_eq!(motion(&experiment).intervals, 10);
}

#[test]
fn an_unknown_motion_has_both_ends_known_without_saying_so() {
    let experiment = parse(&format!("{MOTION}trust = 'unknown'\n"));
    assert_eq!(motion(&experiment).known_ends, KnownEnds::Both);
    assert_eq!(motion(&parse(&format!("{MOTION}trust = 'known'\n"))).known_ends, KnownEnds::Start);
}

#[test]
fn design_and_prior_arrive() {
    let text = format!(
        "{MOTION}trust = 'known'\n[design]\ncriterion = 'c'\nweights = {{ 'matrix.xy' = 2, 'bias.z' = 0.5 }}\n\
         range_mps2 = 20\nscale_by = 'datasheet'\nstarts = 3\nseed = 9\ncertificate = false\n\
         [calibrate]\nprior = 'datasheet'\n"
    );
    let experiment = parse(&text);
    let design = &experiment.design;
    assert_eq!((design.criterion, design.criterion.name()), (CriterionLetter::C, "c"));
    let weights = [("bias.z".to_owned(), 0.5.into()), ("matrix.xy".to_owned(), 2.0.into())];
    assert_eq!(design.weights, weights.into());
    assert_eq!((design.scale_by, design.range_mps2), (ScaleBy::Datasheet, Some(20.0.into())));
    assert_eq!((design.starts, design.seed, design.certificate), (3, 9, false));
    assert_eq!(experiment.calibrate.prior, Prior::Datasheet);
}

#[test]
fn counts_have_gain_offset_and_noise() {
    let text = MOTION.replace(
        "noise_mps2 = [1e-4, 2, 3]",
        "unit = 'counts', gain_counts_per_mps2 = 415, offset_counts = -3, noise_counts = 10",
    );
    let sensor = parse(&format!("{text}trust = 'known'\n")).sensor;
    assert_eq!((sensor.gain, sensor.offset), (Some(Vector3::repeat(415.0)), Some(Vector3::repeat(-3.0))));
    assert_eq!((sensor.noise_counts, sensor.noise_mps2), (Some(Vector3::repeat(10.0)), None));
}

#[test]
fn files_are_read_with_byte_order_mark_and_refused_when_no_text() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("experiment.toml");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("written");
        Experiment::read(&path)
    };
    let text = preset("report").expect("known").replace('\n', "\r\n");
    assert!(read(&[b"\xef\xbb\xbf", text.as_bytes()].concat()).is_ok());
    let message = |bytes: &[u8]| {
        let error = read(bytes).expect_err("refused");
        assert!(error.is_invalid_experiment());
        error.to_string().replace(&path.display().to_string(), "FILE")
    };
    assert_eq!(
        message(b"schema = 1\n\xff"),
        "FILE:2: not UTF-8 text: byte 0xff at offset 11 (save it as UTF-8 (or plain ASCII))"
    );
    assert_eq!(
        message(b"a\0b"),
        "FILE: this is binary data, not text: NUL byte at offset 1 (export the data as text)"
    );
    assert_eq!(
        message(&[b'#'; 1_100_000]),
        "FILE: the experiment file is larger than 1 MiB (this is hardly the file that you mean)"
    );
    assert_eq!(
        message(text.replace("axes = 3", "axes = 5").as_bytes()),
        "FILE:8:8: `sensor.axes`: 5 axes are not supported (axes = 3, or axes = 1 for a sensor of one axis)"
    );
    std::fs::remove_file(&path).expect("removed");
    let error = Experiment::read(&path).expect_err("absent").to_string();
    assert!(
        error.contains("cannot read the experiment file: ") && error.contains("check the name"),
        "{error}"
    );
    let error = Experiment::read(directory.path()).expect_err("a directory").to_string();
    assert!(error.contains("this is a directory, not the experiment file"), "{error}");
}

#[test]
fn an_experiment_that_was_changed_in_code_has_another_origin() {
    let read = parse(preset("imu").expect("known"));
    assert_eq!(read.origin(), read.source);
    let mut changed = read.clone();
    changed.sensor.axes = 1;
    assert_ne!(changed.origin().sha256, read.origin().sha256);
}

#[test]
fn an_experiment_has_the_hash_of_its_text_and_of_its_file() {
    let text = preset("imu").expect("known");
    assert_eq!(parse(text).source, HashedFile::of_bytes("experiment", text.as_bytes()));
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("imu.toml");
    std::fs::write(&path, [b"\xef\xbb\xbf", text.as_bytes()].concat()).expect("written");
    let read = Experiment::read(&path).expect("valid");
    assert_eq!((read.source.file.as_str(), Some(&read.source)), ("imu.toml", HashedFile::of(&path).as_ref()));
}

#[test]
fn a_variant_takes_what_it_does_not_say_from_the_motion() {
    let text = preset("report").expect("known");
    let head = &text[..=text.find("\n[study]").expect("there")];
    let experiment = parse(&format!(
        "{head}[study]\nsensors = 4\n[study.surface]\n[study.unknown]\n[study.noisy]\ninput_noise = {{ floor_mps3 = 0.1, ratio = 0.0 }}\n"
    ));
    let (plan, study) = (motion(&experiment), &experiment.study);
    let surface = study.surface(plan).expect("valid").expect("there");
    assert_eq!((surface.points, surface.interval_s, surface.rate_hz), (41, plan.interval_s, plan.rate_hz));
    let unknown = study.unknown(plan, 3).expect("valid").expect("there");
    assert_eq!((unknown.sensors, unknown.plan.intervals, &unknown.limits), (4, plan.intervals, &None));
    assert_eq!(study.noisy(plan, 3).expect("valid").map(|noisy| noisy.limits.is_none()), Some(true));
    let none = parse(&format!("{head}[study]\nstarts = 3\n")).study;
    assert_eq!((none.starts, none.surface, none.unknown, none.noisy), (Some(3.into()), None, None, None));
}

#[test]
fn a_preset_that_is_written_again_is_the_same_experiment() {
    for Preset { name, text, .. } in PRESETS {
        let file = ExperimentFile::preset(name).expect("known");
        let again = file.to_toml();
        assert_eq!(ExperimentFile::parse(&again, None).expect(name), file, "{again}");
        let mut built = file.experiment().expect(name);
        built.source = parse(text).source;
        assert_eq!(built, parse(text));
    }
}

#[test]
fn the_datasheets_fit_every_preset() {
    for (sensor, Preset { name, text, .. }) in
        DATASHEETS.iter().flat_map(|of| PRESETS.iter().map(move |preset| (of, preset)))
    {
        let text = sensor.in_experiment(text);
        let experiment = parse(&text);
        let noise = experiment.sensor.noise_mps2.expect("by its density");
        assert!(
            (noise.x / (sensor.noise_ug_per_rthz * 9.80665e-6 * 50_f64.sqrt()) - 1.0).abs() < 1e-12,
            "{name}"
        );
        assert!(experiment.sensor.range_mps2.is_some());
        let is_of_counts = sensor.ranges_g[0].1 > 0.0;
        // a preset that names the unit of its file has no place for another
        if !is_of_counts || text.contains("\naccelerometer_unit") {
            continue;
        }
        let with_counts = text.replace("# accelerometer_lsb_per_g", "accelerometer_lsb_per_g");
        let unit = parse(&with_counts).columns.accelerometer_unit;
        let sensitivity = unit.and_then(ImuUnit::sensitivity).expect("of the datasheet");
        let per_g = sensitivity.counts_per_unit() * 9.80665;
        assert!((per_g / sensor.ranges_g[0].1 - 1.0).abs() < 1e-5, "{name} {}: {per_g}", sensor.name);
    }
    assert_eq!(Datasheet::of("ICM42688").map(|of| of.name), Some("ICM-42688-P"));
    assert_eq!(Datasheet::of("mpu"), None, "two of them begin so");
}

#[test]
fn every_key_is_in_a_preset() {
    // noise of poses goes together, and logged times are rare
    let elsewhere = ["position_noise_m", "orientation_noise_rad", "times"];
    let texts: String = PRESETS.iter().map(|preset| preset.text).collect();
    let sections = experiment_keys();
    let names: Vec<&str> = sections.iter().map(|(name, _)| name.as_str()).collect();
    assert!(names.contains(&"machine.mount") && names.contains(&"study.noisy.input_noise"), "{names:?}");
    assert_eq!((names[0], sections[0].1[0]), ("", "schema"));
    for (section, keys) in &sections {
        for key in keys.iter().filter(|key| !elsewhere.contains(key)) {
            let as_section =
                if section.is_empty() { format!("[{key}]") } else { format!("[{section}.{key}]") };
            let quoted = if key.contains('.') { format!("\"{key}\" =") } else { format!("{key} =") };
            assert!(
                texts.contains(&quoted) || texts.contains(&as_section),
                "`{section}.{key}` is in no preset"
            );
        }
    }
}

#[test]
fn the_default_problem_of_the_library_is_that_of_the_preset() {
    let experiment = parse(preset("imu").expect("known"));
    let (plan, imu) = (holds(&experiment), experiment.imu.as_ref().expect("an IMU"));
    assert_eq!(experiment.sensor, Sensor::triaxial(SensorModel::Full));
    assert_eq!(imu.gyroscope, Gyroscope::default());
    assert_eq!(imu.setup(plan).expect("valid"), ImuSetup::default());
}

#[test]
fn the_axis_of_a_turn_may_be_known_better_or_worse_than_its_angle() {
    let imu = preset("imu").expect("known").replace("# turns = ", "turns = ");
    let sd = |text: &str| {
        let turn = parse(text).imu.expect("an IMU").turns[0].clone();
        [Some(turn.angle_sd_rad), turn.axis_sd_rad]
            .map(|sd| sd.map(|sd| (sd.to_degrees() * 1e6).round() / 1e6))
    };
    assert_eq!(sd(&imu.replace("axis_sd_deg = 0.5", "axis_sd_deg = 0.02")), [Some(0.5), Some(0.02)]);
    assert_eq!(sd(&imu.replace(", axis_sd_deg = 0.5", "")), [Some(0.5), None], "that of the angle");
}

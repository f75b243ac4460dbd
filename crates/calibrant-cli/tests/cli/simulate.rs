//! Tests of several recordings of one simulated sensor.

use crate::bench::Bench;

/// An experiment of each kind, and the files beside truth and recording that differ between recordings.
fn experiments(bench: &Bench) -> Vec<(&'static str, &'static [&'static str])> {
    bench.preset("report", "known.toml", &[]);
    bench.preset("report-unknown", "unknown.toml", &[]);
    bench.preset("report-noisy", "noisy.toml", &[]);
    bench.preset("static-poses", "poses.toml", &[]);
    bench.preset("imu", "hand.toml", &[]);
    bench.preset("arm", "joints.toml", &[]);
    bench.preset("mocap", "body.toml", &[]);
    let orders = [
        ("# accelerometer_bias = 1", "accelerometer_bias = 1"),
        ("# gyroscope_scale = 1", "gyroscope_scale = 1"),
    ];
    bench.preset("imu", "warm.toml", &orders);
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.write(
        "known-bias.toml",
        format!("{table}\n[known]\n\"gyroscope.bias.z\" = {{ value = 0.01, sd = 0.002 }}\n"),
    );
    vec![
        ("known.toml", &["motion.csv"]),
        ("unknown.toml", &["motion.csv"]),
        ("noisy.toml", &["motion.csv", "true_motion.csv"]),
        ("poses.toml", &[]),
        ("hand.toml", &[]),
        ("joints.toml", &["joints.csv"]),
        ("body.toml", &["poses.csv"]),
        ("warm.toml", &[]),
        ("table.toml", &[]),
        ("known-bias.toml", &[]),
    ]
}

#[test]
fn recordings_of_one_seed_are_of_one_sensor() {
    let bench = Bench::new();
    for (experiment, others) in experiments(&bench) {
        let simulate = format!("simulate {experiment} --seed 5");
        bench.run(&format!("{simulate} -o default")).done();
        for number in 1..=3 {
            bench.run(&format!("{simulate} --recording {number} -o {number}")).done();
            assert_eq!(bench.read("default/truth.json"), bench.read(&format!("{number}/truth.json")));
        }
        for file in others.iter().chain(&["recording.csv"]) {
            assert_eq!(bench.read(&format!("default/{file}")), bench.read(&format!("1/{file}")));
            for (one, two) in [(1, 2), (1, 3), (2, 3)] {
                let [one, two] = [one, two].map(|number| bench.read(&format!("{number}/{file}")));
                // a shuttle is the same for all
                let may_agree = (experiment, *file) == ("noisy.toml", "motion.csv");
                assert!((one != two || may_agree) && one.len() > 100, "{experiment} {file}");
            }
        }
    }
    let outcome = bench.run("simulate poses.toml --recording 2 -o said").done();
    assert!(outcome.stdout.contains("seed 1, recording 2: said/recording.csv"), "{outcome:?}");
}

/// A given motion does not change.
#[test]
fn a_given_motion_is_recorded_again() {
    let bench = Bench::new();
    bench.preset("report-noisy", "noisy.toml", &[]);
    bench.run("simulate noisy.toml -o one").done();
    bench.run("simulate noisy.toml --recording 2 --motion one/motion.csv -o two").done();
    assert_eq!(bench.read("one/motion.csv"), bench.read("two/motion.csv"));
    for differs in ["true_motion.csv", "recording.csv"] {
        assert_ne!(bench.read(&format!("one/{differs}")), bench.read(&format!("two/{differs}")));
    }
}

/// The readings of a hold about their mean: all axes of all sensors, hold by hold, `hold` samples in each
/// `period`.
fn noise(bench: &Bench, file: &str, holds: usize, period: usize, hold: usize) -> Vec<f64> {
    let text = bench.read(file);
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|row| row.split(',').skip(1).map(|number| number.parse().expect("a number")).collect())
        .collect();
    let mut noise = Vec::new();
    for rows in (0..holds).map(|j| &rows[j * period..j * period + hold]) {
        for axis in 0..rows[0].len() {
            let mean = rows.iter().map(|row| row[axis]).sum::<f64>() / rows.len() as f64;
            // sensors differ in their noise
            let sd =
                (rows.iter().map(|row| (row[axis] - mean).powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
            noise.extend(rows.iter().map(|row| (row[axis] - mean) / sd));
        }
    }
    noise
}

#[test]
fn recordings_of_one_seed_have_independent_noise() {
    let bench = Bench::new();
    let more = [("poses = 24 ", "poses = 48 ")];
    bench.preset("static-poses", "poses.toml", &[]);
    bench.preset("static-poses", "more.toml", &more);
    bench.preset("imu", "hand.toml", &[]);
    // samples in a hold and from one to the next, as simulated
    for (one, other) in [("poses", "more"), ("hand", "hand")] {
        for seed in 1..=3 {
            bench.run(&format!("simulate {one}.toml --seed {seed} -o one")).done();
            bench.run(&format!("simulate {other}.toml --seed {seed} --recording 2 -o two")).done();
            bench.run(&format!("simulate {other}.toml --seed {seed} --recording 3 -o three")).done();
            let [one, two, three] = ["one", "two", "three"]
                .map(|name| noise(&bench, &format!("{name}/recording.csv"), 24, 700, 500));
            let n = one.len() as f64;
            for (a, b) in [(&one, &two), (&one, &three), (&two, &three)] {
                assert_eq!(a.len(), b.len());
                // the first recording has drawn the sensor before its noise
                for shift in 0..40 {
                    for (a, b) in [(a, b), (b, a)] {
                        let product = a[shift..].iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / n;
                        // 480 correlations of each kind: 5 standard deviations
                        assert!(product.abs() < 5.0 / n.sqrt(), "{seed}, {shift}: {product}");
                    }
                }
            }
        }
    }
}

/// Two commands and a third one.
#[test]
fn a_validation_is_rehearsed_with_the_second_recording_of_the_sensor() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.preset("imu", "hand.toml", &[]);
    bench.write("table.toml", include_str!("../../../../examples/06_whole_imu/table.toml"));
    for (experiment, kinds) in [
        ("poses", &["magnitude"][..]),
        ("hand", &["magnitude", "rate", "rotation"]),
        ("table", &["magnitude", "rate", "rotation"]),
    ] {
        for seed in 1..=4 {
            bench.run(&format!("simulate {experiment}.toml --seed {seed} -o one")).done();
            bench.run(&format!("simulate {experiment}.toml --seed {seed} --recording 2 -o two")).done();
            let calibrate =
                format!("calibrate {experiment}.toml one/recording.csv --validate two/recording.csv");
            bench.run(&format!("{calibrate} -o result")).done();
            let json = bench.json("result/calibration.json");
            for kind in kinds {
                let errors = &json["validation"]["recording"][kind];
                let verdict = errors["verdict"].as_str().expect("a verdict");
                // three turns and six faces are few: not every seed is conclusive, and 1 of 200 finds a
                // covariance larger than needed
                let honest =
                    if experiment == "table" { verdict != "too_small" } else { verdict == "believed" };
                assert!(honest, "{experiment}, seed {seed}, {kind}: {errors}");
            }
        }
    }
}

/// The mean of the first samples, which belong to a hold, in each column.
fn means(bench: &Bench, file: &str) -> Vec<(String, f64)> {
    let text = bench.read(file);
    let header = text.lines().next().expect("a header").split(',');
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(101)
        .take(350)
        .map(|row| row.split(',').map(|number| number.parse().expect("a number")).collect())
        .collect();
    let mean = |column: usize| rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64;
    header.enumerate().map(|(column, name)| (name.to_owned(), mean(column))).collect()
}

#[test]
fn a_result_is_compared_with_the_truth_which_is_a_calibration_as_any_other() {
    let bench = Bench::new();
    experiments(&bench);
    let symmetric = |preset: &str, file: &str, gauge: &str| {
        bench.preset(preset, file, &[(&format!("gauge = \"{gauge}\""), "gauge = \"symmetric\"")]);
    };
    symmetric("static-poses", "symmetric-poses.toml", "upper");
    symmetric("imu", "symmetric-hand.toml", "lower");
    let table = bench.read("table.toml");
    bench.write("fixed.toml", format!("{table}\n[known]\n\"gyroscope.bias.z\" = {{ value = 0.01 }}\n"));
    for experiment in
        ["poses", "symmetric-poses", "hand", "symmetric-hand", "warm", "table", "known-bias", "fixed"]
    {
        bench.run(&format!("simulate {experiment}.toml --seed 7 -o one")).done();
        bench.run(&format!("calibrate {experiment}.toml one/recording.csv -o result")).done();
        let compare = |a: &str, b: &str| bench.run(&format!("compare {a} {b} --json")).done().json();
        let found = compare("one/truth.json", "result/calibration.json");
        let p_value = found["overall"]["p_value"].as_f64().expect("a number");
        assert!(p_value > 1e-3, "{experiment}: {found}");
        let (truth, result) = (bench.json("one/truth.json"), bench.json("result/calibration.json"));
        let mut biases = 0;
        for row in found["quantities"].as_array().expect("a table") {
            // biases are the same in any frame; a single accelerometer's names have no sensor
            let name = row["name"].as_str().expect("a name");
            let of = |file: &serde_json::Value| {
                let list = file["parameters"].as_array().expect("a list").clone();
                let is_it = |listed: &str| name == listed || name == format!("accelerometer.{listed}");
                list.into_iter().find(|parameter| is_it(parameter["name"].as_str().expect("a name")))
            };
            if let (true, Some(truth), Some(found)) = (name.contains(".bias."), of(&truth), of(&result)) {
                let number = |value: &serde_json::Value| value.as_f64().expect("a number");
                let difference = number(&found["value"]) - number(&truth["value"]);
                let in_sd = difference / number(&found["sd"]);
                assert!((number(&row["difference"]) - difference).abs() < 1e-12, "{experiment}: {row}");
                assert!((number(&row["difference_in_sd"]) - in_sd).abs() < 1e-6, "{experiment}: {row}");
                biases += 1;
            }
        }
        let expected = [("poses", 3), ("symmetric-poses", 3), ("fixed", 5)];
        let expected = expected.iter().find(|(of, _)| *of == experiment).map_or(6, |(_, biases)| *biases);
        assert_eq!(biases, expected, "{experiment}: {found}");
        // another format keeps all of it, and it corrects the recording
        bench.run("convert one/truth.json other.json").done();
        let same = compare("one/truth.json", "other.json");
        for row in same["quantities"].as_array().expect("a table") {
            assert_eq!(row["difference"].as_f64(), Some(0.0), "{experiment}: {row}");
        }
        bench.run("apply one/truth.json one/recording.csv -o corrected.csv").done();
        let means = means(&bench, "corrected.csv");
        let of = |name: &str| means.iter().find(|(column, _)| column == name).map(|(_, mean)| *mean);
        let force = ["ax_mps2", "ay_mps2", "az_mps2"].map(|name| of(name).expect("a column"));
        let gravity = result["holds"]["gravity_mps2"].as_f64().expect("a number");
        // noise of 0.01 m/s² and 2e-3 rad/s, 350 samples: five standard deviations of a mean
        let magnitude = force.iter().map(|f| f * f).sum::<f64>().sqrt();
        assert!((magnitude - gravity).abs() < 5.0 * 0.01 / 350.0_f64.sqrt(), "{experiment}: {force:?}");
        for rate in ["gx_radps", "gy_radps", "gz_radps"].into_iter().filter_map(of) {
            assert!(rate.abs() < 5.0 * 2e-3 / 350.0_f64.sqrt(), "{experiment}: {rate}");
        }
    }
    let outcome = bench.run("compare one/truth.json result/calibration.json").done();
    outcome.says("one/truth.json: the truth of a simulation, seed 7: its values are exact");
    outcome.says("A has no covariance: its values count as exact");
    // broken truth files
    bench.preset("report", "line.toml", &[("axes = 3", "axes = 1")]);
    bench.run("simulate line.toml -o line").done();
    bench.refuses(
        "compare line/truth.json one/truth.json",
        2,
        &["fewer than three scale factors of the accel"],
    );
    bench.run("simulate known.toml -o known").done();
    bench.refuses(
        "design known.toml --from known/truth.json -o next",
        2,
        &["known/truth.json: this is the truth of a simulation, not a calibration: it has no covariance"],
    );
    let says =
        ["this is the truth of a simulation", "give a calibration.json that `calibrant calibrate` wrote"];
    bench.refuses("records add r.db known/truth.json", 2, &says);
    bench.write("part.json", bench.read("one/truth.json").replace("parameters", "parametres"));
    bench.refuses("compare part.json one/truth.json", 2, &["the field `parameters` is missing"]);
    bench.write("part.json", bench.read("one/truth.json").replace("scale.x\"", "scale.u\""));
    bench.refuses("compare part.json one/truth.json", 2, &["\"accelerometer.scale.u\" is no parameter"]);
}

#[test]
fn numbers_in_the_other_direction_are_refused() {
    let bench = Bench::new();
    for preset in ["imu", "static-poses"] {
        bench.preset(preset, "experiment.toml", &[]);
        bench.run("simulate experiment.toml -o one").done();
        bench.run("calibrate experiment.toml one/recording.csv --no-report -o result").done();
        for file in ["one/truth.json", "result/calibration.json"] {
            let text = bench.read(file);
            assert!(text.contains("\"true to raw: y"), "{text}");
            bench.write("turned.json", text.replace("true to raw: y", "raw to true: y"));
            for command in [
                "compare one/truth.json turned.json",
                "convert turned.json o.h",
                "apply turned.json one/recording.csv -o o.csv",
            ] {
                bench.refuses(
                    command,
                    2,
                    &["turned.json: `", "must be true to raw in this format, not \"raw to true: y"],
                );
            }
        }
    }
}

//! Several recordings of one simulated sensor.

use crate::bench::Bench;

/// An experiment of each kind, and the files beside truth and recording that differ between recordings.
fn experiments(bench: &Bench) -> Vec<(&'static str, &'static [&'static str])> {
    bench.preset("report", "known.toml", &[]);
    bench.preset("report-unknown", "unknown.toml", &[]);
    bench.preset("report-noisy", "noisy.toml", &[]);
    bench.preset("static-poses", "poses.toml", &[]);
    bench.preset("imu", "hand.toml", &[]);
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
                assert!(one != two && one.len() > 100, "{experiment} {file}");
            }
        }
    }
    let outcome = bench.run("simulate poses.toml --recording 2 -o said").done();
    assert!(outcome.stdout.contains("seed 1, recording 2: said/recording.csv"), "{outcome:?}");
}

/// What is commanded stays as it is where it is given.
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

/// The readings of a hold about their mean, all axes of all sensors, hold by hold, one of `hold` samples in each `period`.
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

/// Two commands and a third.
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
                // three turns and six faces are few: not every seed can tell, and 1 of 200 says larger than needed
                let honest =
                    if experiment == "table" { verdict != "too_small" } else { verdict == "believed" };
                assert!(honest, "{experiment}, seed {seed}, {kind}: {errors}");
            }
        }
    }
}

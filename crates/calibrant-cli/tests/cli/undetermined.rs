//! Tests of undetermined parameters: the program names them, exits with status 4, and writes nothing.

use crate::bench::Bench;

/// A motion that leaves one axis at rest: the column of a `motion.csv` has this value throughout.
fn with_column(motion: &str, column: usize, value: impl Fn(usize) -> Option<&'static str>) -> String {
    let rows = motion.lines().enumerate().map(|(row, line)| {
        let mut fields: Vec<&str> = line.split(',').collect();
        if let Some(value) = value(row) {
            fields[column] = value;
        }
        fields.join(",") + "\n"
    });
    rows.collect()
}

#[test]
fn an_axis_that_does_not_move() {
    let bench = Bench::new();
    bench.preset("report", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    let motion = bench.read("simulated/motion.csv");
    bench.write("still.csv", with_column(&motion, 2, |row| (row > 0).then_some("2.0")));
    bench.run("simulate experiment.toml --motion still.csv -o still").done();
    bench.refuses(
        "calibrate experiment.toml still/recording.csv --motion still/motion.csv -o result",
        4,
        &[
            "still/recording.csv: the data cannot determine the parameters",
            "accelerometer.bias.y and accelerometer.scale.y cannot be separated: axis y does not move, its acceleration is 2 m/s² throughout",
            "move the sensor along axis y",
        ],
    );
}

#[test]
fn equal_ends_of_an_unknown_motion() {
    let bench = Bench::new();
    bench.preset("report-unknown", "experiment.toml", &[]);
    bench.run("simulate experiment.toml -o simulated").done();
    let motion = bench.read("simulated/motion.csv");
    let last = motion.lines().count() - 1;
    let ends = |row: usize| (row == 1 || row == last).then_some("1.5");
    bench.write("ends.csv", with_column(&motion, 3, ends));
    bench.refuses(
        "calibrate experiment.toml simulated/recording.csv --motion ends.csv -o result",
        4,
        &[
            "accelerometer.bias.z and accelerometer.scale.z cannot be separated",
            "axis z has the same acceleration, 1.5 m/s², at both ends",
        ],
    );
}

#[test]
fn a_full_matrix_from_an_unknown_motion() {
    let bench = Bench::new();
    bench.preset("report-unknown", "experiment.toml", &[]);
    bench.preset("report-unknown", "full.toml", &[("\"scale-bias\"", "\"full\"")]);
    bench.run("simulate experiment.toml -o simulated").done();
    bench.refuses(
        "calibrate full.toml simulated/recording.csv --motion simulated/motion.csv -o result",
        4,
        &[
            "2 combinations of accelerometer.bias.x, accelerometer.scale.x, accelerometer.matrix.xy, accelerometer.matrix.xz left free",
            "2 combinations of accelerometer.bias.z, accelerometer.scale.z, accelerometer.matrix.zx, accelerometer.matrix.zy left free",
            "use model = \"scale-bias\"",
        ],
    );
}

#[test]
fn too_few_holds() {
    for (poses, says) in [("8", "8 holds give 8 equations"), ("1", "only one hold was found")] {
        let bench = Bench::new();
        bench.preset("static-poses", "experiment.toml", &[("poses = 24", &format!("poses = {poses}"))]);
        bench.run("simulate experiment.toml -o simulated").done();
        bench.refuses(
            "calibrate experiment.toml simulated/recording.csv -o result",
            4,
            &[
                "combination",
                "of accelerometer.bias.x, accelerometer.bias.y, accelerometer.bias.z, accelerometer.scale.x",
                "accelerometer.matrix.yz left free",
                says,
                "at least 14",
            ],
        );
    }
}

/// What the refusal of one hold says: with its direction and the gains of the datasheet, one pose gives the bias.
#[test]
fn one_pose_gives_the_bias() {
    let bench = Bench::new();
    let known = "intervals_s = [[0.5, 4.5]]\ndirections = [\"z\"]\n[calibrate]\nprior = \"datasheet\"\n";
    let (before, _) =
        calibrant::io::preset("static-poses").expect("built in").split_once("[design]").expect("a section");
    bench.write("static.toml", before);
    bench.write("known.toml", format!("{before}{known}"));
    bench.write("up.csv", "up_x,up_y,up_z\n0,0,1\n");
    bench.run("simulate static.toml --poses up.csv -o one").done();
    bench.refuses(
        "calibrate static.toml one/recording.csv -o result",
        4,
        &["only one hold was found", "holds.intervals_s with holds.directions, and prior = \"datasheet\""],
    );
    let outcome = bench.run("calibrate known.toml one/recording.csv -o known").done();
    assert!(
        outcome.printed().contains("with the gains of the datasheet gravity gives the bias"),
        "{}",
        outcome.stdout
    );
    let (found, truth) = (bench.json("known/calibration.json"), bench.json("one/truth.json"));
    for k in 0..3 {
        let of = |key: &str| found["parameters"][k][key].as_f64().expect("a number");
        let off = of("value") - truth["parameters"][k]["value"].as_f64().expect("a number");
        assert!(off.abs() < 3.0 * of("sd") && of("sd") < 0.1, "{k}: {off} ± {}", of("sd"));
    }
}

#[test]
fn no_hold_at_all() {
    let bench = Bench::new();
    bench.preset("static-poses", "experiment.toml", &[("minimum_hold_s = 1.0", "minimum_hold_s = 10.0")]);
    bench.run("simulate experiment.toml -o simulated").done();
    bench.refuses(
        "calibrate experiment.toml simulated/recording.csv -o result",
        4,
        &["no hold was found in the recording: the sensor was never still for long enough"],
    );
}

/// A bias of 10 g: the readings lie on a small sphere far from zero, and hardly tell bias from scale factor.
#[test]
fn a_bias_of_many_g_is_named() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o one").done();
    let text = bench.read("one/recording.csv");
    let biased = text.lines().filter(|line| !line.starts_with('#')).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        match cells[1].parse::<f64>() {
            Ok(x) => format!("{},{},{},{}\n", cells[0], x + 98.0, cells[2], cells[3]),
            Err(_) => format!("{line}\n"),
        }
    });
    bench.write("biased.csv", biased.collect::<String>());
    bench.refuses("calibrate poses.toml biased.csv -o result", 4, &["a bias of many g"]);
}

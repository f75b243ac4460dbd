//! Tests of `calibrate --residuals`: the table has every residual of every kind of calibration, and agrees with calibration.json.

use crate::bench::Bench;
use serde_json::Value;

/// The header of every table.
const HEADER: &str = "kind,sensor,axis,t_s,unit,residual,sd,whitened,weight";

/// A row: its texts `kind sensor axis unit`, and time, residual, standard deviation, whitened residual, weight.
struct Row {
    of: String,
    numbers: [f64; 5],
}

/// The rows of a table. A field that is empty is not a number.
fn rows(bench: &Bench, file: &str) -> Vec<Row> {
    let text = bench.read(file);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEADER), "{file}");
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields.len(), 9, "{line}");
        let number = |k: usize| match fields[k] {
            "" => f64::NAN,
            field => field.parse().unwrap_or_else(|error| panic!("{line}: {error}")),
        };
        Row { of: [0, 1, 2, 4].map(|k| fields[k]).join(" "), numbers: [3, 5, 6, 7, 8].map(number) }
    };
    lines.map(row).collect()
}

/// A column of the rows with these texts.
fn column(rows: &[Row], of: &str, k: usize) -> Vec<f64> {
    let found: Vec<f64> = rows.iter().filter(|row| row.of == of).map(|row| row.numbers[k]).collect();
    assert!(!found.is_empty(), "no rows of {of:?}");
    found
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Is one number the other, but for rounding?
fn assert_same(what: &str, found: f64, stated: &Value) {
    let stated = stated.as_f64().unwrap_or_else(|| panic!("{what}: {stated}"));
    assert!((found / stated - 1.0).abs() < 1e-9, "{what}: {found} {stated}");
}

#[test]
fn of_a_motion_each_sample_and_axis_has_a_row() {
    let bench = Bench::new();
    bench.preset("report", "report.toml", &[]);
    bench.run("simulate report.toml -o made").done();
    let command = "calibrate report.toml --motion made/motion.csv made/recording.csv -o out";
    let outcome = bench.run(&format!("{command} --residuals out/residuals.csv")).done();
    assert!(outcome.stdout.ends_with("\nout/report.html\nout/residuals.csv\n"), "{outcome:?}");
    let (rows, calibration) = (rows(&bench, "out/residuals.csv"), bench.json("out/calibration.json"));
    let samples = calibration["inputs"][0]["samples"].as_u64().expect("a number") as usize;
    assert_eq!(rows.len(), 3 * samples);
    let fit = &calibration["fit"];
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let of = format!("sample accelerometer {axis} m/s²");
        assert_same(axis, rms(&column(&rows, &of, 1)), &fit["residual_rms_mps2"][k]);
        let noise = fit["assumed_noise_mps2"][k].as_f64().expect("a number");
        let whitened = rms(&column(&rows, &of, 3));
        assert_same(axis, whitened * noise, &fit["residual_rms_mps2"][k]);
        assert!(column(&rows, &of, 4).iter().all(|weight| *weight == 1.0));
        assert!(column(&rows, &of, 0).is_sorted());
    }

    // the folder knows it as its own: it is written again, unless somebody has edited it
    let written = bench.read("out/residuals.csv");
    bench.run(&format!("{command} --residuals out/residuals.csv")).done();
    assert_eq!(bench.read("out/residuals.csv"), written);
    bench.write("out/residuals.csv", format!("{written}sample,accelerometer,x,0,m/s²,0,1,0,1\n"));
    let edited = bench.read("out/residuals.csv");
    bench.refuses(
        &format!("{command} --residuals out/residuals.csv"),
        2,
        &["out/residuals.csv: this file is there already", "--force"],
    );
    assert_eq!(bench.read("out/residuals.csv"), edited);
    bench.run(&format!("{command} --residuals out/residuals.csv --force")).done();
    assert_eq!(bench.read("out/residuals.csv"), written);
}

#[test]
fn of_holds_each_hold_has_a_row() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o made").done();
    bench.run("calibrate poses.toml made/recording.csv -o out --residuals holds.csv").done();
    let (rows, calibration) = (rows(&bench, "holds.csv"), bench.json("out/calibration.json"));
    of_table(&rows, &calibration["holds"]["table"]);
    let stated = calibration["holds"]["table"].as_array().expect("a table").iter();
    for (whitened, hold) in column(&rows, "hold accelerometer  m/s²", 3).iter().zip(stated) {
        let studentised = hold["studentised_residual"].as_f64().expect("a number");
        assert!((whitened - studentised).abs() < 1e-9, "{whitened} {studentised}");
    }
    assert_eq!(rows.len(), calibration["holds"]["table"].as_array().expect("a table").len());
}

/// The rows of holds are those of the table of calibration.json, and so is the root mean square of the used ones.
fn of_table(rows: &[Row], table: &Value) {
    let of = "hold accelerometer  m/s²";
    for (k, name) in [(0, "start_s"), (1, "magnitude_residual_mps2")] {
        let stated = table.as_array().expect("a table").iter().map(|hold| hold[name].as_f64());
        let found =
            column(rows, of, k).into_iter().map(|value| Some(value).filter(|value| value.is_finite()));
        assert_eq!(found.collect::<Vec<_>>(), stated.collect::<Vec<_>>(), "{name}");
    }
    let [residuals, sd, whitened] = [1, 2, 3].map(|k| column(rows, of, k));
    for ((residual, sd), whitened) in residuals.iter().zip(&sd).zip(&whitened) {
        assert!(*sd > 0.0 && *whitened == residual / sd, "{residual} {sd} {whitened}");
    }
    // the precision of holds of equal length hardly depends on their direction
    let (least, most) = (sd.iter().copied().fold(f64::MAX, f64::min), sd.iter().copied().fold(0.0, f64::max));
    assert!(most < 2.0 * least, "{sd:?}");
}

/// The residuals with a weight.
fn used(rows: &[Row], of: &str) -> Vec<f64> {
    let residuals = column(rows, of, 1).into_iter().zip(column(rows, of, 4));
    residuals.filter(|(_, weight)| *weight == 1.0).map(|(residual, _)| residual).collect()
}

#[test]
fn of_an_imu_each_hold_and_each_rotation_has_a_row() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    let command = "calibrate imu.toml made/recording.csv -o out --no-report --residuals out/residuals";
    bench.run(&format!("{command}.csv")).done();
    let (rows, calibration) = (rows(&bench, "out/residuals.csv"), bench.json("out/calibration.json"));
    let (holds, rotations) = (&calibration["holds"], &calibration["rotations"]);
    of_table(&rows, &holds["table"]);
    let count = |part: &Value| part["table"].as_array().expect("a table").len();
    assert_eq!(rows.len(), count(holds) + count(rotations));
    let magnitudes = rms(&used(&rows, "hold accelerometer  m/s²"));
    assert_same("holds", magnitudes, &holds["magnitude_residual_rms_mps2"]);
    let rotation = "rotation gyroscope  rad";
    assert_same("rotations", rms(&used(&rows, rotation)), &rotations["error_rms_rad"]);
    let whitened = column(&rows, rotation, 3);
    let stated: Vec<f64> = (0..count(rotations))
        .map(|k| rotations["table"][k]["studentised"].as_f64().expect("a number"))
        .collect();
    assert_eq!(whitened, stated);

    bench.run(&format!("{command}.parquet")).done();
    let bytes = std::fs::read(bench.path("out/residuals.parquet")).expect("there");
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    for wrong in ["residuals.json", "residuals"] {
        let command = format!("calibrate imu.toml made/recording.csv -o new --residuals {wrong}");
        bench.refuses(&command, 2, &[wrong, "the ending of this name is neither .csv nor .parquet"]);
    }
    bench.refuses(
        "calibrate imu.toml made/recording.csv imu.csv -o new --residuals residuals.csv",
        2,
        &["--residuals is the table of one calibration, and several recordings are given"],
    );
}

#[test]
fn on_a_machine_each_sample_of_each_sensor_has_a_row() {
    let bench = Bench::new();
    bench.preset("arm", "arm.toml", &[("duration_s = 60.0", "duration_s = 20.0")]);
    bench.run("simulate arm.toml --seed 3 -o run").done();
    let command = "calibrate arm.toml run/recording.csv --motion run/joints.csv -o out --no-report";
    bench.run(&format!("{command} --residuals out/residuals.csv")).done();
    let (rows, calibration) = (rows(&bench, "out/residuals.csv"), bench.json("out/calibration.json"));
    let samples = calibration["inputs"][0]["samples"].as_f64().expect("a number");
    let machine = &calibration["machine"];
    // of both sensors
    let used = 2.0 * samples * machine["used_share"].as_f64().expect("a share");
    assert_eq!(rows.len(), 3 * used.round() as usize);
    for noise in machine["sensor_noise"].as_array().expect("a list") {
        let [sensor, unit] = ["sensor", "unit"].map(|key| noise[key].as_str().expect("a text"));
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let of = format!("sample {sensor} {axis} {unit}");
            let (residuals, sd) = (column(&rows, &of, 1), column(&rows, &of, 2));
            assert_same(&of, rms(&residuals), &noise["residual_rms"][k]);
            // the noise at rest, or more where the machine moves
            let at_rest = noise["noise"][k].as_f64().expect("a number");
            assert!(sd.iter().all(|sd| *sd >= at_rest * (1.0 - 1e-12)), "{of}: {at_rest}");
            let whitened: Vec<f64> = residuals.iter().zip(&sd).map(|(residual, sd)| residual / sd).collect();
            assert_eq!(column(&rows, &of, 3), whitened);
            assert!((rms(&whitened) - 1.0).abs() < 0.1, "{of}: {}", rms(&whitened));
            assert!(column(&rows, &of, 4).iter().all(|weight| (0.0..=1.0).contains(weight)));
        }
    }
}

//! `calibrant apply`: what is read wrongly or not at all is said, and units are asked for.

use crate::bench::Bench;

const NAMES: &str = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";

/// A bench with an IMU in `truth.json`, m/s² and rad/s, and a file of its readings.
fn imu() -> Bench {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o sim").done();
    bench.write("truth.json", bench.read("sim/truth.json"));
    bench.write("good.csv", rows(NAMES, 1.0));
    bench
}

/// Four samples, the accelerometer's in a unit that is this many m/s².
fn rows(names: &str, unit_mps2: f64) -> String {
    let up = 9.8 / unit_mps2;
    let row = |k: i32| format!("{:.2},{:.5},0.001,{:.5},0.1,0.2,0.3\n", f64::from(k) / 100.0, 0.01 * up, up);
    format!("{names}\n{}", (0..4).map(row).collect::<String>())
}

/// The mean magnitude that the summary states of a sensor.
fn mean(said: &str, sensor: &str) -> f64 {
    let line = said.lines().find(|line| line.trim_start().starts_with(sensor) && line.contains("samples"));
    let number = line.and_then(|line| line.split("mean magnitude ").nth(1)?.split(' ').next());
    number.expect("a mean").parse().expect("a number")
}

/// A recording whose gyroscope cannot be read is an error, not one without gyroscope.
#[test]
fn a_sensor_that_cannot_be_read_is_not_left_out() {
    let bench = imu();
    let done = bench.run("apply truth.json good.csv -o corrected.csv").done();
    assert!((mean(&done.stdout, "gyroscope") - 0.14_f64.sqrt()).abs() < 0.05, "{}", done.stdout);
    let good = bench.read("good.csv");
    for (name, text, says) in [
        ("cell.csv", good.replacen(",0.2,", ",oops,", 1), "oops"),
        ("mixed.csv", good.replace("gz_radps", "gz_degps"), "the axes of the gyroscope have different units"),
        ("named.csv", good.replace("gz_radps", "gq_radps"), "the gyroscope has no column for axis z"),
        ("g.csv", rows(NAMES, 9.80665), "is it in g?"),
        ("empty.csv", good.replace(",0.2,", ",,"), "the gyroscope has columns, but they cannot be used"),
        ("four.csv", "0 0 0 9.8\n0.1 0 0 9.8\n0.2 0 0 9.8\n".into(), "this one does not say which it is"),
    ] {
        bench.write(name, text);
        bench.refuses(&format!("apply truth.json {name} -o x.csv"), 3, &[name, says]);
    }
    bench.refuses(
        "apply truth.json good.csv --gyroscope-unit deg/s -o x.csv",
        3,
        &["the gyroscope's columns are in rad/s, but the unit was given as deg/s"],
    );
    bench.refuses("apply truth.json good.csv --gyroscope none.mat -o x.csv", 3, &["none.mat"]);
    // without its columns there is none, which is said
    let alone = "t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,9.8\n0.1,0,0,9.8\n0.2,0,0,9.8\n";
    bench.write("alone.csv", alone);
    bench
        .run("apply truth.json alone.csv -o corrected.csv")
        .done()
        .says("the recording has no gyroscope: nothing of it is corrected");
}

/// Readings in deg/s are not corrected as rad/s because the calibration is in rad/s.
#[test]
fn a_unit_that_the_file_does_not_state_is_asked_for() {
    let bench = imu();
    bench.write("plain.csv", rows("t_s,ax,ay,az,gx,gy,gz", 1.0));
    bench.refuses(
        "apply truth.json plain.csv -o x.csv",
        3,
        &["the gyroscope's columns have no unit", "--accelerometer-unit", "--gyroscope-unit"],
    );
    bench.refuses(
        "apply truth.json plain.csv --accelerometer-unit m/s2 -o x.csv",
        3,
        &["the gyroscope's columns have no unit", "--gyroscope-unit"],
    );
    let units = "--accelerometer-unit m/s2 --gyroscope-unit";
    let of = |unit| bench.run(&format!("apply truth.json plain.csv {units} {unit} -o x.csv")).done().stdout;
    let (radps, degps) = (mean(&of("rad/s"), "gyroscope"), mean(&of("deg/s"), "gyroscope"));
    assert!((radps - 0.14_f64.sqrt()).abs() < 0.05 && degps < 0.05, "{radps} {degps}");

    // [columns] of an experiment file answers as well
    let columns = "accelerometer_unit = \"m/s2\"\ngyroscope_unit = \"rad/s\"\n# time = ";
    bench.write("columns.toml", bench.read("imu.toml").replacen("# time = ", columns, 1));
    bench.run("apply truth.json plain.csv --columns columns.toml -o columns.csv").done();
    bench.run(&format!("apply truth.json plain.csv {units} rad/s -o options.csv")).done();
    assert_eq!(bench.read("columns.csv"), bench.read("options.csv"));
    bench.refuses(
        "apply truth.json plain.csv --columns imu.toml -o x.csv",
        2,
        &["imu.toml: there is no [columns] section"],
    );
}

/// Of a calibration in counts, the readings are counts unless the file says otherwise.
#[test]
fn a_calibration_in_counts_corrects_counts() {
    let bench = Bench::new();
    bench.write("shimmer.json", crate::conventions::IMUCAL);
    let names = "ax,ay,az,gx,gy,gz";
    let write = |file: &str, names: &str| {
        bench.write(file, format!("t_s,{names}\n0,112,-128,2179,-9,-6,1\n0.1,112,-128,2179,-9,-6,1\n"));
    };
    write("plain.csv", names);
    write("stated.csv", "ax_counts,ay_counts,az_counts,gx_counts,gy_counts,gz_counts");
    write("half.csv", "ax_counts,ay_counts,az_counts,gx,gy,gz");
    // (2179 − 83.3) / 213.7
    let said = bench.run("apply shimmer.json plain.csv -o plain.out").done().stdout;
    assert!((mean(&said, "accelerometer") - 9.807).abs() < 0.02, "{said}");
    for file in ["stated", "half"] {
        bench.run(&format!("apply shimmer.json {file}.csv -o {file}.out")).done();
        assert_eq!(bench.read(&format!("{file}.out")), bench.read("plain.out"), "{file}");
    }
    // what is wrong with the file is said, not that a unit were missing
    let bad = bench.read("plain.csv").replace(",-6,", ",oops,");
    bench.write("bad.csv", bad);
    bench.refuses("apply shimmer.json bad.csv -o x.csv", 3, &["bad.csv", "oops"]);
    bench.write("four.mat", "0 112 -128 2179\n0.1 112 -128 2179\n");
    bench.refuses("apply shimmer.json four.mat --gyroscope none.mat -o x.csv", 3, &["none.mat"]);
    bench.write("si.csv", rows(NAMES, 1.0));
    bench.refuses("apply shimmer.json si.csv -o x.csv", 3, &["si.csv: the readings of the accelerometer"]);
}

/// A calibration of one sensor corrects it in a file of its own as in one of a whole IMU.
#[test]
fn a_calibration_of_one_sensor_reads_one_sensor() {
    let bench = imu();
    bench.write("acc.calib", "1 0 0\n0 1 0\n0 0 1\n2 0 0\n0 2 0\n0 0 2\n0.1\n0.2\n0.3\n");
    bench.run("convert acc.calib acc.json --sensor accelerometer --unit si").done();
    bench.write("four.mat", "0.0 0.1 0.2 5.3\n0.1 0.1 0.2 5.3\n0.2 0.1 0.2 5.3\n");
    bench.refuses("apply acc.json four.mat -o x.csv", 3, &["four.mat", "--accelerometer-unit"]);
    let said = bench.run("apply acc.json four.mat --accelerometer-unit m/s2 -o x.csv").done().stdout;
    assert!((mean(&said, "accelerometer") - 10.0).abs() < 1e-9, "{said}");
    // the other sensor's unit does not matter where it is left out
    bench.write("whole.csv", rows("t_s,ax_mps2,ay_mps2,az_mps2,gx,gy,gz", 1.0));
    let done = bench.run("apply acc.json whole.csv -o x.csv").done();
    done.says("the calibration has no gyroscope: its readings are left out");
    assert!(bench.read("x.csv").starts_with("t_s,ax_mps2,ay_mps2,az_mps2\n"));
}

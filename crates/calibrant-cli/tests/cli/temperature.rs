//! Tests of an IMU that follows temperature, from its recording to corrected readings and other formats.

use crate::bench::Bench;
use calibrant::sensor::{ImuParameters, ImuRecording, SensorKind};
use calibrant::simulate::{ImuSimulation, Purpose, simulate_imu, stream};
use serde_json::Value;
use std::fmt::Write;

/// A bench with `recording.csv`, whose gyroscope's bias moves by 0.2 mrad/s/K from 20 to 45 °C, and `imu.toml`.
fn bench() -> (Bench, ImuRecording) {
    let mut truth = ImuParameters::identity();
    truth.thermal[SensorKind::Gyroscope].bias[0].x = 2e-4;
    let simulation = ImuSimulation { temperature_c: Some([20.0, 45.0]), ..ImuSimulation::default() };
    let recording = simulate_imu(&truth, &simulation, &mut stream(3, Purpose::Sensor, 8));
    let bench = Bench::new();
    bench.write("recording.csv", csv(&recording, true));
    bench.write("cold.csv", csv(&recording, false));
    let orders = [
        ("# gyroscope_bias = 1", "gyroscope_bias = 1"),
        ("# reference_c = 25.0 ", "reference_c = 25.0 "),
        ("g_sensitivity = true", "g_sensitivity = false"),
    ];
    bench.preset("imu", "imu.toml", &orders);
    (bench, recording)
}

fn csv(recording: &ImuRecording, with_temperature: bool) -> String {
    let [a, g] = [&recording[SensorKind::Accelerometer], &recording[SensorKind::Gyroscope]]
        .map(|sensor_kind| sensor_kind.as_ref().expect("there"));
    let temperature = recording.temperature_c.as_ref().expect("simulated");
    let mut text = String::from("t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps");
    text.push_str(if with_temperature { ",temp_c\n" } else { "\n" });
    for (k, celsius) in temperature.iter().enumerate() {
        let (f, w) = (a.readings()[k], g.readings()[k]);
        let _ = write!(text, "{},{},{},{},{},{},{}", a.times_s()[k], f.x, f.y, f.z, w.x, w.y, w.z);
        let _ = if with_temperature { writeln!(text, ",{celsius}") } else { writeln!(text) };
    }
    text
}

/// Rows of a CSV file, without its header.
fn rows(bench: &Bench, name: &str) -> Vec<Vec<f64>> {
    let text = bench.read(name);
    let row = |line: &str| line.split(',').map(|word| word.parse().expect("a number")).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn the_temperature_goes_from_the_recording_to_the_corrected_readings() {
    let (bench, recording) = bench();
    let done = bench.run("calibrate imu.toml recording.csv -o out").done();
    for says in ["gyroscope.bias_per_k.x", "rad/s/K", "Biases and gains are those at T₀ = 25"] {
        assert!(done.printed().contains(says), "{says}: {}", done.stdout);
    }
    assert!(bench.read("out/report.html").contains("bias over temperature"));
    let json = bench.json("out/calibration.json");
    let temperature = &json["temperature"];
    assert_eq!(temperature["reference_c"], 25.0);
    let slope = |axis: usize| temperature["gyroscope"]["bias_radps_per_k"][axis].as_f64().expect("a number");
    let sd = |axis: &str| {
        let name = format!("gyroscope.bias_per_k.{axis}");
        let parameters = json["parameters"].as_array().expect("a list");
        let found = parameters.iter().find(|parameter| parameter["name"] == name.as_str()).expect("there");
        found["sd"].as_f64().expect("a number")
    };
    assert!((slope(0) - 2e-4).abs() < 4.0 * sd("x") && sd("x") < 5e-5, "{temperature}");
    assert!(slope(1).abs() < 4.0 * sd("y"), "{temperature}");

    bench.run("apply out/calibration.json recording.csv -o corrected.csv").done();
    let warm = rows(&bench, "corrected.csv");
    let times = recording[SensorKind::Accelerometer].as_ref().expect("there").times_s();
    let celsius = recording.temperature_c.as_ref().expect("simulated");
    assert_eq!(warm.len(), times.len());
    // without the temperature, and with one for all samples
    bench.refuses(
        "apply out/calibration.json cold.csv -o x.csv",
        3,
        &["follows temperature, and this recording has no temperature", "--temperature CELSIUS"],
    );
    let message = bench.run("apply out/calibration.json cold.csv --temperature 60 -o hot.csv").done().stderr;
    assert!(message.contains("extrapolated to 60.0 °C"), "{message}");
    let hot = rows(&bench, "hot.csv");
    // 60 °C in place of T makes the corrected rate smaller by the slope over the gain
    let gain = json["gyroscope"]["correction"]["matrix"][0][0].as_f64().expect("a number");
    for k in [0, times.len() / 2, times.len() - 1] {
        let column = header_place(&bench, "hot.csv", "gx_radps");
        let expected = -gain * slope(0) * (60.0 - celsius[k]);
        let others: f64 = (1..3)
            .map(|axis| {
                let entry = json["gyroscope"]["correction"]["matrix"][0][axis].as_f64().expect("a number");
                -entry * slope(axis) * (60.0 - celsius[k])
            })
            .sum();
        let found = hot[k][column] - warm[k][column];
        assert!((found - expected - others).abs() < 1e-9, "{k}: {found} beside {expected}");
    }

    bench.refuses("convert out/calibration.json imu.yaml", 2, &["no place for what temperature does"]);
    let done = bench.run("convert out/calibration.json imu.yaml --temperature 40").done();
    assert!(done.stderr.contains("those at 40 °C"), "{}", done.stderr);
    bench.run("convert out/calibration.json imu.h").done();
    let table = bench.run("compare out/calibration.json imu.h").done().stdout;
    assert!(table.contains("gyroscope.bias_per_k.x"), "{table}");
}

fn header_place(bench: &Bench, name: &str, column: &str) -> usize {
    let text = bench.read(name);
    let header = text.lines().next().expect("a header");
    header.split(',').position(|word| word == column).expect(column)
}

/// A calibration finds the parameters of the simulated recording.
#[test]
fn what_is_simulated_over_temperature_is_found_again() {
    let orders = [
        ("# accelerometer_bias = 1", "accelerometer_bias = 1"),
        ("# accelerometer_scale = 1", "accelerometer_scale = 1"),
        ("# gyroscope_bias = 1", "gyroscope_bias = 2"),
        ("# gyroscope_scale = 1", "gyroscope_scale = 1"),
    ];
    for (reference, from_c) in [(None, 20.0), (Some("reference_c = 10.0 "), -2.0)] {
        let bench = Bench::new();
        let mut edits = orders.to_vec();
        edits.extend(reference.map(|line| ("# reference_c = 25.0 ", line)));
        bench.preset("imu", "imu.toml", &edits);
        for seed in 1..=3 {
            bench.run(&format!("simulate imu.toml --seed {seed} -o simulated")).done();
            let table = rows(&bench, "simulated/recording.csv");
            let column = header_place(&bench, "simulated/recording.csv", "temp_c");
            let (first, last) = (table[0][column], table[table.len() - 1][column]);
            assert!(
                (first - from_c).abs() < 1e-9 && (last - from_c - 24.0).abs() < 1e-9,
                "{first} to {last} °C"
            );
            bench.run("calibrate imu.toml simulated/recording.csv -o out").done();
            let (found, truth) = (bench.json("out/calibration.json"), bench.json("simulated/truth.json"));
            assert_eq!(truth["reference_c"], from_c + 12.0);
            assert_eq!(found["temperature"]["reference_c"], truth["reference_c"]);
            let parameters = |value: &Value| value["parameters"].as_array().expect("a list").clone();
            let (found, truth) = (parameters(&found), parameters(&truth));
            assert_eq!(names_of(&found), names_of(&truth));
            let thermal = found
                .iter()
                .zip(&truth)
                .filter(|(one, _)| one["name"].as_str().is_some_and(|name| name.contains("_per_k")));
            assert_eq!(thermal.clone().count(), 15, "three axes of five polynomials' terms");
            for (found, truth) in found.iter().zip(&truth) {
                let number = |value: &Value, field: &str| value[field].as_f64().expect("a number");
                let off = (number(found, "value") - number(truth, "value")) / number(found, "sd");
                assert!(off.abs() < 4.0, "seed {seed}: {off:.1} sd, {found} beside {truth}");
                assert_eq!(found["unit"], truth["unit"]);
            }
            // the terms that were drawn show
            let largest = thermal.map(|(found, _)| {
                found["value"].as_f64().expect("a number") / found["sd"].as_f64().expect("a number")
            });
            assert!(largest.fold(0.0, |most: f64, ratio| most.max(ratio.abs())) > 20.0);
        }
    }
}

fn names_of(parameters: &[Value]) -> Vec<&str> {
    parameters.iter().filter_map(|parameter| parameter["name"].as_str()).collect()
}

#[test]
fn without_a_column_the_experiment_says_what_to_do() {
    let (bench, _) = bench();
    bench.refuses(
        "calibrate imu.toml cold.csv -o out",
        3,
        &["is to follow temperature, and the recording has none", "temperature = \"…\" in [columns]"],
    );
}

#[test]
fn kelvin_are_asked_about_and_a_long_time_without_temperature_is_a_warning() {
    let (bench, _) = bench();
    let text = bench.read("recording.csv");
    let rewrite = |name: &str, of: &dyn Fn(usize, f64) -> String| {
        let row = |(k, line): (usize, &str)| {
            let (readings, celsius) = line.rsplit_once(',').expect("a temperature");
            match celsius.parse() {
                Ok(celsius) => format!("{readings},{}\n", of(k, celsius)),
                Err(_) => format!("{line}\n"),
            }
        };
        bench.write(name, text.lines().enumerate().map(row).collect::<String>());
    };
    rewrite("kelvin.csv", &|_, celsius| (celsius + 273.15).to_string());
    bench.refuses(
        "calibrate imu.toml kelvin.csv -o out",
        3,
        &[
            "kelvin.csv: the temperature is 293.15 °C at 0 s",
            "is the column in kelvin? then subtract 273.15 from it",
        ],
    );
    let half = text.lines().count() / 2;
    rewrite("half.csv", &|k, celsius| if k <= half { celsius.to_string() } else { String::new() });
    let outcome = bench.run("calibrate imu.toml half.csv -o out").done();
    outcome.says("warning: half.csv: the temperature is missing in ");
    outcome.says("kept constant before the first and after the last");
    // a thermometer with so few values counts as missing
    rewrite("slow.csv", &|k, celsius| if k % 100 == 1 { celsius.to_string() } else { String::new() });
    let outcome = bench.run("calibrate imu.toml slow.csv -o out").done();
    outcome.says("note: slow.csv: the temperature is missing in ");
    for impossible in ["-300", "nan", "400"] {
        let says = &["a sensor's temperature in °C, from -100 to 250"];
        bench.refuses(&format!("convert out/calibration.json imu.yaml --temperature {impossible}"), 2, says);
        bench.refuses(
            &format!("apply out/calibration.json recording.csv --temperature {impossible} -o x.csv"),
            2,
            says,
        );
    }
}

/// A recording beyond the temperatures of the calibration is named, whatever the verdict.
#[test]
fn a_validation_beyond_the_calibrations_temperatures_is_said() {
    let (bench, _) = bench();
    let mut truth = ImuParameters::identity();
    truth.thermal[SensorKind::Gyroscope].bias[0].x = 2e-4;
    let simulation = ImuSimulation { temperature_c: Some([60.0, 65.0]), ..ImuSimulation::default() };
    let hot = simulate_imu(&truth, &simulation, &mut stream(4, Purpose::Sensor, 8));
    bench.write("hot.csv", csv(&hot, true));
    let outcome = bench.run("calibrate imu.toml recording.csv --validate hot.csv -o out").done();
    outcome.says("hot.csv: the calibration was made at 20.");
    outcome.says("extrapolated to 60.0 to 65.0 °C");
    let simulation = ImuSimulation { temperature_c: Some([22.0, 43.0]), ..simulation };
    let inside = simulate_imu(&truth, &simulation, &mut stream(5, Purpose::Sensor, 8));
    bench.write("inside.csv", csv(&inside, true));
    let outcome = bench.run("calibrate imu.toml recording.csv --validate inside.csv -o out").done();
    assert!(!outcome.stderr.contains("extrapolated"), "{}", outcome.stderr);
}

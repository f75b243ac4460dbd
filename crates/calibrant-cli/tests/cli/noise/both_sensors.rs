//! Tests of `calibrant noise` of both sensors of an IMU in one run.

use super::recording;
use crate::bench::Bench;
use std::fmt::Write;

/// An IMU at rest at 100 Hz; the noise of its gyroscope is a tenth of the accelerometer's. Returns the file
/// of the IMU, the accelerometer's and the gyroscope's.
fn imu(n: u32) -> [String; 3] {
    let forces = recording("", n + 100, 0.1);
    let lines: Vec<&str> = forces.lines().skip(1).collect();
    let [mut both, mut first, mut second] = [
        "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n",
        "t_s,ax_mps2,ay_mps2,az_mps2\n",
        "t_s,gx_radps,gy_radps,gz_radps\n",
    ]
    .map(str::to_owned);
    for (line, other) in lines.iter().zip(&lines[100..]) {
        let time = line.split(',').next().expect("a time");
        let noise: Vec<f64> =
            other.split(',').skip(1).map(|value| value.parse().expect("a number")).collect();
        let rates = format!("{:.9},{:.9},{:.9}", 0.1 * noise[0], 0.1 * noise[1], 0.1 * (noise[2] - 9.8));
        writeln!(both, "{line},{rates}").expect("written");
        writeln!(first, "{line}").expect("written");
        writeln!(second, "{time},{rates}").expect("written");
    }
    [both, first, second]
}

#[test]
fn both_sensors_of_an_imu_are_examined_at_once() {
    let bench = Bench::new();
    let [both, first, second] = imu(6000);
    bench.write("imu.csv", both);
    bench.write("acc.csv", first);
    bench.write("gyro.csv", second);
    let outcome = bench.run("noise imu.csv -o both").done();
    for text in [
        "velocity random walk N x",
        "angle random walk N x",
        "in [sensor]: noise_mps2 = ",
        "in [gyroscope]: noise_radps = ",
    ] {
        assert!(outcome.printed().contains(text), "{text}\n{}", outcome.stdout);
    }
    let json = bench.json("both/noise.json");
    assert_eq!(json["schema"], 2);
    let names: Vec<&str> =
        json["sensors"].as_array().expect("sensors").iter().filter_map(|it| it["sensor"].as_str()).collect();
    assert_eq!(names, ["accelerometer", "gyroscope"]);
    let page = bench.read("both/report.html");
    assert!(page.contains("Noise of the accelerometer") && page.contains("Noise of the gyroscope"));
    // the same numbers from two files
    bench.run("noise acc.csv --gyroscope gyro.csv -o pair").done();
    let pair = bench.json("pair/noise.json");
    assert_eq!(pair["sensors"], json["sensors"]);
    assert_eq!(
        (&pair["input"]["file"], &pair["gyroscope_input"]["file"]),
        (&"acc.csv".into(), &"gyro.csv".into())
    );
    // and one at a time
    for (sensor, place) in [("accelerometer", 0), ("gyroscope", 1)] {
        bench.run(&format!("noise imu.csv --sensor {sensor} -o {sensor}")).done();
        let one = bench.json(&format!("{sensor}/noise.json"));
        assert_eq!(one["sensors"].as_array().map(Vec::len), Some(1));
        assert_eq!(one["sensors"][0], json["sensors"][place]);
    }
    // into Kalibr's file: both at once, or one file after the other
    let calibration = r#"{"acc_unit": "m/s^2", "gyr_unit": "deg/s", "from_acc_unit": "m/s^2", "from_gyr_unit": "deg/s", "comment": null,
        "K_a": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "R_a": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "b_a": [0.0, 0.0, 0.0], "K_g": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "R_g": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        "K_ga": [[0.01, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], "b_g": [0.0, 0.0, 0.0], "cal_type": "Ferraris", "_format_version": "2.0.0"}"#;
    bench.write("ferraris.json", calibration);
    bench.run("convert ferraris.json imu.yaml --noise both/noise.json").done();
    bench
        .run("convert ferraris.json again.yaml --noise accelerometer/noise.json --noise gyroscope/noise.json")
        .done();
    let yaml = bench.read("imu.yaml");
    assert_eq!(yaml, bench.read("again.yaml"));
    let value = |key: &str| -> f64 {
        let found = yaml.lines().find_map(|line| line.trim().strip_prefix(key)?.strip_prefix(": "));
        found.expect(key).parse().expect("a number")
    };
    // uniform numbers: 0.1/√12 per sample, of three axes the largest
    let expected = 0.1 / 12.0_f64.sqrt() * 0.1;
    for (key, expected) in
        [("accelerometer_noise_density", expected), ("gyroscope_noise_density", 0.1 * expected)]
    {
        assert!((value(key) / expected - 1.0).abs() < 0.05, "{key}: {yaml}");
    }
    assert!(yaml.contains("update_rate: 100.0\n"), "{yaml}");
    // the accelerometer's file of imu_tk cannot carry the gyroscope's g-sensitivity
    bench.refuses("convert ferraris.json imu.calib", 2, &["g-sensitivity", "--sensor accelerometer"]);
    let outcome = bench.run("convert ferraris.json acc.calib --sensor accelerometer").done();
    assert!(outcome.printed().contains("acc.calib (imu_tk"), "{}", outcome.stdout);
    assert!(bench.read("acc.calib").contains("# sensor: accelerometer"));
    bench.refuses(
        "convert ferraris.json gyro.calib --sensor gyroscope",
        2,
        &["takes the accelerometer's readings"],
    );
    bench.run("convert ferraris.json gyro.calib --sensor gyroscope --drop-g-sensitivity").done();
    assert!(bench.read("gyro.calib").contains("# sensor: gyroscope"));
    bench.refuses(
        "convert acc.calib other.json --sensor gyroscope",
        2,
        &["the file says that it is of the accelerometer, and it was given as that of the gyroscope"],
    );
    // a version that is not known yet
    bench.write("next.json", bench.read("both/noise.json").replacen("\"schema\": 2", "\"schema\": 9", 1));
    bench.refuses("convert ferraris.json next.yaml --noise next.json", 2, &["version 9"]);
}

/// Where the user asks for one sensor, the unit of the other has no effect: that sensor only shows when the
/// IMU is stationary.
#[test]
fn of_a_pair_only_the_unit_of_the_sensor_that_is_asked_for_is_needed() {
    let bench = Bench::new();
    let [_, first, second] = imu(6000);
    let bare = |text: &str| text.lines().skip(1).collect::<Vec<_>>().join("\n").replace(',', " ");
    bench.write("acc.mat", bare(&first));
    bench.write("gyro.mat", bare(&second));
    let pair = "noise acc.mat --gyroscope gyro.mat";
    bench.refuses(pair, 3, &["have no unit"]);
    let outcome = bench.run(&format!("{pair} --sensor gyroscope --gyroscope-unit rad/s -o one")).done();
    assert!(outcome.printed().contains("in [gyroscope]: noise_radps = "), "{}", outcome.stdout);
    bench.run(&format!("{pair} --sensor accelerometer --unit m/s2")).done();
    bench.refuses(
        &format!("{pair} --sensor gyroscope"),
        3,
        &["gyro.mat", "the gyroscope's columns have no unit"],
    );
    // the same hold, and the same noise, as with both units
    bench.run(&format!("{pair} --accelerometer-unit m/s2 --gyroscope-unit rad/s -o both")).done();
    assert_eq!(bench.json("one/noise.json")["sensors"][0], bench.json("both/noise.json")["sensors"][1]);
}

/// An imu.yaml has one update_rate.
#[test]
fn sensors_of_different_rates_are_told_apart() {
    let bench = Bench::new();
    let [_, first, second] = imu(6000);
    let every_other = |text: &str| -> String {
        text.lines().take(1).chain(text.lines().skip(1).step_by(2)).collect::<Vec<_>>().join("\n")
    };
    bench.write("acc.csv", every_other(&first));
    bench.write("gyro.csv", &second);
    bench.run("noise acc.csv --gyroscope gyro.csv -o noise").done();
    bench.write("imu_in.yaml", YAML);
    let outcome = bench.run("convert imu_in.yaml imu.yaml --noise noise/noise.json").done();
    for text in ["update_rate is one number: 100 Hz is written", "the accelerometer has 50 Hz", "1.41 times"]
    {
        assert!(outcome.stderr.contains(text), "{text}: {}", outcome.stderr);
    }
    assert!(bench.read("imu.yaml").contains("update_rate: 100.0\n"));
    bench.write("gyro.csv", every_other(&second));
    bench.run("noise acc.csv --gyroscope gyro.csv -o same").done();
    let outcome = bench.run("convert imu_in.yaml same.yaml --noise same/noise.json").done();
    assert!(!outcome.stderr.contains("update_rate is"), "{}", outcome.stderr);
    assert!(bench.read("same.yaml").contains("update_rate: 50.0\n"));
}

/// A calibration of Kalibr.
const YAML: &str = "imu0:\n  accelerometers:\n    M:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n  gyroscopes:\n    M:\n    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n  model: scale-misalignment\n";

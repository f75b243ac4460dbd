//! A whole IMU: simulated, calibrated, and held against its truth.

use crate::bench::{Bench, assert_close_to_truth};

#[test]
fn a_simulated_imu_is_found_again_and_its_noise_in_a_long_hold() {
    let bench = Bench::new();
    let long = "minimum_hold_s = 1.0         # shortest";
    bench.preset("imu", "imu.toml", &[(long, &format!("poses = 14\nhold_s = 25.0\nrate_hz = 50.0\n{long}"))]);
    bench.run("simulate imu.toml --seed 8 -o sim").done();
    let outcome = bench.run("calibrate imu.toml sim/recording.csv -o out").done();
    assert!(outcome.stdout.contains("rad/s, from: Allan deviation of hold "), "{}", outcome.stdout);
    let calibration = bench.json("out/calibration.json");
    assert_close_to_truth(&calibration, &bench.json("sim/truth.json"));
    let noise = calibration["still_gyroscope"]["noise_per_sample_radps"].as_array().expect("axes").clone();
    // 1200 samples give the white noise to 4 % at best
    assert!(noise.iter().all(|sd| (sd.as_f64().expect("a number") / 2e-3 - 1.0).abs() < 0.15), "{noise:?}");
    // given noise counts
    let given = bench.read("imu.toml").replacen("# noise_radps = 2e-3 ", "noise_radps = 2e-3 ", 1);
    bench.write("given.toml", given);
    let outcome = bench.run("calibrate given.toml sim/recording.csv -o given").done();
    assert!(
        outcome.stdout.contains("0.00200, 0.00200, 0.00200 rad/s, from: datasheet"),
        "{}",
        outcome.stdout
    );
}

#[test]
fn counts_are_simulated_with_gains_alone_and_turns_do_not_overlap() {
    let bench = Bench::new();
    bench.preset("imu-counts", "counts.toml", &[]);
    bench.refuses(
        "simulate counts.toml -o sim",
        2,
        &["a simulation of counts needs `sensor.gain_counts_per_mps2`"],
    );
    let gains = bench
        .read("counts.toml")
        .replacen(
            "unit = \"counts\" ",
            "gain_counts_per_mps2 = 415.0\noffset_counts = 32768.0\nunit = \"counts\" ",
            1,
        )
        .replacen("# gain_counts_per_radps", "gain_counts_per_radps", 1);
    bench.write("gains.toml", gains);
    bench.run("simulate gains.toml --seed 4 -o sim").done();
    assert!(bench.read("sim/recording.csv").starts_with("t_s,ax_counts,ay_counts,az_counts,gx_counts,"));
    bench.run("calibrate gains.toml sim/recording.csv -o out").done();
    assert_close_to_truth(&bench.json("out/calibration.json"), &bench.json("sim/truth.json"));

    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table.replacen("start_s = 7.0", "start_s = 5.0", 1));
    bench.refuses(
        "simulate table.toml -o table",
        2,
        &["begins at 5 s begins before what is done until 6 s is over"],
    );
}

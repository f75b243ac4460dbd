//! Tests of a real recording: the static one that comes with imu_tk.

use crate::bench::{Bench, names};
use crate::data::shared_data;

#[test]
fn the_recording_of_imu_tk_is_calibrated_from_its_38_holds() {
    let Some(path) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let bench = Bench::new();
    bench.preset("static-poses-counts", "experiment.toml", &[]);
    std::fs::copy(&path, bench.path("xsens_acc.mat")).expect("copied");
    let outcome = bench.run("calibrate experiment.toml xsens_acc.mat -o result").done();
    assert!(outcome.printed().contains(" of 38 holds"), "{}", outcome.stdout);
    let calibration = bench.json("result/calibration.json");
    assert_eq!(calibration["holds"]["table"].as_array().map(Vec::len), Some(38));
    assert_eq!(calibration["inputs"][0]["samples"], 51_175);
    assert_eq!(calibration["status"], "converged");
    // imu_tk of 2016 on the same file; it takes a fixed number of samples of each hold, so the digits differ
    let expected = [33124.18, 33275.18, 32364.42];
    assert_eq!(
        names(&calibration["parameters"])[..3],
        ["accelerometer.bias.x", "accelerometer.bias.y", "accelerometer.bias.z"]
    );
    for (k, bias) in expected.iter().enumerate() {
        let found = calibration["parameters"][k]["value"].as_f64().expect("a number");
        assert!((found - bias).abs() < 1.5, "{found} against {bias}");
    }
    // the diagonal of imu_tk's misalignment is one
    let correction = &calibration["accelerometer"]["correction"]["matrix_mps2_per_count"];
    for (k, gain) in [414.458_874, 412.010_468, 414.648_662].iter().enumerate() {
        let found = 1.0 / correction[k][k].as_f64().expect("a number");
        assert!((found - gain).abs() < 0.1, "{found} against {gain}");
    }
}

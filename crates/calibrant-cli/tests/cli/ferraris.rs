//! Known faces and turns: how well they were met, and what cannot be.

use crate::bench::{Bench, assert_close_to_truth};

/// Faces are simulated as well as they are met, and told so.
#[test]
fn how_well_the_faces_were_met_is_told() {
    let bench = Bench::new();
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.write("tilted.toml", table.replacen("[holds]", "[holds]\nface_sd_deg = 0.5", 1));
    bench.run("simulate tilted.toml --seed 3 -o tilted").done();
    let given = bench.run("calibrate tilted.toml tilted/recording.csv -o given").done();
    assert!(
        given.stdout.contains("the faces were met within 0.50° about each axis, as given"),
        "{}",
        given.stdout
    );
    assert_close_to_truth(&bench.json("given/calibration.json"), &bench.json("tilted/truth.json"));
    bench.run("calibrate table.toml tilted/recording.csv -o found").done();
    let faces = &bench.json("found/calibration.json")["holds"]["faces"];
    assert_eq!((faces["source"].as_str(), faces["degrees_of_freedom"].as_u64()), (Some("scatter"), Some(6)));
    // six residuals: a factor of two either way in 99 of 100
    let tilt_deg = faces["tilt_sd_rad"].as_f64().expect("a number").to_degrees();
    assert!((0.2..1.0).contains(&tilt_deg), "{tilt_deg}");
    let page = bench.read("found/report.html");
    assert!(
        page.contains("tilt of the faces, sd") && page.contains("by their scatter, 6 degrees of freedom")
    );
    assert!(page.contains("too little left to tell it"));
    bench.refuses(
        &format!("calibrate {} tilted/recording.csv -o no", {
            bench.write("wrong.toml", table.replacen("[holds]", "[holds]\nface_sd_deg = 60.0", 1));
            "wrong.toml"
        }),
        2,
        &["face_sd_deg"],
    );
}

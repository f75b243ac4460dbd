//! Tests of `calibrant inspect` on logs of a machine's motion.

use crate::bench::Bench;
use crate::data::shared_data;
use std::fmt::Write;

/// Poses at 250 Hz, linear between those of a tracker whose 100 Hz are 200 ppm fast.
fn interpolated() -> String {
    let place = |t: f64| [0.3 * (5.0 * t).sin(), 0.2 * (7.0 * t).cos(), 1.0 + 0.1 * (3.0 * t).sin()];
    let period_s = 0.01 / (1.0 + 200e-6);
    let mut text = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz\n".to_owned();
    for k in 0..5000 {
        let t = 0.004 * f64::from(k);
        let knot = (t / period_s).floor();
        let share = t / period_s - knot;
        let (before, after) = (place(knot * period_s), place((knot + 1.0) * period_s));
        write!(text, "{t:.3}").expect("written");
        for axis in 0..3 {
            write!(text, ",{:.7}", before[axis] * (1.0 - share) + after[axis] * share).expect("written");
        }
        text += if k < 1000 { ",nan,nan,nan,nan\n" } else { ",1,0,0,0\n" };
    }
    text
}

#[test]
fn an_interpolated_log_is_shown_with_the_clock_of_its_stream() {
    let bench = Bench::new();
    bench.write("poses.csv", interpolated());
    let printed = bench.run("inspect poses.csv").done().printed();
    for words in [
        "poses.csv: CSV of poses, 5000 rows",
        "poses: 5000 samples from 0 to 19.996 s, 250.00 Hz",
        "position 100.0 %",
        "orientation 80.00 % 4.00 s",
        "The poses are a linear interpolation of a stream at 100.0200 Hz (of 100 Hz by a clock that is 200.0 ppm fast). Only its 2001 samples are measurements.",
    ] {
        assert!(printed.contains(words), "{words}\n{printed}");
    }
    bench.write("inspection.json", bench.run("inspect poses.csv --json").done().stdout);
    let json = bench.json("inspection.json");
    let stream = &json["poses"]["interpolated"];
    assert_eq!((json["format"].as_str(), stream["nominal_rate_hz"].as_f64()), (Some("poses"), Some(100.0)));
    assert!((stream["clock_fast_ppm"].as_f64().expect("a number") - 200.0).abs() < 0.1, "{stream}");
    assert!(stream["rms_m"].as_f64().expect("a number") < 1e-7, "{stream}");
    assert_eq!(json["poses"]["orientation"]["seen"]["samples"], 4000);
}

#[test]
fn joints_are_shown_with_their_ranges_gaps_and_jumps() {
    let bench = Bench::new();
    let mut text = "t_ms,elbow_deg,elbow_degps,rail_mm\n".to_owned();
    for k in 0..2000_u32 {
        let t = 0.002 * f64::from(k);
        let jump = if k > 1500 { 30.0 } else { 0.0 };
        let rail = if k < 500 { "nan".to_owned() } else { format!("{:.4}", 100.0 * t) };
        // 50 ms are missing
        let late = if k > 800 { 50 } else { 0 };
        writeln!(text, "{},{:.4},{:.4},{rail}", 2 * k + late, 60.0 * t.sin() + jump, 60.0 * t.cos())
            .expect("written");
    }
    text += "4048,0,0,0\n";
    bench.write("joints.csv", text);
    let printed = bench.run("inspect joints.csv").done().printed();
    for words in [
        "joints.csv: CSV of joints, 2001 rows",
        "joints: 2000 samples from 0 to 4.048 s, 500.00 Hz",
        "1 gap of 0.05 s",
        "and 1 more sample with the time of the one before",
        "elbow",
        "yes 100.0 %",
        "75.01 % 1.00 s",
        "gap of 0.052 s after t = 1.6 s",
        "[sampling-gap]",
    ] {
        assert!(printed.contains(words), "{words}\n{printed}");
    }
    bench.run("inspect joints.csv --deny warnings").done();
    bench
        .run("inspect joints.csv --deny sampling-gap")
        .ends_with(1)
        .says("denied: sampling-gap: joints.csv: ");
    let allowed = bench.run("inspect joints.csv --allow sampling-gap").done().printed();
    assert!(!allowed.contains("[sampling-gap]"), "{allowed}");
    bench.write("inspection.json", bench.run("inspect joints.csv --json").done().stdout);
    let json = bench.json("inspection.json");
    assert_eq!(json["repeated_times"], 1);
    let elbow = &json["joints"][0];
    assert_eq!((elbow["name"].as_str(), elbow["has_velocities"].as_bool()), (Some("elbow"), Some(true)));
    let jump = elbow["jumps"]["largest_after_s"].as_f64().expect("a jump");
    assert!((jump - 3.05).abs() < 1e-9, "{elbow}");
    assert_eq!(json["joints"][1]["seen"]["samples"], 1501);
}

#[test]
fn a_broken_log_is_refused_as_a_log_and_other_files_as_recordings() {
    let bench = Bench::new();
    bench.write("joints.csv", "t_s,elbow_rad\n0,1\n1,left\n");
    bench.refuses(
        "inspect joints.csv",
        3,
        &["joints.csv:3:3: \"left\" in column `elbow_rad` is not a number"],
    );
    bench.write("tum.txt", "0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 2\n");
    bench.refuses("inspect tum.txt", 3, &["tum.txt:2: the norm of the quaternion is 2.0000, not 1"]);
    bench.write("eight.txt", "0 1 2 9 1 2 3 25\n1 1 2 9 1 2 3 25\n");
    bench.refuses("inspect eight.txt", 3, &["8 columns without a header: nothing says what they hold"]);
    bench.refuses(
        "inspect tum.txt --format csv",
        3,
        &["8 columns without a header: nothing says what they hold"],
    );
    bench.write("log.mat", "MATLAB 5.0 MAT-file, Platform: GLNXA64\0\0");
    bench.refuses("inspect log.mat", 3, &["a binary file of MATLAB (MAT-file 5)", "save its table as CSV"]);
}

#[test]
fn the_references_of_broad_are_shown_as_interpolated() {
    for (trial, ppm) in
        [("21_undisturbed_fast_combined", "128.0"), ("03_undisturbed_slow_rotation_C", "125.4")]
    {
        let Some(path) = shared_data(&format!("broad-mocap/broad_{trial}/ref_285hz_as_published.csv")) else {
            return;
        };
        let bench = Bench::new();
        std::fs::copy(path, bench.path("reference.csv")).expect("copied");
        let printed = bench.run("inspect reference.csv").done().printed();
        let clock = format!("(of 120 Hz by a clock that is {ppm} ppm fast)");
        assert!(printed.contains(&clock), "{printed}");
    }
}

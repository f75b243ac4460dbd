//! Tests of known faces and turns: the face alignment, and inputs that are impossible.

use crate::bench::{Bench, assert_close_to_truth};

/// Mistakes of a user in a Ferraris session: swapped sections, columns in another order, another unit. The
/// program refuses what is impossible, and reports another mounting.
#[test]
fn a_ferraris_session_that_cannot_be_is_refused_and_another_mounting_is_told() {
    let bench = Bench::new();
    bench.write("table.toml", include_str!("../../../../examples/06_whole_imu/table.toml"));
    bench.write("ferraris.toml", include_str!("../../../../examples/06_whole_imu/ferraris.toml"));
    let list = include_str!("../../../../examples/06_whole_imu/sections.json");
    bench.write("sections.json", list);
    bench.run("simulate table.toml --seed 3 -o table").done();
    let recording = bench.read("table/recording.csv");
    bench.write("ok.csv", &recording);
    let run =
        |file: &str| format!("calibrate ferraris.toml {file} --sections sections.json --no-report -o out");
    let honest = bench.run(&run("ok.csv")).done();
    assert!(!honest.stderr.contains("warning"), "{}", honest.stderr);

    let exchanged = |one: &str, other: &str| {
        let list = list.replacen(one, "?", 1).replacen(other, one, 1).replacen('?', other, 1);
        bench.write("sections.json", list);
        run("ok.csv")
    };
    bench.refuses(
        &exchanged("x_rot", "y_rot"),
        2,
        &[
            "y_rot (",
            "is given as 360.0° about y, but the gyroscope shows 360° about x",
            "exchange these turns",
        ],
    );
    bench.refuses(
        &exchanged("x_rot", "x_p"),
        2,
        &["is given as 360.0° about x, but the gyroscope shows", "correct axis, angle or times"],
    );
    bench.write("sections.json", list);
    // no turn is exact, and gravity is that of the Earth
    let ferraris = include_str!("../../../../examples/06_whole_imu/ferraris.toml");
    bench.write("exact.toml", ferraris.replacen("turn_sd_deg = 0.5", "turn_sd_deg = 0.0", 1));
    let with = |file: &str| run("ok.csv").replacen("ferraris.toml", file, 1);
    bench.refuses(&with("exact.toml"), 2, &["gyroscope.turn_sd_deg"]);
    bench.write(
        "light.toml",
        ferraris.replacen("latitude_deg = 52.0\nheight_m = 30.0", "gravity_mps2 = 9.0", 1),
    );
    bench.run(&with("light.toml")).done().says("on the Earth's surface it is 9.76 to 9.84");

    // columns: t, accelerometer, gyroscope
    let columns = |name: &str, of: &dyn Fn(&[f64]) -> Vec<f64>| {
        let mut lines = recording.lines();
        let mut text = lines.next().expect("a header").to_owned();
        for line in lines {
            let row: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
            let row: Vec<String> = of(&row).iter().map(f64::to_string).collect();
            text.push_str(&format!("\n{}", row.join(",")));
        }
        bench.write(name, text);
        run(name)
    };
    let chosen = |places: [usize; 7]| move |row: &[f64]| places.map(|place| row[place]).to_vec();
    let opposite = columns("opposite.csv", &|row| {
        row.iter().enumerate().map(|(k, y)| if k > 3 { -y } else { *y }).collect()
    });
    bench.refuses(
        &opposite,
        3,
        &["of the angle of every turn", "is the sign of the angle of the turns right"],
    );
    let degrees = columns("degrees.csv", &|row| {
        row.iter().enumerate().map(|(k, y)| if k > 3 { y.to_degrees() } else { *y }).collect()
    });
    bench.refuses(&degrees, 3, &["a ratio of about 180/π", "read as rad/s"]);
    let heavy = columns("heavy.csv", &|row| {
        row.iter().enumerate().map(|(k, y)| if (1..4).contains(&k) { y * 9.806_65 } else { *y }).collect()
    });
    bench.refuses(&heavy, 3, &["the accelerometer shows 9."]);
    let mirrored = columns("mirrored.csv", &chosen([0, 1, 2, 3, 5, 4, 6]));
    bench.refuses(&mirrored, 2, &["exchange these turns", "or the gyroscope's columns"]);
    // both sensors turned alike in their housing, and the gyroscope alone: both are possible
    let both = columns("both.csv", &chosen([0, 2, 3, 1, 5, 6, 4]));
    let reported = bench.run(&both).ends_with(5);
    reported.says("All directions are rotated in the same way");
    assert!(!reported.stderr.contains("turn 1"), "{}", reported.stderr);
    let one = columns("one.csv", &chosen([0, 1, 2, 3, 5, 6, 4]));
    bench
        .run(&one)
        .ends_with(5)
        .says("along x, y and z of the accelerometer lie z, x and y of the gyroscope");
}

/// Faces are simulated with the face alignment of the experiment, and the calibration reports it.
#[test]
fn how_well_the_faces_were_met_is_told() {
    let bench = Bench::new();
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.write("tilted.toml", table.replacen("[holds]", "[holds]\nface_sd_deg = 0.5", 1));
    bench.run("simulate tilted.toml --seed 3 -o tilted").done();
    let given = bench.run("calibrate tilted.toml tilted/recording.csv -o given").done();
    assert!(
        given.printed().contains("face alignment is 0.50° about each axis, as given"),
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
    assert!(page.contains("repeat each face"));
    bench.refuses(
        &format!("calibrate {} tilted/recording.csv -o no", {
            bench.write("wrong.toml", table.replacen("[holds]", "[holds]\nface_sd_deg = 12.0", 1));
            "wrong.toml"
        }),
        2,
        &["face_sd_deg"],
    );
}

/// The preset is for files of imucal, and simulated recordings are not. The program names the way from one to
/// the other, and the way works.
#[test]
fn a_recording_simulated_for_files_of_another_format_is_told_how_to_be_calibrated() {
    let bench = Bench::new();
    bench.preset("ferraris", "ferraris.toml", &[]);
    let done = bench.run("simulate ferraris.toml --seed 2 -o made").done();
    let says = "take a copy of the experiment without [columns] and gyroscope.unit";
    assert!(done.stderr.contains(says), "{}", done.stderr);
    let text = bench.read("ferraris.toml");
    let (before, columns) = text.split_once("[columns]").expect("a section");
    let after = columns.split_once("\n[").map_or(String::new(), |(_, after)| format!("[{after}"));
    let copy = format!("{before}{after}").replace("unit = \"degps\"", "#");
    bench.write("copy.toml", copy);
    bench.run("calibrate copy.toml made/recording.csv --no-report -o out").done();
}

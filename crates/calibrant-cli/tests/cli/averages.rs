//! What was cut by pose before it was written: a table of averages, and a recording for each face.

use crate::bench::Bench;
use serde_json::Value;

/// The readings of a simulated recording of `poses` holds: the rows of each, without the movements between them.
fn rows_of_holds(bench: &Bench, poses: usize) -> Vec<Vec<[f64; 3]>> {
    let text = bench.read("made/recording.csv");
    let rows = text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    let readings: Vec<[f64; 3]> = rows
        .map(|row| {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            [cells[1], cells[2], cells[3]]
        })
        .collect();
    let size = readings.len() / poses;
    readings.chunks(size).take(poses).map(|rows| rows[size / 4..3 * size / 4].to_vec()).collect()
}

/// The largest difference of two calibrations, in standard deviations of the first.
fn difference(one: &Value, other: &Value) -> f64 {
    let of = |of: &Value| of["parameters"].as_array().expect("a list").clone();
    let number = |of: &Value, key: &str| of[key].as_f64().expect("a number");
    let pairs = of(one).into_iter().zip(of(other));
    pairs
        .map(|(one, other)| {
            assert_eq!(one["name"], other["name"]);
            ((number(&one, "value") - number(&other, "value")) / number(&one, "sd")).abs()
        })
        .fold(0.0, f64::max)
}

/// Writes the means of the holds of `whole` as a table; their number.
fn averages(bench: &Bench) -> usize {
    let holds = bench.json("whole/calibration.json")["holds"]["table"].as_array().expect("holds").clone();
    let mean = |hold: &Value| -> Vec<String> {
        let mean = hold["mean_mps2"].as_array().expect("three numbers");
        mean.iter().map(|value| format!("{:.7}", value.as_f64().expect("a number"))).collect()
    };
    let table: String = holds.iter().map(|hold| mean(hold).join(",") + "\n").collect();
    bench.write("averages.txt", table);
    holds.len()
}

#[test]
fn a_table_of_averages_is_calibrated_as_the_recording_that_it_is_from() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[("# noise_mps2", "noise_mps2")]);
    bench.run("simulate poses.toml -o made").done();
    bench.run("calibrate poses.toml made/recording.csv --no-report -o whole").done();
    let holds = averages(&bench);
    // the refusal says what to do, and doing it is enough
    bench.refuses(
        "calibrate poses.toml averages.txt -o out",
        3,
        &["3 columns where 4 are needed", "where each row is the mean of a hold, say --rows-are-holds"],
    );
    let units = "--rows-are-holds --unit m/s2";
    let said = bench.run(&format!("calibrate poses.toml averages.txt {units} -o out")).done().printed();
    assert!(!said.contains("warning") && !said.contains("noise estimate"), "{said}");
    let (whole, found) = (bench.json("whole/calibration.json"), bench.json("out/calibration.json"));
    assert_eq!(found["holds"]["table"].as_array().expect("holds").len(), holds);
    assert_eq!(found["verdict"]["usability"], "ok");
    let off = difference(&whole, &found);
    assert!(off < 0.5, "{off}");
    bench.preset("imu", "imu.toml", &[]);
    bench.write("six.csv", "ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n0.1,0.2,9.8,0.1,0.1,0.1\n0.1,9.8,0.2,0.1,0.1,0.1\n");
    bench.refuses(
        "calibrate imu.toml six.csv --rows-are-holds -o out",
        2,
        &["nothing moves between the rows"],
    );
}

#[test]
fn each_face_may_have_a_recording_of_its_own() {
    let bench = Bench::new();
    bench.preset("faces", "faces.toml", &[]);
    bench.run("simulate faces.toml -o made").done();
    bench.run("calibrate faces.toml made/recording.csv --no-report -o whole").done();
    // the faces as a table of averages
    averages(&bench);
    let said = bench.run("calibrate faces.toml averages.txt --rows-are-holds --unit m/s2 -o table").done();
    assert!(!said.printed().contains("warning"), "{}", said.printed());
    let off = difference(&bench.json("whole/calibration.json"), &bench.json("table/calibration.json"));
    assert!(off < 1.0, "{off}");
    let mut names = Vec::new();
    for (face, rows) in rows_of_holds(&bench, 6).iter().enumerate() {
        let name = format!("face{face}.csv");
        let row = |(k, [x, y, z]): (usize, &[f64; 3])| format!("{},{x},{y},{z}\n", k as f64 / 100.0);
        let rows: String = rows.iter().enumerate().map(row).collect();
        bench.write(&name, format!("t_s,ax_mps2,ay_mps2,az_mps2\n{rows}"));
        names.push(name);
    }
    bench.run(&format!("calibrate faces.toml {} --together -o out", names.join(" "))).done();
    let (whole, found) = (bench.json("whole/calibration.json"), bench.json("out/calibration.json"));
    let off = difference(&whole, &found);
    assert!(off < 1.0, "{off}");
    // of fewer, each hold is on the face that it shows
    let five = format!("calibrate faces.toml {} --together -o out", names[..5].join(" "));
    bench.run(&five).done().says("no hold has -z up");
}

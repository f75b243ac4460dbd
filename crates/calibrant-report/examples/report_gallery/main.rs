//! Writes reports of made-up results for a reader to look at:
//! `cargo run -p calibrant-report --features programs --example report_gallery -- DIRECTORY`.

use calibrant_core::{estimate, information, motion, sensor, simulate};
use calibrant_design as design;
use calibrant_report::{
    About, Batch, BatchParameter, BatchSensor, batch_sheet, calibration_sheet, design_sheet,
    evaluation_sheet, machine_sheet, study_sheet, sweep_sheet,
};
use calibrant_study as study;
use std::path::PathBuf;

mod batches;
mod designs;
mod fakes;
mod imus;
mod machines;
mod studies;

fn main() -> std::io::Result<()> {
    let directory = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_string()));
    std::fs::create_dir_all(&directory)?;
    let write = |name: &str, html: String| {
        println!("{name}: {} kB", html.len() / 1000);
        std::fs::write(directory.join(name), html)
    };
    let about = |title: &str, file: &str, samples: usize| About {
        title: title.to_string(),
        facts: [
            ("File", file.to_string()),
            ("SHA-256", "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".to_string()),
            ("Samples", samples.to_string()),
            ("Experiment", "experiment.toml".to_string()),
            ("Options", "--unit mps2".to_string()),
        ]
        .map(|(label, value)| (label.to_string(), value))
        .to_vec(),
        ..About::default()
    };

    for (name, count) in [("batch.html", 40), ("batch_small.html", 6)] {
        let about = about("Batch of sensors", "–", 101);
        write(name, batch_sheet(&batches::drifting_batch(count), &about).html())?;
    }

    let case = fakes::motion_case(3, 14, 2.0, 4);
    let simulated = About {
        truth: Some(case.truth),
        true_motion: Some(case.true_motion.clone()),
        ..about("Calibration of a simulated sensor", "recording <7>.csv", case.recording.len())
    };
    write(
        "motion.html",
        calibration_sheet(&case.calibration, &case.recording.clone().into(), &[], &simulated).html(),
    )?;

    let mut blind = about("Calibration of sensor 7", "sensor7.csv", case.recording.len());
    blind.findings = vec!["3 samples are missing between 12.5 s and 14.5 s".to_string()];
    write(
        "motion_blind.html",
        calibration_sheet(&case.calibration, &case.recording.clone().into(), &[], &blind).html(),
    )?;

    let case = fakes::motion_case(1, 5, 10.0, 9);
    let simulated =
        About { truth: Some(case.truth), ..about("A uniaxial sensor", "uniaxial.csv", case.recording.len()) };
    write(
        "uniaxial.html",
        calibration_sheet(&case.calibration, &case.recording.clone().into(), &[], &simulated).html(),
    )?;

    let (calibration, recording) = fakes::hold_case(38, 300);
    write(
        "holds.html",
        calibration_sheet(
            &calibration,
            &recording,
            &[],
            &about(
                "Static calibration",
                "mti.csv",
                recording.accelerometer.as_ref().map_or(0, sensor::Recording::len),
            ),
        )
        .html(),
    )?;

    let case = imus::imu_case(24, 1);
    println!("imu: rotation {} is disturbed", imus::DISTURBED + 1);
    let samples = case.recording.gyroscope.as_ref().map_or(0, sensor::Recording::len);
    let imu_about = about("A whole IMU, turned by hand", "imu.csv", samples);
    write("imu.html", calibration_sheet(&case.calibration, &case.recording, &[], &imu_about).html())?;

    let (sensor, limits) = (sensor::Sensor::memsic_mxd2020u(), designs::arm());
    let problem = designs::problem(&sensor, &limits);
    let design = designs::design_of(&problem, 30);
    write(
        "design.html",
        design_sheet(&design, &about("Design for the sensor of the thesis", "–", 101)).html(),
    )?;

    let own = designs::swing(&problem, [1.0; 3]).motion;
    let assessment = design::assess(&problem, &own, Ok(design)).expect("a valid setting");
    write(
        "evaluation.html",
        evaluation_sheet(&assessment, &about("Is my motion any good?", "mine.csv", 101)).html(),
    )?;
    write("sweep.html", sweep_sheet(&designs::sweep(&sensor), &about("Displacement", "–", 101)).html())?;

    for (name, poses) in [("machine.html", false), ("machine_poses.html", true)] {
        let case = machines::machine_case(poses, 20.0, 1);
        let about = about("A sensor on a machine", "imu.csv", 3980);
        write(name, machine_sheet(&case.calibration, &case.setup, &[], &case.recording, &about).html())?;
    }

    let case = fakes::motion_case(3, 20, 10_000.0, 9);
    write(
        "long.html",
        calibration_sheet(
            &case.calibration,
            &case.recording.clone().into(),
            &[],
            &about("A long recording", "long.csv", case.recording.len()),
        )
        .html(),
    )?;

    write(
        "study.html",
        study_sheet(&studies::everything(50, 30), &about("Study of 50 sensors", "–", 0)).html(),
    )?;
    write(
        "study_large.html",
        study_sheet(
            &studies::calibrations(studies::calibration_study(100_000)),
            &about("Study of 100 000 sensors", "–", 0),
        )
        .html(),
    )
}

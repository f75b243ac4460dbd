//! A batch of recordings in memory: a row for each, copies, keys, and what is interrupted.

use calibrant::batch::{Batch, BatchOptions, BatchResults};
use calibrant::error::Refusal;
use calibrant::io::{Experiment, preset};
use calibrant::progress::Progress;
use calibrant::sensor::{Recording, SensorKind};
use calibrant::session::{Session, SessionOptions, Source};
use calibrant::{SimulationOptions, simulate};

fn experiment() -> Experiment {
    Experiment::parse(preset("static-poses").expect("it exists"), None).expect("valid")
}

/// A sensor held still.
fn recording(seed: u64) -> Recording {
    let options = SimulationOptions { seed: Some(seed), ..SimulationOptions::default() };
    simulate(&experiment(), &options).expect("simulated").recording[SensorKind::Accelerometer]
        .clone()
        .expect("there")
}

/// A batch of recordings with these names and seeds; its results keep their text, and nothing is written.
fn batch(options: SessionOptions, recordings: &[(&str, u64)]) -> Batch {
    let sources = recordings.iter().map(|(name, seed)| Source::from_recording(*name, recording(*seed)));
    let session = Session::with(experiment(), options).expect("prepared");
    let options = BatchOptions { keep_json: true, ..BatchOptions::default() };
    Batch::new(session, sources.collect(), options).expect("checked")
}

fn keys(results: &BatchResults) -> Vec<&str> {
    results.rows.iter().map(|row| row.key.as_ref().expect("a key").as_str()).collect()
}

#[test]
fn rows_in_memory_have_results_keys_and_copies() {
    let recordings = [("A", 1), ("B", 2), ("copy of A", 1)];
    let results = batch(SessionOptions::default(), &recordings).run(&Progress::default());
    assert_eq!(results.copies, [[0, 2]]);
    assert_eq!(results.failed(), 2);
    let error = results.rows[2].outcome.as_ref().expect_err("a copy");
    assert_eq!(error.code(), Refusal::RecordingRepeated);
    assert!(error.to_string().contains("copy of A: this is a copy of A: of which sensor is it?"), "{error}");
    let result = results.rows[1].outcome.as_ref().expect("calibrated");
    let alone = batch(SessionOptions::default(), &recordings[1..2]);
    let outcome = alone.calibrate(&alone.sources()[0], &mut Vec::new()).expect("calibrated");
    assert_eq!(result.json, outcome.json());
    let input = &outcome.origin.inputs[0];
    assert_eq!(results.rows[1].files.as_ref().expect("in memory")[0].sha256, input.sha256);

    // a key is of content, experiment and options, not of names or of who waits
    let all = keys(&results);
    assert!(all[0] == all[2] && all[0] != all[1]);
    let told = SessionOptions { progress: Progress::to(|_| {}), ..SessionOptions::default() };
    assert_eq!(keys(&batch(told, &[("another name", 2)]).run(&Progress::default())), [all[1]]);
    let other = SessionOptions { folds: Some(3), ..SessionOptions::default() };
    assert_ne!(keys(&batch(other, &recordings[1..2]).run(&Progress::default())), [all[1]]);
}

#[test]
fn what_was_not_begun_when_it_was_interrupted_has_an_error() {
    let options = SessionOptions::default();
    let (asked, progress) = (options.interruption.clone(), options.interruption.clone());
    let batch = batch(options, &[("A", 1), ("B", 2), ("C", 3), ("D", 4)]);
    asked.ask();
    let results = batch.run(&Progress::to(move |step| assert!(step.of == 4 && progress.is_asked())));
    for row in &results.rows {
        assert_eq!(row.outcome.as_ref().expect_err("interrupted").code(), Refusal::Interrupted);
    }
    assert!(results.json().contains("\"code\": \"interrupted\""), "{}", results.json());
}

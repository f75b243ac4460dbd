//! Good recordings by hand: hardly a warning, and folds that find nothing wrong.

use super::Session;
use crate::common::hand::ByHand;
use calibrant::estimate::{CalibrationSettings, CovarianceVerdict, cross_validate_imu};
use rayon::prelude::*;
use std::collections::BTreeMap;

fn good(number: u64) -> Session {
    let hand = ByHand { knocks: true, filtered: true, turn_in_hold_radps: 1e-3, ..ByHand::default() };
    Session::new(113, number, &hand, |_, _| ())
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn good_recordings_have_hardly_a_warning() {
    let codes: Vec<Vec<&str>> = (0..100)
        .into_par_iter()
        .map(|number| {
            let found = good(number).calibrate().expect("determined");
            found.warnings.iter().map(|warning| warning.code().name()).collect()
        })
        .collect();
    let mut of_code: BTreeMap<&str, usize> = BTreeMap::new();
    codes.iter().flatten().for_each(|code| *of_code.entry(code).or_default() += 1);
    let mut counts: Vec<usize> = codes.iter().map(Vec::len).collect();
    counts.sort_unstable();
    let more = counts.iter().filter(|count| **count > 1).count();
    println!("median {}, more than one in {more}; {of_code:?}", counts[50]);
    assert!(counts[50] == 0 && more <= 5, "{counts:?}");
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn folds_doubt_hardly_a_good_recording() {
    const COUNT: usize = 300;
    let verdicts: Vec<Vec<CovarianceVerdict>> = (0..COUNT as u64)
        .into_par_iter()
        .map(|number| {
            let session = good(number);
            let found = session.calibrate().expect("determined");
            let settings = CalibrationSettings::default();
            let folds = cross_validate_imu(&found, &session.problem(), &settings, 5).expect("determined");
            folds.kinds.iter().map(|errors| errors.verdict).collect()
        })
        .collect();
    let with = |verdict: CovarianceVerdict| verdicts.iter().filter(|all| all.contains(&verdict)).count();
    let doubts =
        [CovarianceVerdict::TooSmall, CovarianceVerdict::LargerThanNeeded, CovarianceVerdict::Doubtful];
    doubts.iter().for_each(|verdict| println!("{} in {} of {COUNT}", verdict.name(), with(*verdict)));
    let doubted = verdicts.iter().filter(|all| all.iter().any(|verdict| doubts.contains(verdict))).count();
    println!("doubted {doubted}");
    assert!(100 * doubted <= 3 * COUNT, "{doubted}");
}

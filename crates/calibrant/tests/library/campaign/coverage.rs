//! Whole IMUs by hand, with all that a hand and a host do to a recording at once: 95 % intervals cover 95 %.

use super::Session;
use crate::common::hand::ByHand;
use calibrant::simulate::{Purpose, stream};
use rand::RngExt;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Sessions.
const COUNT: u64 = 1000;
/// Half the width of a 95 % interval, in standard deviations.
const INTERVAL: f64 = 1.96;

/// The group of a parameter: `gyroscope.scale`.
fn group(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(group, _)| group)
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn intervals_of_whole_imus_by_hand_cover_95_percent() {
    let session = |number: u64| {
        let mut rng = stream(111, Purpose::Recording, number);
        let late_s = rng.random_range(0.005..0.015);
        let hand = ByHand {
            knocks: true,
            filtered: true,
            rate_hz: 99.7,
            host_tick_s: Some(0.005),
            turn_in_hold_radps: 2e-3,
            gyroscope_late_s: late_s,
            ..ByHand::default()
        };
        let session = Session::new(112, number, &hand, |_, _| ());
        let calibration = session.calibrate().expect("determined");
        let names = calibration.quantities.iter().map(|quantity| quantity.name());
        let mut errors: Vec<(String, f64)> = names.zip(session.errors_in_sd(&calibration)).collect();
        let time = calibration.gyroscope.as_ref().and_then(|gyroscope| gyroscope.time_offset);
        errors.extend(time.map(|time| ("time offset".into(), (time.offset_s - late_s) / time.sd_s)));
        errors
    };
    let all: Vec<Vec<(String, f64)>> = (0..COUNT).into_par_iter().map(session).collect();
    let mut groups: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (name, error) in all.into_iter().flatten() {
        groups.entry(group(&name).to_owned()).or_default().push(error);
    }
    for (name, errors) in groups {
        let count = errors.len() as f64;
        let within = errors.iter().filter(|error| error.abs() < INTERVAL).count() as f64 / count;
        let squares = errors.iter().map(|error| error * error).sum::<f64>() / count;
        println!("{name:24} {:6} intervals cover {:.1} %, z² {squares:.2}", errors.len(), 100.0 * within);
        assert!((0.93..0.97).contains(&within), "{name}: {within}");
    }
}

//! A calibration is not tried on the data that it is from, and no recording counts twice.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::Vector3;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// Successive readings in a block.
const BLOCK: usize = 16;

/// Recordings with fewer blocks are not compared.
const LEAST_BLOCKS: usize = 4;

/// Two recordings share samples where the longer one has this share of the shorter one's blocks, of those in which half of the readings differ from the one before.
const SHARED: f64 = 0.5;

/// A sensor's readings, and the hash of the files that they are from.
pub(crate) struct Readings<'a> {
    pub(crate) sha256: String,
    pub(crate) recording: Option<&'a Recording>,
}

/// Refuses the data of a sensor that were calibrated from: the same file, or one that shares its samples.
pub(crate) fn refuse_duplicate(
    sensor_kind: SensorKind,
    one: &Readings<'_>,
    other: &Readings<'_>,
    path: &Path,
) -> Result<()> {
    if !are_the_same(one, other) {
        return Ok(());
    }
    let what = match sensor_kind {
        SensorKind::Accelerometer => "it has the data that were calibrated from",
        SensorKind::Gyroscope => "its gyroscope has the data that were calibrated from",
    };
    let message = format!("{what}; errors on them are smaller than on other data, and validate nothing");
    let help = "give another recording of the sensor, or option `folds` 5 in place of option `validate`, which validates with parts of this recording";
    Err(Error::experiment(InputError::new(Refusal::RecordingRepeated, message, help).in_file(path)))
}

/// Are they of the same file, or do they share samples?
pub(crate) fn are_the_same(one: &Readings<'_>, other: &Readings<'_>) -> bool {
    let recordings = one.recording.zip(other.recording);
    one.sha256 == other.sha256 || recordings.is_some_and(|(one, other)| share_samples(one, other))
}

/// Do two recordings share samples: is one a part of the other, or do they overlap, at whatever times? Readings are compared to the last digit.
fn share_samples(one: &Recording, other: &Recording) -> bool {
    let (long, short) = if one.len() < other.len() { (other, one) } else { (one, other) };
    let (long, short) = (hashes(long), hashes(short));
    let known: HashSet<&[u64]> = long.windows(BLOCK).collect();
    // a sensor with coarse steps gives the same few readings again and again
    let varied = |block: &&[u64]| block.windows(2).filter(|pair| pair[0] != pair[1]).count() >= BLOCK / 2;
    let blocks: Vec<&[u64]> = short.chunks_exact(BLOCK).filter(varied).collect();
    let found = blocks.iter().filter(|block| known.contains(*block)).count();
    blocks.len() >= LEAST_BLOCKS && found as f64 >= SHARED * blocks.len() as f64
}

/// One for each reading.
fn hashes(recording: &Recording) -> Vec<u64> {
    let hash = |reading: &Vector3<f64>| {
        let mut hasher = DefaultHasher::new();
        reading.iter().for_each(|value| value.to_bits().hash(&mut hasher));
        hasher.finish()
    };
    recording.readings().iter().map(hash).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::sensor::{ReadingUnit, SensorParameters};
    use calibrant_core::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};

    /// Standard deviation of the noise, m/s².
    const SD: f64 = 0.01;

    fn recorded(sd_mps2: f64, seed: u64) -> Recording {
        let setup = HoldsSimulation {
            poses: 20,
            hold_s: 4.0,
            turn_s: 1.0,
            rate_hz: 100.0,
            gravity_mps2: 9.81,
            between_holds_sd_mps2: 0.0,
        };
        let unit = ReadingUnit::MetrePerSecondSquared;
        let mut rng = stream(seed, Purpose::Sensor, 0);
        simulate_holds(&SensorParameters::identity(), &Vector3::repeat(sd_mps2), unit, &setup, &mut rng).0
    }

    /// One of the recordings of a machine that repeats its poses, in steps.
    fn repeated(step: f64, seed: u64) -> Recording {
        let mut recording = recorded(0.0, 7);
        let noise = recorded(SD, seed);
        for (y, n) in recording.readings_mut().iter_mut().zip(noise.readings()) {
            // the noise of a recording, whatever its poses
            *y = (*y + n.map(|n| (n * 1e3).fract() * 2.0 * SD)).map(|y| (y / step).round() * step);
        }
        recording
    }

    #[test]
    fn repetitions_share_no_samples() {
        for step in [1e-7, 0.01, 0.05, 0.2, 1e4] {
            assert!(!share_samples(&repeated(step, 8), &repeated(step, 9)), "{step}");
        }
    }

    #[test]
    fn parts_and_overlapping_parts_share_samples() {
        for step in [1e-7, 0.05] {
            let whole = repeated(step, 8);
            let n = whole.len();
            let part = |range: std::ops::Range<usize>| whole.only(|k| range.contains(&k)).later_by(1e3);
            for (one, other) in
                [(0..n, 0..n), (0..n, n / 3..n / 2), (0..2 * n / 3, n / 4..n), (n / 2 + 3..n, 0..n)]
            {
                assert!(share_samples(&part(one.clone()), &part(other.clone())), "{step} {one:?} {other:?}");
            }
            assert!(!share_samples(&part(0..n / 2), &part(n / 2..n)), "{step}");
        }
    }
}

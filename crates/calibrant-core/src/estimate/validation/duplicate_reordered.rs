//! Are two recordings one whose readings come in another order, or at other times: reversed, its halves exchanged, its clock scaled?
//!
//! Blocks of successive readings in holds are looked up, bit by bit and whatever the order within: the sum of the readings' hashes is that of a block. Where readings are coarse or constant, blocks
//! repeat themselves by chance; only those count that a recording has once. Noise of its own leaves them no second time, and where noise is too small to be seen there are none.

use crate::motion::Hold;
use crate::sensor::Recording;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Readings in a block.
const BLOCK: usize = 16;
/// With fewer blocks that a recording has once nothing is said.
const LEAST_BLOCKS: usize = 16;
/// So many of them are found where the readings are the same, all but those across the ends of what was exchanged; in a part of the recording, its share of them.
const LEAST_FOUND_SHARE: f64 = 0.8;

/// The share of a recording's blocks of 16 readings in its holds that another has as well, bit by bit, at any time and in any order, where it is so high that the readings are the same;
/// `None` where they are not.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{find_holds, readings_in_common};
/// use calibrant_core::sensor::{ReadingUnit, SensorParameters};
/// use calibrant_core::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};
/// use nalgebra::Vector3;
///
/// let setup = HoldsSimulation { poses: 12, hold_s: 4.0, turn_s: 1.5, rate_hz: 100.0, gravity_mps2: 9.81, between_holds_sd_mps2: 0.0 };
/// let record = |seed| {
///     let unit = ReadingUnit::MetrePerSecondSquared;
///     simulate_holds(&SensorParameters::identity(), &Vector3::repeat(0.01), unit, &setup, &mut stream(seed, Purpose::Sensor, 0)).0
/// };
/// let (one, other) = (record(1), record(2));
/// let mut reversed = one.clone();
/// reversed.readings.reverse();
/// let holds = find_holds(&one, 1.0)?;
/// assert_eq!(readings_in_common(&one, &holds, &reversed), Some(1.0));
/// assert_eq!(readings_in_common(&one, &holds, &other), None);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn readings_in_common(one: &Recording, holds: &[Hold], other: &Recording) -> Option<f64> {
    let (count, found) = blocks_in_common(one, holds, other);
    let share = found as f64 / count as f64;
    let part = (other.len() as f64 / one.len() as f64).min(1.0);
    (count >= LEAST_BLOCKS && found >= LEAST_BLOCKS && share > LEAST_FOUND_SHARE * part).then_some(share)
}

/// How many blocks the one recording has once, and how many of them the other has.
fn blocks_in_common(one: &Recording, holds: &[Hold], other: &Recording) -> (usize, usize) {
    let hashes: Vec<u64> = one.readings.iter().map(hash).collect();
    // of each block, whether it occurs again, and whether the other recording has it
    let mut blocks: HashMap<u64, (bool, bool), BuildHasherDefault<Hashed>> = HashMap::default();
    let spans = holds.iter().map(|hold| one.between(hold.start_s, hold.end_s));
    let firsts: Vec<usize> = spans
        .flat_map(|span| span.clone().step_by(BLOCK).filter(move |first| first + BLOCK <= span.end))
        .collect();
    let sums_of_one: Vec<u64> = sums(&hashes).collect();
    for first in &firsts {
        blocks.entry(sums_of_one[*first]).and_modify(|(again, _)| *again = true).or_insert((false, false));
    }
    let mut firsts = firsts.into_iter().peekable();
    for (first, sum) in sums_of_one.iter().enumerate() {
        if firsts.next_if_eq(&first).is_none()
            && let Some((again, _)) = blocks.get_mut(sum)
        {
            *again = true;
        }
    }
    let hashes: Vec<u64> = other.readings.iter().map(hash).collect();
    for sum in sums(&hashes) {
        if let Some((_, found)) = blocks.get_mut(&sum) {
            *found = true;
        }
    }
    let once = blocks.values().filter(|(again, _)| !again);
    once.fold((0, 0), |(count, found), (_, is)| (count + 1, found + usize::from(*is)))
}

/// The sums of every so many successive hashes.
fn sums(hashes: &[u64]) -> impl Iterator<Item = u64> {
    let mut sum = hashes.iter().take(BLOCK - 1).fold(0, |sum: u64, hash| sum.wrapping_add(*hash));
    hashes.iter().skip(BLOCK - 1).enumerate().map(move |(first, entering)| {
        sum = sum.wrapping_add(*entering);
        let whole = sum;
        sum = sum.wrapping_sub(hashes[first]);
        whole
    })
}

/// Of the bits of a reading, well mixed (the finaliser of `MurmurHash3`).
fn hash(reading: &Vector3<f64>) -> u64 {
    reading.iter().fold(0, |hash: u64, value| {
        let mut bits = hash.rotate_left(21) ^ value.to_bits();
        bits = (bits ^ (bits >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        bits = (bits ^ (bits >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        bits ^ (bits >> 33)
    })
}

/// The keys are hashes already.
#[derive(Default)]
struct Hashed(u64);

impl Hasher for Hashed {
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = self.0.rotate_left(8) ^ u64::from(*byte);
        }
    }

    fn write_u64(&mut self, value: u64) {
        self.0 = value;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::holds_between;
    use crate::sensor::{ReadingUnit, SensorParameters};
    use crate::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};

    /// Steps of five, twenty and a million times the noise, of a machine that repeats its poses.
    #[test]
    fn coarse_readings_leave_a_wide_margin() {
        let setup = HoldsSimulation {
            poses: 20,
            hold_s: 4.0,
            turn_s: 1.0,
            rate_hz: 100.0,
            gravity_mps2: 9.81,
            between_holds_sd_mps2: 0.0,
        };
        let unit = ReadingUnit::MetrePerSecondSquared;
        let simulate = |sd: f64, seed: u64| {
            let mut rng = stream(seed, Purpose::Sensor, 0);
            simulate_holds(&SensorParameters::identity(), &Vector3::repeat(sd), unit, &setup, &mut rng).0
        };
        let quiet = simulate(0.0, 7);
        for step in [1e-7, 0.01, 0.05, 0.2, 1e4] {
            let record = |seed: u64| {
                let mut recording = quiet.clone();
                let noise = simulate(0.01, seed);
                for (y, n) in recording.readings.iter_mut().zip(&noise.readings) {
                    // the noise of a recording, whatever its poses
                    *y = (*y + n.map(|n| (n * 1e3).fract() * 0.02)).map(|y| (y / step).round() * step);
                }
                recording
            };
            let (one, other) = (record(8), record(9));
            let intervals: Vec<(f64, f64)> =
                (0..20).map(|j| 5.0 * f64::from(j)).map(|t| (t + 0.1, t + 3.9)).collect();
            let holds = holds_between(&one, &intervals).expect("samples");
            let (count, found) = blocks_in_common(&one, &holds, &other);
            println!("{step}: {found} of {count}");
            assert!(found as f64 <= 0.5 * count as f64, "{step}: {found} of {count}");
        }
    }
}

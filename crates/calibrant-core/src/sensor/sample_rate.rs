//! The sample rate of a sensor, from times that may be coarse, jitter, or lack samples.

use super::extremes::{greater, lesser};

/// Number of steps among which the median is first sought.
const MEDIAN_STEPS: usize = 512;
/// Steps that differ from the median by this share are uneven.
const UNEVEN: f64 = 0.01;
/// Uneven steps are sought first in eight blocks of this number of samples.
const FIRST_BLOCK: usize = 64;
/// Uneven times are judged in blocks of this number of samples.
const BLOCK: usize = 512;
/// Largest number of blocks that are judged, spread evenly.
const MOST_BLOCKS: usize = 40;
/// Share of the steps near the median from which on there is a usual step.
const USUAL_SHARE: f64 = 0.48;
/// A step of this number of medians is a pause.
const PAUSE: f64 = 20.0;
/// Times in units longer than this, s, seldom come from sensors with such a rate.
const COARSE_S: f64 = 1.1e-3;
/// Largest relative difference between the mean step of times that jitter and the mean of the steps near the
/// median. Samples that are lost evenly make more.
const JITTERED: f64 = 0.1;
/// Where samples are missing, this share of the steps is a whole multiple of the least one.
const WHOLE_SHARE: f64 = 0.9;
/// A multiple is whole within this share of the least step.
const MULTIPLE_TOLERANCE: f64 = 0.02;

/// The inverse of the usual step between times in s, Hz; 0 for fewer than two.
///
/// The usual step is the median step where steps are even. The blocks show what makes other steps uneven.
#[must_use]
pub fn rate_hz(times_s: &[f64]) -> f64 {
    if times_s.len() < 2 {
        return 0.0;
    }
    let median = median_step(times_s);
    let is_uneven =
        |block: &[f64]| block.array_windows().any(|[one, next]| ((next - one) / median - 1.0).abs() > UNEVEN);
    let blocks = times_s.chunks((times_s.len() / 8).max(1)).map(|part| &part[..part.len().min(FIRST_BLOCK)]);
    if times_s.len() < FIRST_BLOCK || !blocks.into_iter().any(is_uneven) {
        return 1.0 / median;
    }
    let blocks = times_s.chunks(BLOCK);
    let apart = blocks.len().div_ceil(MOST_BLOCKS);
    let of_one_piece = |block: &Block| block.longest < PAUSE * median;
    let blocks: Vec<Block> = blocks.step_by(apart).filter_map(Block::of).filter(of_one_piece).collect();
    let usual = mean_of_most(&blocks, Block::is_coarse)
        .or_else(|| least_step(times_s, median))
        .unwrap_or_else(|| {
            let near = mean_near(times_s, median);
            mean_of_most(&blocks, Block::jitters)
                .filter(|mean| (mean / near - 1.0).abs() < JITTERED)
                .unwrap_or(near)
        });
    if (usual / median - 1.0).abs() > UNEVEN { 1.0 / usual } else { 1.0 / median }
}

/// The share of the samples that is missing between times, in steps of less than `gap_s`. It is 0 where a
/// slightly lower rate explains the steps as well.
#[must_use]
pub fn missing(times_s: &[f64], rate_hz: f64, gap_s: f64) -> f64 {
    let (mean, _) = mean(steps(times_s).filter(|step| *step <= gap_s));
    let missing = 1.0 - 1.0 / (mean * rate_hz);
    if missing > UNEVEN { missing } else { 0.0 }
}

/// The times from each sample to the next, s.
fn steps(times_s: &[f64]) -> impl ExactSizeIterator<Item = f64> {
    times_s.array_windows().map(|[one, next]| next - one)
}

/// Consecutive samples that are judged together.
struct Block {
    mean: f64,
    shortest: f64,
    longest: f64,
    /// Range of the differences between these times and those of an even clock.
    off: f64,
}

impl Block {
    fn of(times_s: &[f64]) -> Option<Self> {
        let (&[first, .., last], true) = (times_s, times_s.len() >= FIRST_BLOCK) else { return None };
        let mean = (last - first) / (times_s.len() - 1) as f64;
        let early = times_s.iter().enumerate().map(|(k, time)| time - first - mean * k as f64);
        let [before, after] =
            early.fold([0.0, 0.0], |[before, after], off| [lesser(before, off), greater(after, off)]);
        Some(Self {
            mean,
            shortest: steps(times_s).fold(f64::INFINITY, lesser),
            longest: steps(times_s).fold(0.0, greater),
            off: after - before,
        })
    }

    /// Is the clock even, but read in coarse units, as at 800 Hz in whole milliseconds? Steps then differ by
    /// one unit, and so do the times from those of the clock.
    ///
    /// Steps of one and two units also occur with lost samples, if the unit is the distance of samples.
    fn is_coarse(&self) -> bool {
        let unit = self.longest - self.shortest;
        let most = if self.shortest < COARSE_S { 1.0 + MULTIPLE_TOLERANCE } else { 1.0 - MULTIPLE_TOLERANCE };
        unit <= most * self.shortest && self.off <= 1.5 * unit
    }

    /// Is the clock even, but each time off by itself? Times are then not farther off than steps. Where
    /// samples are lost here and there, the later times are farther off.
    fn jitters(&self) -> bool {
        let range = self.longest - self.shortest;
        range <= 4.0 * self.mean && self.off <= 1.2 * range
    }
}

/// The median of the mean steps of the blocks for which `is_such` holds, if these are most blocks.
fn mean_of_most(blocks: &[Block], is_such: fn(&Block) -> bool) -> Option<f64> {
    let mut means: Vec<f64> = blocks.iter().filter(|block| is_such(block)).map(|block| block.mean).collect();
    let middle = means.len() / 2;
    (2 * means.len() > blocks.len()).then(|| *means.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The least usual step, if most steps are whole multiples of it. Longer steps lack samples.
fn least_step(times_s: &[f64], median: f64) -> Option<f64> {
    let mut some: Vec<f64> = steps(times_s).step_by(times_s.len().div_ceil(MEDIAN_STEPS)).collect();
    some.sort_unstable_by(f64::total_cmp);
    let least = some[some.len() / 20];
    let multiple =
        |step: f64| Some((step / least).round()).filter(|n| (step / least - n).abs() < MULTIPLE_TOLERANCE);
    let whole = some.iter().filter(|step| multiple(**step).is_some()).count();
    // where samples are lost by chance, one step is more frequent than two: otherwise it is the tick of a clock
    let count = |n: f64| some.iter().filter(|step| multiple(**step) == Some(n)).count();
    if count(2.0) > count(1.0) {
        return None;
    }
    // of coarse times each step is a multiple
    let fewest = if least < COARSE_S { 1.0 - MULTIPLE_TOLERANCE } else { 0.3 };
    let is_usual = least > fewest * median && whole as f64 > WHOLE_SHARE * some.len() as f64;
    is_usual.then(|| mean(steps(times_s).filter(|step| multiple(*step) == Some(1.0))).0)
}

/// The mean of the steps within half of the median of it. Times of arrival have fewer than half of their
/// steps there: then the mean of all steps but pauses.
fn mean_near(times_s: &[f64], median: f64) -> f64 {
    let (near, count) = mean(steps(times_s).filter(|step| (0.5..=1.5).contains(&(step / median))));
    match count < USUAL_SHARE * steps(times_s).len() as f64 {
        true => mean(steps(times_s).filter(|step| *step <= PAUSE * median)).0,
        false => near,
    }
}

/// The mean of steps, and their number.
fn mean(steps: impl Iterator<Item = f64>) -> (f64, f64) {
    let (sum, count) = steps.fold((0.0, 0.0), |(sum, count), step| (sum + step, count + 1.0));
    (sum / count, count)
}

/// The median step between at least two times, s.
fn median_step(times_s: &[f64]) -> f64 {
    let count = steps(times_s).len();
    let middle = count / 2;
    // some of the steps show about where the median is: the others are only compared with that
    let mut some: Vec<f64> = steps(times_s).step_by(count.div_ceil(MEDIAN_STEPS)).collect();
    some.sort_unstable_by(f64::total_cmp);
    let (low, high) = (some[some.len() * 2 / 5], some[some.len() * 3 / 5]);
    let (mut lower, mut not_higher) = (0, 0);
    for step in steps(times_s) {
        lower += usize::from(step < low);
        not_higher += usize::from(step <= high);
    }
    let is_between = (lower..not_higher).contains(&middle);
    if is_between && low == high {
        return low;
    }
    let (mut left, lower) = match is_between {
        true => (steps(times_s).filter(|step| (low..=high).contains(step)).collect(), lower),
        false => (steps(times_s).collect::<Vec<f64>>(), 0),
    };
    *left.select_nth_unstable_by(middle - lower, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Purpose, stream};
    use rand::RngExt;
    use rand_distr::{Distribution, Exp1, StandardNormal};

    #[test]
    fn the_rate_of_uneven_times_is_the_true_one() {
        let at = |time: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..40_000).map(time).collect() };
        // at 400 Hz in whole milliseconds, and at 240 Hz
        for true_hz in [400.0, 240.0, 128.0] {
            let whole = at(&|k| (1e3 * k as f64 / true_hz).floor() / 1e3);
            let rate = rate_hz(&whole);
            assert!((rate / true_hz - 1.0).abs() < 1e-3, "{rate} {true_hz}");
            // three in ten samples lost, and one long pause
            let kept = |k: &usize| (k * 7919) % 10 >= 3;
            let some: Vec<f64> =
                (0..40_000).filter(kept).map(|k| whole[k] + if k > 20_000 { 60.0 } else { 0.0 }).collect();
            assert!((rate_hz(&some) / true_hz - 1.0).abs() < 0.01, "{} {true_hz}", rate_hz(&some));
        }
        // times of arrival: later by up to four steps, in order
        let mut late = at(&|k| (k as f64 + 4.0 * ((k * 7919 % 1009) as f64 / 1009.0).powi(2)) * 0.0025);
        late.sort_by(f64::total_cmp);
        assert!((rate_hz(&late) / 400.0 - 1.0).abs() < 0.02, "{}", rate_hz(&late));
    }

    /// Times of an even clock in s, rounded to a unit.
    fn rounded(rate: f64, unit: f64) -> Vec<f64> {
        (0..20_000).map(|k| (k as f64 / rate / unit).round() * unit).collect()
    }

    #[test]
    fn coarse_times_have_the_rate_of_their_clock() {
        for true_hz in [477.0, 600.0, 700.0, 800.0, 900.0, 1000.0] {
            let times = rounded(true_hz, 1e-3);
            let rate = rate_hz(&times);
            assert!((rate / true_hz - 1.0).abs() < 2e-3, "{rate} {true_hz}");
            assert_eq!(missing(&times, rate, 0.02), 0.0, "{true_hz}");
        }
    }

    #[test]
    fn samples_that_are_missing_are_counted() {
        // a lost sample is equally likely after every step
        let mut rng = stream(3, Purpose::Sensor, 0);
        for (rate, lost) in [(200.0, 0.03), (200.0, 0.3), (200.0, 0.6), (104.0, 0.1)] {
            let even = (0..20_000).map(|k| k as f64 / rate);
            let times: Vec<f64> = even.filter(|_| !rng.random_bool(lost)).collect();
            let found = rate_hz(&times);
            assert!((found / rate - 1.0).abs() < 1e-3, "{found} {rate} {lost}");
            let share = missing(&times, found, 1.0);
            // sd of a share
            assert!((share - lost).abs() < 4.0 * (lost * (1.0 - lost) / 20_000.0).sqrt(), "{share} {lost}");
        }
    }

    #[test]
    fn times_that_jitter_have_the_rate_of_their_clock() {
        let mut rng = stream(4, Purpose::Sensor, 0);
        for (sd_s, late_s) in [(0.0002, 0.0), (0.001, 0.0), (0.002, 0.0), (0.0, 0.003)] {
            let mut late = || -> f64 {
                let normal: f64 = StandardNormal.sample(&mut rng);
                let delay: f64 = Exp1.sample(&mut rng);
                sd_s * normal + late_s * delay
            };
            let mut times: Vec<f64> = (0..20_000).map(|k| k as f64 * 0.005 + late()).collect();
            times.sort_by(f64::total_cmp);
            let rate = rate_hz(&times);
            // steps within 1 % of the median are the median's
            assert!((rate / 200.0 - 1.0).abs() < 0.01, "{rate} {sd_s} {late_s}");
            assert_eq!(missing(&times, rate, 0.025), 0.0, "{sd_s} {late_s}");
        }
    }

    #[test]
    fn the_rate_is_that_of_the_median_step() {
        assert_eq!((rate_hz(&[]), rate_hz(&[1.0])), (0.0, 0.0));
        // steps of -1, 0, 0.25, 0.5 and 8
        assert_eq!(rate_hz(&[0.0, 0.5, 8.5, 7.5, 7.5, 7.75]), 4.0);
        // every step different; all equal; a few that represent the others badly
        let irregular = |k: usize| 0.01 + 1e-3 * (k as f64).sin();
        let every_64th = |k: usize| if k.is_multiple_of(64) { 0.5 } else { 0.01 + 1e-9 * k as f64 };
        for (count, step) in [
            (1000, &irregular as &dyn Fn(usize) -> f64),
            (50_001, &irregular),
            (50_000, &|_| 0.25),
            (512 * 64, &every_64th),
        ] {
            let mut times = vec![0.0];
            (0..count).for_each(|k| times.push(times[k] + step(k)));
            let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            steps.sort_by(f64::total_cmp);
            assert_eq!(rate_hz(&times), 1.0 / steps[steps.len() / 2]);
        }
    }
}

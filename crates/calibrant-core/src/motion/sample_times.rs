//! The times of a recording's samples on a motion, and the sums over them that the information needs.

use super::JerkControlledMotion;

/// Sample times `t_j = j/f_s` from the start of a motion to its end, both included: `M = T f_s + 1`.
#[must_use]
pub fn sample_times(motion: &JerkControlledMotion, rate_hz: f64) -> Vec<f64> {
    let start = motion.times_s()[0];
    (0..sample_count(motion, rate_hz) as usize).map(|j| start + j as f64 / rate_hz).collect()
}

/// Number of the [`sample_times`], `M`.
#[must_use]
pub fn sample_count(motion: &JerkControlledMotion, rate_hz: f64) -> f64 {
    let duration = motion.times_s()[motion.intervals()] - motion.times_s()[0];
    (duration * rate_hz * (1.0 + 1e-12)).floor() + 1.0
}

/// Sums over the samples of one interval of their place λ in it, 0 to 1. The information of a recording
/// depends on its samples only through these sums.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct IntervalSums {
    /// Number of samples.
    pub samples: f64,
    /// `Σ (1 − λ)`
    pub s0: f64,
    /// `Σ λ`
    pub s1: f64,
    /// `Σ (1 − λ)²`
    pub m00: f64,
    /// `Σ λ (1 − λ)`
    pub m01: f64,
    /// `Σ λ²`
    pub m11: f64,
}

impl IntervalSums {
    /// The sums of each interval, for samples at `rate_hz` from the start of the motion to its end. A sample at a breakpoint belongs to the interval that
    /// begins there.
    ///
    /// The samples are evenly spaced, so that the sums follow from their number `n`, the middle `c` of the first and the last, and what lies between these,
    /// `w`: `Σ λ = n c` and `Σ (λ − c)² = n (n + 1) w² / (12 (n − 1))`. The time taken does not depend on the rate.
    #[must_use]
    pub fn all(motion: &JerkControlledMotion, rate_hz: f64) -> Vec<Self> {
        let (times_s, intervals) = (motion.times_s(), motion.intervals());
        let time_s = |j: f64| times_s[0] + j / rate_hz;
        let count = sample_count(motion, rate_hz);
        // the first sample that is not before a time; the division may round to its neighbour
        let first_from = |time: f64| {
            let near = ((time - times_s[0]) * rate_hz).floor();
            let found = [near - 1.0, near, near + 1.0].into_iter().find(|&j| time_s(j) >= time);
            found.unwrap_or(near + 2.0).min(count)
        };
        let mut begin = 0.0;
        let of_interval = |i: usize| {
            let (first, next) = (begin, if i + 1 == intervals { count } else { first_from(times_s[i + 1]) });
            begin = next;
            let place = |j: f64| ((time_s(j) - times_s[i]) / motion.interval_s(i)).clamp(0.0, 1.0);
            if next > first {
                Self::evenly_spaced(next - first, place(first), place(next - 1.0))
            } else {
                Self::default()
            }
        };
        (0..intervals).map(of_interval).collect()
    }

    /// Of `samples` places, evenly spaced from `first` to `last`.
    fn evenly_spaced(samples: f64, first: f64, last: f64) -> Self {
        let (middle, width) = (0.5 * (first + last), last - first);
        let rest = 1.0 - middle;
        let spread = if samples > 1.0 {
            samples * (samples + 1.0) / (12.0 * (samples - 1.0)) * width * width
        } else {
            0.0
        };
        Self {
            samples,
            s0: samples * rest,
            s1: samples * middle,
            m00: samples * rest * rest + spread,
            m01: samples * rest * middle - spread,
            m11: samples * middle * middle + spread,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Sample by sample.
    fn added_up(motion: &JerkControlledMotion, rate_hz: f64) -> Vec<IntervalSums> {
        let mut sums = vec![IntervalSums::default(); motion.intervals()];
        for t in sample_times(motion, rate_hz) {
            let (i, lambda) = motion.locate(t);
            let (sum, rest) = (&mut sums[i], 1.0 - lambda);
            sum.samples += 1.0;
            sum.s0 += rest;
            sum.s1 += lambda;
            sum.m00 += rest * rest;
            sum.m01 += rest * lambda;
            sum.m11 += lambda * lambda;
        }
        sums
    }

    #[test]
    fn the_sums_are_those_of_the_samples() {
        let uneven = vec![-1.7, -1.6, 0.3, 0.30001, 1.3, 7.0];
        let even: Vec<f64> = (0..=40).map(|k| 0.1 * f64::from(k)).collect();
        for times_s in [uneven, even, vec![0.0, 1.0]] {
            let nodes = vec![Vector3::zeros(); times_s.len()];
            let motion = JerkControlledMotion::new(times_s, nodes).expect("a motion");
            for rate_hz in [1e-3, 0.7, 1.0, 3.0, 10.0, 100.0, 999.9, 1e4, 1e5] {
                let all = IntervalSums::all(&motion, rate_hz);
                for (of, slow) in all.iter().zip(added_up(&motion, rate_hz)) {
                    assert!(
                        (of.samples - slow.samples).abs() < 0.5,
                        "{rate_hz} Hz: {} and {}",
                        of.samples,
                        slow.samples
                    );
                    for (a, b) in [
                        (of.s0, slow.s0),
                        (of.s1, slow.s1),
                        (of.m00, slow.m00),
                        (of.m01, slow.m01),
                        (of.m11, slow.m11),
                    ] {
                        assert!((a - b).abs() <= 1e-11 * slow.samples, "{rate_hz} Hz: {a} and {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_trillion_samples_take_no_time() {
        let motion = JerkControlledMotion::uniform(0.5, vec![Vector3::zeros(); 3]).expect("a motion");
        // the integrals over a second: 1/2, 1/3 and 1/6
        for sums in IntervalSums::all(&motion, 2e12) {
            let relative = |value: f64, integral: f64| (value / (1e12 * integral) - 1.0).abs() < 1e-11;
            assert!(relative(sums.s1, 0.5) && relative(sums.m11, 1.0 / 3.0) && relative(sums.m01, 1.0 / 6.0));
        }
    }
}

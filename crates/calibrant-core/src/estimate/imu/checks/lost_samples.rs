//! Samples that are lost while the times stay even: the integrals of the rates are then too small.
//!
//! Where a sample is lost, the gyroscope changes by one step more than before and after. With `s` the mean of the two steps before and the two after and `d`
//! the step between them less `s`, `r = d·s/s·s` is 1 there, and 0 elsewhere. Steps show it that are far above the noise, and whose neighbours are alike: no knock.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::samples::SamplesLost;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::{Recording, SensorKind, quantile};
use nalgebra::Vector3;

/// Least `s·s` in units of the noise, squared.
const CLEAR: f64 = 200.0;
/// Largest sum of squares that `s` and `r` leave of the five steps: in units of the noise, or as a share of `s·s`.
const MISFIT: f64 = 60.0;
const MISFIT_SHARE: f64 = 0.1;
/// `r` is this close to 1 or 0.
const CLOSE: f64 = 0.3;
/// Steps in time are equal within this share.
const EVEN: f64 = 0.2;
/// A smaller share of lost samples is not told from knocks, nor are fewer jumps.
const LEAST_SHARE: f64 = 0.005;
const FEWEST: usize = 4;

/// Are samples of the gyroscope lost?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    evidence.problem.recording[SensorKind::Gyroscope].as_ref().and_then(lost_samples).into_iter().collect()
}

fn lost_samples(gyroscope: &Recording) -> Option<Diagnostic> {
    let readings = &gyroscope.readings;
    let third = |[a, b, c, d]: &[Vector3<f64>; 4]| d - a + (b - c) * 3.0;
    let thirds: Vec<Vector3<f64>> = readings.array_windows().map(third).collect();
    let median = |axis: usize| quantile(thirds.iter().map(|d| d[axis].abs()).collect(), 0.5);
    // the variance of a third difference is 20 times that of a sample
    let noise = Vector3::new(median(0)?, median(1)?, median(2)?) / (0.6745 * 20f64.sqrt());
    let (mut lost, mut whole) = (0, 0);
    for (times, readings) in gyroscope.times_s.array_windows::<6>().zip(readings.array_windows::<6>()) {
        let step_s = (times[5] - times[0]) / 5.0;
        let is_even = times.array_windows().all(|[from, to]| (to - from - step_s).abs() < EVEN * step_s);
        let steps: [Vector3<f64>; 5] =
            std::array::from_fn(|k| (readings[k + 1] - readings[k]).component_div(&noise));
        let usual = (steps[0] + steps[1] + steps[3] + steps[4]) * 0.25;
        let beyond = steps[2] - usual;
        let clear = usual.norm_squared();
        if !is_even || clear.is_nan() || clear < CLEAR {
            continue;
        }
        let ratio = beyond.dot(&usual) / clear;
        let of_neighbours: f64 = [0, 1, 3, 4].iter().map(|&k| (steps[k] - usual).norm_squared()).sum();
        let misfit = of_neighbours + (beyond - usual * ratio).norm_squared();
        if misfit < MISFIT.max(MISFIT_SHARE * clear) {
            lost += usize::from((ratio - 1.0).abs() < CLOSE);
            whole += usize::from(ratio.abs() < CLOSE);
        }
    }
    let lost_share = lost as f64 / (lost + whole).max(1) as f64;
    (lost >= FEWEST && lost_share > LEAST_SHARE)
        .then_some(Diagnostic::from(SamplesLost { lost_share, jumps: lost }))
}

//! Samples of a motion that are far from all others: a lost bit, a loose contact, a knock.
//!
//! One sample of 55 m/s² makes the least squares follow it, and the standard deviations do not show it. So outliers are cut before the fit.
//!
//! # What an outlier is
//! Between two nodes the acceleration is linear in time, and so is the reading, whatever bias, matrix and motion are. So the readings of an axis
//! are fitted by a continuous line with a corner at each node. Where the motion is known and the samples are few, they are fitted by the commanded
//! motion itself: `y = b + S α(t)`, with all entries of a row of `S`. Both fits are linear, and need no start. Neither needs gravity, which is part of `b`.
//!
//! The residual of each sample is divided by its own standard deviation, `σ √(1 − h)` with the leverage `h` (data snooping, `baarda1968`): the
//! outlier is then the largest, even where the fit follows it. `σ` is the median of the absolute values, or the given noise if that is
//! larger. An outlier is beyond [`FAR`] of them. Only those beyond half of the farthest are cut at once, since an outlier
//! spreads over its neighbours; then the fit is repeated.
//!
//! # What is none
//! Where more than one sample in [`MOST_ONE_IN`] is far off, or several in a row are, the residuals are not outliers: the noise has a heavy tail,
//! or the sensor did not follow the motion. Nothing is cut then, and a diagnostic says so.

use super::alignment::aligned;
use super::holds::median;
use super::problem::{CalibrationProblem, Stimulus};
use super::studentised_fit::StudentisedFit;
use crate::diagnostic::noise::NoiseOutliers;
use crate::diagnostic::{Diagnostic, samples};
use crate::motion::{CommandedMotion, Trust};
use crate::sensor::{Axis, Recording, SensorKind, Spikes};

/// An outlier is this many robust standard deviations off.
const FAR: f64 = 7.0;
/// Samples for each node from which a line with corners leaves enough to check them.
const ENOUGH: usize = 3;
/// No more than one sample in this number may be an outlier.
const MOST_ONE_IN: usize = 50;
/// So many consecutive samples that are far off are no outliers.
const IN_A_ROW: usize = 3;
/// Standard deviation of normal noise over the median of its absolute deviations.
const SD_OVER_MAD: f64 = 1.4826;

/// The farthest of the outliers.
#[derive(Clone, Copy)]
struct Farthest {
    axis: Axis,
    sample: usize,
    deviations: f64,
}

/// The recording of a motion without outliers, and what was cut. `None` where there are none, or where the problem is not one of a motion.
///
/// The recording is not there where the samples that are far off are too many to be outliers.
#[must_use]
pub fn without_motion_outliers(problem: &CalibrationProblem<'_>) -> Option<(Option<Recording>, Diagnostic)> {
    let Stimulus::Motion(command) = problem.stimulus else { return None };
    let recording = problem.recording;
    let on_clock = aligned(recording, command, problem.sensor.axes).ok()?.on_motion_clock(recording);
    let times = command.motion.times_s();
    let within = |k: &usize| (times[0]..=times[times.len() - 1]).contains(&on_clock.times_s[*k]);
    let mut kept: Vec<usize> = (0..recording.len()).filter(within).collect();
    let most = (kept.len() / MOST_ONE_IN).max(1);
    let mut cut = Vec::new();
    let mut farthest: Option<Farthest> = None;
    let mut is_too_many = false;
    while !is_too_many {
        let found = outliers(problem, command, &on_clock, &kept);
        let Some(first) = found.iter().max_by(|one, other| one.deviations.total_cmp(&other.deviations))
        else {
            break;
        };
        farthest = farthest.filter(|before| before.deviations >= first.deviations).or(Some(*first));
        let at_once = found.iter().filter(|outlier| outlier.deviations >= 0.5 * first.deviations);
        cut.extend(at_once.map(|outlier| outlier.sample));
        cut.sort_unstable();
        cut.dedup();
        kept.retain(|sample| cut.binary_search(sample).is_err());
        is_too_many = cut.len() > most || are_in_a_row(&cut);
    }
    let Farthest { axis, sample, deviations } = farthest?;
    let (reading, time_s) = (recording.readings[sample][axis.index()], recording.times_s[sample]);
    let (sensor_kind, unit) = (SensorKind::Accelerometer, recording.unit);
    if is_too_many {
        let (outliers, samples) = (cut.len(), recording.len());
        return Some((
            None,
            Diagnostic::from(NoiseOutliers {
                sensor_kind,
                axis,
                unit,
                outliers,
                samples,
                reading,
                time_s,
                deviations,
                left_out: false,
                white_noise_ratio: None,
            }),
        ));
    }
    let is_kept = |k: &usize| cut.binary_search(k).is_err();
    let clean = Recording {
        times_s: (0..recording.len()).filter(is_kept).map(|k| recording.times_s[k]).collect(),
        readings: (0..recording.len()).filter(is_kept).map(|k| recording.readings[k]).collect(),
        ..recording.clone()
    };
    let spikes = Spikes { samples: Vec::new(), cut, axis, time_s, reading, deviations };
    Some((Some(clean), samples::Spikes::of(&spikes, sensor_kind, unit).into()))
}

/// Are some of these samples consecutive?
fn are_in_a_row(samples: &[usize]) -> bool {
    samples.windows(IN_A_ROW).any(|row| row[IN_A_ROW - 1] - row[0] == IN_A_ROW - 1)
}

/// The samples of all axes that are far off.
fn outliers(
    problem: &CalibrationProblem<'_>,
    command: &CommandedMotion,
    recording: &Recording,
    kept: &[usize],
) -> Vec<Farthest> {
    let times: Vec<f64> = kept.iter().map(|k| recording.times_s[*k]).collect();
    let fit = match command.trust {
        Trust::Known if times.len() < ENOUGH * (command.motion.intervals() + 1) => {
            StudentisedFit::of_known(command, &times)
        }
        _ => StudentisedFit::of_corners(command, &times),
    };
    if kept.is_empty() {
        return Vec::new();
    }
    let of_axis = |&axis: &Axis| {
        let readings: Vec<f64> = kept.iter().map(|k| recording.readings[*k][axis.index()]).collect();
        let residuals = fit.as_ref().map_or_else(Vec::new, |fit| fit.residuals(&readings));
        let sizes: Vec<f64> = residuals.iter().map(|residual| residual.abs()).collect();
        let median = median(sizes.clone());
        let gain = problem.sensor.gain.unwrap_or_default();
        let given = problem.sensor.noise(&gain).map_or(0.0, |noise| noise[axis.index()]);
        let sd = (SD_OVER_MAD * median).max(if given.is_finite() { given } else { 0.0 });
        let outlier = |(k, size): (usize, &f64)| {
            let deviations = size / sd;
            (sd > 0.0 && deviations > FAR).then_some(Farthest { axis, sample: kept[k], deviations })
        };
        sizes.iter().enumerate().filter_map(outlier).collect::<Vec<_>>()
    };
    problem.sensor.active_axes().iter().flat_map(of_axis).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Check;
    use crate::motion::{KnownEnds, Limits, MotionClock};
    use crate::sensor::Sensor;
    use crate::simulate::{Purpose, draw_sensor, initial_motion, sample_times, simulate_recording, stream};

    const TRUSTS: [Trust; 2] = [Trust::Known, Trust::Unknown];

    /// What is cut of the recording of a motion after this change, and whether the recording is there.
    fn cut(trust: Trust, seed: u64, change: impl Fn(&mut Recording)) -> Option<(bool, Diagnostic)> {
        let sensor = Sensor::memsic_mxd2020u();
        let mut rng = stream(seed, Purpose::Motion, 0);
        let motion = initial_motion(10, 1.0, 3, &Limits::default(), &mut rng).expect("admissible");
        let truth = draw_sensor(&sensor, &mut rng);
        let noise = sensor.noise_mps2.expect("known");
        let times = sample_times(&motion, 10.0);
        let mut recording = simulate_recording(&truth, &noise, sensor.unit, 3, &motion, &times, &mut rng);
        change(&mut recording);
        let command = CommandedMotion {
            motion,
            trust,
            known_ends: KnownEnds::Both,
            gravity: None,
            clock: MotionClock::default(),
        };
        let stimulus = Stimulus::Motion(&command);
        let problem = CalibrationProblem { sensor: &sensor, recording: &recording, stimulus };
        without_motion_outliers(&problem).map(|(clean, found)| (clean.is_some(), found))
    }

    #[test]
    fn noise_has_no_outliers() {
        for (trust, seed) in TRUSTS.into_iter().flat_map(|trust| (0..50).map(move |seed| (trust, seed))) {
            assert_eq!(cut(trust, seed, |_| ()), None, "{trust:?} {seed}");
        }
    }

    #[test]
    fn outliers_of_any_size_are_cut_and_no_others() {
        for (trust, size) in TRUSTS.into_iter().flat_map(|trust| [5e-3, 1.0, 1e6].map(|size| (trust, size))) {
            let (is_clean, found) = cut(trust, 1, |recording| {
                recording.readings[33].y += size;
                recording.readings[70].x -= 0.9 * size;
            })
            .expect("outliers");
            assert!(is_clean, "{found:?}");
            assert_eq!(found.code(), samples::Spikes::CODE, "{found:?}");
            assert_eq!((found.number("cut"), found.subject()), (Some(2.0), Some("accelerometer axis y")));
            let time_s = found.number("time_s").expect("a time");
            assert!((time_s - 3.3).abs() < 1e-9, "{time_s}");
        }
    }

    #[test]
    fn many_samples_and_several_in_a_row_are_not_cut() {
        for places in [vec![44, 45, 46], (0..10).map(|k| 10 * k + 5).collect()] {
            let disturb = |recording: &mut Recording| {
                places.iter().for_each(|k| recording.readings[*k].z += 3.0 + *k as f64 * 0.01);
            };
            let Some((is_clean, found)) = cut(Trust::Known, 2, disturb) else { continue };
            assert!(!is_clean && found.code() == NoiseOutliers::CODE, "{found:?}");
            assert!(found.message().contains("too many to remove"), "{found:?}");
        }
    }
}

//! A recording that follows the commanded motion up to a time, and another motion from then on.
//!
//! The first part alone is explained by its noise, and the longest such part ends where the motion changed (bisection). A wrong clock or a wrong model grows
//! slowly with the length of the part; another motion is there at once. What the motion did then is tried with the sensor of the first part: rest, another
//! speed, the other direction, the same motion later.

use super::context::Context;
use super::solution::solve_at;
use super::{CalibrationProblem, CalibrationSettings, clock};
use crate::diagnostic::motion::MotionChanges;
use crate::diagnostic::{Diagnostic, Phrase};
use crate::estimate::RecoveredClock;
use crate::motion::{CommandedMotion, Trust};
use crate::sensor::{Recording, SensorParameters};
use crate::solve::chi2_p_value;
use nalgebra::{Matrix3, Vector3};

/// p-value below which noise does not explain a part.
const UNEXPLAINED: f64 = 1e-3;
/// The shortest first part, and the window behind it, as shares of the recording.
const SHORTEST: f64 = 0.1;
const WINDOW: f64 = 0.05;
/// The first part ends within this share of the recording.
const CLOSE: f64 = 0.002;
/// Behind the first part the mean square of the residuals is this many times that of noise: another motion, and not a small error that grows.
const OTHER: f64 = 10.0;
/// What the motion did is named where it leaves less than this part of the residuals' squares.
const TELLING: f64 = 0.25;
/// Samples by which motions are compared.
const SAMPLES: usize = 1000;

/// The change of the motion, if one explains the residuals.
pub(super) fn check(
    problem: &CalibrationProblem<'_>,
    command: &CommandedMotion,
    settings: &CalibrationSettings,
) -> Option<Diagnostic> {
    if command.trust == Trust::Unknown {
        return None;
    }
    let samples = problem.recording.len();
    let share = |part: f64| (part * samples as f64) as usize;
    let mut end = share(SHORTEST);
    let mut first = FirstPart::of(problem, command, settings, end)?;
    let mut beyond = samples;
    while beyond - end > share(CLOSE).max(1) {
        let middle = end.midpoint(beyond);
        match FirstPart::of(problem, command, settings, middle) {
            Some(longer) => (first, end) = (longer, middle),
            None => beyond = middle,
        }
    }
    let change_s = first.motion_time_s(problem.recording.times_s[end.min(samples - 1)]);
    let window = end..(end + share(WINDOW)).min(samples);
    let as_commanded = |time_s: f64| command.motion.acceleration_at(time_s);
    if first.misfit(problem.recording, window, 1, &as_commanded)? < OTHER {
        return None;
    }
    let (rest, stride) = (end..samples, (samples - end).div_ceil(SAMPLES));
    let misfit = |motion: &dyn Fn(f64) -> Vector3<f64>| {
        first.misfit(problem.recording, rest.clone(), stride, motion).unwrap_or(f64::INFINITY)
    };
    let otherwise = Otherwise { command, change_s };
    let mut tried = vec![
        (misfit(&|_| Vector3::zeros()), "it stands still".to_owned()),
        (misfit(&|time_s| -as_commanded(time_s)), "it goes in the other direction".to_owned()),
    ];
    let best = |values: Vec<f64>, of: &dyn Fn(f64) -> f64| {
        values.into_iter().map(|value| (of(value), value)).min_by(|one, other| one.0.total_cmp(&other.0))
    };
    // a thousandth of the speed, over tens of seconds, is hundredths of a second
    let speeds = (-700..=700).filter(|k: &i32| k.abs() > 10).map(|k| (1e-3 * f64::from(k)).exp()).collect();
    tried.extend(
        best(speeds, &|speed| misfit(&|time_s| otherwise.faster(time_s, speed)))
            .map(|(left, speed)| (left, format!("it goes on at {speed:.2} times the speed"))),
    );
    let duration_s = command.motion.times_s()[command.motion.intervals()] - change_s;
    let pauses_s = (1..=500).map(|k| f64::from(k) * duration_s / 1000.0).collect();
    tried.extend(
        best(pauses_s, &|pause_s| misfit(&|time_s| otherwise.later(time_s, pause_s)))
            .map(|(left, pause_s)| (left, format!("it stops, and goes on {pause_s:.2} s later"))),
    );
    let (left, words) = tried.into_iter().min_by(|one, other| one.0.total_cmp(&other.0))?;
    let what = (left < TELLING * misfit(&as_commanded)).then_some(Phrase(words));
    // process noise leads away from the command as well
    if what.is_none() && command.trust != Trust::Known {
        return None;
    }
    Some(MotionChanges { change_s, what }.into())
}

/// The motion behind a change.
struct Otherwise<'a> {
    command: &'a CommandedMotion,
    change_s: f64,
}

impl Otherwise<'_> {
    /// The same path at another speed. It rests at its end.
    fn faster(&self, time_s: f64, speed: f64) -> Vector3<f64> {
        self.at(self.change_s + speed * (time_s - self.change_s)) * (speed * speed)
    }

    /// The same motion after a pause.
    fn later(&self, time_s: f64, pause_s: f64) -> Vector3<f64> {
        let resumed = time_s > self.change_s + pause_s;
        if resumed { self.at(time_s - pause_s) } else { Vector3::zeros() }
    }

    fn at(&self, time_s: f64) -> Vector3<f64> {
        let motion = &self.command.motion;
        let is_within = time_s <= motion.times_s()[motion.intervals()];
        if is_within { motion.acceleration_at(time_s) } else { Vector3::zeros() }
    }
}

/// What the samples up to one of them say of the sensor, where noise explains them.
struct FirstPart {
    clock: RecoveredClock,
    /// The sensor, with its reading at rest in the place of the bias.
    sensor: SensorParameters,
    noise: Vector3<f64>,
    axes: usize,
}

impl FirstPart {
    fn of(
        problem: &CalibrationProblem<'_>,
        command: &CommandedMotion,
        settings: &CalibrationSettings,
        samples: usize,
    ) -> Option<Self> {
        let all = problem.recording;
        let recording = Recording {
            times_s: all.times_s[..samples].to_vec(),
            readings: all.readings[..samples].to_vec(),
            ..*all
        };
        let part = CalibrationProblem { recording: &recording, ..*problem };
        let (clock, used, _) = clock::find(&part, command, settings).ok()?;
        let on_clock = clock.on_motion_clock(&recording);
        let part = CalibrationProblem { recording: &on_clock, ..part };
        let context = Context::new(&part, command, settings, used).ok()?;
        let solved = solve_at(&context).ok()?;
        let p_value = chi2_p_value(solved.chi2, solved.degrees_of_freedom)?;
        let list = problem.sensor.parameter_list();
        let mut sensor = SensorParameters::linear(Vector3::zeros(), Matrix3::zeros());
        for (quantity, value) in list.quantities().iter().zip(&solved.values) {
            quantity.add_to(&mut sensor, *value);
        }
        let (noise, axes) = (context.noise, problem.sensor.axes);
        (p_value >= UNEXPLAINED).then_some(Self { clock, sensor, noise, axes })
    }

    fn motion_time_s(&self, time_s: f64) -> f64 {
        self.clock.motion_time_s(time_s)
    }

    /// Mean square of the residuals of samples beside a motion, in that of noise. `None` where it has none of them.
    fn misfit(
        &self,
        recording: &Recording,
        samples: std::ops::Range<usize>,
        stride: usize,
        motion: &dyn Fn(f64) -> Vector3<f64>,
    ) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0);
        for k in samples.step_by(stride.max(1)) {
            let acceleration = motion(self.motion_time_s(recording.times_s[k]));
            let residual = recording.readings[k] - self.sensor.reading(&acceleration);
            let squares = (0..self.axes).map(|axis| (residual[axis] / self.noise[axis]).powi(2));
            sum += squares.sum::<f64>();
            count += self.axes as f64;
        }
        (count > 0.0).then(|| sum / count)
    }
}

#[cfg(test)]
mod tests {
    use crate::estimate::{CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
    use crate::motion::{CommandedMotion, JerkControlledMotion, KnownEnds, MotionClock, Trust};
    use crate::sensor::{ReadingUnit, Recording, Sensor, SensorModel};
    use crate::simulate::{Purpose, stream};
    use nalgebra::Vector3;
    use rand_distr::{Distribution, StandardNormal};

    const INTERVAL_S: f64 = 0.5;
    const CHANGE_S: f64 = 18.3;

    /// What a calibration says of a recording that follows the command with this acceleration in its place, up to an error of the clock.
    fn said(happened: &dyn Fn(&JerkControlledMotion, f64) -> Vector3<f64>) -> Option<(f64, String)> {
        let mut rng = stream(4, Purpose::Motion, 0);
        let mut number = || -> f64 { StandardNormal.sample(&mut rng) };
        let nodes = (0..=60).map(|_| Vector3::from_fn(|_, _| 2.0 * number())).collect();
        let motion = JerkControlledMotion::uniform(INTERVAL_S, nodes).expect("a motion");
        let times_s: Vec<f64> = (0..=3000).map(|k| 0.01 * f64::from(k)).collect();
        let bias = Vector3::new(0.1, -0.2, 0.05);
        let reading =
            |t: &f64| happened(&motion, *t) * 1.01 + bias + Vector3::from_fn(|_, _| 5e-3 * number());
        let readings = times_s.iter().map(reading).collect();
        let recording =
            Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared).expect("in order");
        let sensor =
            Sensor { noise_mps2: Some(Vector3::repeat(5e-3)), ..Sensor::triaxial(SensorModel::ScaleBias) };
        let command = CommandedMotion {
            motion: motion.clone(),
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity: None,
            clock: MotionClock::default(),
        };
        let stimulus = Stimulus::Motion(&command);
        let problem = CalibrationProblem { sensor: &sensor, recording: &recording, stimulus };
        let found = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
        let named = found.warnings.iter().find(|found| found.code().name() == "motion-changes");
        named.map(|found| (found.number("change_s").expect("a time"), found.message().to_owned()))
    }

    #[test]
    fn a_motion_that_changes_half_way_is_named() {
        let before = |t: f64| t <= CHANGE_S;
        let still = |motion: &JerkControlledMotion, t: f64| {
            if before(t) { motion.acceleration_at(t) } else { Vector3::zeros() }
        };
        let back = |motion: &JerkControlledMotion, t: f64| {
            motion.acceleration_at(t) * if before(t) { 1.0 } else { -1.0 }
        };
        let slower = |motion: &JerkControlledMotion, t: f64| match before(t) {
            true => motion.acceleration_at(t),
            false => motion.acceleration_at(CHANGE_S + 0.8 * (t - CHANGE_S)) * 0.64,
        };
        let later = |motion: &JerkControlledMotion, t: f64| match t {
            t if before(t) => motion.acceleration_at(t),
            t if t <= CHANGE_S + 2.4 => Vector3::zeros(),
            t => motion.acceleration_at(t - 2.4),
        };
        type Happened<'a> = &'a dyn Fn(&JerkControlledMotion, f64) -> Vector3<f64>;
        let cases: [(Happened<'_>, &str); 4] = [
            (&still, "it stands still"),
            (&back, "in the other direction"),
            (&slower, "at 0.80 times the speed"),
            (&later, "goes on 2.4"),
        ];
        for (happened, words) in cases {
            let (change_s, message) = said(happened).expect(words);
            assert!((change_s - CHANGE_S).abs() < 0.1 && message.contains(words), "{words}: {message}");
        }
    }

    #[test]
    fn a_motion_that_is_all_of_the_command_or_late_in_all_does_not_change() {
        assert_eq!(said(&|motion, t| motion.acceleration_at(t)), None);
        assert_eq!(said(&|motion, t| motion.acceleration_at(t + 0.003)), None);
        assert_eq!(said(&|motion, t| motion.acceleration_at(t * 1.0005)), None);
    }
}

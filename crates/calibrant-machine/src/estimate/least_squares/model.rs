//! The least-squares problem: streams, log, and what is known beforehand.

use super::{WeighedLog, predicted};
use crate::estimate::problem::{Layout, TiltedGravity};
use crate::estimate::{MachineParameters, MachineTrust};
use crate::log::ReferenceLog;
use crate::reference::{Carrier, Motion};
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Everything but the state.
#[derive(Clone)]
pub(crate) struct Model<'a> {
    pub(crate) streams: Vec<Stream<'a>>,
    pub(crate) log: WeighedLog<'a>,
    pub(crate) layout: Layout,
    pub(crate) gravity: TiltedGravity,
    pub(crate) trust: MachineTrust,
    /// Middle of the recording, s: the clock's rate counts about it.
    pub(crate) middle_s: f64,
    /// Intervals of the spline that the log covers; samples elsewhere are not used.
    pub(crate) covered: Vec<bool>,
}

/// Motion and parameters.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) motion: Motion,
    pub(crate) parameters: MachineParameters,
}

/// What a sample has beyond its prediction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Residual {
    pub(crate) sample: usize,
    /// Time of the motion, s.
    pub(crate) time_s: f64,
    pub(crate) value: Vector3<f64>,
}

impl Model<'_> {
    /// Time of the motion at which sample `k` of stream `s` was taken, s.
    pub(crate) fn motion_time(&self, s: usize, k: usize, state: &State) -> f64 {
        let stream = &self.streams[s];
        state.parameters.motion_time(stream.sensor, stream.recording.times_s()[k], self.middle_s)
    }

    /// The same after the first knot. It is not rounded to the steps of large times: as a function of the delay it has none.
    pub(crate) fn after_start_s(&self, s: usize, k: usize, state: &State) -> f64 {
        let stream = &self.streams[s];
        let since = |from_s: f64| stream.recording.times_s()[k] - from_s;
        let parameters = &state.parameters;
        let start_s = state.motion.knots().start_s;
        since(start_s) + parameters.clock_rate * since(self.middle_s) + parameters.delays_s[stream.sensor]
    }

    /// What carries the sensor in a state.
    pub(crate) fn carrier(&self, State { motion, parameters }: &State) -> Carrier {
        motion.carrier(self.gravity.vector(parameters), parameters.mount, &parameters.corrections)
    }

    /// The residuals of the samples of stream `s` that are used, in the order of time.
    pub(crate) fn residuals(&self, state: &State, s: usize, pass: Pass) -> Vec<Residual> {
        let (stream, knots, carrier) = (&self.streams[s], state.motion.knots(), self.carrier(state));
        let length = stream.recording.len();
        let residual = |joints: &mut [Vec<f64>; 4], sample: usize| {
            let after_s = self.after_start_s(s, sample, state);
            let weights = knots.weights_after(after_s);
            let used = (0.0..=knots.duration_s()).contains(&after_s) && self.covered[weights.interval];
            let time_s = knots.start_s + after_s;
            used.then(|| {
                let at = state.motion.sensor(&weights, &carrier, joints);
                let predicted = predicted(stream.sensor, &at.specific_force, &at.rate, &state.parameters);
                Residual { sample, time_s, value: stream.recording.readings()[sample] - predicted }
            })
        };
        let samples = (0..length).into_par_iter().step_by(pass.stride(length));
        let residuals = samples.map_init(Default::default, residual).collect::<Vec<_>>();
        residuals.into_iter().flatten().collect()
    }

    /// Root mean square of the whitened residuals of each stream, by axis.
    pub(crate) fn residual_rms(&self, state: &State, pass: Pass) -> Vec<Vector3<f64>> {
        let of = |s: usize| {
            let residuals = self.residuals(state, s, pass);
            let whitened = |of: &Residual| of.value.component_div(&self.streams[s].sd_of(of.sample));
            let squares: Vector3<f64> = residuals.iter().map(|of| whitened(of).map(|r| r * r)).sum();
            (squares / (residuals.len() as f64).max(1.0)).map(f64::sqrt)
        };
        (0..self.streams.len()).map(of).collect()
    }

    /// Names of the joints; none for poses.
    pub(crate) fn joint_names(&self) -> Vec<String> {
        match self.log.log {
            ReferenceLog::Joints(log) => log.names.clone(),
            ReferenceLog::Poses(_) => Vec::new(),
        }
    }
}

/// Which samples are used, and whether the motion is unknown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pass {
    /// With noisy trust the control points are unknowns, and the log measures them.
    pub(crate) trust: MachineTrust,
    /// Samples of each sensor, about, spread evenly.
    pub(crate) samples: usize,
}

impl Pass {
    /// All samples.
    pub(crate) fn all(trust: MachineTrust) -> Self {
        Self { trust, samples: usize::MAX }
    }

    /// The motion is the smoothed log, and about this number of samples of each sensor is used.
    pub(crate) fn trusting(samples: usize) -> Self {
        Self { trust: MachineTrust::Known, samples }
    }

    /// Every how many samples of `length` are used.
    pub(crate) fn stride(self, length: usize) -> usize {
        (length / self.samples).max(1)
    }

    pub(crate) fn noisy(self) -> bool {
        self.trust == MachineTrust::Noisy
    }
}

/// The readings of a sensor, in m/s² and rad/s or in counts, in the order of time.
#[derive(Debug, Clone)]
pub(crate) struct Stream<'a> {
    pub(crate) sensor: SensorKind,
    pub(crate) recording: &'a Recording,
    /// Standard deviation of one sample, per axis.
    pub(crate) sd: Vector3<f64>,
    /// How many times larger the noise of each sample is, where it grows with motion. Empty: everywhere 1.
    pub(crate) growth: Vec<f64>,
}

impl Stream<'_> {
    /// Standard deviation of sample `k`, per axis.
    pub(crate) fn sd_of(&self, k: usize) -> Vector3<f64> {
        self.sd * self.growth.get(k).copied().unwrap_or(1.0)
    }
}

/// The noise that neighbouring samples do not share: from the median of second differences, per axis.
pub(crate) fn white_noise(recording: &Recording) -> Vector3<f64> {
    /// Standard deviation of a normal distribution in median absolute deviations, of second differences of white noise.
    const OF_MEDIAN: f64 = 0.674_489_75 * 2.449_489_742_783_178;
    Vector3::from_fn(|axis, _| {
        let second =
            |window: &[Vector3<f64>]| (window[0][axis] - 2.0 * window[1][axis] + window[2][axis]).abs();
        let mut differences: Vec<f64> = recording.readings().windows(3).map(second).collect();
        if differences.is_empty() {
            return 1.0;
        }
        let middle = differences.len() / 2;
        let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
        (*median / OF_MEDIAN).max(1e-9)
    })
}

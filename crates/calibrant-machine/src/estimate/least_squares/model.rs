//! The least-squares problem: streams, log, and what is known beforehand.

use crate::estimate::least_squares::log_equations::WeighedLog;
use crate::estimate::least_squares::pass::Pass;
use crate::estimate::least_squares::sample_rows::predicted;
use crate::estimate::least_squares::stream::Stream;
use crate::estimate::problem::layout::Layout;
use crate::estimate::problem::parameters::TiltedGravity;
use crate::estimate::{MachineParameters, MachineTrust};
use crate::log::ReferenceLog;
use crate::reference::{Carrier, Motion};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Everything but the state.
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

    /// What carries the sensor in a state.
    pub(crate) fn carrier(&self, State { motion, parameters }: &State) -> Carrier {
        motion.carrier(self.gravity.vector(parameters), parameters.mount, &parameters.corrections)
    }

    /// The residuals of the samples of stream `s` that are used, in the order of time.
    pub(crate) fn residuals(&self, state: &State, s: usize, pass: Pass) -> Vec<Residual> {
        let (stream, knots, carrier) = (&self.streams[s], state.motion.knots(), self.carrier(state));
        let length = stream.recording.len();
        let residual = |joints: &mut [Vec<f64>; 4], sample: usize| {
            let time_s = self.motion_time(s, sample, state);
            let weights = knots.weights(time_s);
            let used = (knots.start_s..=knots.end_s()).contains(&time_s) && self.covered[weights.interval];
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

//! The least-squares problem at one point: streams, log, motion and parameters.

use super::front::Front;
use super::layout::Layout;
use super::log_equations::WeighedLog;
use super::parameters::TiltedGravity;
use super::sample_rows::{RowWriter, Sample, predicted};
use super::stream::Stream;
use super::{MachineParameters, MachineTrust};
use crate::log::ReferenceLog;
use crate::reference::{Carrier, Felt, Motion};
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;
use std::ops::Range;

/// Intervals whose equations are made at the same time.
const BATCH: usize = 64;
/// Rows that are multiplied at once where the motion is known.
const ROWS: usize = 192;

/// Everything but the state.
pub(super) struct Model<'a> {
    pub(super) streams: Vec<Stream<'a>>,
    pub(super) log: WeighedLog<'a>,
    pub(super) layout: Layout,
    pub(super) gravity: TiltedGravity,
    pub(super) trust: MachineTrust,
    /// Middle of the recording, s: the clock's rate counts about it.
    pub(super) middle_s: f64,
    /// Intervals of the spline that the log covers; samples elsewhere are not used.
    pub(super) covered: Vec<bool>,
}

/// Motion and parameters.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) motion: Motion,
    pub(super) parameters: MachineParameters,
}

/// The normal equations.
pub(super) struct Equations {
    pub(super) front: Front,
    /// Twice the cost: `χ²`, with Huber's cost of outliers.
    pub(super) cost: f64,
    /// The scores of the parameters in time: the beginning of each part, s, and its right side.
    pub(super) scores: Vec<(f64, DVector<f64>)>,
}

/// Where the samples of a stream and the log's lie in the intervals: sample `places[i] .. places[i + 1]` in interval `i`.
pub(super) type Places = Vec<usize>;

impl Model<'_> {
    /// Times of the motion at which stream `s` was sampled.
    fn motion_times<'b>(&'b self, s: usize, at: &'b MachineParameters) -> impl Fn(usize) -> f64 + 'b {
        let stream = &self.streams[s];
        move |k| at.motion_time(stream.sensor, stream.recording.times_s[k], self.middle_s)
    }

    /// The samples in each interval; those outside of all are in none.
    pub(super) fn places(&self, state: &State) -> (Vec<Places>, Places) {
        let knots = state.motion.knots();
        let of = |length: usize, time: &dyn Fn(usize) -> f64| -> Places {
            let mut place = 0;
            let boundaries = (0..=knots.intervals).map(|i| {
                let boundary = knots.knot_s(i);
                // the last interval has its end
                while place < length
                    && (time(place) < boundary || (i == knots.intervals && time(place) <= boundary))
                {
                    place += 1;
                }
                place
            });
            boundaries.collect()
        };
        let streams = (0..self.streams.len())
            .map(|s| of(self.streams[s].recording.len(), &self.motion_times(s, &state.parameters)))
            .collect();
        let times = self.log.log.times_s();
        (streams, of(times.len(), &|k| times[k]))
    }

    /// What carries the sensor in a state.
    pub(super) fn carrier(&self, State { motion, parameters }: &State) -> Carrier {
        motion.carrier(self.gravity.vector(parameters), parameters.mount, &parameters.corrections)
    }

    /// The normal equations at a state.
    pub(super) fn equations(&self, state: &State) -> Equations {
        let noisy = self.trust == MachineTrust::Noisy;
        let (streams, log) = self.places(state);
        let (knots, unknowns) = (state.motion.knots(), state.motion.unknowns());
        let order = if noisy { knots.degree.order() } else { 0 };
        let mut front = Front::new(unknowns, order, self.layout.len());
        let rows = 3 * streams.iter().map(|places| places.last().copied().unwrap_or(0)).sum::<usize>();
        let group = if noisy { 1 } else { (ROWS * knots.intervals / rows.max(1)).max(1) };
        let groups: Vec<Range<usize>> =
            (0..knots.intervals).step_by(group).map(|i| i..(i + group).min(knots.intervals)).collect();
        let (mut cost, mut scores) = (0.0, Vec::with_capacity(groups.len()));
        let mut right = DVector::zeros(self.layout.len());
        for batch in groups.chunks(BATCH) {
            let parts: Vec<(DMatrix<f64>, f64)> =
                batch.par_iter().map(|group| self.of_intervals(group, state, &streams, &log)).collect();
            for (group, (equations, part)) in batch.iter().zip(&parts) {
                cost += part;
                front.add(equations);
                let now = front.border_right();
                scores.push((knots.knot_s(group.start), &now - &right));
                right = now;
            }
        }
        let deviation = self.layout.deviation(&state.parameters);
        let pull = -(&self.layout.prior * &deviation);
        cost -= deviation.dot(&pull);
        front.add_to_border(&self.layout.prior, &pull);
        Equations { front, cost, scores }
    }

    /// Root mean square of the whitened residuals of each stream, by axis.
    pub(super) fn residual_rms(&self, state: &State) -> Vec<Vector3<f64>> {
        let of = |s: usize| {
            let (mut squares, mut count) = (Vector3::zeros(), 0);
            self.visit_residuals(state, s, |_, k, residual| {
                squares += residual.component_div(&self.streams[s].sd_of(k)).map(|r| r * r);
                count += 1;
            });
            (squares / f64::from(count.max(1))).map(f64::sqrt)
        };
        (0..self.streams.len()).map(of).collect()
    }

    /// Time of the motion at which sample `k` of stream `s` was taken, s.
    pub(super) fn motion_time(&self, s: usize, k: usize, state: &State) -> f64 {
        let stream = &self.streams[s];
        state.parameters.motion_time(stream.sensor, stream.recording.times_s[k], self.middle_s)
    }

    /// The same, to change its trust.
    pub(super) fn borrowed(&self) -> Model<'_> {
        Model {
            streams: self.streams.clone(),
            log: self.log.clone(),
            layout: self.layout.clone(),
            gravity: self.gravity,
            trust: self.trust,
            middle_s: self.middle_s,
            covered: self.covered.clone(),
        }
    }

    /// Names of the joints; none for poses.
    pub(super) fn joint_names(&self) -> Vec<String> {
        match self.log.log {
            ReferenceLog::Joints(log) => log.names.clone(),
            ReferenceLog::Poses(_) => Vec::new(),
        }
    }

    /// Calls with time of the motion, sample and residual, for each sample that is used.
    pub(super) fn visit_residuals(
        &self,
        state: &State,
        s: usize,
        mut visit: impl FnMut(f64, usize, Vector3<f64>),
    ) {
        let (streams, _) = self.places(state);
        let (knots, columns) = (state.motion.knots(), state.motion.columns(false));
        let carrier = self.carrier(state);
        let mut felt = Felt::zeros(columns);
        let stream = &self.streams[s];
        let first = streams[s][0].next_multiple_of(stream.stride);
        for k in (first..streams[s][knots.intervals]).step_by(stream.stride) {
            let time = self.motion_time(s, k, state);
            let weights = knots.weights(time);
            if self.covered[weights.interval] {
                state.motion.feel(&weights, &carrier, columns, &mut felt);
                let residual =
                    stream.recording.readings[k] - predicted(stream.sensor, &felt, &state.parameters);
                visit(time, k, residual);
            }
        }
    }

    /// The normal equations of some intervals, and their cost.
    fn of_intervals(
        &self,
        intervals: &Range<usize>,
        state: &State,
        streams: &[Places],
        log: &Places,
    ) -> (DMatrix<f64>, f64) {
        let rows = self.rows(intervals, state, streams);
        let mut equations = DMatrix::zeros(rows.length, rows.length);
        let mut cost = rows.cost;
        if !rows.values.is_empty() {
            let transposed = rows.matrix();
            equations.gemm(1.0, &transposed, &transposed.transpose(), 0.0);
        }
        if self.trust == MachineTrust::Noisy {
            cost += self.log.add(log[intervals.start]..log[intervals.end], &state.motion, &mut equations);
            let spread = HELD * (log[log.len() - 1] as f64 / log.len() as f64).max(1.0);
            for k in 0..state.motion.unknowns() * state.motion.knots().degree.order() {
                let sd = self.log.sd[k % state.motion.unknowns()];
                equations[(k, k)] += spread / (sd * sd);
            }
        }
        (equations, cost)
    }

    /// The rows of the samples in some intervals.
    pub(super) fn rows(&self, intervals: &Range<usize>, state: &State, streams: &[Places]) -> Rows {
        let noisy = self.trust == MachineTrust::Noisy;
        let columns = state.motion.columns(noisy);
        let writer = RowWriter::new(&self.layout, columns, &self.gravity, &state.parameters);
        let carrier = self.carrier(state);
        let knots = state.motion.knots();
        let length = writer.length();
        let mut rows = Rows { length, values: Vec::new(), origins: Vec::new(), cost: 0.0 };
        let mut felt = Felt::zeros(columns);
        for (s, stream) in self.streams.iter().enumerate() {
            let time = self.motion_times(s, &state.parameters);
            let first = streams[s][intervals.start].next_multiple_of(stream.stride);
            for k in (first..streams[s][intervals.end]).step_by(stream.stride) {
                let weights = knots.weights(time(k));
                if !self.covered[weights.interval] {
                    continue;
                }
                state.motion.feel(&weights, &carrier, columns, &mut felt);
                let sample = Sample {
                    sensor: stream.sensor,
                    reading: &stream.recording.readings[k],
                    sd: stream.sd_of(k),
                    after_middle_s: stream.recording.times_s[k] - self.middle_s,
                };
                let place = rows.values.len();
                rows.values.resize(place + 3 * length, 0.0);
                rows.cost += writer.write(&sample, &felt, &state.parameters, &mut rows.values[place..]);
                rows.origins.push((s, k));
            }
        }
        rows
    }
}

/// Information of a control point where no sample is, beside that of the log: it holds the control point where it is.
const HELD: f64 = 1e-4;

/// Rows of the least-squares problem, three for each sample.
pub(super) struct Rows {
    /// Length of a row.
    pub(super) length: usize,
    pub(super) values: Vec<f64>,
    /// Stream and sample of each three rows.
    pub(super) origins: Vec<(usize, usize)>,
    pub(super) cost: f64,
}

impl Rows {
    /// The rows as columns.
    pub(super) fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(self.length, self.values.len() / self.length, &self.values)
    }
}

//! The normal equations at one point, interval by interval.

use super::{Block, Front, Model, Pass, RowWriter, Sample, State, block_s};
use crate::reference::Felt;
use nalgebra::{DMatrix, Dyn, MatrixView};
use rayon::prelude::*;
use std::ops::Range;

/// Intervals whose equations are made at the same time.
const BATCH: usize = 64;
/// Rows that are multiplied at once where the motion is known.
const ROWS: usize = 192;
/// Information of a control point where no sample is, beside that of the log: it holds the control point where it is.
const HELD: f64 = 1e-6;

/// The normal equations.
pub(crate) struct Equations {
    pub(crate) front: Front,
    /// Twice the cost: `χ²`, with Huber's cost of outliers.
    pub(crate) cost: f64,
    /// The part of each block of time.
    pub(crate) blocks: Vec<Block>,
}

/// Where samples lie in the intervals: `streams[s][i] .. streams[s][i + 1]` in interval `i`.
pub(crate) struct Places {
    streams: Vec<Vec<usize>>,
    log: Vec<usize>,
}

impl Places {
    /// Samples of the log in some intervals.
    pub(crate) fn of_log(&self, intervals: &Range<usize>) -> Range<usize> {
        self.log[intervals.start]..self.log[intervals.end]
    }

    fn of_stream(&self, s: usize, intervals: &Range<usize>) -> Range<usize> {
        self.streams[s][intervals.start]..self.streams[s][intervals.end]
    }
}

impl Model<'_> {
    /// The samples in each interval; those outside of all are in none.
    pub(crate) fn places(&self, state: &State) -> Places {
        let knots = state.motion.knots();
        // the same function of time tells the interval here and in the weights: samples may lie on knots
        let before = |after_s: f64, i: usize| match i {
            0 => after_s < 0.0,
            i if i == knots.intervals => after_s <= knots.duration_s(),
            i => knots.interval_after(after_s) < i,
        };
        let of = |length: usize, after_s: &dyn Fn(usize) -> f64| -> Vec<usize> {
            let mut place = 0;
            let boundaries = (0..=knots.intervals).map(|i| {
                while place < length && before(after_s(place), i) {
                    place += 1;
                }
                place
            });
            boundaries.collect()
        };
        let streams = (self.streams.iter().enumerate())
            .map(|(s, stream)| of(stream.recording.len(), &|k| self.after_start_s(s, k, state)));
        let times = self.log.log.times_s();
        Places { streams: streams.collect(), log: of(times.len(), &|k| times[k] - knots.start_s) }
    }

    /// Consecutive intervals whose rows are multiplied at once: each alone where its control points are unknown.
    pub(crate) fn groups(&self, state: &State, pass: Pass) -> Vec<Range<usize>> {
        let intervals = state.motion.knots().intervals;
        let used = |length: usize| length / pass.stride(length);
        let rows = 3 * self.streams.iter().map(|stream| used(stream.recording.len())).sum::<usize>();
        let group = if pass.noisy() { 1 } else { (ROWS * intervals / rows.max(1)).max(1) };
        (0..intervals).step_by(group).map(|i| i..(i + group).min(intervals)).collect()
    }

    /// The normal equations at a state.
    pub(crate) fn equations(&self, state: &State, pass: Pass) -> Equations {
        let places = self.places(state);
        let (knots, unknowns) = (state.motion.knots(), state.motion.unknowns());
        let order = if pass.noisy() { knots.degree.order() } else { 0 };
        let mut front = Front::new(unknowns, order, self.layout.len());
        let groups = self.groups(state, pass);
        let (mut cost, mut blocks) = (0.0, Vec::new());
        let length_s = block_s(knots.end_s() - knots.start_s);
        let (mut end_s, mut before) = (knots.start_s + length_s, front.border());
        for batch in groups.chunks(BATCH) {
            let parts: Vec<(DMatrix<f64>, f64)> =
                batch.par_iter().map(|group| self.of_intervals(group, state, &places, pass)).collect();
            for (group, (equations, part)) in batch.iter().zip(&parts) {
                cost += part;
                front.add(equations);
                if knots.knot_s(group.end) >= end_s || group.end == knots.intervals {
                    let now = front.border();
                    let (score, information) =
                        (&now.score - &before.score, &now.information - &before.information);
                    // a block without samples tells nothing
                    if score.amax() > 0.0 {
                        blocks.push(Block { score, information });
                    }
                    (end_s, before) = (knots.knot_s(group.end) + length_s, now);
                }
            }
        }
        let deviation = self.layout.deviation(&state.parameters);
        let pull = -(&self.layout.prior * &deviation);
        cost -= deviation.dot(&pull);
        front.add_to_border(&self.layout.prior, &pull);
        Equations { front, cost, blocks }
    }

    /// The normal equations of some intervals, and their cost.
    fn of_intervals(
        &self,
        intervals: &Range<usize>,
        state: &State,
        places: &Places,
        pass: Pass,
    ) -> (DMatrix<f64>, f64) {
        let rows = self.rows(intervals, state, places, pass);
        let mut equations = DMatrix::zeros(rows.length, rows.length);
        let mut cost = rows.cost;
        if !rows.values.is_empty() {
            equations.gemm(1.0, &rows.as_columns(), &rows.as_rows(), 0.0);
        }
        if pass.noisy() {
            cost += self.log.add(places.of_log(intervals), &state.motion, &mut equations);
            let (samples, controls) = (self.log.log.times_s().len(), state.motion.knots().controls());
            let held = HELD * (samples as f64 / controls as f64).max(1.0);
            let unknowns = state.motion.unknowns();
            for k in 0..unknowns * state.motion.knots().degree.order() {
                let sd = self.log.sd[k % unknowns];
                equations[(k, k)] += held / (sd * sd);
            }
        }
        (equations, cost)
    }

    /// The rows of the samples in some intervals.
    pub(crate) fn rows(&self, intervals: &Range<usize>, state: &State, places: &Places, pass: Pass) -> Rows {
        let columns = state.motion.columns(pass.noisy());
        let writer = RowWriter::new(&self.layout, columns, &self.gravity, &state.parameters);
        let carrier = self.carrier(state);
        let knots = state.motion.knots();
        let length = writer.length();
        let mut rows = Rows { length, values: Vec::new(), streams: Vec::new(), cost: 0.0 };
        let mut felt = Felt::zeros(columns);
        for (s, stream) in self.streams.iter().enumerate() {
            let stride = pass.stride(stream.recording.len());
            let samples = places.of_stream(s, intervals);
            for k in (samples.start.next_multiple_of(stride)..samples.end).step_by(stride) {
                let weights = knots.weights_after(self.after_start_s(s, k, state));
                if !self.covered[weights.interval] {
                    continue;
                }
                state.motion.feel(&weights, &carrier, columns, &mut felt);
                let sample = Sample {
                    sensor: stream.sensor,
                    reading: &stream.recording.readings()[k],
                    sd: stream.sd_of(k),
                    after_middle_s: stream.recording.times_s()[k] - self.middle_s,
                };
                let place = rows.values.len();
                rows.values.resize(place + 3 * length, 0.0);
                rows.cost += writer.write(&sample, &felt, &state.parameters, &mut rows.values[place..]);
                rows.streams.push(s);
            }
        }
        rows
    }
}

/// Rows of the least-squares problem, three for each sample: derivatives by the control points of the interval, by the parameters, and the residual.
pub(crate) struct Rows {
    /// Length of a row.
    pub(crate) length: usize,
    values: Vec<f64>,
    /// The stream of each sample.
    pub(crate) streams: Vec<usize>,
    pub(crate) cost: f64,
}

type Strided<'a> = MatrixView<'a, f64, Dyn, Dyn, Dyn, Dyn>;

impl Rows {
    fn number(&self) -> usize {
        3 * self.streams.len()
    }

    fn as_rows(&self) -> Strided<'_> {
        let (number, length) = (Dyn(self.number()), Dyn(self.length));
        Strided::from_slice_with_strides_generic(&self.values, number, length, length, Dyn(1))
    }

    /// The rows as columns.
    pub(crate) fn as_columns(&self) -> Strided<'_> {
        let (number, length) = (Dyn(self.number()), Dyn(self.length));
        Strided::from_slice_with_strides_generic(&self.values, length, number, Dyn(1), length)
    }
}

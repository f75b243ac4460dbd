//! What the covariance of everything says of the residuals: degrees of freedom, noise, and where each parameter's variance comes from.
//!
//! The equations are solved backwards once more, interval by interval, with the covariance of its control points and of all parameters
//! (`takahashi1973`). With a whitened row `a` of a sample: its leverage is `aᵀ Σ a`, and it adds `(Σ a)ᵢ²` to the variance of parameter `i`.

use crate::estimate::least_squares::{Minimum, Model, Moments, Pass, Places, Scaled, State};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Intervals that are visited at the same time.
const BATCH: usize = 32;

/// The result of the sweep.
pub(crate) struct Posterior {
    /// Covariance of the parameters.
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) sums: Sums,
}

/// Sums over samples.
#[derive(Debug, Clone)]
pub(crate) struct Sums {
    /// For each stream, its axes.
    pub(crate) streams: Vec<[Moments; 3]>,
    /// For each component of the log.
    pub(crate) log: Vec<Moments>,
    /// Variance of each parameter from the noise of each stream.
    pub(crate) of_streams: Vec<DVector<f64>>,
}

/// The covariance of the control points of some intervals and of the parameters, and their last step.
struct Local {
    intervals: Range<usize>,
    covariance: DMatrix<f64>,
    step: DVector<f64>,
}

impl Posterior {
    /// At a minimum. At most `intervals` intervals are visited, spread evenly. `None` where the parameters are not determined.
    pub(crate) fn at(model: &Model<'_>, minimum: &Minimum, pass: Pass, intervals: usize) -> Option<Self> {
        let state = &minimum.state;
        let covariance = Scaled::new(&minimum.solved.information)?.inverse();
        let places = model.places(state);
        let sweep = Sweep { model, state, places: &places, pass, parameters: covariance.nrows() };
        let mut sums = sweep.none();
        let groups = model.groups(state, pass);
        let every = groups.len().div_ceil(intervals).max(1);
        if minimum.solved.has_motion() {
            let (unknowns, knots) = (state.motion.unknowns(), state.motion.knots());
            let controls = minimum.solved.controls();
            let mut batch: Vec<Local> = Vec::with_capacity(BATCH);
            minimum.solved.backwards(&covariance, every, |i, covariance| {
                if i >= knots.intervals {
                    return;
                }
                let of_interval = &controls[i * unknowns..(i + knots.degree.order()) * unknowns];
                let step = of_interval.iter().chain(minimum.solved.parameters.iter()).copied().collect();
                let step = DVector::from_vec(step);
                batch.push(Local { intervals: i..i + 1, covariance, step });
                if batch.len() == BATCH {
                    sums.add(&sweep.over(&batch));
                    batch.clear();
                }
            });
            sums.add(&sweep.over(&batch));
        } else {
            let groups = groups.into_iter().step_by(every);
            let step = &minimum.solved.parameters;
            let local = |intervals| Local { intervals, covariance: covariance.clone(), step: step.clone() };
            sums.add(&sweep.over(&groups.map(local).collect::<Vec<_>>()));
        }
        sums.stand_for(every as f64);
        Some(Self { covariance, sums })
    }
}

struct Sweep<'m> {
    model: &'m Model<'m>,
    state: &'m State,
    places: &'m Places,
    pass: Pass,
    parameters: usize,
}

impl Sweep<'_> {
    fn none(&self) -> Sums {
        Sums {
            streams: vec![Default::default(); self.model.streams.len()],
            log: vec![Moments::default(); self.state.motion.unknowns()],
            of_streams: vec![DVector::zeros(self.parameters); self.model.streams.len()],
        }
    }

    /// The sums over some intervals.
    fn over(&self, batch: &[Local]) -> Sums {
        let parts: Vec<Sums> = batch.par_iter().map(|local| self.at(local)).collect();
        let mut sums = self.none();
        parts.iter().for_each(|part| sums.add(part));
        sums
    }

    fn at(&self, local: &Local) -> Sums {
        let mut sums = self.none();
        let rows = self.model.rows(&local.intervals, self.state, self.places, self.pass);
        let all = rows.as_columns();
        let size = local.covariance.nrows();
        let derivatives = all.rows(0, size);
        let spread = &local.covariance * derivatives;
        for (k, stream) in rows.streams.iter().enumerate() {
            for axis in 0..3 {
                let row = 3 * k + axis;
                let leverage = derivatives.column(row).dot(&spread.column(row));
                let residual = all[(size, row)] - derivatives.column(row).dot(&local.step);
                sums.streams[*stream][axis].add(residual, leverage);
                let of_parameters = spread.view((size - self.parameters, row), (self.parameters, 1));
                sums.of_streams[*stream] += of_parameters.map(|part| part * part);
            }
        }
        if self.pass.noisy() {
            let samples = self.places.of_log(&local.intervals);
            let at = (&local.covariance, &local.step);
            self.model.log.add_moments(samples, &self.state.motion, at, &mut sums.log);
        }
        sums
    }
}

impl Sums {
    /// Multiplies the sums: each interval that was visited stands for this number of them.
    fn stand_for(&mut self, number: f64) {
        for moments in self.streams.iter_mut().flatten().chain(&mut self.log) {
            *moments = moments.times(number);
        }
        for variance in &mut self.of_streams {
            *variance *= number;
        }
    }

    fn add(&mut self, other: &Self) {
        let streams = self.streams.iter_mut().flatten().zip(other.streams.iter().flatten());
        for (one, other) in streams.chain(self.log.iter_mut().zip(&other.log)) {
            *one += *other;
        }
        for (one, other) in self.of_streams.iter_mut().zip(&other.of_streams) {
            *one += other;
        }
    }
}

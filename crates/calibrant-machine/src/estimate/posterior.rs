//! What the covariance of everything says of the residuals: degrees of freedom, noise, and where each parameter's variance comes from.
//!
//! The equations are solved backwards once more, interval by interval, with the covariance of its control points and of all parameters
//! (`takahashi1973`). With a whitened row `a` of a sample: its leverage is `aᵀ Σ a`, and it adds `(Σ a)ᵢ²` to the variance of parameter `i`.

use super::gauss_newton::Minimum;
use super::model::{Model, State};
use super::moments::Moments;
use nalgebra::{DMatrix, DVector};

/// The result of the sweep.
pub(super) struct Posterior {
    /// Covariance of the parameters.
    pub(super) covariance: DMatrix<f64>,
    /// For each stream, its axes.
    pub(super) streams: Vec<[Moments; 3]>,
    /// For each component of the log.
    pub(super) log: Vec<Moments>,
    /// Variance of each parameter from the noise of each stream.
    pub(super) of_streams: Vec<DVector<f64>>,
}

impl Posterior {
    /// At a minimum, from the residuals of each `every`-th interval. `None` where the parameters are not determined.
    pub(super) fn at(model: &Model<'_>, minimum: &Minimum, every: usize) -> Option<Self> {
        let state = &minimum.state;
        let covariance = inverse(&minimum.solved.information)?;
        let parameters = covariance.nrows();
        let mut posterior = Self {
            streams: vec![Default::default(); model.streams.len()],
            log: vec![Moments::default(); state.motion.unknowns()],
            of_streams: vec![DVector::zeros(parameters); model.streams.len()],
            covariance,
        };
        let (streams, log) = model.places(state);
        let (unknowns, order) = (state.motion.unknowns(), state.motion.knots().degree.order());
        let steps = minimum.solved.controls();
        let step_of = |i: usize| -> DVector<f64> {
            let controls = if steps.is_empty() { &[] } else { &steps[i * unknowns..(i + order) * unknowns] };
            let parameters = minimum.solved.parameters.iter();
            DVector::from_iterator(
                controls.len() + parameters.len(),
                controls.iter().chain(parameters).copied(),
            )
        };
        let covariance = posterior.covariance.clone();
        let mut visit = |i: usize, local: &DMatrix<f64>| {
            if i >= state.motion.knots().intervals || !i.is_multiple_of(every) {
                return;
            }
            let step = step_of(i);
            posterior.add_samples(model, state, i, &streams, (local, &step));
            if local.nrows() > parameters {
                model.log.add_moments(log[i]..log[i + 1], &state.motion, (local, &step), &mut posterior.log);
            }
        };
        if minimum.solved.has_motion() {
            minimum.solved.backwards(&covariance, &mut visit);
        } else {
            (0..state.motion.knots().intervals).for_each(|i| visit(i, &covariance));
        }
        Some(posterior)
    }

    fn add_samples(
        &mut self,
        model: &Model<'_>,
        state: &State,
        interval: usize,
        streams: &[Vec<usize>],
        (local, step): (&DMatrix<f64>, &DVector<f64>),
    ) {
        let rows = model.rows(&(interval..interval + 1), state, streams);
        if rows.values.is_empty() {
            return;
        }
        let all = rows.matrix();
        let size = local.nrows();
        let parameters = self.covariance.nrows();
        let derivatives = all.rows(0, size);
        let spread = local * derivatives;
        for (k, (stream, _)) in rows.origins.iter().enumerate() {
            for axis in 0..3 {
                let row = 3 * k + axis;
                let leverage = derivatives.column(row).dot(&spread.column(row));
                let residual = all[(size, row)] - derivatives.column(row).dot(step);
                self.streams[*stream][axis].add(residual, leverage);
                for p in 0..parameters {
                    self.of_streams[*stream][p] += spread[(size - parameters + p, row)].powi(2);
                }
            }
        }
    }
}

/// The inverse of an information matrix, scaled to a unit diagonal first.
pub(super) fn inverse(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = information.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
    let n = information.nrows();
    let scaled = DMatrix::from_fn(n, n, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = nalgebra::Cholesky::new(scaled)?.inverse();
    Some(DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

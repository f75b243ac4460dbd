//! One chain from the problem to its solution.

use super::fit::{Chain, Fit, State};
use super::model::ChainModel;
use super::moments::{Position, locate, moments, reference};
use super::pairs::PairSums;
use super::undetermined::{explain, explain_node};
use super::{
    CalibrationProblem, CalibrationSettings, CalibrationStatus, CommandedMotion, DMatrix, Trust, Vector3,
};
use crate::error::{Complaint, Error, Result, UndeterminedGroup};
use crate::information;
use crate::motion::KnownEnds;
use nalgebra::{SMatrix, SVector};
use std::marker::PhantomData;

/// What every chain of a problem shares.
pub(super) struct Context<'a> {
    pub(super) problem: &'a CalibrationProblem<'a>,
    pub(super) command: &'a CommandedMotion,
    pub(super) settings: &'a CalibrationSettings,
    /// Readings within the motion, and where they lie on it.
    pub(super) readings: &'a [Vector3<f64>],
    pub(super) positions: Vec<Position>,
    /// Pairs of nearby samples, for the whiteness test.
    pairs: PairSums,
    /// The reading nearest to each node.
    reference: Vec<Vector3<f64>>,
    /// Standard deviation of a sample, in the unit of the readings.
    pub(super) noise: Vector3<f64>,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        problem: &'a CalibrationProblem<'a>,
        command: &'a CommandedMotion,
        settings: &'a CalibrationSettings,
        first: usize,
        end: usize,
    ) -> Result<Self> {
        let times = &problem.recording.times_s[first..end];
        let readings = &problem.recording.readings[first..end];
        let tau = command.motion.times_s();
        let positions = locate(times, tau);
        let mut context = Self {
            problem,
            command,
            settings,
            readings,
            pairs: PairSums::new(&positions, command.motion.intervals()),
            positions,
            reference: reference(times, readings, tau),
            noise: Vector3::repeat(1.0),
        };
        if command.trust == Trust::Unknown && command.known_ends != KnownEnds::Both {
            return Err(Error::experiment(Complaint::new(
                "trust `unknown` needs the acceleration at both ends",
                "set known_ends = \"both\"",
            )));
        }
        context.noise = context.noise_of_a_sample()?;
        Ok(context)
    }

    /// σ_ν in the unit of the readings. Readings in counts without a nominal gain take it from a first look at the data.
    fn noise_of_a_sample(&self) -> Result<Vector3<f64>> {
        let sensor = self.problem.sensor;
        let gain = match sensor.gain {
            Some(gain) => gain,
            None => Vector3::from_fn(
                |axis, _| if axis < sensor.axes { self.gain_from_data(axis).abs() } else { 1.0 },
            ),
        };
        let noise = sensor.noise(&gain).ok_or_else(|| {
            Error::experiment(Complaint::new("the noise of a sample is not given", "set `sensor.noise_mps2`"))
        })?;
        match sensor
            .active_axes()
            .iter()
            .find(|axis| !(noise[axis.index()] > 0.0 && noise[axis.index()].is_finite()))
        {
            Some(axis) => Err(Error::experiment(Complaint::new(
                format!("the noise of axis {axis} is {}, not a positive number", noise[axis.index()]),
                "set `sensor.noise_mps2` (or `noise_counts`) to the standard deviation of one sample",
            ))),
            None => Ok(noise),
        }
    }

    /// Rough gain of one axis, negative where the axis is reversed: reading against commanded acceleration, over the samples or (trust `unknown`) the two ends.
    fn gain_from_data(&self, axis: usize) -> f64 {
        let nodes = self.command.motion.acceleration_mps2();
        let last = nodes.len() - 1;
        let ends =
            (self.reference[last][axis] - self.reference[0][axis]) / (nodes[last][axis] - nodes[0][axis]);
        let gain = if self.command.trust == Trust::Unknown {
            ends
        } else {
            let mean = |values: &dyn Fn(usize) -> f64| {
                (0..nodes.len()).map(values).sum::<f64>() / nodes.len() as f64
            };
            let (a, y) = (mean(&|i| nodes[i][axis]), mean(&|i| self.reference[i][axis]));
            let covariance = mean(&|i| (nodes[i][axis] - a) * (self.reference[i][axis] - y));
            covariance / mean(&|i| (nodes[i][axis] - a).powi(2))
        };
        if gain.is_finite() && gain != 0.0 { gain } else { 1.0 }
    }

    /// The chain of these axes.
    fn chain<M: ChainModel<D, P>, const D: usize, const P: usize>(
        &self,
        axes: [usize; D],
        slots: [usize; P],
    ) -> Chain<M, D, P> {
        let motion = &self.command.motion;
        let pick = |v: &Vector3<f64>| SVector::<f64, D>::from_fn(|k, _| v[axes[k]]);
        let jerk = motion.jerk_mps3();
        // noise that drowns in the rounding of the accelerations themselves is none
        let rounding =
            64.0 * f64::EPSILON * motion.acceleration_mps2().iter().map(Vector3::amax).fold(0.0, f64::max);
        let variance: Vec<SVector<f64, D>> = (0..motion.intervals())
            .map(|i| match self.command.trust {
                Trust::Known => SVector::zeros(),
                Trust::Unknown => SVector::repeat(f64::INFINITY),
                Trust::Noisy(noise) => pick(&noise.sd(&jerk[i])).map(|sd| {
                    let step = sd * motion.interval_s(i);
                    if step <= rounding { 0.0 } else { step * step }
                }),
            })
            .collect();
        let commanded =
            motion.acceleration_mps2().windows(2).map(|pair| pick(&(pair[1] - pair[0]))).collect();
        let mut fixed = vec![[false; D]; motion.intervals()];
        if self.command.known_ends == KnownEnds::Both && self.command.trust != Trust::Known {
            // where the last increments are known exactly, so are the nodes before them
            for k in 0..D {
                let mut i = motion.intervals() - 1;
                fixed[i][k] = true;
                while i > 0 && variance[i][k] == 0.0 {
                    i -= 1;
                    fixed[i][k] = true;
                }
            }
        }
        Chain {
            moments: moments(&self.positions, self.readings, &self.reference, axes),
            reference: self.reference.iter().map(pick).collect(),
            weight: pick(&self.noise).map(|noise| 1.0 / (noise * noise)),
            variance,
            commanded,
            fixed,
            prior: self.prior(slots),
            model: PhantomData,
        }
    }

    fn prior<const P: usize>(&self, slots: [usize; P]) -> Option<(SVector<f64, P>, SVector<f64, P>)> {
        if !self.settings.datasheet_prior {
            return None;
        }
        let sensor = self.problem.sensor;
        let parameters = sensor.parameter_list().describe(sensor, &sensor.nominal()?);
        let mean = SVector::from_fn(|k, _| parameters[slots[k]].nominal);
        let weight =
            SVector::from_fn(|k, _| parameters[slots[k]].spread.map_or(0.0, |spread| spread.powi(-2)));
        Some((mean, weight))
    }

    /// Parameters to begin with for trust `unknown`: the gain that the two ends show, unless noise hides it and a nominal one is known; the
    /// bias from the start.
    fn start_from_ends(&self, axis: usize) -> (f64, f64) {
        let last = self.reference.len() - 1;
        let clear = (self.reference[last][axis] - self.reference[0][axis]).abs() > 10.0 * self.noise[axis];
        let gain = match self.problem.sensor.gain {
            Some(nominal) if !clear => nominal[axis],
            _ => self.gain_from_data(axis),
        };
        (self.reference[0][axis] - gain * self.command.motion.acceleration_mps2()[0][axis], gain)
    }
}

/// A solved chain, or several merged, in the order of the parameter list.
pub(super) struct Solved {
    slots: Vec<usize>,
    pub(super) values: Vec<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) nodes: Vec<Vector3<f64>>,
    pub(super) node_sd: Vec<Vector3<f64>>,
    /// Effective number of unknowns that each axis' readings paid for: the trace of the hat matrix.
    pub(super) leverage: Vector3<f64>,
    /// For each lag from 1, what the fit takes from the autocovariance of each axis' residuals: `c_l = Σ_k P_{k,k+l}`.
    pub(super) shortfall: Vec<Vector3<f64>>,
    pub(super) chi2: f64,
    pub(super) degrees_of_freedom: usize,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

impl Solved {
    /// Puts independent chains together.
    pub(super) fn merge(parts: Vec<Solved>) -> Solved {
        let size: usize = parts.iter().map(|part| part.slots.len()).sum();
        let nodes = parts[0].nodes.len();
        let mut whole = Solved {
            slots: (0..size).collect(),
            values: vec![0.0; size],
            covariance: DMatrix::zeros(size, size),
            nodes: vec![Vector3::zeros(); nodes],
            node_sd: vec![Vector3::zeros(); nodes],
            leverage: Vector3::zeros(),
            shortfall: vec![Vector3::zeros(); parts[0].shortfall.len()],
            chi2: 0.0,
            degrees_of_freedom: 0,
            status: CalibrationStatus::Converged,
            iterations: 0,
            gradient_norm: 0.0,
        };
        for part in parts {
            for (i, &row) in part.slots.iter().enumerate() {
                whole.values[row] = part.values[i];
                for (j, &column) in part.slots.iter().enumerate() {
                    whole.covariance[(row, column)] = part.covariance[(i, j)];
                }
            }
            for (sum, node) in whole.nodes.iter_mut().zip(&part.nodes) {
                *sum += node;
            }
            for (sum, sd) in whole.node_sd.iter_mut().zip(&part.node_sd) {
                *sum += sd;
            }
            whole.leverage += part.leverage;
            for (sum, shortfall) in whole.shortfall.iter_mut().zip(&part.shortfall) {
                *sum += shortfall;
            }
            whole.chi2 += part.chi2;
            whole.degrees_of_freedom += part.degrees_of_freedom;
            whole.iterations = whole.iterations.max(part.iterations);
            whole.gradient_norm = whole.gradient_norm.max(part.gradient_norm);
            if part.status != CalibrationStatus::Converged {
                whole.status = part.status;
            }
        }
        whole
    }
}

/// Solves the chain of these axes; `slots` are the places of its parameters in the list.
pub(super) fn solve<M: ChainModel<D, P>, const D: usize, const P: usize>(
    context: &Context<'_>,
    axes: [usize; D],
    slots: [usize; P],
) -> std::result::Result<Solved, Vec<UndeterminedGroup>> {
    let chain = context.chain::<M, D, P>(axes, slots);
    let start = starting_state(context, &chain, axes, slots)?;
    let fit = chain.fit(start, context.settings).map_err(|node| vec![explain_node(context, axes, node)])?;
    Ok(summarise(&chain, fit, &context.pairs, axes, slots))
}

/// Checks that the parameters are determined where the motion is as commanded, and finds parameters to begin with.
fn starting_state<M: ChainModel<D, P>, const D: usize, const P: usize>(
    context: &Context<'_>,
    chain: &Chain<M, D, P>,
    axes: [usize; D],
    slots: [usize; P],
) -> std::result::Result<State<D, P>, Vec<UndeterminedGroup>> {
    let commanded: Vec<SVector<f64, D>> = context
        .command
        .motion
        .acceleration_mps2()
        .iter()
        .map(|a| SVector::from_fn(|k, _| a[axes[k]]))
        .collect();
    let last = commanded.len() - 1;
    let check = |information: &SMatrix<f64, P, P>, reference: &SVector<f64, P>| {
        let information = DMatrix::from_fn(P, P, |i, j| information[(i, j)]);
        let reference = nalgebra::DVector::from_fn(P, |i, _| reference[i]);
        let groups = information::undetermined(&information, &reference);
        if groups.is_empty() { Ok(()) } else { Err(explain(context, &groups, &slots)) }
    };
    if context.command.trust == Trust::Unknown {
        // the motion in between is free, so only the two known ends speak of the parameters
        let w = SMatrix::from_diagonal(&chain.weight);
        let (g0, g1) = (M::sensitivity(&commanded[0]), M::sensitivity(&commanded[last]));
        let mut information = g0.tr_mul(&(w * g0)) + g1.tr_mul(&(w * g1));
        if let Some((_, weight)) = &chain.prior {
            information += SMatrix::from_diagonal(weight);
        }
        check(&information, &information.diagonal())?;
        let mut p = SVector::zeros();
        for (k, &axis) in axes.iter().enumerate() {
            (p[k], p[D + k]) = context.start_from_ends(axis);
        }
        let inverse = M::matrix(&p).try_inverse().unwrap_or_else(SMatrix::identity);
        let mut a: Vec<_> = chain.reference.iter().map(|z| inverse * (z - M::bias(&p))).collect();
        (a[0], a[last]) = (commanded[0], commanded[last]);
        return Ok(State { p, a });
    }
    // with the motion as commanded the problem is linear in the parameters: one step from anywhere
    let mut start = State { p: SVector::zeros(), a: commanded };
    let as_commanded = chain.as_commanded(&start);
    check(&as_commanded.information, &as_commanded.information.diagonal())?;
    if let Some(step) = as_commanded.border_step(0.0) {
        start.p = step;
    }
    if context.command.trust != Trust::Known {
        let factored = chain.factor(&start).map_err(|node| vec![explain_node(context, axes, node)])?;
        check(&factored.0.information, &factored.1)?;
    }
    Ok(start)
}

/// Covariances, leverage and degrees of freedom of a fitted chain.
fn summarise<M: ChainModel<D, P>, const D: usize, const P: usize>(
    chain: &Chain<M, D, P>,
    fit: Fit<D, P>,
    pairs: &PairSums,
    axes: [usize; D],
    slots: [usize; P],
) -> Solved {
    let information = DMatrix::from_fn(P, P, |i, j| fit.system.information[(i, j)]);
    let determined = information::covariance(&information);
    let status = if determined.is_some() { fit.status } else { CalibrationStatus::Stalled };
    let covariance = determined.unwrap_or_else(|| DMatrix::zeros(P, P));
    let border = SMatrix::<f64, P, P>::from_fn(|i, j| covariance[(i, j)]);

    let spread = |v: &SVector<f64, D>| {
        let mut whole = Vector3::zeros();
        for (k, &axis) in axes.iter().enumerate() {
            whole[axis] = v[k];
        }
        whole
    };
    let s = M::matrix(&fit.state.p);
    let mut node_sd = vec![Vector3::zeros()];
    let mut leverage = SVector::<f64, D>::zeros();
    let mut shortfall = vec![SVector::<f64, D>::zeros(); pairs.lags];
    let mut g = M::sensitivity(&fit.state.a[0]);
    // variance of the fitted reading at the node before, and its covariance with the one before that and the sensitivity there
    let mut v_start = (g * border * g.transpose()).diagonal();
    let mut before: Option<(SMatrix<f64, D, P>, SVector<f64, D>)> = None;
    fit.system.walk_covariance(&border, |i, at| {
        node_sd.push(spread(&at.node1.diagonal().map(|variance| variance.max(0.0).sqrt())));
        let next = M::sensitivity(&fit.state.a[i + 1]);
        // covariance of the fitted readings at two nodes, from that of nodes and parameters
        let readings = |nodes: &SMatrix<f64, D, D>,
                        n1: &SMatrix<f64, D, P>,
                        n0: &SMatrix<f64, D, P>,
                        g0: &SMatrix<f64, D, P>| {
            (s * nodes * s.transpose()
                + s * n1 * g0.transpose()
                + next * n0.transpose() * s.transpose()
                + next * border * g0.transpose())
            .diagonal()
        };
        let v_end = readings(&at.node1, &at.node1_border, &at.node1_border, &next);
        let v_step = readings(&at.node1_node0, &at.node1_border, &at.node0_border, &g);
        let m = &chain.moments[i];
        leverage += v_start * m.m00 + v_step * (2.0 * m.m01) + v_end * m.m11;
        for (sum, pair) in shortfall.iter_mut().zip(pairs.of(i)) {
            let w = &pair.within;
            *sum += v_start * w.m11 + v_step * (w.m12 + w.m21) + v_end * w.m22;
        }
        if let (Some((g_before, v_before)), Some((node_border, nodes))) = (&before, &at.before) {
            let v_far = readings(nodes, &at.node1_border, node_border, g_before);
            for (sum, pair) in shortfall.iter_mut().zip(pairs.of(i)) {
                let a = &pair.across;
                *sum += v_before * a.m11 + v_far * a.m12 + v_start * a.m21 + v_step * a.m22;
            }
        }
        before = Some((g, v_step));
        (g, v_start) = (next, v_end);
    });
    leverage.component_mul_assign(&chain.weight);
    shortfall.iter_mut().for_each(|c| c.component_mul_assign(&chain.weight));

    let samples: usize = chain.moments.iter().map(|m| m.samples).sum();
    let mut residuals = samples * D + if chain.prior.is_some() { P } else { 0 };
    let mut unknowns = P;
    for (variance, fixed) in chain.variance.iter().zip(&chain.fixed) {
        for k in 0..D {
            residuals += usize::from(variance[k] > 0.0 && variance[k].is_finite());
            unknowns += usize::from(variance[k] > 0.0 && !fixed[k]);
        }
    }
    Solved {
        slots: slots.to_vec(),
        values: fit.state.p.iter().copied().collect(),
        covariance,
        nodes: fit.state.a.iter().map(spread).collect(),
        node_sd,
        leverage: spread(&leverage),
        shortfall: shortfall.iter().map(spread).collect(),
        chi2: fit.chi2,
        degrees_of_freedom: residuals.saturating_sub(unknowns),
        status,
        iterations: fit.iterations,
        gradient_norm: fit.gradient_norm,
    }
}

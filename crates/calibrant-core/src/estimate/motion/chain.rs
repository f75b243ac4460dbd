//! The solution of one chain.

use super::clock_equations::ClockEquations;
use super::context::Context;
use super::fit::{Chain, Fit, State};
use super::sample_pairs::PairSums;
use super::undetermined::{View, explain, explain_node};
use super::{CalibrationStatus, DMatrix, Trust, Vector3};
use crate::error::UndeterminedGroup;
use crate::information::{
    self,
    chain_model::{self as model, FittedNode, reading_covariance},
};
use crate::solve::Equations;
use nalgebra::{SMatrix, SVector};

/// A solved chain, or several merged, in the order of the parameter list.
pub(super) struct Solved {
    slots: Vec<usize>,
    pub(super) values: Vec<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) nodes: Vec<Vector3<f64>>,
    pub(super) node_sd: Vec<Vector3<f64>>,
    /// Effective number of unknowns of each axis: the trace of the hat matrix.
    pub(super) leverage: Vector3<f64>,
    /// Reduction of the autocovariance of each axis' residuals by the fit, for each lag from 1: `c_l = Σ_k P_{k,k+l}`.
    pub(super) shortfall: Vec<Vector3<f64>>,
    /// First-order bias of the estimate, since motion and parameters are estimated together. Empty unless the motion is noisy.
    pub(super) bias: Vec<f64>,
    pub(super) chi2: f64,
    pub(super) degrees_of_freedom: usize,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
    /// The equations of parameters and clock; none where the motion is unknown, of which nothing tells the time.
    pub(super) clock: Option<ClockEquations>,
}

impl Solved {
    /// Merges independent chains.
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
            bias: vec![0.0; size],
            chi2: 0.0,
            degrees_of_freedom: 0,
            status: CalibrationStatus::Converged,
            iterations: 0,
            gradient_norm: 0.0,
            clock: None,
        };
        let mut clocks = Vec::new();
        for mut part in parts {
            clocks.extend(part.clock.take().map(|equations| (part.slots.clone(), equations)));
            for (i, &row) in part.slots.iter().enumerate() {
                whole.values[row] = part.values[i];
                whole.bias[row] = part.bias[i];
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
        whole.clock = (!clocks.is_empty()).then(|| ClockEquations::sum(size, clocks.into_iter()));
        whole
    }
}

/// Solves the chain of these axes; `slots` are the places of its parameters in the list, Q = P + 2.
pub(super) fn solve<const D: usize, const P: usize, const Q: usize>(
    context: &Context<'_>,
    axes: [usize; D],
    slots: [usize; P],
) -> std::result::Result<Solved, Vec<UndeterminedGroup>> {
    let chain = context.chain::<D, P>(axes, slots);
    let (start, equations) = starting_state(context, &chain, axes, slots)?;
    let fit = chain.fit(start, equations, context.settings);
    let clock = (context.command.trust != Trust::Unknown)
        .then(|| chain.clock_equations::<Q>(&fit.point, &context.nodes_s()).ok())
        .flatten()
        .map(|(information, rhs)| ClockEquations {
            information: DMatrix::from_fn(Q, Q, |i, j| information[(i, j)]),
            rhs: nalgebra::DVector::from_fn(Q, |i, _| rhs[i]),
        });
    Ok(Solved { clock, ..summarise(&chain, fit, &context.pairs, axes, slots) })
}

/// A state and its equations.
type Start<const D: usize, const P: usize> = (State<D, P>, Equations<D, P>);

/// Checks that the commanded motion determines the parameters, and computes the initial ones.
fn starting_state<const D: usize, const P: usize>(
    context: &Context<'_>,
    chain: &Chain<D, P>,
    axes: [usize; D],
    slots: [usize; P],
) -> std::result::Result<Start<D, P>, Vec<UndeterminedGroup>> {
    let commanded: Vec<SVector<f64, D>> = context
        .command
        .motion
        .acceleration_mps2()
        .iter()
        .map(|a| SVector::from_fn(|k, _| a[axes[k]]))
        .collect();
    let last = commanded.len() - 1;
    let check = |information: &SMatrix<f64, P, P>, reference: &SVector<f64, P>, view: View| {
        let eliminated = if view == View::Noise { chain.moments.len() } else { 0 };
        let information = DMatrix::from_fn(P, P, |i, j| information[(i, j)]);
        let reference = nalgebra::DVector::from_fn(P, |i, _| reference[i]);
        let groups = information::undetermined(&information, &reference, eliminated);
        if groups.is_empty() { Ok(()) } else { Err(explain(context, &groups, &slots, view)) }
    };
    let factor =
        |state: &State<D, P>| chain.factor(state).map_err(|node| vec![explain_node(context, axes, node)]);

    if context.command.trust == Trust::Unknown {
        // the motion in between is free, so only the two known ends determine the parameters
        let mut ends =
            model::information::<D, P>(&chain.weight, [1.0, 0.0, 1.0], &commanded[0], &commanded[last]);
        if let Some((_, weight)) = &chain.prior {
            ends += SMatrix::from_diagonal(weight);
        }
        // ends of a sine are 0 to rounding: two usual samples of the motion are the scale
        let samples: usize = chain.moments.iter().map(|m| m.samples).sum();
        let state = State { p: SVector::zeros(), a: commanded.clone() };
        let usual = chain.as_commanded(&state).information.diagonal() * (2.0 / samples.max(2) as f64);
        check(&ends, &ends.diagonal().sup(&usual), View::Ends)?;
        let start = axes.map(|axis| context.start_from_ends(axis));
        let p = model::diagonal::<D, P>(
            &SVector::from_fn(|k, _| start[k].0),
            &SVector::from_fn(|k, _| start[k].1),
        );
        let mut a: Vec<_> = chain
            .reference
            .iter()
            .map(|z| SVector::from_fn(|k, _| (z[k] - start[k].0) / start[k].1))
            .collect();
        (a[0], a[last]) = (commanded[0], commanded[last]);
        let state = State { p, a };
        let equations = factor(&state)?;
        return Ok((state, equations));
    }
    // with the motion as commanded the problem is linear in the parameters: one step from anywhere
    let mut state = State { p: SVector::zeros(), a: commanded };
    let as_commanded = chain.as_commanded(&state);
    check(&as_commanded.information, &as_commanded.information.diagonal(), View::Command)?;
    if let Some(step) = as_commanded.border_step(0.0) {
        state.p = step;
    }
    let equations = factor(&state)?;
    if context.command.trust != Trust::Known {
        check(&equations.0.information, &equations.1, View::Noise)?;
    }
    Ok((state, equations))
}

/// Covariances, leverage and degrees of freedom of a fitted chain.
fn summarise<const D: usize, const P: usize>(
    chain: &Chain<D, P>,
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
    let s = model::matrix(&fit.point.p);
    let mut node_sd = Vec::with_capacity(fit.point.a.len());
    node_sd.push(Vector3::zeros());
    let mut leverage = SVector::<f64, D>::zeros();
    let mut shortfall = vec![SVector::<f64, D>::zeros(); pairs.lags];
    let mut start = FittedNode { a: fit.point.a[0], with_parameters: SMatrix::zeros() };
    let mut v_start = reading_covariance(&s, &SMatrix::zeros(), &start, &start, &border);
    // the node before the interval, and the covariance of the readings there with those at the interval's start
    let mut before: Option<(FittedNode<D, P>, SVector<f64, D>)> = None;
    fit.system.walk_covariance(&border, |i, at| {
        node_sd.push(spread(&at.node1.diagonal().map(|variance| variance.max(0.0).sqrt())));
        let end = FittedNode { a: fit.point.a[i + 1], with_parameters: at.node1_border };
        let v_end = reading_covariance(&s, &at.node1, &end, &end, &border);
        let v_step = reading_covariance(&s, &at.node1_node0, &end, &start, &border);
        let m = &chain.moments[i];
        leverage += v_start * m.m00 + v_step * (2.0 * m.m01) + v_end * m.m11;
        for (sum, pair) in shortfall.iter_mut().zip(pairs.interval(i)) {
            let w = &pair.within;
            *sum += v_start * w.m11 + v_step * (w.m12 + w.m21) + v_end * w.m22;
        }
        if let (Some((node, v_before)), Some((_, nodes))) = (&before, &at.before) {
            let v_far = reading_covariance(&s, nodes, &end, node, &border);
            for (sum, pair) in shortfall.iter_mut().zip(pairs.interval(i)) {
                let a = &pair.across;
                *sum += v_before * a.m11 + v_far * a.m12 + v_start * a.m21 + v_step * a.m22;
            }
        }
        let passed = std::mem::replace(&mut start, end);
        before = Some((passed, v_step));
        v_start = v_end;
    });
    let bias = border * information_of_the_walk(chain, &fit, &s);
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
        values: fit.point.p.iter().copied().collect(),
        covariance,
        nodes: fit.point.a.iter().map(spread).collect(),
        node_sd,
        leverage: spread(&leverage),
        shortfall: shortfall.iter().map(spread).collect(),
        bias: bias.iter().copied().collect(),
        chi2: fit.chi2,
        degrees_of_freedom: residuals.saturating_sub(unknowns),
        status,
        iterations: fit.iterations,
        gradient_norm: fit.gradient_norm,
        clock: None,
    }
}

/// Gradient of `½ ln det H_aa` with respect to the parameters, zero unless increments have a finite variance.
///
/// The likelihood of the parameters has the motion integrated out. The minimum over motion and parameters lacks this term: a larger `S` needs less
/// process noise to explain the same readings. The estimate is therefore biased by about `F⁻¹` times this gradient, which is of the order of N variances
/// of the relative scale factor. With `T = Σ_i Σ_k` covariance of the acceleration at sample k given the parameters, `∂/∂S_rc = w_r (S T)_rc`.
fn information_of_the_walk<const D: usize, const P: usize>(
    chain: &Chain<D, P>,
    fit: &Fit<D, P>,
    s: &SMatrix<f64, D, D>,
) -> SVector<f64, P> {
    let mut gradient = SVector::zeros();
    if chain.rigid || chain.variance.iter().all(|variance| variance.iter().all(|q| !q.is_finite())) {
        return gradient;
    }
    let mut t = SMatrix::<f64, D, D>::zeros();
    fit.system.walk_covariance(&SMatrix::zeros(), |i, at| {
        let m = &chain.moments[i];
        t += at.node0 * m.m00 + (at.node1_node0 + at.node1_node0.transpose()) * m.m01 + at.node1 * m.m11;
    });
    let st = s * t;
    for row in 0..D {
        for column in 0..D {
            gradient[row * (D + 1) + 1 + column] = chain.weight[row] * st[(row, column)];
        }
    }
    gradient
}

//! The linear-algebra kernel: it factors a block chain with a border in time and memory linear in its length.
//! It does not depend on sensors, and uses only nalgebra.
//!
//! Gauss–Newton on a chain of nodes `a_0 … a_N` (blocks of size D) and a border of parameters `p` (size P)
//! gives an arrowhead. Its normal equations are block tridiagonal in `a` and bordered by `p`. Two kinds of
//! information make them up. The data of each interval are a [`Link`] between its two nodes and the border.
//! The prior on each increment `a_{i+1} − a_i` is an [`Increment`] of variance `q`.
//!
//! # One kernel for every degree of trust
//! With the weight `1/q`, the normal matrix breaks down as `q → 0`, where the increment is known exactly (a
//! constraint). Rounding destroys the data long before. So the chain is eliminated from its end to its start
//! in **increment coordinates**:
//!
//! `δa_{i+1} = t ∘ δa_i + ρ + l ∘ w`, cost of `w`: `½ wᵀ diag(d) w`
//!
//! | increment | t | l | d |
//! |---|---|---|---|
//! | known exactly, `q = 0` | 1 | 0 | 1 |
//! | known with variance `0 < q < ∞` | 1 | √q | 1 |
//! | unknown, `q = ∞` | 0 | 1 | 0 |
//! | ends in a node that is itself known | 0 | 0 | 1 |
//!
//! Eliminating `w` has the pivot `diag(d) + diag(l) H diag(l)`. Here `H` is the information that the data
//! right of node i have on node i+1. The pivot is at least one wherever there is a prior, so nothing is
//! divided by a vanishing `q`. The thesis's problems (5), (6) and (3) are the rows `q = 0`, `0 < q < ∞` and
//! `q = ∞` of one table.
//!
//! # Cost
//! The elimination takes `O(N D (D + P)²)` flops. It keeps one gain of `D (2D + P + 1)` numbers for each
//! interval. It asks for links one at a time, so the caller need not store them. The Schur complement `F` on
//! the border remains: the Fisher information of the parameters with the motion marginalised.

use nalgebra::{SMatrix, SVector};

/// Normal equations of the data in one interval, in its first node (0), its last node (1) and the border.
#[derive(Debug, Clone)]
pub struct Link<const D: usize, const P: usize> {
    /// Information on node 0 with itself.
    pub h00: SMatrix<f64, D, D>,
    /// Information on node 0 with node 1.
    pub h01: SMatrix<f64, D, D>,
    /// Information on node 1 with itself.
    pub h11: SMatrix<f64, D, D>,
    /// Information on node 0 with the border.
    pub b0: SMatrix<f64, D, P>,
    /// Information on node 1 with the border.
    pub b1: SMatrix<f64, D, P>,
    /// Information on the border.
    pub c: SMatrix<f64, P, P>,
    /// Right-hand side (negative gradient) of node 0.
    pub g0: SVector<f64, D>,
    /// Right-hand side of node 1.
    pub g1: SVector<f64, D>,
    /// Right-hand side of the border.
    pub gp: SVector<f64, P>,
}

impl<const D: usize, const P: usize> Link<D, P> {
    /// Without information.
    #[must_use]
    pub fn zero() -> Self {
        Self {
            h00: SMatrix::zeros(),
            h01: SMatrix::zeros(),
            h11: SMatrix::zeros(),
            b0: SMatrix::zeros(),
            b1: SMatrix::zeros(),
            c: SMatrix::zeros(),
            g0: SVector::zeros(),
            g1: SVector::zeros(),
            gp: SVector::zeros(),
        }
    }
}

/// The prior on `a_{i+1} − a_i`, per coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Increment<const D: usize> {
    /// Variance `q`: 0 where the increment is known exactly, infinite where nothing is known.
    pub variance: SVector<f64, D>,
    /// Expected increment less the present one, `ρ`.
    pub residual: SVector<f64, D>,
    /// Is node i+1 itself known (and so does not move)?
    pub fixed: [bool; D],
}

impl<const D: usize> Increment<D> {
    /// An increment without a prior.
    #[must_use]
    pub fn unknown() -> Self {
        Self { variance: SVector::repeat(f64::INFINITY), residual: SVector::zeros(), fixed: [false; D] }
    }
}

/// A node that neither data nor prior determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undetermined {
    /// The node, 1..=N.
    pub node: usize,
    /// Its coordinate, 0..D.
    pub coordinate: usize,
}

/// How `w` of one interval follows from its first node and the border: `w = k_0 − K_a δa_i − K_p δp`.
#[derive(Debug, Clone)]
struct Gain<const D: usize, const P: usize> {
    t: SVector<f64, D>,
    l: SVector<f64, D>,
    rho: SVector<f64, D>,
    k0: SVector<f64, D>,
    ka: SMatrix<f64, D, D>,
    kp: SMatrix<f64, D, P>,
    /// Covariance of `w` when node i and border are known: the inverse of the pivot.
    covariance: SMatrix<f64, D, D>,
}

/// The factored system. Node 0 is known.
#[derive(Debug, Clone)]
pub struct Arrowhead<const D: usize, const P: usize> {
    intervals: usize,
    /// One for each interval; none where the chain is rigid.
    gains: Vec<Gain<D, P>>,
    /// Schur complement `F` on the border: the information on the parameters, chain marginalised.
    pub information: SMatrix<f64, P, P>,
    /// Right-hand side of the border after elimination.
    pub rhs: SVector<f64, P>,
}

/// Relative size below which a pivot counts as zero: some thousand roundings.
const SINGULAR: f64 = 1e-12;

impl<const D: usize, const P: usize> Arrowhead<D, P> {
    /// Eliminates the chain, last node first.
    ///
    /// `link(i)` and `increment(i)` describe interval i of `intervals`; `border` and `rhs` start the border's equations (a prior, or zero).
    ///
    /// # Errors
    /// [`Undetermined`] names a node on which there is no information.
    pub fn eliminate(
        intervals: usize,
        mut link: impl FnMut(usize) -> Link<D, P>,
        mut increment: impl FnMut(usize) -> Increment<D>,
        border: SMatrix<f64, P, P>,
        rhs: SVector<f64, P>,
    ) -> Result<Self, Undetermined> {
        let mut gains = Vec::with_capacity(intervals);
        let (mut information, mut border_rhs) = (border, rhs);
        // what the intervals right of the present node contribute to it
        let (mut h, mut b, mut g) =
            (SMatrix::<f64, D, D>::zeros(), SMatrix::<f64, D, P>::zeros(), SVector::<f64, D>::zeros());
        // the node's information before any elimination: the scale of rounding
        let mut unreduced = SVector::<f64, D>::zeros();
        for i in (0..intervals).rev() {
            let here = link(i);
            let known = increment(i);
            h += here.h11;
            b += here.b1;
            g += here.g1;
            unreduced += here.h11.diagonal();
            information += here.c;
            border_rhs += here.gp;

            let (mut t, mut l, mut d) =
                (SVector::<f64, D>::zeros(), SVector::<f64, D>::zeros(), SVector::<f64, D>::repeat(1.0));
            let mut rho = SVector::<f64, D>::zeros();
            let (mut pull, mut pull_rhs) = (SVector::<f64, D>::zeros(), SVector::<f64, D>::zeros());
            for axis in 0..D {
                let q = known.variance[axis];
                if known.fixed[axis] {
                    if q > 0.0 && q.is_finite() {
                        pull[axis] = 1.0 / q;
                        pull_rhs[axis] = -known.residual[axis] / q;
                    }
                } else if q == f64::INFINITY {
                    (l[axis], d[axis]) = (1.0, 0.0);
                } else {
                    (t[axis], l[axis], rho[axis]) = (1.0, q.sqrt(), known.residual[axis]);
                }
            }

            // move the expansion point by ρ, then eliminate w
            g -= h * rho;
            border_rhs -= b.tr_mul(&rho);
            let g0 = here.g0 - here.h01 * rho;
            let pivot = SMatrix::from_fn(|r, c| l[r] * h[(r, c)] * l[c] + if r == c { d[r] } else { 0.0 });
            let to_node = SMatrix::from_fn(|r, c| l[r] * (here.h01[(c, r)] + h[(r, c)] * t[c]));
            let to_border = SMatrix::from_fn(|r, c| l[r] * b[(r, c)]);
            let rhs_w = l.component_mul(&g);
            let covariance = invert(&pivot, &d, &l, &unreduced)
                .map_err(|coordinate| Undetermined { node: i + 1, coordinate })?;
            let (k0, ka, kp) = (covariance * rhs_w, covariance * to_node, covariance * to_border);

            subtract_symmetric_product(&mut information, &to_border, &kp);
            border_rhs -= to_border.tr_mul(&k0);
            g = g0 + t.component_mul(&g) - to_node.tr_mul(&k0) + pull_rhs;
            b = SMatrix::from_fn(|r, c| here.b0[(r, c)] + t[r] * b[(r, c)]) - to_node.tr_mul(&kp);
            let reduced = to_node.tr_mul(&ka);
            h = SMatrix::from_fn(|r, c| {
                let own = here.h00[(r, c)] + t[r] * h[(r, c)] * t[c] + if r == c { pull[r] } else { 0.0 };
                let cross = here.h01[(r, c)] * t[c] + t[r] * here.h01[(c, r)];
                own + cross - 0.5 * (reduced[(r, c)] + reduced[(c, r)])
            });
            unreduced = here.h00.diagonal() + t.component_mul(&unreduced) + pull;
            gains.push(Gain { t, l, rho, k0, ka, kp, covariance });
        }
        gains.reverse();
        Ok(Self { intervals, gains, information, rhs: border_rhs })
    }

    /// The system of a chain whose increments are all known exactly. Only the parameters' own equations are
    /// left; nothing is eliminated.
    #[must_use]
    pub fn rigid(intervals: usize, information: SMatrix<f64, P, P>, rhs: SVector<f64, P>) -> Self {
        Self { intervals, gains: Vec::new(), information, rhs }
    }

    /// The border's step `(F + damping · diag F)⁻¹ g`; `None` where `F` is not positive definite.
    ///
    /// `F` is first scaled to unit diagonal. The units of the parameters then do not matter.
    #[must_use]
    pub fn border_step(&self, damping: f64) -> Option<SVector<f64, P>> {
        let f = &self.information;
        let scale = f.diagonal().map(|d| 1.0 / d.sqrt());
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let scaled = SMatrix::<f64, P, P>::from_fn(|i, j| {
            f[(i, j)] * scale[i] * scale[j] + if i == j { damping } else { 0.0 }
        });
        let cholesky = nalgebra::Cholesky::<f64, nalgebra::Const<P>>::new(scaled)?;
        Some(cholesky.solve(&self.rhs.component_mul(&scale)).component_mul(&scale))
    }

    /// Norm of the border's gradient in the metric of its covariance, `√(gᵀ F⁻¹ g)`. It is the length of the
    /// full step in standard deviations. Infinite where `F` is not positive definite.
    #[must_use]
    pub fn gradient_norm(&self) -> f64 {
        self.border_step(0.0).map_or(f64::INFINITY, |step| step.dot(&self.rhs).max(0.0).sqrt())
    }

    /// The chain's step that goes with a step of the border: `δa_0 … δa_N`, with `δa_0 = 0`.
    #[must_use]
    pub fn chain_step(&self, border_step: &SVector<f64, P>) -> Vec<SVector<f64, D>> {
        if self.gains.is_empty() {
            return vec![SVector::zeros(); self.intervals + 1];
        }
        let mut step = SVector::zeros();
        let mut steps = Vec::with_capacity(self.intervals + 1);
        steps.push(step);
        for gain in &self.gains {
            let w = gain.k0 - gain.ka * step - gain.kp * border_step;
            step = gain.t.component_mul(&step) + gain.rho + gain.l.component_mul(&w);
            steps.push(step);
        }
        steps
    }

    /// Walks the joint covariance of each interval's nodes and the border, from the border's covariance, first interval first.
    pub fn walk_covariance(
        &self,
        border: &SMatrix<f64, P, P>,
        mut visit: impl FnMut(usize, &IntervalCovariance<D, P>),
    ) {
        if self.gains.is_empty() {
            let at = IntervalCovariance::known();
            (0..self.intervals).for_each(|i| visit(i, &at));
            return;
        }
        let mut node = SMatrix::<f64, D, D>::zeros();
        let mut node_border = SMatrix::<f64, D, P>::zeros();
        let mut before: Option<Before<D, P>> = None;
        for (i, gain) in self.gains.iter().enumerate() {
            let lm = SMatrix::from_diagonal(&gain.l);
            let w_node = -(gain.ka * node + gain.kp * node_border.transpose());
            let w_border = -(gain.ka * node_border + gain.kp * border);
            let w_w = gain.covariance - w_node * gain.ka.transpose() - w_border * gain.kp.transpose();
            let tm = SMatrix::from_diagonal(&gain.t);
            let next_node = tm * node + lm * w_node;
            let next_border = tm * node_border + lm * w_border;
            let next = next_node * tm + tm * w_node.transpose() * lm + lm * w_w * lm;
            let next = (next + next.transpose()) * 0.5;
            let far = before.map(|(border_before, node_before)| {
                let w_before = -(gain.ka * node_before + gain.kp * border_before.transpose());
                (border_before, tm * node_before + lm * w_before)
            });
            visit(
                i,
                &IntervalCovariance {
                    node0: node,
                    node1: next,
                    node1_node0: next_node,
                    node0_border: node_border,
                    node1_border: next_border,
                    before: far,
                },
            );
            before = Some((node_border, next_node));
            (node, node_border) = (next, next_border);
        }
    }
}

/// `F ← F − XᵀY` where the product is symmetric: both halves from one.
fn subtract_symmetric_product<const D: usize, const P: usize>(
    f: &mut SMatrix<f64, P, P>,
    x: &SMatrix<f64, D, P>,
    y: &SMatrix<f64, D, P>,
) {
    for j in 0..P {
        for i in 0..=j {
            let product: f64 = (0..D).map(|k| x[(k, i)] * y[(k, j)]).sum();
            f[(i, j)] -= product;
            if i != j {
                f[(j, i)] -= product;
            }
        }
    }
}

/// Covariance of a node with the border (D × P), and covariance of a later node with that node (D × D).
pub type Before<const D: usize, const P: usize> = (SMatrix<f64, D, P>, SMatrix<f64, D, D>);

/// Joint covariance of an interval's two nodes with each other and with the border.
#[derive(Debug, Clone)]
pub struct IntervalCovariance<const D: usize, const P: usize> {
    /// First node.
    pub node0: SMatrix<f64, D, D>,
    /// Last node.
    pub node1: SMatrix<f64, D, D>,
    /// Last node with first node.
    pub node1_node0: SMatrix<f64, D, D>,
    /// First node with border.
    pub node0_border: SMatrix<f64, D, P>,
    /// Last node with border.
    pub node1_border: SMatrix<f64, D, P>,
    /// The node before the first: its covariance with the border, and the covariance of the last node with
    /// it.
    pub before: Option<Before<D, P>>,
}

impl<const D: usize, const P: usize> IntervalCovariance<D, P> {
    /// Both nodes are known.
    fn known() -> Self {
        let (node, border) = (SMatrix::zeros(), SMatrix::zeros());
        Self {
            node0: node,
            node1: node,
            node1_node0: node,
            node0_border: border,
            node1_border: border,
            before: Some((border, node)),
        }
    }
}

/// Inverse of a pivot, or the coordinate on which there is no information. `l` and `d` show which coordinates
/// have no prior. `scale` is the information on the node before elimination.
fn invert<const D: usize>(
    pivot: &SMatrix<f64, D, D>,
    d: &SVector<f64, D>,
    l: &SVector<f64, D>,
    scale: &SVector<f64, D>,
) -> Result<SMatrix<f64, D, D>, usize> {
    for axis in 0..D {
        let floor = SINGULAR * scale[axis] * l[axis] * l[axis];
        if d[axis] == 0.0 && !(pivot[(axis, axis)] > floor && pivot[(axis, axis)] > 0.0) {
            return Err(axis);
        }
    }
    if D == 1 {
        return Ok(SMatrix::repeat(1.0 / pivot[(0, 0)]));
    }
    // scaled to unit diagonal: node information and unit prior weights may differ by many orders of magnitude
    let s = SVector::<f64, D>::from_fn(|axis, _| 1.0 / pivot[(axis, axis)].sqrt());
    let scaled = SMatrix::from_fn(|row, column| pivot[(row, column)] * s[row] * s[column]);
    let inverse = nalgebra::Cholesky::<f64, nalgebra::Const<D>>::new(scaled).ok_or(0_usize)?.inverse();
    Ok(SMatrix::from_fn(|row, column| inverse[(row, column)] * s[row] * s[column]))
}

#[cfg(test)]
mod tests;

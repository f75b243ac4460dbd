//! A feasible primal–dual interior point with a quasi-Newton Hessian (`nocedal2006`, chapter 19).
//!
//! `minimise Φ(x)` subject to `G(x) > 0`: the limits at control points and at times. Every iterate keeps them. With multipliers `λ` and the barrier parameter `μ`, a step
//! solves Newton's equations of `∇Φ − Jᵀλ = 0`, `G ∘ λ = μ`:
//!
//! ```text
//! (B + Jᵀ (Λ/G) J) d = −(∇Φ − Jᵀ(μ/G))        λ⁺ = μ/G − (Λ/G) J d
//! ```
//!
//! `B` is the Hessian of the Lagrangian, by damped BFGS. A step stays inside of the limits, and falls on the barrier function `Φ − μ Σ ln G` (Armijo). When the
//! barrier function hardly falls, `μ` is lowered.
//!
//! Limits that the start breaks (those at new times, where knots were halved) are first shifted by `relax`, which closes as the steps leave room.

use super::band::{Band, dot};
use super::objective::Objective;
use super::quasi_newton::QuasiNewton;
use super::rows::Rows;
use crate::limits::Linear;
use crate::motion::Ties;
use calibrant_design::{DesignStatus, Interruption};

/// How one run goes.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    /// The first barrier parameter, and the last, in nats: each limit keeps the criterion about this far from its optimum.
    pub(crate) barrier: (f64, f64),
    pub(crate) max_iterations: usize,
    /// A step that lowers the barrier function by less than this is small.
    pub(crate) stall: f64,
    pub(crate) interruption: Interruption,
}

/// Where a run ended.
#[derive(Debug, Clone)]
pub(crate) struct Reached {
    pub(crate) x: Vec<f64>,
    pub(crate) value: f64,
    pub(crate) iterations: usize,
    pub(crate) status: DesignStatus,
    /// What is left of the shift of limits: 0 where all are kept.
    pub(crate) relax: f64,
}

/// Part of the way to a limit that a step may go, for limits and for multipliers.
const TO_LIMIT: (f64, f64) = (0.9, 0.95);
/// A step leaves this part of each slack at least.
const LEFT: f64 = 0.05;
/// Part of the linear decrease that a step must reach (Armijo).
const DECREASE: f64 = 1e-4;
/// Halvings of a step.
const HALVINGS: usize = 14;
/// Factor by which the barrier parameter falls.
const BARRIER_FALLS: f64 = 0.25;
/// Multipliers stay within this factor of `μ/G`.
const MULTIPLIER: f64 = 1e3;
/// Room that the first shift of limits leaves, and least room to end it.
const ROOM: (f64, f64) = (0.02, 1e-4);

/// One run.
pub(crate) struct InteriorPoint<'s, 'a> {
    pub(crate) objective: &'s mut Objective<'a>,
    pub(crate) rows: &'s mut Rows<'a>,
    pub(crate) linear: &'s Linear,
    pub(crate) ties: &'s Ties,
}

/// All that belongs to an iterate.
struct Iterate {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
    /// Values of the pointwise rows (shifted), and slacks of the linear ones.
    g: Vec<f64>,
    l: Vec<f64>,
    /// Their inverses.
    inverse: [Vec<f64>; 2],
}

impl Iterate {
    /// One division for each slack: they are used many times.
    fn invert(&mut self) {
        self.inverse = [&self.g, &self.l].map(|slacks| slacks.iter().map(|slack| 1.0 / slack).collect());
    }
}

/// A step that is taken.
struct Trial {
    /// Without its gradient.
    iterate: Iterate,
    /// Do the rows have their derivatives there?
    with_slopes: bool,
    /// How much the barrier function falls.
    fall: f64,
}

impl InteriorPoint<'_, '_> {
    /// Minimises from a motion that keeps the limits on control points.
    pub(crate) fn run(&mut self, start: Vec<f64>, steps: &Steps) -> Reached {
        let (mut mu, last_mu) = steps.barrier;
        let least = self.rows.evaluate(&self.ties.controls_of(&start), false);
        let mut relax = if least > 0.0 { 0.0 } else { ROOM.0 - least };
        let mut reached = Reached {
            x: start.clone(),
            value: f64::INFINITY,
            iterations: 0,
            status: DesignStatus::Stalled,
            relax,
        };
        let Some(mut at) = self.iterate(start, relax) else { return reached };
        let mut multipliers = at.inverse.each_ref().map(|inverse| scaled(mu, inverse));
        let mut hessian = QuasiNewton::new();
        let mut band = Band::zeros(self.ties.len(), 4 * self.ties.joints());
        let mut small = 0;
        while reached.iterations < steps.max_iterations {
            if steps.interruption.is_asked() {
                reached.status = DesignStatus::Interrupted;
                break;
            }
            reached.iterations += 1;
            // direction
            self.barrier_hessian(&at, &multipliers, hessian.sigma(), &mut band);
            let right = self.descent(&at, mu);
            let direction = if band.factor() { hessian.solve(&band, &right) } else { None };
            let Some(d) = direction.filter(|d| dot(d, &right) > 0.0) else {
                if hessian.is_new() {
                    break;
                }
                hessian.forget();
                continue;
            };
            let (changes_g, changes_l) = self.changes(&d);
            let new_multipliers = [
                proposed(mu, &at.inverse[0], &multipliers[0], &changes_g),
                proposed(mu, &at.inverse[1], &multipliers[1], &changes_l),
            ];
            // multipliers
            let part = multiplier_step(&multipliers, &new_multipliers);
            for (own, new) in multipliers.iter_mut().zip(&new_multipliers) {
                for (own, new) in own.iter_mut().zip(new) {
                    *own += part * (new - *own);
                }
            }
            let old = self.lagrangian(&at.gradient, &multipliers);
            // step
            let longest = longest(&at.inverse[0], &changes_g).min(longest(&at.inverse[1], &changes_l));
            let before = barrier(&at, mu);
            let Some(Trial { mut iterate, with_slopes, fall }) =
                self.line_search(&at, &d, longest, (before, dot(&d, &right)), mu, relax)
            else {
                if mu <= last_mu {
                    break;
                }
                mu = (mu * BARRIER_FALLS).max(last_mu);
                clamp(&mut multipliers, &at, mu);
                self.rows.evaluate(&self.ties.controls_of(&at.x), true);
                continue;
            };
            // update
            let step: Vec<f64> = iterate.x.iter().zip(&at.x).map(|(new, old)| new - old).collect();
            if !with_slopes {
                self.rows.evaluate(&self.ties.controls_of(&iterate.x), true);
            }
            let Some(gradient) = self.objective.gradient() else { break };
            iterate.gradient = self.ties.gradient(&gradient);
            if relax > 0.0 {
                let least = iterate.g.iter().copied().fold(f64::INFINITY, f64::min) - relax;
                let left = if least > ROOM.1 { 0.0 } else { (relax - 0.6 * (least + relax)).max(0.0) };
                for g in &mut iterate.g {
                    *g += left - relax;
                }
                relax = left;
            }
            iterate.invert();
            at = iterate;
            let new = self.lagrangian(&at.gradient, &multipliers);
            let change: Vec<f64> = new.iter().zip(&old).map(|(new, old)| new - old).collect();
            hessian.update(step, &change);
            clamp(&mut multipliers, &at, mu);
            // next barrier
            let is_small = relax == 0.0 && fall < steps.stall.max(0.002 * mu * at.x.len() as f64);
            small = if is_small { small + 1 } else { 0 };
            if small >= 2 {
                small = 0;
                if mu <= last_mu {
                    reached.status = DesignStatus::Converged;
                    break;
                }
                mu = (mu * BARRIER_FALLS).max(last_mu);
            }
        }
        if reached.iterations >= steps.max_iterations && reached.status == DesignStatus::Stalled {
            reached.status = DesignStatus::IterationLimit;
        }
        Reached { x: at.x, value: at.value, relax, ..reached }
    }

    /// All of an iterate, with the limits' derivatives.
    fn iterate(&mut self, x: Vec<f64>, relax: f64) -> Option<Iterate> {
        let controls = self.ties.controls_of(&x);
        let value = self.objective.value(&controls);
        let gradient = self.ties.gradient(&self.objective.gradient()?);
        self.rows.evaluate(&controls, true);
        let g = self.rows.values.iter().map(|value| value + relax).collect();
        let mut l = vec![0.0; self.linear.len()];
        self.linear.slacks(&x, &mut l);
        let mut iterate = Iterate { x, value, gradient, g, l, inverse: [Vec::new(), Vec::new()] };
        iterate.invert();
        Some(iterate)
    }

    /// `σ I + Jᵀ (Λ/G) J`.
    fn barrier_hessian(&self, at: &Iterate, multipliers: &[Vec<f64>; 2], sigma: f64, band: &mut Band) {
        band.clear();
        for i in 0..at.x.len() {
            band.add(i, i, sigma);
        }
        self.rows.add_squares(&products(&multipliers[0], &at.inverse[0]), band);
        self.linear
            .add_squares(&products(&multipliers[1], &at.inverse[1]), |i, j, value| band.add(i, j, value));
    }

    /// `Jᵀλ`.
    fn transposed(&self, of_rows: &[f64], of_linear: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.ties.len()];
        self.rows.add_transposed(of_rows, &mut sum);
        self.linear.add_transposed(of_linear, &mut sum);
        sum
    }

    /// `−(∇Φ − Jᵀ(μ/G))`.
    fn descent(&self, at: &Iterate, mu: f64) -> Vec<f64> {
        let pushed = self.transposed(&scaled(mu, &at.inverse[0]), &scaled(mu, &at.inverse[1]));
        pushed.iter().zip(&at.gradient).map(|(pushed, gradient)| pushed - gradient).collect()
    }

    /// `∇Φ − Jᵀλ`.
    fn lagrangian(&self, gradient: &[f64], multipliers: &[Vec<f64>; 2]) -> Vec<f64> {
        let of_limits = self.transposed(&multipliers[0], &multipliers[1]);
        gradient.iter().zip(of_limits).map(|(gradient, of)| gradient - of).collect()
    }

    /// `J d`.
    fn changes(&self, d: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut of_rows, mut of_linear) = (vec![0.0; self.rows.values.len()], vec![0.0; self.linear.len()]);
        self.rows.changes(d, &mut of_rows);
        self.linear.changes(d, &mut of_linear);
        (of_rows, of_linear)
    }

    /// The longest of the halved steps that stays inside and falls: what it reaches, and by how much the barrier function falls.
    fn line_search(
        &mut self,
        at: &Iterate,
        d: &[f64],
        longest: f64,
        (before, slope): (f64, f64),
        mu: f64,
        relax: f64,
    ) -> Option<Trial> {
        let mut length = longest;
        let mut l = vec![0.0; self.linear.len()];
        let mut with_slopes = true;
        for _ in 0..HALVINGS {
            let x: Vec<f64> = at.x.iter().zip(d).map(|(x, d)| x + length * d).collect();
            self.linear.slacks(&x, &mut l);
            if stays(&l, &at.l) {
                let controls = self.ties.controls_of(&x);
                // the first trial mostly succeeds
                self.rows.evaluate(&controls, with_slopes);
                let g: Vec<f64> = self.rows.values.iter().map(|value| value + relax).collect();
                if stays(&g, &at.g) {
                    let value = self.objective.value(&controls);
                    let iterate = Iterate {
                        x,
                        value,
                        gradient: Vec::new(),
                        g,
                        l: l.clone(),
                        inverse: Default::default(),
                    };
                    let fall = before - barrier(&iterate, mu);
                    if fall >= DECREASE * length * slope {
                        return Some(Trial { iterate, with_slopes, fall });
                    }
                }
                with_slopes = false;
            }
            length *= 0.5;
        }
        None
    }
}

/// `Φ − μ Σ ln G`.
fn barrier(at: &Iterate, mu: f64) -> f64 {
    at.value - mu * (logarithms(&at.g) + logarithms(&at.l))
}

/// `Σ ln x` of positive numbers, with few logarithms: products of eight stay far from the ends of the range of numbers.
fn logarithms(values: &[f64]) -> f64 {
    values.chunks(8).map(|eight| eight.iter().product::<f64>().ln()).sum()
}

fn scaled(mu: f64, inverse: &[f64]) -> Vec<f64> {
    inverse.iter().map(|inverse| mu * inverse).collect()
}

fn products(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(one, other)| one * other).collect()
}

/// `μ/G − (Λ/G) J d`.
fn proposed(mu: f64, inverse: &[f64], multipliers: &[f64], changes: &[f64]) -> Vec<f64> {
    let each = inverse.iter().zip(multipliers).zip(changes);
    each.map(|((inverse, multiplier), change)| (mu - multiplier * change) * inverse).collect()
}

/// The longest step, at most 1, that keeps a part of each slack to first order.
fn longest(inverse: &[f64], changes: &[f64]) -> f64 {
    let most = inverse.iter().zip(changes).map(|(inverse, change)| -change * inverse).fold(0.0, f64::max);
    if most > TO_LIMIT.0 { TO_LIMIT.0 / most } else { 1.0 }
}

/// The longest part of the multipliers' step, at most 1, that keeps them positive.
fn multiplier_step(own: &[Vec<f64>; 2], new: &[Vec<f64>; 2]) -> f64 {
    let pairs = own.iter().flatten().zip(new.iter().flatten());
    let most = pairs.map(|(own, new)| (own - new) / own).fold(0.0, f64::max);
    if most > TO_LIMIT.1 { TO_LIMIT.1 / most } else { 1.0 }
}

/// Is a part of each slack left?
fn stays(new: &[f64], old: &[f64]) -> bool {
    new.iter().zip(old).all(|(new, old)| *new > LEFT * old)
}

fn clamp(multipliers: &mut [Vec<f64>; 2], at: &Iterate, mu: f64) {
    for (multipliers, inverse) in multipliers.iter_mut().zip(&at.inverse) {
        for (multiplier, inverse) in multipliers.iter_mut().zip(inverse) {
            let middle = mu * inverse;
            *multiplier = multiplier.clamp(middle * (1.0 / MULTIPLIER), middle * MULTIPLIER);
        }
    }
}

//! An upper bound on the motion variance of any admissible motion of one axis. It chooses among relaxations
//! by their cost.

use super::bounds::StateBounds;
use super::dual_bound::Patience;
use super::moment_relaxation::ChainPart;
use super::moment_solver;
use super::{AxisChain, States};
use crate::Interruption;
use calibrant_core::motion::Rest;
use std::ops::Range;

/// An upper bound on the motion variance `V = Σ α² − (Σ α + shift)²/mass` over all admissible motions of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionVarianceBound {
    /// The bound, (m/s²)².
    pub(crate) value: f64,
    /// Where it comes from.
    pub(crate) kind: BoundKind,
    /// Did the conic solver reach its solution? The bound holds in any case; otherwise it is looser than
    /// necessary.
    pub(crate) solved: bool,
    /// Part of `value` that covers the solver's residual and rounding.
    pub(crate) correction: f64,
}

/// Where a bound comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BoundKind {
    /// Moment relaxation of the whole chain.
    Chain {
        /// Is `(Σ α + shift)²/mass` part of it, or dropped?
        mean: bool,
        /// Were velocity or displacement states needed?
        states: bool,
    },
    /// Moment relaxations of segments of the chain that may each start and end anywhere.
    Stretches,
    /// Every node at its largest acceleration at once.
    StateBounds,
    /// Every node as far from the middle of the motion as the largest jerk takes it.
    Jerk,
}

impl BoundKind {
    /// What the bound is and why it may be loose, for a reader who has not seen one before.
    pub(crate) fn explanation(self) -> &'static str {
        match self {
            Self::Chain { states: false, mean: true } => {
                "a moment relaxation of the whole motion, in most cases exact to within rounding"
            }
            Self::Chain { states: false, .. } => {
                "a moment relaxation of the whole motion that leaves out what the mean acceleration costs: loose where the best motion is not balanced"
            }
            Self::Chain { states: true, mean: true } => {
                "a moment relaxation of the whole motion that holds velocity and displacement to their limits at four times in each interval: usually loose by some percent of a standard deviation"
            }
            Self::Chain { states: true, .. } => {
                "a moment relaxation of the whole motion that holds velocity and displacement to their limits at four times in each interval and leaves out what the mean acceleration costs: usually loose by some percent of a standard deviation"
            }
            Self::Stretches => {
                "the motion is long, so its stretches were bounded one by one as if each could start and end anywhere: loose where they cannot"
            }
            Self::StateBounds => {
                "every node was taken at its largest acceleration at once, which no motion may be able to do: can be loose by a factor"
            }
            Self::Jerk => {
                "in the time that there is, the largest jerk takes no node further from the acceleration in the middle; exact where a straight line keeps the limits"
            }
        }
    }
}

/// Largest number of iterations of the conic solver; it needs some 20.
const MAX_ITERATIONS: u32 = 100;
/// Places inside each interval at which limits on velocity and displacement are imposed.
const INSIDE: [f64; 3] = [0.25, 0.5, 0.75];
/// Most intervals for moments up to degree 6 with states. They take two seconds of processor time.
const MOST_HIGH_ORDER: usize = 40;
/// Most variables of a clique: with moments up to degree 4 and up to degree 6.
const VARIABLES: (usize, usize) = (5, 4);
/// Relative accuracy of a bound: with and without states. Without them, bounds are exact in most cases.
const TOLERANCE: (f64, f64) = (3e-4, 1e-7);
/// Most intervals of a whole chain with states. They take seconds.
const MOST_WITH_STATES: usize = 100;
/// Most intervals of a whole chain without states. They take seconds.
const MOST_WITHOUT_STATES: usize = 1000;
/// Most intervals over which the running sum is a state: its scale grows with the chain.
const MOST_WITH_MEAN: usize = 200;
/// Most intervals over which the running sum is a state beside others.
const MOST_WITH_STATES_AND_MEAN: usize = 30;
/// Most intervals whose bounds are tightened by linear programs.
const MOST_TIGHTENED: usize = 30;
/// Number of intervals of a segment.
const SEGMENT_INTERVALS: usize = 20;
/// Largest number of different segments that are relaxed.
const MOST_SEGMENTS: usize = 12;

/// Bounds the motion variance; `None` where nothing bounds the acceleration.
pub(crate) fn motion_variance_bound(
    chain: &AxisChain,
    interruption: &Interruption,
) -> Option<MotionVarianceBound> {
    bound_within(chain, Patience { max_iterations: MAX_ITERATIONS, interruption }, 3)
}

/// The same with this patience with the conic solver, and moments up to degree
/// `2 · most_order`.
pub(super) fn bound_within(
    chain: &AxisChain,
    patience: Patience<'_>,
    most_order: u8,
) -> Option<MotionVarianceBound> {
    let (n, l) = (chain.sums.len(), &chain.limits);
    let mut bounds = StateBounds::of(chain);
    if !bounds.sum_of_squares(chain, 0..n).is_finite() {
        return None;
    }
    let displacement = l.displacement.is_some();
    let velocity = displacement || l.velocity.is_some() || l.rest == Rest::Both;
    if n <= MOST_TIGHTENED && (velocity || l.intercept.is_some()) {
        bounds = bounds.tightened(chain, &INSIDE, patience.interruption);
    }
    let value = bounds.sum_of_squares(chain, 0..n);
    let cheap = MotionVarianceBound { value, kind: BoundKind::StateBounds, solved: true, correction: 0.0 };
    let most = if velocity { MOST_WITH_STATES } else { MOST_WITHOUT_STATES };
    let mut best = cheap;
    let mut consider = |bound: Option<MotionVarianceBound>| {
        best =
            bound.into_iter().fold(best.clone(), |best, new| if new.value < best.value { new } else { best });
    };
    consider(by_jerk(chain, &bounds));
    if n > most {
        consider(segments(
            chain,
            &bounds,
            States { velocity, displacement, sum: false },
            patience,
            most_order,
        ));
        return Some(best);
    }
    // the running sum is one more state; beside velocity and displacement only to second order. Rest at the
    // end makes the mean small, so that it is not needed there
    let with_mean = chain.mass.is_finite()
        && n <= if velocity { MOST_WITH_STATES_AND_MEAN } else { MOST_WITH_MEAN }
        && !(velocity && l.rest == Rest::Both);
    let with_order = |sum: bool, order: u8| {
        let states = States { velocity, displacement, sum };
        let part = ChainPart::new(chain, &bounds, 0..n, states, order);
        relax(&part, patience, BoundKind::Chain { mean: sum, states: velocity })
    };
    if with_mean {
        consider(with_order(true, 2));
    }
    if velocity || !with_mean {
        let high = velocity && n <= MOST_HIGH_ORDER && most_order > 2;
        let bound = high.then(|| with_order(false, 3)).flatten();
        let accurate = bound.as_ref().is_some_and(|bound| bound.solved);
        consider(bound);
        if !accurate {
            consider(with_order(false, 2));
        }
    }
    Some(best)
}

/// The bound from the jerk alone: `V ≤ Σ (α − c)² + (mass − M) c² + 2 |shift| |c|` for every c. Here c is the
/// acceleration in the middle of the motion.
///
/// The relaxations divide by the largest acceleration. A small jerk is then lost in the solver's tolerance;
/// in this bound it is not.
fn by_jerk(chain: &AxisChain, bounds: &StateBounds) -> Option<MotionVarianceBound> {
    let (n, jerk) = (chain.sums.len(), chain.limits.jerk?);
    let samples: f64 = chain.sums.iter().map(|sum| sum.samples).sum();
    let apart =
        (0..=n).map(|i| jerk * chain.interval_s * (i as f64 - n as f64 / 2.0).abs()).collect::<Vec<_>>();
    let middle = bounds.a[n / 2].max(bounds.a[n.div_ceil(2)]);
    let spread = StateBounds { a: apart, ..bounds.clone() }.sum_of_squares(chain, 0..n);
    let value = spread + (chain.mass - samples).max(0.0) * middle * middle + 2.0 * chain.shift.abs() * middle;
    let kind = BoundKind::Jerk;
    value.is_finite().then_some(MotionVarianceBound { value, kind, solved: true, correction: 0.0 })
}

impl<'a> ChainPart<'a> {
    /// A part whose cliques and places fit its order.
    fn new(
        chain: &'a AxisChain,
        bounds: &'a StateBounds,
        range: Range<usize>,
        states: States,
        order: u8,
    ) -> Self {
        let variables = if order > 2 { VARIABLES.1 } else { VARIABLES.0 };
        Self { chain, bounds, range, variables, states, open: false, inside: &INSIDE, order }
    }
}

fn relax(part: &ChainPart<'_>, patience: Patience<'_>, kind: BoundKind) -> Option<MotionVarianceBound> {
    let scale = part.bounds.sum_of_squares(part.chain, part.range.clone());
    if scale == 0.0 {
        return None;
    }
    let tolerance = if part.states.velocity { TOLERANCE.0 } else { TOLERANCE.1 };
    let bound = moment_solver::solve(&part.relax(scale)?, tolerance, patience)?.bound;
    Some(MotionVarianceBound {
        value: (bound.value * scale).max(0.0),
        kind,
        solved: bound.solved,
        correction: bound.correction * scale,
    })
}

/// The sum of the bounds of segments; equal segments are relaxed once.
fn segments(
    chain: &AxisChain,
    bounds: &StateBounds,
    states: States,
    patience: Patience<'_>,
    most_order: u8,
) -> Option<MotionVarianceBound> {
    let n = chain.sums.len();
    // the same bounds everywhere make segments equal, but for the thesis's intercept, which counts from t = 0
    let uniform = bounds.everywhere();
    let (bounds, moves) = if chain.limits.intercept.is_some() { (bounds, true) } else { (&uniform, false) };
    let mut total =
        MotionVarianceBound { value: 0.0, kind: BoundKind::Stretches, solved: true, correction: 0.0 };
    let mut known: Vec<(Range<usize>, MotionVarianceBound)> = Vec::new();
    for first in (0..n).step_by(SEGMENT_INTERVALS) {
        let range = first..(first + SEGMENT_INTERVALS).min(n);
        let same = |other: &Range<usize>| !moves && chain.sums[other.clone()] == chain.sums[range.clone()];
        let part = if let Some((_, part)) = known.iter().find(|(other, _)| same(other)) {
            part.clone()
        } else {
            let cheap = MotionVarianceBound {
                value: bounds.sum_of_squares(chain, range.clone()),
                kind: BoundKind::StateBounds,
                solved: true,
                correction: 0.0,
            };
            let relaxed = if known.len() < MOST_SEGMENTS {
                let order = if states.velocity && !moves { most_order } else { 2 };
                let part =
                    ChainPart { open: true, ..ChainPart::new(chain, bounds, range.clone(), states, order) };
                relax(&part, patience, BoundKind::Stretches)
            } else {
                None
            };
            let part = relaxed.filter(|bound| bound.value < cheap.value).unwrap_or(cheap);
            known.push((range, part.clone()));
            part
        };
        total.value += part.value;
        total.correction += part.correction;
        total.solved &= part.solved;
    }
    total.value *= 1.0 + 1e-12;
    Some(total)
}

//! Tests of the certificate: its bounds against exact optima, random motions and the reference cases.

use super::bounds::StateBounds;
use super::dual_bound::{MomentProgram, Patience};
use super::moment_relaxation::ChainPart;
use super::moment_solver;
use super::motion_variance::{self, BoundKind, MotionVarianceBound};
use super::*;
use crate::Interruption;
use crate::convex::Row;
use calibrant_core::motion::{AxisLimits, IntervalSums, Rest};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::DMatrix;
use rand::RngExt;

fn motion_variance_bound(chain: &AxisChain) -> Option<MotionVarianceBound> {
    motion_variance::motion_variance_bound(chain, &Interruption::default())
}

fn bound_within(chain: &AxisChain, max_iterations: u32, most_order: u8) -> Option<MotionVarianceBound> {
    let patience = Patience { max_iterations, interruption: &Interruption::default() };
    motion_variance::bound_within(chain, patience, most_order)
}

fn sums(intervals: usize, per_interval: usize) -> Vec<IntervalSums> {
    let mut all = vec![IntervalSums::default(); intervals];
    for k in 0..=intervals * per_interval {
        let i = (k / per_interval).min(intervals - 1);
        let x = k as f64 / per_interval as f64 - i as f64;
        let m = &mut all[i];
        m.samples += 1.0;
        m.s0 += 1.0 - x;
        m.s1 += x;
        m.m00 += (1.0 - x) * (1.0 - x);
        m.m01 += x * (1.0 - x);
        m.m11 += x * x;
    }
    all
}

fn case(intervals: usize, limits: AxisLimits) -> AxisChain {
    let sums = sums(intervals, 10);
    let mass = (intervals * 10 + 1) as f64;
    AxisChain { interval_s: 1.0, sums, limits, shift: 0.0, mass }
}

/// `V = Σ α² − (Σ α + shift)²/mass`.
fn variance(chain: &AxisChain, a: &[f64]) -> f64 {
    let (mut s1, mut s2) = (chain.shift, 0.0);
    for (m, a) in chain.sums.iter().zip(a.windows(2)) {
        s1 += m.s0 * a[0] + m.s1 * a[1];
        s2 += m.m00 * a[0] * a[0] + 2.0 * m.m01 * a[0] * a[1] + m.m11 * a[1] * a[1];
    }
    s2 - s1 * s1 / chain.mass
}

/// The reference's standard deviation of a scale factor over the smallest that the bound admits, less one.
fn gap(bound: &MotionVarianceBound, sd: f64) -> f64 {
    sd / (2e-4 / bound.value.sqrt()) - 1.0
}

/// The limits of the thesis's case D1: acceleration and jerk.
const D1: AxisLimits = AxisLimits {
    acceleration: Some(30.0),
    jerk: Some(30.0),
    intercept: None,
    velocity: None,
    displacement: None,
    rest: Rest::None,
    start: None,
    end: None,
};

#[test]
fn the_bound_of_d1_is_the_exact_optimum() {
    let chain = case(10, D1);
    let bound = motion_variance_bound(&chain).expect("bounded");
    assert!(bound.solved && bound.kind == BoundKind::Chain { mean: true, states: false });
    assert!(gap(&bound, 7.11884e-07).abs() < 2e-6, "{bound:?}");
    // with A = U Δτ the vertices of the admissible motions lie on the lattice {−A, 0, A}, and V is convex
    let mut best = 0.0_f64;
    for code in 0..3_usize.pow(11) {
        let a: Vec<f64> = (0..11).map(|k| 30.0 * ((code / 3_usize.pow(k) % 3) as f64 - 1.0)).collect();
        if a.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 30.0) {
            best = best.max(variance(&chain, &a));
        }
    }
    assert!(bound.value >= best && bound.value < best * (1.0 + 1e-5), "{} {best}", bound.value);
}

#[test]
fn the_bound_of_d2_is_the_steepest_line() {
    // the largest jerk all the time: α = 30 t, through the origin as the intercept wants it
    let chain = case(10, AxisLimits { acceleration: None, intercept: Some(30.0), ..D1 });
    let line: Vec<f64> = (0..=10).map(|i| 30.0 * f64::from(i)).collect();
    let bound = motion_variance_bound(&chain).expect("bounded");
    let best = variance(&chain, &line);
    assert!(bound.value >= best && bound.value < best * (1.0 + 1e-5), "{} {best}", bound.value);
}

#[test]
fn the_bound_of_d3_is_within_two_percent() {
    let limits = AxisLimits { velocity: Some(10.0), displacement: Some(10.0), rest: Rest::Both, ..D1 };
    let chain = case(10, limits);
    let quick = bound_within(&chain, 100, 2).expect("bounded");
    assert!((0.0..0.08).contains(&gap(&quick, 1.70204e-06)), "{quick:?}");
    let bound = motion_variance_bound(&chain).expect("bounded");
    assert!((0.0..0.018).contains(&gap(&bound, 1.70204e-06)), "{bound:?}");
}

/// The relaxation of a whole chain with velocity and displacement.
fn relaxation(chain: &AxisChain, order: u8) -> MomentProgram {
    let bounds = StateBounds::of(chain);
    let states = States { velocity: true, displacement: true, sum: false };
    let range = 0..chain.sums.len();
    let part =
        ChainPart { chain, bounds: &bounds, range, variables: 4, states, open: false, inside: &[0.5], order };
    part.relax(bounds.sum_of_squares(chain, 0..chain.sums.len())).expect("bounded")
}

/// Each is an upper bound, with the residual counted on top. Moments that keep every condition and reach it show that
/// no other solver finds a lower one.
#[test]
fn moments_that_keep_every_condition_reach_the_bound_of_our_solver() {
    let interruption = Interruption::default();
    let patience = Patience { max_iterations: 100, interruption: &interruption };
    let limits = AxisLimits { velocity: Some(10.0), displacement: Some(10.0), rest: Rest::Both, ..D1 };
    for (intervals, order) in [(3, 2), (4, 2), (7, 2), (10, 2), (4, 3)] {
        let program = relaxation(&case(intervals, limits), order);
        let own = moment_solver::solve(&program, 1e-6, patience).expect("solved");
        let y = &own.moments;
        let at = |row: &Row| row.constant + row.terms.iter().map(|&(column, a)| a * y[column]).sum::<f64>();
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let broken = [
            largest(&mut y.iter().map(|y| y.abs() - 1.0)),
            largest(&mut program.squares.iter().map(|&column| -y[column])),
            largest(&mut program.zero.iter().map(|row| at(row).abs())),
            largest(&mut program.nonnegative.iter().map(|row| -at(row))),
            largest(&mut program.semidefinite.iter().map(|(size, triangle)| {
                let place = |i: usize, j: usize| i.max(j) * (i.max(j) + 1) / 2 + i.min(j);
                -DMatrix::from_fn(*size, *size, |i, j| at(&triangle[place(i, j)]))
                    .symmetric_eigenvalues()
                    .min()
            })),
        ];
        assert!(broken.iter().all(|broken| *broken < 1e-7), "{intervals} {order}: {broken:?}");
        let apart = own.bound.value - at(&program.objective);
        assert!(
            own.bound.solved && apart.abs() < own.bound.correction + 3e-6,
            "{intervals} {order}: {apart} {own:?}"
        );
        assert!(own.bound.correction < 1e-4 && own.iterations <= 35, "{intervals} {order}: {own:?}");
    }
}

#[test]
fn an_interrupted_bound_still_holds() {
    let interruption = Interruption::default();
    interruption.ask();
    let limits = AxisLimits { velocity: Some(10.0), displacement: Some(10.0), rest: Rest::Both, ..D1 };
    let bound = motion_variance::motion_variance_bound(&case(20, limits), &interruption).expect("bounded");
    assert!(bound.value.is_finite() && bound.kind == BoundKind::StateBounds, "{bound:?}");
}

#[test]
fn small_motions_have_the_optimum_of_hand() {
    let free = AxisLimits { jerk: None, ..D1 };
    for (intervals, best) in [(1, vec![30.0, -30.0]), (2, vec![30.0, -30.0, 30.0])] {
        let chain = case(intervals, free);
        let bound = motion_variance_bound(&chain).expect("bounded");
        let ends_apart = variance(&chain, &[30.0, 0.0, -30.0][..=intervals.min(2)]);
        let best = variance(&chain, &best).max(if intervals == 2 { ends_apart } else { 0.0 });
        let best = if intervals == 2 { best.max(variance(&chain, &[30.0, 30.0, -30.0])) } else { best };
        assert!(bound.value >= best && bound.value < best * (1.0 + 1e-5), "{} {best}", bound.value);
    }
}

#[test]
fn a_slow_motion_is_bounded_by_its_jerk_whatever_the_acceleration() {
    // a jerk of 0.001 for 10 s, beside an acceleration of 500: the best motion is a straight line
    let chain = case(10, AxisLimits { acceleration: Some(500.0), jerk: Some(1e-3), ..D1 });
    let line: Vec<f64> = (0..=10).map(|i| 1e-3 * f64::from(i)).collect();
    let best = variance(&chain, &line);
    let bound = motion_variance_bound(&chain).expect("bounded");
    assert_eq!(bound.kind, BoundKind::Jerk);
    assert!(
        bound.value >= best * (1.0 - 1e-12) && bound.value < best * (1.0 + 1e-9),
        "{} {best}",
        bound.value
    );
    // earlier information on the bias counts too
    let informed = AxisChain { shift: 0.3, mass: chain.mass + 20.0, ..chain };
    let bound = motion_variance_bound(&informed).expect("bounded");
    for offset in [-500.0, -1.0, 0.0, 1.0, 500.0_f64] {
        let a: Vec<f64> = line.iter().map(|a| (a + offset).clamp(-500.0, 500.0)).collect();
        assert!(bound.value >= variance(&informed, &a), "{bound:?} {offset}");
    }
}

#[test]
fn nothing_that_bounds_the_motion_is_no_bound() {
    assert_eq!(motion_variance_bound(&case(3, AxisLimits { acceleration: None, ..D1 })), None);
}

/// Largest ratio of a quantity to its limit, at all times (fifty in each interval).
fn breach(chain: &AxisChain, a: &[f64]) -> f64 {
    let (l, dt) = (&chain.limits, chain.interval_s);
    let mut worst = 0.0_f64;
    let mut within =
        |value: f64, limit: Option<f64>| worst = worst.max(limit.map_or(0.0, |l| value.abs() / l));
    let (mut v, mut d) = (0.0, 0.0);
    within(a[0], l.acceleration);
    for (i, a) in a.windows(2).enumerate() {
        let u = (a[1] - a[0]) / dt;
        within(a[1], l.acceleration);
        within(u, l.jerk);
        within(a[0] - u * i as f64 * dt, l.intercept);
        let at =
            |t: f64| (v + a[0] * t + u * t * t / 2.0, d + v * t + a[0] * t * t / 2.0 + u * t * t * t / 6.0);
        for k in 1..=50 {
            let (v, d) = at(dt * f64::from(k) / 50.0);
            within(v, l.velocity);
            within(d, l.displacement);
        }
        (v, d) = at(dt);
    }
    worst
}

/// A random small problem and an admissible motion of it, improved as far as random steps go.
fn climbed(number: u64) -> (AxisChain, f64) {
    let mut rng = stream(7, Purpose::Motion, number);
    let n = rng.random_range(2..=4_usize);
    let mut some = |chance: f64, size: f64| {
        let x = size * rng.random_range(0.3..2.0);
        rng.random_bool(chance).then_some(x)
    };
    let mut limits = AxisLimits {
        acceleration: some(0.7, 3.0),
        jerk: some(0.7, 3.0),
        intercept: some(0.3, 3.0),
        velocity: some(0.4, 3.0),
        displacement: some(0.3, 5.0),
        ..AxisLimits::default()
    };
    if limits.acceleration.is_none() && limits.velocity.is_none() && limits.displacement.is_none() {
        limits.acceleration = Some(4.0);
    }
    limits.rest = if rng.random_bool(0.3) { Rest::Both } else { Rest::None };
    let sums = sums(n, rng.random_range(2..6));
    let samples: f64 = sums.iter().map(|m| m.samples).sum();
    let (extra, shift) = if rng.random_bool(0.3) { (3.0, 2.0) } else { (0.0, 0.0) };
    let interval_s = rng.random_range(0.5..2.0);
    let mut chain = AxisChain { interval_s, sums, limits, shift, mass: samples + extra };

    let mut a: Vec<f64> = (0..=n).map(|_| rng.random_range(-1.0..1.0)).collect();
    let stops = limits.rest == Rest::Both;
    if stops {
        a[n] = -a[0] - 2.0 * a[1..n].iter().sum::<f64>();
    }
    let size = breach(&chain, &a);
    a.iter_mut().for_each(|a| *a *= 0.5 / size);
    let (fix_start, fix_end) = (rng.random_bool(0.2), rng.random_bool(0.2));
    if fix_start {
        chain.limits.start = Some(a[0]);
    }
    if fix_end {
        chain.limits.end = Some(a[n]);
    }
    let free: Vec<usize> = (usize::from(fix_start)..=n - usize::from(fix_end)).collect();
    let begin = a;
    let mut top = 0.0_f64;
    // local optima abound: start again, first far, then near
    for _ in 0..12 {
        let mut a = begin.clone();
        let mut best = f64::NEG_INFINITY;
        let mut step = 4.0 / size;
        for k in 0..600 {
            let mut next = a.clone();
            let i = free[rng.random_range(0..free.len())];
            let weight = |i: usize| if i == 0 || i == n { 0.5 } else { 1.0 };
            let change = step * rng.random_range(-1.0..1.0);
            next[i] += change / weight(i);
            if stops || rng.random_bool(0.5) {
                let j = free[rng.random_range(0..free.len())];
                next[j] -= change / weight(j);
            }
            let value = variance(&chain, &next);
            // wander about at first
            if (k < 60 || value > best) && breach(&chain, &next) <= 1.0 {
                best = value;
                a = next;
            } else {
                step = (step * 0.99).max(1e-4 / size);
            }
        }
        top = top.max(best);
    }
    (chain, top)
}

#[test]
fn no_admissible_motion_beats_the_bound_and_most_come_near_it() {
    let mut ratios = Vec::new();
    for number in 0..100 {
        let (chain, best) = climbed(number);
        // the higher order takes longer: use it for a few
        let order = if number % 50 == 0 { 3 } else { 2 };
        let bound = bound_within(&chain, 100, order).expect("bounded");
        assert!(bound.value >= best, "{number}: {} < {best}, {chain:?}", bound.value);
        ratios.push(bound.value / best);
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[50] < 1.01 && ratios[90] < 1.1, "{ratios:?}");
}

#[test]
fn a_solver_that_stops_early_gives_a_looser_bound_not_a_wrong_one() {
    for number in 0..10 {
        let (chain, best) = climbed(number);
        for iterations in 1..=8 {
            let bound = bound_within(&chain, iterations, 2).expect("bounded");
            assert!(bound.value >= best, "{number}, {iterations} iterations: {bound:?} {best}");
        }
    }
    let early = bound_within(&case(10, D1), 6, 2).expect("bounded");
    assert!(early.value > 78930.0 && early.value.is_finite());
}

#[test]
fn a_long_chain_is_bounded_by_its_stretches() {
    let limits = AxisLimits { velocity: Some(10.0), ..D1 };
    let bound = motion_variance_bound(&case(128, limits)).expect("bounded");
    assert_eq!(bound.kind, BoundKind::Stretches);
    // back and forth with the largest jerk: velocity within ±7.5
    let chain = case(128, limits);
    let a: Vec<f64> = (0..129).map(|i| if i % 2 == 0 { 15.0 } else { -15.0 }).collect();
    assert!(breach(&chain, &a) <= 1.0);
    assert!(bound.value > variance(&chain, &a) && bound.value < 3.0 * variance(&chain, &a), "{bound:?}");
}

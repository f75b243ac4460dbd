use super::motion_variance::{BoundKind, MotionVarianceBound, bound_within, motion_variance_bound};
use super::*;
use crate::motion::Rest;
use crate::simulate::{Purpose, stream};
use rand::RngExt;

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
fn explore() {
    let d2 = AxisLimits { acceleration: None, intercept: Some(30.0), ..D1 };
    let d3 = AxisLimits { velocity: Some(10.0), displacement: Some(10.0), rest: Rest::Both, ..D1 };
    for (name, n, limits, sd) in [
        ("D1", 10, D1, 7.11884e-07),
        ("D1-100", 100, D1, 7.11884e-07),
        ("D2", 10, d2, 2.27e-07),
        ("D3v", 10, AxisLimits { displacement: None, ..d3 }, 1.70204e-06),
        ("D3", 10, d3, 1.70204e-06),
        ("D3-30", 30, d3, 1.70204e-06 / 3.0_f64.sqrt()),
        ("D3-200", 200, d3, 1.70204e-06 / 20.0_f64.sqrt()),
    ] {
        let clock = std::time::Instant::now();
        let bound = motion_variance_bound(&case(n, limits)).expect("bounded");
        println!("{name}: gap in sd {:.3} %, {bound:?}, {:?}", 100.0 * gap(&bound, sd), clock.elapsed());
    }
}

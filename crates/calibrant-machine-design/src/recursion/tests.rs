//! The recursion against that of `calibrant-machine`, and its reverse against the derivatives there and against differences.

use super::*;
use crate::chains_for_tests::{Numbers, arm_of_all_kinds};
use calibrant_machine::chain::{ChainSensitivity, FrameMotion, JointState, SensorMount};
use nalgebra::{UnitQuaternion, Vector3};

struct Case {
    chain: calibrant_machine::chain::KinematicChain,
    mount: SensorMount,
    gravity: Vector3<f64>,
    state: [Vec<f64>; 3],
}

fn case(seed: u64) -> Case {
    let mut numbers = Numbers(seed);
    let chain = arm_of_all_kinds(2 + seed as usize % 5, &mut numbers);
    let n = chain.joints.len();
    let mount = SensorMount {
        lever_m: numbers.vector(0.1),
        tip_from_sensor: UnitQuaternion::from_scaled_axis(numbers.vector(1.0)),
    };
    let state = [2.0, 3.0, 8.0].map(|size| (0..n).map(|_| numbers.next(size)).collect());
    Case { chain, mount, gravity: numbers.vector(9.8), state }
}

fn joints(state: &[Vec<f64>; 3]) -> Vec<JointAt<f64>> {
    (0..state[0].len()).map(|k| JointAt::new(state[0][k], state[1][k], state[2][k])).collect()
}

#[test]
fn the_recursion_and_its_reverse_are_those_of_the_chain() {
    for seed in 1..20 {
        let Case { chain, mount, gravity, state } = case(seed);
        let n = chain.joints.len();
        let links = Links::<f64>::new(&chain, &mount, &gravity);
        let (at, mut sweep) = (joints(&state), Sweep::new(n));
        sweep.forward(&links, &at);
        let mut of = ChainSensitivity::new(n);
        let given = JointState { positions: &state[0], velocities: &state[1], accelerations: &state[2] };
        of.evaluate(&chain.nominal(), given, &FrameMotion::at_rest(&gravity), &mount);
        let near = |found: f64, wanted: f64| {
            assert!((found - wanted).abs() < 1e-11 * (1.0 + wanted.abs()), "{seed}: {found} {wanted}");
        };
        for k in 0..3 {
            near(sweep.sensor().a.0[k], of.sensor.specific_force[k]);
            near(sweep.sensor().w.0[k], of.sensor.rate[k]);
            near(sweep.sensor().wd.0[k], of.sensor.angular_acceleration[k]);
        }
        let mut bars = vec![JointBars { q: 0.0, qd: 0.0, qdd: 0.0 }; n];
        for row in 0..6 {
            let mut seed = Moving::zero();
            if row < 3 {
                seed.a.0[row] = 1.0
            } else {
                seed.w.0[row - 3] = 1.0
            }
            sweep.reverse(&links, &at, seed, &mut bars);
            for (k, bar) in bars.iter().enumerate() {
                near(bar.q, of.positions[(row, k)]);
                near(bar.qd, of.velocities[(row, k)]);
                near(bar.qdd, of.accelerations[(row, k)]);
            }
        }
    }
}

/// The second derivative of a reading: the slope of the reverse sweep along a direction of positions, against differences of that sweep.
#[test]
fn dual_numbers_give_the_slope_of_the_reverse_sweep() {
    let Case { chain, mount, gravity, state } = case(4);
    let n = chain.joints.len();
    let mut numbers = Numbers(9);
    let direction: Vec<f64> = (0..n).map(|_| numbers.next(1.0)).collect();
    let bars_at = |step: f64| {
        let mut moved = state.clone();
        for (q, d) in moved[0].iter_mut().zip(&direction) {
            *q += step * d;
        }
        let links = Links::<f64>::new(&chain, &mount, &gravity);
        let (at, mut sweep) = (joints(&moved), Sweep::new(n));
        sweep.forward(&links, &at);
        let mut bars = vec![JointBars { q: 0.0, qd: 0.0, qdd: 0.0 }; n];
        let mut seed = Moving::zero();
        seed.a.0[1] = 1.0;
        sweep.reverse(&links, &at, seed, &mut bars);
        bars
    };
    let links = Links::<Dual<f64>>::new(&chain, &mount, &gravity);
    let at: Vec<_> = (joints(&state).iter().zip(&direction))
        .map(|(at, &d)| JointAt {
            q: Dual::new(at.q, d),
            qd: Dual::of(at.qd),
            qdd: Dual::of(at.qdd),
            cos: Dual::new(at.cos, -at.sin * d),
            sin: Dual::new(at.sin, at.cos * d),
        })
        .collect();
    let mut sweep = Sweep::new(n);
    sweep.forward(&links, &at);
    let mut seed = Moving::zero();
    seed.a.0[1] = Dual::of(1.0);
    let mut bars = vec![JointBars { q: Dual::of(0.0), qd: Dual::of(0.0), qdd: Dual::of(0.0) }; n];
    sweep.reverse(&links, &at, seed, &mut bars);
    let h = 1e-5;
    for (k, (low, high)) in bars_at(-h).iter().zip(bars_at(h)).enumerate() {
        for (found, low, high) in
            [(bars[k].q, low.q, high.q), (bars[k].qd, low.qd, high.qd), (bars[k].qdd, low.qdd, high.qdd)]
        {
            let slope = (high - low) / (2.0 * h);
            assert!((found.slope - slope).abs() < 1e-7 * (1.0 + slope.abs()), "{k}: {found:?} {slope}");
        }
    }
}

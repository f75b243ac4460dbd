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

fn joints(state: &[Vec<f64>; 3]) -> Vec<JointAt> {
    (0..state[0].len()).map(|k| JointAt::new(state[0][k], state[1][k], state[2][k])).collect()
}

#[test]
fn the_recursion_and_its_reverse_are_those_of_the_chain() {
    for seed in 1..20 {
        let Case { chain, mount, gravity, state } = case(seed);
        let n = chain.joints.len();
        let links = Links::new(&chain, &mount, &gravity);
        let (at, mut sweep) = (joints(&state), Sweep::new(n));
        sweep.forward(&links, &at);
        let mut of = ChainSensitivity::new(n);
        let given = JointState { positions: &state[0], velocities: &state[1], accelerations: &state[2] };
        of.evaluate(&chain.nominal(), given, &FrameMotion::at_rest(&gravity), &mount);
        let near = |found: f64, wanted: f64| {
            assert!((found - wanted).abs() < 1e-11 * (1.0 + wanted.abs()), "{seed}: {found} {wanted}");
        };
        let (readings, sensor) = (sweep.readings(), *sweep.sensor());
        let turned = sensor.turn.transposed_times(&sensor.moving.wd);
        for k in 0..3 {
            near(readings[0].0[k], of.sensor.specific_force[k]);
            near(readings[1].0[k], of.sensor.rate[k]);
            near(turned.0[k], of.sensor.angular_acceleration[k]);
        }
        for row in 0..6 {
            let mut bars = vec![JointBars::ZERO; n];
            let mut seed = [V::ZERO; 2];
            seed[row / 3].0[row % 3] = 1.0;
            sweep.reverse(&links, &at, &seed, |_| Moving::ZERO, &mut bars);
            for (k, bar) in bars.iter().enumerate() {
                near(bar.q, of.positions[(row, k)]);
                near(bar.qd, of.velocities[(row, k)]);
                near(bar.qdd, of.accelerations[(row, k)]);
                let [fq, fqd, fqdd, wq, wqd] =
                    sweep.of_joint(&links, k).map(|of| sensor.turn.transposed_times(&of));
                let of_row = |of: [V; 3]| of.map(|v| v.0[row % 3]);
                let own = if row < 3 { of_row([fq, fqd, fqdd]) } else { of_row([wq, wqd, V::ZERO]) };
                near(own[0], bar.q);
                near(own[1], bar.qd);
                near(own[2], bar.qdd);
            }
        }
    }
}

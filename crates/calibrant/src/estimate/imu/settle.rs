//! Weights and the gyroscope's parameters in turn, directions fixed, until both rest.

use super::joint::{Joint, Misses, State};
use super::rates::LocalBias;
use super::solver::singular;
use super::weights::{self, Weighed};
use crate::error::Result;
use crate::sensor::Condition;
use nalgebra::{DMatrix, DVector, Vector3};

/// Rounds in which weights and estimate follow each other.
const ROUNDS: usize = 12;
/// Steps below this many standard deviations end the rounds.
const SETTLED: f64 = 0.1;

/// What holds, turns and prior say of the gyroscope, directions fixed: the rest of the problem beside the rotations.
fn rest(joint: &Joint<'_>, state: &State) -> (DMatrix<f64>, DVector<f64>) {
    let places = joint.gyroscope_places();
    let size = places.len();
    let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let imu = &state.imu;
    let mut add = |at: Condition<'_>, time: f64, r: Vector3<f64>, weight: &Vector3<f64>| {
        let columns: Vec<Vector3<f64>> = places
            .iter()
            .map(|&k| {
                let quantity = joint.quantities[k];
                let scale = if quantity.is_of_bias() { time } else { 1.0 };
                quantity.derivative(&at) * scale
            })
            .collect();
        for i in 0..size {
            let weighted = columns[i].component_mul(weight);
            g[i] += weighted.dot(&r);
            for j in 0..size {
                f[(i, j)] += weighted.dot(&columns[j]);
            }
        }
    };
    for (hold, force) in joint.holds.iter().zip(&state.forces) {
        if let Some((mean, weight)) = &hold.gyroscope {
            let temperature_c = hold.temperature_c;
            let still =
                Condition { imu, stimulus: force * joint.vertical_rate, force: *force, temperature_c };
            add(still, 1.0, mean - joint.at_rest(&imu.at(temperature_c), force), weight);
        }
    }
    for turn in &joint.turns {
        let (stimulus, force, temperature_c) = (joint.turned(turn), turn.force, turn.temperature_c);
        let at = Condition { imu, stimulus, force, temperature_c };
        add(at, turn.duration_s, joint.turn_residual(turn, imu), &turn.weight);
    }
    if let Some((mean, weight)) = &joint.prior {
        for (i, &k) in places.iter().enumerate() {
            f[(i, i)] += weight[k];
            g[i] += weight[k] * (mean[k] - joint.quantities[k].of(imu));
        }
    }
    (f, g)
}

pub(super) fn reweigh(joint: &Joint<'_>, state: &State, misses: &Misses) -> Result<Option<Weighed>> {
    if misses.iter().all(Option::is_none) {
        return Ok(None);
    }
    let (f, g) = rest(joint, state);
    weights::weigh(joint, misses, &f, &g).map(Some).ok_or_else(singular)
}

pub(super) fn apply(joint: &mut Joint<'_>, weighed: &Weighed) {
    joint.excess_rad = weighed.excess_rad;
    for (rotation, used) in joint.rotations.iter_mut().zip(&weighed.used) {
        rotation.counts = *used;
    }
}

/// The bias of a rotation is that of the holds before and after it, as far as these tell: a hold's deviation from the mean bias counts by the share of it that
/// is not noise.
pub(super) fn follow_drift(joint: &mut Joint<'_>, state: &State, between: &Vector3<f64>) {
    let biases: Vec<LocalBias> = joint
        .holds
        .iter()
        .zip(&state.forces)
        .map(|(hold, force)| {
            let none = LocalBias::none(hold.temperature_c);
            hold.gyroscope.map_or(none, |(mean, weight)| {
                let true_variance = between.component_mul(between);
                LocalBias {
                    mean,
                    force: *force,
                    rate: force * joint.vertical_rate,
                    share: true_variance.component_mul(&weight),
                    variance: weight.map(|weight| 1.0 / weight) - true_variance,
                    ..none
                }
            })
        })
        .collect();
    for rotation in &mut joint.rotations {
        rotation.samples.drift = [biases[rotation.from], biases[rotation.from + 1]];
    }
}

/// Weights and the gyroscope's parameters in turn, directions fixed, until both rest.
///
/// `misses` are those of the state; those of the state that it leads to are given back.
pub(super) fn settle(
    joint: &mut Joint<'_>,
    state: &mut State,
    mut misses: Misses,
    between: &Vector3<f64>,
) -> Result<(Weighed, Misses)> {
    let places = joint.gyroscope_places();
    let mut last = Weighed::none(joint.rotations.len());
    for _ in 0..ROUNDS {
        let Some(weighed) = reweigh(joint, state, &misses)? else { break };
        apply(joint, &weighed);
        last = weighed;
        // the fit that follows takes a step this short by itself
        if last.length < SETTLED {
            break;
        }
        for (&k, step) in places.iter().zip(last.step.iter()) {
            joint.quantities[k].add_to(&mut state.imu, *step);
        }
        follow_drift(joint, state, between);
        misses = joint.misses(state).ok_or_else(singular)?;
    }
    Ok((last, misses))
}

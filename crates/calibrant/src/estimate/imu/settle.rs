//! Weights, the gyroscope's parameters and the Earth's rate in turn, directions fixed, until all rest.

use super::joint::{HoldData, Joint, Misses, State, TurnData};
use super::rates::LocalBias;
use super::solver::singular;
use super::still::{Explanation, Means, between_sd, weigh};
use super::weights::{self, Rest, Weighed};
use crate::error::Result;
use crate::sensor::{Condition, ImuParameters, ImuQuantity};
use nalgebra::{DMatrix, DVector, Matrix3xX, Vector3};
use std::ops::SubAssign;

/// Rounds in which weights and estimate follow each other.
const ROUNDS: usize = 12;
/// Steps below this many standard deviations end the rounds.
const SETTLED: f64 = 0.1;

/// What holds, turns and prior say of the gyroscope and the Earth's rate, directions fixed: the rest of the problem beside the rotations. In place of `Γ` stands what [`Earth`](super::earth) makes of it.
fn rest(joint: &Joint<'_>, state: &State) -> Rest {
    let places = joint.gyroscope_places();
    let unknowns = joint.earth.unknowns();
    let size = places.len() + unknowns.len();
    let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let imu = &state.imu;
    let mut add =
        |at: Condition<'_>, time: f64, r: Vector3<f64>, weight: &Vector3<f64>, of_earth: Matrix3xX<f64>| {
            let columns: Vec<Vector3<f64>> = places
                .iter()
                .map(|&k| {
                    let quantity = joint.quantities[k];
                    let scale = if quantity.is_of_bias() { time } else { 1.0 };
                    quantity.derivative(&at) * scale
                })
                .chain(of_earth.column_iter().map(|column| column.into_owned()))
                .collect();
            for i in 0..size {
                let weighted = columns[i].component_mul(weight);
                g[i] += weighted.dot(&r);
                for j in 0..size {
                    f[(i, j)] += weighted.dot(&columns[j]);
                }
            }
        };
    for (j, (hold, force)) in joint.holds.iter().zip(&state.forces).enumerate() {
        if let Some((mean, weight)) = &hold.gyroscope {
            let temperature_c = hold.temperature_c;
            let still = Condition { imu, stimulus: joint.earth.rate(j, force), force: *force, temperature_c };
            let here = imu.at(temperature_c);
            let residual = mean - joint.at_rest(j, &here, force);
            add(still, 1.0, residual, weight, joint.earth.of_hold(j, &here, force));
        }
    }
    for turn in &joint.turns {
        let (stimulus, force, temperature_c) = (joint.turned(turn), turn.force, turn.temperature_c);
        let at = Condition { imu, stimulus, force, temperature_c };
        let of_earth = joint.earth.of_turn(&imu.at(temperature_c), &force);
        add(at, turn.duration_s, joint.turn_residual(turn, imu), &turn.weight, of_earth);
    }
    if let Some((mean, weight)) = &joint.prior {
        for (i, &k) in places.iter().enumerate() {
            let (off, taken) =
                (mean[k] - joint.quantities[k].of(imu), joint.earth.taken_off(joint.quantities[k], imu));
            f[(i, i)] += weight[k];
            g[i] += weight[k] * off;
            if taken != 0.0 {
                let first = places.len();
                f[(i, first)] -= weight[k] * taken;
                f[(first, i)] -= weight[k] * taken;
                f[(first, first)] += weight[k] * taken * taken;
                g[first] -= weight[k] * off * taken;
            }
        }
    }
    for (k, unknown) in unknowns.iter().enumerate() {
        f[(places.len() + k, places.len() + k)] += 1.0;
        g[places.len() + k] -= unknown;
    }
    let told = (0..size)
        .filter(|&i| f[(i, i)] > 0.0 && places.get(i).is_none_or(|&k| is_told(joint, k, imu)))
        .count();
    Rest { information: f, rhs: g, told }
}

/// Do the data beside the rotations tell a quantity? What the Earth's rate in the holds says of gains is nothing beside these.
fn is_told(joint: &Joint<'_>, place: usize, imu: &ImuParameters) -> bool {
    let quantity = joint.quantities[place];
    let of_turn = |turn: &TurnData| {
        let (force, temperature_c) = (turn.force, turn.temperature_c);
        quantity.derivative(&Condition { imu, stimulus: turn.angle, force, temperature_c }).amax() > 0.0
    };
    quantity.is_of_bias()
        || matches!(quantity, ImuQuantity::GSensitivity(..))
        || joint.turns.iter().any(of_turn)
        || joint.prior.as_ref().is_some_and(|(_, weight)| weight[place] > 0.0)
}

/// The weights that a state asks for.
pub(super) fn reweigh(joint: &Joint<'_>, state: &State, misses: &Misses) -> Result<Weighed> {
    let mut weighed = weights::weigh(joint, state, misses, rest(joint, state)).ok_or_else(singular)?;
    let places = joint.gyroscope_places();
    for (i, &k) in places.iter().enumerate() {
        let taken = joint.earth.taken_off(joint.quantities[k], &state.imu);
        if taken != 0.0 {
            let first = places.len();
            weighed.step[i] -= taken * weighed.step[first];
            let row = weighed.covariance.row(first) * taken;
            weighed.covariance.row_mut(i).sub_assign(&row);
            let column = weighed.covariance.column(first) * taken;
            weighed.covariance.column_mut(i).sub_assign(&column);
        }
    }
    Ok(weighed)
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
        .enumerate()
        .map(|(j, (hold, force))| {
            let none = LocalBias::none(hold.temperature_c);
            hold.gyroscope.map_or(none, |(mean, weight)| {
                let true_variance = between.component_mul(between);
                LocalBias {
                    mean,
                    force: *force,
                    rate: joint.earth.rate(j, force),
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

/// The scatter of the holds beyond what the Earth's rate explains, and their weights with it.
fn scatter(joint: &mut Joint<'_>, state: &State, means: &Means<'_>) -> Vector3<f64> {
    let of_earth = |(j, hold): (usize, &HoldData)| {
        joint.earth.of_hold(j, &state.imu.at(hold.temperature_c), &state.forces[j])
    };
    let by_earth = joint.holds.iter().enumerate().map(of_earth).collect();
    let given = |(hold, force): (&HoldData, &Vector3<f64>)| {
        state.imu.at(hold.temperature_c).gyroscope.matrix * force * joint.earth.given()
    };
    let is_felt = means.by.forces.is_some();
    let of_earth = (!is_felt).then(|| joint.holds.iter().zip(&state.forces).map(given).collect());
    let by = Explanation { of_earth, by_earth, ..means.by.clone() };
    let (between, _) = between_sd(&Means { by, ..*means });
    weigh(&mut joint.holds, means.stills, means.noise, &between);
    between
}

/// Weights, the gyroscope's parameters and the Earth's rate in turn, directions fixed, until all rest.
///
/// `misses` are those of the state; those of the state that it leads to are given back.
pub(super) fn settle(
    joint: &mut Joint<'_>,
    state: &mut State,
    mut misses: Misses,
    means: &Means<'_>,
    between: &mut Vector3<f64>,
) -> Result<(Weighed, Misses)> {
    let places = joint.gyroscope_places();
    let mut last = Weighed::none(joint.rotations.len());
    for _ in 0..ROUNDS {
        joint.earth.follow(&joint.rotations, &misses, &state.forces);
        let weighed = reweigh(joint, state, &misses)?;
        apply(joint, &weighed);
        last = weighed;
        // the fit that follows takes a step this short by itself
        if last.length < SETTLED {
            break;
        }
        for (&k, step) in places.iter().zip(last.step.iter()) {
            joint.quantities[k].add_to(&mut state.imu, *step);
        }
        joint.earth.step(last.step.iter().skip(places.len()).copied());
        *between = scatter(joint, state, means);
        follow_drift(joint, state, between);
        misses = joint.misses(state).ok_or_else(singular)?;
    }
    Ok((last, misses))
}

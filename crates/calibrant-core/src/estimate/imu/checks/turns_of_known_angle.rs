//! Turns of known angle that do not fit the other data.

use crate::diagnostic::Diagnostic;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::checks::turn_angles::{OTHER_TURN_SHARE, factor, is_another, shows_another};
use crate::estimate::imu::model::{Fit, ImuModel, TurnData};
use crate::estimate::imu::problem::Turn;
use crate::estimate::result::Calibration;
use crate::sensor::{ReadingUnit, SensorKind};

/// The data contradict a turn that is off by this many standard deviations.
const CONTRADICTED_SD: f64 = 4.5;

/// Turns that show another angle than was given; where there are none, turns that fit badly.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    of_turns(evidence.model, evidence.fit, &evidence.problem.setup.turns, evidence.calibration)
}

fn of_turns(model: &ImuModel<'_>, fit: &Fit, turns: &[Turn], calibration: &Calibration) -> Diagnostics {
    let mut warnings = Vec::new();
    let on_faces = calibration.frame_is_known();
    if calibration.unit(SensorKind::Gyroscope) != ReadingUnit::Counts {
        if let Some(share) = same_share(model, fit) {
            return vec![Diagnostic::TurnShare { share, mistake: factor(share) }];
        }
        // on known faces these were refused before
        let other = model.turns.iter().zip(turns).enumerate().filter(|_| !on_faces);
        warnings.extend(other.filter_map(|(k, (data, turn))| other_turn(fit, data, turn, k)));
    }
    if !warnings.is_empty() {
        // the others fit badly since these do
        return warnings;
    }
    for (number, (data, turn)) in model.turns.iter().zip(turns).enumerate() {
        let residual = model.turn_residual(data, &fit.state.imu);
        let off = residual.component_mul(&residual).dot(&data.weight).sqrt();
        if off > CONTRADICTED_SD {
            warnings.push(Diagnostic::TurnContradicted {
                turn: turn.span(number),
                angle_rad: turn.angle_rad,
                deviations: off,
            });
        }
    }
    warnings
}

/// The share of their angle that several turns show, where it is the same of all and far from one: no turn is wrong then, but what they have in common.
fn same_share(model: &ImuModel<'_>, fit: &Fit) -> Option<f64> {
    let shown = |data: &TurnData| data.beyond_bias(&fit.state.imu);
    let share = |data: &TurnData| shown(data).dot(&data.angle) / data.angle.norm_squared();
    let mean = model.turns.iter().map(share).sum::<f64>() / model.turns.len() as f64;
    let follows =
        |data: &TurnData| (shown(data) - mean * data.angle).norm() < 0.1 * mean.abs() * data.angle.norm();
    (model.turns.len() > 1 && (mean - 1.0).abs() > OTHER_TURN_SHARE && model.turns.iter().all(follows))
        .then_some(mean)
}

/// A turn of which the readings, in SI, show quite another one.
fn other_turn(fit: &Fit, data: &TurnData, turn: &Turn, number: usize) -> Option<Diagnostic> {
    let shown = data.beyond_bias(&fit.state.imu);
    let share = shown.dot(&data.angle) / data.angle.norm_squared();
    is_another(&shown, &data.angle).then(|| Diagnostic::TurnUnlikeGiven {
        turn: shows_another(number, turn, &shown),
        mistake: factor(share),
    })
}

//! Turns of known angle that do not fit the other data.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::turns::TurnContradicted;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// The data contradict a turn that is off by this many standard deviations.
const CONTRADICTED_SD: f64 = 4.5;

/// Turns that fit badly; none where some are quite others (`wrong_turns`), since the others fit badly then.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (model, turns) = (evidence.model, &evidence.problem.setup.turns);
    if !evidence.turns.is_empty() {
        return Vec::new();
    }
    let contradicted = model.turns.iter().zip(turns).enumerate().filter_map(|(number, (data, turn))| {
        let residual = model.turn_residual(data, &evidence.fit.state.imu);
        let deviations = residual.component_mul(&residual).dot(&data.weight).sqrt();
        let (turn, angle_rad) = (turn.span(number), turn.angle_rad);
        (deviations > CONTRADICTED_SD).then_some(Diagnostic::from(TurnContradicted {
            turn,
            angle_rad,
            deviations,
        }))
    });
    contradicted.collect()
}

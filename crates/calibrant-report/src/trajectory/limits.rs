//! The limits of a trajectory, with the share of each that is used.

use crate::number_format::{percent, short, significant};
use crate::sheet::{Cell, Column, Shown, Table};
use calibrant_machine_design::{Kept, LimitProof, TrajectoryEvaluation, TrajectoryProblem};

/// From this share on, a limit is worth a row on a terminal.
const NEAR: f64 = 0.8;

/// One row for each limit, the most used first.
pub(super) fn limit_table(of: &TrajectoryEvaluation, problem: &TrajectoryProblem<'_>) -> Table {
    let columns = ["limit", "of", "nearest", "allowed", "unit", "used"].map(Column::new);
    let mut table = Table::new(
        columns.into_iter().chain([Column::on_page("at time (s)"), Column::on_page("for all times")]),
    );
    let mut proofs: Vec<&LimitProof> = of.limits.iter().filter(|proof| proof.used.is_finite()).collect();
    proofs.sort_by(|one, other| other.used.total_cmp(&one.used));
    for proof in proofs {
        let kept = match proof.kept {
            Kept::Proved => "proved",
            Kept::Unproved => "not proved",
            Kept::Broken => "broken",
        };
        let used = if proof.kept == Kept::Broken { "broken".to_owned() } else { percent(proof.used) };
        let cells = vec![
            Cell::name(proof.limit.kind()),
            Cell::Text(problem.limited(proof.limit)),
            Cell::significant(proof.peak, 4),
            Cell::Number(short(proof.allowed)),
            Cell::text(problem.unit_of(proof.limit)),
            Cell::Number(used),
            Cell::fixed(proof.time_s, 2),
            Cell::text(kept),
        ];
        match proof.kept {
            Kept::Broken => table.row_left_out(cells),
            _ if proof.used < NEAR => table.row_shown(Shown::OnPage, cells),
            _ => table.row(cells),
        }
    }
    table
}

/// The nearest pair of bodies, and when; `None` where nothing is kept apart.
pub(super) fn nearest_pair(of: &TrajectoryEvaluation, problem: &TrajectoryProblem<'_>) -> Option<String> {
    let distances = of.limits.iter().filter(|proof| proof.limit.kind() == "distance");
    let nearest = distances.min_by(|one, other| one.peak.total_cmp(&other.peak))?;
    Some(format!(
        "Nearest bodies: {}, {} mm apart at {} s.",
        problem.limited(nearest.limit),
        significant(1e3 * nearest.peak, 3),
        significant(nearest.time_s, 3)
    ))
}

/// Limits that are broken, in words.
pub(super) fn broken(of: &TrajectoryEvaluation, problem: &TrajectoryProblem<'_>) -> Vec<String> {
    let broken = of.limits.iter().filter(|proof| proof.kept == Kept::Broken);
    let words = |proof: &LimitProof| {
        let unit = problem.unit_of(proof.limit);
        format!(
            "{} of {}: {} {unit} at {} s, allowed {} {unit}",
            proof.limit.kind(),
            problem.limited(proof.limit),
            significant(proof.peak, 4),
            significant(proof.time_s, 3),
            short(proof.allowed)
        )
    };
    broken.map(words).collect()
}

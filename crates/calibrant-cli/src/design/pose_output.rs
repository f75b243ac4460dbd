//! What the pages of a design of poses and of its evaluation share.

use super::Arguments;
use calibrant::design::poses::{DirectionKnowledge, PoseProblem};
use calibrant::report::About;
use calibrant::report::number_format::significant;

/// The head of a page.
pub(super) fn about(arguments: &Arguments, problem: &PoseProblem, title: &str) -> About {
    let directions = match problem.directions {
        DirectionKnowledge::Unknown => "unknown: only |f| = g".into(),
        DirectionKnowledge::Known { sd_rad: 0.0 } => "known exactly".into(),
        DirectionKnowledge::Known { sd_rad } => format!("known to {}°", significant(sd_rad.to_degrees(), 3)),
    };
    let mut facts = vec![
        ("Experiment".to_owned(), arguments.experiment.display().to_string()),
        ("Poses".to_owned(), problem.poses.to_string()),
        ("Directions".to_owned(), directions),
    ];
    facts.extend(arguments.from.iter().map(|path| ("Known before".to_owned(), path.display().to_string())));
    About { title: title.into(), facts, ..About::default() }
}

//! What the pages of a design of poses and of its evaluation share.

use super::Arguments;
use calibrant::design::poses::{DirectionKnowledge, PoseProblem};
use calibrant::io::write_atomically;
use calibrant::report::About;
use calibrant::report::number_format::significant;
use std::path::Path;

/// Writes a page whole or not at all.
pub(super) fn write_page(path: &Path, html: &str) -> calibrant::Result<()> {
    write_atomically(path, |out| out.write_all(html.as_bytes()))
}

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
    let program = format!("calibrant {}", env!("CARGO_PKG_VERSION"));
    About { title: title.into(), facts, program, ..About::default() }
}

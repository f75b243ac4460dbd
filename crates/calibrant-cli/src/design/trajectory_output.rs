//! Writes and shows the trajectory of a machine.

use super::Arguments;
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::TrajectoryPlan;
use calibrant::io::{Reached, to_json, write_text};
use calibrant::machine_design::TrajectoryDesign;
use calibrant::report::number_format::short;
use calibrant::report::{About, trajectory_sheet};

/// Writes and shows a design, with the goals that it reaches and a sentence on them.
pub(super) fn finish(
    arguments: &Arguments,
    plan: &TrajectoryPlan,
    design: TrajectoryDesign,
    reached: Option<(&Reached, &str)>,
) -> calibrant::Result<Exit> {
    let mut title = "Trajectory of a machine".to_owned();
    let (mut plan, mut design) = (plan.clone(), design);
    if let Some(times) = arguments.slow {
        title += &format!(", {} times slower", short(times));
        design = plan.slowed_design(&design, times)?;
        plan.machine.duration_s *= times;
    }
    let plan = &plan;
    let output = &arguments.output;
    let goals = reached.map(|(goals, _)| goals);
    let mut files = plan.write(&design, output, goals)?;
    let problem = plan.problem();
    let mut about = about(arguments, plan, title);
    about.findings.extend(reached.map(|(_, sentence)| sentence.to_owned()));
    let sheet = trajectory_sheet(&design, (&problem, &plan.world), &about);
    let page = output.join("report.html");
    write_text(&page, &sheet.html())?;
    files.push(page);
    let file = plan.file(&design, &problem, goals);
    let sentence = reached.map(|(_, sentence)| sentence);
    console::result(arguments.json, || to_json(&file), &sheet, sentence, &files)?;
    tell_all(&plan.remarks(&design));
    // however the search ended: the limits of what it found are proved
    Ok(if design.optimal.covariance.is_some() { Exit::DONE } else { Exit::NOT_IDENTIFIABLE })
}

pub(super) fn about(arguments: &Arguments, plan: &TrajectoryPlan, title: String) -> About {
    let fact = |label: &str, text: String| (label.to_owned(), text);
    let known = arguments.from.iter().map(|path| fact("Machine as found by", path.display().to_string()));
    let mut facts = vec![
        fact("Experiment", arguments.experiment.display().to_string()),
        fact(
            "Machine",
            format!(
                "{} joints, from {} to {}",
                plan.machine.chain.joints.len(),
                plan.machine.chain.base,
                plan.machine.chain.tip
            ),
        ),
        fact(
            "Duration",
            format!("{} s, waypoints every {} s", short(plan.machine.duration_s), short(plan.machine.knot_s)),
        ),
        fact("Starts", format!("{}, seed {}", plan.settings.starts, plan.settings.seed)),
    ];
    facts.extend(known);
    About { title, facts, ..About::default() }
}

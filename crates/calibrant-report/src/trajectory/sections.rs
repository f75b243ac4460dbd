//! The sections of a trajectory, in their order.

use super::gain::gains;
use super::limits::{broken, limit_table, nearest_pair};
use super::predicted::{promised_table, unit};
use crate::About;
use crate::budget::{bars, shares};
use crate::figure::{PLAYER_SCRIPT, Scene, joint_figure, player, three_views};
use crate::number_format::{counted, short, significant};
use crate::sheet::{Grade, Section, Sheet, SheetVerdict, Shown};
use calibrant_machine_design::world::World;
use calibrant_machine_design::{
    Kept, PlainRoutine, TrajectoryDesign, TrajectoryEvaluation, TrajectoryProblem,
};

/// What a reading is.
const MODEL: &str = "Readings are y = S f + b of the accelerometer and y = S ω + b of the gyroscope; sd is the standard deviation that a calibration from a recording of \
    the trajectory will state, as the root mean square over sensors: those with larger cross terms than usual, 1 % where the experiment says nothing, have larger ones of the \
    scale factors, which an uncertain mount mixes with them.";

/// Values within this of the best are called equal, nats: 1 % in each of two dozen standard deviations.
const EQUAL: f64 = 0.5;

/// The best trajectory of a machine as a sheet.
#[must_use]
pub fn trajectory_sheet<'a>(
    design: &'a TrajectoryDesign,
    (problem, world): (&'a TrajectoryProblem<'a>, &'a World),
    about: &'a About,
) -> Sheet<'a> {
    let best = &design.optimal;
    let random = ("random motion", &design.random);
    let plain = design.plain.as_ref().map(|of| (of.routine.name(), &of.evaluation));
    let others = plain.map_or_else(Vec::new, |_| vec![random]);
    let proved = best.limits.iter().all(|proof| proof.kept == Kept::Proved);
    let (grade, word) =
        if proved { (Grade::Good, "✓ Found.") } else { (Grade::Caution, "! Not all limits are proved.") };
    let verdict =
        SheetVerdict::new(grade, word, in_words(design, problem)).with("Findings", about.findings.clone());
    let mut predicted = Section::new("Predicted standard deviations").lead(
        "Standard deviations that a calibration from a recording of the trajectory will state, with everything else that is not known exactly. All trajectories \
         last as long and keep the limits. The random motion is the first start of the search. What the mount or the geometry leaves open, no motion \
         improves: the symmetric part of a matrix, the mean of its entries xy and yx, does not depend on the mount, and criterion D counts all combinations of the parameters.",
    );
    match &design.plain {
        Some(of) => predicted.explanation(compared_with(of.routine)),
        None => predicted.line(
            "No plain routine was found that keeps the limits in this duration: six poses, or each joint in turn.",
        ),
    }
    predicted.table(promised_table(plain.unwrap_or(random), &others, Some(("optimal", best))));
    predicted.line(values(design, problem));
    let sections = vec![
        predicted,
        motion(best, problem, world),
        budget(best),
        path(best, problem),
        limits(best, problem),
        search(design),
    ];
    about.sheet("Trajectory of a machine", verdict, sections, MODEL)
}

/// The evaluation of a trajectory as a sheet, beside the best one where it was sought.
#[must_use]
pub fn trajectory_evaluation_sheet<'a>(
    evaluation: &'a TrajectoryEvaluation,
    best: Option<&'a TrajectoryEvaluation>,
    (problem, world): (&'a TrajectoryProblem<'a>, &'a World),
    about: &'a About,
) -> Sheet<'a> {
    let broken = broken(evaluation, problem);
    let verdict = match (broken.is_empty(), evaluation.is_proved()) {
        (true, true) => {
            SheetVerdict::new(Grade::Good, "✓ All limits are kept.", "It is proved for all times.")
        }
        (true, false) => SheetVerdict::new(
            Grade::Caution,
            "! Not all limits are proved.",
            "None is broken at the times that were looked at.",
        ),
        (false, _) => SheetVerdict::new(
            Grade::Bad,
            "✗ Limits are broken.",
            format!(
                "{} broken. Do not run it.",
                if broken.len() == 1 {
                    "One limit is".into()
                } else {
                    format!("{} limits are", broken.len())
                }
            ),
        ),
    };
    let mut predicted = Section::new("Predicted standard deviations");
    let given = ("of this trajectory", evaluation);
    predicted.table(promised_table(given, &[], best.map(|best| ("optimal", best))));
    let mut sections = vec![
        predicted,
        motion(evaluation, problem, world),
        budget(evaluation),
        path(evaluation, problem),
        limits(evaluation, problem),
    ];
    if !broken.is_empty() {
        let mut section = Section::new("Broken limits");
        section.list(broken);
        sections.insert(0, section);
    }
    about.sheet("Evaluation of a trajectory", verdict, sections, MODEL)
}

/// What a plain routine is.
fn compared_with(routine: PlainRoutine) -> &'static str {
    match routine {
        PlainRoutine::SixPoses => {
            "Six poses: each axis of the sensor up and down, held at rest, with the quickest straight moves in between; the best of a few such routines."
        }
        PlainRoutine::JointsInTurn => {
            "Joints in turn: each joint to both of its ends and back, as quickly as it may, again and again; the best of a few such routines."
        }
    }
}

fn in_words(design: &TrajectoryDesign, problem: &TrajectoryProblem<'_>) -> String {
    let knots = design.optimal.motion.knots;
    let duration = short((1e3 * knots.step_s * knots.intervals as f64).round() / 1e3);
    let mut sentence =
        format!("A trajectory of {duration} s for {}.", counted(problem.chain.joints.len(), "joint"));
    let plain = design.plain.as_ref().map(|of| (&of.evaluation, of.routine.name()));
    let compared = plain.into_iter().chain([(&design.random, "a random motion")]);
    let compared: Vec<_> = compared.filter(|(of, _)| of.value.is_finite()).collect();
    sentence += &gains(&compared, &design.optimal, problem);
    if let Some(bound) = &design.bound {
        sentence += &format!(
            " A bound, whose minimum was looked for on a grid, leaves at most a factor of {} by this criterion; it is loose.",
            significant(bound.times_better, 3)
        );
    }
    sentence
}

fn values(design: &TrajectoryDesign, problem: &TrajectoryProblem<'_>) -> String {
    let bound =
        design.bound.map_or_else(String::new, |bound| format!(", bound {}", significant(bound.value, 5)));
    let plain = design.plain.as_ref().map_or_else(String::new, |of| {
        format!("{} {}, ", significant(of.evaluation.value, 5), of.routine.name())
    });
    format!(
        "{} (nats): {plain}{} random, {} optimal{bound}",
        problem.criterion.letter(),
        significant(design.random.value, 5),
        significant(design.optimal.value, 5)
    )
}

fn budget(of: &TrajectoryEvaluation) -> Section<'_> {
    let mut section =
        Section::new("Budget").lead("Where the variance of each parameter comes from: what to improve.");
    if !of.budget.is_empty() {
        section.table(shares(&of.budget).shown(Shown::OnTerminal));
        section.figure(|| Some(bars(&of.budget, unit)));
    }
    section
}

/// The posture to begin with, and the dwells.
fn path<'a>(of: &TrajectoryEvaluation, problem: &TrajectoryProblem<'_>) -> Section<'a> {
    let mut section = Section::new("The way");
    let knots = of.motion.knots;
    let start = of.motion.at(knots.start_s, 0);
    let joints = problem.chain.joints.iter().zip(start);
    let posture: Vec<String> = joints
        .map(|(joint, position)| match joint.kind.turns() {
            true => format!("{} {}°", joint.name, significant(position.to_degrees(), 4)),
            false => format!("{} {} m", joint.name, significant(position, 4)),
        })
        .collect();
    section.paragraph(format!("Begin at rest at: {}. Go there slowly, and watch the surroundings: the way to this posture is not part of the design.", posture.join(", ")));
    section.paragraph(format!("{} of {} s.", counted(knots.intervals, "interval"), short(knots.step_s)));
    section
}

fn limits<'a>(of: &TrajectoryEvaluation, problem: &TrajectoryProblem<'_>) -> Section<'a> {
    let proof = "What is called proved holds between the samples, too.";
    let mut section = Section::new("Limits").lead(format!("Each limit with its largest use. {proof}"));
    section.table(limit_table(of, problem));
    nearest_pair(of, problem).into_iter().for_each(|line| section.line(line));
    section
}

fn motion<'a>(
    of: &'a TrajectoryEvaluation,
    problem: &'a TrajectoryProblem<'a>,
    world: &'a World,
) -> Section<'a> {
    let mut section = Section::on_page("The machine in motion").lead("To turn and to play.");
    section.drawn(|| {
        let scene = Scene::of_trajectory(&of.motion, problem.chain, problem.setup, world);
        let script = format!("<script>\n{PLAYER_SCRIPT}</script>");
        [player(&scene), three_views(&scene), script].join("\n")
    });
    section.figure(|| Some(joint_figure(&of.motion, problem)));
    section
}

fn search<'a>(design: &TrajectoryDesign) -> Section<'a> {
    let mut section = Section::new("The search");
    let polished = design.starts.iter().filter(|start| start.polished);
    let at_best = polished.clone().filter(|start| start.value - design.optimal.value < EQUAL).count();
    // a slowed trajectory has none: its values are of another duration
    if !design.starts.is_empty() {
        let searched = counted(polished.count(), "start");
        section.line(format!(
            "Of {searched} searched to the end, {at_best} came within {EQUAL} nats of the best (1 % of a standard deviation)."
        ));
    }
    if !design.dwells_s.is_empty() {
        let each: Vec<String> = design
            .dwells_s
            .iter()
            .map(|(from, to)| format!("{} to {} s", short(*from), short(*to)))
            .collect();
        section.line(format!("The machine stands still at {}.", each.join(", ")));
    }
    section
}

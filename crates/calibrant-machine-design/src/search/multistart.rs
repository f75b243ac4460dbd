//! Many starts on coarse knots, the best of them on finer ones, and the best of these with the full information.
//!
//! Every stage is a list of runs that do not know of each other, in a fixed order. So the result does not depend on the number of threads.

use super::nested::{Candidate, HeldBack, Level, Shared};
use super::{Kind, Starts, Steps};
use crate::certificate::certify;
use crate::information::{FullInformation, Sensing, undetermined};
use crate::motion::{Knots, REST};
use crate::{Dwells, Kept, LimitProof, TrajectoryProblem, TrajectorySettings, TrajectoryStart};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::simulate::{Purpose, stream};
use calibrant_design::{DesignStatus, Interruption};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Fewest intervals of the coarsest knots.
const COARSE: usize = 10;
/// Quadrature points in an interval on each level, the coarsest first, and times at which limits are taken.
const POINTS: [usize; 3] = [5, 4, 3];
const TIMES: [usize; 3] = [5, 4, 3];
/// Barrier parameter of random starts, and the last one on each level, in nats. A level begins with the last one of the level before: a larger one would drive the motion back
/// from the limits that it has found.
const FIRST_BARRIER: f64 = 0.075;
/// Short motions have fewer levels, and one or two joints perhaps: they begin each level farther from the limits.
const SHORT_BARRIERS: [f64; 3] = [FIRST_BARRIER, 0.1, 0.05];
const BARRIERS: [f64; 3] = [0.02, 0.01, 5e-4];
/// A step that lowers the barrier function by less than this is small, on each level.
const STALLS: [f64; 3] = [0.05, 0.02, 0.003];
/// Iterations at most. The last stage goes on from the finest knots, so their optimum need not be exact.
const ITERATIONS: [usize; 3] = [usize::MAX, usize::MAX, 80];
/// Where there are dwells, the last stage begins with this many times its iterations in which they are held: near rest, noise that grows makes steps short.
const HELD: usize = 2;
/// The same of the last stage, with the full information.
const POLISH: ((f64, f64), f64) = ((1e-3, 4e-4), 0.002);
/// Times of an interval at which a repair takes limits.
const REPAIR_TIMES: usize = 12;
/// What the search holds back.
pub(crate) const HELD_BACK: HeldBack = HeldBack { clearance_m: 0.0025, share: 0.008 };

/// The knots of each level, the coarsest first.
pub(crate) fn levels(problem: &TrajectoryProblem<'_>) -> Vec<Knots> {
    let about = problem.duration_s / problem.knot_s - 1e-9;
    let halvings = (0..3).rev().find(|h| about >= (COARSE << h) as f64).unwrap_or(0);
    let coarsest = (about / f64::from(1 << halvings)).ceil().max(4.0);
    let knots = Knots { step_s: problem.duration_s / coarsest, intervals: coarsest as usize };
    std::iter::successors(Some(knots), |knots| Some(knots.halved())).take(halvings + 1).collect()
}

/// What the search found.
pub(crate) struct Found {
    /// Motions, the best first: those of the last stage, then what there was before.
    pub(crate) candidates: Vec<Candidate>,
    /// The first start, as it was drawn.
    pub(crate) first: Candidate,
    pub(crate) starts: Vec<TrajectoryStart>,
    pub(crate) iterations: usize,
}

/// Searches the best motion.
///
/// # Errors
/// [`Error::Infeasible`] where no start keeps the limits, [`Error::NotIdentifiable`] where no motion determines the parameters.
pub(crate) fn search(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    settings: &TrajectorySettings,
    interruption: &Interruption,
) -> Result<Found> {
    let sizes = sizes(problem);
    let shared = Shared { problem, sensing, sizes: &sizes };
    let levels = levels(problem);
    let mut candidates = drawn(shared, settings, levels[0], interruption);
    if candidates.is_empty() {
        settings.interruption.check()?;
    }
    let first = candidates.first().cloned().ok_or_else(|| no_start(shared, levels[0]))?;
    let mut full = FullInformation::new(sensing, problem.chain, first.knots, POINTS[0]);
    if full.at(&first.controls).is_none() {
        let information = full.information().unwrap_or_else(|| sensing.sensor_prior());
        if let Some(error) = undetermined(&information, &sensing.quantities()) {
            return Err(error);
        }
    }
    let mut left_behind = Vec::new();
    // what to fall back on: the best of each level, and the first start
    let mut fallbacks = vec![first.clone()];
    let stages = (levels.len() + 1) as u64;
    for place in 0..levels.len() {
        if place > 0 {
            let kept = (settings.kept >> (place - 1)).clamp(1, candidates.len());
            left_behind.extend(candidates.split_off(kept).iter().map(|one| one.outcome(false)));
            candidates = candidates.into_iter().map(Candidate::halved).collect();
        }
        let level = level(place, levels.len(), settings, interruption);
        // an interruption leaves out starts that were not begun
        let begun = |one: &Candidate| place > 0 || one.start == first.start || !interruption.is_asked();
        candidates = candidates
            .into_par_iter()
            .filter(begun)
            .map(|one| shared.with_full_value(shared.improve(one, &level), level.points))
            .collect();
        sort(&mut candidates);
        fallbacks.push(candidates[0].clone());
        settings.progress.tell("search", place as u64 + 1, stages);
    }
    // the nuisances count; then dwells are free to go
    let kept = (settings.kept / 2).clamp(1, candidates.len());
    left_behind.extend(candidates.split_off(kept).iter().map(|one| one.outcome(false)));
    let polish = polish(settings.polish, HELD_BACK, interruption);
    let held = self::polish(HELD * settings.polish, HELD_BACK, interruption);
    candidates = candidates
        .into_par_iter()
        .map(|one| if one.dwells.is_empty() { one } else { shared.improve(one, &held) })
        .map(|one| shared.improve(Candidate { dwells: Vec::new(), ..one }, &polish))
        .collect();
    sort(&mut candidates);
    settings.progress.tell("search", stages, stages);
    let mut starts: Vec<TrajectoryStart> = candidates.iter().map(|one| one.outcome(true)).collect();
    left_behind.sort_by(|a, b| a.knot_s.total_cmp(&b.knot_s).then(a.value.total_cmp(&b.value)));
    starts.extend(left_behind);
    candidates.extend(fallbacks.into_iter().rev());
    let iterations = starts.iter().map(|start| start.iterations).sum();
    Ok(Found { candidates, first, starts, iterations })
}

/// The same motion, searched on with limits at more times; then with more held back of them, twice, four times, until its limits are proved, or an interruption ends it.
pub(crate) fn repaired(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    candidate: &Candidate,
    interruption: &Interruption,
    is_proved: impl Fn(&Candidate) -> bool,
) -> Option<Candidate> {
    let sizes = sizes(problem);
    let shared = Shared { problem, sensing, sizes: &sizes };
    let more = |factor: f64| {
        let held_back =
            HeldBack { clearance_m: factor * HELD_BACK.clearance_m, share: factor * HELD_BACK.share };
        let level = polish(20, held_back, interruption);
        shared.improve(candidate.clone(), &Level { times: REPAIR_TIMES, ..level })
    };
    let factors = [1.0, 2.0, 4.0].into_iter().take_while(|_| !interruption.is_asked());
    factors.map(more).find(|one| one.admissible && is_proved(one))
}

/// The last stage.
fn polish(iterations: usize, held_back: HeldBack, interruption: &Interruption) -> Level {
    Level {
        points: POINTS[2],
        times: TIMES[2],
        kind: Kind::Full,
        held_back,
        steps: Steps {
            barrier: POLISH.0,
            max_iterations: iterations,
            stall: POLISH.1,
            interruption: interruption.clone(),
        },
    }
}

/// Why there is no start: what a posture at rest breaks, or the limits of the motion.
fn no_start(shared: Shared<'_>, knots: Knots) -> Error {
    let problem = shared.problem;
    let refuse = |key: &str, what: String, help: &str| {
        Error::infeasible(InputError::new(Refusal::MotionInfeasible, what, help).about_key(key))
    };
    // at rest the readings of three axes are those of gravity, whatever the posture
    if problem.force_range_mps2.norm() < problem.setup.gravity_mps2 {
        let what = "gravity at rest exceeds the range of the accelerometer in every posture".to_owned();
        return refuse("sensor.range_mps2", what, "give the range of each axis in m/s²: ±4 g is 39.2");
    }
    let mut starts = Starts::new(shared.pointwise(HELD_BACK), knots, &[]);
    let posture = starts.posture(&mut stream(0, Purpose::Start, 0));
    match (&problem.home, posture) {
        (_, Some(_)) => {
            let what = "the machine may rest, but no motion was found that keeps the limits of its joints"
                .to_owned();
            let help = "look at velocity, acceleration and jerk in [machine.limits]: are they in rad/s, rad/s², rad/s³?";
            refuse("machine.limits", what, help)
        }
        (Some(home), None) => {
            let rest = DMatrix::from_fn(knots.controls(), home.len(), |_, j| home[j]);
            let proofs = certify(problem, knots, &rest);
            let of = |proof: &LimitProof| {
                let unit = problem.unit_of(proof.limit);
                let (kind, of) = (proof.limit.kind(), problem.limited(proof.limit));
                format!("{kind} of {of} is {:.4} {unit}, allowed {:.4} {unit}", proof.peak, proof.allowed)
            };
            let broken: Vec<String> =
                proofs.iter().filter(|proof| proof.kept == Kept::Broken).map(of).collect();
            let why = match broken.is_empty() {
                true => "it has not the room that a design keeps".to_owned(),
                false => broken.join("; "),
            };
            refuse(
                "machine.design.home",
                format!("the machine cannot rest at home: {why}"),
                "give another home posture, or none",
            )
        }
        (None, None) => {
            let what = "no posture was found in which the machine may rest".to_owned();
            refuse(
                "machine.world",
                what,
                "look at the floor, the boxes, the clearance and the sensor's range",
            )
        }
    }
}

/// The settings of a level of knots. `number`: from 0, the coarsest. `levels`: how many there are.
fn level(number: usize, levels: usize, settings: &TrajectorySettings, interruption: &Interruption) -> Level {
    let place = number + 3 - levels;
    let first = if number > 0 && levels == 3 { BARRIERS[place - 1] } else { SHORT_BARRIERS[place] };
    Level {
        points: POINTS[place],
        times: TIMES[place],
        kind: Kind::Plain,
        held_back: HELD_BACK,
        steps: Steps {
            barrier: (first, BARRIERS[place]),
            max_iterations: settings.max_iterations.min(ITERATIONS[place]),
            stall: STALLS[place],
            interruption: interruption.clone(),
        },
    }
}

/// Admissible ones first, then by value, then by start.
fn sort(candidates: &mut [Candidate]) {
    candidates.sort_by(|a, b| {
        b.admissible.cmp(&a.admissible).then(a.value.total_cmp(&b.value)).then(a.start.cmp(&b.start))
    });
}

/// Starts. Numbers of dwells take turns.
fn drawn(
    shared: Shared<'_>,
    settings: &TrajectorySettings,
    knots: Knots,
    interruption: &Interruption,
) -> Vec<Candidate> {
    let numbers = dwell_numbers(shared.problem);
    let one = |start: usize| {
        if start > 0 && interruption.is_asked() {
            return None;
        }
        let dwells = runs(numbers[start % numbers.len()], knots);
        let mut candidate = Candidate {
            knots,
            controls: DMatrix::zeros(knots.controls(), shared.sizes.len()),
            dwells,
            start,
            value: f64::INFINITY,
            iterations: 0,
            status: DesignStatus::Stalled,
            admissible: false,
        };
        let ties = shared.ties(&candidate);
        let mut rng = stream(settings.seed, Purpose::Start, start as u64);
        let mut starts = Starts::new(shared.pointwise(HELD_BACK), knots, &candidate.dwells);
        candidate.controls = starts.draw(&ties, &settings.interruption, &mut rng)?;
        Some(candidate)
    };
    (0..settings.starts).into_par_iter().filter_map(one).collect()
}

/// Numbers of dwells that are tried.
fn dwell_numbers(problem: &TrajectoryProblem<'_>) -> Vec<usize> {
    match problem.dwells {
        Dwells::None => vec![0],
        Dwells::Number(number) => vec![number],
        Dwells::Auto if problem.noise.moving > 1.0 => vec![0, 4, 5, 6],
        Dwells::Auto => vec![0],
    }
}

/// Control points that are equal in a dwell on the coarsest knots: at rest for an interval.
const RUN: usize = 4;

/// Runs of equal control points at even distances, ends included. Fewer than asked for where there is no room.
fn runs(number: usize, knots: Knots) -> Vec<(usize, usize)> {
    let controls = knots.controls();
    // two free control points between dwells
    let number = number.min((controls + 2) / (RUN + 2));
    if number < 2 {
        return Vec::new();
    }
    let step = (controls - RUN) as f64 / (number - 1) as f64;
    (0..number).map(|k| ((k as f64 * step).round() as usize, RUN)).collect()
}

/// The size of each joint's unknowns: a third of the way that it goes in a second at its top speed, so that they are of order one for an arm and a gantry alike.
fn sizes(problem: &TrajectoryProblem<'_>) -> Vec<f64> {
    let size = |joint: &crate::JointLimit| {
        let of_range = (joint.upper - joint.lower) / 6.0;
        [joint.velocity / 3.0, of_range].into_iter().filter(|size| size.is_finite()).fold(f64::NAN, f64::min)
    };
    problem.joints.iter().map(size).map(|size| if size.is_finite() { size } else { 1.0 }).collect()
}

const _: () = assert!(RUN > REST);

//! The multistart search: many starts, in parallel, and the best motion of each axis.
//!
//! A third of the starts are random motions and corners of the admissible region; for a full sensor most of
//! these are the optima of single axes, combined. The others are kicks from the best optima so far. They run
//! in rounds, so that the result does not depend on the number of threads. They end early once many starts
//! agree on the best, or one is as close to the bound as was asked for, and where a time is given, after it.
//!
//! Axes of a scale-bias sensor share nothing, so each has its own design. Axes with the same problem are
//! designed once, with the starts of all of them. Among equally good motions each axis takes the one most
//! like its initial motion: optima come in pairs, `a` and `−a`, and often more.

use crate::certificate::LowerBound;
use crate::limits::Region;
use crate::local_search::{LocalOptimum, Nodes, Part, PartGravity};
use crate::{DesignProblem, DesignSettings, DesignStatus, StartOutcome};
use calibrant_core::error::Result;
use calibrant_core::information::criterion::DOptimality;
use calibrant_core::information::{Criterion, PartInformation};
use calibrant_core::motion::{JerkControlledMotion, Limits, MotionClock};
use calibrant_core::sensor::{Axis, SensorModel};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::{DVector, SMatrix, SVector, Vector3};
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// The result of the search.
pub(crate) struct Found {
    pub(crate) nodes: Vec<Vector3<f64>>,
    pub(crate) starts: Vec<StartOutcome>,
    pub(crate) status: DesignStatus,
}

/// What the search of every part shares.
struct Search<'a> {
    /// The first start of every axis.
    initial: &'a JerkControlledMotion,
    settings: &'a DesignSettings,
    progress: &'a (dyn Fn(u64) + Sync),
    problem: &'a DesignProblem<'a>,
    /// The lower bound, where the search may end at a gap to it.
    bound: Option<&'a LowerBound>,
}

/// Values that differ by less than this, relatively, are equal.
const EQUAL: f64 = 1e-9;
/// Number of starts at the best value that end the search.
const AGREED: usize = 10;
/// One in this many starts is not a kick.
const FIRST: usize = 3;
/// Number of kicks from the same optima.
const ROUND: usize = 8;
/// Relative difference within which a start is at the best value.
const AGREEMENT: f64 = 1e-7;

/// Searches the best motion. `initial` is the first start of every axis. `inside` is an admissible motion at
/// a relative distance `slack` from every limit.
pub(crate) fn search(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    bound: Option<&LowerBound>,
    limits: &Limits,
    initial: &JerkControlledMotion,
    (inside, slack): (&JerkControlledMotion, f64),
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Found> {
    let setting = problem.setting()?;
    // what is best for an exact clock is a good start
    let exact = match problem.clock.is_exact() {
        true => None,
        false => {
            let exact = DesignProblem { clock: MotionClock::default(), ..problem.clone() };
            let found = self::search(&exact, settings, None, limits, initial, (inside, slack), &|_| ())?;
            Some(JerkControlledMotion::new(initial.times_s().to_vec(), found.nodes)?)
        }
    };
    let search = Search { initial, settings, progress, problem, bound };
    let mut found = Found {
        nodes: vec![Vector3::zeros(); problem.intervals + 1],
        starts: Vec::new(),
        status: DesignStatus::Converged,
    };
    if problem.sensor.model == SensorModel::Full {
        let whole = part(problem, setting.full(initial), limits, inside, slack);
        // any criterion gives good motions of single axes; D needs no weights
        let alone = DesignProblem {
            criterion: Criterion::D(DOptimality { scale: DVector::repeat(whole.prior.nrows(), 1.0) }),
            prior: None,
            gravity: None,
            ..problem.clone()
        };
        let axes = [0, 1, 2].map(|axis| part(&alone, setting.single(axis, initial), limits, inside, slack));
        // the single axes take at most half of the time
        let begun = Instant::now();
        let half = settings.seconds.map(|seconds| begun + Duration::from_secs_f64(seconds / 2.0));
        let alone = DesignSettings { interruption: settings.interruption.or_at(half), ..settings.clone() };
        let combined = whole.combined(axes.each_ref(), settings.starts * 2 / 3, &alone);
        let all = problem.sensor.active_axes().to_vec();
        let left = settings.seconds.map(|seconds| (seconds - begun.elapsed().as_secs_f64()).max(0.0));
        let settings = &DesignSettings { seconds: left, ..settings.clone() };
        let promising = exact.iter().map(|exact| whole.information.nodes(exact)).chain(combined).collect();
        found.take(&whole, &[all], promising, &Search { settings, ..search });
        return Ok(found);
    }
    let mut classes: Vec<(Part<1, 2>, Vec<Vec<Axis>>)> = Vec::new();
    for &axis in problem.sensor.active_axes() {
        let own = part(problem, setting.single(axis.index(), initial), limits, inside, slack);
        match classes.iter_mut().find(|(other, _)| other.is_like(&own)) {
            Some((_, axes)) => axes.push(vec![axis]),
            None => classes.push((own, vec![vec![axis]])),
        }
    }
    for (part, axes) in &classes {
        let of_axes = |axes: &Vec<Axis>| exact.as_ref().map(|exact| axis_nodes(exact, axes));
        found.take(part, axes, axes.iter().filter_map(of_axes).collect(), &search);
    }
    Ok(found)
}

/// The nodes of a motion on these axes.
fn axis_nodes<const D: usize>(motion: &JerkControlledMotion, axes: &[Axis]) -> Nodes<D> {
    motion.acceleration_mps2().iter().map(|a| SVector::from_fn(|k, _| a[axes[k].index()])).collect()
}

fn part<const D: usize, const P: usize>(
    problem: &DesignProblem<'_>,
    information: PartInformation<D, P>,
    limits: &Limits,
    inside: &JerkControlledMotion,
    slack: f64,
) -> Part<D, P> {
    let slots = information.slots;
    let gravity = problem.gravity_marginal();
    let prior = gravity.as_ref().map(|gravity| &gravity.prior).or(problem.prior.as_ref());
    Part {
        regions: information.axes.map(|axis| Region::new(limits.axis(axis), &information.tau)),
        criterion: problem.criterion.restricted(&slots),
        prior: prior
            .map_or_else(SMatrix::zeros, |prior| SMatrix::from_fn(|i, j| prior[(slots[i], slots[j])])),
        gravity: gravity.as_ref().and_then(|gravity| PartGravity::of(gravity, &slots)),
        inside: information.nodes(inside),
        slack,
        information,
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// Is it the same problem, for another axis?
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.regions.iter().zip(&other.regions).all(|(one, two)| one.limits == two.limits)
            && self.criterion == other.criterion
            && self.prior == other.prior
            && self.gravity == other.gravity
            && self.inside == other.inside
            && self.information.is_like(&other.information)
    }

    /// How much a motion resembles another: their scalar product.
    fn resemblance(a: &[SVector<f64, D>], b: &[SVector<f64, D>]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
    }

    /// The best outcome for the axes that begin at `own`: among equals, and their mirror images, the one most
    /// like it.
    fn choose(
        &self,
        outcomes: &[LocalOptimum<D>],
        own: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, DesignStatus)> {
        let best = outcomes.iter().min_by(|a, b| a.value.total_cmp(&b.value))?;
        if best.value.is_infinite() {
            // no motion determines the parameters: the first one shows it as well as any
            return outcomes.first().map(|first| (first.nodes.clone(), first.status));
        }
        let mut choice: Option<(Nodes<D>, DesignStatus)> = None;
        let mut likeness = f64::NEG_INFINITY;
        let equal = best.value + EQUAL * best.value.abs().min(1.0);
        for outcome in outcomes.iter().filter(|outcome| outcome.value <= equal) {
            let mirrored: Nodes<D> = outcome.nodes.iter().map(|node| -node).collect();
            let symmetric = self
                .regions
                .iter()
                .all(|region| region.limits.start.is_none() && region.limits.end.is_none())
                && self.value(&mirrored) <= equal;
            for nodes in std::iter::once(&outcome.nodes).chain(symmetric.then_some(&mirrored)) {
                let own = Self::resemblance(nodes, own);
                if own > likeness {
                    likeness = own;
                    choice = Some((nodes.clone(), outcome.status));
                }
            }
        }
        // a start that ended there and converged shows that it is an optimum
        let close = best.value + AGREEMENT * best.value.abs();
        let converged =
            |outcome: &LocalOptimum<D>| outcome.value <= close && outcome.status == DesignStatus::Converged;
        if outcomes.iter().any(converged) {
            return choice.map(|(nodes, _)| (nodes, DesignStatus::Converged));
        }
        choice
    }
}

impl Search<'_> {
    /// The value at which the gap asked for is reached, of the part with the parameters at these places. Where
    /// every part reaches its own, the whole does.
    fn good_enough(&self, places: &[usize]) -> Option<f64> {
        let (bound, gap) = (self.bound?, self.settings.gap?);
        if self.problem.gravity.is_some() {
            // gaps are above a floor that belongs to all parts
            return None;
        }
        let criterion = &self.problem.criterion;
        let bound = bound.of_part(criterion, places);
        let size = self.problem.sensor.parameter_list().len();
        Some(match criterion {
            Criterion::D(_) => bound + gap * places.len() as f64 / size as f64,
            _ => bound * (1.0 + gap),
        })
    }
}

impl Found {
    /// Do enough starts end at the best value?
    fn agreed<const D: usize>(outcomes: &[LocalOptimum<D>], best: f64) -> bool {
        let close = |outcome: &&LocalOptimum<D>| outcome.value <= best + AGREEMENT * best.abs();
        outcomes.iter().filter(close).count() >= AGREED
    }

    /// Runs the starts of a part and takes the best motion for each of its `groups` of axes. It begins with the
    /// initial motions and the `promising` ones.
    fn take<const D: usize, const P: usize>(
        &mut self,
        part: &Part<D, P>,
        groups: &[Vec<Axis>],
        promising: Vec<Nodes<D>>,
        search: &Search<'_>,
    ) {
        let Search { initial, settings, progress, problem, .. } = *search;
        let own = |axes: &[Axis]| -> Nodes<D> { axis_nodes(initial, axes) };
        let first = groups[0][0].index() as u64;
        let count = settings.starts * D * groups.len();
        // axes that are designed one after the other share the time
        let share = (D * groups.len()) as f64 / problem.sensor.axes as f64;
        let deadline =
            settings.seconds.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds * share));
        let interruption = settings.interruption.or_at(deadline);
        let settings = &DesignSettings { interruption, ..settings.clone() };
        let mut outcomes: Vec<LocalOptimum<D>> = Vec::new();
        let mut numbers: Vec<usize> = Vec::new();
        let first_ones = count.div_ceil(FIRST);
        let good_enough = search.good_enough(&part.information.slots);
        while outcomes.len() < count || deadline.is_some() {
            let mut best: Vec<&LocalOptimum<D>> = outcomes.iter().collect();
            best.sort_by(|one, other| one.value.total_cmp(&other.value));
            best.dedup_by(|one, other| one.value <= other.value + AGREEMENT * other.value.abs());
            // starts that resemble each other agree easily
            let independent = outcomes.get(promising.len()..).unwrap_or_default();
            if best.first().is_some_and(|best| Self::agreed(independent, best.value)) {
                progress(count.saturating_sub(outcomes.len()) as u64);
                break;
            }
            if best.first().is_some_and(|best| good_enough.is_some_and(|value| best.value <= value)) {
                progress(count.saturating_sub(outcomes.len()) as u64);
                break;
            }
            if settings.interruption.is_asked() && !best.is_empty() {
                break;
            }
            let optima: Vec<&Nodes<D>> = best.iter().map(|best| &best.nodes).collect();
            let most = if deadline.is_some() { usize::MAX } else { count };
            // the first ones need no optima, and run at once where nothing is to be decided in between
            let end = match outcomes.len() {
                done if done < first_ones && good_enough.is_none() => first_ones,
                done if done < first_ones => first_ones.min(done + ROUND),
                done => most.min(done + ROUND),
            };
            let (done, round): (Vec<_>, Vec<_>) = (outcomes.len()..end)
                .into_par_iter()
                .filter_map(|number| {
                    // each axis keeps its initial motion at least
                    if settings.interruption.is_asked() && number >= groups.len() {
                        return None;
                    }
                    let mut rng = stream(settings.seed, Purpose::Start, 3 * number as u64 + first);
                    let start = if number < groups.len() {
                        part.stretched_if_better(own(&groups[number]))
                    } else if let Some(start) = promising.get(number - groups.len()) {
                        start.clone()
                    } else if number < first_ones {
                        part.start(number, &mut rng).unwrap_or_else(|| own(&groups[0]))
                    } else {
                        part.kicked(&optima, &mut rng).unwrap_or_else(|| own(&groups[0]))
                    };
                    let outcome = part.improve(start, settings);
                    settings.so_far.found(first as usize, groups.len(), D * groups.len(), outcome.value);
                    progress(1);
                    Some((number, outcome))
                })
                .unzip();
            numbers.extend(done);
            outcomes.extend(round);
        }
        let axes: Vec<Axis> = groups.iter().flatten().copied().collect();
        for (&number, outcome) in numbers.iter().zip(&outcomes) {
            self.starts.push(StartOutcome {
                axes: axes.clone(),
                number,
                initial_value: outcome.initial_value,
                value: outcome.value,
                iterations: outcome.iterations,
                status: outcome.status,
            });
        }
        for group in groups {
            let Some((nodes, status)) = part.choose(&outcomes, &own(group)) else { continue };
            for (whole, node) in self.nodes.iter_mut().zip(&nodes) {
                for (k, axis) in group.iter().enumerate() {
                    whole[axis.index()] = node[k];
                }
            }
            if status != DesignStatus::Converged {
                self.status = status;
            }
        }
    }
}

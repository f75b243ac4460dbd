//! One motion on nested knots: coarse knots find its shape, halved ones its limits.
//!
//! Halving is exact, so the motion of one level starts the next. Most of the information is found on coarse knots at a fraction of the cost.

use super::{InteriorPoint, Kind, Objective, Reached, Rows, Steps};
use crate::information::Sensing;
use crate::limits::{Linear, Pointwise};
use crate::motion::{Knots, Ties, halved};
use crate::{TrajectoryProblem, TrajectoryStart};
use calibrant_design::DesignStatus;
use nalgebra::DMatrix;

/// What the search holds back of limits at times, since they are taken at some times alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HeldBack {
    /// Of the clearance, m.
    pub(crate) clearance_m: f64,
    /// Part of ranges and speeds.
    pub(crate) share: f64,
}

/// A motion under way.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    pub(crate) knots: Knots,
    pub(crate) controls: DMatrix<f64>,
    /// Runs of control points that are held equal.
    pub(crate) dwells: Vec<(usize, usize)>,
    /// Number of the start.
    pub(crate) start: usize,
    pub(crate) value: f64,
    pub(crate) iterations: usize,
    pub(crate) status: DesignStatus,
    /// Does it keep the limits at all times that were looked at?
    pub(crate) admissible: bool,
}

impl Candidate {
    /// How it went.
    pub(crate) fn outcome(&self, polished: bool) -> TrajectoryStart {
        TrajectoryStart {
            number: self.start,
            knot_s: self.knots.step_s,
            value: self.value,
            polished,
            iterations: self.iterations,
            status: self.status,
        }
    }

    /// The same motion on halved knots.
    pub(crate) fn halved(self) -> Self {
        let dwells = self.dwells.iter().map(|(first, number)| (2 * first, 2 * number - 3)).collect();
        Self { knots: self.knots.halved(), controls: halved(&self.controls), dwells, ..self }
    }
}

/// How one level is searched.
#[derive(Debug, Clone)]
pub(crate) struct Level {
    /// Quadrature points in an interval.
    pub(crate) points: usize,
    /// Times in an interval at which limits are taken.
    pub(crate) times: usize,
    pub(crate) steps: Steps,
    pub(crate) kind: Kind,
    pub(crate) held_back: HeldBack,
}

/// What all runs share.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    pub(crate) problem: &'a TrajectoryProblem<'a>,
    pub(crate) sensing: &'a Sensing,
    pub(crate) sizes: &'a [f64],
}

impl<'a> Shared<'a> {
    pub(crate) fn pointwise(&self, held_back: HeldBack) -> Pointwise<'a> {
        let clearance = self.problem.clearance_m + held_back.clearance_m;
        Pointwise::new(self.problem, self.sensing.links.clone(), clearance, 1.0 - held_back.share)
    }

    pub(crate) fn ties(&self, candidate: &Candidate) -> Ties {
        Ties::new(candidate.knots.controls(), self.problem.home.as_deref(), self.sizes, &candidate.dwells)
    }

    /// With the value at the full information: by it candidates are compared.
    pub(crate) fn with_full_value(&self, candidate: Candidate, points: usize) -> Candidate {
        let mut full = Objective::new(self.problem, self.sensing, Kind::Full, candidate.knots, points);
        Candidate { value: full.value(&candidate.controls), ..candidate }
    }

    /// Improves a motion on its knots.
    pub(crate) fn improve(&self, candidate: Candidate, level: &Level) -> Candidate {
        let (problem, knots) = (self.problem, candidate.knots);
        let ties = self.ties(&candidate);
        let mut objective = Objective::new(problem, self.sensing, level.kind, knots, level.points);
        let mut rows = Rows::new(self.pointwise(level.held_back), knots, level.times, &ties);
        let linear = Linear::new(&problem.joints, &knots, &ties);
        let mut run =
            InteriorPoint { objective: &mut objective, rows: &mut rows, linear: &linear, ties: &ties };
        let Reached { x, value, iterations, status, relax } =
            run.run(ties.unknowns_of(&candidate.controls), &level.steps);
        Candidate {
            controls: ties.controls_of(&x),
            value,
            iterations: candidate.iterations + iterations,
            status,
            admissible: relax == 0.0 && value.is_finite(),
            ..candidate
        }
    }
}

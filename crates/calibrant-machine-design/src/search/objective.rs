//! What the interior point minimises: a criterion at the plain or the full information.

use crate::TrajectoryProblem;
use crate::information::{FullInformation, Marginalised, PlainInformation, Sensing, Valued};
use crate::motion::Knots;
use nalgebra::DMatrix;

/// The information that is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nuisances are known.
    Plain,
    /// Nuisances are marginalised under their priors.
    Full,
}

/// The criterion as a function of the motion.
pub(crate) enum Objective<'a> {
    Plain(PlainInformation<'a>, Option<Valued>),
    Full(Box<FullInformation<'a>>, Option<Marginalised>),
}

impl<'a> Objective<'a> {
    pub(crate) fn new(
        problem: &TrajectoryProblem<'a>,
        sensing: &'a Sensing,
        kind: Kind,
        knots: Knots,
        points: usize,
    ) -> Self {
        match kind {
            Kind::Plain => Self::Plain(PlainInformation::new(sensing, knots, points), None),
            Kind::Full => {
                Self::Full(Box::new(FullInformation::new(sensing, problem.chain, knots, points)), None)
            }
        }
    }

    /// Its value; infinite where the motion does not determine the parameters.
    pub(crate) fn value(&mut self, controls: &DMatrix<f64>) -> f64 {
        match self {
            Self::Plain(information, at) => {
                *at = information.at(controls);
                at.as_ref().map_or(f64::INFINITY, |at| at.value)
            }
            Self::Full(information, at) => {
                *at = information.at(controls);
                at.as_ref().map_or(f64::INFINITY, |at| at.valued.value)
            }
        }
    }

    /// Its derivative by the control points, at the motion of the last value.
    pub(crate) fn gradient(&mut self) -> Option<DMatrix<f64>> {
        match self {
            Self::Plain(information, at) => at.as_ref().map(|at| information.gradient(at)),
            Self::Full(information, at) => at.as_ref().map(|at| information.gradient(at)),
        }
    }
}

//! The files of poses: `design.json` of the best ones, and `evaluation.json` of the holds of a recording.

use super::heading::{Heading, JsonFile};
use super::reach::Reached;
use calibrant_core::form::rows;
use calibrant_core::json::{flat, if_some};
use calibrant_core::json_object;
use calibrant_core::sensor::{Quantity, ReadingUnit};
use calibrant_design::poses::{PoseBound, PoseDesign, PoseEvaluation, PoseProblem};
use nalgebra::{DMatrix, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

/// The content of the `design.json` of poses.
#[derive(Debug, Clone, Copy)]
pub struct PoseDesignFile<'a> {
    /// The poses.
    pub design: &'a PoseDesign,
    /// The goals that they reach.
    pub reached: Option<&'a Reached>,
    /// What they are for.
    pub problem: &'a PoseProblem,
    /// Unit of the readings.
    pub unit: ReadingUnit,
}

/// The content of the `evaluation.json` of holds.
#[derive(Debug, Clone, Copy)]
pub struct PoseEvaluationFile<'a> {
    /// How good they are.
    pub evaluation: &'a PoseEvaluation,
    /// The direction that was up in each hold, in the sensor's axes.
    pub directions: &'a [Vector3<f64>],
    /// What they were for.
    pub problem: &'a PoseProblem,
    /// Unit of the readings.
    pub unit: ReadingUnit,
}

json_object! {
    /// The best poses for a static calibration, with everything that is needed to take and to judge them.
    PoseDesignFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// How the search ended.
        status: if file.design.interrupted { "interrupted" } else { "converged" },
        poses: flat(file.poses()),
        /// What the poses give.
        optimal: file.poses().value(),
        /// From 0 to 1: at least this share of the best possible.
        efficiency: file.design.efficiency(&file.problem.criterion),
        /// Poses that an engineer would take without a design, where they are allowed.
        usual: &file.design.usual,
        /// Number of starts of the search.
        starts: file.design.starts,
        /// Starts that ended within 0.1 % of the best.
        starts_at_best: file.design.starts_at_best,
        reach: if_some(file.reached),
    }
}

impl JsonFile for PoseDesignFile<'_> {
    const KIND: &'static str = "poses";
}

json_object! {
    /// The holds of a recording, beside the best poses.
    PoseEvaluationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        poses: flat(file.poses()),
        /// What the holds give.
        evaluation: file.poses().value(),
        /// From 0 to 1: at least this share of the best possible.
        efficiency: file.evaluation.efficiency,
    }
}

impl JsonFile for PoseEvaluationFile<'_> {
    const KIND: &'static str = "poses-evaluation";
}

/// What both files say of poses.
#[derive(Clone, Copy)]
struct Poses<'a> {
    directions: &'a [Vector3<f64>],
    covariance: &'a DMatrix<f64>,
    value: f64,
    bound: &'a PoseBound,
    problem: &'a PoseProblem,
    unit: ReadingUnit,
}

json_object! {
    Poses<'_> as of {
        criterion: &of.problem.criterion,
        /// What the poses determine: the order of all lists of parameters.
        parameters: of.parameters(),
        /// Number of poses.
        count: of.directions.len(),
        /// The direction that is up in each pose, in the sensor's axes, in the order to take.
        poses: of.directions.iter().map(|up| <[f64; 3]>::from(*up)).collect::<Vec<_>>(),
        certificate: PoseCertificate {
            bound: of.bound,
            gap: of.problem.criterion.gap(of.value, of.bound.value),
        },
        setting: of.problem,
    }
}

/// The value of poses.
struct PoseValue<'a>(Poses<'a>);

json_object! {
    PoseValue<'_> as of {
        /// Value of the criterion of the holds alone.
        value: of.0.value,
        /// Standard deviation that a calibration from the poses will state of each parameter.
        sd: of.0.covariance.diagonal().iter().map(|variance| variance.sqrt()).collect::<Vec<f64>>(),
        /// Entry (i, j) in the unit of parameter i times that of parameter j.
        covariance: rows(of.0.covariance),
    }
}

/// The bound that no set of as many poses can beat.
struct PoseCertificate<'a> {
    bound: &'a PoseBound,
    gap: f64,
}

json_object! {
    PoseCertificate<'_> as of {
        bound: flat(of.bound),
        /// How far the poses are from the bound: relative, for criterion D in nats.
        gap: of.gap,
    }
}

/// A parameter, and the value at which the information is taken.
#[derive(Serialize, JsonSchema)]
struct PoseParameter {
    /// Which parameter it is.
    name: String,
    /// Its unit.
    unit: &'static str,
    /// The value at which the information is taken.
    nominal: f64,
}

impl PoseDesignFile<'_> {
    fn poses(&self) -> Poses<'_> {
        let PoseDesign { directions, covariance, value, bound, .. } = self.design;
        Poses { directions, covariance, value: *value, bound, problem: self.problem, unit: self.unit }
    }
}

impl PoseEvaluationFile<'_> {
    fn poses(&self) -> Poses<'_> {
        let PoseEvaluation { covariance, value, bound, .. } = self.evaluation;
        let Self { directions, problem, unit, .. } = *self;
        Poses { directions, covariance, value: *value, bound, problem, unit }
    }
}

impl<'a> Poses<'a> {
    fn value(self) -> PoseValue<'a> {
        PoseValue(self)
    }

    fn parameters(&self) -> Vec<PoseParameter> {
        let described = |quantity: &Quantity| PoseParameter {
            name: quantity.name(),
            unit: quantity.unit(self.unit),
            nominal: quantity.value(&self.problem.at),
        };
        self.problem.list.quantities().iter().map(described).collect()
    }
}

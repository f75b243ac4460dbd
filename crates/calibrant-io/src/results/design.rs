//! The files of a design: `design.json`, `evaluation.json` and `sweep.json`. Each has what was found, and what is needed to repeat it.

use super::heading::{Heading, JsonFile};
use super::reach::Reached;
use calibrant_core::form::{per_axis, rows};
use calibrant_core::json::{flat, if_some, with_ending};
use calibrant_core::json_object;
use calibrant_design::{Assessment, Design, DesignProblem, DesignSettings, Sweep};

/// The content of `design.json`.
///
/// Arrays over axes have 1 or 3 entries. Entry (i, j) of a covariance is in the unit of parameter i times that of parameter j.
#[derive(Debug, Clone, Copy)]
pub struct DesignFile<'a> {
    /// The design.
    pub design: &'a Design,
    /// The goals that it reaches.
    pub reached: Option<&'a Reached>,
    /// What it is for.
    pub setting: DesignSetting<'a>,
}

/// The content of `evaluation.json`: a motion of the user's own, beside the best one and the limits.
#[derive(Debug, Clone, Copy)]
pub struct EvaluationFile<'a> {
    /// The motion.
    pub assessment: &'a Assessment,
    /// What the best one is for.
    pub setting: DesignSetting<'a>,
}

/// The content of `sweep.json`: the best designs over the values of one variable.
#[derive(Debug, Clone, Copy)]
pub struct SweepFile<'a> {
    /// The designs.
    pub sweep: &'a Sweep,
    /// What they are for.
    pub setting: DesignSetting<'a>,
}

/// The conditions of the experiment that is designed for, and how the search was done.
#[derive(Debug, Clone, Copy)]
pub struct DesignSetting<'a> {
    /// The problem.
    pub problem: &'a DesignProblem<'a>,
    /// The settings of the search.
    pub settings: &'a DesignSettings,
}

json_object! {
    /// The best motion for a calibration, with everything that is needed to repeat it, to judge it and to drive the arm.
    DesignFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        design: flat(file.design),
        reach: if_some(file.reached),
        setting: file.setting,
    }
}

impl JsonFile for DesignFile<'_> {
    const KIND: &'static str = "design";
}

json_object! {
    /// A motion of the user's own, beside the best one and the limits.
    EvaluationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        assessment: flat(file.assessment),
        setting: file.setting,
    }
}

impl JsonFile for EvaluationFile<'_> {
    const KIND: &'static str = "evaluation";
}

json_object! {
    /// The best motions over the values of one variable.
    SweepFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        sweep: flat(file.sweep),
        setting: file.setting,
    }
}

impl JsonFile for SweepFile<'_> {
    const KIND: &'static str = "sweep";
}

json_object! {
    /// The conditions of the experiment that was designed for, and how the search was done.
    DesignSetting<'_> as of {
        /// Number of axes of the sensor.
        axes: of.problem.sensor.axes,
        model: of.problem.sensor.model,
        /// Unit of its readings.
        reading_unit: of.problem.sensor.unit.symbol(),
        /// Of one sample.
        noise: with_ending(of.problem.sensor.unit.suffix(), of.noise()),
        /// Number of intervals of the motion.
        intervals: of.problem.intervals,
        interval_s: of.problem.interval_s,
        rate_hz: of.problem.rate_hz,
        /// How far the motion will be trusted.
        trust: of.problem.trust,
        known_ends: of.problem.known_ends,
        input_noise: if_some(of.problem.trust.input_noise()),
        gravity: if_some(of.problem.gravity),
        /// The parameters at which the information is taken.
        guess: of.guess(),
        /// What was known before, in the order of the parameters.
        prior_information: of.problem.prior.as_ref().map(rows),
        /// Largest number of starts for each axis.
        starts: of.settings.starts,
        /// Seed of the random starts and of the initial motion.
        seed: of.settings.seed,
        /// Was a bound asked for?
        certificate: of.settings.certificate,
        /// Limit of the iterations of one start.
        max_iterations: of.settings.max_iterations,
    }
}

impl DesignSetting<'_> {
    fn noise(&self) -> Option<Vec<f64>> {
        let sensor = self.problem.sensor;
        let noise = sensor.noise(&self.problem.at.matrix.diagonal().abs());
        noise.map(|noise| per_axis(&noise, sensor.axes))
    }

    fn guess(&self) -> Vec<f64> {
        let list = self.problem.sensor.parameter_list();
        list.quantities().iter().map(|quantity| quantity.value(&self.problem.at)).collect()
    }
}

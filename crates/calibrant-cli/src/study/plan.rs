//! The studies that the experiment file and the options describe.

use crate::interruption;
use crate::simulate::commanded_motion;
use calibrant::design::limit_use;
use calibrant::estimate::CalibrationSettings;
use calibrant::io::{Experiment, MotionPlan, Prior};
use calibrant::motion::{CommandedMotion, JerkControlledMotion, Limits, Trust};
use calibrant::sensor::SensorParameters;
use calibrant::study::{DesignStudyProblem, StudiesProblem, StudyProblem, StudySettings};
use std::path::Path;

/// The options of the command line that replace values of the file.
pub(super) struct Choice<'a> {
    pub(super) motion: Option<&'a Path>,
    pub(super) sensors: Option<usize>,
    pub(super) seed: u64,
    pub(super) starts: Option<usize>,
}

/// The inputs of the studies.
pub(super) struct Material<'a> {
    experiment: &'a Experiment,
    plan: &'a MotionPlan,
    sensors: Option<usize>,
    /// The given motion.
    given: Option<JerkControlledMotion>,
    /// The command of the calibration without a design, its rate and the number of sensors.
    calibration: Option<(CommandedMotion, f64, usize)>,
    /// Initial against optimal motion.
    designs: [Option<DesignStudyProblem<'a>>; 2],
    remarks: Vec<String>,
}

impl<'a> Material<'a> {
    pub(super) fn new(
        experiment: &'a Experiment,
        plan: &'a MotionPlan,
        choice: &Choice<'_>,
    ) -> calibrant::Result<Self> {
        let mut material = Self {
            experiment,
            plan,
            sensors: choice.sensors,
            given: None,
            calibration: None,
            designs: [None, None],
            remarks: Vec::new(),
        };
        let axes = experiment.sensor.axes;
        material.given = choice.motion.map(|path| calibrant::io::read_motion(path, axes)).transpose()?;
        if let Some(motion) = &material.given {
            material.remarks.extend(beyond_limits(experiment, motion));
        }
        let study = &experiment.study;
        let design = material.design_study(plan.trust, &experiment.limits)?;
        let obstacle = design.obstacle();
        if let Some(unknown) = &study.unknown {
            let limits = unknown.limits.as_ref().unwrap_or(&experiment.limits);
            let motion = commanded_motion(None, &unknown.plan, axes, limits, choice.seed, 1)?;
            material.calibration = Some(calibration(&unknown.plan, motion, unknown.sensors));
        } else if obstacle.is_some() {
            let motion = commanded_motion(choice.motion, plan, axes, &experiment.limits, choice.seed, 1)?;
            material.calibration = Some(calibration(plan, motion, study.sensors));
        }
        match obstacle {
            None => material.designs[0] = Some(design),
            Some(reason) => material.remarks.push(format!("no motion was designed: {reason}")),
        }
        if let Some(noisy) = &study.noisy {
            let limits = noisy.limits.as_ref().unwrap_or(&experiment.limits);
            let design = material.design_study(Trust::Noisy(noisy.noise), limits)?;
            match design.obstacle() {
                None => material.designs[1] = Some(design),
                Some(reason) => {
                    let remark =
                        format!("no motion with process noise ([study.noisy]) was designed: {reason}");
                    material.remarks.push(remark);
                }
            }
        }
        Ok(material)
    }

    fn design_study(&self, trust: Trust, limits: &Limits) -> calibrant::Result<DesignStudyProblem<'a>> {
        let (experiment, plan) = (self.experiment, self.plan);
        let nominal = experiment.sensor.nominal().unwrap_or_else(SensorParameters::identity);
        Ok(DesignStudyProblem {
            sensor: &experiment.sensor,
            intervals: plan.intervals,
            interval_s: plan.interval_s,
            rate_hz: plan.rate_hz,
            trust,
            known_ends: plan.known_ends,
            gravity: plan.gravity,
            limits: limits.clone(),
            criterion: experiment.criterion(&experiment.sensor.parameter_list(), &nominal)?,
            initial: None,
            sensors: self.sensors.unwrap_or(experiment.study.sensors),
            motions_shown: experiment.study.motions,
        })
    }

    /// The studies as one problem.
    pub(super) fn problem(&self) -> StudiesProblem<'_> {
        let sensor = &self.experiment.sensor;
        let [design, noisy] = self.designs.clone();
        StudiesProblem {
            calibration: self.calibration.as_ref().map(|(command, rate_hz, sensors)| StudyProblem {
                sensor,
                command,
                rate_hz: *rate_hz,
                sensors: self.sensors.unwrap_or(*sensors),
            }),
            surface: self.experiment.study.surface.map(|surface| (sensor, surface)),
            design: design.map(|design| DesignStudyProblem { initial: self.given.as_ref(), ..design }),
            noisy,
            remarks: self.remarks.clone(),
        }
    }
}

/// Warns if the given motion breaks limits. The best motion keeps them, which makes the comparison unfair.
fn beyond_limits(experiment: &Experiment, motion: &JerkControlledMotion) -> Option<String> {
    let limits = experiment.limits.within_range(experiment.sensor.range_mps2);
    let broken: Vec<String> = limit_use(&limits, experiment.sensor.axes, motion)
        .iter()
        .filter(|found| found.is_violated())
        .map(|found| format!("{} of axis {}", found.kind.name(), found.axis))
        .collect();
    (!broken.is_empty())
        .then(|| format!("the given motion breaks limits that the optimal one keeps: {}", broken.join(", ")))
}

fn calibration(
    plan: &MotionPlan,
    motion: JerkControlledMotion,
    sensors: usize,
) -> (CommandedMotion, f64, usize) {
    (plan.command(motion), plan.rate_hz, sensors)
}

/// The settings of the studies.
pub(super) fn settings(experiment: &Experiment, choice: &Choice<'_>) -> StudySettings {
    let mut design = experiment.design_settings();
    design.interruption = interruption::keeping_the_best();
    design.starts = choice.starts.or(experiment.study.starts).unwrap_or(design.starts);
    StudySettings {
        seed: choice.seed,
        calibration: CalibrationSettings {
            datasheet_prior: experiment.calibrate.prior == Prior::Datasheet,
            ..CalibrationSettings::default()
        },
        design,
        detail_rate_hz: experiment.study.unknown.as_ref().and_then(|unknown| unknown.detail_rate_hz),
    }
}

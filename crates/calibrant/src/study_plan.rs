//! The studies that an experiment describes.

use crate::session::MotionSource;
use crate::simulation::commanded_motion;
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::design::{GivenBreaksLimits, MotionNotDesigned};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::CalibrationSettings;
use calibrant_core::interruption::Interruption;
use calibrant_core::motion::{CommandedMotion, JerkControlledMotion, Limits, Trust};
use calibrant_core::sensor::SensorParameters;
use calibrant_design::{SurfaceSettings, limit_use};
use calibrant_io::{Experiment, MotionPlan, Plan, Prior};
use calibrant_study::{
    DesignStudyProblem, Studies, StudiesProblem, StudyProblem, StudySettings, run_studies,
};

/// What is chosen of the studies in place of what the experiment says.
#[derive(Debug, Clone, Default)]
pub struct StudyChoice {
    /// The initial motion of every sensor; `None`: a random one for each.
    pub motion: Option<MotionSource>,
    /// Number of sensors of every study.
    pub sensors: Option<usize>,
    /// Seed of all random numbers.
    pub seed: Option<u64>,
    /// Starts of each sensor's design.
    pub starts: Option<usize>,
    /// What the studies may take.
    pub budget: Budget,
    /// Ends the studies; those sensors remain that are finished.
    pub interruption: Interruption,
}

/// The studies that an experiment describes, ready to run.
///
/// # Examples
/// ```no_run
/// use calibrant::io::{Experiment, preset};
/// use calibrant::{StudyChoice, StudyPlan};
///
/// let experiment = Experiment::parse(preset("report").expect("built in"), None)?;
/// let choice = StudyChoice { sensors: Some(100), ..StudyChoice::default() };
/// let studies = StudyPlan::new(&experiment, &choice)?.run(&|_| {})?;
/// println!("{} sensors", studies.calibration.map_or(0, |study| study.outcomes.len()));
/// # Ok::<(), calibrant::Error>(())
/// ```
pub struct StudyPlan<'a> {
    choice: &'a StudyChoice,
    seed: u64,
    experiment: &'a Experiment,
    plan: &'a MotionPlan,
    sensors: Option<usize>,
    /// The criterion over the jerks of two intervals.
    surface: Option<SurfaceSettings>,
    /// The given motion.
    given: Option<JerkControlledMotion>,
    /// The command of the calibration without a design, its rate and the number of sensors.
    calibration: Option<(CommandedMotion, f64, usize)>,
    /// Initial against optimal motion.
    designs: [Option<DesignStudyProblem<'a>>; 2],
    notes: Vec<Diagnostic>,
}

impl<'a> StudyPlan<'a> {
    /// The studies of a `[motion]` experiment.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the experiment has no `[motion]`, or no nominal gain; where a motion makes no sense; or where the work is beyond the budget.
    pub fn new(experiment: &'a Experiment, choice: &'a StudyChoice) -> Result<Self> {
        let Plan::Motion(plan) = &experiment.plan else {
            return Err(Error::experiment(InputError::new(
                Refusal::ExperimentUnsuited,
                format!("a study needs a [motion] experiment, this one has {}", experiment.plan.section()),
                "see `calibrant init report-unknown`; a static recording can be made with `calibrant simulate`",
            )));
        };
        if experiment.sensor.gain.is_none() {
            let message = "a study needs `gain_counts_per_mps2`";
            let input_error = InputError::new(Refusal::KeyMissing, message, "add it to the experiment file");
            return Err(Error::experiment(input_error.about_key("sensor.gain_counts_per_mps2")));
        }
        let plan = Self::of_motion(experiment, plan, choice)?;
        let what = format!("this study of {} sensors", plan.steps());
        let work = plan.problem().work(&plan.settings());
        choice
            .budget
            .check(work, &what, "take fewer sensors, starts, intervals or samples")
            .map_err(Error::Experiment)?;
        Ok(plan)
    }

    /// Number of sensors of all studies together.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.problem().steps()
    }

    /// Runs the studies; `progress` is told of each sensor.
    ///
    /// # Errors
    /// As [`run_studies`].
    pub fn run(&self, progress: &(dyn Fn(u64) + Sync)) -> Result<Studies> {
        run_studies(&self.problem(), &self.settings(), progress)
    }

    fn of_motion(experiment: &'a Experiment, plan: &'a MotionPlan, choice: &'a StudyChoice) -> Result<Self> {
        let mut material = Self {
            choice,
            seed: choice.seed.unwrap_or(experiment.study.seed),
            experiment,
            plan,
            sensors: choice.sensors,
            surface: experiment.study.surface(plan)?,
            given: None,
            calibration: None,
            designs: [None, None],
            notes: Vec::new(),
        };
        let axes = experiment.sensor.axes;
        material.given = choice.motion.as_ref().map(|motion| motion.commanded(axes)).transpose()?;
        if let Some(motion) = &material.given {
            material.notes.extend(beyond_limits(experiment, motion));
        }
        let study = &experiment.study;
        let design = material.design_study(plan.trust, &experiment.limits)?;
        let obstacle = design.obstacle();
        if let Some(unknown) = study.unknown(plan, axes)? {
            let limits = unknown.limits.as_ref().unwrap_or(&experiment.limits);
            let motion = commanded_motion(None, &unknown.plan, axes, limits, material.seed, 1)?;
            material.calibration = Some(calibration(&unknown.plan, motion, unknown.sensors));
        } else if obstacle.is_some() {
            let motion = {
                let given = choice.motion.as_ref();
                commanded_motion(given, plan, axes, &experiment.limits, material.seed, 1)?
            };
            material.calibration = Some(calibration(plan, motion, study.sensors));
        }
        match obstacle {
            None => material.designs[0] = Some(design),
            Some(reason) => material.not_designed(false, reason),
        }
        if let Some(noisy) = study.noisy(plan, axes)? {
            let limits = noisy.limits.as_ref().unwrap_or(&experiment.limits);
            let design = material.design_study(Trust::Noisy(noisy.noise), limits)?;
            match design.obstacle() {
                None => material.designs[1] = Some(design),
                Some(reason) => material.not_designed(true, reason),
            }
        }
        Ok(material)
    }

    fn not_designed(&mut self, is_noisy: bool, reason: String) {
        self.notes.push(MotionNotDesigned { is_noisy, why: Phrase(reason) }.into());
    }

    fn design_study(&self, trust: Trust, limits: &Limits) -> Result<DesignStudyProblem<'a>> {
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
            clock: plan.clock,
            limits: limits.clone(),
            criterion: experiment.criterion(&experiment.sensor.parameter_list(), &nominal)?,
            initial: None,
            sensors: self.sensors.unwrap_or(experiment.study.sensors),
            motions_shown: experiment.study.motions,
        })
    }

    /// The studies as one problem.
    fn problem(&self) -> StudiesProblem<'_> {
        let sensor = &self.experiment.sensor;
        let [design, noisy] = self.designs.clone();
        StudiesProblem {
            calibration: self.calibration.as_ref().map(|(command, rate_hz, sensors)| StudyProblem {
                sensor,
                command,
                rate_hz: *rate_hz,
                sensors: self.sensors.unwrap_or(*sensors),
            }),
            surface: self.surface.map(|surface| (sensor, surface)),
            design: design.map(|design| DesignStudyProblem { initial: self.given.as_ref(), ..design }),
            noisy,
            notes: self.notes.clone(),
        }
    }

    /// The settings of the studies.
    fn settings(&self) -> StudySettings {
        let (experiment, choice) = (self.experiment, self.choice);
        let mut design = experiment.design_settings();
        let study = &experiment.study;
        design.interruption = choice.interruption.clone();
        design.starts = choice.starts.or(study.starts.map(|starts| starts.size())).unwrap_or(design.starts);
        StudySettings {
            seed: self.seed,
            calibration: CalibrationSettings {
                datasheet_prior: experiment.calibrate.prior == Prior::Datasheet,
                ..CalibrationSettings::default()
            },
            design,
            detail_rate_hz: study.unknown.as_ref().and_then(|unknown| unknown.detail_rate_hz).map(f64::from),
        }
    }
}

/// A note if the given motion breaks limits. The best motion keeps them, which makes the comparison unfair.
fn beyond_limits(experiment: &Experiment, motion: &JerkControlledMotion) -> Option<Diagnostic> {
    let limits = experiment.limits.within_range(experiment.sensor.range_mps2);
    let limits_broken: Vec<String> = limit_use(&limits, experiment.sensor.axes, motion)
        .iter()
        .filter(|found| found.is_violated())
        .map(|found| format!("{} of axis {}", found.kind.name(), found.axis))
        .collect();
    (!limits_broken.is_empty()).then(|| GivenBreaksLimits { limits: limits_broken }.into())
}

fn calibration(
    plan: &MotionPlan,
    motion: JerkControlledMotion,
    sensors: usize,
) -> (CommandedMotion, f64, usize) {
    (plan.command(motion), plan.rate_hz, sensors)
}

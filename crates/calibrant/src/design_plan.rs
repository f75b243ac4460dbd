//! The designs that an experiment describes: of a motion, or of poses.

use crate::session::{Session, SessionOptions, Source};
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::design::{CalibrationsApart, CalibrationsEqual};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::interruption::Interruption;
use calibrant_core::number_format::counted;
use calibrant_design::poses::{
    FewestPoses, PoseDesign, PoseEvaluation, PoseProblem, design_poses, evaluate_poses, fewest_poses,
};
use calibrant_design::{
    Design, DesignProblem, DesignSettings, Goal, ShortestMotion, Sweep, SweepVariable, design,
    shortest_motion, sweep, sweep_work,
};
use calibrant_io::{CriterionLetter, EarlierCalibration, Experiment};
use nalgebra::Vector3;

/// What is chosen of a design in place of what the experiment says.
#[derive(Debug, Clone, Default)]
pub struct DesignChoice {
    /// The criterion to minimise.
    pub criterion: Option<CriterionLetter>,
    /// Number of starts of the search.
    pub starts: Option<usize>,
    /// Time to search, s, in place of a number of starts.
    pub seconds: Option<f64>,
    /// Seed of the random starts.
    pub seed: Option<u64>,
    /// Is the bound that no motion can beat left out?
    pub without_certificate: bool,
    /// The gap to the bound at which the search ends.
    pub gap: Option<f64>,
    /// What the search may take.
    pub budget: Budget,
    /// Ends the search with the best so far.
    pub interruption: Interruption,
}

/// The design that an experiment describes, with what is known of the sensor before.
///
/// # Examples
/// ```no_run
/// use calibrant::io::{Experiment, preset};
/// use calibrant::report::{About, design_sheet};
/// use calibrant::{DesignChoice, DesignPlan};
///
/// let stage = Experiment::parse(preset("stage").expect("built in"), None)?;
/// let plan = DesignPlan::new(stage, Vec::new(), &DesignChoice { gap: Some(0.01), ..DesignChoice::default() })?;
/// let best = plan.design(&plan.problem()?, &|_| {})?;
/// println!("{}", design_sheet(&best, &About::default()).text(80));
/// # Ok::<(), calibrant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct DesignPlan {
    /// The experiment, with the criterion that was chosen.
    pub experiment: Experiment,
    /// Earlier calibrations of the sensor: their information adds up, and the last gives the estimate.
    pub earlier: Vec<EarlierCalibration>,
    /// How the search goes.
    pub settings: DesignSettings,
    /// What was noticed of the earlier calibrations, and what is assumed.
    pub notes: Vec<Diagnostic>,
    budget: Budget,
}

/// The holds of a recording beside the best ones.
#[derive(Debug, Clone)]
pub struct RecordedPoses {
    /// What the best poses would be of.
    pub problem: PoseProblem,
    /// The directions of the recorded holds.
    pub directions: Vec<Vector3<f64>>,
    /// How efficient they are.
    pub evaluation: PoseEvaluation,
    /// What was noticed in the recording.
    pub notes: Vec<Diagnostic>,
}

impl DesignPlan {
    /// The design of an experiment.
    ///
    /// # Errors
    /// [`Error::Experiment`] where a gap is asked for, and the experiment wants no bound.
    pub fn new(
        mut experiment: Experiment,
        earlier: Vec<EarlierCalibration>,
        choice: &DesignChoice,
    ) -> Result<Self> {
        if let Some(letter) = choice.criterion {
            experiment.design.criterion = letter;
        }
        let otherwise = experiment.design_settings();
        let settings = DesignSettings {
            starts: choice.starts.unwrap_or(otherwise.starts),
            seconds: choice.seconds,
            seed: choice.seed.unwrap_or(otherwise.seed),
            certificate: otherwise.certificate && !choice.without_certificate,
            gap: choice.gap,
            interruption: choice.interruption.clone(),
            ..otherwise
        };
        if settings.gap.is_some() && !settings.certificate {
            let message = "option `gap` asks for a proof, and the experiment wants no bound";
            let help = "set certificate = true in [design], or leave option `gap` away";
            return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
        }
        let mut notes = strangers(&earlier);
        notes.extend(experiment.assumed_noise(&earlier));
        Ok(Self { experiment, earlier, settings, notes, budget: choice.budget })
    }

    /// The motion to find.
    ///
    /// # Errors
    /// As [`Experiment::design_problem`].
    pub fn problem(&self) -> Result<DesignProblem<'_>> {
        self.experiment.design_problem(&self.earlier)
    }

    /// The poses to find: so many, or as many as the experiment says.
    ///
    /// # Errors
    /// As [`Experiment::pose_problem`].
    pub fn pose_problem(&self, poses: Option<usize>) -> Result<PoseProblem> {
        self.experiment.pose_problem(&self.earlier, poses)
    }

    /// Checks that a search fits into the budget.
    ///
    /// # Errors
    /// [`Error::Experiment`] with the amount, where it does not.
    pub fn check_work(&self, problem: &DesignProblem<'_>) -> Result<()> {
        let what = format!("{} starts of {} intervals", self.settings.starts, problem.intervals);
        let work = self.settings.work(problem);
        self.budget.check(work, &what, "take fewer starts or intervals").map_err(Error::Experiment)
    }

    /// Finds the best motion; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`design`], and where the work is beyond the budget.
    pub fn design(&self, problem: &DesignProblem<'_>, progress: &(dyn Fn(u64) + Sync)) -> Result<Design> {
        self.check_work(problem)?;
        design(problem, &self.settings, progress)
    }

    /// Finds the shortest motion that reaches the goals; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`shortest_motion`], and where the work is beyond the budget.
    pub fn shortest_motion(
        &self,
        problem: &DesignProblem<'_>,
        goals: &[Goal],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<ShortestMotion> {
        let what = format!("a search among motions of up to 16 times {} intervals", problem.intervals);
        let work = self.settings.work_on_shortest(problem);
        self.budget.check(work, &what, "take fewer starts or intervals").map_err(Error::Experiment)?;
        shortest_motion(problem, goals, &self.settings, progress)
    }

    /// Finds the best motion for each value of a quantity; `progress` is told how many values are done. Where it is interrupted, it has those that are finished.
    ///
    /// # Errors
    /// As [`sweep`], and where the work is beyond the budget.
    pub fn sweep(
        &self,
        problem: &DesignProblem<'_>,
        variable: SweepVariable,
        values: &[f64],
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Sweep> {
        let work = sweep_work(problem, &self.settings, variable, values)?;
        let what = counted(values.len(), "value") + " of the sweep";
        let less = "sweep less far, or take fewer starts";
        self.budget.check(work, &what, less).map_err(Error::Experiment)?;
        sweep(problem, &self.settings, variable, values, &|number, _| progress(number))
    }

    /// Finds the best poses; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`design_poses`], and where the work is beyond the budget.
    pub fn design_poses(&self, problem: &PoseProblem, progress: &(dyn Fn(u64) + Sync)) -> Result<PoseDesign> {
        let what = format!("{} starts of {} poses", self.settings.starts, problem.poses);
        self.check_poses(self.settings.work_on_poses(problem), &what)?;
        design_poses(problem, &self.settings, progress)
    }

    /// Finds the fewest poses that reach the goals; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`fewest_poses`], and where the work is beyond the budget.
    pub fn fewest_poses(
        &self,
        problem: &PoseProblem,
        goals: &[Goal],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<FewestPoses> {
        let work = self.settings.work_on_fewest_poses(problem);
        self.check_poses(work, "a search for the fewest poses")?;
        fewest_poses(problem, goals, &self.settings, progress)
    }

    fn check_poses(&self, work: Budget, what: &str) -> Result<()> {
        let less = "take fewer starts, poses or allowed directions";
        self.budget.check(work, what, less).map_err(Error::Experiment)
    }

    /// Compares the holds of a recording with the best poses. `options`: how the recording is read and named.
    ///
    /// # Errors
    /// As [`Session::calibrate`]. [`Error::Experiment`] where earlier calibrations are given, or on a machine.
    pub fn evaluate_recorded(&self, source: &Source, options: SessionOptions) -> Result<RecordedPoses> {
        let unsuited = |message: &str, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)))
        };
        if !self.earlier.is_empty() {
            return unsuited(
                "option `from` is not used: the holds of a recording are compared with the best by themselves",
                "leave it away, or design the next poses with option `from` and option `add`",
            );
        }
        let outcome = Session::with(self.experiment.clone(), options)?.calibrate(source)?;
        if outcome.calibrated.machine().is_some() {
            return unsuited(
                "the holds of a machine are not compared with the best",
                "see `calibrant init static-poses`",
            );
        }
        let (problem, directions) = self.experiment.recorded_poses(outcome.calibration())?;
        let evaluation = evaluate_poses(&problem, &directions, self.settings.seed)?;
        Ok(RecordedPoses { problem, directions, evaluation, notes: outcome.notes })
    }
}

/// Warns about earlier calibrations of different sensors, or the same calibration twice. Their information adds up.
fn strangers(earlier: &[EarlierCalibration]) -> Vec<Diagnostic> {
    let mut notes = Vec::new();
    let name = |calibration: &EarlierCalibration| {
        Phrase(calibration.file.as_ref().map_or_else(String::new, |file| file.display().to_string()))
    };
    for (number, calibration) in earlier.iter().enumerate() {
        let same = |other: &&EarlierCalibration| {
            other.values == calibration.values && other.covariance == calibration.covariance
        };
        if let Some(other) = earlier[..number].iter().find(same) {
            notes.push(CalibrationsEqual { one: name(other), other: name(calibration) }.into());
        }
    }
    let Some((last, others)) = earlier.split_last() else { return notes };
    for other in others {
        let parameters = last.values.len();
        let degrees_of_freedom = parameters as f64;
        // significant: mean and variance of χ² are k and 2k
        let most = degrees_of_freedom + 6.0 * (2.0 * degrees_of_freedom).sqrt();
        if let Some(chi2) = last.chi2_against(other).filter(|chi2| *chi2 > most) {
            notes.push(CalibrationsApart { one: name(other), other: name(last), chi2, parameters }.into());
        }
    }
    notes
}

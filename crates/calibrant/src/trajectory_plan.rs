//! The trajectory of a machine that an experiment describes.

use crate::design_plan::DesignChoice;
use crate::design_remarks::search_ended;
use crate::session::MotionSource;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::design::{CollisionsUnknown, LinksWithoutShapes};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::progress::Progress;
use calibrant_core::sensor::{ImuQuantity, ReadingUnit, SensorKind};
use calibrant_core::simulate::MATRIX_SD;
use calibrant_design::{DesignStatus, SweepVariable};
use calibrant_io::{
    CriterionLetter, EarlierMachine, Experiment, LinksKnown, MachineDesignPlan, Plan, Reached, Trajectory,
    TrajectoryFile, read_trajectory, write_goal, write_json, write_trajectory, write_urscript,
};
use calibrant_machine::estimate::MachineSetup;
use calibrant_machine::log::ReferenceLog;
use calibrant_machine_design::world::World;
use calibrant_machine_design::{
    Dwells, PlainTrajectory, SensorBody, TrajectoryCriterion, TrajectoryDesign, TrajectoryEvaluation,
    TrajectoryNoise, TrajectoryProblem, TrajectorySettings, TrajectorySweep, design_trajectory,
    evaluate_trajectory, sweep_durations,
};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The design of a machine's trajectory, as an experiment describes it.
///
/// # Examples
/// ```no_run
/// use calibrant::io::{Experiment, preset};
/// use calibrant::{DesignChoice, TrajectoryPlan};
///
/// let arm = Experiment::parse(preset("arm").expect("built in"), None)?;
/// let plan = TrajectoryPlan::new(arm, &DesignChoice::default())?;
/// let best = plan.design()?;
/// plan.write(&best, "best".as_ref(), None)?;
/// # Ok::<(), calibrant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TrajectoryPlan {
    /// The experiment.
    pub experiment: Experiment,
    /// Chain, limits, noise and duration.
    pub machine: MachineDesignPlan,
    /// What is known of mount, clocks, gravity and geometry.
    pub setup: MachineSetup,
    /// The sensor's parameters that a recording is to determine.
    pub quantities: Vec<ImuQuantity>,
    /// What the machine must not touch.
    pub world: World,
    /// What is minimised.
    pub criterion: TrajectoryCriterion,
    /// How the search goes.
    pub settings: TrajectorySettings,
}

impl TrajectoryPlan {
    /// The design of an experiment with `[machine]`.
    ///
    /// # Errors
    /// [`Error::Experiment`] as [`Experiment::machine_design`]; and for a criterion that trajectories do not have, E or M.
    pub fn new(experiment: Experiment, choice: &DesignChoice) -> Result<Self> {
        Self::after(experiment, choice, None)
    }

    /// The same on the machine as an earlier calibration found it: with its zeros and geometry, its mount and delays, and the noise of its sensor. How well all is known
    /// stays as the experiment says.
    ///
    /// # Errors
    /// As [`new`](Self::new); and where the calibration is of another machine.
    pub fn after(
        experiment: Experiment,
        choice: &DesignChoice,
        earlier: Option<&EarlierMachine>,
    ) -> Result<Self> {
        let mut machine = experiment.machine_design()?;
        let Plan::Machine(plan) = &experiment.plan else {
            let help = "see `calibrant init arm`";
            let message = "the trajectory of a machine needs [machine]";
            return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
        };
        let mut setup =
            plan.setup(&experiment.sensor, experiment.imu.as_ref(), machine.chain.joints.len())?;
        if let Some(earlier) = earlier {
            machine.chain = earlier.chain(&machine.chain)?;
            setup = earlier.setup(&setup);
            machine.moving_noise = earlier.moving_noise.unwrap_or(machine.moving_noise);
            for (sensor, density) in &earlier.noise_density {
                match sensor {
                    SensorKind::Accelerometer => machine.force_density = *density,
                    SensorKind::Gyroscope => machine.rate_density = machine.rate_density.map(|_| *density),
                }
            }
        }
        let quantities = experiment
            .quantities_of(|kind| kind == SensorKind::Accelerometer || machine.rate_density.is_some());
        let ranges: Vec<(f64, f64)> =
            machine.limits.joints.iter().map(|limit| (limit.lower, limit.upper)).collect();
        if experiment.sensor.unit == ReadingUnit::Counts {
            let help = "unit = \"mps2\" in [sensor], with noise_mps2 = noise_counts/gain_counts_per_mps2, for the design alone";
            let message = "the trajectory of a machine is designed in m/s², not in counts";
            let input_error = InputError::new(Refusal::ExperimentUnsuited, message, help);
            return Err(Error::experiment(input_error.about_key("sensor.unit")));
        }
        let world = World::new(&machine.chain, &ranges, machine.world.scene.clone());
        let letter = choice.criterion.unwrap_or(experiment.design.criterion);
        let criterion = criterion(letter, &experiment, &machine, &quantities)?;
        let settings = TrajectorySettings {
            starts: choice.starts.unwrap_or(experiment.design.starts),
            seconds: choice.seconds,
            seed: choice.seed.unwrap_or(experiment.design.seed),
            interruption: choice.interruption.clone(),
            ..TrajectorySettings::default()
        };
        Ok(Self { experiment, machine, setup, quantities, world, criterion, settings })
    }

    /// The same plan, whose search reports its stages to this listener.
    #[must_use]
    pub fn with_progress(mut self, progress: Progress) -> Self {
        self.settings.progress = progress;
        self
    }

    /// The problem that is solved.
    #[must_use]
    pub fn problem(&self) -> TrajectoryProblem<'_> {
        let of = &self.machine;
        TrajectoryProblem {
            chain: &of.chain,
            setup: &self.setup,
            quantities: &self.quantities,
            noise: TrajectoryNoise {
                force_density: Some(of.force_density),
                rate_density: of.rate_density,
                moving: of.moving_noise,
            },
            cross_axis_sd: [self.experiment.sensor.cross_axis_sd.unwrap_or(MATRIX_SD), MATRIX_SD],
            joints: of.limits.joints.clone(),
            force_range_mps2: of.force_range_mps2,
            rate_range_radps: of.rate_range_radps,
            tip_speed_mps: of.limits.tip_speed_mps,
            sensor_body: of.world.sensor_body.map(|(center_m, radius_m)| SensorBody { center_m, radius_m }),
            surroundings: Some(&self.world),
            clearance_m: of.world.clearance_m,
            duration_s: of.duration_s,
            knot_s: of.knot_s,
            home: of.home.clone(),
            criterion: self.criterion.clone(),
            dwells: match of.dwells {
                calibrant_io::Dwells::None => Dwells::None,
                calibrant_io::Dwells::Auto => Dwells::Auto,
                calibrant_io::Dwells::Number(number) => Dwells::Number(number),
            },
        }
    }

    /// Finds the best trajectory.
    ///
    /// # Errors
    /// As [`design_trajectory`].
    pub fn design(&self) -> Result<TrajectoryDesign> {
        design_trajectory(&self.problem(), &self.settings)
    }

    /// Finds the best trajectory for each duration; `progress` is told how many are done. Where it is interrupted, it has those that are finished.
    ///
    /// # Errors
    /// [`Error::Experiment`] for another quantity than the duration, and for a duration that `machine.design.duration_s` may not have.
    pub fn sweep(
        &self,
        variable: SweepVariable,
        values: &[f64],
        progress: &dyn Fn(usize),
    ) -> Result<TrajectorySweep> {
        let refused =
            |code, message: String, help| Err(Error::experiment(InputError::new(code, message, help)));
        if variable != SweepVariable::Duration {
            let message = format!("a machine is swept over its duration, not over its {}", variable.name());
            return refused(Refusal::ExperimentUnsuited, message, "sweep the duration: 10, 20 and 40 s");
        }
        if let Some(duration_s) = values.iter().find(|duration_s| !DURATIONS_S.contains(*duration_s)) {
            let message = format!("the sweep has a trajectory of {duration_s} s");
            return refused(Refusal::ValueOutOfRange, message, "durations from 1 s, at most 3600 s");
        }
        Ok(sweep_durations(&self.problem(), &self.settings, values, progress))
    }

    /// Evaluates a trajectory, in a file or as positions and velocities at its knots: what it determines, and which limits it keeps.
    ///
    /// # Errors
    /// As [`read_trajectory`] and [`evaluate_trajectory`].
    pub fn evaluate(&self, motion: &MotionSource) -> Result<TrajectoryEvaluation> {
        let chain = &self.machine.chain;
        let trajectory = match motion {
            MotionSource::File(path) => read_trajectory(path, chain)?,
            MotionSource::Logged(ReferenceLog::Joints(log))
            | MotionSource::OnKnots(ReferenceLog::Joints(log), _) => Trajectory::at_knots(log, chain)?,
            _ => {
                let message = "a trajectory of a machine is of its joints";
                let help = "give positions and velocities of the joints at the knots";
                return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
            }
        };
        evaluate_trajectory(&self.problem(), &trajectory.spline)
    }

    /// The same path, so many times slower: for the first run on the machine.
    ///
    /// # Errors
    /// As [`evaluate_trajectory`].
    pub fn slowed(&self, of: &TrajectoryEvaluation, times: f64) -> Result<TrajectoryEvaluation> {
        let mut motion = of.motion.clone();
        motion.knots.step_s *= times;
        evaluate_trajectory(&self.problem(), &motion)
    }

    /// A design whose motions are all so many times slower.
    ///
    /// # Errors
    /// As [`slowed`](Self::slowed).
    pub fn slowed_design(&self, of: &TrajectoryDesign, times: f64) -> Result<TrajectoryDesign> {
        let plain = of.plain.as_ref().map(|plain| {
            let evaluation = self.slowed(&plain.evaluation, times)?;
            Ok::<_, Error>(PlainTrajectory { evaluation, ..plain.clone() })
        });
        Ok(TrajectoryDesign {
            optimal: self.slowed(&of.optimal, times)?,
            random: self.slowed(&of.random, times)?,
            plain: plain.transpose()?,
            dwells_s: of.dwells_s.iter().map(|(from, to)| (times * from, times * to)).collect(),
            // these are of the duration that was searched
            bound: None,
            starts: Vec::new(),
            ..of.clone()
        })
    }

    /// Writes `trajectory.csv`, `follow_joint_trajectory.yaml`, `trajectory.script` for an arm of Universal Robots, `plain_trajectory.csv` and `design.json` with the goals that were reached. Returns their paths.
    ///
    /// # Errors
    /// [`Error::Output`] where one cannot be written.
    pub fn write(
        &self,
        design: &TrajectoryDesign,
        directory: &Path,
        reached: Option<&Reached>,
    ) -> Result<Vec<PathBuf>> {
        let at = |name: &str| directory.join(name);
        let mut written = self.write_motion(&design.optimal, directory)?;
        write_json(&at("design.json"), &self.file(design, &self.problem(), reached))?;
        written.push(at("design.json"));
        if let Some(plain) = &design.plain {
            let trajectory = Trajectory::of(&self.machine.chain, plain.evaluation.motion.clone());
            write_trajectory(&at("plain_trajectory.csv"), &trajectory)?;
            written.push(at("plain_trajectory.csv"));
        }
        Ok(written)
    }

    /// The content of `design.json`, with the goals that were reached.
    #[must_use]
    pub fn file<'a>(
        &'a self,
        design: &'a TrajectoryDesign,
        problem: &'a TrajectoryProblem<'a>,
        reached: Option<&'a Reached>,
    ) -> TrajectoryFile<'a> {
        TrajectoryFile { design, problem, plan: &self.machine, world: &self.world, reached }
    }

    /// Writes the trajectory alone, in the files that controllers take.
    ///
    /// # Errors
    /// [`Error::Output`] where one cannot be written.
    pub fn write_motion(&self, of: &TrajectoryEvaluation, directory: &Path) -> Result<Vec<PathBuf>> {
        let at = |name: &str| directory.join(name);
        let trajectory = Trajectory::of(&self.machine.chain, of.motion.clone());
        write_trajectory(&at("trajectory.csv"), &trajectory)?;
        write_goal(&at("follow_joint_trajectory.yaml"), &trajectory)?;
        let mut written = vec![at("trajectory.csv"), at("follow_joint_trajectory.yaml")];
        if write_urscript(&at("trajectory.script"), &trajectory)? {
            written.push(at("trajectory.script"));
        }
        Ok(written)
    }

    /// What is not known of the machine's shape, and what should be known of its limits and files.
    #[must_use]
    pub fn notes(&self) -> Vec<Diagnostic> {
        let world = &self.machine.world;
        let of_links: Option<Diagnostic> = match world.links {
            LinksKnown::Nothing => Some(CollisionsUnknown {}.into()),
            LinksKnown::Joints => Some(LinksWithoutShapes { links: Vec::new() }.into()),
            LinksKnown::Shapes if world.without_mesh.is_empty() => None,
            LinksKnown::Shapes => {
                let links = world.without_mesh.iter().map(|of| of.link.clone()).collect();
                Some(LinksWithoutShapes { links }.into())
            }
        };
        of_links.into_iter().chain(self.machine.limits.notes.clone()).chain(world.notes.clone()).collect()
    }

    /// Why the search of a design ended before it converged. The last stage has a number of iterations by intention, which is no reason to say so.
    #[must_use]
    pub fn remarks(&self, design: &TrajectoryDesign) -> Vec<Diagnostic> {
        if design.status == DesignStatus::IterationLimit {
            return Vec::new();
        }
        search_ended(design.status, !self.settings.interruption.is_asked()).into_iter().collect()
    }
}

/// Durations of a trajectory, s: as `machine.design.duration_s` may be.
const DURATIONS_S: RangeInclusive<f64> = 1.0..=3600.0;
/// Range of a criterion where the sensor's is not given: ±2 g and ±500 °/s.
const USUAL_RANGE: [f64; 2] = [19.613_3, 8.726_646];

fn criterion(
    letter: CriterionLetter,
    experiment: &Experiment,
    machine: &MachineDesignPlan,
    quantities: &[ImuQuantity],
) -> Result<TrajectoryCriterion> {
    let finite = |range: f64, usual: f64| if range.is_finite() { range } else { usual };
    let force = experiment.design.range_mps2.map(f64::from);
    let range = [
        force.unwrap_or_else(|| finite(machine.force_range_mps2.min(), USUAL_RANGE[0])),
        finite(machine.rate_range_radps.min(), USUAL_RANGE[1]),
    ];
    let refused = |key: &str, message: &str, help: &str| {
        Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help).about_key(key)))
    };
    Ok(match letter {
        CriterionLetter::D => TrajectoryCriterion::D,
        CriterionLetter::A => TrajectoryCriterion::A { range },
        CriterionLetter::I => TrajectoryCriterion::I { range },
        CriterionLetter::C => {
            let weight = |quantity: &ImuQuantity| {
                experiment.design.weights.get(&quantity.name()).map_or(0.0, |weight| weight.get())
            };
            let weights: Vec<f64> = quantities.iter().map(weight).collect();
            if weights.iter().all(|weight| *weight == 0.0) {
                let help = "weights = { \"accelerometer.scale.x\" = 1.0 } in [design]";
                return refused("design.weights", "criterion c needs a weight above 0", help);
            }
            TrajectoryCriterion::C { weights }
        }
        CriterionLetter::E | CriterionLetter::M => {
            let message = "trajectories of machines have the criteria D, A, c and I";
            return refused("design.criterion", message, "criterion = \"D\" in [design]");
        }
    })
}

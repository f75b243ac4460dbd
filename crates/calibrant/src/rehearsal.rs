//! The rehearsal of a machine: what design, recording and calibration give for simulated sensors, before the machine is used.

use crate::session::{MotionSource, Readings, Session, SessionOptions, Source};
use crate::simulation::{SimulationOptions, simulate};
use crate::trajectory_plan::TrajectoryPlan;
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::design::{SensorsNotCalibrated, SeriesInterrupted};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::interruption::Interruption;
use calibrant_core::sensor::{ImuQuantity, Parameter, ReadingUnit};
use calibrant_io::{Experiment, Plan, Trajectory};
use calibrant_machine::estimate::MachineQuantity;
use calibrant_machine_design::{PlainRoutine, PlainTrajectory, TrajectoryDesign, TrajectoryEvaluation};
use calibrant_study::{Rehearsal, RehearsedCalibration, RehearsedSensor, Studies};
use rayon::iter::Either;
use rayon::prelude::*;

/// A rehearsal, ready to run.
///
/// # Examples
/// ```no_run
/// use calibrant::io::{Experiment, preset};
/// use calibrant::{DesignChoice, RehearsalPlan, TrajectoryPlan};
///
/// let arm = Experiment::parse(preset("arm").expect("built in"), None)?;
/// let plan = TrajectoryPlan::new(arm, &DesignChoice::default())?;
/// let design = plan.design()?;
/// let studies = RehearsalPlan { plan: &plan, sensors: 30, seed: 1, interruption: Default::default(), budget: Default::default() }.run(&design, &|_| {})?;
/// println!("{} sensors", studies.rehearsal.map_or(0, |rehearsal| rehearsal.sensors.len()));
/// # Ok::<(), calibrant::Error>(())
/// ```
pub struct RehearsalPlan<'a> {
    /// The experiment with its machine.
    pub plan: &'a TrajectoryPlan,
    /// Number of simulated sensors.
    pub sensors: usize,
    /// Seed of the first sensor; each later one has the next. Everything that is not known of sensor, mount, clocks and machine is drawn from its prior.
    pub seed: u64,
    /// Ends it; those sensors remain that are finished.
    pub interruption: Interruption,
    /// What it may take.
    pub budget: Budget,
}

/// One of both motions.
struct Rehearsed<'a> {
    motion: MotionSource,
    evaluation: &'a TrajectoryEvaluation,
    /// Number of the recording.
    number: u64,
}

impl RehearsalPlan<'_> {
    /// Simulates each sensor on the plain routine and on the best trajectory of this design, and calibrates it from both recordings. `progress` is called with 1 after
    /// each sensor.
    ///
    /// The result does not depend on the number of threads. Sensor `k` is that of `calibrant simulate --seed` with its seed.
    ///
    /// # Errors
    /// [`Error::Infeasible`] where the design found no plain routine to compare with; as [`simulate`] and [`Session::calibrate`] where no sensor is calibrated;
    /// [`Refusal::Interrupted`] before the first sensor.
    pub fn run(&self, design: &TrajectoryDesign, progress: &(dyn Fn(u64) + Sync)) -> Result<Studies> {
        let Some(PlainTrajectory { routine, evaluation: plain }) = &design.plain else {
            return Err(no_routine());
        };
        let one = |number: u64, evaluation| Rehearsed { motion: self.motion(evaluation), evaluation, number };
        let both = [one(1, plain), one(2, &design.optimal)];
        let (sensors, failed) = self.sensors(&both, progress);
        let mut notes = Vec::<Diagnostic>::new();
        if self.interruption.is_asked() {
            let (finished, all) = (sensors.len(), self.sensors);
            notes.push(SeriesInterrupted { series: "study", items: "sensors", finished, all }.into());
        }
        if sensors.is_empty() {
            self.interruption.check()?;
        }
        let number = failed.len();
        match failed.into_iter().next() {
            Some((_, error)) if sensors.is_empty() => return Err(error),
            Some((seed, error)) => {
                let why = Phrase(format!("The sensor of seed {seed}: {error}"));
                notes.push(SensorsNotCalibrated { number, all: self.sensors, why }.into());
            }
            None => {}
        }
        let rehearsal = self.summed_up(design, *routine, &both, sensors);
        Ok(Studies { rehearsal: Some(rehearsal), notes, ..Studies::default() })
    }

    fn motion(&self, of: &TrajectoryEvaluation) -> MotionSource {
        let trajectory = Trajectory::of(&self.plan.machine.chain, of.motion.clone());
        MotionSource::OnKnots(trajectory.log(), of.motion.knots.step_s)
    }

    /// The sensors, and the seeds of those that were not calibrated, with the error.
    fn sensors(
        &self,
        both: &[Rehearsed<'_>; 2],
        progress: &(dyn Fn(u64) + Sync),
    ) -> (Vec<RehearsedSensor>, Vec<(u64, Error)>) {
        let one = |k: u64| {
            if self.interruption.is_asked() {
                return None;
            }
            let seed = self.seed.wrapping_add(k);
            let sensor = self.sensor(both, seed).map_err(|error| (seed, error));
            progress(1);
            // what an interruption broke off is left out
            (sensor.is_ok() || !self.interruption.is_asked()).then_some(sensor)
        };
        (0..self.sensors as u64).into_par_iter().filter_map(one).partition_map(|sensor| match sensor {
            Ok(sensor) => Either::Left(sensor),
            Err(failed) => Either::Right(failed),
        })
    }

    fn sensor(&self, [plain, optimal]: &[Rehearsed<'_>; 2], seed: u64) -> Result<RehearsedSensor> {
        let experiment = self.as_designed();
        let (truth, plain) = self.calibrated(&experiment, plain, seed)?;
        let (_, optimal) = self.calibrated(&experiment, optimal, seed)?;
        Ok(RehearsedSensor { seed, truth, plain, optimal })
    }

    /// The experiment, whose simulation has the rate and the noise of its design.
    fn as_designed(&self) -> Experiment {
        let mut experiment = self.plan.experiment.clone();
        if let Plan::Machine(plan) = &mut experiment.plan {
            let simulation = &mut plan.simulation;
            simulation.rate_hz = self.plan.machine.rate_hz;
            let added = (self.plan.machine.moving_noise.powi(2) - 1.0).max(0.0).sqrt();
            simulation.vibration = simulation.vibration.max(added);
        }
        experiment
    }

    /// The true values of a sensor, and its calibration from a recording of this motion.
    fn calibrated(
        &self,
        experiment: &Experiment,
        of: &Rehearsed<'_>,
        seed: u64,
    ) -> Result<(Vec<f64>, RehearsedCalibration)> {
        let options = SimulationOptions {
            seed: Some(seed),
            recording: of.number,
            motion: Some(of.motion.clone()),
            budget: self.budget,
            ..SimulationOptions::default()
        };
        let simulated = simulate(experiment, &options)?;
        let truth = |quantity: &ImuQuantity| simulated.truth.value(&quantity.name()).unwrap_or(f64::NAN);
        let truth: Vec<f64> = self.plan.quantities.iter().map(truth).collect();
        let log = simulated.log.map(|(log, _)| match simulated.knot_step_s {
            Some(step_s) => MotionSource::OnKnots(log, step_s),
            None => MotionSource::Logged(log),
        });
        let options = SessionOptions {
            motion: log,
            interruption: self.interruption.clone(),
            ..SessionOptions::default()
        };
        let session = Session::with(experiment.clone(), options)?;
        let readings = Readings::recording(format!("sensor {seed}"), simulated.recording);
        let outcome = session.calibrate(&Source::new(readings))?;
        let machine = outcome.calibrated.machine().ok_or_else(no_machine)?;
        let estimate = |of: &ImuQuantity| machine.calibration.estimate(MachineQuantity::Imu(*of));
        let found = self.plan.quantities.iter().map(|of| estimate(of).unwrap_or((f64::NAN, f64::NAN)));
        let (values, sd) = found.unzip();
        let verdict = outcome.verdict();
        let codes = verdict.code_names();
        Ok((truth, RehearsedCalibration { values, sd, verdict: verdict.usability.name(), codes }))
    }

    fn summed_up(
        &self,
        design: &TrajectoryDesign,
        routine: PlainRoutine,
        both: &[Rehearsed<'_>; 2],
        sensors: Vec<RehearsedSensor>,
    ) -> Rehearsal {
        let experiment = &self.plan.experiment;
        let gyroscope = experiment.imu.as_ref().map(|imu| imu.gyroscope.unit);
        let units = [experiment.sensor.unit, gyroscope.unwrap_or(ReadingUnit::RadianPerSecond)];
        let unit = |quantity: &ImuQuantity| units[quantity.sensor_kind() as usize];
        let quantities = &self.plan.quantities;
        let parameters = quantities.iter().map(|of| Parameter::undescribed(*of, unit(of))).collect();
        let knots = design.optimal.motion.knots;
        let designed = |of: &Rehearsed<'_>| of.evaluation.sd();
        let duration_s = knots.step_s * knots.intervals as f64;
        Rehearsal::of(
            (self.seed, duration_s),
            parameters,
            routine.name(),
            both.each_ref().map(designed),
            sensors,
        )
    }
}

fn no_machine() -> Error {
    let message = "a rehearsal needs [machine] with joints";
    Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, "see `calibrant init arm`"))
}

fn no_routine() -> Error {
    let message = "a rehearsal compares the best trajectory with a plain routine, and none was found that keeps the limits in this duration";
    let help =
        "give more time (`machine.design.duration_s`), or simulate and calibrate on trajectory.csv alone";
    Error::infeasible(InputError::new(Refusal::MotionInfeasible, message, help))
}

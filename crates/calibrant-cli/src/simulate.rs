//! `calibrant simulate`: draws a sensor from the datasheet and simulates its recording.

mod arguments;
mod gains;
mod imu;
mod length;
mod machine;
mod machine_motion;
mod random;

pub(crate) use arguments::Arguments;

use crate::diagnostics::tell;
use crate::{Exit, console, rest_remark};
use calibrant::Error;
use calibrant::design::initial_motion;
use calibrant::diagnostic::settings::SettingUnused;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{
    Experiment, HoldsPlan, MotionPlan, Plan, ResultPlaces, Truth, read_motion, read_poses, write_json,
    write_motion, write_recording,
};
use calibrant::motion::{JerkControlledMotion, KnownEnds, Limits, Trust};
use calibrant::sensor::{ReadingUnit, Sensor};
use calibrant::simulate::{
    HoldsSimulation, Purpose, draw_gravity, draw_sensor, perturb, sample_times, simulate_holds,
    simulate_holds_in, simulate_recording, stream,
};
use nalgebra::Vector3;
use random::Random;
use std::path::Path;

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let names =
            ["recording.csv", "truth.json", "motion.csv", "true_motion.csv", "joints.csv", "poses.csv"];
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: names.map(|name| self.output.join(name)).to_vec(),
            inputs: std::iter::once(&self.experiment)
                .chain(&self.motion)
                .chain(&self.poses)
                .cloned()
                .collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = Experiment::read(&arguments.experiment)?;
    let seed = arguments.seed.unwrap_or(experiment.study.seed);
    let random = Random { seed, recording: arguments.recording.into() };
    let takes_poses = matches!(&experiment.plan, Plan::Holds(plan) if plan.directions.is_none());
    if arguments.poses.is_some() && (!takes_poses || experiment.imu.is_some()) {
        let message =
            "--poses is for an accelerometer that is held by hand, in directions that [holds] does not list";
        let help = "leave it away, or see `calibrant init static-poses`";
        return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    }
    let samples = match (&experiment.plan, &experiment.imu) {
        (Plan::Motion(plan), _) => {
            check_simulable(&experiment.sensor, &arguments.experiment)?;
            simulate_motion(arguments, &experiment, plan, random)?
        }
        (Plan::Machine(plan), _) => machine::run(arguments, &experiment, plan, random)?,
        (Plan::Holds(plan), imu) => {
            if arguments.motion.is_some() {
                tell(SettingUnused::of(&["--motion"], "a [holds] experiment has no motion"));
            }
            match imu {
                Some(imu) => imu::run(arguments, &experiment, plan, imu, random)?,
                None => {
                    check_simulable(&experiment.sensor, &arguments.experiment)?;
                    simulate_poses(arguments, &experiment, plan, random)?
                }
            }
        }
    };
    let which =
        if arguments.recording == 1 { String::new() } else { format!(", recording {}", arguments.recording) };
    console::print(&format!(
        "{samples} samples, seed {seed}{which}: {}\n",
        arguments.output.join("recording.csv").display()
    ));
    Ok(Exit::DONE)
}

/// Returns an error where a simulation needs a number that a calibration can do without.
fn check_simulable(sensor: &Sensor, file: &Path) -> calibrant::Result<()> {
    let missing = |key: &str| {
        let input_error = InputError::new(
            Refusal::KeyMissing,
            format!("a simulation needs `{key}`"),
            "add it to the experiment file",
        );
        Err(Error::Experiment(Box::new(input_error.in_file(file).about_key(format!("sensor.{key}")))))
    };
    if sensor.gain.is_none() {
        return missing("gain_counts_per_mps2");
    }
    match sensor.noise(&sensor.gain.unwrap_or_else(|| Vector3::repeat(1.0))) {
        None if sensor.unit == ReadingUnit::Counts => missing("noise_counts"),
        None => missing("noise_mps2"),
        Some(_) => Ok(()),
    }
}

/// Largest number of draws of an initial motion.
const MOST_DRAWS: u64 = 100;

/// The commanded motion: the given one, or the experiment's random initial one for this recording (from 1).
pub(crate) fn commanded_motion(
    motion: Option<&Path>,
    plan: &MotionPlan,
    axes: usize,
    limits: &Limits,
    seed: u64,
    recording: u64,
) -> calibrant::Result<JerkControlledMotion> {
    if let Some(path) = motion {
        return read_motion(path, axes);
    }
    // with both ends known and nothing in between, the ends must differ: draw again until they differ by a
    // tenth of the peak
    let first = MOST_DRAWS * (recording - 1);
    let drawn = |draw| {
        let mut rng = stream(seed, Purpose::Motion, draw);
        initial_motion(plan.intervals, plan.interval_s, axes, limits, &mut rng)
    };
    for draw in first..first + MOST_DRAWS {
        let motion = drawn(draw)?;
        let a = motion.acceleration_mps2();
        let apart = (0..axes).all(|k| {
            let peak = a.iter().fold(0.0_f64, |peak, a| peak.max(a[k].abs()));
            (a[plan.intervals][k] - a[0][k]).abs() >= 0.1 * peak
        });
        if plan.trust != Trust::Unknown || plan.known_ends != KnownEnds::Both || apart {
            return Ok(motion);
        }
    }
    drawn(first)
}

fn simulate_motion(
    arguments: &Arguments,
    experiment: &Experiment,
    plan: &MotionPlan,
    random: Random,
) -> calibrant::Result<usize> {
    let sensor = &experiment.sensor;
    let limits = experiment.limits.within_range(plan.range_left(sensor));
    let given = arguments.motion.as_deref();
    if given.is_none() {
        rest_remark::remark(&limits);
    }
    let motion = commanded_motion(given, plan, sensor.axes, &limits, random.seed, random.recording)?;
    length::check_motion(&motion, plan.rate_hz)?;
    let mut rng = random.sensor();
    let truth = draw_sensor(sensor, &mut rng);
    let mut rng = random.happening(rng);
    let happened = match plan.trust {
        Trust::Noisy(noise) => Some(perturb(&motion, &noise, sensor.axes, plan.known_ends, &mut rng)?),
        Trust::Known | Trust::Unknown => None,
    };
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let times = sample_times(&motion, plan.rate_hz);
    let gravity = plan.gravity.as_ref().map(|gravity| draw_gravity(gravity, &mut rng));
    let at_rest = gravity.map_or_else(Vector3::zeros, |gravity| gravity.force_mps2);
    let sensed = happened.as_ref().unwrap_or(&motion).plus(&at_rest)?;
    let recording = simulate_recording(&truth, &noise, sensor.unit, sensor.axes, &sensed, &times, &mut rng);
    let output = &arguments.output;
    write_motion(&output.join("motion.csv"), &motion, sensor.axes)?;
    if let Some(happened) = &happened {
        write_motion(&output.join("true_motion.csv"), happened, sensor.axes)?;
    }
    let list = sensor.parameter_list();
    let path = output.join("truth.json");
    let file = Truth::of_sensor(random.seed, &list, sensor.unit, &truth).with_gravity(gravity);
    write_json(&path, &file)?;
    write_recording(&output.join("recording.csv"), &recording)?;
    Ok(recording.len())
}

fn simulate_poses(
    arguments: &Arguments,
    experiment: &Experiment,
    plan: &HoldsPlan,
    random: Random,
) -> calibrant::Result<usize> {
    let poses = arguments.poses.as_deref().map(read_poses).transpose()?;
    let plan = &HoldsPlan { poses: poses.as_ref().map_or(plan.poses, Vec::len), ..plan.clone() };
    length::check_holds(plan)?;
    let sensor = &experiment.sensor;
    let mut rng = random.sensor();
    let drawn = draw_sensor(sensor, &mut rng);
    let on_table = imu::table(plan, &[]);
    // known directions fix the true frame; otherwise the gauge does
    let (truth, list) = match &on_table {
        Some(_) => (drawn, sensor.parameter_list()),
        None => (plan.gauge.apply(&drawn), plan.gauge.parameter_list(sensor.model)),
    };
    let mut rng = random.happening(rng);
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let recording = match &on_table {
        Some(steps) => imu::accelerometer_on_table(sensor, &truth, plan, steps, &mut rng)?,
        None => {
            let setup = by_hand(plan);
            match &poses {
                Some(poses) => simulate_holds_in(&truth, &noise, sensor.unit, poses, &setup, &mut rng).0,
                None => simulate_holds(&truth, &noise, sensor.unit, &setup, &mut rng).0,
            }
        }
    };
    let output = &arguments.output;
    write_json(&output.join("truth.json"), &Truth::of_sensor(random.seed, &list, sensor.unit, &truth))?;
    write_recording(&output.join("recording.csv"), &recording)?;
    Ok(recording.len())
}

fn by_hand(plan: &HoldsPlan) -> HoldsSimulation {
    HoldsSimulation {
        poses: plan.poses,
        hold_s: plan.hold_s,
        turn_s: 2.0,
        rate_hz: plan.rate_hz,
        gravity_mps2: plan.gravity.magnitude_mps2,
        between_holds_sd_mps2: plan.between_holds_sd_mps2,
    }
}

//! Simulates a sensor on a machine, and the log of its motion.

use super::gains::gains;
use super::machine_motion::{TrueMotion, motion};
use super::options::SimulationOptions;
use super::random::Random;
use super::simulated::Simulation;
use super::{imu, length};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ParameterList, ReadingUnit, SensorKind, SensorModel,
};
use calibrant_core::simulate::{GyroscopeToDraw, ImuSimulation, Rng, draw_imu};
use calibrant_io::{Experiment, MachinePlan, TrueMachine, Truth};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use calibrant_machine::simulate::{
    LogErrors, SensorErrors, SensorSampling, draw_machine, record_log, record_sensors,
};
use calibrant_machine::spline::Degree;
use nalgebra::Vector3;

/// Noise of a joint's encoder where none is given, rad or m.
const ENCODER_NOISE: f64 = 2e-5;
/// Noise of a pose where none is given: position, m, and orientation, rad.
const POSE_NOISE: [f64; 2] = [2e-4, 1e-3];

pub(super) fn simulate(
    experiment: &Experiment,
    plan: &MachinePlan,
    options: &SimulationOptions,
    random: Random,
) -> Result<Simulation> {
    let chain = plan.kinematic_chain()?;
    let joints = chain.as_ref().map_or(0, |chain| chain.joints.len());
    if chain.is_some() && joints == 0 {
        let message = "no joint between base and tip moves";
        let help = "name other links in [machine]: base and tip";
        return Err(Error::experiment(InputError::new(Refusal::MachineUnsuited, message, help)));
    }
    let setup = plan.setup(&experiment.sensor, experiment.imu.as_ref(), joints)?;
    let asked = &plan.simulation;
    let log_errors = LogErrors {
        rate_hz: asked.log_rate_hz,
        noise: log_noise(&setup, chain.as_ref())?,
        resolution: asked.resolution,
    };
    let mut notes = Vec::new();
    let given = (options.motion.as_ref(), &mut notes);
    let TrueMotion { motion, edge_s } = motion(given, plan, chain.as_ref(), &setup, random)?;
    let knots = motion.knots();
    let duration_s = knots.end_s() - knots.start_s;
    let less = "lower duration_s, rate_hz or log_rate_hz in [machine.simulate], or give a shorter log";
    length::check(duration_s, asked.rate_hz + asked.log_rate_hz, less, options.budget)?;
    let sampling = SensorSampling {
        start_s: knots.start_s + edge_s - setup.delay_s,
        samples: ((duration_s - 2.0 * edge_s) * asked.rate_hz).round() as usize + 1,
        rate_hz: asked.rate_hz,
    };

    let of_experiment =
        Sensors { experiment, setup: &setup, gains: gains(experiment)?, vibration: asked.vibration };
    let sensors = of_experiment.errors();
    let kinds: Vec<SensorKind> = sensors.iter().map(|of| of.sensor).collect();
    let mut rng = random.sensor();
    let drawn = of_experiment.drawn(&mut rng)?;
    let machine = draw_machine(&setup, drawn, &kinds, joints, &mut rng);
    let mut rng = random.happening(rng);
    let recording = record_sensors(&motion, &machine.parameters, &setup, &sampling, &sensors, &mut rng)?;
    let log = record_log(&motion, &log_errors, &mut rng);

    let joints = chain.iter().flat_map(|chain| &chain.joints);
    let log_units = joints.map(|joint| joint.kind.unit()).collect();
    let (quantities, units) = (of_experiment.quantities(), of_experiment.units());
    let truth = Truth::of_imu(random.seed, &quantities, units, &machine.parameters.imu)
        .on_machine(TrueMachine::new(&machine, chain.as_ref(), &sensors, &log_errors));
    Ok(Simulation {
        log: Some((log, log_units)),
        knot_step_s: (knots.degree == Degree::Cubic).then_some(knots.step_s),
        notes,
        ..Simulation::new(random.seed, recording, truth)
    })
}

/// The noise of each component of the log: what the experiment states, or what is usual.
fn log_noise(setup: &MachineSetup, chain: Option<&KinematicChain>) -> Result<Vec<f64>> {
    let usual = match chain {
        Some(chain) => vec![ENCODER_NOISE; chain.joints.len()],
        None => POSE_NOISE.map(|noise| [noise; 3]).concat(),
    };
    match &setup.reference_noise {
        Some(noise) if noise.len() != usual.len() => {
            let message =
                format!("machine.log.noise has {} values, the machine {} joints", noise.len(), usual.len());
            let help = "give one number, or one for each joint";
            Err(Error::experiment(InputError::new(Refusal::MachineUnsuited, message, help)))
        }
        Some(noise) => Ok(noise.clone()),
        None => Ok(usual),
    }
}

/// The sensors that are simulated.
struct Sensors<'a> {
    experiment: &'a Experiment,
    setup: &'a MachineSetup,
    /// Nominal gains of accelerometer and gyroscope.
    gains: [Vector3<f64>; 2],
    vibration: f64,
}

impl Sensors<'_> {
    fn units(&self) -> [ReadingUnit; 2] {
        let gyroscope = self.experiment.imu.as_ref().map(|imu| imu.gyroscope.unit);
        [self.experiment.sensor.unit, gyroscope.unwrap_or(ReadingUnit::RadianPerSecond)]
    }

    /// Noise and units: what the experiment states, or what is usual.
    fn errors(&self) -> Vec<SensorErrors> {
        let ([gain_a, gain_g], [unit_a, unit_g]) = (self.gains, self.units());
        let usual = ImuSimulation::default();
        let vibration = self.vibration;
        let of_a = self.experiment.sensor.noise(&gain_a).unwrap_or(gain_a * usual.accelerometer_noise);
        let mut errors =
            vec![SensorErrors { sensor: SensorKind::Accelerometer, unit: unit_a, noise: of_a, vibration }];
        if let Some(imu) = &self.experiment.imu {
            let noise = imu.gyroscope.noise.unwrap_or(gain_g * usual.gyroscope_noise);
            errors.push(SensorErrors { sensor: SensorKind::Gyroscope, unit: unit_g, noise, vibration });
        }
        errors
    }

    /// A sensor drawn from the datasheet. Where its mounting is unknown, its accelerometer fixes the frame.
    fn drawn(&self, rng: &mut Rng) -> Result<ImuParameters> {
        let [_, gain] = self.gains;
        let gyroscope = self.experiment.imu.as_ref().map(|imu| &imu.gyroscope);
        let gyroscope = GyroscopeToDraw {
            model: gyroscope.map_or(SensorModel::Full, |of| of.model),
            gain,
            g_sensitivity: gyroscope.is_some_and(|of| of.g_sensitivity),
        };
        let drawn = draw_imu(&self.experiment.sensor, &gyroscope, rng);
        match self.setup.mounting {
            MountingPrior::Unknown => imu::in_gauge(&drawn, self.units(), MountingPrior::GAUGE),
            MountingPrior::Exact | MountingPrior::Within(_) => Ok(drawn),
        }
    }

    /// The parameters that a calibration finds.
    fn quantities(&self) -> Vec<ImuQuantity> {
        let model = self.experiment.sensor.model;
        let list = match self.setup.mounting {
            MountingPrior::Unknown => MountingPrior::GAUGE.parameter_list(model),
            MountingPrior::Exact | MountingPrior::Within(_) => ParameterList::new(3, model),
        };
        let of = |kind: SensorKind, list: &ParameterList| -> Vec<ImuQuantity> {
            list.quantities().iter().map(|quantity| ImuQuantity::Of(kind, *quantity)).collect()
        };
        let mut quantities = of(SensorKind::Accelerometer, &list);
        if let Some(imu) = &self.experiment.imu {
            let list = ParameterList::new(3, imu.gyroscope.model);
            quantities.extend(of(SensorKind::Gyroscope, &list));
            if imu.gyroscope.g_sensitivity {
                quantities.extend(ImuQuantity::full_list(false, false, true));
            }
        }
        quantities
    }
}

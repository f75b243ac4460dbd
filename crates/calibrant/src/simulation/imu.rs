//! Simulates a whole IMU: turned by hand, or on a table as the experiment lists it.

use super::gains::gains;
use super::length;
use super::noise::one_for_all;
use super::options::SimulationOptions;
use super::poses::unused_motion;
use super::random::Random;
use super::simulated::Simulation;
use super::table::{check, table};
use calibrant_core::diagnostic::simulation::ColumnsOfAnother;
use calibrant_core::error::Result;
use calibrant_core::motion::earth_rate;
use calibrant_core::sensor::{
    CalibratedImu, Gauge, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, WORKING_C,
};
use calibrant_core::simulate::{
    GyroscopeToDraw, ImuSimulation, Rng, TURN_S, draw_imu, draw_known, draw_thermal, simulate_imu,
    simulate_table,
};
use calibrant_io::{Experiment, HoldsPlan, ImuPlan, ImuReadOptions, Truth};
use nalgebra::Vector3;

/// An IMU that follows temperature warms by this much over its recording, K.
const WARMING_K: f64 = 24.0;
/// Its temperature in the middle where no reference is given, °C. A calibration takes the mean over the
/// holds, to the degree.
const MIDDLE_C: f64 = 32.0;

pub(super) fn simulate(
    experiment: &Experiment,
    holds: &HoldsPlan,
    plan: &ImuPlan,
    options: &SimulationOptions,
    random: Random,
) -> Result<Simulation> {
    let sensor = &experiment.sensor;
    let holds = &HoldsPlan { poses: options.poses.as_ref().map_or(holds.poses, Vec::len), ..holds.clone() };
    let mut notes = unused_motion(options);
    let [gain_a, gain_g] = gains(experiment)?;
    let mut rng = random.sensor();
    let gyroscope = GyroscopeToDraw {
        model: plan.gyroscope.model,
        gain: gain_g,
        g_sensitivity: plan.gyroscope.g_sensitivity,
    };
    let drawn = draw_imu(sensor, &gyroscope, &mut rng);
    let usual = ImuSimulation::default();
    let noise_a = sensor.noise(&gain_a).unwrap_or_else(|| gain_a * usual.accelerometer_noise);
    let noise_g = plan.gyroscope.noise.unwrap_or_else(|| gain_g * usual.gyroscope_noise);
    let setup = ImuSimulation {
        poses: holds.poses,
        directions: options.poses.clone(),
        hold_s: holds.hold_s,
        turn_s: TURN_S,
        rate_hz: holds.rate_hz,
        gravity_mps2: holds.gravity()?.magnitude_mps2,
        accelerometer_noise: one_for_all(SensorKind::Accelerometer, &noise_a, &mut notes),
        between_holds_sd_mps2: holds.between_holds_sd_mps2,
        gyroscope_noise: one_for_all(SensorKind::Gyroscope, &noise_g, &mut notes),
        accelerometer_unit: sensor.unit,
        gyroscope_unit: plan.gyroscope.unit,
        face_sd_rad: holds.face_sd_rad().unwrap_or(0.0),
        earth_rate_radps: holds
            .latitude_deg
            .map_or_else(Vector3::zeros, |latitude| earth_rate(latitude.get())),
        temperature_c: warming(plan),
    };
    let units = [sensor.unit, plan.gyroscope.unit];
    let on_table = table(holds, &plan.turns);
    // on a table the faces fix the true frame; by hand the accelerometer's gauge does
    let mut truth = match &on_table {
        Some(steps) => {
            check(steps, holds.rate_hz, options.budget)?;
            drawn
        }
        None => {
            length::check_holds(holds, options.budget)?;
            in_gauge(&drawn, units, holds.gauge)?
        }
    };
    // the quantities that a calibration of this experiment finds, and those that it fixes
    let quantities = plan.setup(holds)?.quantities(sensor.model, &plan.gyroscope);
    if let Some([from, to]) = setup.temperature_c {
        truth.thermal.reference_c = plan.thermal.reference_c.unwrap_or(0.5 * (from + to));
        draw_thermal(&mut truth, &plan.thermal.quantities(), [gain_a, gain_g], &mut rng);
    }
    set_known(&mut truth, &quantities, plan, &mut rng);
    let mut rng = random.happening(rng);
    let recording = match &on_table {
        Some(steps) => simulate_table(&truth, steps, &setup, &mut rng),
        None => simulate_imu(&truth, &setup, &mut rng),
    };
    if experiment.columns != ImuReadOptions::default() {
        notes.push(ColumnsOfAnother {}.into());
    }
    let truth = Truth::of_imu(random.seed, &quantities, units, &truth);
    Ok(Simulation { notes, ..Simulation::new(random.seed, recording, truth) })
}

/// Gives known quantities their value, in the true frame of the calibration. As there, a prior of a quantity
/// that is not estimated does nothing.
fn set_known(truth: &mut ImuParameters, estimated: &[ImuQuantity], plan: &ImuPlan, rng: &mut Rng) {
    for known in &plan.known {
        // a temperature term does nothing where nothing follows temperature
        let does_nothing = matches!(known.quantity, ImuQuantity::Thermal(..)) && plan.thermal.is_none();
        if !does_nothing && (known.sd.is_none() || estimated.contains(&known.quantity)) {
            draw_known(truth, known.quantity, known.value, known.sd, rng);
        }
    }
}

/// Temperature at the beginning and at the end of the recording, °C, about the reference: the IMU warms up.
/// `None` where nothing follows temperature.
fn warming(plan: &ImuPlan) -> Option<[f64; 2]> {
    let middle = plan.thermal.reference_c.unwrap_or(MIDDLE_C);
    let within = |celsius: f64| celsius.clamp(*WORKING_C.start(), *WORKING_C.end());
    (!plan.thermal.is_none()).then(|| [-0.5, 0.5].map(|share| within(middle + share * WARMING_K)))
}

/// The same IMU in the frame that its accelerometer's gauge fixes.
pub(super) fn in_gauge(
    drawn: &ImuParameters,
    [a, g]: [ReadingUnit; 2],
    gauge: Gauge,
) -> Result<ImuParameters> {
    let imu = CalibratedImu::new(*drawn, [Some(a), Some(g)], vec![], "");
    Ok(imu.in_gauge_of(SensorKind::Accelerometer, gauge)?.parameters)
}

//! `calibrant simulate` for a whole IMU: turned by hand, or on a table as the experiment lists it.

use super::Arguments;
use super::gains::gains;
use super::length;
use super::random::Random;
use crate::console;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::estimate::Turn;
use calibrant::io::{Experiment, HoldsPlan, ImuPlan, ImuReadOptions, Truth, write_imu_recording, write_json};
use calibrant::motion::earth_rate;
use calibrant::sensor::{
    CalibratedImu, Gauge, ImuParameters, ImuQuantity, ReadingUnit, Recording, Sensor, SensorKind,
    SensorParameters, WORKING_C,
};
use calibrant::simulate::{
    GyroscopeToDraw, ImuSimulation, Rng, TURN_S, TableAction, TableStep, draw_imu, draw_known, draw_thermal,
    simulate_imu, simulate_table,
};
use nalgebra::Vector3;

/// An IMU that follows temperature warms by this much over its recording, K.
const WARMING_K: f64 = 24.0;
/// Its temperature in the middle where no reference is given, °C. A calibration takes the mean over the
/// holds, to the degree.
const MIDDLE_C: f64 = 32.0;

pub(super) fn run(
    arguments: &Arguments,
    experiment: &Experiment,
    holds: &HoldsPlan,
    plan: &ImuPlan,
    random: Random,
) -> calibrant::Result<usize> {
    let sensor = &experiment.sensor;
    let [gain_a, gain_g] = gains(experiment, &arguments.experiment)?;
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
        hold_s: holds.hold_s,
        turn_s: TURN_S,
        rate_hz: holds.rate_hz,
        gravity_mps2: holds.gravity.magnitude_mps2,
        accelerometer_noise: one_for_all(SensorKind::Accelerometer, &noise_a),
        between_holds_sd_mps2: holds.between_holds_sd_mps2,
        gyroscope_noise: one_for_all(SensorKind::Gyroscope, &noise_g),
        accelerometer_unit: sensor.unit,
        gyroscope_unit: plan.gyroscope.unit,
        face_sd_rad: holds.face_sd_rad.unwrap_or(0.0),
        earth_rate_radps: holds.latitude_deg.map_or_else(Vector3::zeros, earth_rate),
        temperature_c: warming(plan),
    };
    let units = [sensor.unit, plan.gyroscope.unit];
    let on_table = table(holds, &plan.turns);
    // on a table the faces fix the true frame; by hand the accelerometer's gauge does
    let mut truth = match &on_table {
        Some(steps) => {
            check(steps, holds.rate_hz)?;
            drawn
        }
        None => {
            length::check_holds(holds)?;
            in_gauge(&drawn, units, holds.gauge)?
        }
    };
    // the quantities that a calibration of this experiment finds, and those that it fixes
    let quantities = plan.setup(holds).quantities(sensor.model, &plan.gyroscope);
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
    let file = Truth::of_imu(random.seed, &quantities, units, &truth);
    write_json(&arguments.output.join("truth.json"), &file)?;
    write_imu_recording(&arguments.output.join("recording.csv"), &recording)?;
    if experiment.columns != ImuReadOptions::default() {
        console::note(&format!(
            "recording.csv says its columns and units itself: to calibrate it take a copy of {} without [columns] and gyroscope.unit, which are about another file",
            arguments.experiment.display()
        ));
    }
    Ok(recording.accelerometer.map_or(0, |recording| recording.len()))
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

/// The simulation has one noise for all axes of a sensor: the largest.
fn one_for_all(sensor_kind: SensorKind, noise: &Vector3<f64>) -> f64 {
    if noise.max() > noise.min() {
        console::note(&format!("the noise of the {sensor_kind} is simulated with that of its noisiest axis"));
    }
    noise.max()
}

/// The same IMU in the frame that its accelerometer's gauge fixes.
pub(super) fn in_gauge(
    drawn: &ImuParameters,
    [a, g]: [ReadingUnit; 2],
    gauge: Gauge,
) -> calibrant::Result<ImuParameters> {
    let imu = CalibratedImu {
        parameters: *drawn,
        accelerometer_unit: Some(a),
        gyroscope_unit: Some(g),
        quantities: Vec::new(),
        covariance: None,
        degrees_of_freedom: None,
        frame: String::new(),
    };
    Ok(imu.in_gauge_of(SensorKind::Accelerometer, gauge)?.parameters)
}

/// The recording of an accelerometer in these steps.
pub(super) fn accelerometer_on_table(
    sensor: &Sensor,
    truth: &SensorParameters,
    holds: &HoldsPlan,
    steps: &[TableStep],
    rng: &mut Rng,
) -> calibrant::Result<Recording> {
    check(steps, holds.rate_hz)?;
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let setup = ImuSimulation {
        rate_hz: holds.rate_hz,
        gravity_mps2: holds.gravity.magnitude_mps2,
        accelerometer_noise: one_for_all(SensorKind::Accelerometer, &noise),
        between_holds_sd_mps2: holds.between_holds_sd_mps2,
        accelerometer_unit: sensor.unit,
        face_sd_rad: holds.face_sd_rad.unwrap_or(0.0),
        ..ImuSimulation::default()
    };
    let nothing = Recording::new(Vec::new(), Vec::new(), 3, sensor.unit)?;
    let imu = ImuParameters { accelerometer: *truth, ..ImuParameters::identity() };
    Ok(simulate_table(&imu, steps, &setup, rng).accelerometer.unwrap_or(nothing))
}

/// The steps on the table, in order of time; `None` where the sensor is turned by hand.
pub(super) fn table(holds: &HoldsPlan, turns: &[Turn]) -> Option<Vec<TableStep>> {
    let (intervals, directions) = (holds.intervals_s.as_ref()?, holds.directions.as_ref()?);
    let faces = intervals.iter().zip(directions).map(|(&(start_s, end_s), &direction)| TableStep {
        start_s,
        end_s,
        action: TableAction::Hold(direction),
    });
    let turns = turns.iter().map(|turn| TableStep {
        start_s: turn.start_s,
        end_s: turn.end_s,
        action: TableAction::Turn {
            axis: turn.axis,
            angle_rad: turn.angle_rad,
            angle_sd_rad: turn.angle_sd_rad,
        },
    });
    let mut steps: Vec<TableStep> = faces.chain(turns).collect();
    steps.sort_by(|one, other| one.start_s.total_cmp(&other.start_s));
    Some(steps)
}

/// Checks the steps of a recording.
fn check(steps: &[TableStep], rate_hz: f64) -> calibrant::Result<()> {
    check_order(steps)?;
    length::check_table(steps, rate_hz)
}

/// Checks that holds and turns follow each other.
fn check_order(steps: &[TableStep]) -> calibrant::Result<()> {
    match steps.windows(2).find(|pair| pair[1].start_s < pair[0].end_s) {
        None => Ok(()),
        Some(pair) => Err(Error::Experiment(Box::new(InputError::new(
            Refusal::HoldsInvalid,
            format!(
                "what begins at {} s begins before what is done until {} s is over",
                pair[1].start_s, pair[0].end_s
            ),
            "holds.intervals_s and gyroscope.turns must not overlap",
        )))),
    }
}

//! The steps of a sensor on a table: faces and turns, as the experiment lists them.

use super::length;
use super::noise::one_for_all;
use super::options::SimulationOptions;
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::Turn;
use calibrant_core::sensor::{ImuParameters, Recording, Sensor, SensorKind, SensorParameters};
use calibrant_core::simulate::{ImuSimulation, Rng, TableAction, TableStep, simulate_table};
use calibrant_io::HoldsPlan;
use nalgebra::Vector3;

/// The recording of an accelerometer in these steps.
pub(super) fn accelerometer_on_table(
    sensor: &Sensor,
    truth: &SensorParameters,
    holds: &HoldsPlan,
    steps: &[TableStep],
    (options, notes): (&SimulationOptions, &mut Vec<Diagnostic>),
    rng: &mut Rng,
) -> Result<Recording> {
    check(steps, holds.rate_hz, options.budget)?;
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let setup = ImuSimulation {
        rate_hz: holds.rate_hz,
        gravity_mps2: holds.gravity()?.magnitude_mps2,
        accelerometer_noise: one_for_all(SensorKind::Accelerometer, &noise, notes),
        between_holds_sd_mps2: holds.between_holds_sd_mps2,
        accelerometer_unit: sensor.unit,
        face_sd_rad: holds.face_sd_rad().unwrap_or(0.0),
        ..ImuSimulation::default()
    };
    let nothing = Recording::new(Vec::new(), Vec::new(), 3, sensor.unit)?;
    let imu = ImuParameters::identity().with(SensorKind::Accelerometer, *truth);
    Ok(simulate_table(&imu, steps, &setup, rng)[SensorKind::Accelerometer].clone().unwrap_or(nothing))
}

/// The sensor is on its way from one face to the next for so long, s, where no times are given.
const MOVES_S: f64 = 2.0;

/// The steps on the table, in order of time; `None` where the sensor is turned by hand. Without times one face follows the other.
pub(super) fn table(holds: &HoldsPlan, turns: &[Turn]) -> Option<Vec<TableStep>> {
    let directions = holds.directions()?;
    let intervals = match &holds.intervals_s {
        Some(given) => given.clone(),
        None if turns.is_empty() => {
            let start_s = |k: usize| 1.0 + k as f64 * (holds.hold_s + MOVES_S);
            (0..directions.len()).map(|k| (start_s(k), start_s(k) + holds.hold_s)).collect()
        }
        None => return None,
    };
    let faces = intervals.into_iter().zip(directions).map(|((start_s, end_s), direction)| TableStep {
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
            axis_sd_rad: turn.axis_sd_rad,
        },
    });
    let mut steps: Vec<TableStep> = faces.chain(turns).collect();
    steps.sort_by(|one, other| one.start_s.total_cmp(&other.start_s));
    Some(steps)
}

/// Checks the steps of a recording.
pub(super) fn check(steps: &[TableStep], rate_hz: f64, budget: Budget) -> Result<()> {
    check_order(steps)?;
    length::check_table(steps, rate_hz, budget)
}

/// Checks that holds and turns follow each other.
fn check_order(steps: &[TableStep]) -> Result<()> {
    match steps.windows(2).find(|pair| pair[1].start_s < pair[0].end_s) {
        None => Ok(()),
        Some(pair) => Err(Error::experiment(InputError::new(
            Refusal::HoldsInvalid,
            format!(
                "what begins at {} s begins before what is done until {} s is over",
                pair[1].start_s, pair[0].end_s
            ),
            "holds.intervals_s and gyroscope.turns must not overlap",
        ))),
    }
}

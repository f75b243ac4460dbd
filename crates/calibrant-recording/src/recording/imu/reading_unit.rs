//! The unit of a sensor's readings: stated by the file or given by the user. It is refused where gravity
//! contradicts it.

use super::column::ColumnMeaning;
use super::file_layout::Draft;
use super::options::ImuReadOptions;
use super::sensitivity::{STANDARD_GRAVITY_MPS2, Sensitivity};
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::row_parser::Sense;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_core::number_format::plain;
use calibrant_core::sensor::{Axis, Recording, SensorKind};
use nalgebra::Vector3;

/// A gyroscope that reads faster rates than this is most likely not in rad/s.
const FAST_RADPS: f64 = 40.0;
/// A gyroscope that reads faster rates than this in deg/s is not in deg/s either.
const FAST_DEGPS: f64 = 8000.0;
/// No gyroscope has a range beyond this, rad/s: 57 300 deg/s.
const FASTEST_RADPS: f64 = 1000.0;
/// Whole numbers larger than this are most likely counts.
const COUNTS: f64 = 2500.0;
/// Gravity was removed from a sensor that reads less than this, m/s², half of the time.
const NO_GRAVITY_MPS2: f64 = 3.0;
/// Magnitudes of a sensor that mostly rests, g; the ranges of a sensor differ by a factor of two.
const ONE_AT_REST: std::ops::RangeInclusive<f64> = 0.7..=1.4;
/// Magnitudes that are 1 within this share are in g.
const ONE: f64 = 0.15;

/// The unit of a sensor's columns: from the file; from the user where the file is a container, of which some state what they do not hold; else from the user; else the usual one of a plain text, or
/// counts, if the options allow it; else `None`.
pub(super) fn stated_unit(
    draft: &Draft,
    options: &ImuReadOptions,
    sensor_kind: SensorKind,
) -> Checked<Option<ImuUnit>> {
    let columns: Vec<_> = Axis::ALL
        .iter()
        .filter_map(|&axis| draft.column(ColumnMeaning::Reading(sensor_kind, axis)))
        .collect();
    let unit = |k: usize| match columns[k].unit {
        Some(ColumnUnit::Reading(unit)) => Some(unit),
        _ => None,
    };
    let symbol = |unit: Option<ImuUnit>| unit.map_or("no stated unit", ImuUnit::symbol);
    if let Some(other) = (1..columns.len()).find(|&k| unit(k) != unit(0)) {
        let message = format!(
            "the axes of the {sensor_kind} have different units: `{}` has {}, `{}` has {}",
            columns[0].name,
            symbol(unit(0)),
            columns[other].name,
            symbol(unit(other))
        );
        return Err(contradiction(draft, message, "all axes need the same".into()));
    }
    let stated = if columns.is_empty() { None } else { unit(0) };
    let given = options.unit(sensor_kind);
    if let Some(given) = given.filter(|given| !given.suits(sensor_kind)) {
        let message = format!("{} is no unit of the {sensor_kind}", given.symbol());
        return refuse(Refusal::UnitContradicted, message, format!("say {}", ImuUnit::choices(sensor_kind)));
    }
    match (stated, given) {
        // a sensitivity is that of counts
        (Some(ImuUnit::Counts), Some(given)) if given.sensitivity().is_some() => Ok(Some(given)),
        (Some(stated), Some(given)) if given.sensitivity().is_some() => Ok(Some(stated)),
        (Some(stated), Some(given)) if stated != given && !draft.format.is_text() => Ok(Some(given)),
        (Some(stated), Some(given)) if stated != given => {
            let message = format!(
                "the {sensor_kind}'s columns are in {}, but the unit was given as {}",
                stated.symbol(),
                given.symbol()
            );
            let option = match options.accelerometer_only {
                Some(_) => TaskOption::Unit.to_string(),
                None => format!("{} (or {})", unit_option(sensor_kind), TaskOption::Unit),
            };
            let help = format!(
                "leave {option} away: the file decides (name the columns in [columns] to overrule it)"
            );
            Err(contradiction(draft, message, help))
        }
        (stated, given) => {
            let usual = draft.plain.map(|only| ImuUnit::from(only.unit));
            let agreed = options.counts_unless_stated[sensor_kind as usize].then_some(ImuUnit::Counts);
            Ok(stated.or(given).or(usual).or(agreed))
        }
    }
}

/// The option that gives the unit of this sensor.
pub(super) fn unit_option(sensor_kind: SensorKind) -> TaskOption {
    match sensor_kind {
        SensorKind::Accelerometer => TaskOption::AccelerometerUnit,
        SensorKind::Gyroscope => TaskOption::GyroscopeUnit,
    }
}

/// The error for a header that contradicts itself or the user.
fn contradiction(draft: &Draft, message: String, help: String) -> Box<InputError> {
    InputError { line: draft.line, ..InputError::new(Refusal::UnitContradicted, message, help) }.into()
}

/// What whole numbers suggest.
pub(super) const COUNTS_HINT: &str = "suggest counts";

/// The question where the unit is not known, with what the readings suggest.
pub(super) fn question(sensor_kind: SensorKind, readings: &[Vector3<f64>]) -> String {
    let largest = readings.iter().map(|y| y.amax()).fold(0.0, f64::max);
    let whole = readings.iter().all(|y| y.iter().all(|value| value.fract() == 0.0));
    let median = median_magnitude(readings);
    let hint = match sensor_kind {
        _ if whole && largest > COUNTS => COUNTS_HINT,
        SensorKind::Gyroscope if largest > FAST_DEGPS => "suggest mdps",
        SensorKind::Gyroscope if largest > FAST_RADPS => "suggest deg/s",
        SensorKind::Gyroscope => "may be rad/s, or deg/s of slow turns",
        SensorKind::Accelerometer if (9.0..=10.6).contains(&median) => "suggest m/s²",
        SensorKind::Accelerometer if (1.0 - ONE..=1.0 + ONE).contains(&median) => "suggest g",
        SensorKind::Accelerometer if (1e3 * (1.0 - ONE)..=1e3 * (1.0 + ONE)).contains(&median) => {
            "suggest mg"
        }
        SensorKind::Accelerometer if (9e3..=10.6e3).contains(&median) => "suggest mm/s²",
        SensorKind::Accelerometer => "do not tell",
    };
    let of = match sensor_kind {
        SensorKind::Accelerometer => format!("magnitudes around {}", plain(round(median), 6)),
        SensorKind::Gyroscope => format!("magnitudes up to {}", plain(round(largest), 6)),
    };
    format!("the {sensor_kind}'s columns have no unit: {of} {hint}")
}

/// Three significant digits.
fn round(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

fn median_magnitude(readings: &[Vector3<f64>]) -> f64 {
    let mut magnitudes: Vec<f64> = readings.iter().map(|y| y.norm()).collect();
    let middle = magnitudes.len() / 2;
    if magnitudes.is_empty() { 0.0 } else { *magnitudes.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Returns an error for an accelerometer in m/s² that does not read gravity: its readings are in g, or
/// gravity was removed.
pub(super) fn check_gravity(recording: &Recording, stated: ImuUnit) -> Checked<()> {
    if stated == ImuUnit::Counts {
        return Ok(());
    }
    let factor = stated.reading().1;
    let median = median_magnitude(recording.readings());
    if let Some(sensitivity) = stated.sensitivity() {
        return check_sensitivity(sensitivity, median / STANDARD_GRAVITY_MPS2);
    }
    let (shown, unit) = (plain(round(median / factor), 6), stated.symbol());
    if stated == ImuUnit::MetrePerSecondSquared && (median - 1.0).abs() <= ONE {
        let near = |y: &Vector3<f64>| (y.norm() - 1.0).abs() <= ONE;
        let share = recording.readings().iter().filter(|y| near(y)).count() as f64 / recording.len() as f64;
        if share > 0.7 {
            return refuse(
                Refusal::UnitImplausible,
                format!(
                    "the accelerometer is said to be in {unit}, but its magnitude is {shown} most of the time: is it in g?"
                ),
                "give the unit g; in a text a column's name may end in _g, or accelerometer_unit = \"g\" stands in [columns] beside the names of the columns",
            );
        }
    }
    if median < NO_GRAVITY_MPS2 {
        return refuse(
            Refusal::GravityRemoved,
            format!(
                "gravity has been removed from the accelerometer: its magnitude is {shown} {unit} half of the time or less"
            ),
            "export the sensor's own readings; is it really an acceleration, in the unit that is stated?",
        );
    }
    check_size(recording, stated)
}

/// Returns an error for an accelerometer in a physical unit whose readings are larger than any has.
pub(super) fn check_size(recording: &Recording, stated: ImuUnit) -> Checked<()> {
    let median = median_magnitude(recording.readings());
    if stated == ImuUnit::Counts || median <= 100.0 * STANDARD_GRAVITY_MPS2 {
        return Ok(());
    }
    let (shown, unit) = (plain(round(median / stated.reading().1), 6), stated.symbol());
    refuse(
        Refusal::UnitImplausible,
        format!(
            "the accelerometer is said to be in {unit}, but its magnitude is {shown} half of the time or more: is it in mg, or are these counts?"
        ),
        "correct the unit: accelerometer_unit = \"mg\" in [columns], or accelerometer_lsb_per_g for counts of a known sensitivity; for counts of an unknown \
         one, see `calibrant init --list`",
    )
}

/// Returns an error for readings, made of counts by this sensitivity, that no sensor of it shows: it is that of another range, or they were no counts.
///
/// # Errors
/// [`Error::Recording`] with the sensitivity that would fit.
pub fn check_counts(recording: &Recording, sensitivity: Sensitivity) -> Result<()> {
    let unit = ImuUnit::CountsOf(sensitivity);
    let checked = match sensitivity.sensor_kind() {
        SensorKind::Accelerometer => check_gravity(recording, unit),
        SensorKind::Gyroscope => check_rates(recording, unit),
    };
    checked.map_err(Error::Recording)
}

/// Returns an error for a sensitivity by which the accelerometer shows another gravity: most are those of another range.
fn check_sensitivity(sensitivity: Sensitivity, median_g: f64) -> Checked<()> {
    if ONE_AT_REST.contains(&median_g) {
        return Ok(());
    }
    let message = format!(
        "with {sensitivity} the accelerometer's magnitude is {} g half of the time",
        plain(round(median_g), 6)
    );
    let help = format!(
        "give the sensitivity of the range in which it was recorded: near {} the magnitude is 1 g",
        sensitivity.times(median_g)
    );
    refuse(Refusal::UnitImplausible, message, help)
}

/// Returns an error for a gyroscope in rad/s that reads faster rates than any has, in more samples than a few bad ones.
pub(super) fn check_rates(recording: &Recording, stated: ImuUnit) -> Checked<()> {
    if stated == ImuUnit::Counts {
        return Ok(());
    }
    let is_beyond = |y: &&Vector3<f64>| y.norm() > FASTEST_RADPS;
    let beyond = recording.readings().iter().filter(is_beyond).count();
    if beyond < 2 || !Sense::is_lost(beyond, recording.len()) {
        return Ok(());
    }
    let (unit, most) = (stated.symbol(), FASTEST_RADPS / stated.reading().1);
    let message = format!(
        "the gyroscope is said to be in {unit}, but {beyond} of its {} readings are beyond {} {unit}, which no gyroscope measures: are these counts, or in another unit?",
        recording.len(),
        plain(round(most), 6)
    );
    let help = "correct the unit: a column's name may end in _degps, _mdps or _counts, and gyroscope_unit in [columns] counts where the columns are named there";
    refuse(Refusal::UnitImplausible, message, help)
}

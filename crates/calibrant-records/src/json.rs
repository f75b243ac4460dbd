//! Records, histories and the fleet as JSON.

use super::aging::{QuantityAging, SensorChange, SensorDrift, SensorHistory};
use super::database::KeptRecord;
use super::fleet::{Fleet, FleetParameter, LeftOut};
use calibrant_core::form::finite;
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_core::sensor::{Gauge, ImuFields};
use calibrant_io::{Heading, SCHEMA};
use schemars::JsonSchema;
use serde::Serialize;

json_object! {
    /// A record without its parameters.
    KeptRecord as kept {
        /// Its number in the database.
        id: kept.id,
        sensor: &kept.record.sensor,
        /// When the recording was made, UTC.
        recorded: kept.record.recorded.map(|time| time.to_string()),
        station: kept.record.station.as_deref(),
        /// When it was entered, UTC.
        inserted: kept.inserted.to_string(),
        /// What the sensor was compared with: `motion`, `holds` or `machine`.
        plan: &kept.record.plan,
        experiment: kept.record.experiment.as_ref(),
        motion_file: kept.record.motion_file.as_ref(),
        recordings: &kept.record.recordings,
        verdict: Verdict { usability: kept.record.verdict.name(), codes: &kept.record.codes },
        /// How the estimation ended.
        status: &kept.record.status,
        /// The program that calibrated, with its version.
        program: &kept.record.program,
    }
}

/// May it be used, and which diagnostics decide it? Codes may be those of another version.
#[derive(Serialize, JsonSchema)]
struct Verdict<'a> {
    usability: &'static str,
    codes: &'a [String],
}

/// A record as calibrant JSON, which [`read_calibrated_imu`](calibrant_io::read_calibrated_imu) reads.
#[derive(Debug, Clone, Copy)]
pub struct RecordFile<'a>(pub &'a KeptRecord);

json_object! {
    /// A record with its parameters: a calibration.
    RecordFile<'_> as file {
        schema: SCHEMA,
        kind: "calibration",
        record: flat(file.0),
        imu: flat(ImuFields::of(file.0.record.imu.clone())),
    }
}

json_object! {
    /// What changed between two calibrations.
    SensorChange as change {
        /// The number of the earlier.
        from: change.from,
        /// The number of the later.
        to: change.to,
        /// All parameters together.
        overall: change.comparison.overall,
        quantities: &change.comparison.quantities,
    }
}

json_object! {
    /// The aging of one quantity.
    QuantityAging as of {
        name: of.invariant.name(),
        unit: of.unit,
        per_year: of.aging.per_year,
        per_year_sd: of.aging.sd,
        /// None for two values.
        birge_ratio: of.aging.birge_ratio,
        chi2: of.aging.chi2,
        degrees_of_freedom: of.aging.degrees_of_freedom,
        fit_p_value: of.aging.fit_p_value,
        /// Degrees of freedom behind the standard deviation; none where it is known.
        degrees_behind: finite(of.aging.degrees_behind),
        p_value: of.aging.p_value,
    }
}

json_object! {
    /// The history of a sensor. Angles are in rad.
    SensorHistory as history {
        heading: flat(Heading::of("history")),
        sensor: &history.sensor,
        /// In the order of their dates, one for each recording.
        calibrations: &history.calibrations,
        changes: &history.changes,
        /// Number of calibrations behind the aging.
        aging_from: history.aging_from,
        aging: &history.aging,
    }
}

json_object! {
    /// How one of several sensors drifts.
    SensorDrift as drift {
        sensor: &drift.sensor,
        /// Number of its recordings.
        calibrations: drift.calibrations,
        first: drift.dates.map(|[first, _]| first.to_string()),
        last: drift.dates.map(|[_, last]| last.to_string()),
        /// The last change of all parameters together.
        last_change: drift.last_change,
        /// The quantity whose aging is the most significant.
        largest_aging: drift.largest_aging,
        aging_p_value: drift.aging_p_value,
    }
}

json_object! {
    /// The parameters over all sensors.
    Fleet as fleet {
        heading: flat(Heading::of("fleet")),
        gauge: fleet.gauge.map(Gauge::name),
        reference_c: fleet.reference_c,
        /// Number of sensors that do not follow temperature, where others do.
        without_temperature: fleet.without_temperature,
        parameters: &fleet.parameters,
        left_out: &fleet.left_out,
    }
}

json_object! {
    /// A sensor that is not compared with the others.
    LeftOut as one {
        sensor: &one.sensor,
        id: one.id,
        reason: &one.reason,
    }
}

json_object! {
    /// A parameter over all sensors.
    FleetParameter as parameter {
        name: &parameter.name,
        unit: parameter.unit,
        sensors: parameter.values.count,
        mean: parameter.values.mean,
        /// From sensor to sensor.
        sd: parameter.values.sd,
        least: parameter.values.quantiles[0],
        quantile_05: parameter.values.quantiles[1],
        median: parameter.values.quantiles[2],
        quantile_95: parameter.values.quantiles[3],
        greatest: parameter.values.quantiles[4],
        /// Root mean square of the standard deviations of the calibrations.
        calibration_sd: parameter.calibration_sd,
        farthest: parameter.farthest.iter().map(|(sensor, value, in_robust_sd)| Farthest { sensor, value: *value, in_robust_sd: *in_robust_sd }).collect::<Vec<_>>(),
    }
}

/// A sensor that is far from the median.
#[derive(Serialize, JsonSchema)]
struct Farthest<'a> {
    sensor: &'a str,
    value: f64,
    in_robust_sd: f64,
}

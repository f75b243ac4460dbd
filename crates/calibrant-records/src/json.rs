//! Records, histories and the fleet as JSON.

use super::aging::{QuantityAging, SensorChange, SensorDrift, SensorHistory};
use super::database::KeptRecord;
use super::fleet::{Fleet, FleetParameter, LeftOut};
use calibrant_core::estimate::OverallDifference;
use calibrant_core::sensor::{Gauge, ImuFields};
use calibrant_io::{HashedFile, SCHEMA, UtcTime, to_json};
use serde::Serialize;

#[derive(Serialize)]
struct RecordFields<'a> {
    id: i64,
    sensor: &'a str,
    recorded: Option<UtcTime>,
    station: Option<&'a str>,
    inserted: UtcTime,
    plan: &'a str,
    experiment: Option<&'a HashedFile>,
    motion_file: Option<&'a HashedFile>,
    recordings: &'a [HashedFile],
    verdict: VerdictFields<'a>,
    status: &'a str,
}

#[derive(Serialize)]
struct VerdictFields<'a> {
    usability: &'static str,
    codes: &'a [String],
}

impl<'a> RecordFields<'a> {
    fn of(kept: &'a KeptRecord) -> Self {
        let record = &kept.record;
        Self {
            id: kept.id,
            sensor: &record.sensor,
            recorded: record.recorded,
            station: record.station.as_deref(),
            inserted: kept.inserted,
            plan: &record.plan,
            experiment: record.experiment.as_ref(),
            motion_file: record.motion_file.as_ref(),
            recordings: &record.recordings,
            verdict: VerdictFields { usability: record.verdict.name(), codes: &record.codes },
            status: &record.status,
        }
    }
}

#[derive(Serialize)]
struct ListedFields<'a> {
    #[serde(flatten)]
    record: RecordFields<'a>,
    program: &'a str,
}

/// Records as a JSON array, without their parameters.
#[must_use]
pub fn records_json(records: &[KeptRecord]) -> String {
    let fields = |kept| ListedFields { record: RecordFields::of(kept), program: &kept.record.program };
    to_json(&records.iter().map(fields).collect::<Vec<_>>())
}

#[derive(Serialize)]
struct CalibrationFields<'a> {
    schema: u32,
    kind: &'static str,
    program: &'a str,
    #[serde(flatten)]
    record: RecordFields<'a>,
    #[serde(flatten)]
    core: ImuFields,
}

/// A record as calibrant JSON of schema 2, which [`read_calibrated_imu`](calibrant_io::read_calibrated_imu) reads.
#[must_use]
pub fn record_json(kept: &KeptRecord) -> String {
    to_json(&CalibrationFields {
        schema: SCHEMA,
        kind: "calibration",
        program: &kept.record.program,
        record: RecordFields::of(kept),
        core: ImuFields::of(kept.record.imu.clone()),
    })
}

#[derive(Serialize)]
struct ChangeFields {
    from: i64,
    to: i64,
    overall: Option<OverallFields>,
    quantities: Vec<ChangedFields>,
}

#[derive(Serialize)]
struct OverallFields {
    chi2: f64,
    degrees_of_freedom: usize,
    p_value: f64,
}

#[derive(Serialize)]
struct ChangedFields {
    name: String,
    unit: &'static str,
    difference: Option<f64>,
    difference_sd: Option<f64>,
    difference_in_sd: Option<f64>,
    p_value: Option<f64>,
}

#[derive(Serialize)]
struct AgingFields {
    name: String,
    unit: &'static str,
    per_year: f64,
    per_year_sd: f64,
    birge_ratio: Option<f64>,
    chi2: f64,
    degrees_of_freedom: usize,
    fit_p_value: Option<f64>,
    /// JSON has `null` where it is infinite.
    degrees_behind: f64,
    p_value: f64,
}

impl From<OverallDifference> for OverallFields {
    fn from(overall: OverallDifference) -> Self {
        let OverallDifference { chi2, degrees_of_freedom, p_value, .. } = overall;
        Self { chi2, degrees_of_freedom, p_value }
    }
}

impl From<&SensorChange> for ChangeFields {
    fn from(change: &SensorChange) -> Self {
        let quantities = change.comparison.quantities.iter().map(|quantity| ChangedFields {
            name: quantity.invariant.name(),
            unit: quantity.unit_b,
            difference: quantity.difference,
            difference_sd: quantity.sd,
            difference_in_sd: quantity.in_sd,
            p_value: quantity.p_value,
        });
        Self {
            from: change.from,
            to: change.to,
            overall: change.comparison.overall.map(OverallFields::from),
            quantities: quantities.collect(),
        }
    }
}

impl From<&QuantityAging> for AgingFields {
    fn from(QuantityAging { invariant, unit, aging }: &QuantityAging) -> Self {
        Self {
            name: invariant.name(),
            unit,
            per_year: aging.per_year,
            per_year_sd: aging.sd,
            birge_ratio: aging.birge_ratio,
            chi2: aging.chi2,
            degrees_of_freedom: aging.degrees_of_freedom,
            fit_p_value: aging.fit_p_value,
            degrees_behind: aging.degrees_behind,
            p_value: aging.p_value,
        }
    }
}

#[derive(Serialize)]
struct HistoryFields<'a> {
    schema: u32,
    sensor: &'a str,
    calibrations: Vec<RecordFields<'a>>,
    changes: Vec<ChangeFields>,
    aging_from: usize,
    aging: Vec<AgingFields>,
}

/// The history of a sensor as JSON. Angles are in rad.
#[must_use]
pub fn history_json(history: &SensorHistory) -> String {
    to_json(&HistoryFields {
        schema: 1,
        sensor: &history.sensor,
        calibrations: history.calibrations.iter().map(RecordFields::of).collect(),
        changes: history.changes.iter().map(ChangeFields::from).collect(),
        aging_from: history.aging_from,
        aging: history.aging.iter().map(AgingFields::from).collect(),
    })
}

#[derive(Serialize)]
struct DriftFields<'a> {
    sensor: &'a str,
    calibrations: usize,
    first: Option<UtcTime>,
    last: Option<UtcTime>,
    last_change: Option<OverallFields>,
    largest_aging: Option<AgingFields>,
    aging_p_value: Option<f64>,
}

/// The drifts of sensors as a JSON array.
#[must_use]
pub fn drifts_json(drifts: &[SensorDrift]) -> String {
    to_json(&drifts.iter().map(DriftFields::from).collect::<Vec<_>>())
}

impl<'a> From<&'a SensorDrift> for DriftFields<'a> {
    fn from(drift: &'a SensorDrift) -> Self {
        let SensorDrift { sensor, calibrations, dates, last_change, largest_aging, aging_p_value } = drift;
        Self {
            sensor,
            calibrations: *calibrations,
            first: dates.map(|[first, _]| first),
            last: dates.map(|[_, last]| last),
            last_change: last_change.map(OverallFields::from),
            largest_aging: largest_aging.as_ref().map(AgingFields::from),
            aging_p_value: *aging_p_value,
        }
    }
}

#[derive(Serialize)]
struct FleetFields<'a> {
    schema: u32,
    gauge: Option<&'static str>,
    reference_c: Option<f64>,
    without_temperature: usize,
    parameters: Vec<FleetParameterFields<'a>>,
    left_out: Vec<LeftOutFields<'a>>,
}

#[derive(Serialize)]
struct LeftOutFields<'a> {
    sensor: &'a str,
    id: i64,
    reason: &'a str,
}

#[derive(Serialize)]
struct FleetParameterFields<'a> {
    name: &'a str,
    unit: &'a str,
    sensors: usize,
    mean: f64,
    sd: f64,
    least: f64,
    quantile_05: f64,
    median: f64,
    quantile_95: f64,
    greatest: f64,
    calibration_sd: Option<f64>,
    farthest: Vec<FarthestFields<'a>>,
}

#[derive(Serialize)]
struct FarthestFields<'a> {
    sensor: &'a str,
    value: f64,
    in_robust_sd: f64,
}

/// The parameters over all sensors as JSON, and the sensors that were left out.
#[must_use]
pub fn fleet_json(fleet: &Fleet) -> String {
    to_json(&FleetFields {
        schema: 1,
        gauge: fleet.gauge.map(Gauge::name),
        reference_c: fleet.reference_c,
        without_temperature: fleet.without_temperature,
        parameters: fleet.parameters.iter().map(FleetParameterFields::from).collect(),
        left_out: fleet.left_out.iter().map(LeftOutFields::from).collect(),
    })
}

impl<'a> From<&'a FleetParameter> for FleetParameterFields<'a> {
    fn from(parameter: &'a FleetParameter) -> Self {
        let FleetParameter { name, unit, values, calibration_sd, farthest } = parameter;
        let [least, quantile_05, median, quantile_95, greatest] = values.quantiles;
        let farthest = farthest.iter().map(|(sensor, value, distance)| FarthestFields {
            sensor,
            value: *value,
            in_robust_sd: *distance,
        });
        Self {
            name,
            unit,
            sensors: values.count,
            mean: values.mean,
            sd: values.sd,
            least,
            quantile_05,
            median,
            quantile_95,
            greatest,
            calibration_sd: *calibration_sd,
            farthest: farthest.collect(),
        }
    }
}

impl<'a> From<&'a LeftOut> for LeftOutFields<'a> {
    fn from(LeftOut { sensor, id, reason }: &'a LeftOut) -> Self {
        Self { sensor, id: *id, reason }
    }
}

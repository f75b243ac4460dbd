//! Inspection of a recording before its calibration: what it contains and what to expect of it, as data and
//! as JSON.

use super::json;
use super::recording::{ImuColumn, ImuFile};
use super::sampling::{Sampling, SamplingFields};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::holds::HoldsLostToFilter;
use calibrant_core::error::Result;
use calibrant_core::estimate::{
    CoarseAxis, Coverage, ExpectedCalibration, clipped_holds, coarse_axes_in, coverage, expected_calibration,
    find_clean_imu_holds, holds_lost_to_filter, swapped_sensors,
};
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{
    Gauge, ImuRecording, MeanReading, ReadingUnit, Recording, Saturation, SensorKind, Spikes,
};
use nalgebra::Vector3;
use serde::Serialize;

/// Gravity that is assumed, m/s²: the location changes a prediction by less than one per cent.
const GRAVITY_MPS2: f64 = 9.806_65;
/// Shortest stationary interval that counts as a hold, s.
const MINIMUM_HOLD_S: f64 = 1.0;

/// The content of a recording.
#[derive(Debug, Clone)]
pub struct Inspection {
    /// Each sensor that is there.
    pub sensors: Vec<SensorInspection>,
    /// Spikes and invalid samples of a sensor. The search for holds does not use them.
    pub spikes: Vec<(SensorKind, Spikes)>,
    /// The holds of the accelerometer. `None` without an accelerometer; the reason where the search was
    /// impossible.
    pub holds: Option<std::result::Result<HoldsInspection, String>>,
}

/// Sampling and values of one sensor.
#[derive(Debug, Clone)]
pub struct SensorInspection {
    /// Which sensor.
    pub sensor_kind: SensorKind,
    /// Unit of its readings, after the conversion.
    pub unit: ReadingUnit,
    /// Its sample times.
    pub sampling: Sampling,
    /// Least, mean and largest reading per axis.
    pub least: Vector3<f64>,
    /// Mean reading per axis.
    pub mean: Vector3<f64>,
    /// Largest reading per axis.
    pub most: Vector3<f64>,
}

/// The holds of a recording and their use for a calibration.
#[derive(Debug, Clone)]
pub struct HoldsInspection {
    /// The holds, in order of time.
    pub holds: Vec<Hold>,
    /// The end of its range at which the accelerometer stops in each hold, where it does: such a hold is not
    /// used.
    pub clipped: Vec<Option<Saturation>>,
    /// The coverage of the sphere by their directions. `None` where there is no hold, or no direction is
    /// known without the sensor's offset.
    pub coverage: Option<Coverage>,
    /// The parameters of the accelerometer that they will determine, or the reason why they do not determine
    /// all of them.
    pub expected: std::result::Result<ExpectedCalibration, String>,
    /// The reason, in words, why there may be fewer holds than there should be: a filter that breaks them up,
    /// or swapped sensors.
    pub lost: Option<String>,
    /// Axes with a quantisation step coarser than their noise.
    pub coarse: Vec<(SensorKind, CoarseAxis)>,
    /// Mean of the gyroscope over the holds and scatter of its samples within them, unit of its readings.
    pub gyroscope_at_rest: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// Examines a recording: sampling, ranges, holds, coverage, expected quality.
///
/// # Examples
/// ```
/// use calibrant_io::{ImuReadOptions, inspect, parse_imu_recording};
/// let file = parse_imu_recording(b"t_s,gx_radps,gy_radps,gz_radps\n0,0,1,2\n0.01,1,1,2.5\n0.02,2,4,3\n", &ImuReadOptions::default())?;
/// let inspection = inspect(&file);
/// assert_eq!(inspection.sensors[0].mean.y, 2.0);
/// assert!(inspection.holds.is_none(), "there is no accelerometer");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn inspect(file: &ImuFile) -> Inspection {
    let recording = &file.recording;
    let sensors = SensorKind::ALL
        .into_iter()
        .filter_map(|sensor_kind| Some(SensorInspection::of(sensor_kind, recording.sensor(sensor_kind)?)))
        .collect();
    let (clean, spikes) = recording.without_spikes();
    let holds = clean
        .accelerometer
        .as_ref()
        .map(|accelerometer| HoldsInspection::of(&clean, accelerometer).map_err(|error| error.to_string()));
    Inspection { sensors, spikes, holds }
}

impl SensorInspection {
    fn of(sensor_kind: SensorKind, recording: &Recording) -> Self {
        let readings = recording.readings();
        let [least, most] = recording.extremes();
        Self {
            sensor_kind,
            unit: recording.unit(),
            sampling: Sampling::of(recording.times_s()),
            least,
            mean: readings.iter().sum::<Vector3<f64>>() / readings.len() as f64,
            most,
        }
    }
}

impl HoldsInspection {
    fn of(recording: &ImuRecording, accelerometer: &Recording) -> Result<Self> {
        let holds = find_clean_imu_holds(recording, MINIMUM_HOLD_S)?;
        let clipped = clipped_holds(accelerometer, &holds);
        let sound: Vec<Hold> = holds
            .iter()
            .zip(&clipped)
            .filter(|(_, end)| end.is_none())
            .map(|(hold, _)| hold.clone())
            .collect();
        let expected = expected_calibration(&sound, accelerometer.unit(), GRAVITY_MPS2, Gauge::Upper)
            .map_err(|error| error.to_string());
        let offset = match &expected {
            Ok(expected) => Some(expected.like.bias),
            // readings in counts have an offset that is unknown without the calibration
            Err(_) => (accelerometer.unit() != ReadingUnit::Counts).then(Vector3::zeros),
        };
        let directions = offset.map(|offset| sound.iter().map(|hold| hold.mean - offset).collect::<Vec<_>>());
        Ok(Self {
            coverage: directions.and_then(|directions| coverage(&directions)),
            gyroscope_at_rest: recording.gyroscope.as_ref().and_then(|gyroscope| at_rest(gyroscope, &holds)),
            lost: match &expected {
                Err(_) => swapped_sensors(recording, MINIMUM_HOLD_S).map(str::to_owned),
                Ok(_) => None,
            }
            .or_else(|| {
                holds_lost_to_filter(accelerometer, &holds, MINIMUM_HOLD_S)
                    .map(|lost| Diagnostic::from(HoldsLostToFilter { lost }).message().to_owned())
            }),
            coarse: SensorKind::ALL
                .into_iter()
                .flat_map(|sensor_kind| coarse(recording, sensor_kind, &sound))
                .collect(),
            expected,
            clipped,
            holds,
        })
    }
}

/// The coarse axes of a sensor, by its samples in holds.
fn coarse(
    recording: &ImuRecording,
    sensor_kind: SensorKind,
    holds: &[Hold],
) -> Vec<(SensorKind, CoarseAxis)> {
    let Some(recording) = recording.sensor(sensor_kind) else { return Vec::new() };
    coarse_axes_in(recording, holds).into_iter().map(|found| (sensor_kind, found)).collect()
}

/// Mean of a sensor over the holds, and the scatter of its samples within them.
fn at_rest(recording: &Recording, holds: &[Hold]) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let of_holds = holds.iter().filter_map(|hold| recording.mean_between(hold.start_s, hold.end_s));
    let stills: Vec<MeanReading> = of_holds.filter(|still| still.samples > 1).collect();
    let sum: Vector3<f64> = stills.iter().map(|still| still.mean * still.samples as f64).sum();
    let samples: usize = stills.iter().map(|still| still.samples).sum();
    (samples > 0).then(|| (sum / samples as f64, MeanReading::pooled_sd(&stills)))
}

/// The text of `calibrant inspect --json`.
#[must_use]
pub fn inspection_json(file: &ImuFile, inspection: &Inspection) -> String {
    json::to_json(&InspectionFile::of(file, inspection))
}

#[derive(Serialize)]
struct InspectionFile<'a> {
    schema: u32,
    format: &'static str,
    /// The hash of each file, with spaces between.
    sha256: String,
    rows: usize,
    /// The gyroscope's file of a pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    second_file: Option<SecondFields>,
    columns: Vec<ColumnFields<'a>>,
    findings: Vec<String>,
    sensors: Vec<SensorFields>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[serde(rename = "sparks")]
    spikes: Vec<SpikesFields>,
    temperature_c: Option<[f64; 2]>,
    holds: Option<HoldsFields<'a>>,
    no_holds_because: Option<&'a str>,
}

#[derive(Serialize)]
struct ColumnFields<'a> {
    name: &'a str,
    meaning: String,
    unit: Option<&'static str>,
    used: bool,
    not_used_because: Option<&'a str>,
}

#[derive(Serialize)]
struct SensorFields {
    sensor: &'static str,
    unit: &'static str,
    #[serde(flatten)]
    sampling: SamplingFields,
    least: Vec<f64>,
    mean: Vec<f64>,
    most: Vec<f64>,
}

/// The gyroscope's file of a pair; `columns` is the number of its columns, which come last.
#[derive(Serialize)]
struct SecondFields {
    format: &'static str,
    rows: usize,
    columns: usize,
}

/// Samples that were removed, and the one that is farthest off.
#[derive(Serialize)]
struct SpikesFields {
    sensor: &'static str,
    samples: usize,
    cut_samples: usize,
    axis: String,
    time_s: f64,
    reading: f64,
}

#[derive(Serialize)]
struct HoldsFields<'a> {
    count: usize,
    minimum_hold_s: f64,
    table: Vec<HoldFields>,
    largest_gap_deg: Option<f64>,
    emptiest_direction: Option<Vec<f64>>,
    gyroscope_mean: Option<Vec<f64>>,
    gyroscope_noise: Option<Vec<f64>>,
    coarse_axes: Vec<CoarseFields>,
    expected: Option<ExpectedFields>,
    not_determined_because: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lost: Option<&'a str>,
}

/// An axis whose quantisation step is coarser than its noise, in the unit of the readings.
#[derive(Serialize)]
struct CoarseFields {
    sensor: &'static str,
    axis: String,
    step: f64,
    noise: f64,
    mean_sd: f64,
}

#[derive(Serialize)]
struct HoldFields {
    start_s: f64,
    end_s: f64,
    samples: usize,
    mean: Vec<f64>,
    sd: Vec<f64>,
    saturated_axis: Option<String>,
}

#[derive(Serialize)]
struct ExpectedFields {
    gauge: &'static str,
    gravity_mps2: f64,
    noise: Vec<f64>,
    condition_number: f64,
    parameters: Vec<ExpectedParameter>,
}

#[derive(Serialize)]
struct ExpectedParameter {
    name: String,
    unit: &'static str,
    sd: f64,
    /// Standard deviation of biases in m/s², of others relative to the gain.
    sd_in_si: f64,
}

fn list(vector: &Vector3<f64>) -> Vec<f64> {
    vector.as_slice().to_vec()
}

impl<'a> InspectionFile<'a> {
    fn of(file: &'a ImuFile, inspection: &'a Inspection) -> Self {
        let range = |values: &Vec<f64>| {
            values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], &value| {
                [least.min(value), most.max(value)]
            })
        };
        let found = inspection.holds.as_ref();
        Self {
            schema: 1,
            format: file.format.name(),
            sha256: file.sha256.join(" "),
            rows: file.rows,
            second_file: file.second.as_ref().map(|second| SecondFields {
                format: second.format.name(),
                rows: second.rows,
                columns: second.columns,
            }),
            columns: file.columns.iter().map(ColumnFields::of).collect(),
            findings: file.all_findings().map(ToString::to_string).collect(),
            sensors: inspection.sensors.iter().map(SensorFields::of).collect(),
            spikes: inspection.spikes.iter().map(SpikesFields::of).collect(),
            temperature_c: file.recording.temperature_c.as_ref().map(range),
            holds: found.and_then(|holds| holds.as_ref().ok()).map(HoldsFields::of),
            no_holds_because: found.and_then(|holds| holds.as_ref().err()).map(String::as_str),
        }
    }
}

impl<'a> ColumnFields<'a> {
    fn of(column: &'a ImuColumn) -> Self {
        Self {
            name: &column.name,
            meaning: column.meaning.to_string(),
            unit: column.unit.map(super::ColumnUnit::symbol),
            used: column.is_used(),
            not_used_because: column.unused.as_deref(),
        }
    }
}

impl SpikesFields {
    fn of((sensor_kind, spikes): &(SensorKind, Spikes)) -> Self {
        Self {
            sensor: sensor_kind.name(),
            samples: spikes.samples.len(),
            cut_samples: spikes.cut.len(),
            axis: spikes.axis.to_string(),
            time_s: spikes.time_s,
            reading: spikes.reading,
        }
    }
}

impl SensorFields {
    fn of(sensor: &SensorInspection) -> Self {
        Self {
            sensor: sensor.sensor_kind.name(),
            unit: sensor.unit.symbol(),
            sampling: SamplingFields::of(&sensor.sampling),
            least: list(&sensor.least),
            mean: list(&sensor.mean),
            most: list(&sensor.most),
        }
    }
}

impl<'a> HoldsFields<'a> {
    fn of(holds: &'a HoldsInspection) -> Self {
        let hold = |(hold, clipped): (&Hold, &Option<Saturation>)| HoldFields {
            start_s: hold.start_s,
            end_s: hold.end_s,
            samples: hold.samples(),
            mean: list(&hold.mean),
            sd: list(&hold.sd),
            saturated_axis: clipped.map(|end| end.axis.to_string()),
        };
        let coarse = |(sensor_kind, found): &(SensorKind, CoarseAxis)| CoarseFields {
            sensor: sensor_kind.name(),
            axis: found.axis.to_string(),
            step: found.step,
            noise: found.noise,
            mean_sd: found.mean_sd,
        };
        Self {
            count: holds.holds.len(),
            minimum_hold_s: MINIMUM_HOLD_S,
            table: holds.holds.iter().zip(&holds.clipped).map(hold).collect(),
            largest_gap_deg: holds.coverage.map(|coverage| coverage.gap_rad.to_degrees()),
            emptiest_direction: holds.coverage.map(|coverage| list(&coverage.emptiest)),
            gyroscope_mean: holds.gyroscope_at_rest.as_ref().map(|(mean, _)| list(mean)),
            gyroscope_noise: holds.gyroscope_at_rest.as_ref().map(|(_, noise)| list(noise)),
            coarse_axes: holds.coarse.iter().map(coarse).collect(),
            expected: holds.expected.as_ref().ok().map(ExpectedFields::of),
            not_determined_because: holds.expected.as_ref().err().map(String::as_str),
            lost: holds.lost.as_deref(),
        }
    }
}

impl ExpectedFields {
    fn of(expected: &ExpectedCalibration) -> Self {
        let (sd, relative) = (expected.sd(), expected.relative_sd());
        let parameter = |(k, quantity): (usize, &calibrant_core::sensor::Quantity)| ExpectedParameter {
            name: quantity.name(),
            unit: quantity.unit(expected.unit),
            sd: sd[k],
            sd_in_si: relative[k],
        };
        Self {
            gauge: Gauge::Upper.name(),
            gravity_mps2: GRAVITY_MPS2,
            noise: list(&expected.noise),
            condition_number: expected.condition_number,
            parameters: expected.list.quantities().iter().enumerate().map(parameter).collect(),
        }
    }
}

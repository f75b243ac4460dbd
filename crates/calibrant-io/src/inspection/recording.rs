//! Inspection of a recording before its calibration: what it contains and what to expect of it, as data and
//! as JSON.

use super::sampling::Sampling;
use crate::results::heading::{Heading, JsonFile};
use calibrant_core::diagnostic::holds::{HoldLeftOut, HoldsUndetermined};
use calibrant_core::diagnostic::samples::Spikes as SpikesFound;
use calibrant_core::diagnostic::{Diagnostic, HoldReason, HoldSpan, Phrase};
use calibrant_core::error::{Error, Result};
use calibrant_core::estimate::{
    CoarseAxis, Coverage, ExpectedCalibration, clipped_holds, coarse_axes_in, coverage, expected_calibration,
    find_clean_imu_holds, holds_lost_to_filter, repeated_readings, swapped_sensors,
};
use calibrant_core::form::As;
use calibrant_core::json::{flat, if_any, if_some};
use calibrant_core::json_object;
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{
    Gauge, ImuRecording, MeanReading, Quantity, ReadingUnit, Recording, Saturation, SensorKind, Spikes,
};
use calibrant_recording::ImuFile;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

/// Gravity that is assumed, m/s²: the location changes a prediction by less than one per cent.
const GRAVITY_MPS2: f64 = 9.806_65;
/// The content of a recording.
#[derive(Debug, Clone)]
pub struct Inspection {
    /// What was noticed: first by the reader, as in the file, then in the samples and the holds.
    pub findings: Vec<Diagnostic>,
    /// Each sensor that is there.
    pub sensors: Vec<SensorInspection>,
    /// Spikes and invalid samples of a sensor. The search for holds does not use them.
    pub spikes: Vec<(SensorKind, Spikes)>,
    /// The holds of the accelerometer. `None` without an accelerometer, or where the search was impossible.
    pub holds: Option<HoldsInspection>,
}

impl Inspection {
    /// Duration of the shortest hold that is looked for, s.
    pub const MINIMUM_HOLD_S: f64 = 1.0;
}

/// Sampling and values of one sensor.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SensorInspection {
    /// Which sensor.
    #[serde(rename = "sensor")]
    pub sensor_kind: SensorKind,
    /// Of its readings, after the conversion.
    pub unit: ReadingUnit,
    /// Its sample times.
    #[serde(flatten)]
    pub sampling: Sampling,
    /// Least reading per axis.
    #[serde(with = "As::<[f64; 3]>")]
    pub least: Vector3<f64>,
    /// Mean reading per axis.
    #[serde(with = "As::<[f64; 3]>")]
    pub mean: Vector3<f64>,
    /// Largest reading per axis.
    #[serde(with = "As::<[f64; 3]>")]
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
    /// The parameters of the accelerometer that they will determine. `None` where they do not determine all.
    pub expected: Option<ExpectedCalibration>,
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
    let mut findings: Vec<Diagnostic> = file.all_findings().cloned().collect();
    let distinct = recording.without_repeats();
    let repeats = distinct.iter().flat_map(|(_, found)| found);
    findings.extend(repeats.flat_map(|(sensor_kind, repeats)| repeated_readings(repeats, *sensor_kind)));
    let recording = distinct.as_ref().map_or(recording, |(distinct, _)| distinct);
    let (clean, spikes) = recording.without_spikes();
    findings.extend(spikes.iter().filter_map(|(sensor_kind, spikes)| {
        let unit = recording.sensor(*sensor_kind)?.unit();
        Some(SpikesFound::of(spikes, *sensor_kind, unit).into())
    }));
    let holds = clean[SensorKind::Accelerometer].as_ref().and_then(|accelerometer| {
        HoldsInspection::of(&clean, accelerometer, &mut findings)
            .map_err(|why| findings.push(undetermined(&why)))
            .ok()
    });
    Inspection { findings, sensors, spikes, holds }
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

fn undetermined(why: &Error) -> Diagnostic {
    HoldsUndetermined { why: Phrase(why.to_string()) }.into()
}

impl HoldsInspection {
    /// The holds; what is noticed in them is added to the findings.
    fn of(
        recording: &ImuRecording,
        accelerometer: &Recording,
        findings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let holds = find_clean_imu_holds(recording, Inspection::MINIMUM_HOLD_S)?;
        let clipped = clipped_holds(accelerometer, &holds);
        let sound: Vec<Hold> = holds
            .iter()
            .zip(&clipped)
            .filter(|(_, end)| end.is_none())
            .map(|(hold, _)| hold.clone())
            .collect();
        let unit = accelerometer.unit();
        findings.extend((0..).zip(&holds).zip(&clipped).filter_map(|((number, hold), end)| {
            let why = end.map(|end| HoldReason::Saturated { axis: end.axis, reading: end.value, unit })?;
            Some(HoldLeftOut { hold: HoldSpan::of(number, hold), why }.into())
        }));
        let coarse: Vec<(SensorKind, CoarseAxis)> = SensorKind::ALL
            .into_iter()
            .flat_map(|sensor_kind| coarse(recording, sensor_kind, &sound))
            .collect();
        findings.extend(coarse.iter().filter_map(|(sensor_kind, axis)| {
            Some(axis.check(*sensor_kind, recording.sensor(*sensor_kind)?.unit()).into())
        }));
        let expected = expected_calibration(&sound, unit, GRAVITY_MPS2, Gauge::Upper);
        let swapped =
            expected.is_err().then(|| swapped_sensors(recording, Inspection::MINIMUM_HOLD_S)).flatten();
        findings.extend(expected.as_ref().err().map(undetermined));
        findings.extend(swapped.map(Diagnostic::from).or_else(|| {
            holds_lost_to_filter(accelerometer, &holds, Inspection::MINIMUM_HOLD_S).map(Diagnostic::from)
        }));
        let offset = match &expected {
            Ok(expected) => Some(expected.like.bias),
            // readings in counts have an offset that is unknown without the calibration
            Err(_) => (unit != ReadingUnit::Counts).then(Vector3::zeros),
        };
        let directions = offset.map(|offset| sound.iter().map(|hold| hold.mean - offset).collect::<Vec<_>>());
        Ok(Self {
            coverage: directions.and_then(|directions| coverage(&directions)),
            gyroscope_at_rest: recording[SensorKind::Gyroscope]
                .as_ref()
                .and_then(|gyroscope| at_rest(gyroscope, &holds)),
            coarse,
            expected: expected.ok(),
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

/// A recording and its inspection, as `calibrant inspect --json` prints them.
#[derive(Debug, Clone, Copy)]
pub struct InspectionFile<'a> {
    /// The recording.
    pub file: &'a ImuFile,
    /// What it contains.
    pub inspection: &'a Inspection,
}

json_object! {
    /// What a recording contains, and what to expect of its calibration.
    InspectionFile<'_> as of {
        heading: flat(Heading::<Self>::of()),
        /// The format of the file.
        format: of.file.format.name(),
        /// The hash of each file, with spaces between.
        sha256: of.file.sha256.join(" "),
        /// Number of rows.
        rows: of.file.rows,
        /// The gyroscope's file of a pair. Its columns come last.
        second_file: if_some(of.file.second.as_ref()),
        /// What each column was read as.
        columns: &of.file.columns,
        /// What was noticed by the reader, in the samples and in the holds.
        findings: &of.inspection.findings,
        sensors: &of.inspection.sensors,
        /// Samples that were removed.
        spikes: if_any(of.inspection.spikes.iter().map(|(sensor_kind, spikes)| SpikesOf { sensor_kind: *sensor_kind, spikes }).collect::<Vec<_>>()),
        /// Least and greatest temperature.
        temperature_c: of.file.recording.temperature_c.as_deref().map(range),
        holds: of.inspection.holds.as_ref(),
    }
}

impl JsonFile for InspectionFile<'_> {
    const KIND: &'static str = "recording";
}

fn range(values: &[f64]) -> [f64; 2] {
    let wider = |[least, most]: [f64; 2], value: &f64| [least.min(*value), most.max(*value)];
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], wider)
}

struct SpikesOf<'a> {
    sensor_kind: SensorKind,
    spikes: &'a Spikes,
}

json_object! {
    /// Samples of a sensor that were removed, and the one that is farthest off.
    SpikesOf<'_> as of {
        /// Which sensor it is.
        sensor: of.sensor_kind,
        /// Number of samples.
        samples: of.spikes.samples.len(),
        /// Samples that were removed and not replaced.
        cut_samples: of.spikes.cut.len(),
        axis: of.spikes.axis,
        time_s: of.spikes.time_s,
        reading: of.spikes.reading,
    }
}

json_object! {
    /// The holds of a recording and their use for a calibration.
    HoldsInspection as of {
        /// Number of holds.
        count: of.holds.len(),
        minimum_hold_s: Inspection::MINIMUM_HOLD_S,
        /// The holds, in the order of time.
        table: of.holds.iter().zip(&of.clipped).map(|(hold, clipped)| HoldOf { hold, clipped: *clipped }).collect::<Vec<_>>(),
        /// The widest part of the sphere without a direction, and its middle.
        largest_gap_deg: of.coverage.map(|coverage| coverage.gap_rad.to_degrees()),
        /// The direction farthest from all holds.
        emptiest_direction: of.coverage.map(|coverage| list(&coverage.emptiest)),
        /// Mean reading of the gyroscope in the holds.
        gyroscope_mean: of.gyroscope_at_rest.as_ref().map(|(mean, _)| list(mean)),
        /// Noise of one sample of the gyroscope in the holds.
        gyroscope_noise: of.gyroscope_at_rest.as_ref().map(|(_, noise)| list(noise)),
        coarse_axes: of.coarse.iter().map(|(sensor_kind, axis)| CoarseOf { sensor_kind: *sensor_kind, axis }).collect::<Vec<_>>(),
        /// The parameters that they will determine.
        expected: of.expected.as_ref().map(ExpectedOf),
    }
}

struct HoldOf<'a> {
    hold: &'a Hold,
    clipped: Option<Saturation>,
}

json_object! {
    HoldOf<'_> as of {
        start_s: of.hold.start_s,
        end_s: of.hold.end_s,
        /// Number of samples.
        samples: of.hold.samples(),
        /// Mean reading of each axis.
        mean: list(&of.hold.mean),
        /// Standard deviation of one sample of each axis.
        sd: list(&of.hold.sd),
        /// The axis that is at the end of its range.
        saturated_axis: of.clipped.map(|end| end.axis),
    }
}

struct CoarseOf<'a> {
    sensor_kind: SensorKind,
    axis: &'a CoarseAxis,
}

json_object! {
    /// An axis whose quantisation step is coarser than its noise, in the unit of the readings.
    CoarseOf<'_> as of {
        /// Which sensor it is.
        sensor: of.sensor_kind,
        /// Which axis it is.
        axis: of.axis.axis,
        step: of.axis.step,
        noise: of.axis.noise,
        mean_sd: of.axis.mean_sd,
    }
}

struct ExpectedOf<'a>(&'a ExpectedCalibration);

json_object! {
    /// The parameters of the accelerometer that the holds will determine.
    ExpectedOf<'_> as of {
        /// The form of the matrix for which this holds.
        gauge: Gauge::Upper.name(),
        gravity_mps2: GRAVITY_MPS2,
        /// Standard deviation of one sample within the holds.
        noise: list(&of.0.noise),
        /// Largest over smallest eigenvalue of the scaled information: 1 is best.
        condition_number: of.0.condition_number,
        /// The standard deviation that each parameter would have.
        parameters: of.parameters(),
    }
}

#[derive(Serialize, JsonSchema)]
struct ExpectedParameter {
    /// Which parameter it is.
    name: String,
    /// Its unit.
    unit: &'static str,
    /// Its standard deviation.
    sd: f64,
    /// Standard deviation of biases in m/s², of others relative to the gain.
    sd_in_si: f64,
}

impl ExpectedOf<'_> {
    fn parameters(&self) -> Vec<ExpectedParameter> {
        let (sd, relative) = (self.0.sd(), self.0.relative_sd());
        let parameter = |(k, quantity): (usize, &Quantity)| ExpectedParameter {
            name: quantity.name(),
            unit: quantity.unit(self.0.unit),
            sd: sd[k],
            sd_in_si: relative[k],
        };
        self.0.list.quantities().iter().enumerate().map(parameter).collect()
    }
}

fn list(vector: &Vector3<f64>) -> [f64; 3] {
    (*vector).into()
}

//! Writes `noise.json`: the noise of a sensor at rest, its Allan deviation and its coefficients.

use super::diagnostics::{DiagnosticFields, DiagnosticWords};
use super::input::Input;
use super::json;
use calibrant_core::error::Result;
use calibrant_core::noise::{
    AllanPoint, AxisNoise, CONFIDENCE, Coefficient, PowerLaw, SensorNoise, coefficient_units,
};
use calibrant_core::sensor::{ReadingUnit, SensorKind};
use serde::Serialize;
use std::path::Path;

/// The version of `noise.json`. Added fields do not change it.
pub(super) const NOISE_SCHEMA: u32 = 1;

/// Writes `noise.json`: the noise of one sensor or of both, and the recording from which it came. Two files
/// are the accelerometer's and the gyroscope's.
///
/// Coefficients carry their unit beside them, in the unit of the readings and in customary ones. A
/// coefficient that is not determined has a `reason` and, where the recording gives one, an `upper_limit`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_noise(
    path: &Path,
    noise: &[SensorNoise],
    inputs: &[Input],
    words: &DiagnosticWords<'_>,
) -> Result<()> {
    json::write_json(path, &NoiseFile::of(noise, inputs, words))
}

/// The text that [`write_noise`] writes.
#[must_use]
pub fn noise_json(noise: &[SensorNoise], inputs: &[Input], words: &DiagnosticWords<'_>) -> String {
    json::to_json(&NoiseFile::of(noise, inputs, words))
}

/// The line of an experiment file that states a sensor's white noise, and its section.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct NoiseLine {
    /// `sensor` for an accelerometer, `gyroscope` for a gyroscope.
    pub section: &'static str,
    /// The line: `noise_counts = [26.3, 27.1, 25.8]`.
    pub line: String,
}

/// The line to paste into an experiment file, in the unit of the readings. `None` where the white noise is
/// not determined on an axis, or is not that of a sensor at rest.
#[must_use]
pub fn noise_line(noise: &SensorNoise) -> Option<NoiseLine> {
    if noise.caveat.is_some() {
        return None;
    }
    let sigma = noise.white_noise_of_readings()?;
    let counts = noise.unit == ReadingUnit::Counts || noise.gain.is_some();
    let unit = if counts { ReadingUnit::Counts } else { noise.unit };
    let section = match noise.sensor_kind {
        SensorKind::Accelerometer => "sensor",
        SensorKind::Gyroscope => "gyroscope",
    };
    // TOML recognises a float by its point
    let digits = |value: f64| format!("{value:.3e}").parse::<f64>().map(|rounded| format!("{rounded:?}"));
    let values: Vec<String> =
        noise.axes.iter().filter_map(|axis| digits(sigma[axis.axis.index()]).ok()).collect();
    Some(NoiseLine { section, line: format!("noise_{} = [{}]", unit.suffix(), values.join(", ")) })
}

#[derive(Serialize)]
struct NoiseFile<'a> {
    schema: u32,
    program: String,
    confidence: f64,
    sensors: Vec<SensorNoiseFields<'a>>,
    input: Option<&'a Input>,
    /// The gyroscope's file, where it has one of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    gyroscope_input: Option<&'a Input>,
}

impl<'a> NoiseFile<'a> {
    fn of(noise: &'a [SensorNoise], inputs: &'a [Input], words: &DiagnosticWords<'_>) -> Self {
        Self {
            schema: NOISE_SCHEMA,
            program: crate::atomic_output::program(),
            confidence: CONFIDENCE,
            sensors: noise.iter().map(|noise| SensorNoiseFields::of(noise, words)).collect(),
            input: inputs.first(),
            gyroscope_input: inputs.get(1),
        }
    }
}

#[derive(Serialize)]
struct SensorNoiseFields<'a> {
    sensor: &'static str,
    reading_unit: &'static str,
    first_sample: usize,
    end_sample: usize,
    start_s: f64,
    end_s: f64,
    interval_s: f64,
    interval_jitter: f64,
    missing_share: f64,
    axes: Vec<AxisFields<'a>>,
    experiment: Option<NoiseLine>,
    #[serde(rename = "doubt")]
    caveat: Option<&'a str>,
    warnings: Vec<DiagnosticFields>,
}

impl<'a> SensorNoiseFields<'a> {
    fn of(noise: &'a SensorNoise, words: &DiagnosticWords<'_>) -> Self {
        let rate = noise.segment.rate_hz();
        Self {
            sensor: noise.sensor_kind.name(),
            reading_unit: noise.unit.symbol(),
            first_sample: noise.segment.first,
            end_sample: noise.segment.end,
            start_s: noise.segment.start_s,
            end_s: noise.segment.end_s,
            interval_s: noise.segment.interval_s,
            interval_jitter: noise.segment.jitter,
            missing_share: noise.segment.missing,
            axes: noise
                .axes
                .iter()
                .map(|axis| AxisFields::of(axis, noise.sensor_kind, noise.unit, rate))
                .collect(),
            experiment: noise_line(noise),
            caveat: noise.caveat.as_deref(),
            warnings: DiagnosticFields::all(&noise.warnings, words),
        }
    }
}

#[derive(Serialize)]
struct AxisFields<'a> {
    axis: String,
    white_noise_per_sample: Option<f64>,
    sample_sd: f64,
    random_walk: CoefficientFields<'a>,
    bias_instability: CoefficientFields<'a>,
    rate_random_walk: CoefficientFields<'a>,
    quantisation: CoefficientFields<'a>,
    bias_instability_tau_s: Option<f64>,
    drift: DriftFields,
    fit: FitFields,
    vibration: Option<VibrationFields>,
    allan: AllanFields,
}

impl<'a> AxisFields<'a> {
    fn of(axis: &'a AxisNoise, sensor_kind: SensorKind, unit: ReadingUnit, rate_hz: f64) -> Self {
        let model = &axis.fit.model;
        let of = |process| CoefficientFields::of(model.coefficient(process), sensor_kind, process, unit);
        let points = &axis.allan.points;
        let column = |f: fn(&AllanPoint) -> f64| points.iter().map(f).collect();
        Self {
            axis: axis.axis.to_string(),
            white_noise_per_sample: model.white_noise_per_sample(rate_hz),
            sample_sd: axis.sample_sd,
            random_walk: of(PowerLaw::White),
            bias_instability: of(PowerLaw::Flicker),
            rate_random_walk: of(PowerLaw::RandomWalk),
            quantisation: of(PowerLaw::Quantisation),
            bias_instability_tau_s: axis.fit.flat_tau_s,
            drift: DriftFields {
                per_s: axis.fit.drift.per_s,
                sd: axis.fit.drift.sd,
                significant: axis.fit.drift.is_significant(),
            },
            fit: FitFields {
                filtered: axis.fit.filtered,
                shortest_tau_s: axis.fit.shortest_tau_s,
                longest_tau_s: axis.fit.longest_tau_s,
                chi2: axis.fit.chi2,
                degrees_of_freedom: axis.fit.degrees_of_freedom,
                p_value: axis.fit.p_value,
            },
            vibration: axis.fit.vibration.as_ref().map(|line| VibrationFields {
                frequency_hz: line.frequency_hz,
                share: line.share,
                of_white: line.of_white,
                left_out: line.left_out,
            }),
            allan: AllanFields {
                cluster_samples: points.iter().map(|point| point.cluster).collect(),
                tau_s: column(|point| point.tau_s),
                deviation: column(|point| point.deviation),
                low: column(|point| point.low),
                high: column(|point| point.high),
                degrees_of_freedom: column(|point| point.degrees_of_freedom),
            },
        }
    }
}

#[derive(Serialize)]
struct CoefficientFields<'a> {
    determined: bool,
    unit: &'static str,
    value: Option<f64>,
    sd: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
    customary: Vec<CustomaryFields>,
    upper_limit: Option<f64>,
    reason: Option<&'a str>,
}

impl<'a> CoefficientFields<'a> {
    fn of(
        coefficient: &'a Coefficient,
        sensor_kind: SensorKind,
        process: PowerLaw,
        unit: ReadingUnit,
    ) -> Self {
        let units = coefficient_units(sensor_kind, process, unit);
        let found = coefficient.estimate();
        let customary = |unit: &calibrant_core::noise::CoefficientUnit| {
            let estimate = found?.scaled(unit.factor);
            Some(CustomaryFields { unit: unit.symbol, value: estimate.value, sd: estimate.sd })
        };
        let reason = match coefficient {
            Coefficient::Determined(_) => None,
            Coefficient::NotDetermined { reason, .. } => Some(reason.as_str()),
        };
        Self {
            determined: found.is_some(),
            unit: units[0].symbol,
            value: found.map(|found| found.value),
            sd: found.map(|found| found.sd),
            low: found.map(|found| found.low),
            high: found.map(|found| found.high),
            customary: units[1..].iter().filter_map(customary).collect(),
            upper_limit: coefficient.limit(),
            reason,
        }
    }
}

#[derive(Serialize)]
struct CustomaryFields {
    unit: &'static str,
    value: f64,
    sd: f64,
}

#[derive(Serialize)]
struct DriftFields {
    per_s: f64,
    sd: f64,
    significant: bool,
}

#[derive(Serialize)]
struct FitFields {
    filtered: bool,
    shortest_tau_s: f64,
    longest_tau_s: f64,
    chi2: f64,
    degrees_of_freedom: usize,
    p_value: Option<f64>,
}

/// Lines in the spectrum.
#[derive(Serialize)]
struct VibrationFields {
    frequency_hz: f64,
    /// Share of the variance of the samples.
    share: f64,
    /// Share of N² if they were not subtracted.
    of_white: f64,
    left_out: bool,
}

#[derive(Serialize)]
struct AllanFields {
    cluster_samples: Vec<usize>,
    tau_s: Vec<f64>,
    deviation: Vec<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
    degrees_of_freedom: Vec<f64>,
}

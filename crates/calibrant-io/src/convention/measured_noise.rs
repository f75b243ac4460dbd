//! Reads noise densities from `noise.json`, as `calibrant noise` writes it, for formats with one number for a
//! sensor.

use super::ImuNoise;
use super::file::LARGEST;
use super::words::invalid;
use crate::results::json::{self, SCHEMA};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::WalkOfSomeAxes;
use calibrant_core::error::Result;
use calibrant_core::sensor::{Axis, CalibratedImu, ReadingUnit, SensorKind};
use calibrant_recording::text::decoding::{self, Checked};
use serde::Deserialize;
use std::path::Path;

/// Sample times are known to this part of an interval at best.
const FINEST: f64 = 1e-6;
/// The remedy for a broken file.
const HELP: &str = "give noise.json as `calibrant noise` writes it";

#[derive(Deserialize)]
struct NoiseFile {
    schema: Option<u32>,
    sensors: Vec<Sensor>,
}

#[derive(Deserialize)]
struct Sensor {
    #[serde(rename = "sensor")]
    kind: SensorKind,
    reading_unit: ReadingUnit,
    interval_s: f64,
    interval_jitter: Option<f64>,
    first_sample: Option<usize>,
    end_sample: Option<usize>,
    axes: Vec<AxisNoise>,
    caveat: Option<Diagnostic>,
}

#[derive(Deserialize)]
struct AxisNoise {
    axis: Axis,
    random_walk: Coefficient,
    rate_random_walk: Coefficient,
}

#[derive(Deserialize)]
struct Coefficient {
    value: Option<f64>,
    upper_limit: Option<f64>,
}

/// Reads the densities of `noise.json` in SI: the largest of the three axes. The gain for readings in counts
/// is that of the calibration.
///
/// A random walk that an axis does not determine counts by its upper limit on that axis. Where no axis determines it, it is not given, and its limit is.
/// White noise that is not determined on every axis is not given.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment) with the file. It is not readable or not a `noise.json`. Its noise is not that of a
/// sensor at rest. A number is not positive. It has counts of a sensor whose calibration is of SI readings.
pub fn read_measured_noise(path: &Path, imu: &CalibratedImu) -> Result<ImuNoise> {
    decoding::parsed(path, (LARGEST, "noise.json"), |bytes| {
        let file: NoiseFile = serde_json::from_str(decoding::as_text(bytes)?)
            .map_err(|error| json::broken(&error, "the noise of a sensor", HELP))?;
        if let Some(schema) = file.schema.filter(|schema| *schema > SCHEMA) {
            let message = format!("it is of version {schema}, and this program knows up to {SCHEMA}");
            return Err(invalid(message, "convert with the program that wrote it"));
        }
        let mut noise = ImuNoise::default();
        for sensor in &file.sensors {
            take(&mut noise, sensor, imu)?;
        }
        noise.checked()
    })
}

fn take(noise: &mut ImuNoise, sensor: &Sensor, imu: &CalibratedImu) -> Checked<()> {
    let sensor_kind = sensor.kind;
    let Some(unit) = imu.unit(sensor_kind) else { return Ok(()) };
    if let Some(caveat) = &sensor.caveat {
        let message =
            format!("the noise of the {sensor_kind} is not that of a sensor at rest: {}", caveat.message());
        return Err(invalid(
            message,
            "run `calibrant noise` on a recording at rest, where nothing vibrates; or write the densities into the file by hand",
        ));
    }
    let is_physical = sensor.reading_unit == sensor_kind.stimulus_unit();
    if !is_physical && unit != sensor.reading_unit {
        let message = format!(
            "the noise of the {sensor_kind} is in {}, the calibration in {}",
            sensor.reading_unit.symbol(),
            unit.symbol()
        );
        return Err(invalid(
            message,
            "run `calibrant noise` on the same readings, or give it their option `gain`",
        ));
    }
    let matrix = &imu.parameters.sensor(sensor_kind).matrix;
    let gain = |axis: Axis| if is_physical { 1.0 } else { matrix.row(axis.index()).norm() };
    let largest = |of: fn(&AxisNoise) -> &Coefficient| -> Option<f64> {
        let densities: Option<Vec<f64>> =
            sensor.axes.iter().map(|axis| Some(of(axis).value? / gain(axis.axis))).collect();
        densities?.into_iter().reduce(f64::max)
    };
    let density = largest(|axis| &axis.random_walk);
    let of_axes = |of: fn(&Coefficient) -> Option<f64>| {
        let scaled = |axis: &AxisNoise| Some((axis.axis, of(&axis.rate_random_walk)? / gain(axis.axis)));
        sensor.axes.iter().filter_map(scaled).collect::<Vec<_>>()
    };
    let most = |of: &[(Axis, f64)]| of.iter().map(|(_, walk)| *walk).reduce(f64::max);
    let (shown, limited) = (
        of_axes(|walk| walk.value),
        of_axes(|walk| walk.upper_limit.filter(|limit| walk.value.is_none() && *limit > 0.0)),
    );
    let walk = most(&shown).map(|shown| most(&limited).map_or(shown, |limit| shown.max(limit)));
    if walk.is_none() {
        noise.walk_limits[sensor_kind as usize] = most(&limited);
    } else if shown.len() < sensor.axes.len() {
        let hidden = sensor.axes.iter().filter(|axis| axis.rate_random_walk.value.is_none());
        let axes = hidden.map(|axis| axis.axis.to_string()).collect::<Vec<_>>().join(", ");
        let is_limit = most(&limited) == walk;
        noise.findings.push(WalkOfSomeAxes { sensor_kind, axes, is_limit }.into());
    }
    match sensor_kind {
        SensorKind::Accelerometer => {
            (noise.accelerometer_density, noise.accelerometer_random_walk) = (density, walk)
        }
        SensorKind::Gyroscope => (noise.gyroscope_density, noise.gyroscope_random_walk) = (density, walk),
    }
    noise.update_rate_hz = Some(sensor.rate_hz());
    noise.measured_at_hz[sensor_kind as usize] = noise.update_rate_hz;
    Ok(())
}

impl Sensor {
    /// The rate, to the digits that the sample times determine: the ends of `n` intervals are known to the
    /// jitter of a time.
    fn rate_hz(&self) -> f64 {
        let rate = self.interval_s.recip();
        let samples = self.first_sample.zip(self.end_sample).map(|(first, end)| end.saturating_sub(first));
        let jitter = self.interval_jitter.unwrap_or(0.0).max(FINEST);
        let tolerance = rate * jitter / samples.unwrap_or(1).max(1) as f64;
        let mut rounded = (0..17_usize).filter_map(|digits| format!("{rate:.digits$e}").parse::<f64>().ok());
        rounded.find(|rounded| (rounded - rate).abs() <= tolerance).unwrap_or(rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_random_walk_is_the_largest_of_what_the_axes_show_and_may_have() {
        let noise = |walks: [&str; 3]| {
            let axis = |(name, walk): (&str, &str)| {
                format!(
                    r#"{{"axis": "{name}", "random_walk": {{"value": 1e-3}}, "rate_random_walk": {walk}}}"#
                )
            };
            let axes: Vec<String> = ["x", "y", "z"].into_iter().zip(walks).map(axis).collect();
            let text = format!(
                r#"{{"sensor": "gyroscope", "reading_unit": "rad/s", "interval_s": 0.01, "axes": [{}]}}"#,
                axes.join(", ")
            );
            let units = [None, Some(ReadingUnit::RadianPerSecond)];
            let imu =
                CalibratedImu::new(calibrant_core::sensor::ImuParameters::identity(), units, vec![], "");
            let mut noise = ImuNoise::default();
            take(&mut noise, &serde_json::from_str(&text).expect("a sensor"), &imu).expect("usable");
            noise
        };
        let (low, high, y, z) = (
            r#"{"upper_limit": 3.5e-7}"#,
            r#"{"upper_limit": 9e-6}"#,
            r#"{"value": 5.99e-6}"#,
            r#"{"value": 4.98e-6}"#,
        );
        let said =
            |noise: &ImuNoise| noise.findings.iter().map(|of| of.message().to_owned()).collect::<String>();
        let shown = noise([low, y, z]);
        assert_eq!(shown.gyroscope_random_walk, Some(5.99e-6));
        assert!(said(&shown).contains("x has less"), "{}", said(&shown));
        let limited = noise([high, y, z]);
        assert_eq!(limited.gyroscope_random_walk, Some(9e-6));
        assert!(said(&limited).contains("upper limit: x does not"), "{}", said(&limited));
        let none = noise([low, low, high]);
        assert_eq!((none.gyroscope_random_walk, none.walk_limits[1]), (None, Some(9e-6)));
        assert_eq!((noise([y, y, z]).findings, none.findings), (vec![], vec![]));
    }

    #[test]
    fn a_rate_has_the_digits_that_its_times_tell() {
        let rate = |rate_hz: f64, jitter: f64, samples: usize| {
            let text = format!(
                r#"{{"sensor": "gyroscope", "reading_unit": "rad/s", "interval_s": {:?}, "interval_jitter": {jitter:?}, "first_sample": 0,
                    "end_sample": {samples}, "axes": []}}"#,
                1.0 / rate_hz
            );
            serde_json::from_str::<Sensor>(&text).expect("a sensor").rate_hz()
        };
        assert_eq!(rate(99.999_999_999_999_96, 0.0, 6000), 100.0);
        // 5206 intervals to a hundredth of one: 2e-6 of the rate
        assert_eq!(rate(100.009_512_3, 0.01, 5206), 100.0095);
        assert_eq!(rate(100.009_812_3, 0.0, 5206), 100.009_812_3);
        assert_eq!(rate(102.4, 1e-9, 3000), 102.4);
    }
}

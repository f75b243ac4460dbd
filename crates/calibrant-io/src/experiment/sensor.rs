//! Reads `[sensor]`: the datasheet of the accelerometer.

use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ReadingUnit, Sensor, SensorModel};
use nalgebra::Vector3;

/// Range of the noise of a sample in m/s².
const NOISE_MPS2: Bounds = Bounds::from(1e-7, 1e6, "m/s²");
/// Range of the noise of a sample in counts.
const NOISE_COUNTS: Bounds = Bounds::from(1e-9, 1e9, "counts");
/// Range of the datasheet spread of the bias.
const BIAS_SD: Bounds = Bounds::from(0.0, 1e6, "m/s²");
/// Range of the datasheet spread of the scale factors, relative.
const SCALE_SD: Bounds = Bounds::from(0.0, 10.0, "");
/// Range of the largest stimulus.
const RANGE: Bounds = Bounds::above(0.0, 1e9, "m/s²");
/// Range of the datasheet spread of the cross-axis sensitivities.
const CROSS_AXIS_SD: Bounds = Bounds::from(0.0, 10.0, "");
/// Range of the nominal gain.
const GAIN: Bounds = Bounds::above(0.0, 1e12, "counts/(m/s²)");
/// Range of the nominal offset.
const OFFSET: Bounds = Bounds::from(-1e12, 1e12, "counts");

/// Reads `[sensor]`.
pub(super) fn read(section: &Section<'_>) -> Result<Sensor> {
    let kind = section.need("kind", "kind = \"accelerometer\"")?;
    match kind.text() {
        Some("gyroscope" | "magnetometer") => {
            return Err(kind.reject(
                "an accelerometer can be calibrated, alone or with a gyroscope",
                "kind = \"accelerometer\", or \"imu\" for both",
            ));
        }
        _ => kind.word(&[("accelerometer", ()), ("imu", ())])?,
    }
    let is_imu = kind.text() == Some("imu");
    let entry = section.need("axes", "axes = 1 or axes = 3")?;
    let axes = entry.size(0, u64::MAX)?;
    if axes != 3 && (axes != 1 || is_imu) {
        let help = if is_imu {
            "axes = 3: an IMU has three of each sensor"
        } else {
            "axes = 3, or axes = 1 for a sensor of one axis"
        };
        return Err(entry.reject(format!("{axes} axes are not supported"), help));
    }
    let entry = section.need("model", "model = \"scale-bias\" or \"full\"")?;
    let model = entry.word(&[("scale-bias", SensorModel::ScaleBias), ("full", SensorModel::Full)])?;
    if axes == 1 && model == SensorModel::Full {
        return Err(entry.reject("a sensor of one axis has no cross-axis terms", "model = \"scale-bias\""));
    }
    let unit = match section.get("unit") {
        None => ReadingUnit::MetrePerSecondSquared,
        Some(entry) => {
            entry.word(&[("mps2", ReadingUnit::MetrePerSecondSquared), ("counts", ReadingUnit::Counts)])?
        }
    };
    let per_axis = |key: &str, bounds: &Bounds| -> Result<Option<Vector3<f64>>> {
        section.get(key).map(|entry| entry.per_axis(axes, bounds)).transpose()
    };
    if unit == ReadingUnit::MetrePerSecondSquared {
        for key in ["gain_counts_per_mps2", "offset_counts", "noise_counts"] {
            if let Some(entry) = section.get(key) {
                return Err(entry.reject(
                    "readings in m/s² have no counts",
                    "write unit = \"counts\" in [sensor], or leave this key away",
                ));
            }
        }
    } else if let (Some(entry), Some(_)) = (section.get("noise_counts"), section.get("noise_mps2")) {
        return Err(entry.reject("the noise is given twice, in counts and in m/s²", "keep one of the two"));
    }
    let (gain, offset) = match unit {
        ReadingUnit::MetrePerSecondSquared | ReadingUnit::RadianPerSecond => {
            (Some(Vector3::repeat(1.0)), Some(Vector3::zeros()))
        }
        ReadingUnit::Counts => {
            (per_axis("gain_counts_per_mps2", &GAIN)?, per_axis("offset_counts", &OFFSET)?)
        }
    };
    Ok(Sensor {
        axes,
        model,
        unit,
        gain,
        offset,
        noise_mps2: per_axis("noise_mps2", &NOISE_MPS2)?,
        noise_counts: per_axis("noise_counts", &NOISE_COUNTS)?,
        bias_sd_mps2: per_axis("bias_sd_mps2", &BIAS_SD)?,
        scale_sd: per_axis("scale_sd", &SCALE_SD)?,
        range_mps2: section.get("range_mps2").map(|entry| entry.per_axis(axes, &RANGE)).transpose()?,
        cross_axis_sd: section.get("cross_axis_sd").map(|entry| entry.number(&CROSS_AXIS_SD)).transpose()?,
    })
}

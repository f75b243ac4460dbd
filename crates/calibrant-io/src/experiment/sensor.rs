//! `[sensor]`: the datasheet of the accelerometer.

use super::fault::unknown_word;
use super::noise_density::{MPS2_PER_UG, of_sample};
use super::number::{Count, Either, PerAxis, Within};
use super::ranges::{
    Acceleration, AccelerometerGain, BiasSpread, NoiseBandwidth, NoiseCounts, NoiseMps2, NoiseUg, Offset,
    RelativeSpread,
};
use super::refused_key::refused;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ReadingUnit, Sensor, SensorModel};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// `[sensor]`: the datasheet of the accelerometer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorSection {
    /// An accelerometer, or a whole IMU.
    pub kind: SensorsKind,
    /// Number of axes: 1, or 3.
    pub axes: Count<0, { u64::MAX }>,
    /// Which errors the model has.
    pub model: SensorModel,
    /// Unit of the readings; m/s² without it.
    pub unit: Option<AccelerometerUnit>,
    /// Nominal gain.
    pub gain_counts_per_mps2: Option<PerAxis<AccelerometerGain>>,
    /// Nominal offset.
    pub offset_counts: Option<PerAxis<Offset>>,
    /// Noise of one sample, m/s².
    pub noise_mps2: Option<PerAxis<NoiseMps2>>,
    /// Noise of one sample, counts.
    pub noise_counts: Option<PerAxis<NoiseCounts>>,
    /// Noise density of the datasheet, µg/√Hz: the noise of one sample by its bandwidth.
    pub noise_ug_per_rthz: Option<PerAxis<NoiseUg>>,
    /// Bandwidth of that noise.
    pub noise_bandwidth_hz: Option<Within<NoiseBandwidth>>,
    /// Spread of the bias.
    pub bias_sd_mps2: Option<PerAxis<BiasSpread>>,
    /// Spread of the scale factors, relative.
    pub scale_sd: Option<PerAxis<RelativeSpread>>,
    /// Spread of the cross-axis sensitivities, relative.
    pub cross_axis_sd: Option<Within<RelativeSpread>>,
    /// Largest acceleration that the sensor can report.
    pub range_mps2: Option<PerAxis<Acceleration>>,
}

/// Which sensors are calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", try_from = "String")]
pub enum SensorsKind {
    /// An accelerometer.
    Accelerometer,
    /// Accelerometer and gyroscope.
    Imu,
}

impl TryFrom<String> for SensorsKind {
    type Error = String;

    fn try_from(word: String) -> std::result::Result<Self, String> {
        match word.as_str() {
            "accelerometer" => Ok(Self::Accelerometer),
            "imu" => Ok(Self::Imu),
            "gyroscope" | "magnetometer" => Err(String::from(
                "an accelerometer can be calibrated, alone or with a gyroscope\nkind = \"accelerometer\", or \"imu\" for both",
            )),
            other => Err(unknown_word(other, &["accelerometer", "imu"])),
        }
    }
}

/// The unit of an accelerometer's readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AccelerometerUnit {
    /// m/s².
    Mps2,
    /// Counts.
    Counts,
}

/// A value of each axis, where it is given. A single number counts for all axes.
pub(super) fn per_axis<R: Copy>(
    key: &str,
    value: Option<&PerAxis<R>>,
    axes: usize,
) -> Result<Option<Vector3<f64>>> {
    Ok(match value {
        None => None,
        Some(Either::Single(number)) => Some(Vector3::repeat(number.get())),
        Some(Either::Compound(numbers)) if numbers.len() != axes => {
            let es = if axes == 1 { "is" } else { "es" };
            let message = format!("{} numbers for {axes} ax{es}", numbers.len());
            return Err(refused(key, message, "give one number for all axes, or one per axis"));
        }
        Some(Either::Compound(numbers)) => Some(Vector3::from_fn(|axis, _| numbers[axis % axes].get())),
    })
}

impl SensorSection {
    /// Is it a whole IMU?
    #[must_use]
    pub fn is_imu(&self) -> bool {
        self.kind == SensorsKind::Imu
    }

    /// The datasheet.
    pub(super) fn sensor(&self) -> Result<Sensor> {
        let axes = self.axes.size();
        if axes != 3 && (axes != 1 || self.is_imu()) {
            let help = match self.kind {
                SensorsKind::Imu => "axes = 3: an IMU has three of each sensor",
                SensorsKind::Accelerometer => "axes = 3, or axes = 1 for a sensor of one axis",
            };
            return Err(refused("sensor.axes", format!("{axes} axes are not supported"), help));
        }
        if axes == 1 && self.model == SensorModel::Full {
            let message = "a sensor of one axis has no cross-axis terms";
            return Err(refused("sensor.model", message, "model = \"scale-bias\""));
        }
        let unit = match self.unit {
            None | Some(AccelerometerUnit::Mps2) => ReadingUnit::MetrePerSecondSquared,
            Some(AccelerometerUnit::Counts) => ReadingUnit::Counts,
        };
        let of_counts = [
            ("sensor.gain_counts_per_mps2", self.gain_counts_per_mps2.is_some()),
            ("sensor.offset_counts", self.offset_counts.is_some()),
            ("sensor.noise_counts", self.noise_counts.is_some()),
        ];
        if let Some((key, _)) =
            of_counts.iter().find(|(_, is_there)| *is_there && unit != ReadingUnit::Counts)
        {
            let help = "write unit = \"counts\" in [sensor], or leave this key away";
            return Err(refused(*key, "readings in m/s² have no counts", help));
        }
        if self.noise_counts.is_some() && self.noise_mps2.is_some() {
            let message = "the noise is given twice, in counts and in m/s²";
            return Err(refused("sensor.noise_counts", message, "keep one of the two"));
        }
        let noise_mps2 = per_axis("sensor.noise_mps2", self.noise_mps2.as_ref(), axes)?;
        let density = per_axis("sensor.noise_ug_per_rthz", self.noise_ug_per_rthz.as_ref(), axes)?;
        let by_density_mps2 = of_sample(
            ("sensor.noise_ug_per_rthz", density),
            ("sensor.noise_bandwidth_hz", self.noise_bandwidth_hz.map(f64::from)),
            MPS2_PER_UG,
            &[
                ("sensor.noise_mps2", noise_mps2.is_some()),
                ("sensor.noise_counts", self.noise_counts.is_some()),
            ],
        )?;
        let gain = per_axis("sensor.gain_counts_per_mps2", self.gain_counts_per_mps2.as_ref(), axes)?;
        let offset = per_axis("sensor.offset_counts", self.offset_counts.as_ref(), axes)?;
        let in_si = unit != ReadingUnit::Counts;
        Ok(Sensor {
            axes,
            model: self.model,
            unit,
            gain: if in_si { Some(Vector3::repeat(1.0)) } else { gain },
            offset: if in_si { Some(Vector3::zeros()) } else { offset },
            noise_mps2: noise_mps2.or(by_density_mps2),
            noise_counts: per_axis("sensor.noise_counts", self.noise_counts.as_ref(), axes)?,
            bias_sd_mps2: per_axis("sensor.bias_sd_mps2", self.bias_sd_mps2.as_ref(), axes)?,
            scale_sd: per_axis("sensor.scale_sd", self.scale_sd.as_ref(), axes)?,
            range_mps2: per_axis("sensor.range_mps2", self.range_mps2.as_ref(), axes)?,
            cross_axis_sd: self.cross_axis_sd.map(f64::from),
        })
    }
}

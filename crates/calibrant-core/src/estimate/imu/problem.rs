//! What is to be calibrated of an IMU, and what is known of its recording.

use crate::diagnostic::TurnSpan;
use crate::estimate::earth::UNKNOWN_SD_RADPS;
use crate::estimate::holds::HoldsSetup;
use crate::motion::{earth_rate, to_ms};
use crate::sensor::{ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Sensor, SensorKind, SensorModel};
use nalgebra::Vector3;

/// An IMU, a recording of it, and what is known beforehand.
#[derive(Debug, Clone, Copy)]
pub struct ImuProblem<'a> {
    /// The accelerometer's datasheet.
    pub accelerometer: &'a Sensor,
    /// The gyroscope's.
    pub gyroscope: &'a Gyroscope,
    /// Both recordings.
    pub recording: &'a ImuRecording,
    /// How it was recorded.
    pub setup: &'a ImuSetup,
}

/// A gyroscope's datasheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Gyroscope {
    /// Unit of the readings: rad/s or counts.
    pub unit: ReadingUnit,
    /// Which errors the model has.
    pub model: SensorModel,
    /// Nominal gain in counts/(rad/s), where it is known; 1 for rad/s.
    pub gain: Option<Vector3<f64>>,
    /// Standard deviation of one sample's noise, in the unit of the readings; from the recording where it is not known.
    pub noise: Option<Vector3<f64>>,
    /// Is the g-sensitivity estimated?
    pub g_sensitivity: bool,
}

impl Default for Gyroscope {
    fn default() -> Self {
        Self {
            unit: ReadingUnit::RadianPerSecond,
            model: SensorModel::Full,
            gain: None,
            noise: None,
            g_sensitivity: false,
        }
    }
}

/// How an IMU was recorded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImuSetup {
    /// The holds.
    pub holds: HoldsSetup,
    /// Geographic latitude, degrees, southern ones negative: the Earth's turn about the vertical is then part of the model. Where it is not known, it is estimated as far as the recording tells it, and part of the uncertainty, of the g-sensitivity above all.
    pub latitude_deg: Option<f64>,
    /// Direction of the specific force in each of the given holds (up), unit vectors in the true frame; `None` where only its magnitude is known.
    pub directions: Option<Vec<Vector3<f64>>>,
    /// How well these directions were met, rad about each axis; by the scatter of the holds where it is not given.
    pub face_sd_rad: Option<f64>,
    /// Turns of known angle.
    pub turns: Vec<Turn>,
    /// Quantities that are known beforehand.
    pub known: Vec<KnownTerm>,
    /// What is to follow temperature.
    pub thermal: ThermalModel,
    /// White noise of the gyroscope as a long hold of this recording shows it: what counts where the datasheet gives no noise.
    pub white_noise: Option<WhiteNoise>,
}

impl ImuSetup {
    /// A recording of which nothing but its holds is known.
    pub(in crate::estimate) fn from_holds(holds: &HoldsSetup) -> Self {
        Self { holds: holds.clone(), ..Self::default() }
    }

    /// The Earth's rate about the vertical over gravity, `Ω sin φ/g`, (rad/s)/(m/s²): at rest an IMU turns by this times the specific force. Zero where the latitude is not known.
    pub(in crate::estimate) fn vertical_rate(&self) -> f64 {
        let rate = self.latitude_deg.map_or(0.0, |latitude_deg| earth_rate(latitude_deg).z);
        rate / self.holds.gravity.magnitude_mps2
    }

    /// Standard deviation of each component of the Earth's rate about the north, in a heading that is not known, rad/s: `Ω cos φ/√2`, or `Ω/√3` where the latitude is not known.
    pub(in crate::estimate) fn north_sd(&self) -> f64 {
        match self.latitude_deg {
            Some(latitude_deg) => earth_rate(latitude_deg).x.abs() / 2.0_f64.sqrt(),
            None => UNKNOWN_SD_RADPS,
        }
    }

    /// What an IMU of these sensors consists of, in the order of a result: the accelerometer's quantities in its gauge, the gyroscope's, then what temperature does to both. What is
    /// fixed beforehand is among them.
    #[must_use]
    pub fn quantities(&self, accelerometer: SensorModel, gyroscope: &Gyroscope) -> Vec<ImuQuantity> {
        // known directions are the true frame, otherwise the gauge fixes it
        let of_accelerometer = match self.directions {
            Some(_) => ParameterList::new(3, accelerometer),
            None => self.holds.gauge.parameter_list(accelerometer),
        };
        let of_gyroscope = ParameterList::new(3, gyroscope.model);
        let mut quantities = Vec::new();
        for (sensor_kind, list) in
            [(SensorKind::Accelerometer, of_accelerometer), (SensorKind::Gyroscope, of_gyroscope)]
        {
            quantities
                .extend(list.quantities().iter().map(|quantity| ImuQuantity::Of(sensor_kind, *quantity)));
        }
        if gyroscope.g_sensitivity {
            quantities.extend(ImuQuantity::full_list(false, false, true));
        }
        quantities.extend(self.thermal.quantities());
        quantities
    }
}

/// White noise of one sample, from the Allan deviation of a hold.
///
/// The scatter of samples about the mean of their hold contains the slow wander of the bias, too; the white part alone is what averages out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhiteNoise {
    /// Standard deviation `N √f_s` per axis, in the unit of the readings.
    pub sd: Vector3<f64>,
    /// The hold, from 0.
    pub hold: usize,
    /// Duration of what was examined of it, s.
    pub duration_s: f64,
}

/// Where the noise of a gyroscope's sample comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseSource {
    /// The datasheet.
    Datasheet,
    /// The Allan deviation of a hold of this recording.
    AllanDeviation {
        /// The hold, from 0.
        hold: usize,
        /// Duration of what was examined of it, s.
        duration_s: f64,
    },
    /// The scatter of the samples within the holds of this recording.
    ScatterWithinHolds,
}

impl std::fmt::Display for NoiseSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Datasheet => f.write_str("datasheet"),
            Self::AllanDeviation { hold, duration_s } => {
                write!(f, "Allan deviation of hold {} ({duration_s:.1} s)", hold + 1)
            }
            Self::ScatterWithinHolds => f.write_str("scatter within holds"),
        }
    }
}

/// A turn of known angle about an axis that is fixed in the sensor: the Ferraris procedure, or a turntable.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// Its name in a list of sections, `x_rot`, where it is from one.
    pub name: Option<String>,
    /// First and last time of the section, s.
    pub start_s: f64,
    /// End of the section, s.
    pub end_s: f64,
    /// The axis, a unit vector in the true frame.
    pub axis: Vector3<f64>,
    /// The angle, positive by the right-hand rule, rad.
    pub angle_rad: f64,
    /// Standard uncertainty of the angle, and of the axis' direction, rad: across the axis the rotation is known to the angle times this. An axis that was met to 0.5° makes 3.1° of a full turn.
    pub angle_sd_rad: f64,
}

impl Turn {
    /// What it is called in a diagnostic, by its name, or its number from 0, and its times.
    pub(crate) fn span(&self, number: usize) -> TurnSpan {
        TurnSpan {
            number: number + 1,
            name: self.name.clone(),
            start_s: to_ms(self.start_s),
            end_s: to_ms(self.end_s),
        }
    }

    /// Is it the same turn once more? Two that share more than half of the shorter one's time are.
    #[must_use]
    pub fn repeats(&self, other: &Self) -> bool {
        let shared = self.end_s.min(other.end_s) - self.start_s.max(other.start_s);
        shared > 0.5 * (self.end_s - self.start_s).min(other.end_s - other.start_s)
    }
}

/// A quantity that is known beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownTerm {
    /// The quantity.
    pub quantity: ImuQuantity,
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty; `None` where it is fixed at the value.
    pub sd: Option<f64>,
}

/// What is to follow temperature: orders of the polynomials, 0 where nothing follows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ThermalModel {
    /// The reference `T₀`, °C; the mean over the holds, to the degree, where it is not given.
    pub reference_c: Option<f64>,
    /// Order of the accelerometer's bias, to 2.
    pub accelerometer_bias: usize,
    /// Order of the accelerometer's gains.
    pub accelerometer_scale: usize,
    /// Order of the gyroscope's bias.
    pub gyroscope_bias: usize,
    /// Order of the gyroscope's gains.
    pub gyroscope_scale: usize,
}

impl ThermalModel {
    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.quantities().is_empty()
    }

    /// The terms, in the order of a result.
    #[must_use]
    pub fn quantities(&self) -> Vec<ImuQuantity> {
        let mut list = ImuQuantity::thermal_list(
            SensorKind::Accelerometer,
            self.accelerometer_bias,
            self.accelerometer_scale,
        );
        list.extend(ImuQuantity::thermal_list(
            SensorKind::Gyroscope,
            self.gyroscope_bias,
            self.gyroscope_scale,
        ));
        list
    }
}

//! The calibration problem of an IMU: sensors, recording, and given values.

use crate::diagnostic::TurnSpan;
use crate::estimate::earth::UNKNOWN_SD_RADPS;
use crate::estimate::holds::HoldsSetup;
use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::imu::thermometer::ThermometerLag;
use crate::estimate::problem::FacesProblem;
use crate::motion::{earth_rate, to_ms};
use crate::sensor::{
    Gauge, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, Sensor, SensorKind, SensorModel,
};
use nalgebra::Vector3;

/// An IMU, its recording, and given values.
#[derive(Debug, Clone, Copy)]
pub struct ImuProblem<'a> {
    /// The accelerometer's datasheet.
    pub accelerometer: &'a Sensor,
    /// The gyroscope's datasheet.
    pub gyroscope: &'a Gyroscope,
    /// Both recordings.
    pub recording: &'a ImuRecording,
    /// Holds, turns and other facts of the recording.
    pub setup: &'a ImuSetup,
}

impl<'a> ImuProblem<'a> {
    /// Its accelerometer alone, whose recording this is, in known directions.
    pub(in crate::estimate) fn on_faces<'b>(
        &'b self,
        directions: &'b [Vector3<f64>],
        accelerometer: &'b Recording,
    ) -> FacesProblem<'b> {
        FacesProblem {
            sensor: self.accelerometer,
            recording: self.recording[SensorKind::Accelerometer].as_ref().unwrap_or(accelerometer),
            holds: &self.setup.holds,
            directions,
            face_sd_rad: self.setup.face_sd_rad,
        }
    }
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
    /// Standard deviation of one sample's noise, in the unit of the readings. `None`: it comes from the recording.
    pub noise: Option<Vector3<f64>>,
    /// Is the g-sensitivity estimated? Where it is not and the sensor has one, the biases' standard deviations are many times wider.
    pub g_sensitivity: bool,
}

/// As in the preset `imu`: all errors of the model, the g-sensitivity among them.
impl Default for Gyroscope {
    fn default() -> Self {
        Self {
            unit: ReadingUnit::RadianPerSecond,
            model: SensorModel::Full,
            gain: None,
            noise: None,
            g_sensitivity: true,
        }
    }
}

/// Facts of the recording of an IMU.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuSetup {
    /// The holds.
    pub holds: HoldsSetup,
    /// Geographic latitude, degrees, negative in the south. With it, the Earth's rate about the vertical is part of the model. Without it, this rate is
    /// estimated, and adds to the uncertainty, mainly of the g-sensitivity.
    pub latitude_deg: Option<f64>,
    /// Direction of the specific force in each given hold (up), unit vectors in the true frame. `None`: only its magnitude is known.
    pub directions: Option<Vec<Vector3<f64>>>,
    /// Face alignment: standard deviation of these directions, rad about each axis. `None`: it comes from the scatter of the holds.
    pub face_sd_rad: Option<f64>,
    /// Turns of known angle.
    pub turns: Vec<Turn>,
    /// Known quantities, which are held against the recording.
    pub known: Vec<KnownTerm>,
    /// Priors of others: what is usual, or what other recordings say. They are not held against the recording.
    pub usual: Vec<KnownTerm>,
    /// The temperature terms.
    pub thermal: ThermalModel,
    /// What is known of the lag of the thermometer behind the sensor, beside these terms.
    pub thermometer: ThermometerLag,
    /// Relative standard deviation of the recording's sample rate, if that is nominal; 0 if a clock was recorded. The gains of the gyroscope are
    /// uncertain by this share.
    pub rate_sd: f64,
    /// White noise of the gyroscope from a long hold of this recording. It is used if the datasheet gives no noise.
    pub white_noise: Option<WhiteNoise>,
}

/// As in the preset `imu`: nothing is known of the recording, and the true frame is that of Kalibr.
impl Default for ImuSetup {
    fn default() -> Self {
        Self {
            holds: HoldsSetup { gauge: Gauge::Lower, ..HoldsSetup::default() },
            latitude_deg: None,
            directions: None,
            face_sd_rad: None,
            turns: Vec::new(),
            known: Vec::new(),
            usual: Vec::new(),
            thermal: ThermalModel::default(),
            thermometer: ThermometerLag::default(),
            rate_sd: 0.0,
            white_noise: None,
        }
    }
}

impl ImuSetup {
    /// A recording with known holds, and nothing else.
    pub(in crate::estimate) fn from_holds(holds: &HoldsSetup) -> Self {
        Self { holds: holds.clone(), ..Self::default() }
    }

    /// All that is known of quantities.
    pub fn known_terms(&self) -> impl Iterator<Item = &KnownTerm> {
        self.known.iter().chain(&self.usual)
    }

    /// The Earth's rate about the vertical over gravity, `Ω sin φ/g`, (rad/s)/(m/s²). An IMU at rest turns by this times the specific force. Zero at an
    /// unknown latitude.
    pub(in crate::estimate) fn vertical_rate(&self) -> f64 {
        let rate = self.latitude_deg.map_or(0.0, |latitude_deg| earth_rate(latitude_deg).z);
        rate / self.holds.gravity.magnitude_mps2
    }

    /// Standard deviation of each component of the Earth's rate about the north, at an unknown heading, rad/s: `Ω cos φ/√2`, or `Ω/√3` at an unknown latitude.
    pub(in crate::estimate) fn north_sd(&self) -> f64 {
        match self.latitude_deg {
            Some(latitude_deg) => earth_rate(latitude_deg).x.abs() / 2.0_f64.sqrt(),
            None => UNKNOWN_SD_RADPS,
        }
    }

    /// The quantities of an IMU with these sensors, in the order of a result: those of the accelerometer in its gauge, those of the gyroscope, then the
    /// temperature terms of both. Fixed quantities are included.
    #[must_use]
    pub fn quantities(&self, accelerometer: SensorModel, gyroscope: &Gyroscope) -> Vec<ImuQuantity> {
        // known directions are the true frame, otherwise the gauge fixes it
        let of_accelerometer = match self.directions {
            Some(_) => self.holds.parameter_list_on_faces(accelerometer),
            None => self.holds.parameter_list(accelerometer),
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
/// The scatter of samples about the mean of their hold also contains the slow wander of the bias. Only the white part averages out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhiteNoise {
    /// Standard deviation `N √f_s` per axis, in the unit of the readings.
    pub sd: Vector3<f64>,
    /// The hold, from 0.
    pub hold: usize,
    /// Duration of the examined part, s.
    pub duration_s: f64,
}

/// The source of the noise of a gyroscope's sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoiseSource {
    /// The datasheet.
    Datasheet,
    /// The Allan deviation of a hold of this recording.
    AllanDeviation {
        /// The hold, from 0.
        hold: usize,
        /// Duration of the examined part, s.
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
    /// Its name in a list of sections, such as `x_rot`.
    pub name: Option<String>,
    /// Start of the section, s.
    pub start_s: f64,
    /// End of the section, s.
    pub end_s: f64,
    /// The axis, a unit vector in the true frame.
    pub axis: Vector3<f64>,
    /// The angle, positive by the right-hand rule, rad.
    pub angle_rad: f64,
    /// Standard uncertainty of the angle, rad.
    pub angle_sd_rad: f64,
    /// Standard uncertainty of the axis' direction, rad. Across the axis, the uncertainty is this times the angle: 0.5° of the axis is 3.1° of a full turn.
    /// Without it, that of the angle; over several turns that of the angle for each turn, but half a degree at least, where that is less.
    pub axis_sd_rad: Option<f64>,
}

impl Turn {
    /// Its span in a diagnostic. `number`: counted from 0.
    pub(crate) fn span(&self, number: usize) -> TurnSpan {
        TurnSpan {
            number: number + 1,
            name: self.name.clone(),
            start_s: to_ms(self.start_s),
            end_s: to_ms(self.end_s),
        }
    }

    /// Is it a repetition of another turn? Two turns are the same if they share more than half of the shorter one's time.
    #[must_use]
    pub fn repeats(&self, other: &Self) -> bool {
        let shared = self.end_s.min(other.end_s) - self.start_s.max(other.start_s);
        shared > 0.5 * (self.end_s - self.start_s).min(other.end_s - other.start_s)
    }
}

/// The orders of the temperature polynomials. Order 0: no term.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ThermalModel {
    /// The reference `T₀`, °C. `None`: the mean over the holds, rounded to a degree.
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
    /// Are there no temperature terms?
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

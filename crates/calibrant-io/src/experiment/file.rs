//! The form of an experiment file: one tree of types that serde reads and writes.

use super::accept::AcceptSection;
use super::calibrate::CalibrateOptions;
use super::campaign::CampaignSection;
use super::columns::ColumnsSection;
use super::design::DesignOptions;
use super::gyroscope::{GyroscopeSection, KnownSection};
use super::holds::HoldsPlan;
use super::limits::LimitsSection;
use super::machine::MachinePlan;
use super::motion::MotionSection;
use super::number::Count;
use super::sensor::SensorSection;
use super::study::StudyOptions;
use super::temperature::TemperatureSection;
use serde::{Deserialize, Serialize};

/// An experiment as its file has it: a section is a table, a key a field, with the unit in its name. `None`: the
/// key is not there.
///
/// [`experiment`](Self::experiment) makes the [`Experiment`](super::Experiment) of it. In code one begins with a
/// preset, which has the usual values, and changes what is different.
///
/// # Examples
/// ```
/// use calibrant_io::ExperimentFile;
///
/// let mut file = ExperimentFile::preset("imu").expect("known");
/// let holds = file.holds.as_mut().expect("held by hand");
/// holds.gravity_mps2 = Some(9.8132.into());
/// let experiment = file.experiment()?;
/// assert!(experiment.imu.is_some_and(|imu| imu.gyroscope.g_sensitivity));
///
/// let text = file.to_toml();
/// assert!(text.contains("gravity_mps2 = 9.8132"));
/// assert_eq!(ExperimentFile::parse(&text, None)?, file);
///
/// file.limits = Some(Default::default());
/// file.limits.as_mut().expect("there").velocity_mps = Some((-1.0).into());
/// let error = file.experiment().expect_err("negative").to_string();
/// assert!(error.starts_with("`limits.velocity_mps`: -1.0 is out of range"), "{error}");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentFile {
    /// Version of the file's format: 1.
    pub schema: Count<0, { u64::MAX }>,
    /// The datasheet of the accelerometer.
    pub sensor: SensorSection,
    /// A commanded motion.
    pub motion: Option<MotionSection>,
    /// Still poses.
    pub holds: Option<HoldsPlan>,
    /// A machine whose motion is logged.
    pub machine: Option<MachinePlan>,
    /// The gyroscope of an IMU.
    pub gyroscope: Option<GyroscopeSection>,
    /// Known quantities of an IMU.
    pub known: Option<KnownSection>,
    /// Temperature terms of an IMU.
    pub temperature: Option<TemperatureSection>,
    /// A campaign over temperature.
    pub campaign: Option<CampaignSection>,
    /// What the recordings' files do not state themselves.
    pub columns: Option<ColumnsSection>,
    /// How a recording is evaluated.
    pub calibrate: Option<CalibrateOptions>,
    /// The limits that a result must keep.
    pub accept: Option<AcceptSection>,
    /// The limits of the arm.
    pub limits: Option<LimitsSection>,
    /// The design of a motion or of poses.
    pub design: Option<DesignOptions>,
    /// Studies over many sensors.
    pub study: Option<StudyOptions>,
}

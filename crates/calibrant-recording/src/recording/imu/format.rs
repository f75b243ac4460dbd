//! The formats of recordings, and how the content of a file shows its format.

use crate::recording::autopilot::{dataflash, ulog};
use crate::recording::bag_kind::BagKind;
use crate::recording::text_header::Head;
use crate::text::decoding::Checked;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use serde::{Deserialize, Serialize};

/// The remedy where the given format is not that of the content.
pub(super) const LEAVE_AWAY: &str =
    "leave option `format` away, and `format` in [columns]: the format is recognised by the content";

/// A file format of whole-IMU recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FileFormat {
    /// Text export of Xsens/Movella MT Manager.
    MtManager,
    /// CSV export of the Movella DOT app.
    MovellaDot,
    /// `data.csv` of the EuRoC MAV dataset (and of TUM VI and others).
    Euroc,
    /// imu_tk: two files of `t x y z`, one for each sensor.
    ImuTk,
    /// CSV of imucal and NilsPod: `n_samples,gyr_x,…,acc_x,…`.
    Imucal,
    /// Delimited text whose header (or `[columns]`) gives the meaning of the columns.
    Csv,
    /// ROS 2 bag in an MCAP container, `sensor_msgs/msg/Imu`.
    Mcap,
    /// ROS 2 bag in an SQLite database.
    Db3,
    /// ROS 1 bag.
    Rosbag,
    /// Apache Parquet, columns named as in CSV.
    Parquet,
    /// Log of PX4, ULog.
    Ulog,
    /// Log of ArduPilot, DataFlash.
    #[serde(rename = "dataflash")]
    DataFlash,
    /// Columns in memory, named as in CSV.
    #[serde(skip)]
    Columns,
}

impl FileFormat {
    /// All formats of files.
    pub const ALL: [Self; 12] = [
        Self::MtManager,
        Self::MovellaDot,
        Self::Euroc,
        Self::ImuTk,
        Self::Imucal,
        Self::Csv,
        Self::Mcap,
        Self::Db3,
        Self::Rosbag,
        Self::Parquet,
        Self::Ulog,
        Self::DataFlash,
    ];

    /// As the option `format` takes it: `mt-manager`, `movella-dot`, `euroc`, `imu-tk`, `imucal`, `csv`, `mcap`, `db3`,
    /// `rosbag`, `parquet`, `ulog`, `dataflash`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MtManager => "mt-manager",
            Self::MovellaDot => "movella-dot",
            Self::Euroc => "euroc",
            Self::ImuTk => "imu-tk",
            Self::Imucal => "imucal",
            Self::Csv => "csv",
            Self::Mcap => "mcap",
            Self::Db3 => "db3",
            Self::Rosbag => "rosbag",
            Self::Parquet => "parquet",
            Self::Ulog => "ulog",
            Self::DataFlash => "dataflash",
            Self::Columns => "columns",
        }
    }

    /// In words, for people.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::MtManager => "Xsens MT Manager text export",
            Self::MovellaDot => "Movella DOT export",
            Self::Euroc => "EuRoC CSV",
            Self::ImuTk => "imu_tk text, t x y z",
            Self::Imucal => "imucal CSV",
            Self::Csv => "CSV",
            Self::Mcap => "ROS 2 bag (MCAP)",
            Self::Db3 => "ROS 2 bag (SQLite)",
            Self::Rosbag => "ROS 1 bag",
            Self::Parquet => "Parquet",
            Self::Ulog => "log of PX4 (ULog)",
            Self::DataFlash => "log of ArduPilot (DataFlash)",
            Self::Columns => "columns in memory",
        }
    }

    /// The format of this name.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// Is it text?
    #[must_use]
    pub fn is_text(self) -> bool {
        use FileFormat::{Columns, DataFlash, Db3, Mcap, Parquet, Rosbag, Ulog};
        !matches!(self, Mcap | Db3 | Rosbag | Parquet | Ulog | DataFlash | Columns)
    }

    /// The binary format that begins with these bytes.
    pub(super) fn of_magic(bytes: &[u8]) -> Option<Self> {
        if let Some(kind) = BagKind::of(bytes) {
            return Some(match kind {
                BagKind::Mcap => Self::Mcap,
                BagKind::Db3 => Self::Db3,
                BagKind::Rosbag => Self::Rosbag,
            });
        }
        let magics: [(&[u8], Self); 3] =
            [(b"PAR1", Self::Parquet), (ulog::MAGIC, Self::Ulog), (dataflash::MAGIC, Self::DataFlash)];
        magics.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, format)| format)
    }

    /// The format of a text that begins like this.
    pub(super) fn of_text(head: &Head<'_>) -> Checked<Self> {
        let names = head.lower_names();
        let has = |name: &str| names.iter().any(|known| known == name);
        if names.first().is_some_and(|name| name.starts_with("#timestamp") || name.starts_with("# timestamp"))
        {
            return Ok(Self::Euroc);
        }
        let preamble = |keys: &[&str]| keys.iter().any(|key| head.value(key).is_some());
        if preamble(&["DeviceTag", "AppVersion", "OutputRate", "Measurement Mode"]) {
            return Ok(Self::MovellaDot);
        }
        let xsens = has("packetcounter") || has("sampletimefine");
        let device = ["MT Manager version", "Update Rate", "DeviceId", "Start Time", "Filter Profile"];
        if preamble(&device) || (xsens && !head.preamble.is_empty() && !head.has_separator_line()) {
            return Ok(Self::MtManager);
        }
        if xsens {
            return Err(InputError::new(Refusal::FormatUnknown,
                "the columns are those of an MT Manager and of a Movella DOT export, whose units differ (rad/s and 0.1 ms; deg/s and µs), and \
                 nothing above the header tells which it is",
                "say option `format` mt-manager or movella-dot",
            )
            .answered_by(TaskOption::Format, ["mt-manager", "movella-dot"])
            .at_line(head.line())
            .into());
        }
        if has("n_samples") && has("gyr_x") {
            return Ok(Self::Imucal);
        }
        if names.is_empty() && head.fields() == 4 {
            return Ok(Self::ImuTk);
        }
        Ok(Self::Csv)
    }
}

//! The options for reading an IMU's recording: what the user states about a file beyond its content.

use super::even_times::SampleTimes;
use super::format::FileFormat;
use super::unit::ImuUnit;
use crate::recording::time_unit::TimeUnit;
use calibrant_core::budget::Budget;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// Standard deviation of a sample rate that a logger writes to its file, ppm: that of a crystal which was not measured. An RC oscillator has about 2000.
pub const USUAL_RATE_SD_PPM: f64 = 100.0;

/// Standard deviation of a sample rate that was set or typed, ppm: that of what was asked for. A loop that waits 10 ms and works for 0.9 ms is 8 % slower
/// than its delay says, and the oscillators of MEMS sensors are off by some per cent.
pub const TYPED_RATE_SD_PPM: f64 = 50_000.0;

/// Options for reading a recording of an IMU: everything that the file does not state itself. `[columns]` of
/// an experiment file gives the same.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::SensorKind;
/// use calibrant_recording::{ImuReadOptions, ImuUnit, parse_imu_recording};
///
/// let text = b"n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n0,90,0,0,0,0,9.8\n1,0,90,0,0,9.8,0\n2,0,0,90,9.8,0,0\n";
/// let question = parse_imu_recording(text, &ImuReadOptions::default()).expect_err("no units, no rate");
/// assert!(question.to_string().contains("option `gyroscope_unit`"));
///
/// let options = ImuReadOptions {
///     accelerometer_unit: Some(ImuUnit::MetrePerSecondSquared),
///     gyroscope_unit: Some(ImuUnit::DegreePerSecond),
///     rate_hz: Some(102.4),
///     ..ImuReadOptions::default()
/// };
/// let file = parse_imu_recording(text, &options)?;
/// let gyroscope = file.recording.sensor(SensorKind::Gyroscope).expect("there");
/// assert_eq!(gyroscope.readings()[0].x, std::f64::consts::FRAC_PI_2);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImuReadOptions {
    /// The format; `None` to recognise it by the content.
    pub format: Option<FileFormat>,
    /// Columns by name, where their names do not show their content.
    pub columns: ColumnMapping,
    /// Unit of the time column, where its name does not give it.
    pub time_unit: Option<TimeUnit>,
    /// Unit of the accelerometer's columns, where the file does not give it.
    pub accelerometer_unit: Option<ImuUnit>,
    /// Unit of the gyroscope's columns, where the file does not give it.
    pub gyroscope_unit: Option<ImuUnit>,
    /// Accelerometer, gyroscope: use counts where neither the file nor the user gives a unit. A calibration
    /// in counts is applied so. The user is then not asked.
    pub counts_unless_stated: [bool; 2],
    /// Sample rate in Hz, for files without sample times.
    pub rate_hz: Option<f64>,
    /// Even times or the logged ones; `None`: even ones where the logged times are steps of a coarse clock about them.
    pub times: Option<SampleTimes>,
    /// Standard deviation of that rate, or of the one that the file states, ppm; `None` for [`TYPED_RATE_SD_PPM`], or for [`USUAL_RATE_SD_PPM`] of one that a
    /// logger states.
    pub rate_sd_ppm: Option<f64>,
    /// Which sensor to read of a text whose rows are those of several: its value in the column that numbers them.
    pub instance: Option<String>,
    /// Topic of a bag that has more than one of `sensor_msgs/msg/Imu`.
    pub topic: Option<String>,
    /// Each row is the mean of a hold. It then has no sample time.
    pub rows_are_holds: bool,
    /// The recording is one of an accelerometer, or is read for its accelerometer alone.
    pub accelerometer_only: Option<AccelerometerOnly>,
    /// What a file may take that states more values than it has bytes for; `None` for [`Budget::USUAL`].
    pub budget: Option<Budget>,
}

/// What an experiment with one accelerometer expects of its recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AccelerometerOnly {
    /// Number of axes that are needed, 1 or 3. Others are not read from a plain text, and are 0.
    pub axes: usize,
    /// Unit of the readings. A plain text has it, unless its header or the user gives another.
    pub unit: ReadingUnit,
    /// Is a temperature kept that nobody names in [`ImuReadOptions::columns`]?
    pub with_temperature: bool,
}

impl ImuReadOptions {
    /// The options for recordings of an accelerometer with this number of axes, 1 or 3, whose unit is this
    /// where a plain text does not state it.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{ReadingUnit, SensorKind};
    /// use calibrant_recording::{ImuReadOptions, parse_imu_recording};
    ///
    /// let options = ImuReadOptions::accelerometer(3, ReadingUnit::MetrePerSecondSquared);
    /// let file = parse_imu_recording(b"t_s,ax_g,ay_g,az_g\n0.00,0,0,1\n0.01,0,0,1\n", &options)?;
    /// assert_eq!(file.recording.sensor(SensorKind::Accelerometer).expect("there").readings()[0].z, 9.80665);
    /// assert!(file.findings[0].to_string().contains("axis x never changes"));
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    #[must_use]
    pub fn accelerometer(axes: usize, unit: ReadingUnit) -> Self {
        Self {
            accelerometer_only: Some(AccelerometerOnly { axes, unit, with_temperature: false }),
            ..Self::default()
        }
    }

    /// The unit that is given for a sensor.
    #[must_use]
    pub fn unit(&self, sensor_kind: SensorKind) -> Option<ImuUnit> {
        match sensor_kind {
            SensorKind::Accelerometer => self.accelerometer_unit,
            SensorKind::Gyroscope => self.gyroscope_unit,
        }
    }

    /// These options with this unit of a sensor.
    #[must_use]
    pub fn with_unit(self, sensor_kind: SensorKind, unit: Option<ImuUnit>) -> Self {
        match sensor_kind {
            SensorKind::Accelerometer => Self { accelerometer_unit: unit, ..self },
            SensorKind::Gyroscope => Self { gyroscope_unit: unit, ..self },
        }
    }

    /// These options, completed from `other`.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self {
            format: self.format.or(other.format),
            columns: if self.columns.is_empty() { other.columns } else { self.columns },
            time_unit: self.time_unit.or(other.time_unit),
            accelerometer_unit: self.accelerometer_unit.or(other.accelerometer_unit),
            gyroscope_unit: self.gyroscope_unit.or(other.gyroscope_unit),
            counts_unless_stated: [0, 1]
                .map(|k| self.counts_unless_stated[k] || other.counts_unless_stated[k]),
            rate_hz: self.rate_hz.or(other.rate_hz),
            times: self.times.or(other.times),
            rate_sd_ppm: self.rate_sd_ppm.or(other.rate_sd_ppm),
            instance: self.instance.or(other.instance),
            topic: self.topic.or(other.topic),
            rows_are_holds: self.rows_are_holds || other.rows_are_holds,
            accelerometer_only: self.accelerometer_only.or(other.accelerometer_only),
            budget: self.budget.or(other.budget),
        }
    }
}

/// The content of each column, by name. Columns of a file without a header are named `1`, `2`, ….
///
/// A given column replaces the meaning of the columns' names. Other columns are still found by name.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ColumnMapping {
    /// Sample times, in [`ImuReadOptions::time_unit`].
    pub time: Option<String>,
    /// What is to be added to sample times in whole seconds: ns, µs or ms, by its values or [`ImuReadOptions::time_unit`].
    pub rest_of_second: Option<String>,
    /// x, y, z of the accelerometer.
    pub accelerometer: Option<[String; 3]>,
    /// x, y, z of the gyroscope.
    pub gyroscope: Option<[String; 3]>,
    /// Temperature, °C.
    pub temperature: Option<String>,
}

impl ColumnMapping {
    /// Is nothing given?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The columns of a sensor.
    #[must_use]
    pub fn sensor(&self, sensor_kind: SensorKind) -> Option<&[String; 3]> {
        match sensor_kind {
            SensorKind::Accelerometer => self.accelerometer.as_ref(),
            SensorKind::Gyroscope => self.gyroscope.as_ref(),
        }
    }
}

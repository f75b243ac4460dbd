//! What a user may say where an error asks: an option and its values, as data. Each surface words it as its own.

use std::fmt;
use std::sync::OnceLock;

macro_rules! options {
    ($($option:ident $name:literal $meaning:literal;)*) => {
        /// An option of a task, by the name that all surfaces share. In messages it is written as ``option `rate_hz` ``;
        /// the command line words it as `--rate-hz`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum TaskOption {
            $(#[doc = $meaning] $option,)*
        }

        impl TaskOption {
            /// All options that messages name.
            pub const ALL: &'static [Self] = &[$(Self::$option,)*];

            /// Its name: `rate_hz`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$option => $name,)*
                }
            }
        }
    };
}

options! {
    Accept "accept" "A file with the limits that a result must keep.";
    AccelerometerUnit "accelerometer_unit" "Unit of the accelerometer's readings.";
    Add "add" "Number of poses to add to those of earlier calibrations.";
    After "after" "The calibration that had corrected the readings of another one.";
    Columns "columns" "A file that says what the columns of a recording hold.";
    Drop "drop" "Leave out parts of a calibration on purpose.";
    Folds "folds" "The number of parts of the recording that validate it.";
    Force "force" "Do it in spite of its size, or replace what is there.";
    Format "format" "The format of a recording.";
    From "from" "An earlier calibration, or the format of a calibration.";
    Gain "gain" "The nominal gain of the readings.";
    Gap "gap" "The gap to the bound at which a search ends.";
    Gauge "gauge" "The convention that fixes the true frame.";
    Gyroscope "gyroscope" "The file of the gyroscope.";
    GyroscopeUnit "gyroscope_unit" "Unit of the gyroscope's readings.";
    Hold "hold" "The interval in which the sensor is held still.";
    Instance "instance" "Which sensor to read of a file with the rows of several.";
    Into "into" "The file of another program whose calibration is replaced.";
    Motion "motion" "The commanded motion, or the log of the machine.";
    Noise "noise" "A file with noise densities.";
    Poses "poses" "The directions of holds.";
    RateHz "rate_hz" "The sample rate in Hz.";
    RateSdPpm "rate_sd_ppm" "The standard deviation of the sample rate in ppm.";
    Reach "reach" "Standard deviations that a design should reach.";
    Records "records" "The database to which results are added.";
    Resume "resume" "Continue an earlier run: what is finished is not done again.";
    Rostopic "rostopic" "The ROS topic of the IMU.";
    RowsAreHolds "rows_are_holds" "Each row of a recording is the mean of a hold.";
    Sections "sections" "The faces and turns of a session.";
    Seconds "seconds" "How long a search may take.";
    Sensor "sensor" "Which sensor a file is of.";
    SensorFrom "sensor_from" "What the names of files say of their sensors.";
    Starts "starts" "The number of random starts of a search.";
    Temperature "temperature" "The temperature in °C.";
    TimeUnit "time_unit" "Unit of the times.";
    Times "times" "Even times, or the logged ones.";
    Together "together" "The recordings are of one sensor, and are fitted together.";
    Topic "topic" "The topic of a bag.";
    Unit "unit" "Unit of the readings.";
    UpdateRate "update_rate" "The rate of the readings that a program gets, Hz.";
    Validate "validate" "A second recording, which validates the result.";
    ValidateGyroscope "validate_gyroscope" "The file of the gyroscope of the second recording.";
    ValidateMotion "validate_motion" "The log of the machine during the second recording.";
}

static WORDING: OnceLock<fn(&str) -> String> = OnceLock::new();

/// Says once, before the first task, how a surface words the options in a text: the command line makes ``option `rate_hz` `` to `--rate-hz`. Errors and
/// diagnostics are made in these words, so that terminal, page and JSON agree. Without it they keep the names that all surfaces share.
pub fn word_options_as(wording: fn(&str) -> String) {
    let _ = WORDING.set(wording); // a second call changes nothing
}

/// The text with options as the surface words them.
#[must_use]
pub fn with_options_worded(text: String) -> String {
    match WORDING.get() {
        Some(wording) if text.contains("option `") => wording(&text),
        _ => text,
    }
}

impl fmt::Display for TaskOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "option `{}`", self.name())
    }
}

/// An answer to the question of an error.
///
/// # Examples
/// ```
/// use calibrant_core::error::{Answer, InputError, Refusal, TaskOption};
/// let answer = Answer::new(TaskOption::Sensor, ["accelerometer", "gyroscope"]);
/// let question = InputError::question(Refusal::SensorUnnamed, "which sensor is this?", vec![answer]);
/// assert_eq!(question.help, "say option `sensor` accelerometer or gyroscope");
/// assert_eq!(question.answers[0].values.len(), 2);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The option that answers it.
    pub option: TaskOption,
    /// The values that it may have; empty where they cannot be listed.
    pub values: Vec<String>,
    /// What else is known, to follow the option and its values.
    pub more: String,
}

impl Answer {
    /// An answer with one of these values.
    #[must_use]
    pub fn new<'v>(option: TaskOption, values: impl IntoIterator<Item = &'v str>) -> Self {
        let values = values.into_iter().map(str::to_owned).collect();
        Self { option, values, more: String::new() }
    }

    /// The same answer, and what else is known.
    #[must_use]
    pub fn and(self, more: impl Into<String>) -> Self {
        Self { more: more.into(), ..self }
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.option)?;
        match self.values.split_last() {
            None => (),
            Some((last, [])) => write!(f, " {last}")?,
            Some((last, others)) => write!(f, " {} or {last}", others.join(", "))?,
        }
        write!(f, "{}", self.more)
    }
}

//! The meaning of a column's name: which sensor, which axis, which unit.
//!
//! | meaning | names | units, as an ending or in brackets |
//! |---|---|---|
//! | time | `t`, `time`, `timestamp`, `stamp` | `_s`, `_ms`, `_us`, `_ns` |
//! | another clock | `millis`, `micros`, `ms`, `elapsed`, `seconds_elapsed`, `rtcTime`, `TimeUS` | the name itself, or as of a time |
//! | counter | `n_samples`, `sample`, `index`, `counter`, `packetcounter` | |
//! | accelerometer | `ax`, `acc_x`, `AcX`, `accel_x`, `accelerometer_x`, `acceleration_x`, `linear_acceleration_x`, `accSmooth[0]` | `_mps2`, `_mmps2`, `_g`, `_mg`, `_counts` |
//! | gyroscope | `gx`, `wx`, `GyX`, `gyr_x`, `gyro_x`, `gyroscope_x`, `omega_x`, `angular_velocity_x` | `_radps`, `_degps`, `_mdps`, `_counts` |
//! | temperature | `temp`, `temperature` | `_c` |
//!
//! `x (g)` and `x-axis (deg/s)` are of the sensor whose unit it is, and `G_X [mdps]` is a gyroscope's. An axis may be a number in brackets, from 0.
//! Capitals do not matter, nor whether `_`, `.`, `-` or a space joins words. `linear_acceleration` is ROS'
//! name of an accelerometer's reading, and Android's of one without gravity: the magnitude decides.

use super::column::{ColumnMeaning, ImuColumn};
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::time_unit::TimeUnit;
use calibrant_core::sensor::{Axis, SensorKind};

/// Names of a time.
const TIME: &[&str] = &[
    "t",
    "time",
    "timestamp",
    "timestampunix",
    "stamp",
    "timestamps",
    "sampletime",
    "timestampsample",
    "headerstamp",
];
/// Names of another clock.
const CLOCK: &[&str] = &[
    "clock",
    "datetime",
    "elapsed",
    "elapsedtime",
    "epoch",
    "epochtime",
    "gpstime",
    "localtime",
    "rtc",
    "rtctime",
    "systemtime",
    "timeofday",
    "unixtime",
    "uptime",
    "utc",
    "utctime",
];
/// Names before the unit of a clock, as in `TimeUS`.
const BEFORE_UNIT: &[&str] =
    &["", "time", "timestamp", "elapsed", "uptime", "clock", "epoch", "epoc", "unix", "sample"];
/// Names of a sample counter.
const COUNTER: &[&str] = &[
    "nsamples",
    "sample",
    "samples",
    "samplenumber",
    "sampleindex",
    "index",
    "count",
    "counter",
    "packetcounter",
    "seq",
];
/// Names of an accelerometer.
const ACCELEROMETER: &[&str] = &[
    "a",
    "ac",
    "acc",
    "accadc",
    "accsmooth",
    "accel",
    "accelln",
    "accelerometer",
    "acceleration",
    "linearacceleration",
    "totalacceleration",
    "arss",
    "rawacc",
    "accraw",
];
/// Names of a gyroscope.
const GYROSCOPE: &[&str] = &[
    "g",
    "w",
    "gy",
    "gyr",
    "gyro",
    "gyroadc",
    "gyroscope",
    "omega",
    "angularvelocity",
    "angularrate",
    "wrss",
    "rawgyro",
    "rate",
];
/// Names of an acceleration without gravity.
const GRAVITY_REMOVED: &[&str] = &["freeacc", "useracceleration", "useracc", "linacc", "linaccel", "lia"];
/// Names of a temperature.
const TEMPERATURE: &[&str] = &["temp", "temperature", "imutemp", "sensortemp"];
/// Names of a magnetometer.
const MAGNETOMETER: &[&str] = &["m", "mag", "magnetometer", "magneticfield"];
/// Names of an orientation.
const ORIENTATION: &[&str] = &["quat", "q", "orientation", "euler"];

/// The column of this name.
pub(crate) fn column(name: &str) -> ImuColumn {
    let (base, unit) = split_unit(name);
    // as Shimmer marks what it converted
    let base = base.strip_suffix("_cal").unwrap_or(&base);
    let meaning = meaning(base, unit.as_deref());
    // an ending that is no unit of such a column belongs to the name
    let unit = match (meaning, unit.as_deref()) {
        (ColumnMeaning::Time | ColumnMeaning::Clock, Some(unit)) => {
            TimeUnit::parse(unit).map(ColumnUnit::Time)
        }
        (ColumnMeaning::Clock, None) => unit_in_name(&plain(base)).map(ColumnUnit::Time),
        (ColumnMeaning::Counter, _) => Some(ColumnUnit::Time(TimeUnit::Sample)),
        (ColumnMeaning::Reading(sensor_kind, _), Some(unit)) => {
            ImuUnit::parse(unit).filter(|unit| unit.suits(sensor_kind)).map(ColumnUnit::Reading)
        }
        (ColumnMeaning::Temperature, Some(unit)) => is_celsius(unit).then_some(ColumnUnit::Celsius),
        _ => None,
    };
    let mut column = ImuColumn::new(name, meaning, unit);
    if meaning == ColumnMeaning::Temperature && unit.is_none() {
        column.unused = Some("its name does not say °C: `temp_c` does, and [columns] temperature too".into());
    }
    column
}

/// The sensor of this name: `Accel`, `gyroscope`.
pub(super) fn sensor_named(name: &str) -> Option<SensorKind> {
    let plain = plain(&name.to_lowercase());
    let names = [(SensorKind::Accelerometer, ACCELEROMETER), (SensorKind::Gyroscope, GYROSCOPE)];
    names.into_iter().find(|(_, names)| names.contains(&plain.as_str())).map(|(sensor_kind, _)| sensor_kind)
}

/// Is it `ax`, `ay` or `az`, with or without a unit?
pub(super) fn is_plain_axis(name: &str) -> bool {
    ["ax", "ay", "az"].contains(&split_unit(name).0.as_str())
}

fn is_celsius(unit: &str) -> bool {
    ["c", "°c", "degc", "deg c", "celsius"].contains(&unit)
}

/// Name in lower case without its unit, and the unit: in brackets, or after the last `_`.
fn split_unit(name: &str) -> (String, Option<String>) {
    let lower = name.trim().to_lowercase();
    // `gyro_rad[0]` of PX4 is in rad/s
    let axis = ["x", "y", "z"].into_iter().zip(["[0]", "[1]", "[2]"]);
    if let Some((stem, axis)) =
        axis.into_iter().find_map(|(axis, end)| Some((lower.strip_suffix(end)?, axis)))
    {
        let (base, unit) = match stem.strip_suffix("_rad") {
            Some(base) => (base.to_owned(), Some("rad/s".to_owned())),
            None => split_unit(stem),
        };
        return (format!("{base} {axis}"), unit);
    }
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((base, rest)) = lower.split_once(open)
            && let Some(unit) = rest.strip_suffix(close)
            && !base.trim().is_empty()
        {
            return (base.trim().to_owned(), Some(unit.trim().to_owned()));
        }
    }
    // longest ending first: `_rad_s` before `_s`
    for (at, _) in lower.match_indices(['_', ' ']) {
        let (base, ending) = (&lower[..at], &lower[at + 1..]);
        let is_time = TimeUnit::parse(ending).is_some_and(|unit| unit != TimeUnit::Sample);
        let known = ImuUnit::parse(ending).is_some() || is_time || is_celsius(ending);
        if known && !base.is_empty() {
            return (base.to_owned(), Some(ending.to_owned()));
        }
    }
    (lower, None)
}

fn meaning(base: &str, unit: Option<&str>) -> ColumnMeaning {
    let plain = plain(base);
    if TIME.contains(&plain.as_str()) {
        return ColumnMeaning::Time;
    }
    if CLOCK.contains(&plain.as_str()) || unit_in_name(&plain).is_some() {
        return ColumnMeaning::Clock;
    }
    if COUNTER.contains(&plain.as_str()) {
        return ColumnMeaning::Counter;
    }
    if TEMPERATURE.contains(&plain.as_str()) {
        return ColumnMeaning::Temperature;
    }
    // `g_x` may be gravity, and `a_x` is no worse than `ax`; `gx` alone is a gyroscope's
    let ends = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];
    let of_axis = plain.strip_suffix("axis").unwrap_or(&plain);
    let Some((stem, axis)) =
        ends.into_iter().find_map(|(end, axis)| of_axis.strip_suffix(end).map(|stem| (stem, axis)))
    else {
        return if ORIENTATION.iter().any(|word| plain == format!("{word}w")) || is_angle(&plain) {
            ColumnMeaning::Orientation
        } else {
            ColumnMeaning::Other
        };
    };
    let of_unit = unit.and_then(sensor_of_unit);
    let is_gravity = stem == "g" && base.len() != plain.len() && of_unit != Some(SensorKind::Gyroscope);
    if let (Some(sensor_kind), "") = (of_unit, stem) {
        ColumnMeaning::Reading(sensor_kind, axis)
    } else if ACCELEROMETER.contains(&stem) {
        ColumnMeaning::Reading(SensorKind::Accelerometer, axis)
    } else if GYROSCOPE.contains(&stem) && !is_gravity {
        ColumnMeaning::Reading(SensorKind::Gyroscope, axis)
    } else if GRAVITY_REMOVED.contains(&stem) {
        ColumnMeaning::GravityRemoved
    } else if MAGNETOMETER.contains(&stem) {
        ColumnMeaning::Magnetometer
    } else if ORIENTATION.contains(&stem) {
        ColumnMeaning::Orientation
    } else {
        ColumnMeaning::Other
    }
}

/// The one sensor that has this unit.
fn sensor_of_unit(unit: &str) -> Option<SensorKind> {
    let unit = ImuUnit::parse(unit).filter(|unit| *unit != ImuUnit::Counts)?;
    SensorKind::ALL.into_iter().find(|sensor_kind| unit.suits(*sensor_kind))
}

fn plain(base: &str) -> String {
    base.chars().filter(|c| c.is_alphanumeric()).collect()
}

/// The unit that is the name of a clock, or its end: `millis`, `TimeUS`. A single `s` is none.
fn unit_in_name(plain: &str) -> Option<TimeUnit> {
    let unit = |before: &&str| TimeUnit::parse(plain.strip_prefix(*before).filter(|rest| rest.len() > 1)?);
    let elapsed = || TimeUnit::parse(plain.strip_suffix("elapsed").filter(|rest| rest.len() > 1)?);
    BEFORE_UNIT.iter().find_map(unit).or_else(elapsed).filter(|unit| *unit != TimeUnit::Sample)
}

/// Is it the clock of the sample, where another one is that of its message?
pub(super) fn is_of_sample(name: &str) -> bool {
    ["timestampsample", "sampleus"].contains(&plain(&name.to_lowercase()).as_str())
}

fn is_angle(plain: &str) -> bool {
    ["roll", "pitch", "yaw", "heading"].contains(&plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_sensor_axis_and_unit() {
        let reading = |sensor_kind, axis, unit: Option<ImuUnit>| {
            (ColumnMeaning::Reading(sensor_kind, axis), unit.map(ColumnUnit::Reading))
        };
        let (a, g) = (SensorKind::Accelerometer, SensorKind::Gyroscope);
        for (name, expected) in [
            ("ax", reading(a, Axis::X, None)),
            ("Acc_Y", reading(a, Axis::Y, None)),
            ("az_mps2", reading(a, Axis::Z, Some(ImuUnit::MetrePerSecondSquared))),
            ("accel x (m/s^2)", reading(a, Axis::X, Some(ImuUnit::MetrePerSecondSquared))),
            ("linear_acceleration.x", reading(a, Axis::X, None)),
            ("ax_g", reading(a, Axis::X, Some(ImuUnit::StandardGravity))),
            ("ax_counts", reading(a, Axis::X, Some(ImuUnit::Counts))),
            ("ax_m_s2", reading(a, Axis::X, Some(ImuUnit::MetrePerSecondSquared))),
            ("a_RS_S_y [m s^-2]", reading(a, Axis::Y, Some(ImuUnit::MetrePerSecondSquared))),
            ("gx_radps", reading(g, Axis::X, Some(ImuUnit::RadianPerSecond))),
            ("gyro_z_rad_s", reading(g, Axis::Z, Some(ImuUnit::RadianPerSecond))),
            ("GyroX [deg/s]", reading(g, Axis::X, Some(ImuUnit::DegreePerSecond))),
            ("wy_dps", reading(g, Axis::Y, Some(ImuUnit::DegreePerSecond))),
            ("w_RS_S_x [rad s^-1]", reading(g, Axis::X, Some(ImuUnit::RadianPerSecond))),
            ("g_x", (ColumnMeaning::Other, None)),
            ("gravity_x", (ColumnMeaning::Other, None)),
            ("userAcceleration.x", (ColumnMeaning::GravityRemoved, None)),
            ("orientation.w", (ColumnMeaning::Orientation, None)),
            ("timestamp [ns]", (ColumnMeaning::Time, Some(ColumnUnit::Time(TimeUnit::Nanosecond)))),
            ("t_us", (ColumnMeaning::Time, Some(ColumnUnit::Time(TimeUnit::Microsecond)))),
            ("time", (ColumnMeaning::Time, None)),
            ("n_samples", (ColumnMeaning::Counter, Some(ColumnUnit::Time(TimeUnit::Sample)))),
            ("millis", (ColumnMeaning::Clock, Some(ColumnUnit::Time(TimeUnit::Millisecond)))),
            ("ms", (ColumnMeaning::Clock, Some(ColumnUnit::Time(TimeUnit::Millisecond)))),
            ("TimeUS", (ColumnMeaning::Clock, Some(ColumnUnit::Time(TimeUnit::Microsecond)))),
            ("seconds_elapsed", (ColumnMeaning::Clock, Some(ColumnUnit::Time(TimeUnit::Second)))),
            ("elapsed (s)", (ColumnMeaning::Clock, Some(ColumnUnit::Time(TimeUnit::Second)))),
            ("rtcTime", (ColumnMeaning::Clock, None)),
            ("times", (ColumnMeaning::Other, None)),
            ("temp_c", (ColumnMeaning::Temperature, Some(ColumnUnit::Celsius))),
            ("Temperature (°C)", (ColumnMeaning::Temperature, Some(ColumnUnit::Celsius))),
            ("temp", (ColumnMeaning::Temperature, None)),
            ("label", (ColumnMeaning::Other, None)),
        ] {
            let column = column(name);
            assert_eq!((column.meaning, column.unit), expected, "{name}");
        }
    }
}

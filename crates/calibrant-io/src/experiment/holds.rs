//! Reads `[holds]`: static calibration in several poses.

use super::direction::direction;
use super::gravity::{LATITUDE, read_gravity};
use super::motion::RATE_HZ;
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::error::Result;
use calibrant_core::estimate::HoldsSetup;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::Gauge;
use nalgebra::Vector3;

/// Range of the face alignment. Faces with a larger tilt are not faces.
const TILT: Bounds = Bounds::from(0.0, 10.0, "degrees");
/// Range of a time.
const TIME: Bounds = Bounds::from(-1e12, 1e12, "s");
/// Range of a duration.
const DURATION: Bounds = Bounds::above(0.0, 1e6, "s");

/// A static calibration, as `[holds]` describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldsPlan {
    /// Gravity where the recording was made.
    pub gravity: Gravity,
    /// Geographic latitude, degrees, where it is given. It determines Earth's rate.
    pub latitude_deg: Option<f64>,
    /// The source of the value of gravity, in words: `given`, or `from latitude 52.2°, height 30 m`.
    pub gravity_source: String,
    /// Convention that fixes the true frame.
    pub gauge: Gauge,
    /// Start and end of each hold, s, in order, where the user gives them. Otherwise the program searches for
    /// them.
    pub intervals_s: Option<Vec<(f64, f64)>>,
    /// Direction of the specific force (up) in each of these holds, where it is known.
    pub directions: Option<Vec<Vector3<f64>>>,
    /// Face alignment of these directions, rad about each axis. Where it is not given, the scatter of the
    /// holds determines it.
    pub face_sd_rad: Option<f64>,
    /// Standard deviation of the drift of each bias from the first hold to the last, m/s². By default 2 mg, as while a MEMS sensor warms up.
    pub bias_drift_sd_mps2: f64,
    /// Scatter between holds that the noise does not explain, m/s², for a simulated recording and a design of poses.
    pub between_holds_sd_mps2: f64,
    /// Shortest stationary interval that counts as a hold, s.
    pub minimum_hold_s: f64,
    /// Number of poses of a simulated recording.
    pub poses: usize,
    /// Duration of each simulated hold, s.
    pub hold_s: f64,
    /// Sample rate of a simulated recording, Hz.
    pub rate_hz: f64,
}

impl HoldsPlan {
    /// The setup of such a recording.
    #[must_use]
    pub fn setup(&self) -> HoldsSetup {
        HoldsSetup {
            gravity: self.gravity,
            gauge: self.gauge,
            intervals_s: self.intervals_s.clone(),
            bias_drift_sd_mps2: self.bias_drift_sd_mps2,
            minimum_hold_s: self.minimum_hold_s,
            found: None,
        }
    }
}

/// Usual drift of a bias over a recording, m/s².
const BIAS_DRIFT_SD_MPS2: f64 = 0.02;
/// Range of it, and of the scatter between holds.
const BIAS_DRIFT: Bounds = Bounds::from(0.0, 100.0, "m/s²");

/// Reads `[holds]`. The gyroscope of an IMU senses Earth's rate: a latitude beside a value of gravity serves
/// for that.
pub(super) fn read(section: &Section<'_>, is_imu: bool) -> Result<HoldsPlan> {
    let (gravity, gravity_source) = read_gravity(section, is_imu)?;
    let latitude_deg = section.get("latitude_deg").map(|entry| entry.number(&LATITUDE)).transpose()?;
    let gauge = section
        .need("gauge", "gauge = \"upper\" (as imu_tk), \"lower\" (as Kalibr) or \"symmetric\"")?
        .word(&[("lower", Gauge::Lower), ("upper", Gauge::Upper), ("symmetric", Gauge::Symmetric)])?;
    let number = |key: &str, bounds: &Bounds, otherwise: f64| {
        section.get(key).map_or(Ok(otherwise), |entry| entry.number(bounds))
    };
    let poses = section.get("poses").map_or(Ok(24), |entry| entry.size(1, 1_000_000))?;
    let hold_s = number("hold_s", &DURATION, 5.0)?;
    let rate_hz = number("rate_hz", &RATE_HZ, 100.0)?;
    if hold_s * rate_hz < 1.0 - 1e-9 {
        let message = format!("a hold of {hold_s} s at {rate_hz} Hz has less than one sample step");
        return Err(section.reject(&message, "raise rate_hz or hold_s", ""));
    }
    let intervals_s = section.get("intervals_s").map(|entry| read_intervals(&entry)).transpose()?;
    let directions =
        section.get("directions").map(|entry| read_directions(&entry, intervals_s.as_deref())).transpose()?;
    let face_sd = section.get("face_sd_deg").map(|entry| entry.number(&TILT)).transpose()?;
    Ok(HoldsPlan {
        gravity,
        latitude_deg,
        gravity_source,
        gauge,
        intervals_s,
        directions,
        face_sd_rad: face_sd.map(f64::to_radians),
        bias_drift_sd_mps2: number("bias_drift_sd_mps2", &BIAS_DRIFT, BIAS_DRIFT_SD_MPS2)?,
        between_holds_sd_mps2: number("between_holds_sd_mps2", &BIAS_DRIFT, 0.0)?,
        minimum_hold_s: number("minimum_hold_s", &DURATION, 1.0)?,
        poses,
        hold_s,
        rate_hz,
    })
}

fn read_directions(entry: &Entry<'_>, intervals: Option<&[(f64, f64)]>) -> Result<Vec<Vector3<f64>>> {
    /// The remedy for wrong directions.
    const HELP: &str =
        "one for each of intervals_s, in the same order: [\"x\", \"-x\", \"y\", \"-y\", \"z\", \"-z\"]";
    let directions: Vec<Vector3<f64>> = entry.items(HELP)?.iter().map(direction).collect::<Result<_>>()?;
    if intervals.map_or(0, <[_]>::len) == directions.len() {
        return Ok(directions);
    }
    let message = format!("{} directions for {} holds", directions.len(), intervals.map_or(0, <[_]>::len));
    Err(entry.reject(message, HELP))
}

fn read_intervals(entry: &Entry<'_>) -> Result<Vec<(f64, f64)>> {
    /// The remedy for wrong intervals.
    const HELP: &str = "start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]]";
    let mut intervals: Vec<(f64, f64)> = Vec::new();
    let items = entry.items(HELP)?;
    if items.is_empty() {
        return Err(entry.reject("no hold is given", format!("{HELP}; without this key they are looked for")));
    }
    for item in items {
        let pair = item.items(HELP)?;
        let [start, end] = pair.as_slice() else {
            return Err(item.reject(format!("a hold has two numbers, this has {}", pair.len()), HELP));
        };
        let (start, end) = (start.number(&TIME)?, end.number(&TIME)?);
        if end <= start {
            return Err(
                item.reject(format!("the hold ends at {end} s, not after its start at {start} s"), HELP)
            );
        }
        if let Some(&(_, before)) = intervals.last().filter(|(_, before)| *before > start) {
            let message = format!("the hold starts at {start} s, before the one above ends at {before} s");
            return Err(item.reject(message, "sort the holds by time; they must not overlap"));
        }
        intervals.push((start, end));
    }
    Ok(intervals)
}

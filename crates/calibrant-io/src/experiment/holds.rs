//! `[holds]`: static calibration in several poses.

use super::direction::{Direction, unit_vectors};
use super::gravity::GravityKeys;
use super::number::{Count, Within};
use super::ranges::{Duration, GravityMps2, GravitySd, Height, HoldSd, Latitude, Rate, SmallTilt, Time};
use super::refused_key::refused;
use super::remedies::remedy;
use calibrant_core::error::Result;
use calibrant_core::estimate::HoldsSetup;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::Gauge;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// `[holds]`: the sensor is held still in several orientations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HoldsSection {
    /// Magnitude of gravity. Latitude and height may stand in its place.
    pub gravity_mps2: Option<Within<GravityMps2>>,
    /// Its standard uncertainty.
    pub gravity_sd_mps2: Option<Within<GravitySd>>,
    /// Geographic latitude. It determines Earth's rate, too.
    pub latitude_deg: Option<Within<Latitude>>,
    /// Height above the sea.
    pub height_m: Option<Within<Height>>,
    /// Convention that fixes the true frame.
    pub gauge: Gauge,
    /// Start and end of each hold, in order. Without it the program searches for them.
    pub intervals_s: Option<Vec<Vec<Within<Time>>>>,
    /// Direction of the specific force (up) in each of these holds, where it is known.
    pub directions: Option<Vec<Direction>>,
    /// Face alignment of these directions about each axis. Without it, the scatter of the holds determines it.
    pub face_sd_deg: Option<Within<SmallTilt>>,
    /// Standard deviation of the drift of each bias from the first hold to the last.
    pub bias_drift_sd_mps2: Option<Within<HoldSd>>,
    /// Scatter between holds that the noise does not explain.
    pub between_holds_sd_mps2: Option<Within<HoldSd>>,
    /// Shortest stationary interval that counts as a hold.
    pub minimum_hold_s: Option<Within<Duration>>,
    /// Number of poses of a simulated recording or a design.
    pub poses: Option<Count<1, 1_000_000>>,
    /// Duration of each of these holds.
    pub hold_s: Option<Within<Duration>>,
    /// Sample rate of a simulated recording.
    pub rate_hz: Option<Within<Rate>>,
}

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

impl HoldsSection {
    /// The plan of such a calibration. The gyroscope of an IMU senses Earth's rate: a latitude beside a value
    /// of gravity serves for that.
    pub(super) fn plan(&self, is_imu: bool) -> Result<HoldsPlan> {
        let keys = GravityKeys {
            section: "holds",
            gravity_mps2: self.gravity_mps2.map(f64::from),
            gravity_sd_mps2: self.gravity_sd_mps2,
            latitude_deg: self.latitude_deg,
            height_m: self.height_m,
        };
        let (gravity, gravity_source) = keys.magnitude(is_imu)?;
        let otherwise = HoldsSetup::default();
        let hold_s = self.hold_s.map_or(5.0, f64::from);
        let rate_hz = self.rate_hz.map_or(100.0, f64::from);
        if hold_s * rate_hz < 1.0 - 1e-9 {
            let message = format!("a hold of {hold_s} s at {rate_hz} Hz has less than one sample step");
            return Err(refused("holds", message, "raise rate_hz or hold_s"));
        }
        let intervals_s = self.intervals_s.as_deref().map(intervals).transpose()?;
        Ok(HoldsPlan {
            gravity,
            latitude_deg: self.latitude_deg.map(f64::from),
            gravity_source,
            gauge: self.gauge,
            directions: self.directions_of(intervals_s.as_ref().map_or(0, Vec::len))?,
            intervals_s,
            face_sd_rad: self.face_sd_deg.map(|sd| sd.get().to_radians()),
            bias_drift_sd_mps2: self.bias_drift_sd_mps2.map_or(otherwise.bias_drift_sd_mps2, f64::from),
            between_holds_sd_mps2: self.between_holds_sd_mps2.map_or(0.0, f64::from),
            minimum_hold_s: self.minimum_hold_s.map_or(otherwise.minimum_hold_s, f64::from),
            poses: self.poses.map_or(24, Count::size),
            hold_s,
            rate_hz,
        })
    }

    fn directions_of(&self, holds: usize) -> Result<Option<Vec<Vector3<f64>>>> {
        let Some(directions) = &self.directions else { return Ok(None) };
        let vectors = unit_vectors("holds.directions", directions)?;
        if vectors.len() == holds {
            return Ok(Some(vectors));
        }
        let message = format!("{} directions for {holds} holds", vectors.len());
        Err(refused("holds.directions", message, remedy("holds.directions")))
    }
}

fn intervals(given: &[Vec<Within<Time>>]) -> Result<Vec<(f64, f64)>> {
    let help = remedy("holds.intervals_s");
    let mut intervals: Vec<(f64, f64)> = Vec::new();
    if given.is_empty() {
        let help = format!("{help}; without this key they are looked for");
        return Err(refused("holds.intervals_s", "no hold is given", help));
    }
    for (number, pair) in given.iter().enumerate() {
        let reject =
            |message: String, help: &str| Err(refused(format!("holds.intervals_s[{number}]"), message, help));
        let [start, end] = pair.as_slice() else {
            return reject(format!("a hold has two numbers, this has {}", pair.len()), help);
        };
        let (start, end) = (start.get(), end.get());
        if end <= start {
            return reject(format!("the hold ends at {end} s, not after its start at {start} s"), help);
        }
        if let Some(&(_, before)) = intervals.last().filter(|(_, before)| *before > start) {
            let message = format!("the hold starts at {start} s, before the one above ends at {before} s");
            return reject(message, "sort the holds by time; they must not overlap");
        }
        intervals.push((start, end));
    }
    Ok(intervals)
}

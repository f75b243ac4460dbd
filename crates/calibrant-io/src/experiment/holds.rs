//! `[holds]`: static calibration in several poses.

use super::direction::Direction;
use super::gravity::gravity_of;
use super::number::{Within, size, within};
use super::ranges::{Duration, GravityMps2, GravitySd, Height, HoldSd, Latitude, Rate, SmallTilt, Time};
use super::refused_key::refused;
use super::remedies::remedy;
use calibrant_core::error::Result;
use calibrant_core::estimate::HoldsSetup;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::{Gauge, NonlinearTerm, ParameterList, SensorModel};
use nalgebra::Vector3;
use serde::{Deserialize, Deserializer, Serialize};

/// `[holds]`: the sensor is held still in several orientations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HoldsPlan {
    /// Magnitude of gravity. Latitude and height may stand in its place.
    pub gravity_mps2: Option<Within<GravityMps2>>,
    /// Its standard uncertainty.
    pub gravity_sd_mps2: Option<Within<GravitySd>>,
    /// Geographic latitude. It determines Earth's rate, too.
    pub latitude_deg: Option<Within<Latitude>>,
    /// Height above the sea.
    pub height_m: Option<Within<Height>>,
    /// Convention that fixes the true frame. A file states it.
    pub gauge: Gauge,
    /// Terms that bend the accelerometer's response, to be estimated: "second-order", "gain-by-sign". None without it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub nonlinearity: Vec<NonlinearTerm>,
    /// Start and end of each hold, s, in order. Without it the program searches for them.
    #[serde(deserialize_with = "intervals")]
    pub intervals_s: Option<Vec<(f64, f64)>>,
    /// Direction of the specific force (up) in each of these holds, where it is known. Without intervals: those that the holds of a recording are in, in any order.
    pub directions: Option<Vec<Direction>>,
    /// Face alignment of these directions about each axis. Without it, the scatter of the holds determines it.
    pub face_sd_deg: Option<Within<SmallTilt>>,
    /// Standard deviation of the drift of each bias from the first hold to the last, m/s². By default 2 mg, as while a MEMS sensor warms up.
    #[serde(deserialize_with = "within::<HoldSd, _>")]
    pub bias_drift_sd_mps2: f64,
    /// Scatter between holds that the noise does not explain, m/s², for a simulated recording and a design of poses.
    #[serde(deserialize_with = "within::<HoldSd, _>")]
    pub between_holds_sd_mps2: f64,
    /// Shortest stationary interval that counts as a hold, s.
    #[serde(deserialize_with = "within::<Duration, _>")]
    pub minimum_hold_s: f64,
    /// Number of poses of a simulated recording or a design.
    #[serde(deserialize_with = "size::<1, 1_000_000, _>")]
    pub poses: usize,
    /// Duration of each of these holds, s.
    #[serde(deserialize_with = "within::<Duration, _>")]
    pub hold_s: f64,
    /// Sample rate of a simulated recording, Hz.
    #[serde(deserialize_with = "within::<Rate, _>")]
    pub rate_hz: f64,
}

impl Default for HoldsPlan {
    fn default() -> Self {
        let HoldsSetup { gauge, bias_drift_sd_mps2, minimum_hold_s, .. } = HoldsSetup::default();
        Self {
            gravity_mps2: None,
            gravity_sd_mps2: None,
            latitude_deg: None,
            height_m: None,
            gauge,
            nonlinearity: Vec::new(),
            intervals_s: None,
            directions: None,
            face_sd_deg: None,
            bias_drift_sd_mps2,
            between_holds_sd_mps2: 0.0,
            minimum_hold_s,
            poses: 24,
            hold_s: 5.0,
            rate_hz: 100.0,
        }
    }
}

/// A hold, as a file has it.
#[derive(Deserialize)]
#[serde(try_from = "Vec<Within<Time>>")]
struct Interval(f64, f64);

impl TryFrom<Vec<Within<Time>>> for Interval {
    type Error = String;

    fn try_from(pair: Vec<Within<Time>>) -> std::result::Result<Self, String> {
        let refused = |message: String| Err(format!("{message}\n{}", remedy("holds.intervals_s")));
        let [start, end] = pair.as_slice() else {
            return refused(format!("a hold has two numbers, this has {}", pair.len()));
        };
        let (start, end) = (start.get(), end.get());
        if end <= start {
            return refused(format!("the hold ends at {end} s, not after its start at {start} s"));
        }
        Ok(Self(start, end))
    }
}

fn intervals<'de, D>(deserializer: D) -> std::result::Result<Option<Vec<(f64, f64)>>, D::Error>
where
    D: Deserializer<'de>,
{
    let given = Vec::<Interval>::deserialize(deserializer)?;
    Ok(Some(given.into_iter().map(|Interval(start, end)| (start, end)).collect()))
}

impl HoldsPlan {
    /// The setup of such a recording.
    ///
    /// # Errors
    /// As [`gravity`](Self::gravity).
    pub fn setup(&self) -> Result<HoldsSetup> {
        Ok(HoldsSetup {
            gravity: self.gravity()?,
            gauge: self.gauge,
            nonlinearity: self.nonlinearity.clone(),
            intervals_s: self.intervals_s.clone(),
            bias_drift_sd_mps2: self.bias_drift_sd_mps2,
            minimum_hold_s: self.minimum_hold_s,
            ..HoldsSetup::default()
        })
    }

    /// Gravity where the recording was made.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where neither a value of it nor latitude and height are given.
    pub fn gravity(&self) -> Result<Gravity> {
        // beside a value, a latitude serves for Earth's rate: `check` says for which sensors
        self.gravity_where(true)
    }

    /// The parameters that a calibration estimates of an accelerometer of this model: those of the gauge, or all where the directions of the holds are known.
    #[must_use]
    pub fn parameter_list(&self, model: SensorModel, known_directions: bool) -> ParameterList {
        let linear = match known_directions {
            true => ParameterList::new(3, model),
            false => self.gauge.parameter_list(model),
        };
        linear.with_terms(&self.nonlinearity)
    }

    /// The unit vectors of the directions, where they are known.
    #[must_use]
    pub fn directions(&self) -> Option<Vec<Vector3<f64>>> {
        Some(self.directions.as_ref()?.iter().map(Direction::unit).collect())
    }

    /// Face alignment of the directions, rad about each axis, where it is given.
    #[must_use]
    pub fn face_sd_rad(&self) -> Option<f64> {
        self.face_sd_deg.map(|sd| sd.get().to_radians())
    }

    fn gravity_where(&self, with_earth_rate: bool) -> Result<Gravity> {
        let value = (self.gravity_mps2.map(f64::from), self.gravity_sd_mps2);
        gravity_of("holds", value, (self.latitude_deg, self.height_m), with_earth_rate)
    }

    /// Refuses keys that contradict each other. The gyroscope of an IMU senses Earth's rate: a latitude beside
    /// a value of gravity serves for that.
    pub(super) fn check(&self, is_imu: bool) -> Result<()> {
        self.gravity_where(is_imu)?;
        let (hold_s, rate_hz) = (self.hold_s, self.rate_hz);
        if hold_s * rate_hz < 1.0 - 1e-9 {
            let message = format!("a hold of {hold_s} s at {rate_hz} Hz has less than one sample step");
            return Err(refused("holds", message, "raise rate_hz or hold_s"));
        }
        if let Some(twice) =
            (1..self.nonlinearity.len()).find(|&k| self.nonlinearity[..k].contains(&self.nonlinearity[k]))
        {
            let message = "this term stands twice";
            return Err(refused(format!("holds.nonlinearity[{twice}]"), message, "keep one of the two"));
        }
        let intervals = self.intervals_s.as_deref().unwrap_or_default();
        if self.intervals_s.is_some() && intervals.is_empty() {
            let help = format!("{}; without this key they are looked for", remedy("holds.intervals_s"));
            return Err(refused("holds.intervals_s", "no hold is given", help));
        }
        if let Some(late) = intervals.windows(2).position(|pair| pair[1].0 < pair[0].1) {
            let (start, before) = (intervals[late + 1].0, intervals[late].1);
            let message = format!("the hold starts at {start} s, before the one above ends at {before} s");
            let help = "sort the holds by time; they must not overlap";
            return Err(refused(format!("holds.intervals_s[{}]", late + 1), message, help));
        }
        match &self.directions {
            // without intervals the holds are found, or each direction has a recording of its own
            Some(directions) if self.intervals_s.is_some() && directions.len() != intervals.len() => {
                let message = format!("{} directions for {} holds", directions.len(), intervals.len());
                Err(refused("holds.directions", message, remedy("holds.directions")))
            }
            _ => Ok(()),
        }
    }
}

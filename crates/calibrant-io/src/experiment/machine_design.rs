//! `[machine.design]`: the trajectory that is designed.

use super::fault::unknown_word;
use super::number::{Within, within};
use super::ranges::{JointPosition, MovingNoise, Rate, TrajectoryDuration, TrajectoryKnot};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// `[machine.design]`: the trajectory that is designed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineDesignSection {
    /// Its duration, s.
    #[serde(deserialize_with = "within::<TrajectoryDuration, _>")]
    pub duration_s: f64,
    /// Sample rate of the IMU, Hz.
    #[serde(deserialize_with = "within::<Rate, _>")]
    pub rate_hz: f64,
    /// Posture at its beginning and its end; free without it.
    pub home: Option<Vec<Within<JointPosition>>>,
    /// Noise while the machine moves over noise at rest.
    #[serde(deserialize_with = "within::<MovingNoise, _>")]
    pub moving_noise: f64,
    /// How often it stands still.
    pub dwells: Dwells,
    /// Distance of the knots, s.
    #[serde(deserialize_with = "within::<TrajectoryKnot, _>")]
    pub knot_s: f64,
}

impl Default for MachineDesignSection {
    fn default() -> Self {
        Self {
            duration_s: 20.0,
            rate_hz: 200.0,
            home: None,
            moving_noise: 1.0,
            dwells: Dwells::Auto,
            knot_s: 0.2,
        }
    }
}

/// How often the machine stands still, the ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dwells {
    /// Not at all.
    None,
    /// As often as it pays.
    Auto,
    /// So often.
    Number(usize),
}

/// Most dwells.
const MOST_DWELLS: i64 = 100;

impl Serialize for Dwells {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::None => serializer.serialize_str("none"),
            Self::Auto => serializer.serialize_str("auto"),
            Self::Number(number) => serializer.serialize_u64(*number as u64),
        }
    }
}

impl<'de> Deserialize<'de> for Dwells {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct WordOrNumber;

        impl serde::de::Visitor<'_> for WordOrNumber {
            type Value = Dwells;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a word or a number\n\"none\", \"auto\", or a whole number up to {MOST_DWELLS}")
            }

            fn visit_str<E: serde::de::Error>(self, word: &str) -> std::result::Result<Dwells, E> {
                match word {
                    "none" => Ok(Dwells::None),
                    "auto" => Ok(Dwells::Auto),
                    other => Err(E::custom(unknown_word(other, &["none", "auto"]))),
                }
            }

            fn visit_i64<E: serde::de::Error>(self, number: i64) -> std::result::Result<Dwells, E> {
                let within = usize::try_from(number).ok().filter(|_| number <= MOST_DWELLS);
                within
                    .map(Dwells::Number)
                    .ok_or_else(|| E::invalid_value(serde::de::Unexpected::Signed(number), &self))
            }
        }
        deserializer.deserialize_any(WordOrNumber)
    }
}

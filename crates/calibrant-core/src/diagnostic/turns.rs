//! Checks of turns of known angle.

use super::check::checks;
use super::direction::direction_in_words;
use super::parts::{Part, Parts, neither};
use nalgebra::Vector3;
use std::fmt;

checks! {
    /// The gyroscope shows the same share of the angle of every turn.
    TurnShare "turn-share" Warning {
        /// The share.
        share: f64,
        /// The mistake of units that explains the share.
        mistake: Option<UnitMistake>,
    }
    decided "The share differs from 1 by more than a quarter, and is the same for all turns."
    remedy "Correct the angle of the turns, the sample rate, or the gyroscope's unit."
    says format!(
        "the gyroscope shows {share:.3} of the angle of every turn: {}",
        mistake.as_ref().map_or_else(
            || "check the angle of the turns, the sample rate and the gyroscope's unit.".to_owned(),
            UnitMistake::to_string,
        )
    );

    /// The gyroscope shows a different turn from the given one.
    TurnUnlikeGiven "turn-unlike-given" Warning {
        /// The turn.
        turn: TurnMismatch,
        /// The mistake of units that explains the difference.
        mistake: Option<UnitMistake>,
    }
    decided "The difference in angle or axis exceeds any error of a sensor."
    remedy "Correct its angle, its axis or its times."
    says match mistake {
        Some(mistake) => format!("{turn}, {mistake}"),
        None => format!("{turn}. Correct its angle, its axis or its times."),
    };

    /// A turn of known angle contradicts the other data.
    TurnContradicted "turn-contradicted" Warning {
        /// The turn.
        turn: TurnSpan,
        /// Its angle as given, rad.
        angle_rad: f64,
        /// The difference, in standard deviations.
        deviations: f64,
    }
    decided "The difference exceeds 4.5 standard deviations."
    remedy "Correct its times, axis and angle."
    says format!(
        "{turn} of {:.1}° contradicts the other data, by {deviations:.0} standard deviations. Check its times, axis and \
         angle.",
        angle_rad.to_degrees()
    );
}

/// A turn by its name or number and its times.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnSpan {
    /// Its number, from 1.
    pub number: usize,
    /// Its name, where it has one.
    pub name: Option<String>,
    /// Begin, s, to the millisecond.
    pub start_s: f64,
    /// End, s, to the millisecond.
    pub end_s: f64,
}

/// `turn 3 (12.0 to 15.512 s)`.
impl fmt::Display for TurnSpan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "{name}")?,
            None => write!(f, "turn {}", self.number)?,
        }
        write!(f, " ({:?} to {:?} s)", self.start_s, self.end_s)
    }
}

impl Part for TurnSpan {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        let name = self.name.clone();
        parts.subject.push(name.unwrap_or_else(|| format!("turn {}", self.number)));
        parts.numbers.extend([
            ("turn", self.number as f64),
            ("start_s", self.start_s),
            ("end_s", self.end_s),
        ]);
    }
}

/// A given turn, and the turn that the gyroscope shows instead.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnMismatch {
    /// The turn.
    pub turn: TurnSpan,
    /// Its angle as given, rad.
    pub given_rad: f64,
    /// About this axis.
    pub given_about: Vector3<f64>,
    /// The angle that the gyroscope shows, rad.
    pub shown_rad: f64,
    /// About this axis.
    pub shown_about: Vector3<f64>,
}

impl fmt::Display for TurnMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} is given as {:.1}° about {}, but the gyroscope shows {:.0}° about {}",
            self.turn,
            self.given_rad.to_degrees(),
            direction_in_words(&self.given_about),
            self.shown_rad.to_degrees(),
            direction_in_words(&self.shown_about)
        )
    }
}

impl Part for TurnMismatch {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        self.turn.add_to(parts, key);
        parts.numbers.extend([("given_rad", self.given_rad), ("shown_rad", self.shown_rad)]);
    }
}

/// A mistake of units, by the factor that it makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitMistake {
    /// The factor is 180/π.
    DegreesAsRadians,
    /// The factor is π/180.
    RadiansAsDegrees,
}

impl fmt::Display for UnitMistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::DegreesAsRadians => {
                "a ratio of about 180/π. Is the angle in radians where degrees are expected (angle_deg = 360.0 for a whole turn)? Or are readings in deg/s read as rad/s?"
            }
            Self::RadiansAsDegrees => "a ratio of about π/180. Are the gyroscope's readings in rad/s, and read as deg/s?",
        })
    }
}

neither!(UnitMistake);

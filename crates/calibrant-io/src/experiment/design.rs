//! `[design]`: the criterion that an optimal motion minimises, and the effort of the search.

use super::number::{Within, size, whole};
use super::poses::{AllowedDirections, DirectionsAre, allowed};
use super::ranges::{Acceleration, Cone, Weight};
use super::refused_key::{missing, refused};
use super::spreads::need_spreads;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ParameterList, Sensor};
use calibrant_design::poses::Allowed;
use calibrant_recording::text::similar_word::{nearest, shorten};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The criterion of a design, by its letter. C is the covariance of the parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CriterionLetter {
    /// `trace C`.
    A,
    /// `ln det C`.
    D,
    /// Largest eigenvalue of C.
    E,
    /// Largest diagonal entry of C.
    M,
    /// Weighted sum `Σ w_i C_ii`; written `c`.
    #[serde(rename = "c")]
    C,
    /// Mean variance of the corrected reading over the operating range.
    I,
}

impl CriterionLetter {
    /// All criteria.
    pub const ALL: [Self; 6] = [Self::A, Self::D, Self::E, Self::M, Self::C, Self::I];

    /// As written in experiment files: `A`, `D`, `E`, `M`, `c`, `I`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::D => "D",
            Self::E => "E",
            Self::M => "M",
            Self::C => "c",
            Self::I => "I",
        }
    }
}

/// The divisor of the parameters before they are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ScaleBy {
    /// Nothing: their units decide.
    #[default]
    None,
    /// Their datasheet spread.
    Datasheet,
}

/// `[design]`: what is designed, and with how much effort.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DesignOptions {
    /// The criterion that is minimised.
    pub criterion: CriterionLetter,
    /// Weights of criterion c by parameter name; parameters that are not named have weight 0.
    pub weights: BTreeMap<String, Within<Weight>>,
    /// Operating range R of criterion I.
    pub range_mps2: Option<Within<Acceleration>>,
    /// The divisor of the parameters before they are compared.
    pub scale_by: ScaleBy,
    /// Number of random starts.
    #[serde(deserialize_with = "size::<1, 1_000_000, _>")]
    pub starts: usize,
    /// Seed of the random starts.
    #[serde(deserialize_with = "whole")]
    pub seed: u64,
    /// Is a lower bound wanted that no admissible motion can beat?
    pub certificate: bool,
    /// What will be known of the directions of poses.
    pub directions: DirectionsAre,
    /// The directions that a pose may have; any without it.
    pub allowed: Option<AllowedDirections>,
    /// The angle around them that is allowed, too.
    pub within_deg: Option<Within<Cone>>,
}

impl Default for DesignOptions {
    fn default() -> Self {
        Self {
            criterion: CriterionLetter::A,
            weights: BTreeMap::new(),
            range_mps2: None,
            scale_by: ScaleBy::None,
            starts: 30,
            seed: 1,
            certificate: true,
            directions: DirectionsAre::Unknown,
            allowed: None,
            within_deg: None,
        }
    }
}

impl DesignOptions {
    /// Will the directions of the holds be known when the sensor is calibrated?
    #[must_use]
    pub fn knows_directions(&self) -> bool {
        self.directions == DirectionsAre::Known
    }

    /// The directions that a pose may have.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) for a list that is empty, or has what is no direction.
    pub fn allowed_directions(&self) -> Result<Allowed> {
        allowed(self.allowed.as_ref(), self.within_deg)
    }

    /// Returns an error where keys contradict each other or the sensor; `list`: the parameters in the gauge of the
    /// experiment.
    pub(super) fn check(&self, sensor: &Sensor, list: &ParameterList) -> Result<()> {
        self.allowed_directions()?;
        // with known directions there is no gauge
        let all = sensor.parameter_list();
        self.check_weights(if self.knows_directions() { &all } else { list })?;
        if self.criterion == CriterionLetter::C && self.weights.values().all(|weight| weight.get() == 0.0) {
            let help = "criterion c needs a weight above 0: weights = { \"scale.x\" = 1.0 }";
            return Err(missing("design.weights", help));
        }
        if self.criterion == CriterionLetter::I && self.range_mps2.is_none() {
            let help = "criterion I needs the operating range: range_mps2 = 20.0";
            return Err(missing("design.range_mps2", help));
        }
        match self.scale_by {
            ScaleBy::Datasheet => need_spreads("design.scale_by", sensor),
            ScaleBy::None => Ok(()),
        }
    }

    fn check_weights(&self, list: &ParameterList) -> Result<()> {
        let Some(name) = self.weights.keys().find(|name| list.position(name).is_none()) else {
            return Ok(());
        };
        let names = list.names();
        let near = nearest(name, names.iter().map(String::as_str));
        let hint = near.map_or(String::new(), |near| format!("did you mean \"{near}\"? "));
        Err(refused(
            format!("design.weights.{name}"),
            format!("this sensor has no parameter \"{}\"", shorten(name)),
            format!("{hint}its parameters are {}", names.join(", ")),
        ))
    }
}

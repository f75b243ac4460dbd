//! Reads `[design]`: the criterion that an optimal motion minimises, and the effort of the search.

use super::known_keys;
use super::number_range::Bounds;
use super::poses::{self, PoseOptions};
use super::spreads::need_spreads;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ParameterList, Sensor};

/// Range of the operating range of criterion I.
const RANGE: Bounds = Bounds::above(0.0, 1e9, "m/s²");
/// Range of a weight of criterion c.
const WEIGHT: Bounds = Bounds::from(0.0, 1e30, "");

/// The criterion of a design, by its letter. C is the covariance of the parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ScaleBy {
    /// Nothing: their units decide.
    #[default]
    None,
    /// Their datasheet spread.
    Datasheet,
}

/// The options of `[design]`.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignOptions {
    /// The criterion that is minimised.
    pub criterion: CriterionLetter,
    /// Weights of criterion c by parameter name; parameters that are not named have weight 0.
    pub weights: Vec<(String, f64)>,
    /// Operating range R of criterion I, m/s².
    pub range_mps2: Option<f64>,
    /// The divisor of the parameters before they are compared.
    pub scale_by: ScaleBy,
    /// Number of random starts.
    pub starts: usize,
    /// Seed of the random starts.
    pub seed: u64,
    /// Is a lower bound wanted that no admissible motion can beat?
    pub certificate: bool,
    /// What a design of poses may choose from.
    pub poses: PoseOptions,
}

impl Default for DesignOptions {
    fn default() -> Self {
        Self {
            criterion: CriterionLetter::A,
            weights: Vec::new(),
            range_mps2: None,
            scale_by: ScaleBy::None,
            starts: 30,
            seed: 1,
            certificate: true,
            poses: PoseOptions::default(),
        }
    }
}

/// Reads `[design]`.
pub(super) fn read(section: &Section<'_>, sensor: &Sensor, list: &ParameterList) -> Result<DesignOptions> {
    use CriterionLetter::{A, C, D, E, I, M};
    let otherwise = DesignOptions::default();
    let poses = poses::read(section)?;
    // with known directions there is no gauge
    let all = sensor.parameter_list();
    let list = if poses.known { &all } else { list };
    let criterion = section.get("criterion").map_or(Ok(otherwise.criterion), |entry| {
        entry.word(&[("A", A), ("D", D), ("E", E), ("M", M), ("c", C), ("I", I)])
    })?;
    let options = DesignOptions {
        criterion,
        weights: read_weights(section, list)?,
        range_mps2: section.get("range_mps2").map(|entry| entry.number(&RANGE)).transpose()?,
        scale_by: section.get("scale_by").map_or(Ok(otherwise.scale_by), |entry| {
            entry.word(&[("none", ScaleBy::None), ("datasheet", ScaleBy::Datasheet)])
        })?,
        starts: section.get("starts").map_or(Ok(otherwise.starts), |entry| entry.size(1, 1_000_000))?,
        seed: section.get("seed").map_or(Ok(otherwise.seed), |entry| entry.whole(0, u64::MAX))?,
        certificate: section.get("certificate").map_or(Ok(otherwise.certificate), |entry| entry.flag())?,
        poses,
    };
    match criterion {
        C if options.weights.iter().all(|(_, weight)| *weight == 0.0) => {
            return Err(section
                .missing("weights", "criterion c needs a weight above 0: weights = { \"scale.x\" = 1.0 }"));
        }
        I if options.range_mps2.is_none() => {
            return Err(
                section.missing("range_mps2", "criterion I needs the operating range: range_mps2 = 20.0")
            );
        }
        _ => (),
    }
    if options.scale_by == ScaleBy::Datasheet {
        need_spreads(section, "scale_by", sensor)?;
    }
    Ok(options)
}

fn read_weights(section: &Section<'_>, list: &ParameterList) -> Result<Vec<(String, f64)>> {
    let Some(entry) = section.get("weights") else { return Ok(Vec::new()) };
    let names = list.names();
    let mut weights = Vec::new();
    for (name, value) in Section::open(&entry, "design.weights")?.entries() {
        if value.is_table() {
            let help = "write for example \"scale.x\" = 1.0";
            return Err(value.reject("the name of a parameter has a dot and so needs quotes", help));
        }
        if list.position(name).is_none() {
            let near = known_keys::nearest(name, names.iter().map(String::as_str));
            let hint = near.map_or(String::new(), |near| format!("did you mean \"{near}\"? "));
            return Err(value.reject(
                format!("this sensor has no parameter \"{}\"", known_keys::shorten(name)),
                format!("{hint}its parameters are {}", names.join(", ")),
            ));
        }
        weights.push((name.to_owned(), value.number(&WEIGHT)?));
    }
    weights.sort_by_key(|(name, _)| list.position(name));
    Ok(weights)
}

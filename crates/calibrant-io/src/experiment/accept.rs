//! `[accept]`: the limits that a result must keep.

use super::number::Within;
use super::ranges::{SdLimit, Value};
use super::refused_key::refused;
use super::remedies::remedy;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::ImuQuantity;
use calibrant_recording::text::similar_word::nearest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `[accept]`: limits of figures, by their names.
pub type AcceptSection = BTreeMap<String, AcceptEntry>;

/// The limits of a figure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AcceptEntry {
    /// The least and the largest accepted value.
    pub range: Option<Vec<Within<Value>>>,
    /// The largest accepted standard deviation.
    pub sd: Option<Within<SdLimit>>,
}

/// Figures that follow from the parameters, or from the fit.
const DERIVED: [&str; 6] = [
    "axis_angle_deg",
    "norm_rms_mps2",
    "rotation_rms_deg",
    "residual_rms",
    "repeatability_mps2",
    "validation_ratio",
];
/// The limits that the section names.
pub(super) fn acceptance_limits(section: &AcceptSection) -> Result<Vec<AcceptanceLimit>> {
    let known = names();
    section
        .iter()
        .map(|(name, entry)| {
            let key = format!("accept.{name}");
            if known.contains(name) {
                return entry.limit(name, key);
            }
            let near = nearest(name, known.iter().map(String::as_str));
            let help = near.map_or_else(
                || format!("a parameter of calibration.json, or one of {}", DERIVED.join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            Err(Error::experiment(InputError::new(Refusal::KeyUnknown, "unknown key", help).about_key(key)))
        })
        .collect()
}

impl AcceptEntry {
    fn limit(&self, name: &str, key: String) -> Result<AcceptanceLimit> {
        let range = self.range.as_deref().map(|range| limits(range, &key)).transpose()?;
        let sd = self.sd.map(f64::from);
        if range.is_none() && sd.is_none() {
            let help = remedy(&key);
            return Err(refused(key, "this limit limits nothing", help));
        }
        Ok(AcceptanceLimit { name: name.to_owned(), range, sd })
    }
}

fn limits(range: &[Within<Value>], key: &str) -> Result<(f64, f64)> {
    let help = "the least and the largest accepted value: [-0.05, 0.05]";
    let reject = |message: &str| Err(refused(format!("{key}.range"), message, help));
    match range {
        [least, most] if least.get() <= most.get() => Ok((least.get(), most.get())),
        [least, most] => {
            let (least, most) = (least.get(), most.get());
            reject(&format!("the least value {least:?} is above the largest, {most:?}"))
        }
        _ => reject("two numbers are needed here"),
    }
}

/// The names of all figures, and those of their groups.
fn names() -> Vec<String> {
    let mut names: Vec<String> = DERIVED.map(String::from).to_vec();
    for quantity in ImuQuantity::all(true, true) {
        let name = quantity.name();
        let group = name.rsplit_once('.').map(|(group, _)| group.to_owned());
        names.extend(group.into_iter().chain([name]));
    }
    names
}

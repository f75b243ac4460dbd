//! What the user says of the columns of a log, where their names do not say it.

use super::orientation_form::OrientationForm;
use crate::recording::TimeUnit;
use serde::de::value::{SeqAccessDeserializer, StrDeserializer};
use serde::de::{Error, IntoDeserializer, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt;

/// What the columns of a log hold. What is not said here, the names of the columns say. A column is given by its name; where the file
/// has no header, by its number, from `"1"`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogColumns {
    /// The column of times, or the two of whole seconds and of the rest of them.
    pub time: Option<TimeColumns>,
    /// Unit of the times; of two columns, that of the second.
    pub time_unit: Option<TimeUnit>,
    /// The columns of a position, x to z.
    pub position: Option<Vec<String>>,
    /// Their unit.
    pub position_unit: Option<LengthUnit>,
    /// The columns of an orientation, in the order of `orientation_is`.
    pub orientation: Option<Vec<String>>,
    /// What they are.
    pub orientation_is: Option<OrientationForm>,
    /// Unit of angles.
    pub orientation_unit: Option<AngleUnit>,
    /// The column of each joint's position, by the name of the joint.
    pub joints: Option<BTreeMap<String, String>>,
    /// Unit of those whose name states none.
    pub joints_unit: Option<JointUnit>,
}

/// The unit of a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
}

/// The unit of angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AngleUnit {
    /// Radians.
    Rad,
    /// Degrees.
    Deg,
}

/// The unit of joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointUnit {
    /// Radians.
    Rad,
    /// Degrees.
    Deg,
    /// Metres.
    M,
    /// Millimetres.
    Mm,
}

impl LengthUnit {
    /// Metres in it.
    pub(super) fn factor(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 1e-2,
            Self::Mm => 1e-3,
        }
    }

    /// The unit of this symbol.
    pub(super) fn parse(symbol: &str) -> Option<Self> {
        match symbol {
            "m" | "meters" | "metres" => Some(Self::M),
            "cm" | "centimeters" => Some(Self::Cm),
            "mm" | "millimeters" | "millimetres" => Some(Self::Mm),
            _ => None,
        }
    }
}

impl AngleUnit {
    /// Radians in it.
    pub(super) fn factor(self) -> f64 {
        match self {
            Self::Rad => 1.0,
            Self::Deg => PI / 180.0,
        }
    }

    /// The unit of this symbol.
    pub(super) fn parse(symbol: &str) -> Option<Self> {
        match symbol {
            "rad" | "radians" => Some(Self::Rad),
            "deg" | "degrees" | "°" => Some(Self::Deg),
            _ => None,
        }
    }
}

impl JointUnit {
    /// Its ending of a name.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Rad => "rad",
            Self::Deg => "deg",
            Self::M => "m",
            Self::Mm => "mm",
        }
    }
}

impl LogColumns {
    /// What contradicts itself: the key, what is wrong and what to do.
    #[must_use]
    pub fn complaint(&self) -> Option<(&'static str, String, String)> {
        let wrong = |key, message: String, help: &str| Some((key, message, help.to_owned()));
        if let Some(position) = self.position.as_ref().filter(|names| names.len() != 3) {
            let message = format!("{} columns for x, y and z", position.len());
            return wrong("position", message, "the columns of x, y and z: [\"x\", \"y\", \"z\"]");
        }
        if let Some(TimeColumns(names)) = self.time.as_ref().filter(|time| !(1..=2).contains(&time.0.len())) {
            let message = format!("{} columns of one time", names.len());
            return wrong(
                "time",
                message,
                "\"t\", or whole seconds and the rest of them: [\"sec\", \"nanosec\"]",
            );
        }
        match (&self.orientation, self.orientation_is) {
            (Some(_), None) => {
                return wrong(
                    "orientation_is",
                    "nothing says what these columns of an orientation are".into(),
                    OrientationForm::WORDS,
                );
            }
            (Some(names), Some(form)) if names.len() != form.width() => {
                let message = format!("{} columns for \"{form}\", which has {}", names.len(), form.width());
                return wrong("orientation", message, "give one for each, in their order");
            }
            (None, Some(OrientationForm::Euler { .. })) => {
                let help = "orientation = [\"…\", \"…\", \"…\"], in the order of the turns";
                return wrong("orientation", "Euler angles need their columns".into(), help);
            }
            (_, Some(form)) if self.orientation_unit.is_some() && !form.has_unit() => {
                return wrong("orientation_unit", format!("\"{form}\" has no unit"), "take it out");
            }
            _ => (),
        }
        if self.joints.is_some() && (self.position.is_some() || self.orientation.is_some()) {
            return wrong("joints", "a log is of joints or of poses".into(), "keep one of the two");
        }
        if self.joints_unit.is_some() && self.joints.is_none() {
            return wrong(
                "joints_unit",
                "this needs joints".into(),
                "joints = { elbow_joint = \"q3\" }, for example",
            );
        }
        let names = [&self.position, &self.orientation].into_iter().flatten().flatten();
        let names = names.chain(self.joints.iter().flat_map(BTreeMap::values));
        let mut seen: Vec<&str> = Vec::new();
        for name in names.chain(self.time.iter().flat_map(|time| &time.0)) {
            if seen.contains(&name.as_str()) {
                return wrong(
                    "",
                    format!("the column `{name}` is named twice"),
                    "each column holds one thing",
                );
            }
            seen.push(name);
        }
        None
    }
}

/// The column of times, or the two of whole seconds and of the rest of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimeColumns(pub Vec<String>);

impl Serialize for TimeColumns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [one] => one.serialize(serializer),
            names => names.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for TimeColumns {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrTwo)
    }
}

/// Reads a name, or a list of names.
struct OneOrTwo;

impl<'de> Visitor<'de> for OneOrTwo {
    type Value = TimeColumns;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a column, or two\n\"t\", or whole seconds and the rest of them: [\"sec\", \"nanosec\"]")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<TimeColumns, E> {
        let name: StrDeserializer<'_, E> = name.into_deserializer();
        Ok(TimeColumns(vec![String::deserialize(name)?]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, names: A) -> Result<TimeColumns, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(names)).map(TimeColumns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_contradict_each_other_are_refused_by_their_key() {
        let names = |of: &[&str]| Some(of.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
        let key = |columns: LogColumns| columns.complaint().map(|(key, ..)| key);
        let of = LogColumns::default;
        let rpy = || names(&["roll", "pitch", "yaw"]);
        let form = OrientationForm::parse("extrinsic-xyz");
        assert_eq!(key(LogColumns { orientation: rpy(), orientation_is: form, ..of() }), None);
        assert_eq!(key(LogColumns { orientation: rpy(), ..of() }), Some("orientation_is"));
        assert_eq!(key(LogColumns { orientation_is: form, ..of() }), Some("orientation"));
        assert_eq!(key(LogColumns { orientation_is: Some(OrientationForm::RotationVector), ..of() }), None);
        let quaternion = Some(OrientationForm::QuaternionWxyz);
        assert_eq!(
            key(LogColumns { orientation: rpy(), orientation_is: quaternion, ..of() }),
            Some("orientation")
        );
        let unit = Some(AngleUnit::Deg);
        assert_eq!(
            key(LogColumns { orientation_is: quaternion, orientation_unit: unit, ..of() }),
            Some("orientation_unit")
        );
        assert_eq!(key(LogColumns { position: names(&["x", "y"]), ..of() }), Some("position"));
        assert_eq!(key(LogColumns { position: names(&["x", "y", "x"]), ..of() }), Some(""));
        let time = |of: &[&str]| names(of).map(TimeColumns);
        assert_eq!(key(LogColumns { time: time(&["a", "b", "c"]), ..of() }), Some("time"));
        let joints = Some(BTreeMap::from([("elbow".to_owned(), "q3".to_owned())]));
        assert_eq!(
            key(LogColumns { joints: joints.clone(), position: names(&["x", "y", "z"]), ..of() }),
            Some("joints")
        );
        assert_eq!(key(LogColumns { joints_unit: Some(JointUnit::Deg), ..of() }), Some("joints_unit"));
        assert_eq!(key(LogColumns { joints, joints_unit: Some(JointUnit::Deg), ..of() }), None);
    }
}

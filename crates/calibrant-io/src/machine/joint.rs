//! The joints of a URDF file.

use super::element::{Element, Place};
use super::franka::near_ends_of_fr3;
use calibrant_core::error::Refusal;
use calibrant_machine::chain::{Joint, JointKind, JointLimits, SpeedNearEnds};
use calibrant_recording::text::decoding::Checked;
use calibrant_recording::text::similar_word::shorten;
use nalgebra::{Isometry3, Quaternion, Translation3, Unit, UnitQuaternion, Vector3};

/// Shortest axis.
const SHORTEST_AXIS: f64 = 1e-6;

/// A joint as the file has it: what is impossible in a chain may stand elsewhere.
#[derive(Debug, Clone)]
pub(super) struct UrdfJoint {
    pub name: String,
    pub parent: String,
    pub child: String,
    pub place: Place,
    /// Where its parent and its child stand.
    pub parent_place: Place,
    pub child_place: Place,
    kind: String,
    origin: Isometry3<f64>,
    axis: Vector3<f64>,
    axis_place: Place,
    limits: Option<JointLimits>,
    /// The joint that it follows, and where that is said.
    mimic: Option<(String, Place)>,
}

/// A joint of a chain.
pub(super) enum ChainJoint {
    /// It does not move.
    Fixed(Isometry3<f64>),
    /// It moves.
    Moving(Joint),
}

impl UrdfJoint {
    /// Reads a joint. Its numbers are checked here; what a chain needs of it is checked in [`Self::in_chain`].
    pub(super) fn read(element: Element) -> Checked<Self> {
        let name = element.need("name")?.to_owned();
        let kind = element.need("type")?.to_owned();
        let (parent, child) = (element.need_child("parent")?, element.need_child("child")?);
        let axis = element.child("axis")?;
        let numbers = axis.map(|axis| {
            axis.need("xyz")?;
            axis.numbers("xyz")
        });
        let limits = element.child("limit")?.map(limits).transpose()?;
        let near_ends = element.child("position_based_velocity_limits")?;
        let limits = match (limits, near_ends) {
            (Some(limits), Some(of)) => Some(JointLimits { near_ends: near_ends_of(of, &limits)?, ..limits }),
            (Some(limits), None) => Some(JointLimits { near_ends: near_ends_of_fr3(&name), ..limits }),
            (None, _) => None,
        };
        let mimic = element.child("mimic")?;
        Ok(Self {
            name,
            kind,
            parent: parent.need("link")?.to_owned(),
            child: child.need("link")?.to_owned(),
            parent_place: parent.place(),
            child_place: child.place(),
            origin: element.child("origin")?.map_or(Ok(Isometry3::identity()), origin)?,
            axis: numbers.transpose()?.flatten().map_or(Vector3::x(), Vector3::from),
            axis_place: axis.unwrap_or(element).place(),
            limits,
            mimic: mimic.map(|of| (of.attribute("joint").unwrap_or("another").to_owned(), of.place())),
            place: element.place(),
        })
    }

    /// Its transform, where it does not move.
    pub(super) fn fixed(&self) -> Option<Isometry3<f64>> {
        (self.kind == "fixed").then_some(self.origin)
    }

    /// The joint as a part of a chain.
    pub(super) fn in_chain(&self, text: &str) -> Checked<ChainJoint> {
        let kind = match self.kind.as_str() {
            "fixed" => return Ok(ChainJoint::Fixed(self.origin)),
            "revolute" => JointKind::Revolute,
            "continuous" => JointKind::Continuous,
            "prismatic" => JointKind::Prismatic,
            other => {
                let message = format!("a joint of type \"{}\" is not supported in the chain", shorten(other));
                let help = "revolute, continuous, prismatic and fixed joints are; choose a base behind it, or another tip";
                return Err(self.place.error(text, Refusal::JointUnsupported, message, help));
            }
        };
        if let Some((leader, place)) = &self.mimic {
            let message = format!(
                "the joint follows `{}`: mimic joints are not supported in the chain",
                shorten(leader)
            );
            return Err(place.error(
                text,
                Refusal::JointUnsupported,
                message,
                "choose a tip before this joint",
            ));
        }
        let Some(axis) = Unit::try_new(self.axis, SHORTEST_AXIS) else {
            let message = "the axis is zero";
            return Err(self.axis_place.error(
                text,
                Refusal::ValueInvalid,
                message,
                "write a direction, such as \"0 0 1\"",
            ));
        };
        let limits = match (self.limits, kind) {
            (Some(limits), _) => limits,
            (None, JointKind::Continuous) => JointLimits::default(),
            (None, _) => {
                let message = format!("<limit> is missing, which a {} joint needs", kind.name());
                let help = "add <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/>";
                return Err(self.place.error(text, Refusal::KeyMissing, message, help));
            }
        };
        Ok(ChainJoint::Moving(Joint { name: self.name.clone(), kind, axis, origin: self.origin, limits }))
    }
}

/// An `<origin>`: URDF's roll, pitch and yaw are about fixed axes.
pub(super) fn origin(element: Element) -> Checked<Isometry3<f64>> {
    let [x, y, z] = element.numbers("xyz")?.unwrap_or_default();
    let rotation = match (element.numbers("quat_xyzw")?, element.numbers("rpy")?) {
        (Some(_), Some(_)) => {
            let message = "`rpy` and `quat_xyzw` are both there";
            return Err(element.error(Refusal::OptionsContradict, message, "keep one of them"));
        }
        (Some([i, j, k, w]), None) => {
            let Some(unit) = Unit::try_new(Quaternion::new(w, i, j, k), SHORTEST_AXIS) else {
                return Err(element.error(Refusal::ValueInvalid, "`quat_xyzw` is zero", "write \"0 0 0 1\""));
            };
            unit
        }
        (None, rpy) => {
            let [roll, pitch, yaw] = rpy.unwrap_or_default();
            UnitQuaternion::from_euler_angles(roll, pitch, yaw)
        }
    };
    Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

/// A `<position_based_velocity_limits>`, as Franka's files have it: the speed at which the joint can still stop before its end.
fn near_ends_of(element: Element, limits: &JointLimits) -> Checked<Option<SpeedNearEnds>> {
    let need = |key: &str| {
        element.need(key)?;
        match element.number(key)? {
            Some(value) if value >= 0.0 => Ok(value),
            _ => Err(element.error(
                Refusal::ValueInvalid,
                format!("`{key}` is negative"),
                "write its magnitude",
            )),
        }
    };
    let (offset, deceleration) = (need("velocity_offset")?, need("deceleration_limit")?);
    let (lower, upper) = (limits.lower.unwrap_or(f64::NEG_INFINITY), limits.upper.unwrap_or(f64::INFINITY));
    let of = SpeedNearEnds { lower, upper, slope: 2.0 * deceleration, offset };
    Ok((deceleration > 0.0 && lower.is_finite() && upper.is_finite()).then_some(of))
}

/// A `<limit>`. A velocity or effort of 0 stands for an unknown one, as exporters write it.
fn limits(element: Element) -> Checked<JointLimits> {
    let positive = |key: &str| -> Checked<Option<f64>> {
        match element.number(key)? {
            Some(value) if value < 0.0 => {
                let message = format!("`{key}` is negative: {value}");
                Err(element.error(Refusal::ValueInvalid, message, "write its magnitude"))
            }
            other => Ok(other.filter(|value| *value > 0.0)),
        }
    };
    let limits = JointLimits {
        lower: element.number("lower")?,
        upper: element.number("upper")?,
        velocity: positive("velocity")?,
        effort: positive("effort")?,
        near_ends: None,
    };
    if let (Some(lower), Some(upper)) = (limits.lower, limits.upper)
        && lower > upper
    {
        let message = format!("the lower limit {lower} is above the upper one, {upper}");
        return Err(element.error(Refusal::ValueInvalid, message, "exchange them"));
    }
    Ok(limits)
}

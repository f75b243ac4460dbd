//! `[machine.limits]`: what the joints and the tip may do. What it does not say, MoveIt's file says, and then the URDF file.

use super::number::{Either, Within};
use super::ranges::{JointAcceleration, JointJerk, JointPosition, JointSpeed, TipSpeed};
use super::refused_key::{missing, refused};
use super::widened_limits::widened;
use crate::machine::{FileJointLimits, JointLimitsFile, read_joint_limits_file};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::design::ScalingFactorsApplied;
use calibrant_core::error::Result;
use calibrant_machine::chain::{Joint, JointKind, KinematicChain, SpeedNearEnds};
use calibrant_machine_design::JointLimit;
use calibrant_recording::text::similar_word::{nearest, shorten};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::PathBuf;

/// `[machine.limits]`: what the joints and the tip may do in a design.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineLimitsSection {
    /// MoveIt's file.
    pub joint_limits: Option<PathBuf>,
    /// Least and largest position: of all joints, or a table by joint.
    pub position: Option<JointRanges>,
    /// Largest speed.
    pub velocity: Option<ByJoint<JointSpeed>>,
    /// Largest acceleration.
    pub acceleration: Option<ByJoint<JointAcceleration>>,
    /// Largest jerk.
    pub jerk: Option<ByJoint<JointJerk>>,
    /// Largest speed of the tip and of the sensor's body.
    pub tip_speed_mps: Option<Within<TipSpeed>>,
}

/// One number that no joint exceeds, or a table by joint.
pub type ByJoint<R> = Either<Within<R>, BTreeMap<String, Within<R>>>;

/// Two numbers.
type Ends = Vec<Within<JointPosition>>;

/// Ends of all joints, or a table by joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum JointRanges {
    /// No joint goes beyond these.
    All(Ends),
    /// By joint.
    ByJoint(BTreeMap<String, Ends>),
}

impl<'de> Deserialize<'de> for JointRanges {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct Kind;

        impl<'de> serde::de::Visitor<'de> for Kind {
            type Value = JointRanges;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "a table or an array\n{RANGES}")
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(
                self,
                items: A,
            ) -> std::result::Result<JointRanges, A::Error> {
                Ends::deserialize(SeqAccessDeserializer::new(items)).map(JointRanges::All)
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(
                self,
                entries: A,
            ) -> std::result::Result<JointRanges, A::Error> {
                BTreeMap::deserialize(MapAccessDeserializer::new(entries)).map(JointRanges::ByJoint)
            }
        }
        deserializer.deserialize_any(Kind)
    }
}

/// How positions are written.
const RANGES: &str = "[-2.6, 2.6] for all joints, or { elbow_joint = [-2.6, 2.6] }";

/// What the joints and the tip may do. An infinite number is no limit.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineLimits {
    /// Of each joint of the chain.
    pub joints: Vec<JointLimit>,
    /// Largest speed of the tip and of the sensor's body, m/s.
    pub tip_speed_mps: Option<f64>,
    /// What a reader should know: which limits are wider than those of a file.
    pub notes: Vec<Diagnostic>,
}

impl MachineLimitsSection {
    /// The limits of the joints of a chain.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment): no such joint; no acceleration limit, no ends or no speed of a joint; or as
    /// [`read_joint_limits`](crate::read_joint_limits).
    pub fn of(&self, chain: &KinematicChain) -> Result<MachineLimits> {
        let JointLimitsFile { joints: in_file, factors } = match &self.joint_limits {
            Some(path) => read_joint_limits_file(path)?,
            None => JointLimitsFile { joints: BTreeMap::new(), factors: [1.0; 2] },
        };
        self.check_names(chain)?;
        if let Some(path) = &self.joint_limits
            && !chain.joints.iter().any(|joint| in_file.contains_key(&joint.name))
        {
            let message = format!("{} names none of the joints of this machine", path.display());
            let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
            return Err(refused(
                "machine.limits.joint_limits",
                message,
                format!("is it the file of another? the joints are {}", names.join(", ")),
            ));
        }
        self.check_accelerations(chain, &in_file)?;
        let said = |joint: &Joint| in_file.get(&joint.name).copied().unwrap_or_default();
        let of = |joint: &Joint| self.of_joint(joint, &said(joint), factors);
        let joints: Vec<JointLimit> = chain.joints.iter().map(of).collect::<Result<_>>()?;
        let each = chain.joints.iter().zip(&joints);
        let mut notes: Vec<Diagnostic> =
            each.filter_map(|(joint, limit)| widened(joint, &said(joint), limit)).collect();
        if factors != [1.0; 2] {
            let [velocity, acceleration] = factors;
            notes.push(ScalingFactorsApplied { velocity, acceleration }.into());
        }
        Ok(MachineLimits { joints, tip_speed_mps: self.tip_speed_mps.map(f64::from), notes })
    }

    /// Refuses tables whose joints the chain has not, and positions that are no two numbers.
    fn check_names(&self, chain: &KinematicChain) -> Result<()> {
        fn names<R>(of: Option<&ByJoint<R>>) -> Vec<&String> {
            of.map_or_else(Vec::new, |of| match of {
                Either::Single(_) => Vec::new(),
                Either::Compound(table) => table.keys().collect(),
            })
        }
        let positions = match &self.position {
            Some(JointRanges::ByJoint(table)) => table.keys().collect(),
            _ => Vec::new(),
        };
        let tables = [
            ("position", positions),
            ("velocity", names(self.velocity.as_ref())),
            ("acceleration", names(self.acceleration.as_ref())),
            ("jerk", names(self.jerk.as_ref())),
        ];
        let known = || chain.joints.iter().map(|joint| joint.name.as_str());
        for (key, names) in tables {
            if let Some(name) = names.into_iter().find(|name| !known().any(|of| of == name.as_str())) {
                let near = nearest(name, known());
                let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
                return Err(refused(
                    format!("machine.limits.{key}.{name}"),
                    format!("the chain has no joint `{}`", shorten(name)),
                    format!("{hint}its joints are {}", known().collect::<Vec<_>>().join(", ")),
                ));
            }
        }
        Ok(())
    }

    /// Refuses joints without an acceleration limit: nobody can guess it, and a machine that is asked for too much stops.
    fn check_accelerations(
        &self,
        chain: &KinematicChain,
        in_file: &BTreeMap<String, FileJointLimits>,
    ) -> Result<()> {
        let lacks = |joint: &&Joint| {
            given(self.acceleration.as_ref(), &joint.name).is_none()
                && in_file.get(&joint.name).is_none_or(|of| of.acceleration.is_none())
        };
        let without: Vec<&str> = chain.joints.iter().filter(lacks).map(|joint| joint.name.as_str()).collect();
        if without.is_empty() {
            return Ok(());
        }
        let help = format!(
            "URDF has none ({}): acceleration = 5.0 in [machine.limits], in rad/s² or m/s², from the machine's manual; or joint_limits = \"joint_limits.yaml\", MoveIt's file, with has_acceleration_limits: true and max_acceleration",
            without.join(", ")
        );
        Err(missing("machine.limits.acceleration", help))
    }

    /// `factors`: parts of speeds and accelerations that MoveIt uses of those in files.
    fn of_joint(&self, joint: &Joint, in_file: &FileJointLimits, factors: [f64; 2]) -> Result<JointLimit> {
        let [lower, upper] = self.ends(joint, in_file)?;
        let nominal = joint.limits;
        let least = |of: Option<Given>, usual: Option<f64>| match (of, usual) {
            (Some(Given::OfThis(number)), _) => Some(number),
            (Some(Given::OfAll(number)), usual) => Some(usual.map_or(number, |usual| usual.min(number))),
            (None, usual) => usual,
        };
        let scaled = |of: Option<f64>, which: usize| of.map(|of| of * factors[which]);
        let velocity = least(
            given(self.velocity.as_ref(), &joint.name),
            scaled(in_file.velocity.or(nominal.velocity), 0),
        );
        let Some(velocity) = velocity else {
            let help = format!("the urdf has none of `{}`: velocity = 3.1 in [machine.limits]", joint.name);
            return Err(missing("machine.limits.velocity", help));
        };
        let acceleration =
            least(given(self.acceleration.as_ref(), &joint.name), scaled(in_file.acceleration, 1));
        let jerk = least(given(self.jerk.as_ref(), &joint.name), in_file.jerk);
        let near_ends = match in_file.near_ends {
            Some([offset, deceleration]) => {
                Some(SpeedNearEnds { lower, upper, slope: 2.0 * deceleration, offset })
            }
            None => nominal.near_ends,
        };
        Ok(JointLimit {
            lower,
            upper,
            velocity,
            acceleration: acceleration.unwrap_or(f64::INFINITY),
            jerk: jerk.unwrap_or(f64::INFINITY),
            near_ends,
        })
    }

    /// The ends of a joint. One that turns without end keeps to a turn in each direction.
    fn ends(&self, joint: &Joint, in_file: &FileJointLimits) -> Result<[f64; 2]> {
        let nominal = match joint.kind {
            JointKind::Continuous => Some((-TAU, TAU)),
            _ => joint.limits.lower.zip(joint.limits.upper),
        };
        let usual = in_file.position.or(nominal.map(<[f64; 2]>::from));
        let pair = |key: String, ends: &Ends| match ends.as_slice() {
            [lower, upper] if lower.get() < upper.get() => Ok([lower.get(), upper.get()]),
            [lower, upper] => {
                let message = format!("{} is not below {}", lower.get(), upper.get());
                Err(refused(key, message, "exchange them"))
            }
            _ => Err(refused(key, format!("{} numbers are not two", ends.len()), RANGES)),
        };
        let key = "machine.limits.position";
        let ends = match (&self.position, usual) {
            (Some(JointRanges::ByJoint(table)), _) if table.contains_key(&joint.name) => {
                return pair(format!("{key}.{}", joint.name), &table[&joint.name]);
            }
            (Some(JointRanges::All(ends)), usual) => {
                let [lower, upper] = pair(key.into(), ends)?;
                usual.map_or([lower, upper], |[least, most]| [lower.max(least), upper.min(most)])
            }
            (_, Some(usual)) => usual,
            (_, None) => {
                let help = format!("the urdf has none of `{}`: position = {RANGES}", joint.name);
                return Err(missing(key, help));
            }
        };
        if ends[0] < ends[1] {
            return Ok(ends);
        }
        let message = format!("nothing is left to `{}` between {} and {}", joint.name, ends[0], ends[1]);
        Err(refused(key, message, format!("write {RANGES}")))
    }
}

/// A number as it is given.
enum Given {
    /// Of this joint: it stands in the place of all else.
    OfThis(f64),
    /// Of all joints: none exceeds it.
    OfAll(f64),
}

fn given<R: Copy>(of: Option<&ByJoint<R>>, name: &str) -> Option<Given> {
    match of? {
        Either::Single(number) => Some(Given::OfAll(number.get())),
        Either::Compound(table) => table.get(name).map(|number| Given::OfThis(number.get())),
    }
}

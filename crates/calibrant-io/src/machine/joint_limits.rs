//! MoveIt's `joint_limits.yaml`: what URDF does not say of joints, or says otherwise.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_recording::text::decoding::{Checked, as_text, parsed};
use calibrant_recording::text::similar_word::shorten;
use serde::Deserialize;
use serde_saphyr::Spanned;
use std::collections::BTreeMap;
use std::path::Path;

/// Largest file, bytes.
const LARGEST_BYTES: u64 = 1 << 20;
/// The remedy for a file that is another.
const HELP: &str = "give MoveIt's joint_limits.yaml: joint_limits: { elbow_joint: { has_acceleration_limits: true, max_acceleration: 5.0 } }";

/// What a file says of a joint. Positions are in rad or m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FileJointLimits {
    /// Smallest and largest position.
    pub position: Option<[f64; 2]>,
    /// Largest speed, rad/s or m/s.
    pub velocity: Option<f64>,
    /// Largest acceleration, rad/s² or m/s².
    pub acceleration: Option<f64>,
    /// Largest jerk, rad/s³ or m/s³.
    pub jerk: Option<f64>,
    /// Offset and deceleration of a speed that falls towards the ends, as Franka's files have them.
    pub near_ends: Option<[f64; 2]>,
}

/// A file with its joints.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointLimitsFile {
    /// By the names of the joints.
    pub(crate) joints: BTreeMap<String, FileJointLimits>,
    /// Parts of each speed and of each acceleration with which MoveIt plans, 1 where the file says nothing. The joints' limits are without them.
    pub(crate) factors: [f64; 2],
}

/// The tables in which the joints may stand, from the outside.
#[derive(Deserialize, Default)]
struct File {
    joint_limits: Option<BTreeMap<String, Spanned<Entry>>>,
    default_velocity_scaling_factor: Number,
    default_acceleration_scaling_factor: Number,
    robot_description_planning: Option<Box<Self>>,
    #[serde(rename = "ros__parameters")]
    parameters: Option<Box<Self>>,
    #[serde(rename = "/**")]
    all_nodes: Option<Box<Self>>,
}

impl File {
    /// The table that has the joints; `None` where none has.
    fn of_joints(self) -> Option<Self> {
        if self.joint_limits.is_some() {
            return Some(self);
        }
        self.robot_description_planning.or(self.parameters).or(self.all_nodes)?.of_joints()
    }

    /// The factors of speeds and accelerations.
    fn factors(&self) -> Checked<[f64; 2]> {
        let factor = |name: &str, number: &Number| match number {
            Some(number) if number.value > 0.0 && number.value <= 1.0 => Ok(number.value),
            Some(number) => {
                let message = format!("{} is not above 0 and at most 1", number.value);
                let help = "write the part of the limits with which MoveIt plans: 1.0 for all of them";
                let error = InputError::new(Refusal::ValueOutOfRange, message, help).about_key(name);
                Err(Box::new(error.at_line(line(number))))
            }
            None => Ok(1.0),
        };
        Ok([
            factor("default_velocity_scaling_factor", &self.default_velocity_scaling_factor)?,
            factor("default_acceleration_scaling_factor", &self.default_acceleration_scaling_factor)?,
        ])
    }
}

type Number = Option<Spanned<f64>>;

#[derive(Deserialize)]
struct Entry {
    has_position_limits: Option<bool>,
    min_position: Number,
    max_position: Number,
    has_velocity_limits: Option<bool>,
    max_velocity: Number,
    has_acceleration_limits: Option<bool>,
    max_acceleration: Number,
    has_jerk_limits: Option<bool>,
    max_jerk: Number,
    position_based_velocity_limits: Option<NearEnds>,
}

#[derive(Deserialize)]
struct NearEnds {
    velocity_offset: Spanned<f64>,
    deceleration_limit: Spanned<f64>,
}

/// Reads the limits of joints by their names.
///
/// # Errors
/// [`Error::Experiment`] with line and key: the file is no YAML or has no `joint_limits`, a number is negative or not finite, a number stands without its `has_…`,
/// or the other way round, or an angle is in degrees.
pub fn read_joint_limits(path: &Path) -> Result<BTreeMap<String, FileJointLimits>> {
    read_joint_limits_file(path).map(|file| file.joints)
}

/// The same with the factors of the file.
pub(crate) fn read_joint_limits_file(path: &Path) -> Result<JointLimitsFile> {
    parsed(path, (LARGEST_BYTES, "joint_limits.yaml"), limits)
}

/// Reads the text of such a file.
///
/// # Errors
/// As [`read_joint_limits`].
///
/// # Examples
/// ```
/// let text = "joint_limits:\n  elbow:\n    has_acceleration_limits: true\n    max_acceleration: 5.0\n";
/// assert_eq!(calibrant_io::parse_joint_limits(text.as_bytes())?["elbow"].acceleration, Some(5.0));
/// let error = calibrant_io::parse_joint_limits(text.replace("5.0", "-5.0").as_bytes()).expect_err("negative");
/// assert_eq!(error.input_error().and_then(|error| error.line), Some(4));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_joint_limits(bytes: &[u8]) -> Result<BTreeMap<String, FileJointLimits>> {
    limits(bytes).map(|file| file.joints).map_err(Error::Experiment)
}

fn limits(bytes: &[u8]) -> Checked<JointLimitsFile> {
    let text = as_text(bytes)?;
    let degrees = text.lines().position(|line| {
        let content = line.split('#').next().unwrap_or_default();
        content.contains("!degrees") || content.contains("deg(")
    });
    if let Some(line) = degrees {
        let error = InputError::new(Refusal::ValueInvalid, "the angle is in degrees", "write it in rad");
        return Err(error.at_line(line + 1).into());
    }
    let file: File = serde_saphyr::from_str(text).map_err(broken)?;
    let Some(file) = file.of_joints() else {
        let error = InputError::new(Refusal::KeyMissing, "there is no `joint_limits`", HELP);
        return Err(error.about_key("joint_limits").into());
    };
    let joints = file.joint_limits.iter().flatten();
    Ok(JointLimitsFile {
        joints: joints
            .map(|(name, entry)| Ok((name.clone(), entry.value.limits(name, line(entry))?)))
            .collect::<Checked<_>>()?,
        factors: file.factors()?,
    })
}

fn line<T>(of: &Spanned<T>) -> usize {
    usize::try_from(of.referenced.line()).unwrap_or(1).max(1)
}

fn broken(error: serde_saphyr::Error) -> Box<InputError> {
    let error = error.without_snippet();
    let message = error.to_string();
    let words = message.split(" at line ").next().unwrap_or(&message).trim();
    let mut input_error = InputError::new(
        Refusal::SyntaxInvalid,
        format!("not MoveIt's joint_limits.yaml: {}", shorten(words)),
        HELP,
    );
    if let Some(place) = error.location() {
        let number = |n: u64| usize::try_from(n).unwrap_or(1).max(1);
        input_error = input_error.at_line(number(place.line())).at_column(number(place.column()));
    }
    Box::new(input_error)
}

impl Entry {
    /// `at`: the line where the joint begins.
    fn limits(&self, joint: &str, at: usize) -> Checked<FileJointLimits> {
        let key = |key: &str| format!("joint_limits.{}.{key}", shorten(joint));
        let refused = |line: usize, of: &str, message: String, help: &str| {
            let error = InputError::new(Refusal::ValueInvalid, message, help).about_key(key(of));
            Box::new(error.at_line(line))
        };
        let finite = |name: &str, number: &Spanned<f64>| match number.value.is_finite() {
            true => Ok(number.value),
            false => Err(refused(line(number), name, "this is not finite".into(), "write a number")),
        };
        // a number counts if, and only if, its `has_…` is true
        let stated = |has: Option<bool>, has_name: &str, name: &str, number: &Number| match (has, number) {
            (Some(true), Some(number)) => finite(name, number).map(Some),
            (Some(true), None) => {
                let message = format!("{has_name} is true, and this is missing");
                Err(refused(at, name, message, "add it, in rad or m and s"))
            }
            (None, Some(number)) => {
                let message = format!("MoveIt does not use it without {has_name}");
                let help = format!("write {has_name}: true beside it, or take it out");
                Err(refused(line(number), name, message, &help))
            }
            _ => Ok(None),
        };
        let positive = |has: Option<bool>, has_name: &str, name: &str, number: &Number| match (
            stated(has, has_name, name, number)?,
            number,
        ) {
            (Some(value), Some(number)) if value <= 0.0 => {
                let message = format!("{value} is not above 0");
                Err(refused(line(number), name, message, "write a number above 0"))
            }
            (value, _) => Ok(value),
        };
        let of = |name: &str, number: &Number| {
            stated(self.has_position_limits, "has_position_limits", name, number)
        };
        let ends = (of("min_position", &self.min_position)?, of("max_position", &self.max_position)?);
        let position = ends.0.zip(ends.1).map(|(lower, upper)| [lower, upper]);
        if let (Some([lower, upper]), Some(number)) = (position, &self.min_position)
            && lower >= upper
        {
            let message = format!("{lower} is not below max_position, {upper}");
            return Err(refused(line(number), "min_position", message, "exchange them"));
        }
        let near_ends = self.position_based_velocity_limits.as_ref().map(|of| {
            let offset = finite("velocity_offset", &of.velocity_offset)?;
            let deceleration = finite("deceleration_limit", &of.deceleration_limit)?;
            if offset < 0.0 || deceleration <= 0.0 {
                let message = "an offset from 0 and a deceleration above 0 are needed".to_owned();
                let at = line(&of.deceleration_limit);
                return Err(refused(at, "position_based_velocity_limits", message, "write both"));
            }
            Ok([offset, deceleration])
        });
        Ok(FileJointLimits {
            position,
            velocity: positive(
                self.has_velocity_limits,
                "has_velocity_limits",
                "max_velocity",
                &self.max_velocity,
            )?,
            acceleration: positive(
                self.has_acceleration_limits,
                "has_acceleration_limits",
                "max_acceleration",
                &self.max_acceleration,
            )?,
            jerk: positive(self.has_jerk_limits, "has_jerk_limits", "max_jerk", &self.max_jerk)?,
            near_ends: near_ends.transpose()?,
        })
    }
}

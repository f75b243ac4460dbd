//! The messages of ROS 2 that say where a machine is.
//!
//! ```text
//! JointState        header; name: list of texts; position, velocity, effort: lists of f64
//! PoseStamped       header; position x y z, orientation x y z w
//! TransformStamped  header; child_frame_id: text; translation x y z, rotation x y z w
//! Odometry          header; child_frame_id: text; position, orientation, …
//! TFMessage         list of TransformStamped
//! ```
//! A header is a time stamp, sec i32 and nanosec u32, and a text, `frame_id`. All vectors are f64.

use crate::recording::cdr::{CdrReader, Unreadable};
use crate::recording::mcap_container::MessageType;

/// A message.
pub(super) enum Message {
    Joints(JointState),
    Pose(Pose),
    /// Poses of frames, each with the name of its frame.
    Transforms(Vec<(String, Pose)>),
}

impl Message {
    /// `header.stamp`, ns; of several poses, that of the first.
    pub(super) fn stamp_ns(&self) -> i64 {
        match self {
            Self::Joints(joints) => joints.stamp_ns,
            Self::Pose(pose) => pose.stamp_ns,
            Self::Transforms(poses) => poses.first().map_or(0, |(_, pose)| pose.stamp_ns),
        }
    }
}

/// Positions of joints.
pub(super) struct JointState {
    pub(super) stamp_ns: i64,
    pub(super) names: Vec<String>,
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
}

/// A pose: x, y, z, then w, x, y, z of the quaternion.
pub(super) struct Pose {
    pub(super) stamp_ns: i64,
    pub(super) values: [f64; 7],
}

/// The messages that are read.
pub(super) const TYPES: &[MessageType<Message>] = &[
    MessageType { name: "sensor_msgs/msg/JointState", read: joint_state },
    MessageType { name: "geometry_msgs/msg/PoseStamped", read: pose_stamped },
    MessageType { name: "geometry_msgs/msg/TransformStamped", read: transform_stamped },
    MessageType { name: "nav_msgs/msg/Odometry", read: transform_stamped },
    MessageType { name: "tf2_msgs/msg/TFMessage", read: transforms },
];

fn joint_state(bytes: &[u8]) -> Result<Message, Unreadable> {
    let mut reader = CdrReader::new(bytes)?;
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    let names = reader.list(CdrReader::text)?;
    let positions = reader.list(CdrReader::f64)?;
    let velocities = reader.list(CdrReader::f64)?;
    // either list may be empty
    for (list, why) in [
        (&positions, "it has another number of positions than of names"),
        (&velocities, "it has another number of velocities than of names"),
    ] {
        if !list.is_empty() && list.len() != names.len() {
            return Err(why);
        }
    }
    Ok(Message::Joints(JointState { stamp_ns, names, positions, velocities }))
}

fn pose_stamped(bytes: &[u8]) -> Result<Message, Unreadable> {
    let mut reader = CdrReader::new(bytes)?;
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    Ok(Message::Pose(Pose { stamp_ns, values: values(&mut reader)? }))
}

fn transform_stamped(bytes: &[u8]) -> Result<Message, Unreadable> {
    Ok(Message::Pose(transform(&mut CdrReader::new(bytes)?)?.1))
}

fn transforms(bytes: &[u8]) -> Result<Message, Unreadable> {
    Ok(Message::Transforms(CdrReader::new(bytes)?.list(transform)?))
}

/// The name of the frame, and its pose.
fn transform(reader: &mut CdrReader<'_>) -> Result<(String, Pose), Unreadable> {
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    let frame = reader.text()?;
    Ok((frame, Pose { stamp_ns, values: values(reader)? }))
}

fn values(reader: &mut CdrReader<'_>) -> Result<[f64; 7], Unreadable> {
    let [px, py, pz, x, y, z, w] = reader.numbers()?;
    Ok([px, py, pz, w, x, y, z])
}

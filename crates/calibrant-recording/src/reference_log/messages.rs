//! The messages of ROS that say where a machine is.
//!
//! ```text
//! JointState        header; name: list of texts; position, velocity, effort: lists of f64
//! PoseStamped       header; position x y z, orientation x y z w
//! TransformStamped  header; child_frame_id: text; translation x y z, rotation x y z w
//! Odometry          header; child_frame_id: text; position, orientation, …
//! TFMessage         list of TransformStamped
//! ```
//! A header is a time stamp, sec i32 and nanosec u32, and a text, `frame_id`. All vectors are f64.

use crate::recording::bag::MessageType;
use crate::recording::ros_message::{RosMessage, Unreadable};

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

fn joint_state(reader: &mut RosMessage<'_>) -> Result<Message, Unreadable> {
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    let names = reader.list(RosMessage::text)?;
    let positions = reader.list(RosMessage::f64)?;
    let velocities = reader.list(RosMessage::f64)?;
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

fn pose_stamped(reader: &mut RosMessage<'_>) -> Result<Message, Unreadable> {
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    Ok(Message::Pose(Pose { stamp_ns, values: values(reader)? }))
}

fn transform_stamped(reader: &mut RosMessage<'_>) -> Result<Message, Unreadable> {
    Ok(Message::Pose(transform(reader)?.1))
}

fn transforms(reader: &mut RosMessage<'_>) -> Result<Message, Unreadable> {
    Ok(Message::Transforms(reader.list(transform)?))
}

/// The name of the frame, and its pose.
fn transform(reader: &mut RosMessage<'_>) -> Result<(String, Pose), Unreadable> {
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    let frame = reader.text()?;
    Ok((frame, Pose { stamp_ns, values: values(reader)? }))
}

fn values(reader: &mut RosMessage<'_>) -> Result<[f64; 7], Unreadable> {
    let [px, py, pz, x, y, z, w] = reader.numbers()?;
    Ok([px, py, pz, w, x, y, z])
}

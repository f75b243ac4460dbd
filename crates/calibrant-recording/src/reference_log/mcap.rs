//! Reads the log of a motion in a bag of ROS.
//!
//! Times are `header.stamp`, when the machine was there, not when the recorder received the message. A topic of
//! `TFMessage` holds the poses of many frames: each is a log of its own, `/tf:tool0`, and serves where it is asked
//! for, or where the bag has no other log.

use super::content::Content;
use super::file::ReferenceLogFile;
use super::format::ReferenceFormat;
use super::log_assembly::assemble;
use super::messages::{JointState, Message, Pose, TYPES};
use super::orientation_form::OrientationForm;
use super::rows::Rows;
use crate::recording::TimeUnit;
use crate::recording::bag::Topics;
use crate::recording::bag_file;
use crate::recording::mcap_order::{Logged, by_log_time};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;
use std::collections::BTreeMap;

pub(super) fn read(format: ReferenceFormat, bytes: &[u8], topic: Option<&str>) -> Checked<ReferenceLogFile> {
    let mut bag = bag_file::read(bytes, TYPES)?;
    let (cut, unread) = (bag.cut("a motion")?, bag.unread.take());
    let messages = by_frame(bag.topics(), topic).one(topic, "log of a motion", "machine.log")?;
    let (messages, sorted) = by_log_time(messages, Message::stamp_ns);
    let number = messages.len();
    let (mut joints, mut poses) = (Vec::new(), Vec::new());
    for message in messages {
        match message {
            Message::Joints(message) => joints.push(message),
            Message::Pose(message) => poses.push(message),
            Message::Transforms(messages) => poses.extend(messages.into_iter().map(|(_, pose)| pose)),
        }
    }
    let (content, rows) = match joints.is_empty() {
        true => (Content::Poses(OrientationForm::QuaternionWxyz), of_poses(&poses)),
        false if joints.iter().all(|message| message.positions.is_empty()) => {
            let message = "the messages of JointState have no positions";
            let help = "record a topic whose messages have them: velocities and efforts are no reference";
            return refuse(Refusal::ColumnMissing, message, help);
        }
        false => of_joints(&joints),
    };
    let mut file = assemble(format, content, ("header.stamp", Some(TimeUnit::Nanosecond)), rows, Vec::new())?;
    let times_s = file.log.times_s();
    let duration_s = times_s.last().zip(times_s.first()).map_or(0.0, |(last, first)| last - first);
    file.findings.extend(sorted);
    file.findings.extend(cut.map(|cut| cut.finding(number, duration_s)));
    file.findings.extend(unread);
    Ok(file)
}

/// The same topics, but with one for each frame in place of a topic with many.
fn by_frame(mut topics: Topics<Message>, asked: Option<&str>) -> Topics<Message> {
    let mut frames: BTreeMap<String, Vec<Logged<Message>>> = BTreeMap::new();
    for (topic, messages) in &mut topics.messages {
        for Logged { log_time_ns, message } in std::mem::take(messages) {
            match message {
                Message::Transforms(poses) => {
                    for (frame, pose) in poses {
                        let message = Logged { log_time_ns, message: Message::Pose(pose) };
                        frames.entry(format!("{topic}:{frame}")).or_default().push(message);
                    }
                }
                message => messages.push(Logged { log_time_ns, message }),
            }
        }
    }
    topics.messages.retain(|_, messages| !messages.is_empty());
    if asked.is_some() || topics.messages.is_empty() {
        topics.messages.append(&mut frames);
    }
    topics
}

fn of_poses(poses: &[Pose]) -> Rows {
    let mut rows = of_stamps(poses.iter().map(|pose| pose.stamp_ns));
    rows.values = poses.iter().flat_map(|pose| pose.values).collect();
    rows
}

/// The joints of all messages that have a position; a message need not hold all of them.
fn of_joints(messages: &[JointState]) -> (Content, Rows) {
    let mut names: Vec<String> = Vec::new();
    for message in messages.iter().filter(|message| !message.positions.is_empty()) {
        for name in &message.names {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
    }
    let has_velocities = messages.iter().any(|message| !message.velocities.is_empty());
    let mut rows = of_stamps(messages.iter().map(|message| message.stamp_ns));
    for message in messages {
        let lists = [Some(&message.positions), has_velocities.then_some(&message.velocities)];
        for list in lists.into_iter().flatten() {
            let of_joint = |name: &String| {
                let k = message.names.iter().position(|known| known == name)?;
                list.get(k).copied()
            };
            rows.values.extend(names.iter().map(|name| of_joint(name).unwrap_or(f64::NAN)));
        }
    }
    let turns = vec![None; names.len()];
    (Content::Joints { names, turns, has_velocities, derivatives: usize::from(has_velocities) }, rows)
}

/// Rows with these times and no values yet.
fn of_stamps(stamps_ns: impl Iterator<Item = i64> + Clone) -> Rows {
    let origin = stamps_ns.clone().next().unwrap_or(0);
    Rows { times: stamps_ns.map(|stamp| (stamp - origin) as f64).collect(), origin, ..Rows::default() }
}

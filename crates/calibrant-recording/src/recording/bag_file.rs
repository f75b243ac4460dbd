//! Reads the messages of a bag, whatever its container.

use super::bag::{Bag, MessageType};
use super::bag_kind::BagKind;
use super::{db3, mcap_container, rosbag};
use crate::text::decoding::Checked;

/// The messages of these types.
pub(crate) fn read<'t, M>(bytes: &[u8], types: &'t [MessageType<M>]) -> Checked<Bag<'t, M>> {
    match BagKind::of(bytes) {
        Some(BagKind::Db3) => db3::read(bytes, types),
        Some(BagKind::Rosbag) => rosbag::read(bytes, types),
        _ => mcap_container::read(bytes, types),
    }
}

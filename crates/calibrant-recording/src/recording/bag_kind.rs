//! The containers of bags, by their first bytes.

/// A container of messages of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BagKind {
    /// ROS 2, MCAP.
    Mcap,
    /// ROS 2, SQLite.
    Db3,
    /// ROS 1.
    Rosbag,
}

impl BagKind {
    /// The container that begins with these bytes.
    pub(crate) fn of(bytes: &[u8]) -> Option<Self> {
        let magics: [(&[u8], Self); 3] = [
            (b"\x89MCAP0\r\n", Self::Mcap),
            (b"SQLite format 3\0", Self::Db3),
            (b"#ROSBAG V2.0\n", Self::Rosbag),
        ];
        magics.into_iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, kind)| kind)
    }
}

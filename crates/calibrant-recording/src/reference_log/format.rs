//! The formats of logs of a motion.

/// A file format of logs of a machine's motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ReferenceFormat {
    /// Delimited text with a column for each joint.
    Joints,
    /// Universal Robots' real-time data exchange, `actual_q_0`, ….
    Rtde,
    /// Text of `t x y z qx qy qz qw`, as of the TUM RGB-D benchmark.
    Tum,
    /// Ground truth of the EuRoC MAV dataset (and of others).
    Euroc,
    /// Delimited text whose header names the columns of a pose.
    Poses,
    /// Export of OptiTrack's Motive.
    Motive,
    /// Export of Vicon's Tracker or Nexus.
    Vicon,
    /// Export of Qualisys Track Manager, 6D.
    Qualisys,
    /// ROS 2 bag in an MCAP container.
    Mcap,
    /// ROS 2 bag in an SQLite database.
    Db3,
    /// ROS 1 bag.
    Rosbag,
}

impl ReferenceFormat {
    /// All formats.
    pub const ALL: [Self; 11] = [
        Self::Joints,
        Self::Rtde,
        Self::Tum,
        Self::Euroc,
        Self::Poses,
        Self::Motive,
        Self::Vicon,
        Self::Qualisys,
        Self::Mcap,
        Self::Db3,
        Self::Rosbag,
    ];

    /// Its short name: `joints`, `rtde`, `tum`, `euroc`, `poses`, `motive`, `vicon`, `qualisys`, `mcap`, `db3` or `rosbag`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Joints => "joints",
            Self::Rtde => "rtde",
            Self::Tum => "tum",
            Self::Euroc => "euroc",
            Self::Poses => "poses",
            Self::Motive => "motive",
            Self::Vicon => "vicon",
            Self::Qualisys => "qualisys",
            Self::Mcap => "mcap",
            Self::Db3 => "db3",
            Self::Rosbag => "rosbag",
        }
    }

    /// In words, for people.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Joints => "CSV of joints",
            Self::Rtde => "RTDE log of a Universal Robots arm",
            Self::Tum => "TUM trajectory",
            Self::Euroc => "EuRoC ground truth",
            Self::Poses => "CSV of poses",
            Self::Motive => "CSV of OptiTrack's Motive",
            Self::Vicon => "CSV of Vicon's Tracker or Nexus",
            Self::Qualisys => "6D export of Qualisys Track Manager",
            Self::Mcap => "ROS 2 bag (MCAP)",
            Self::Db3 => "ROS 2 bag (SQLite)",
            Self::Rosbag => "ROS 1 bag",
        }
    }
}

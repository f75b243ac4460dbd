//! What to write for a key that is missing, or whose value is of another kind. Numbers and words say it themselves.

/// What to write for this key; empty where nothing is known.
pub(super) fn remedy(key: &str) -> &'static str {
    if (key.starts_with("columns.") || key.starts_with("machine.log.columns.")) && key.ends_with(']') {
        return COLUMN;
    }
    let key = key.split('[').next().unwrap_or(key);
    match key {
        "schema" => "the first line of an experiment file is schema = 1",
        "sensor" => "the sensor's datasheet: [sensor]",
        "sensor.kind" => "kind = \"accelerometer\"",
        "sensor.axes" => "axes = 1 or axes = 3",
        "sensor.model" => "model = \"scale-bias\" or \"full\"",
        "motion.intervals" => "the number of intervals, for example intervals = 10",
        "motion.interval_s" => "the duration of an interval in seconds, for example interval_s = 1.0",
        "motion.rate_hz" => "the sample rate in Hz, for example rate_hz = 10.0",
        "motion.trust" => "how far the motion is trusted: \"known\", \"noisy\" or \"unknown\"",
        "motion.gravity_mps2" => MOTION_GRAVITY,
        "holds.gauge" => "gauge = \"upper\" (as imu_tk), \"lower\" (as Kalibr) or \"symmetric\"",
        "holds.intervals_s" => "start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]]",
        "holds.directions" => {
            "one for each of intervals_s, in the same order: [\"x\", \"-x\", \"y\", \"-y\", \"z\", \"-z\"]"
        }
        "campaign.range_c" => "the lowest and the highest temperature of use, °C: range_c = [-20.0, 60.0]",
        "campaign.budget_min" => "the time of the whole campaign, min: budget_min = 360.0",
        "campaign.ramp_k_per_min" => "the rate of the chamber, K/min: ramp_k_per_min = 2.0",
        "gyroscope.turns" => "turns = [{ start_s = 10.0, end_s = 14.0, axis = \"x\", angle_deg = 360.0 }]",
        "machine.up" | "motion.gravity" => DIRECTION,
        "machine.base" | "machine.tip" => {
            "the name of a link, in quotes; `calibrant inspect arm.urdf` lists the joints"
        }
        "machine.packages" => "a list of directories: [\"description\"]",
        "machine.limits.joint_limits" => "the path of MoveIt's file: \"joint_limits.yaml\"",
        "machine.world.srdf" => "the path of MoveIt's file: \"arm.srdf\"",
        "machine.world.boxes" => {
            "[{ center_m = [0.45, 0.35, 0.2], half_m = [0.15, 0.15, 0.2] }], in the axes of the base"
        }
        "machine.world.sensor_body" => {
            "{ center_m = [0.0, 0.0, 0.025], radius_m = 0.05 }, in the axes of the tip"
        }
        "machine.world.capsules" => {
            "by link: { forearm = { from_m = [0.0, 0.0, 0.03], to_m = [-0.39, 0.0, 0.01], radius_m = 0.07 } }"
        }
        "machine.design.home" => {
            "one position for each joint, rad or m: [0.0, -1.57, -1.57, -1.57, 1.57, 0.0]"
        }
        _ if key.starts_with("machine.world.") && key.ends_with("_m") => {
            "three coordinates, m: [0.0, 0.0, 0.025]"
        }
        _ if key.starts_with("machine.limits.") => {
            "a number that no joint exceeds, or a table by joint: { elbow_joint = 3.1 }"
        }
        "machine.mount.lever_m" => {
            "from the tip to the sensor in the axes of the tip, m: [0.02, -0.03, 0.04]"
        }
        "machine.mount.rotation" => {
            "a quaternion [w, x, y, z], a rotation vector in degrees [0.0, 0.0, 90.0], or \"unknown\""
        }
        "machine.log.topic" => "topic = \"/joint_states\"",
        "machine.log.columns.position" => "the columns of x, y and z: [\"x\", \"y\", \"z\"]",
        "machine.log.columns.orientation" => {
            "the columns in the order of orientation_is: [\"qw\", \"qx\", \"qy\", \"qz\"]"
        }
        "machine.log.columns.joints" => "the column of each joint: { elbow_joint = \"q3 [deg]\" }",
        _ if key.starts_with("machine.log.columns.joints.") => COLUMN,
        "columns.accelerometer" | "columns.gyroscope" => {
            "the columns of x, y and z: [\"acc_x\", \"acc_y\", \"acc_z\"]"
        }
        "columns.time" | "columns.temperature" | "columns.topic" => COLUMN,
        "design.allowed" => {
            "\"any\", \"faces\" (6 of a cube), \"edges\" (18, with the faces), \"corners\" (26, with both), or a list: [\"x\", \"-z\", [0.0, 0.6, 0.8]]"
        }
        "design.weights" => "for example { \"scale.x\" = 1.0 }",
        _ if key.ends_with(".floor_mps3") => "the noise at any jerk, m/s³",
        _ if key.ends_with(".ratio") => "the noise relative to the jerk; 0.01 is one percent",
        _ if key.starts_with("accept.") => "for example { range = [-0.05, 0.05], sd = 1e-3 }",
        _ if key.starts_with("known.") => "a number fixes it; { value = 0.0, sd = 0.01 } is a prior",
        _ => "",
    }
}

/// How a direction is written.
pub(super) const DIRECTION: &str = "\"x\", \"-x\", …, or three numbers: [0.0, 0.6, 0.8]";
/// How the name of a column is written.
pub(super) const COLUMN: &str =
    "the name as it is in the file, in quotes; without a header, its number from \"1\"";
/// How the gravity of a motion is written.
pub(super) const MOTION_GRAVITY: &str =
    "gravity_mps2 = [0.0, 0.0, 9.80665]: what the sensor senses at rest, in its axes, positive up";

//! Tests that each format is recognised, and that what is written is read.

use super::{findings, in_unit, read};
use calibrant::io::{
    ImuReadOptions, ReferenceFormat, ReferenceLogFile, ReferenceLogOptions, TimeUnit, parse_imu_recording,
    parse_reference_log, read_reference_log,
};
use calibrant::machine::log::PoseLog;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::PI;
use std::fmt::Write;

/// Poses of a body that moves and turns.
fn motion(samples: usize) -> PoseLog {
    let time = |k: usize| 0.01 * k as f64;
    let turn = |t: f64| UnitQuaternion::from_euler_angles(t.sin(), 2.0 * t, 0.3 - t);
    PoseLog {
        times_s: (0..samples).map(time).collect(),
        positions_m: (0..samples).map(|k| Some(Vector3::new(time(k), 0.5, -2.0 * time(k)))).collect(),
        world_from_body: (0..samples).map(|k| Some(turn(time(k)))).collect(),
    }
}

/// A table of poses: time, position and quaternion in this order of their numbers.
fn table(
    log: &PoseLog,
    header: &str,
    time: impl Fn(f64) -> String,
    order: [usize; 7],
    comma: &str,
) -> String {
    let mut text = header.to_owned();
    for (k, t) in log.times_s.iter().enumerate() {
        let (p, q) = (log.positions_m[k].expect("seen"), log.world_from_body[k].expect("seen"));
        let values = [p.x, p.y, p.z, q.w, q.i, q.j, q.k];
        let fields: Vec<String> = order.iter().map(|&value| format!("{:?}", values[value])).collect();
        writeln!(text, "{}{comma}{}", time(*t), fields.join(comma)).expect("written");
    }
    text
}

/// Are both the same to the rounding of a unit quaternion?
fn assert_poses(file: &ReferenceLogFile, expected: &PoseLog) {
    let log = file.poses().expect("poses");
    assert_eq!(log.times_s.len(), expected.times_s.len());
    for k in 0..log.times_s.len() {
        assert!((log.times_s[k] - expected.times_s[k]).abs() < 1e-9, "{k}");
        assert_eq!(log.positions_m[k], expected.positions_m[k]);
        let (one, other) =
            (log.world_from_body[k].expect("seen"), expected.world_from_body[k].expect("seen"));
        assert!(one.angle_to(&other) < 1e-7, "{k}");
    }
}

const W_LAST: [usize; 7] = [0, 1, 2, 4, 5, 6, 3];
const W_FIRST: [usize; 7] = [0, 1, 2, 3, 4, 5, 6];

#[test]
fn a_trajectory_of_tum_is_read() {
    let log = motion(50);
    let seconds = |t: f64| format!("{t:?}");
    for (header, comma) in [
        ("", " "),
        ("# ground truth trajectory\n# file: 'a.bag'\n# timestamp tx ty tz qx qy qz qw\n", " "),
        ("# a comment of eight words for the columns\n", " "),
        ("# t x y z qx qy qz qw\n", "  "),
        ("#timestamp [s] and then the pose\n", " "),
        ("", ","),
        ("# timestamp, tx, ty, tz, qx, qy, qz, qw\n", ", "),
    ] {
        let file = read(&table(&log, header, seconds, W_LAST, comma));
        assert_eq!(file.format, ReferenceFormat::Tum, "{header:?}");
        assert_poses(&file, &log);
        assert!(file.findings.is_empty(), "{:?}", findings(&file));
    }
    let named = table(&log, "# timestamp tx ty tz qw qx qy qz\n", seconds, W_FIRST, " ");
    assert_poses(&read(&named), &log);
}

#[test]
fn times_since_1970_show_their_unit() {
    let log = motion(50);
    for (times, unit) in
        [(1e9, TimeUnit::Nanosecond), (1e6, TimeUnit::Microsecond), (1e3, TimeUnit::Millisecond)]
    {
        let time = |t: f64| format!("{:.0}", (1_403_636_580.0 + t) * times);
        let file = read(&table(&log, "", time, W_LAST, " "));
        let log = file.poses().expect("poses");
        assert!((log.times_s[49] - 0.49).abs() < 1e-6, "{unit:?}: {}", log.times_s[49]);
        assert_eq!(file.counted_from_ns, Some(1_403_636_580_000_000_000));
        assert!(findings(&file)[0].contains(unit.symbol()), "{:?}", findings(&file));
    }
}

#[test]
fn ground_truth_of_euroc_is_read() {
    const HEADER: &str =
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []";
    let log = motion(50);
    let nanoseconds = |t: f64| (1_403_636_580_838_555_648 + (t * 1e9).round() as i64).to_string();
    let rows = table(&log, "", nanoseconds, W_FIRST, ",");
    let file = read(&format!("{HEADER}\n{rows}"));
    assert_eq!(file.format, ReferenceFormat::Euroc);
    assert_poses(&file, &log);
    assert_eq!(file.counted_from_ns, Some(1_403_636_580_838_555_648));
    // as in state_groundtruth_estimate0, with velocities and biases behind
    let more = rows.replace('\n', ",0.1,0.2,0.3,0,0,0\n");
    let behind = ",v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2]";
    let file = read(&format!("{}{behind}\n{more}", HEADER.replace("#timestamp", "#timestamp [ns]")));
    assert_poses(&file, &log);
    assert!(findings(&file)[0].contains("ignored columns `v_RS_R_x"), "{:?}", findings(&file));
    // a tracker of positions alone
    let file =
        read("#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n10000000,1,2,3\n20000000,1,2,4\n");
    assert_eq!(file.format, ReferenceFormat::Euroc);
    let log = file.poses().expect("poses");
    assert_eq!(log.times_s, [0.01, 0.02]);
    assert_eq!(log.world_from_body, [None, None]);
}

#[test]
fn poses_are_read_by_the_names_of_their_columns() {
    let file = read(
        "t_s,qw,qx,qy,qz,px_m,py_m,pz_m\n0.0,nan,nan,nan,nan,1,2,3\n0.5,1,0,0,0,nan,nan,nan\n1.0,0,-1.005,0,0,1,2,nan\n1.5,,,,,,,\n",
    );
    assert_eq!(file.format, ReferenceFormat::Poses);
    let log = file.poses().expect("poses");
    assert_eq!(log.positions_m, [Some(Vector3::new(1.0, 2.0, 3.0)), None, None, None]);
    let turned = UnitQuaternion::from_quaternion(Quaternion::new(0.0, -1.0, 0.0, 0.0));
    assert_eq!(log.world_from_body, [None, Some(UnitQuaternion::identity()), Some(turned), None]);
    let file =
        read("t_ms;x [mm];y [mm];z [mm];q.w;q.x;q.y;q.z;quality\n0;1;2;3;1;0;0;0;9\n10;1;2;4;1;0;0;0;9\n");
    let log = file.poses().expect("poses");
    assert_eq!((log.times_s[1], log.positions_m[1]), (0.01, Some(Vector3::new(1e-3, 2e-3, 4e-3))));
    assert_eq!(findings(&file), ["line 1: ignored column `quality`"]);
}

#[test]
fn joints_are_read_in_their_units() {
    let file = read(
        "t_ms,lift_mm,wrist_deg,wrist_velocity_degps,shoulder_rad,lift_mps,note_v\n0,100,180,90,0.5,2,7\n10,200,170,45,nan,3,7\n",
    );
    assert_eq!(file.format, ReferenceFormat::Joints);
    let log = file.joints().expect("joints");
    assert_eq!(log.names, ["lift", "wrist", "shoulder"]);
    assert_eq!(log.times_s, [0.0, 0.01]);
    assert_eq!(log.row(0), [0.1, PI, 0.5]);
    assert!(log.row(1)[2].is_nan());
    let velocities = log.velocities.as_ref().expect("velocities");
    assert_eq!(velocities[..2], [2.0, PI / 2.0]);
    assert!(velocities[2].is_nan(), "the shoulder has none");
    assert_eq!(findings(&file), ["line 1: ignored column `note_v`"]);
    let gantry = read("t_s,x_m,y_m,z_m\n0,1,2,3\n1,1,2,3\n");
    assert_eq!(gantry.joints().expect("joints").names, ["x", "y", "z"]);
    assert_eq!(gantry.joints().expect("joints").velocities, None);
}

#[test]
fn logs_of_rtde_are_read_with_spaces_or_commas() {
    let names = ["q", "qd"].map(|what| (0..6).map(|k| format!("actual_{what}_{k}")).collect::<Vec<_>>());
    for comma in [" ", ","] {
        let mut text = format!(
            "timestamp{comma}target_q_0{comma}{}{comma}{}\n",
            names[1].join(comma),
            names[0].join(comma)
        );
        for k in 0..20 {
            let row = |scale: f64| {
                (0..6).map(|joint| format!("{:?}", scale * (k + joint) as f64)).collect::<Vec<_>>()
            };
            writeln!(
                text,
                "{:.3}{comma}9{comma}{}{comma}{}",
                100.0 + 0.002 * k as f64,
                row(2.0).join(comma),
                row(0.1).join(comma)
            )
            .expect("written");
        }
        let file = read(&text);
        assert_eq!(file.format, ReferenceFormat::Rtde);
        let log = file.joints().expect("joints");
        assert_eq!(log.names, names[0]);
        assert_eq!((log.times_s[0], log.row(3)[5]), (100.0, 0.1 * 8.0));
        assert_eq!(log.velocities.as_ref().expect("velocities")[6 * 3 + 5], 16.0);
        assert_eq!(findings(&file), ["line 1: ignored column `target_q_0`"]);
    }
}

#[test]
fn times_may_stand_still_and_a_cut_last_line_is_dropped() {
    let rows: String =
        (0..20).map(|k| format!("{:.2},{:.6}\n", 0.01 * f64::from(k / 2), 0.1 * f64::from(k))).collect();
    let file = read(&format!("t_s,a_rad\n{rows}"));
    assert_eq!(file.joints().expect("joints").times_s.len(), 20);
    assert_eq!(findings(&file), [""; 0]);
    let file = read(&format!("t_s,a_rad\n{rows}0.10,0.1"));
    assert_eq!(
        (file.joints().expect("joints").times_s.len(), findings(&file)),
        (20, vec!["line 22: truncated last line dropped".to_owned()])
    );
    let file = read("t_s,a_rad\n0,1\nnan,2\n1,3\n2,4\n20,5\n");
    assert_eq!(file.joints().expect("joints").times_s, [0.0, 1.0, 2.0, 20.0]);
    assert_eq!(findings(&file)[0], "line 3: 1 row without a time dropped");
    assert!(findings(&file).iter().any(|found| found.contains("gap of 18 s")), "{:?}", findings(&file));
}

#[test]
fn the_unit_of_the_times_can_be_given() {
    let text = b"time,a_rad\n0,1\n10,2\n";
    let file = parse_reference_log(text, &in_unit(TimeUnit::Millisecond)).expect("read");
    assert_eq!(file.joints().expect("joints").times_s, [0.0, 0.01]);
    let question =
        parse_reference_log(text, &ReferenceLogOptions::default()).expect_err("no unit").to_string();
    assert!(
        question.contains("the time column `time` has no unit") && question.contains("option `time_unit`"),
        "{question}"
    );
}

#[test]
fn a_log_and_a_recording_count_from_one_time() {
    let imu = b"#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n\
        1403636580838555648,0,0.1,0,0,0,9.8\n1403636580843555648,0.1,0,0,0,0,9.8\n1403636580848555648,0,0,0.1,0,0,9.81\n";
    let imu = parse_imu_recording(imu, &ImuReadOptions::default()).expect("read");
    let header = "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n";
    let mut file = read(&format!("{header}1403636582838555648,1,2,3\n1403636582938555648,1,2,3\n"));
    file.put_on_clock_of(imu.counted_from_ns);
    assert_eq!(file.log.times_s(), [2.0, 2.1]);
    let mut file = read("1403636582.838556 0 0 0 0 0 0 1\n1403636582.938556 0 0 0 0 0 0 1\n");
    file.put_on_clock_of(imu.counted_from_ns);
    assert!((file.log.times_s()[0] - 2.0).abs() < 1e-6);
    let mut file = read("5 0 0 0 0 0 0 1\n6 0 0 0 0 0 0 1\n");
    file.put_on_clock_of(imu.counted_from_ns);
    assert_eq!(file.log.times_s(), [5.0, 6.0], "it has a clock of its own");
}

#[test]
fn a_long_file_is_read_in_pieces_with_its_checksum() {
    let log = motion(20_000);
    let text = table(&log, "", |t| format!("{t:?}"), W_LAST, " ");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("poses.txt");
    std::fs::write(&path, &text).expect("written");
    let file = read_reference_log(&path, &ReferenceLogOptions::default()).expect("read");
    assert_eq!(file, read(&text));
    assert_eq!((file.rows, file.sha256.len()), (20_000, 64));
    let broken = text.replacen("\n150.0 ", "\nabc ", 1);
    std::fs::write(&path, broken).expect("written");
    let refused = read_reference_log(&path, &ReferenceLogOptions::default()).expect_err("broken").to_string();
    assert!(refused.contains("poses.txt:15001:1: \"abc\" in column 1 is not a number"), "{refused}");
}

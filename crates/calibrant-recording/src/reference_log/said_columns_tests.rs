//! Tests of logs whose columns the user names, and of names that are taken as they usually are.

use super::file::ReferenceLogFile;
use super::log_columns::{AngleUnit, JointUnit, LengthUnit, LogColumns, TimeColumns};
use super::options::ReferenceLogOptions;
use super::orientation_form::OrientationForm;
use super::read::parse_reference_log;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

fn try_read(text: &str, columns: LogColumns) -> Result<ReferenceLogFile, String> {
    let options = ReferenceLogOptions { columns, ..ReferenceLogOptions::default() };
    parse_reference_log(text.as_bytes(), &options).map_err(|error| error.to_string())
}

fn read(text: &str) -> ReferenceLogFile {
    try_read(text, LogColumns::default()).expect("read")
}

fn refused(text: &str) -> String {
    try_read(text, LogColumns::default()).expect_err("refused")
}

fn names(of: &[&str]) -> Option<Vec<String>> {
    Some(of.iter().map(|name| (*name).to_owned()).collect())
}

fn codes(file: &ReferenceLogFile) -> String {
    let codes = file.findings.iter().map(|found| found.code().name());
    // two rows are no clock
    codes.filter(|code| *code != "clock-doubtful").collect::<Vec<_>>().join(" ")
}

/// Angle about z, and position, of the first row.
fn first(file: &ReferenceLogFile) -> (f64, [f64; 3]) {
    let log = file.poses().expect("poses");
    let at = log.positions_m[0].expect("seen");
    (log.world_from_body[0].expect("seen").scaled_axis().z, [at.x, at.y, at.z])
}

#[test]
fn the_pose_of_a_tool_is_a_rotation_vector() {
    let rtde = "timestamp actual_TCP_pose_0 actual_TCP_pose_1 actual_TCP_pose_2 actual_TCP_pose_3 actual_TCP_pose_4 actual_TCP_pose_5\n0 1 2 3 0 0 0.5\n0.1 1 2 3 0 0 0.6\n";
    let file = read(rtde);
    assert_eq!(
        (first(&file), codes(&file).as_str(), file.format.name()),
        ((0.5, [1.0, 2.0, 3.0]), "", "rtde")
    );
    let both = rtde
        .replace("timestamp", "timestamp actual_q_0")
        .replace("\n0 ", "\n0 7 ")
        .replace("\n0.1 ", "\n0.1 8 ");
    assert_eq!(read(&both).joints().expect("the usual").row(0), [7.0]);
    let options = ReferenceLogOptions { poses: true, ..ReferenceLogOptions::default() };
    assert_eq!(first(&parse_reference_log(both.as_bytes(), &options).expect("read")).0, 0.5);
    assert!(
        refused(&rtde.replace("actual", "target"))
            .contains("where the tool should have been (target_TCP_pose), not where it was")
    );
}

#[test]
fn names_that_may_mean_another_thing_are_taken_with_a_note() {
    let file = read("t_s,x,y,z,rx,ry,rz\n0,1,2,3,0,0,0.5\n1,1,2,3,0,0,0.6\n");
    assert_eq!((first(&file), codes(&file).as_str()), ((0.5, [1.0, 2.0, 3.0]), "orientation-assumed"));
    let degrees = "t_s,x_mm,y_mm,z_mm,rx [deg],ry [deg],rz [deg]\n0,1,2,3,0,0,90\n1,1,2,3,0,0,91\n";
    assert!(read(degrees).joints().is_some(), "six joints have such names as well");
    let options = ReferenceLogOptions { poses: true, ..ReferenceLogOptions::default() };
    let file = parse_reference_log(degrees.as_bytes(), &options).expect("read");
    assert!((first(&file).0 - FRAC_PI_2).abs() < 1e-12 && first(&file).1 == [0.001, 0.002, 0.003]);
    let long = refused("t_s,x,y,z,rx,ry,rz\n0,1,2,3,0,0,90\n1,1,2,3,0,0,91\n");
    assert!(
        long.contains("90.000 rad, more than a full turn") && long.contains("orientation_unit = \"deg\""),
        "{long}"
    );
    let unit = Some(AngleUnit::Deg);
    let file = try_read(
        "t_s,x,y,z,rx,ry,rz\n0,1,2,3,0,0,90\n1,1,2,3,0,0,91\n",
        LogColumns { orientation_unit: unit, ..LogColumns::default() },
    );
    assert!((first(&file.expect("as said")).0 - FRAC_PI_2).abs() < 1e-12);
    // ABB: w first, and the other way round where it is said
    let abb = "t_s,x,y,z,q1,q2,q3,q4\n0,1,2,3,0.8,0,0,0.6\n1,1,2,3,0.8,0,0,0.6\n";
    let file = read(abb);
    assert_eq!(codes(&file), "orientation-assumed");
    assert!((first(&file).0 - 2.0 * 0.6_f64.asin()).abs() < 1e-12);
    let w_last = Some(OrientationForm::QuaternionXyzw);
    let file = try_read(abb, LogColumns { orientation_is: w_last, ..LogColumns::default() }).expect("read");
    assert_eq!((codes(&file).as_str(), first(&file).0), ("", 0.0));
    assert!(
        refused("t_s,q1,q2,q3,q4\n0,0.1,0.2,0.3,0.4\n1,0.1,0.2,0.3,0.4\n").contains("no column is known")
    );
}

#[test]
fn angles_without_an_order_are_refused_with_the_lines_that_give_it() {
    for (turns, unit, remedy) in [
        (
            "roll,pitch,yaw",
            "",
            "orientation = [\"roll\", \"pitch\", \"yaw\"] and orientation_is = \"extrinsic-xyz\"",
        ),
        ("a,b,c", "", "orientation = [\"a\", \"b\", \"c\"] and orientation_is = \"intrinsic-zyx\""),
        ("w,p,r", "", "orientation = [\"w\", \"p\", \"r\"] and orientation_is = \"extrinsic-xyz\""),
        ("roll_deg,pitch_deg,yaw_deg", "x", "orientation_is = \"extrinsic-xyz\""),
    ] {
        let text = format!("t_s,x,y,z,{turns}\n0,1,2,3,0,0,90\n1,1,2,3,0,0,91\n");
        let said = refused(&text);
        assert!(said.contains(remedy) && said.contains("orientation_unit") == unit.is_empty(), "{said}");
        // to the letter
        let orientation = Some(turns.split(',').map(ToOwned::to_owned).collect());
        let form = said.split("orientation_is = \"").nth(1).and_then(|rest| rest.split('"').next());
        let columns = LogColumns {
            orientation,
            orientation_is: form.and_then(OrientationForm::parse),
            orientation_unit: Some(AngleUnit::Deg),
            ..LogColumns::default()
        };
        let file = try_read(&text, columns.clone()).expect("followed");
        assert_eq!(
            file.poses().expect("poses").world_from_body[0].map(|of| (of.angle() - FRAC_PI_2).abs() < 1e-9),
            Some(true)
        );
        if unit.is_empty() {
            let asked =
                try_read(&text, LogColumns { orientation_unit: None, ..columns }).expect_err("no unit");
            assert!(asked.contains("nothing says the unit of the angle"), "{asked}");
        }
    }
    assert!(
        refused("t_s,roll,pitch,yaw\n0,1,2,3\n1,1,2,3\n")
            .contains("the order of the turns roll, pitch, yaw is not known")
    );
    let of_imu = refused(
        "t_s,ax_g,ay_g,az_g,q0,q1,q2,q3,roll,pitch,yaw\n0,0,0,1,1,0,0,0,1,2,3\n1,0,0,1,1,0,0,0,1,2,3\n",
    );
    assert!(of_imu.contains("those of a recording of an IMU"), "its own estimate is no reference: {of_imu}");
    assert!(read("t_s,roll_rad,pitch_rad,yaw_rad\n0,1,2,3\n1,1,2,3\n").joints().is_some(), "a gimbal");
}

#[test]
fn columns_are_those_that_the_user_names() {
    let text = "stamp_sec,stamp_nanosec,A,B,C,W,I,J,K\n1700000000,500000000,1,2,3,0.8,0,0,0.6\n1700000001,250000000,1,2,3,0.8,0,0,0.6\n";
    let columns = LogColumns {
        position: names(&["A", "B", "C"]),
        position_unit: Some(LengthUnit::Mm),
        orientation: names(&["W", "I", "J", "K"]),
        orientation_is: Some(OrientationForm::QuaternionWxyz),
        ..LogColumns::default()
    };
    let file = try_read(text, columns.clone()).expect("read");
    assert_eq!(first(&file).1, [0.001, 0.002, 0.003]);
    assert_eq!(
        (file.log.times_s(), file.counted_from_ns),
        (&[0.0, 0.75][..], Some(1_700_000_000_500_000_000))
    );
    let time = names(&["stamp_sec", "stamp_nanosec"]).map(TimeColumns);
    assert_eq!(try_read(text, LogColumns { time, ..columns.clone() }).expect("read").log, file.log);
    let missing =
        try_read(text, LogColumns { position: names(&["A", "B", "Q"]), ..columns }).expect_err("missing");
    assert!(missing.contains("names the column `Q`, which the file lacks"), "{missing}");
    // a trajectory whose w is first
    let form = Some(OrientationForm::QuaternionWxyz);
    let columns =
        LogColumns { orientation_is: form, position_unit: Some(LengthUnit::Mm), ..LogColumns::default() };
    let file = try_read("0 1 2 3 0.8 0 0 0.6\n1 1 2 3 0.8 0 0 0.6\n", columns).expect("read");
    assert!((first(&file).0 - 2.0 * 0.6_f64.asin()).abs() < 1e-12 && first(&file).1 == [0.001, 0.002, 0.003]);
    // numbers, in a file without a header
    let columns = LogColumns {
        time: names(&["1"]).map(TimeColumns),
        time_unit: Some(crate::recording::TimeUnit::Millisecond),
        position: names(&["4", "3", "2"]),
        ..LogColumns::default()
    };
    let file = try_read("0 1 2 3 9\n10 1 2 4 9\n", columns).expect("read");
    let log = file.poses().expect("poses");
    assert_eq!(
        (log.times_s[1], log.positions_m[1].map(|at| [at.x, at.y, at.z])),
        (0.01, Some([4.0, 2.0, 1.0]))
    );
}

#[test]
fn joints_are_those_that_the_user_names() {
    let text = "time,q1 [deg],q2,tool\n0,90,1,5\n10,91,2,5\n";
    let joints = Some(BTreeMap::from(
        [("pan", "q1 [deg]"), ("lift", "q2")].map(|(joint, of)| (joint.to_owned(), of.to_owned())),
    ));
    let columns = LogColumns {
        joints,
        time_unit: Some(crate::recording::TimeUnit::Millisecond),
        ..LogColumns::default()
    };
    let asked = try_read(text, columns.clone()).expect_err("no unit");
    assert!(
        asked.contains("nothing says the unit of the joint `lift` in the column `q2`")
            && asked.contains("joints_unit"),
        "{asked}"
    );
    let file = try_read(text, LogColumns { joints_unit: Some(JointUnit::Mm), ..columns }).expect("read");
    let log = file.joints().expect("joints");
    assert_eq!(
        (log.names.join(" ").as_str(), log.row(0), log.times_s[1]),
        ("lift pan", &[1e-3, FRAC_PI_2][..], 0.01)
    );
    assert_eq!(file.turns, [Some(false), Some(true)]);
}

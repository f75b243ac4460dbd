//! Tests of `calibrant inspect` with a machine.

use crate::bench::Bench;
use calibrant::io::machine_preset;

fn arm() -> &'static str {
    machine_preset("arm").expect("known")
}

#[test]
fn the_joints_of_a_machine_are_listed_with_their_limits() {
    let bench = Bench::new();
    bench.write("arm.urdf", arm());
    let outcome = bench.run("inspect arm.urdf").done();
    for words in [
        "arm.urdf: machine arm, 8 links",
        "from base to flange: 6 joints, reach 1.13 m",
        "shoulder_pan revolute -6.28319 to 6.28319 rad 3.14159 rad/s 150 N·m",
        "URDF has no limits of acceleration and jerk.",
    ] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    bench.write("arm.json", bench.run("inspect arm.urdf --tip wrist_1 --json").done().stdout);
    let json = bench.json("arm.json");
    assert_eq!((json["base"].as_str(), json["tip"].as_str()), (Some("base"), Some("wrist_1")));
    assert_eq!(json["joints"].as_array().map(Vec::len), Some(4));
    assert_eq!(json["joints"][2]["upper"], std::f64::consts::PI);
    assert_eq!(json["joints"][2]["missing"], serde_json::json!([]));
}

#[test]
fn missing_limits_and_meshes_are_said() {
    let bench = Bench::new();
    let mesh = r#"<mesh filename="package://arm/base.stl"/>"#;
    let text =
        arm().replacen(r#"velocity="3.141592653589793" effort="28""#, r#"velocity="0" effort="28""#, 1);
    bench.write("arm.urdf", text.replacen(r#"<cylinder radius="0.075" length="0.1"/>"#, mesh, 1));
    let outcome = bench.run("inspect arm.urdf --packages models").done();
    assert!(outcome.printed().contains("joint wrist_1: no limit of velocity"), "{}", outcome.stdout);
    assert!(
        outcome
            .stderr
            .contains("warning: link base: no mesh package://arm/base.stl (looked for models/arm/base.stl)"),
        "{}",
        outcome.stderr
    );
    bench.write("models/arm/base.stl", "solid");
    assert_eq!(bench.run("inspect arm.urdf --packages models").done().stderr, "");
}

#[test]
fn a_broken_machine_is_refused_with_its_place() {
    let bench = Bench::new();
    bench.write("arm.urdf", arm().replacen(r#"<axis xyz="0 0 1"/>"#, r#"<axis xyz="0 0 0"/>"#, 1));
    let outcome = bench.run("inspect arm.urdf").ends_with(2);
    for words in
        ["arm.urdf:18:5: `joint shoulder_pan > axis`: the axis is zero", "value-invalid", "write a direction"]
    {
        outcome.says(words);
    }
    bench.write("arm.urdf", arm());
    let outcome = bench.run("inspect arm.urdf --tip flansch").ends_with(2);
    assert!(outcome.stderr.contains("arm.urdf: the machine has no link `flansch`"), "{}", outcome.stderr);
    bench.write("imu.csv", "t_s,ax_g,ay_g,az_g\n0,0,0,1\n");
    let outcome = bench.run("inspect imu.csv --tip flange").ends_with(2);
    assert!(outcome.stderr.contains("are for machines"), "{}", outcome.stderr);
}

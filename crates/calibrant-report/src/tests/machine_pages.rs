//! Tests of the page on a machine.

use super::super::{About, machine_sheet};
use super::{about, assert_sound, sensor};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::fit::NotConverged;
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

mod machines;
use machines::{MachineCase, machine_case};

fn page(case: &MachineCase) -> String {
    machine_sheet(&case.calibration, &case.setup, &[], &case.recording, &about()).html()
}

/// A sound page but for its one script, which fetches nothing.
fn assert_sound_with_script(html: &str) {
    let (before, rest) = html.split_once("<script>").expect("a script");
    let (script, after) = rest.split_once("</script>").expect("closed");
    assert_sound(&(before.to_owned() + after));
    for bad in ["http", "fetch", "import", "innerHTML", "eval", "url(", "<"] {
        let allowed = bad == "<" && script.replace(" < ", "").find('<').is_none();
        assert!(allowed || !script.contains(bad), "{bad}");
    }
    assert!(script.lines().count() <= 150);
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
}

#[test]
fn an_arm_shows_sensor_mount_budget_motion_residuals_noise_and_geometry() {
    let case = machine_case(false, 12.0, 1);
    let html = page(&case);
    assert_sound_with_script(&html);
    for name in case.calibration.names() {
        assert!(html.contains(&format!("<th scope=\"row\">{name}</th>")), "{name}");
    }
    for says in [
        "Accelerometer and gyroscope against the logged positions of 3 joints",
        "The gains are known to",
        "expected ± prior sd",
        "20 ± 2.0",
        "0 ± 8.7",
        "Where the variance of each parameter comes from",
        "sensor noise",
        "mounting",
        "Table of the budget",
        "The machine in motion",
        "front, seen along y",
        "side, seen against x",
        "top, seen against z",
        "Where the sensor sits",
        "data-part=\"links\"",
        "Accelerometer: specific force",
        "Gyroscope: angular rate",
        "speed of the tip",
        "Residuals by frequency",
        "Coherence of residual and reference",
        "sd of a sample",
        "Corrections in prior standard deviations",
        "shoulder",
        "Correlation of the estimates",
    ] {
        assert!(html.contains(says), "{says}");
    }
    let map = html.split("Correlation of the estimates").nth(1).expect("there");
    assert!(map.contains("clock_rate") && !map.contains("geometry.") && !map.contains("zero."));
    assert_eq!(html, page(&case), "equal inputs give equal pages");
}

#[test]
fn a_tracked_body_has_no_links_and_no_geometry() {
    let case = machine_case(true, 12.0, 2);
    let html = page(&case);
    assert_sound_with_script(&html);
    for says in
        ["the logged poses of the body", "The tracked body", "speed of the body", "position.x", "held"]
    {
        assert!(html.contains(says), "{says}");
    }
    assert!(!html.contains("data-part=\"links\" d=") && !html.contains("Corrections in prior"));
}

/// The shares of the widths of each bar add up.
#[test]
fn the_bars_of_the_budget_are_full() {
    let html = page(&machine_case(false, 12.0, 1));
    let bars: Vec<&str> = html.split("class=\"stack\"").skip(1).collect();
    assert_eq!(bars.len(), 24);
    for bar in bars {
        let bar = bar.split("</div>").next().expect("closed");
        let widths =
            bar.split("width:").skip(1).filter_map(|width| width.split('%').next()?.parse::<f64>().ok());
        let sum: f64 = widths.sum();
        assert!((sum - 100.0).abs() < 0.05, "{sum}");
    }
}

#[test]
fn degenerate_results_on_a_machine_are_reported_without_panic() {
    let mut case = machine_case(false, 6.0, 3);
    let hostile = "a<b>&\"c\"";
    case.calibration.joints[0] = hostile.into();
    case.calibration.sensors.warnings = vec![Diagnostic::from(NotConverged { status: "stalled" })];
    case.calibration.sensors.status = CalibrationStatus::Stalled;
    case.calibration.sensors.fit.p_value = Some(1e-9);
    case.calibration.used_share = 0.4;
    case.calibration.inflation.fill(3.0);
    let about = About { title: hostile.into(), findings: vec![hostile.into()], ..about() };
    let html = machine_sheet(&case.calibration, &case.setup, &[], &case.recording, &about).html();
    assert_sound_with_script(&html);
    assert!(!html.contains(hostile) && html.contains("do not use (not-converged)") && html.contains("× 3.0"));

    case.calibration.covariance.fill(f64::NAN);
    case.calibration.values.fill(f64::INFINITY);
    case.calibration.parameters.mount.lever_m.fill(f64::NAN);
    for row in &mut case.calibration.sensors.budget {
        row.variance = f64::NAN;
        row.parts.fill(f64::NAN);
    }
    for noise in &mut case.calibration.noise {
        noise.noise.fill(0.0);
        noise.residuals.iter_mut().for_each(|sample| sample.value = Vector3::repeat(f64::NAN));
    }
    assert_sound_with_script(&page(&case));

    for noise in &mut case.calibration.noise {
        noise.residuals.clear();
    }
    assert_sound(&page(&case));
    case.calibration.noise.clear();
    case.recording[SensorKind::Accelerometer] = None;
    assert_sound(&page(&case));
}

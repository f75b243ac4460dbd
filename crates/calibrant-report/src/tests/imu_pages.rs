//! Tests of the pages on a whole IMU.

use super::super::{About, calibration_sheet, number_format};
use super::{about, assert_sound, estimate, motion, sensor};
use calibrant_core::diagnostic::RotationReason;
use calibrant_core::diagnostic::fit::NotConverged;
use calibrant_core::estimate::{Calibration, GyroscopeCalibration, Recovered};
use calibrant_core::noise::{Segment, SensorNoise};
use calibrant_core::sensor::{ImuRecording, SensorKind};

mod imus;

fn gyroscope_of(calibration: &mut Calibration) -> &mut GyroscopeCalibration {
    calibration.gyroscope.as_mut().expect("an IMU")
}

#[test]
fn sphere_and_budget_are_files_too() {
    let case = imus::imu_case(14, 1);
    let files = calibration_sheet(&case.calibration, &case.recording, &[], &about()).figures();
    let of = |title: &str| files.iter().find(|of| of.title == title).expect("a figure");
    let sphere = of("Orientations of the holds");
    assert_eq!((sphere.csv.lines().count(), sphere.svg.matches("<svg ").count()), (15, 4), "{}", sphere.svg);
    assert!(!sphere.svg.contains("z < 0"), "XML");
    let budget = of("Where the variance of each parameter comes from");
    let shares = budget.csv.lines().filter(|line| line.starts_with("\"accelerometer.bias.x\""));
    let share =
        |line: &str| line.rsplit(',').next().and_then(|share| share.parse::<f64>().ok()).expect("a share");
    assert!((shares.map(share).sum::<f64>() - 1.0).abs() < 1e-9, "{}", budget.csv);
    assert!(budget.svg.contains(">accelerometer.bias.x</text>"));
}

#[test]
fn a_page_shows_both_sensors_the_holds_the_rotations_and_the_turns() {
    let case = imus::imu_case(14, 1);
    let gyroscope = case.recording[SensorKind::Gyroscope].as_ref().expect("recorded");
    let segment = Segment::between(gyroscope, 0.0, 2.0).expect("long enough");
    let noise = SensorNoise::of(SensorKind::Gyroscope, gyroscope, segment).expect("noisy");
    let html = calibration_sheet(&case.calibration, &case.recording, &[noise], &about()).html();
    assert_sound(&html);
    let text = html.replace("<th scope=\"row\">", "");
    for quantity in &case.calibration.quantities {
        let (name, unit) = (quantity.name(), case.calibration.unit_of(*quantity));
        let short = name.split_once('.').expect("named after its sensor").1;
        assert!(text.contains(&format!("{short}</th>")), "{short}");
        assert!(text.contains(&name) && text.contains(unit), "{name} in {unit}");
    }
    let from = imus::DISTURBED + 1;
    for says in [
        &*format!(
            "from 14 of 14 holds, 12 of 13 rotations (not used: {from} → {}) between them and 1 turn of known angle",
            from + 1
        ),
        "The rotation error is",
        "The gains are known to",
        "from prior",
        "z of both sensors",
        "ω = C_g (y_g − b_g − Γ f)",
        "C_g = [[",
        "Before and after correction",
        "Gravity in each hold, before and after",
        "Before: one gain and one offset for all axes: the means of those found.",
        "gain, less the mean reading at rest.",
        "change by the correction",
        "Magnitude residual of each hold",
        "The gyroscope at rest",
        "Rotation errors",
        "rotation error (°)",
        "after, not used",
        &format!("{from} → {}</th>", from + 1),
        "no: it misses gravity by",
        "Turns of known angle",
        "Allan deviation of the gyroscope",
        "Correlation of the estimates",
    ] {
        assert!(html.contains(says), "{says}");
    }
    // the text to copy is plain
    let copied = html.split("<pre>").nth(1).and_then(|rest| rest.split("</pre>").next()).expect("there");
    assert!(copied.is_ascii() && copied.contains("b_a = [3.31"), "{copied}");
}

#[test]
fn a_terminal_shows_what_was_used_what_was_found_and_how_good_it_is() {
    let case = imus::imu_case(14, 1);
    assert!(case.recording[SensorKind::Gyroscope].is_some());
    let about = about();
    let sheet = calibration_sheet(&case.calibration, &case.recording, &[], &about);
    let text = sheet.text(120);
    let in_one_line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let from = imus::DISTURBED + 1;
    for says in [
        &*format!(
            "from 14 of 14 holds, 12 of 13 rotations (not used: {from} → {}) between them and 1 turn of known angle",
            from + 1
        ),
        "accelerometer.matrix.yz",
        "gyroscope.g_sensitivity.zz",
        "counts/(rad/s)",
        "(°/s)/g",
        "The rotation error is 0.0",
        "the error of the known turns is",
        "gyroscope's noise x, y, z ",
        " counts",
        "status converged",
        "iterations ",
    ] {
        assert!(in_one_line.contains(says), "{says}\n{text}");
    }
    let known = text.lines().find(|line| line.contains("g_sensitivity.xx")).expect("there");
    assert!(known.ends_with(" %"), "{known}");
    assert!(text.starts_with("verdict: doubtful (") && text.contains("\nParameters\n"), "{text}");
    // nothing is wider than the terminal
    for width in [40, 60, 80, 120] {
        assert!(sheet.text(width).lines().all(|line| line.chars().count() <= width), "{width}");
    }
}

/// One gain and one offset for all axes, by hand: `|mean − b̄|/K̄ − g` in each hold.
#[test]
fn the_magnitude_before_is_that_of_plain_readings() {
    let case = imus::imu_case(14, 1);
    let holds = case.calibration.holds().expect("held");
    let imu = &case.calibration.imu[SensorKind::Accelerometer];
    let readings = case.recording[SensorKind::Accelerometer].as_ref().expect("recorded").readings();
    let bias = (imu.bias.x + imu.bias.y + imu.bias.z) / 3.0;
    let gain = imu.matrix.row_iter().map(|row| row.norm()).sum::<f64>() / 3.0;
    let mut squares = 0.0;
    for result in &holds.holds {
        let samples = &readings[result.hold.first..result.hold.end];
        let mean = samples.iter().sum::<nalgebra::Vector3<f64>>() / samples.len() as f64;
        let residual = mean.map(|y| (y - bias) / gain).norm() - 9.81;
        let found = holds.magnitude_residual_before_mps2(&result.hold).expect("regular");
        assert!((found - residual).abs() < 1e-9, "{found} beside {residual}");
        squares += residual * residual;
    }
    let rms = (squares / holds.holds.len() as f64).sqrt();
    let found = holds.magnitude_residual_rms_before_mps2().expect("regular");
    assert!((found / rms - 1.0).abs() < 1e-9 && rms > 0.5, "{found} beside {rms}");
    let html = calibration_sheet(&case.calibration, &case.recording, &[], &about()).html();
    let [before, after] =
        [found, holds.magnitude_residual_rms_mps2].map(|v| number_format::significant(v, 3));
    assert!(
        html.contains(&format!("<td class=\"n\">{before}</td><td class=\"n\">{after}</td><td>m/s²</td>")),
        "{before}, {after}"
    );
}

#[test]
fn the_verdict_follows_the_status_the_warnings_and_the_prior() {
    let case = imus::imu_case(14, 1);
    let mut calibration = case.calibration;
    let page = |calibration: &Calibration| {
        let html = calibration_sheet(calibration, &case.recording, &[], &about()).html();
        assert_sound(&html);
        html
    };
    assert!(page(&calibration).contains("verdict caution"), "a rotation was left out");
    calibration.warnings.clear();
    calibration.prior_share.fill(0.0);
    assert!(page(&calibration).contains("verdict good"));
    calibration.prior_share[0] = 0.9;
    assert!(page(&calibration).contains("less information than the prior about accelerometer.bias.x."));
    calibration.prior_share[0] = 0.0;
    assert!(!page(&calibration).contains("nown beforehand"));
    gyroscope_of(&mut calibration)
        .rotations
        .iter_mut()
        .for_each(|rotation| rotation.error_before_rad = rotation.error_rad);
    assert!(page(&calibration).contains("hardly improves the rotations"));
    calibration.warnings.push(NotConverged { status: "stalled" }.into());
    assert!(page(&calibration).contains("verdict bad") && page(&calibration).contains("(not-converged)"));
}

#[test]
fn degenerate_results_and_hostile_words_are_reported_without_harm() {
    let case = imus::imu_case(14, 1);
    let mut calibration = case.calibration;
    for rotation in &mut gyroscope_of(&mut calibration).rotations {
        (rotation.used, rotation.path_rad) = (false, 0.0);
        rotation.reason = Some(RotationReason::SamplesMissing);
    }
    let hostile = About { findings: vec!["a<b>&\"c\"".into()], ..About::default() };
    let html = calibration_sheet(&calibration, &ImuRecording::default(), &[], &hostile).html();
    assert_sound(&html);
    assert!(html.contains("a&lt;b&gt;&amp;&quot;c&quot;"));
    assert!(html.contains("no: the gyroscope has too few samples") && !html.contains("Rotation errors"));

    gyroscope_of(&mut calibration).rotations.clear();
    gyroscope_of(&mut calibration).turns.clear();
    if let Recovered::Holds(holds) = &mut calibration.recovered {
        holds.holds.clear();
    }
    calibration.covariance.fill(f64::NAN);
    calibration.values.fill(f64::INFINITY);
    gyroscope_of(&mut calibration).still.noise.fill(f64::NAN);
    assert_sound(&calibration_sheet(&calibration, &case.recording, &[], &about()).html());

    calibration.imu[SensorKind::Gyroscope].matrix.fill(0.0);
    let html = calibration_sheet(&calibration, &case.recording, &[], &about()).html();
    assert_sound(&html);
    assert!(html.contains("there is no correction"));
}

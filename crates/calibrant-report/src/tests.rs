//! Tests of what holds for every report page.

use super::{About, Batch, BatchParameter, BatchSensor, calibration_sheet};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::datasheet::WeakerThanDatasheet;
use calibrant_core::estimate::{Calibration, Recovered};
use calibrant_core::sensor::SensorKind;
use calibrant_core::{estimate, information, motion, sensor, simulate};
use calibrant_design as design;
use calibrant_study as study;
use nalgebra::Vector3;

mod batch_pages;
mod batches;
mod design_pages;
mod designs;
mod fakes;
mod imu_pages;
mod machine_pages;
mod noise_pages;
#[cfg(feature = "study")]
mod studies;
#[cfg(feature = "study")]
mod study_pages;

#[test]
fn the_script_of_the_figures_is_short_and_fetches_nothing() {
    let script = super::html::CHART_SCRIPT;
    for bad in ["http", "fetch", "import", "innerHTML", "eval", "url(", "<"] {
        assert!(!script.contains(bad), "{bad}");
    }
    assert!(script.lines().count() <= 215);
}

fn about() -> About {
    About { title: "A test".to_string(), of_thesis: true, ..About::default() }
}

/// The page without the script of its figures.
fn without_script(html: &str) -> String {
    html.replacen(&format!("<script>\n{}</script>\n", super::html::CHART_SCRIPT), "", 1)
}

/// Asserts one self-contained file whose numbers are all finite, whose contents lead somewhere, and whose legends are distinct.
fn assert_sound(html: &str) {
    let html = without_script(html);
    let html = html.as_str();
    assert!(html.starts_with("<!DOCTYPE html>") && html.trim_end().ends_with("</html>"));
    for bad in ["http", "NaN", "nan,", "inf ", "\"inf", "url(", "<script", "src=", "@import"] {
        assert!(!html.contains(bad), "{bad}: …{}…", excerpt(html, bad));
    }
    for address in between(html, "href=\"#", "\"") {
        assert_eq!(html.matches(&format!(" id=\"{address}\"")).count(), 1, "{address}");
    }
    for legend in between(html, "<ul class=\"legend\">", "</ul>") {
        let signs: Vec<&str> = between(legend, "<li>", "</svg>").collect();
        let alike = signs.iter().enumerate().find(|(k, sign)| signs[..*k].contains(sign));
        assert!(alike.is_none(), "two signs are alike in {legend}");
    }
    for tag in ["table", "figure", "svg", "div", "tr", "td", "text"] {
        let opened = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(opened, html.matches(&format!("</{tag}>")).count(), "{tag}");
    }
}

/// The texts between `before` and the next `after`.
fn between<'a>(html: &'a str, before: &'a str, after: &'a str) -> impl Iterator<Item = &'a str> {
    html.split(before).skip(1).filter_map(move |rest| Some(rest.split_once(after)?.0))
}

fn excerpt<'a>(html: &'a str, needle: &str) -> &'a str {
    let at = html.find(needle).unwrap_or(0);
    let start = html.floor_char_boundary(at.saturating_sub(80));
    &html[start..html.floor_char_boundary((at + 80).min(html.len()))]
}

fn residuals_of(calibration: &mut Calibration) -> &mut Vec<Vector3<f64>> {
    match &mut calibration.recovered {
        Recovered::Motion(motion) => &mut motion.residuals,
        _ => panic!("no motion"),
    }
}

fn assert_names_all(html: &str, calibration: &Calibration) {
    for parameter in &calibration.parameters {
        let name = &parameter.name;
        assert!(html.contains(&format!("<th scope=\"row\">{name}</th>")), "{name}");
        assert!(html.contains(&format!("<td>{}</td>", parameter.unit)));
    }
}

#[test]
fn a_motion_calibration_shows_every_parameter_figure_and_axis() {
    let case = fakes::motion_case(3, 14, 2.0, 1);
    let about = About { truth: Some(case.truth), true_motion: Some(case.true_motion.clone()), ..about() };
    let html = calibration_sheet(&case.calibration, &case.recording.clone().into(), &[], &about).html();
    assert_sound(&html);
    assert_names_all(&html, &case.calibration);
    for text in [
        "Figure 4 of the thesis",
        "Figure 5 of the thesis",
        "axis z",
        "time (s)",
        "p-value",
        "Autocorrelation",
    ] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn a_static_calibration_shows_every_parameter_and_hold() {
    let (calibration, recording) = fakes::hold_case(38, 50);
    let html = calibration_sheet(&calibration, &recording, &[], &about()).html();
    assert_sound(&html);
    assert_names_all(&html, &calibration);
    for text in ["<th scope=\"row\">38</th>", "no: outlier", "Gauge upper", "counts/(m/s²)", "upper half"] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn text_of_the_user_is_escaped() {
    let case = fakes::motion_case(1, 3, 2.0, 1);
    let hostile = "a<b>&\"c\".csv";
    let mut calibration = case.calibration;
    calibration.warnings =
        vec![Diagnostic::from(WeakerThanDatasheet { parameters: vec![hostile.to_string()] })];
    let about = About {
        title: hostile.to_string(),
        facts: vec![(hostile.to_string(), hostile.to_string())],
        findings: vec![hostile.to_string()],
        ..About::default()
    };
    let html = calibration_sheet(&calibration, &case.recording.clone().into(), &[], &about).html();
    assert_sound(&html);
    assert!(!html.contains(hostile) && html.matches("a&lt;b&gt;&amp;&quot;c&quot;.csv").count() >= 6);
}

#[test]
fn large_inputs_give_small_files() {
    let case = fakes::motion_case(3, 20, 10_000.0, 1);
    assert!(case.recording.len() > 1_000_000);
    let html = calibration_sheet(&case.calibration, &case.recording.clone().into(), &[], &about()).html();
    assert_sound(&html);
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
}

#[test]
fn residuals_are_seen_beside_a_noise_that_is_far_too_small() {
    let case = fakes::motion_case(3, 4, 2.0, 1);
    let page = |calibration: &Calibration| {
        calibration_sheet(calibration, &case.recording.clone().into(), &[], &about()).html()
    };
    let cut = "The top of the curve is beyond the axis";
    assert!(!page(&case.calibration).contains(cut));
    let mut contradicted = case.calibration.clone();
    residuals_of(&mut contradicted).iter_mut().for_each(|residual| *residual *= 500.0);
    let html = page(&contradicted);
    assert_sound(&html);
    assert!(html.contains(cut));
}

#[test]
fn degenerate_results_are_reported_without_panic() {
    let case = fakes::motion_case(3, 4, 2.0, 1);
    let empty = case.recording.only(|_| false);
    let mut calibration = case.calibration.clone();
    residuals_of(&mut calibration).clear();
    assert_sound(&calibration_sheet(&calibration, &empty.into(), &[], &about()).html());

    calibration = case.calibration.clone();
    calibration.covariance.fill(0.0);
    residuals_of(&mut calibration).fill(Vector3::zeros());
    calibration.fit.assumed_noise = None;
    calibration.fit.noise_estimate = None;
    calibration.fit.p_value = None;
    calibration.fit.degrees_of_freedom = 0;
    calibration.fit.residual_rms = None;
    assert_sound(&calibration_sheet(&calibration, &case.recording.clone().into(), &[], &about()).html());

    calibration.covariance.fill(f64::NAN);
    calibration.values.fill(f64::INFINITY);
    residuals_of(&mut calibration).fill(Vector3::repeat(f64::NAN));
    calibration.imu[SensorKind::Accelerometer].matrix.fill(0.0);
    calibration.fit.chi2 = f64::NAN;
    calibration.gradient_norm = f64::INFINITY;
    if let Recovered::Motion(motion) = &mut calibration.recovered {
        motion.acceleration_sd_mps2.fill(Vector3::repeat(f64::NAN));
    }
    assert_sound(&calibration_sheet(&calibration, &case.recording.clone().into(), &[], &about()).html());

    let (mut calibration, recording) = fakes::hold_case(3, 20);
    if let Recovered::Holds(holds) = &mut calibration.recovered {
        holds.holds[0].force_mps2.fill(0.0);
        holds.holds[1].studentised_residual = f64::NAN;
        assert_sound(&calibration_sheet(&calibration, &recording, &[], &about()).html());
    }
    if let Recovered::Holds(holds) = &mut calibration.recovered {
        holds.holds.clear();
    }
    assert_sound(&calibration_sheet(&calibration, &recording, &[], &about()).html());
}

//! Tests of the pages about designs.

use super::{about, assert_sound, designs};
use crate::{About, design_sheet, evaluation_sheet, number_format, sweep_sheet};
use calibrant_core::motion::{JerkControlledMotion, Limits};
use calibrant_core::sensor::{Sensor, SensorModel};
use calibrant_design::{Certificate, Design, DesignStatus, StartOutcome, Sweep, assess};
use nalgebra::Vector3;

fn design(sensor: &Sensor, starts: usize) -> Design {
    let limits = designs::arm();
    designs::design_of(&designs::problem(sensor, &limits), starts)
}

#[test]
fn a_design_shows_every_number_of_the_result() {
    let design = design(&Sensor::memsic_mxd2020u(), 30);
    let html = design_sheet(&design, &about()).html();
    assert_sound(&html);
    for ((parameter, old), new) in
        design.parameters.iter().zip(design.baseline().1.sd()).zip(design.optimal.sd())
    {
        assert!(html.contains(&format!("<th scope=\"row\">{}</th>", parameter.name)), "{}", parameter.name);
        for sd in [old, new] {
            assert!(
                html.contains(&format!(">{}<", number_format::significant(sd * 1e6, 4))),
                "{}: {sd}",
                parameter.name
            );
        }
    }
    let certificate = design.certificate.as_ref().expect("made up");
    for value in [design.baseline().1.value, design.optimal.value, certificate.lower_bound] {
        assert!(html.contains(&number_format::significant(value, 6)), "{value}");
    }
    for start in &design.starts {
        assert!(html.contains(&number_format::significant(start.value, 8)));
    }
    for text in [
        "Figure 8 of the thesis",
        "jerk uᵢ (m/s³)",
        "acceleration (m/s²)",
        "velocity (m/s)",
        "displacement (m)",
        "Confidence ellipses",
        "Correlation of the estimates",
        "18 of 30 starts",
        "Moment relaxation",
        "100 %: the limit is active",
    ] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn the_verdict_says_what_is_proved_and_what_is_not() {
    let sensor = Sensor::memsic_mxd2020u();
    let mut design = design(&sensor, 3);
    let html = design_sheet(&design, &about()).html();
    assert!(html.contains("Proved optimal to within 0.50 %"));
    assert!(html.contains("No motion within the limits can give scale.z a standard deviation below"));

    design.status = DesignStatus::IterationLimit;
    assert!(design_sheet(&design, &about()).html().contains("verdict caution"));

    design.status = DesignStatus::Converged;
    design.certificate = None;
    let html = design_sheet(&design, &about()).html();
    assert!(html.contains("a better motion is not ruled out") && !html.contains("Proved"));
}

#[test]
fn a_motion_that_breaks_a_limit_or_determines_nothing_is_called_so() {
    let sensor = Sensor::memsic_mxd2020u();
    let mut broken = design(&sensor, 3);
    broken.limits.velocity_mps = Some(Vector3::new(2.0, 10.0, 10.0));
    let html = design_sheet(&broken, &about()).html();
    assert_sound(&html);
    assert!(html.contains("verdict bad") && html.contains("velocity of axis x is 3.14"));

    let limits = designs::arm();
    let problem = designs::problem(&sensor, &limits);
    let mut still = design(&sensor, 3);
    let zeros = vec![Vector3::zeros(); 11];
    let zeros = JerkControlledMotion::uniform(1.0, zeros).expect("valid");
    still.optimal = calibrant_design::evaluate(&problem, &zeros).expect("a valid setting");
    let html = design_sheet(&still, &about()).html();
    assert_sound(&html);
    assert!(html.contains("verdict bad") && html.contains("scale.y is not determined"));
}

#[test]
fn every_shape_of_problem_makes_a_sound_page() {
    let one_axis = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let html = design_sheet(&design(&one_axis, 2), &about()).html();
    assert_sound(&html);
    assert!(!html.contains("axis y"));

    let full = Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() };
    let html = design_sheet(&design(&full, 2), &about()).html();
    assert_sound(&html);
    assert!(html.contains("matrix.zy"));

    let mut bare = design(&one_axis, 0);
    bare.limits = Limits { intercept_mps2: bare.limits.acceleration_mps2, ..Limits::default() };
    bare.certificate = Some(Certificate {
        lower_bound: f64::NAN,
        gap: f64::INFINITY,
        sd_lower_bound: Vec::new(),
        explanation: String::new(),
    });
    (bare.shuttle, bare.initial.covariance) = (None, None);
    let html = design_sheet(&bare, &about()).html();
    assert_sound(&html);
    assert!(html.contains("state xᵢ (m/s²)") && html.contains("undetermined"));
}

#[test]
fn many_starts_are_folded() {
    let mut design = design(&Sensor::memsic_mxd2020u(), 40);
    assert!(!design_sheet(&design, &about()).html().contains("<details>"));
    design.starts.push(StartOutcome { value: f64::NAN, ..design.starts[0].clone() });
    let html = design_sheet(&design, &about()).html();
    assert_sound(&html);
    assert!(html.contains("<details><summary>All 41 starts, best first</summary>"));
}

#[test]
fn text_of_the_user_is_escaped_in_designs() {
    let hostile = "a<b>&\"c\".csv";
    let mut design = design(&Sensor::memsic_mxd2020u(), 2);
    design.certificate.as_mut().expect("made up").explanation = hostile.to_string();
    let about = About {
        title: hostile.to_string(),
        facts: vec![(hostile.to_string(), hostile.to_string())],
        findings: vec![hostile.to_string()],
        ..About::default()
    };
    let html = design_sheet(&design, &about).html();
    assert_sound(&html);
    assert!(!html.contains(hostile) && html.matches("a&lt;b&gt;&amp;&quot;c&quot;.csv").count() >= 5);
}

#[test]
fn an_evaluation_compares_with_the_optimum_and_names_what_is_broken() {
    let sensor = Sensor::memsic_mxd2020u();
    let limits = designs::arm();
    let problem = designs::problem(&sensor, &limits);
    let own = designs::swing(&problem, [1.0; 3]).motion;
    let design = designs::design_of(&problem, 3);
    let assessment = assess(&problem, &own, Ok(design)).expect("valid");
    let html = evaluation_sheet(&assessment, &about()).html();
    assert_sound(&html);
    let gain = assessment.evaluation.sd()[4] / assessment.optimum.as_ref().expect("given").optimal.sd()[4];
    assert!(
        gain > 2.0 && html.contains(&format!("scale.y {} times smaller", number_format::fixed(gain, 2))),
        "{gain}"
    );
    let efficiency = number_format::percent(assessment.efficiency().expect("both determined"));
    assert!(html.contains("a better motion is worth the effort") && html.contains(&efficiency));

    // twice as wide breaks the displacement, and there may be nothing to compare with
    let nodes = own.acceleration_mps2().iter().map(|a| a * 2.0).collect();
    let wide = JerkControlledMotion::uniform(1.0, nodes).expect("valid");
    let hostile = Err("the limits <clash>".to_string());
    let html = evaluation_sheet(&assess(&problem, &wide, hostile).expect("valid"), &about()).html();
    assert_sound(&html);
    assert!(
        html.contains("Breaks limits")
            && html.contains(
                "displacement of axis x is 20.00 m at 5.000 s, 10.00 beyond the limit of 10.00 (100 %)"
            )
    );
    assert!(html.contains("the limits &lt;clash&gt;"));

    let still = JerkControlledMotion::uniform(2.0, vec![Vector3::zeros(); 3]).expect("valid");
    let design = designs::design_of(&problem, 3);
    let html = evaluation_sheet(&assess(&problem, &still, Ok(design)).expect("valid"), &about()).html();
    assert_sound(&html);
    assert!(html.contains("verdict bad") && html.contains("scale.x is not determined"));
    assert!(html.contains("takes 4 s in 2 intervals"));
}

#[test]
fn a_sweep_shows_every_value_and_why_some_have_no_design() {
    let sensor = Sensor::memsic_mxd2020u();
    let sweep = designs::sweep(&sensor);
    let html = sweep_sheet(&sweep, &about()).html();
    assert_sound(&html);
    for point in &sweep.points {
        assert!(html.contains(&format!("<th scope=\"row\">{}</th>", number_format::short(point.value))));
        for sd in point.sd(sweep.parameters.len()).into_iter().filter(|sd| sd.is_finite()) {
            assert!(html.contains(&number_format::significant(sd * 1e6, 4)), "{sd}");
        }
    }
    for text in
        ["each doubling", "lower bound", "the limits &lt;clash&gt;", "iteration limit", "scale factor x, y"]
    {
        assert!(html.contains(text), "{text}");
    }
    let nothing = Sweep { points: sweep.points[..1].to_vec(), ..sweep.clone() };
    let html = sweep_sheet(&nothing, &about()).html();
    assert_sound(&html);
    assert!(
        html.contains("No motion was designed")
            && html.contains("no motion was designed at any of the values")
    );
    assert_sound(&sweep_sheet(&Sweep { points: Vec::new(), ..sweep }, &about()).html());
}

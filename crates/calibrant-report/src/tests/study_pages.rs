//! Tests of the pages about studies of optimal motions.

use super::{about, assert_sound, studies};
use crate::{number_format, study_sheet};
use calibrant_core::motion::Trust;
use calibrant_study::Studies;

#[test]
fn a_study_of_everything_shows_the_figures_of_chapters_three_and_four() {
    let everything = studies::everything(20, 12);
    let html = study_sheet(&everything, &about()).html();
    assert_sound(&html);
    for figure in (4..=11).chain(13..=14) {
        assert!(html.contains(&format!("Figure {figure} of the thesis")), "Figure {figure}");
    }
    for study in [&everything.design, &everything.noisy].into_iter().flatten() {
        for entry in &study.summary {
            let error = entry.realised.standard_error.expect("many sensors");
            assert!(
                html.contains(&number_format::with_sd(entry.realised.value, error)),
                "{}",
                entry.initial.name
            );
        }
        for trace in [study.trace.initial.most, study.trace.optimal.median] {
            assert!(html.contains(&number_format::significant(trace, 4)), "{trace}");
        }
    }
    for text in [
        "log₁₀ trace",
        "(a) bias.x",
        "(b) scale.z",
        "not determined: the sensor does not move",
        "4 like sensor 1 (within 1 %), 6 mirrored, 0 otherwise",
    ] {
        assert!(html.contains(text), "{text}");
    }
    assert!(html.contains("no motion was designed: &lt;and why&gt;"));
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
}

#[test]
fn each_experiment_alone_makes_a_page() {
    let all = studies::everything(2, 3);
    let pages = [
        Studies::default(),
        Studies { surface: all.surface.clone(), ..Studies::default() },
        Studies { design: all.design.clone(), ..Studies::default() },
        Studies { noisy: all.noisy.clone(), ..Studies::default() },
    ];
    for (page, figure) in
        pages.iter().zip(["No study was run", "Figure 7 of", "Figure 10 of", "Figure 13 of"])
    {
        let html = study_sheet(page, &about()).html();
        assert_sound(&html);
        assert!(html.contains(figure), "{figure}");
    }
}

#[test]
fn a_single_sensor_and_broken_numbers_are_reported_without_panic() {
    let mut study = studies::design_study(1, Trust::Known);
    study.summary.iter_mut().for_each(|entry| entry.realised.standard_error = None);
    assert_sound(
        &study_sheet(&Studies { design: Some(study.clone()), ..Studies::default() }, &about()).html(),
    );
    study.outcomes[0].optimal.values.fill(f64::NAN);
    study.outcomes[0].optimal.trace = f64::INFINITY;
    study.outcomes[0].initial.trace = 0.0;
    study.outcomes[0].initial.values.clear();
    study.trace.optimal.median = f64::NAN;
    assert_sound(&study_sheet(&Studies { design: Some(study), ..Studies::default() }, &about()).html());

    let mut surface = studies::everything(1, 1).surface;
    if let Some(surface) = &mut surface {
        surface.log10_trace.iter_mut().flatten().for_each(|value| *value = None);
    }
    assert_sound(&study_sheet(&Studies { surface, ..Studies::default() }, &about()).html());
}

#[test]
fn a_study_shows_the_figures_of_the_thesis() {
    let study = studies::calibrations(studies::calibration_study(50));
    let html = study_sheet(&study, &about()).html();
    assert_sound(&html);
    for figure in 4..=6 {
        assert!(html.contains(&format!("Figure {figure} of the thesis")), "Figure {figure}");
    }
}

#[test]
fn a_large_study_gives_a_small_file() {
    let html = study_sheet(&studies::calibrations(studies::calibration_study(100_000)), &about()).html();
    assert_sound(&html);
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
}

#[test]
fn a_study_of_one_sensor_or_none_is_reported_without_panic() {
    assert_sound(&study_sheet(&studies::calibrations(studies::calibration_study(0)), &about()).html());
    assert_sound(&study_sheet(&studies::calibrations(studies::calibration_study(1)), &about()).html());
}

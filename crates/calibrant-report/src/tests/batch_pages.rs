//! Tests of the page on a batch of sensors.

use super::batches::drifting_batch;
use super::{about, assert_sound};
use crate::{Batch, batch_sheet};

#[test]
fn the_page_shows_yield_failures_causes_and_every_parameter() {
    let batch = drifting_batch(40);
    let html = batch_sheet(&batch, &about()).html();
    assert_sound(&html);
    assert!(
        html.contains("✗ Yield 88 %: 35 of 40 sensors ok."),
        "three have spikes, one is bad, one has no result"
    );
    assert!(html.contains("1 bad, 3 doubtful, 1 without a result. 1 breaks a limit of [accept]."));
    let table = html.find("Sensors that are not ok").expect("a section");
    let order = ["sensor-14<", "sensor-21/report.html", "sensor-5/report.html"].map(|name| html.find(name));
    assert!(Some(table) < order[0] && order.is_sorted(), "no result, bad, doubtful: {order:?}");
    assert!(!html.contains("sensor-14/report.html"), "it has no page");
    let causes = ["spikes</th>", "parameter-implausible</th>"].map(|code| html.find(code));
    assert!(causes[0].is_some() && causes.is_sorted(), "the most frequent is first: {causes:?}");
    for parameter in &batch.parameters {
        let panels = html.matches(&format!("aria-label=\"{}\"", parameter.name)).count();
        assert_eq!(panels, 2, "a histogram and a chart of {}", parameter.name);
    }
    assert!(html.contains("estimate, 1 outside"), "the bad one does not flatten the others");
    assert!(html.contains("Beyond the control limits: accelerometer.bias.x of sensor-1, "));
    assert!(
        html.contains("<th scope=\"col\">station</th>") && !html.contains("<th scope=\"col\">recorded</th>")
    );
    assert!(html.contains("<dt>Stations</dt><dd>L1 (20), L2 (20)</dd>"));
    assert!(html.contains("data-names=\"all-sensors\"") && html.contains("<h2 id=\"all-sensors\">"));
    // bias.x drifts beyond its limits, bias.y has half a spread of 0.05 about zero: 0.15 over three of these
    let row = |name: &str| {
        let rows = html.split("Scatter of the parameters</h2>").nth(1).expect("a section");
        let row = rows.split(&format!("{name}</th>")).nth(1).expect("a row").split("</tr>").next();
        row.expect("its end").replace("<td>", "").replace("<td class=\"n\">", "").replace("</td>", "|")
    };
    let cells = row("bias.y");
    let cpk = cells.split('|').nth_back(1).and_then(|cell| cell.split(' ').next());
    let cpk: f64 = cpk.and_then(|text| text.parse().ok()).expect("a number");
    assert!((1.4..2.6).contains(&cpk), "{cells}");
    assert!(row("scale.x").ends_with("–|–|"), "it has no limits");
}

#[test]
fn each_message_has_a_line_and_each_code_its_sensors() {
    let mut batch = drifting_batch(40);
    batch.sensors[4].reasons = vec!["One thing is wrong".into(), "another is, too".into()];
    let html = batch_sheet(&batch, &about()).html();
    assert!(html.contains(">One thing is wrong.<br>Another is, too.</td>"));
    assert!(html.contains("<td>sensor-5<br>sensor-14<br>sensor-23<br>sensor-32</td>"), "those with spikes");
}

#[test]
fn a_long_name_is_broken_so_that_the_verdict_stays_in_view() {
    let mut batch = drifting_batch(6);
    let long = "recording_".repeat(12);
    batch.sensors[1].name.clone_from(&long);
    let html = batch_sheet(&batch, &about()).html();
    assert_sound(&html);
    assert!(html.contains("<th scope=\"row\"><a href=\"sensor-1/report.html\">sensor-1</a></th>"));
    let broken = format!("<th scope=\"row\" class=\"long\"><a href=\"sensor-2/report.html\">{long}</a></th>");
    assert!(html.contains(&broken));
}

#[test]
fn a_batch_without_results_has_a_page() {
    assert_sound(&batch_sheet(&Batch::default(), &about()).html());
    let mut batch = drifting_batch(6);
    batch.sensors.retain(|sensor| sensor.verdict.is_err());
    let html = batch_sheet(&batch, &about()).html();
    assert_sound(&html);
    assert!(html.contains("file-empty") && !html.contains("Distribution of the parameters"));
    let mut one = drifting_batch(6);
    one.sensors.truncate(1);
    assert_sound(&batch_sheet(&one, &about()).html());
}

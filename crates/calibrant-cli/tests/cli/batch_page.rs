//! Tests of batch.html, the page on a batch.

use crate::bench::Bench;

const CALIBRATE: &str =
    "calibrate experiment.toml --motion motion.csv s1.csv s2.csv s3.csv s4.csv s5.csv s6.csv";

#[test]
fn the_page_names_the_bad_sensor_its_codes_and_the_yield() {
    let bench = Bench::new();
    bench.six_sensors();
    bench.write("s6.csv", "");
    let outcome = bench.run(&format!("{CALIBRATE} -o results"));
    assert_eq!(outcome.status, 5, "{outcome:?}");
    assert!(outcome.stdout.ends_with("5 calibrated, 1 failed: results/summary.csv\nresults/batch.html\n"));
    let page = bench.read("results/batch.html");
    assert!(page.contains("✗ Yield 67 %: 4 of 6 sensors ok."), "{outcome:?}");
    assert!(page.contains("1 bad, 0 doubtful, 1 without a result."));
    let list = page.split("Sensors that are not ok</h2>").nth(1).and_then(|of| of.split("</table>").next());
    let list = list.expect("a table");
    for text in ["<a href=\"s4/report.html\">s4</a>", "parameter-implausible", "s6</th>", "file-empty"] {
        assert!(list.contains(text), "{text}: {list}");
    }
    assert!(
        !list.contains("s1") && !list.contains("s6/report.html"),
        "an empty file has nothing to show: {list}"
    );
    assert!(page.find("Causes</h2>") < page.find("Sensors that are not ok</h2>"), "causes are first");
    let causes = page.split("Sensors with each code").nth(1).expect("bars");
    assert!(causes.contains("<th scope=\"row\">file-empty</th><td class=\"n\">1 (17 %)</td>"));
    assert!(page.contains("aria-label=\"accelerometer.scale.x\"") && page.contains("estimate, 1 outside"));
}

#[test]
fn the_page_has_the_limits_and_leads_to_the_results_that_are_there() {
    let bench = Bench::new();
    bench.six_sensors();
    bench.write("limits.toml", "[accept]\n\"accelerometer.scale\" = { range = [0.98, 1.02] }\n");
    let command = format!("{CALIBRATE} --accept limits.toml --no-report");
    bench.run(&format!("{command} --threads 1 -o one")).ends_with(5);
    bench.run(&format!("{command} --threads 2 -o two")).ends_with(5);
    let page = bench.read("one/batch.html");
    assert!(page == bench.read("two/batch.html"), "the same to the byte");
    assert!(page.contains("1 breaks a limit of [accept].") && page.contains("acceptance limits"));
    assert!(page.contains("<a href=\"s4/calibration.json\">s4</a>") && !page.contains("report.html"));
}

#[test]
fn no_recording_takes_the_place_of_the_page() {
    let bench = Bench::new();
    bench.six_sensors();
    bench.write("batch.html.csv", bench.read("s1.csv"));
    bench.run("calibrate experiment.toml --motion motion.csv batch.html.csv s2.csv -o results").done();
    assert!(bench.path("results/batch.html").is_file());
    assert!(bench.path("results/batch.html-2/calibration.json").is_file());
}

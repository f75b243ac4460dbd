//! Tests of `calibrant design` of a campaign over temperature.

use crate::bench::Bench;

fn bench(edits: &[(&str, &str)]) -> Bench {
    let bench = Bench::new();
    bench.preset("campaign", "campaign.toml", edits);
    bench
}

#[test]
fn a_campaign_has_a_timetable_a_bound_and_what_is_usual_beside_it() {
    let bench = bench(&[]);
    let outcome = bench.run("design campaign.toml -o plan").done();
    for word in
        ["34 soaks in", "above the bound", "every 10 °C there and back", "from above", "plan/campaign.csv"]
    {
        assert!(outcome.printed().contains(word), "{word}\n{}", outcome.stdout);
    }
    let design = bench.json("plan/design.json");
    assert_eq!(design["kind"], "campaign");
    let number = |pointer: &str| design.pointer(pointer).and_then(|of| of.as_f64()).expect("a number");
    assert!(number("/certificate/lower_bound_anywhere") <= number("/certificate/lower_bound"));
    assert!(number("/certificate/lower_bound") <= number("/value"));
    let table = bench.read("plan/campaign.csv");
    assert!(table.starts_with("soak,temperature_c,direction,wait_min,blocks,begin_min,end_min\n"), "{table}");
    let last =
        table.lines().last().and_then(|row| row.rsplit(',').next()).and_then(|end| end.parse::<f64>().ok());
    assert!(last.expect("a time") <= 360.0);
    assert!(bench.read("plan/report.html").contains("Standard deviation over temperature"));
    // machine output is the file
    let json = bench.run("design campaign.toml --json -o again").done();
    assert_eq!(json.stdout.trim_end(), bench.read("plan/design.json").trim_end());
}

/// Time for one soak or two, and a room outside the range.
#[test]
fn short_campaigns_and_other_rooms_fit_their_time() {
    for edits in [
        [("budget_min = 360.0", "budget_min = 83.0"), ("# cycles = 1 ", "cycles = 1 ")],
        [("budget_min = 360.0", "budget_min = 88.0"), ("# cycles = 1 ", "cycles = 1 ")],
        [("range_c = [-20.0, 60.0]", "range_c = [40.0, 90.0]"), ("# cycles = 1 ", "cycles = 3 ")],
    ] {
        let bench = bench(&edits);
        bench.run("design campaign.toml -o plan").done();
        let table = bench.read("plan/campaign.csv");
        let last: Vec<f64> =
            table.lines().last().expect("a soak").split(',').filter_map(|of| of.parse().ok()).collect();
        let [.., temperature_c, _, _, _, end_min] = last[..] else { panic!("{table}") };
        let budget_min = bench
            .read("campaign.toml")
            .lines()
            .find_map(|line| line.strip_prefix("budget_min = ")?.split(' ').next()?.parse::<f64>().ok());
        // and home again
        let home_min = end_min + (temperature_c - 25.0).abs() / 2.0;
        assert!(home_min <= budget_min.expect("there") + 1e-6, "{home_min}: {table}");
    }
}

#[test]
fn what_cannot_be_designed_is_refused_with_what_to_do() {
    for (edit, status, says) in [
        (("budget_min = 360.0", "budget_min = 80.0"), 2, "give at least 82 min"),
        (("range_c = [-20.0, 60.0]", "range_c = [60.0, -20.0]"), 2, "range_c = [-20.0, 60.0]"),
        (("ramp_k_per_min = 2.0 ", "ramp_k_per_min = 0.0 "), 2, "above 0 K/min"),
        (("# spacing_c = 5.0 ", "spacing_c = 100.0 "), 2, "give a smaller spacing"),
        (("# criterion = \"I\"", "criterion = \"c\"\n# "), 2, "at_c = 25.0"),
        (("# at_c = 25.0 ", "at_c = 125.0 "), 2, "within range_c"),
    ] {
        bench(&[edit]).refuses("design campaign.toml -o plan", status, &[says]);
    }
    bench(&[]).refuses(
        "design campaign.toml --sweep duration=5,10 -o plan",
        2,
        &["--sweep is not for a campaign"],
    );
}

//! Tests of `compare` on calibrations from few holds.

use crate::bench::Bench;

#[test]
fn a_comparison_knows_how_few_holds_there_were() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[("poses = 24", "poses = 12")]);
    for k in ["1", "2"] {
        bench.run(&format!("simulate poses.toml --seed 5 --recording {k} -o made{k}")).done();
        bench.run(&format!("calibrate poses.toml made{k}/recording.csv --no-report -o found{k}")).done();
    }
    let state = |degrees: Option<&str>| {
        for k in ["1", "2"] {
            let mut file = bench.json(&format!("found{k}/calibration.json"));
            let fields = file.as_object_mut().expect("an object");
            assert!(fields["covariance_degrees_of_freedom"].get("gyroscope_matrix").is_some());
            match degrees {
                Some(text) => {
                    let degrees = serde_json::from_str(text).expect("JSON");
                    fields.insert("covariance_degrees_of_freedom".into(), degrees);
                }
                None => {
                    fields.remove("covariance_degrees_of_freedom");
                }
            }
            bench.write(&format!("{k}.json"), file.to_string());
        }
    };
    let compared = || bench.run("compare 1.json 2.json --json").done().json();
    state(Some(r#"{"accelerometer": 3}"#));
    let few = compared();
    let behind = few["overall"]["degrees_behind"].as_f64().expect("a number");
    assert!((3.0..=8.0).contains(&behind), "{behind}");
    let row = &few["quantities"][0];
    assert!(row["degrees_of_freedom"].as_f64().is_some() && row["difference_sd"].as_f64().is_some());
    let table = bench.run("compare 1.json 2.json").done().stdout;
    assert!(table.contains("the least known scatter has"), "{table}");
    state(None);
    let known = compared();
    assert!(known["overall"]["degrees_behind"].is_null());
    assert!(known["notes"].to_string().contains("B does not say the degrees of freedom behind its sd"));
    let p_values = |of: &serde_json::Value| -> Vec<f64> {
        let rows = of["quantities"].as_array().expect("rows").iter();
        rows.map(|row| row["p_value"].as_f64().expect("a number")).collect()
    };
    assert!(p_values(&known).iter().zip(p_values(&few)).all(|(known, few)| *known < few));
    assert_ne!(known["overall"]["p_value"], few["overall"]["p_value"]);
    state(Some(r#"{"accelerometer": -1}"#));
    bench.refuses("compare 1.json 2.json", 2, &["`covariance_degrees_of_freedom` has -1"]);
}

//! Tests of the remark on limits that count from rest.

use crate::bench::Bench;

#[test]
fn a_limit_that_counts_from_rest_is_told_where_rest_is_not_set() {
    let bench = Bench::new();
    let says = "so the motion starts at rest";
    for (name, velocity, displacement, rest, told) in [
        ("velocity", true, true, "", Some("the limit of velocity counts")),
        ("displacement", false, true, "", Some("the limit of displacement counts")),
        ("neither", false, false, "", None),
        ("none", true, true, "rest = \"none\"", Some("the limit of velocity counts")),
        ("start", true, true, "rest = \"start\"", None),
        ("both", true, true, "rest = \"both\"", None),
    ] {
        let key = |wanted: bool, key: &'static str| if wanted { key } else { "#" };
        bench.preset(
            "stage",
            &format!("{name}.toml"),
            &[
                ("velocity_mps =", key(velocity, "velocity_mps =")),
                ("displacement_m =", key(displacement, "displacement_m =")),
                ("rest = \"both\"", rest),
                ("intervals = 40", "intervals = 8"),
            ],
        );
        for command in [
            format!("design {name}.toml --no-certificate -o design"),
            format!("simulate {name}.toml -o made"),
        ] {
            let outcome = bench.run(&command).done();
            match told {
                Some(told) => outcome.says(told),
                None => assert!(!outcome.stderr.contains(says), "{outcome:?}"),
            }
        }
    }
}

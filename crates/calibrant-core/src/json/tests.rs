//! Objects, names and forms, and what their schemas say.

use super::{IfSome, flat, if_any, if_some, named, with_ending};
use crate::form::Form;
use schemars::schema_for;

struct Hold {
    end: usize,
    mean: f64,
    reason: Option<&'static str>,
    colour: Colour,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Colour {
    Red,
    Green,
}

impl Colour {
    const ALL: [Self; 2] = [Self::Red, Self::Green];

    fn name(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Green => "green",
        }
    }
}

crate::json_name!(Colour, Colour::ALL);

crate::json_object! {
    /// A hold.
    Hold as hold {
        /// Number of samples.
        samples: hold.end - 10,
        mean: with_ending("counts", hold.mean),
        reason: if_some(hold.reason),
        colour: hold.colour,
        largest: Form::<Option<f64>>::form(&f64::NAN),
    }
}

struct Outer(Hold);

crate::json_object! {
    Outer as outer {
        hold: flat(&outer.0),
        none: if_any(Vec::<f64>::new()),
        kinds: named([("angle", 1.5)]),
        name: IfSome(outer.0.reason),
    }
}

#[test]
fn an_object_is_written_as_it_is_listed() {
    let hold = |reason| Hold { end: 30, mean: 2.5, reason, colour: Colour::Green };
    let text = |value: &Outer| serde_json::to_string(value).expect("it is");
    assert_eq!(
        text(&Outer(hold(Some("knock")))),
        r#"{"samples":20,"mean_counts":2.5,"reason":"knock","colour":"green","largest":null,"angle":1.5,"name":"knock"}"#
    );
    assert_eq!(
        text(&Outer(hold(None))),
        r#"{"samples":20,"mean_counts":2.5,"colour":"green","largest":null,"angle":1.5}"#
    );
}

#[test]
fn the_schema_lists_the_same_keys() {
    let schema = schema_for!(Outer);
    let keys: Vec<&String> =
        schema.get("properties").and_then(|of| of.as_object()).expect("an object").keys().collect();
    let expected =
        ["samples", "mean_mps2", "mean_radps", "mean_counts", "reason", "colour", "largest", "none", "name"];
    assert_eq!(keys, expected);
    assert_eq!(schema.get("required"), Some(&serde_json::json!(["samples", "colour", "largest"])));
    assert_eq!(schema.pointer("/properties/samples/description"), Some(&"Number of samples.".into()));
    assert_eq!(schema.pointer("/properties/colour/enum"), Some(&serde_json::json!(["red", "green"])));
    assert!(schema.pointer("/additionalProperties").is_some());
    assert_eq!(schema_for!(Hold).get("description"), Some(&"A hold.".into()));
}

#[test]
fn an_unknown_name_is_an_error_that_lists_the_known_ones() {
    assert_eq!(serde_json::from_str::<Colour>("\"red\"").expect("known"), Colour::Red);
    let error = serde_json::from_str::<Colour>("\"blue\"").expect_err("unknown").to_string();
    assert!(error.starts_with("`blue` is none of `red`, `green`"), "{error}");
}

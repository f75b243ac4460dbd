//! The page of JSON files.

use calibrant::json_page;

#[test]
fn the_page_of_the_documentation_is_that_of_the_schemas() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/json.md");
    let page = std::fs::read_to_string(path).expect("read");
    let remedy = "cargo run -p calibrant --features programs --example json_page > docs/json.md";
    assert!(page == json_page(), "docs/json.md is not that of the types: {remedy}");
}

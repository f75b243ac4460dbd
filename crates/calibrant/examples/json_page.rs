//! Prints `docs/json.md`: `cargo run -p calibrant --features programs --example json_page > docs/json.md`.

use calibrant::json_page;

fn main() {
    print!("{}", json_page());
}

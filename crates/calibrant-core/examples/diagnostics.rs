//! Prints `docs/diagnostics.md`: `cargo run -p calibrant-core --example diagnostics > docs/diagnostics.md`.

use calibrant_core::diagnostic::table_as_markdown;

fn main() {
    print!("{}", table_as_markdown());
}

//! The program's name and version, by which every result says who wrote it.

/// The program's name and version, by which every result says who wrote it.
#[must_use]
pub fn program() -> String {
    format!("calibrant {}", env!("CARGO_PKG_VERSION"))
}

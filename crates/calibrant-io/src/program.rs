//! The program's name and version, by which every result says who wrote it.

pub(super) fn program() -> String {
    format!("calibrant {}", env!("CARGO_PKG_VERSION"))
}

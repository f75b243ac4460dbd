//! The command line of calibrant.
fn main() {}

//! Finding the best motion to record, and proving how good it is.

pub mod certificate;

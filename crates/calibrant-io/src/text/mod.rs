//! Text: decoded, split into fields, quoted in errors.

pub(crate) mod decoding;
pub(crate) mod delimited;
pub(crate) mod excerpt;
pub(crate) mod numbers;

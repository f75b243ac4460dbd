//! Text: decoded, split into fields, quoted in errors.

pub mod decoding;
pub mod delimited;
pub mod excerpt;
pub mod numbers;
pub mod similar_word;

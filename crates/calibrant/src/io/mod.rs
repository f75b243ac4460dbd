//! Files: the experiment, recordings and motions that come in, results that go out. The only code that touches files.

mod delimited;
mod output;
mod text;

pub use output::write_atomically;

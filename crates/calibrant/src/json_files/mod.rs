//! The JSON files that are written, and their page `docs/json.md`.

mod keys;
mod kinds;
mod page;

pub use kinds::FileKind;
pub use page::json_page;

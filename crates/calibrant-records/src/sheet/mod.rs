//! Records for people: what each question is answered with is one sheet.

mod cells;
mod drift;
mod fleet;
mod history;
mod list;
mod record;

pub use drift::drift_sheet;
pub use fleet::fleet_sheet;
pub use history::history_sheet;
pub use list::records_sheet;
pub use record::record_sheet;

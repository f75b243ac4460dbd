//! Diagnostics: what a user should know about a result, as values with a stable code.
//!
//! [`Code`] is the table of all codes. A [`Diagnostic`] has a code, a subject and numbers. Sentences are made of it in one place, `calibrant_report::message`.

mod change;
mod code;
mod direction;
mod faces;
mod hold_span;
mod known;
mod late_times;
mod limit_miss;
mod lost_holds;
mod markdown;
mod parts;
mod rotation_reason;
mod severity;
mod taken_out;
mod turn;
mod value;
mod verdict;

pub use change::{Change, Changed, Course};
pub use code::{Code, CodeEntry};
pub(crate) use direction::AGREES_RAD;
pub use faces::{FaceMismatch, FacePointing};
pub use hold_span::{HoldLeftOut, HoldSpan};
pub use known::KnownMismatch;
pub use late_times::{late, repair};
pub use limit_miss::LimitMiss;
pub use lost_holds::LostHolds;
pub use markdown::table_as_markdown;
pub use rotation_reason::RotationReason;
pub use severity::Severity;
pub use turn::{TurnMismatch, TurnSpan, UnitMistake};
pub use value::Diagnostic;
pub use verdict::{Usability, Verdict};

//! Diagnostics: what a user should know about a result, as values with a stable code.
//!
//! Each check has one entry: its code, how much it matters, what it means, how it is decided, what to do, what was found, and the sentence.
//! The entries of an area stand in one file. What a check found becomes a [`Diagnostic`].
//! `docs/diagnostics.md` is made of the entries.

mod check;

pub mod acceptance;
pub mod campaign;
pub mod change;
pub mod comparison;
pub mod convention;
pub mod correction;
pub mod datasheet;
pub mod design;
pub mod faces;
pub mod files;
pub mod fit;
pub mod gyroscope;
pub mod holds;
pub mod log;
pub mod machine;
pub mod motion;
pub mod noise;
pub mod reader;
pub mod samples;
pub mod settings;
pub mod simulation;
pub mod turns;
pub mod validation;

mod code;
mod direction;
mod hold_span;
mod late_times;
mod markdown;
mod numbers;
mod parts;
mod reader_fields;
mod rotation_reason;
mod severity;
mod table;
mod value;
mod verdict;

pub use acceptance::LimitMiss;
pub use change::{Change, Changed, Course};
pub use check::Check;
pub use code::{Code, CodeEntry};
pub(crate) use direction::{AGREES_RAD, direction_in_words};
pub use faces::{FaceMismatch, FacePointing};
pub use hold_span::{HoldReason, HoldSpan};
pub use late_times::{late, repair};
pub use markdown::table_as_markdown;
pub use parts::Phrase;
pub use rotation_reason::RotationReason;
pub use severity::Severity;
pub use turns::{TurnMismatch, TurnSpan, UnitMistake};
pub use value::Diagnostic;
pub use verdict::{Usability, Verdict};

//! What was told of a recording, as it is kept beside its result.

use calibrant_core::diagnostic::Code;
use calibrant_core::json_name;
use serde::{Deserialize, Serialize};

/// A sentence on a recording or its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Who says it.
    pub kind: ToldKind,
    /// Its code, where it has one.
    pub code: Option<Code>,
    /// The file in which a reader found it; empty for all else.
    pub file: String,
    /// The sentence.
    pub words: String,
}

/// Who says a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToldKind {
    /// A diagnostic of the calibration.
    Diagnostic,
    /// A finding of the reader of the recording.
    Finding,
    /// A warning of the session.
    Warning,
    /// A remark of the session.
    Remark,
}

impl ToldKind {
    /// All kinds.
    const ALL: [Self; 4] = [Self::Diagnostic, Self::Finding, Self::Warning, Self::Remark];

    /// As files state it.
    fn name(self) -> &'static str {
        match self {
            Self::Diagnostic => "diagnostic",
            Self::Finding => "finding",
            Self::Warning => "warning",
            Self::Remark => "remark",
        }
    }
}

json_name!(ToldKind, ToldKind::ALL);

//! What a session notices on its way.

use super::source::Source;
use calibrant_io::Finding;
use std::fmt;

/// Something that was noticed and that stops nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// A reader noticed it in a recording.
    Finding {
        /// Name of the file.
        file: String,
        /// What it is.
        finding: Finding,
    },
    /// The user should know it.
    Remark(String),
    /// The result may not be what the user expects.
    Warning(String),
}

impl Note {
    /// Does something become doubtful?
    #[must_use]
    pub fn is_warning(&self) -> bool {
        match self {
            Self::Finding { finding, .. } => finding.is_warning(),
            Self::Remark(_) => false,
            Self::Warning(_) => true,
        }
    }

    /// The findings of a recording, each with the name of its file.
    pub(crate) fn of_findings(findings: &[Finding], source: &Source) -> Vec<Self> {
        let note = |finding: &Finding| Self::Finding {
            file: source.name(finding.in_second_file),
            finding: finding.clone(),
        };
        findings.iter().map(note).collect()
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finding { file, finding } => write!(f, "{file}: {finding}"),
            Self::Remark(words) | Self::Warning(words) => f.write_str(words),
        }
    }
}

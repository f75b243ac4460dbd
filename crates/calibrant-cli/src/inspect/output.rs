//! What `inspect` prints and writes.

use crate::console;
use calibrant::io::write_text;
use calibrant::report::Sheet;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(super) struct Output {
    /// Also write a page: the same, and the readings over time with what is at rest, and why some of it is no hold.
    #[arg(long, value_name = "HTML")]
    pub(super) report: Option<PathBuf>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

impl Output {
    /// Prints what was found, and writes its page.
    pub(super) fn show(&self, json: impl FnOnce() -> String, sheet: &Sheet<'_>) -> calibrant::Result<()> {
        self.report.as_ref().map_or(Ok(()), |path| write_text(path, &sheet.html()))?;
        let pages: Vec<PathBuf> = self.report.iter().cloned().collect();
        console::result(self.json, json, sheet, None, &pages)
    }
}

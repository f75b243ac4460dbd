//! A table as CSV.

use super::columns::{ColumnValues, Table};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes the header, then the rows.
pub(super) fn write(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    let mut out = csv::Writer::from_writer(out);
    out.write_record(table.columns.iter().map(|column| column.name.as_bytes()))?;
    let rows = table.columns.first().map_or(0, |column| column.values.len());
    let mut text = String::new();
    for row in 0..rows {
        for column in &table.columns {
            text.clear();
            match &column.values {
                ColumnValues::Whole(numbers) => write!(text, "{}", numbers[row]),
                ColumnValues::Numbers(numbers) if numbers[row].is_nan() => Ok(()),
                ColumnValues::Numbers(numbers) => write!(text, "{:?}", numbers[row]),
                ColumnValues::Texts(texts) => {
                    text.write_str(&spreadsheet_text(texts[row].as_deref().unwrap_or_default()))
                }
            }
            .map_err(io::Error::other)?;
            out.write_field(&text)?;
        }
        out.write_record(None::<&[u8]>)?;
    }
    out.flush()
}

/// A text that a spreadsheet takes for a text: one that begins like a formula gets an apostrophe before it.
#[must_use]
pub fn spreadsheet_text(text: &str) -> String {
    let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if formula { format!("'{text}") } else { text.to_owned() }
}

//! The table of several recordings: the verdicts are counted, and the worst stand first.

use crate::console;
use calibrant::diagnostic::{Usability, Verdict};

/// The most rows that are printed. All are in `summary.csv`.
const MOST_ROWS: usize = 20;

/// A recording in the table.
pub(super) struct Row {
    /// `None`: there is no result.
    usability: Option<Usability>,
    cells: Vec<String>,
}

impl Row {
    /// A recording with its result.
    pub(super) fn of_result(recording: &str, verdict: &Verdict, quality: Vec<String>) -> Self {
        let mut cells = vec![recording.to_owned(), verdict.usability.name().to_owned()];
        cells.extend(quality);
        cells.push(match verdict.codes.as_slice() {
            [] => "–".to_owned(),
            [first] => first.name().to_owned(),
            [first, others @ ..] => format!("{}, {} more", first.name(), others.len()),
        });
        Self { usability: Some(verdict.usability), cells }
    }

    /// A recording without a result, which has as many columns of quality.
    pub(super) fn of_failure(recording: &str, code: &str, quality: usize) -> Self {
        let mut cells = vec![recording.to_owned(), "FAILED".to_owned()];
        cells.resize(2 + quality, "–".to_owned());
        cells.push(code.to_owned());
        Self { usability: None, cells }
    }

    /// The worst is the largest.
    fn badness(&self) -> u8 {
        match self.usability {
            None => 3,
            Some(Usability::Bad) => 2,
            Some(Usability::Doubtful) => 1,
            Some(Usability::Ok) => 0,
        }
    }
}

/// The count of each verdict, then the table of the worst.
pub(super) fn table_of(mut rows: Vec<Row>, columns: &[&str]) -> String {
    let count = |badness: u8| rows.iter().filter(|row| row.badness() == badness).count();
    let counts = format!(
        "verdicts: {} failed, {} bad, {} doubtful, {} ok\n\n",
        count(3),
        count(2),
        count(1),
        count(0)
    );
    rows.sort_by_key(|row| std::cmp::Reverse(row.badness()));
    let further = rows.len().saturating_sub(MOST_ROWS);
    let header = [&["recording", "verdict"], columns, &["decided by"]].concat();
    let shown: Vec<Vec<String>> = rows.into_iter().take(MOST_ROWS).map(|row| row.cells).collect();
    let rest = if further > 0 { format!("  … and {further} more\n") } else { String::new() };
    counts + &console::table(&header, &shown) + &rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant::diagnostic::datasheet::{GainImplausible, ScaleNegative};
    use calibrant::diagnostic::samples::CoarseSteps;
    use calibrant::diagnostic::{Check, Code};

    #[test]
    fn failures_stand_first_and_twenty_rows_are_shown() {
        let row = |k: usize| {
            let codes: &[Code] = match k {
                3 => &[ScaleNegative::CODE, GainImplausible::CODE],
                5 => &[CoarseSteps::CODE],
                _ => &[],
            };
            Row::of_result(&format!("s{k}"), &Verdict::on(codes.iter().copied(), &[]), vec!["0.5".into()])
        };
        let mut rows: Vec<Row> = (0..24).map(row).collect();
        rows.push(Row::of_failure("s24", "file-empty", 1));
        let text = table_of(rows, &["p-value"]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "verdicts: 1 failed, 1 bad, 1 doubtful, 22 ok");
        let starts = ["  s24 ", "  s3 ", "  s5 ", "  s0 ", "  s1 "];
        lines[4..].iter().zip(starts).for_each(|(line, start)| assert!(line.starts_with(start), "{text}"));
        assert!(lines[5].ends_with("scale-negative, 1 more"), "{text}");
        assert_eq!(lines.len(), 4 + 20 + 1, "{text}");
        assert_eq!(lines[24], "  … and 5 more");
    }
}

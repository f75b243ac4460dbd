//! An error at its place in a file: the line and those around it, what is wrong there underlined, and the remedy.

use std::ops::Range;
use textwrap::core::display_width;
use textwrap::{Options, wrap};

/// Columns from one tab stop to the next.
const TAB: usize = 4;
/// Style of a terminal: red, for the error.
const ERROR: &str = "31";
/// Bold cyan, underlined, for the place.
const PLACE: &str = "1;4;36";
/// Bold magenta, for what is below the line at fault.
const UNDERLINE: &str = "1;35";
/// Cyan, for the remedy.
const REMEDY: &str = "36";
/// Faint, for numbers of lines.
const FAINT: &str = "2";

/// An error and its place.
pub(super) struct Excerpt<'e> {
    pub(super) code: &'e str,
    pub(super) message: &'e str,
    /// File, line and column.
    pub(super) place: &'e str,
    pub(super) text: &'e str,
    /// The bytes at fault. What lies beyond the first line is not underlined.
    pub(super) range: Range<usize>,
    pub(super) help: &'e str,
}

impl Excerpt<'_> {
    /// Its lines, of which the words fit the width.
    pub(super) fn shown(&self, width: usize, in_colour: bool) -> String {
        let paint = |style: &str, text: &str| match in_colour {
            true => format!("\u{1b}[{style}m{text}\u{1b}[0m"),
            false => text.to_owned(),
        };
        let filled = |text: &str, first: &str, further: &str| {
            let options = Options::new(width.saturating_sub(2));
            wrap(text, options.initial_indent(first).subsequent_indent(further)).join("\n")
        };
        let [cross, bar] = ["×", "│"].map(|sign| format!("  {} ", paint(ERROR, sign)));
        let mut shown = format!("{}\n\n{}\n", paint(ERROR, self.code), filled(self.message, &cross, &bar));
        let lines = self.lines();
        let digits = lines.last().map_or(1, |(number, _)| number.to_string().len());
        let margin = " ".repeat(digits + 2);
        shown += &format!("{margin}╭─[{}]\n", paint(PLACE, self.place));
        for (number, line) in &lines {
            let number_shown = paint(FAINT, &format!("{number:>digits$}"));
            shown += &format!(" {number_shown} │ {}\n", spread(line));
            if *number == self.line() {
                let (before, length) = self.columns();
                let (left, right) = (length / 2, length - length / 2 - 1);
                let mark = if self.range.is_empty() { "▲" } else { "┬" };
                let below = format!("{}{mark}{}", "─".repeat(left), "─".repeat(right));
                for (indent, sign) in [(before, below.as_str()), (before + left, "╰── here")] {
                    shown += &format!("{margin}· {}{}\n", " ".repeat(indent), paint(UNDERLINE, sign));
                }
            }
        }
        shown += &format!("{margin}╰────\n");
        if !self.help.is_empty() {
            let first = paint(REMEDY, "  help: ");
            shown += &(filled(self.help, &first, "        ") + "\n");
        }
        shown
    }

    /// The number of the line at fault.
    fn line(&self) -> usize {
        1 + self.text[..self.range.start].matches('\n').count()
    }

    /// The line at fault and those around it, with their numbers.
    fn lines(&self) -> Vec<(usize, &str)> {
        let line = self.line();
        let mut lines: Vec<&str> = self.text.split('\n').collect();
        // after the last end of a line there is none, nor is one in an empty file
        if (lines.len() > line || self.text.is_empty()) && lines.last().is_some_and(|last| last.is_empty()) {
            lines.pop();
        }
        let around = line.saturating_sub(1).max(1)..=line + 1;
        (1..).zip(lines).filter(|(number, _)| around.contains(number)).collect()
    }

    /// The columns before what is at fault, and how many it takes.
    fn columns(&self) -> (usize, usize) {
        let Range { start, end } = self.range;
        let of_line = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |at| start + at);
        let column = |at: usize| display_width(&spread(&self.text[of_line..at]));
        (column(start), (column(end.min(line_end)) - column(start)).max(1))
    }
}

/// A line with spaces in place of tabs.
fn spread(line: &str) -> String {
    let mut spread = String::with_capacity(line.len());
    for part in line.split_inclusive('\t') {
        spread.push_str(part.trim_end_matches('\t'));
        if part.ends_with('\t') {
            spread.push_str(&" ".repeat(TAB - display_width(&spread) % TAB));
        }
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, range: Range<usize>) -> String {
        let excerpt = Excerpt { code: "code", message: "what", place: "f:1:1", text, range, help: "" };
        excerpt.shown(80, false)
    }

    #[test]
    fn what_is_wrong_is_underlined_below_tabs_and_wide_signs() {
        assert_eq!(
            shown("one\n\t度 = x\nthree\nfour\n", 11..12),
            "code\n\n  × what\n   ╭─[f:1:1]\n 1 │ one\n 2 │     度 = x\n   ·          ┬\n   ·          ╰── here\n 3 │ three\n   ╰────\n"
        );
    }

    #[test]
    fn places_at_the_ends_of_a_text_have_a_mark() {
        assert_eq!(shown("", 0..0), "code\n\n  × what\n   ╭─[f:1:1]\n   ╰────\n");
        assert!(shown("a\n", 2..2).contains("\n 1 │ a\n 2 │ \n   · ▲\n"));
        assert!(shown("a\n", 0..1).ends_with("1 │ a\n   · ┬\n   · ╰── here\n   ╰────\n"));
        assert!(shown("a = [\n1]\n", 4..8).contains("\n 1 │ a = [\n   ·     ┬\n"), "to the end of its line");
    }

    #[test]
    fn long_words_of_an_error_are_wrapped() {
        let excerpt = Excerpt {
            code: "c",
            message: "one two three",
            place: "f",
            text: "a",
            range: 0..1,
            help: "four five six",
        };
        let shown = excerpt.shown(15, false);
        assert!(shown.contains("  × one two\n  │ three\n"), "{shown}");
        assert!(shown.ends_with("  help: four\n        five\n        six\n"), "{shown}");
    }
}

//! The same in a terminal of 80 columns: a line for each change of state, and a table after each hold.

use crate::shown::{Kind, Told, shown_unit};
use calibrant_core::number_format::significant;
use std::io::Write;

/// Prints, or does not.
pub(crate) struct Terminal {
    prints: bool,
    phase: &'static str,
    printed_s: f64,
}

impl Terminal {
    pub(crate) fn new(prints: bool) -> Self {
        Self { prints, phase: "", printed_s: f64::NEG_INFINITY }
    }

    /// A change of state. Reasons change often: the first is printed.
    pub(crate) fn state(&mut self, phase: &'static str, word: &str, reason: &str, at_s: f64) {
        if !self.prints || phase == self.phase {
            return;
        }
        self.phase = phase;
        // settling and moving alternate while one looks for a pose
        if matches!(phase, "settling" | "moving") && at_s - self.printed_s < 1.0 {
            return;
        }
        self.printed_s = at_s;
        let text = if reason.is_empty() { word.to_owned() } else { format!("{word}: {reason}") };
        line(at_s, &text);
    }

    pub(crate) fn message(&self, at_s: f64, kind: Kind, text: &str) {
        if self.prints {
            let sign = match kind {
                Kind::Good => "✓",
                Kind::Info => "·",
                Kind::Warning => "!",
                Kind::Error => "✗",
            };
            line(at_s, &format!("{sign} {text}"));
        }
    }

    /// The parameters farthest from their goals, and the sentence.
    pub(crate) fn table(&self, told: &Told) {
        if !self.prints {
            return;
        }
        let estimate = &told.estimate;
        let mut rows: Vec<_> = estimate.parameters.iter().filter_map(|of| Some((of, of.ratio()?))).collect();
        rows.sort_by(|one, other| other.1.total_cmp(&one.1));
        if !rows.is_empty() {
            print(&format!(
                "          {:<26}{:>10}{:>10}{:>10}  unit",
                "farthest from its goal", "sd", "goal", "after"
            ));
        }
        for (of, ratio) in rows.iter().take(4) {
            let (unit, factor) = shown_unit(of.unit);
            let two = |value: f64| significant(factor * value, 2);
            let sign = if *ratio <= 1.0 { "✓" } else { " " };
            let after = of.after.map_or_else(|| "–".to_owned(), two);
            let goal = of.goal.map_or_else(|| "–".to_owned(), two);
            print(&format!(
                "        {sign} {:<26}{:>10}{:>10}{:>10}  {unit}",
                of.name,
                two(of.sd),
                goal,
                after
            ));
        }
        line_without_time(&told.sentence);
        if let Some((_, words, turn)) = told.next_in_words() {
            let turn = if turn.is_empty() { turn } else { format!("; {turn}") };
            line_without_time(&format!("next: {words}{turn}"));
        }
    }
}

/// Width of a terminal, and of what stands before a text.
const WIDTH: usize = 80;
const BEFORE: usize = 10;

fn line(at_s: f64, text: &str) {
    let before = format!("{at_s:>7.1} s ");
    wrapped(&before, text);
}

fn line_without_time(text: &str) {
    wrapped(&" ".repeat(BEFORE), text);
}

fn wrapped(before: &str, text: &str) {
    let behind = " ".repeat(BEFORE);
    let options = textwrap::Options::new(WIDTH).initial_indent(before).subsequent_indent(&behind);
    textwrap::wrap(text, options.break_words(false)).iter().for_each(|line| print(line));
}

/// Prints a line. A terminal that is gone ends no session, and what a board says controls none.
fn print(line: &str) {
    let line: String = line.chars().filter(|c| !c.is_control()).collect();
    let _ = writeln!(std::io::stdout(), "{line}");
}

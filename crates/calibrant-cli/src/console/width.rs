//! Lines that fit the width of the terminal. What goes to a file or another program keeps its lines.

use std::sync::OnceLock;
use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

/// Narrower terminals are taken to be this wide.
const LEAST: usize = 40;

/// The width of the terminal on stdout; `None` where stdout is none.
pub(super) fn of_terminal() -> Option<usize> {
    static WIDTH: OnceLock<Option<usize>> = OnceLock::new();
    let measured = || terminal_size::terminal_size_of(std::io::stdout()).map(|(width, _)| width.0.into());
    WIDTH.get_or_init(measured).map(|width: usize| width.max(LEAST))
}

/// Longest line of a paragraph, on any terminal.
const MOST: usize = 102;

/// A paragraph, two characters from the margin.
pub(crate) fn paragraph(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    filled(&words, of_terminal().map_or(MOST, |width| width.min(MOST)), "  ", "  ") + "\n"
}

/// Breaks lines that are longer than this, between words. They continue two characters further in.
pub(super) fn wrapped(text: &str, width: usize) -> String {
    let broken = |line: &str| {
        if line.chars().count() <= width {
            return line.to_owned();
        }
        let margin = &line[..line.len() - line.trim_start().len()];
        filled(line.trim_start(), width, margin, &format!("{margin}  "))
    };
    text.split('\n').map(broken).collect::<Vec<_>>().join("\n")
}

/// Lines of at most this many characters: as many words as fit into each.
fn filled(text: &str, width: usize, margin: &str, further: &str) -> String {
    let options = Options::new(width).initial_indent(margin).subsequent_indent(further).break_words(false);
    let options =
        options.word_separator(WordSeparator::AsciiSpace).word_splitter(WordSplitter::NoHyphenation);
    textwrap::wrap(text, options.wrap_algorithm(WrapAlgorithm::FirstFit)).join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_break_between_words_and_keep_their_margin() {
        assert_eq!(wrapped("  one two three\nshort\n", 9), "  one two\n    three\nshort\n");
        assert_eq!(wrapped("no-place-to-break", 9), "no-place-to-break");
    }
}

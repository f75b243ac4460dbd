//! Lines that fit a width, broken between words.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

/// Before everything below a heading.
pub(super) const MARGIN: &str = "  ";
/// Longest line of a paragraph: longer ones are hard to read.
const MOST: usize = 102;

/// A paragraph, two characters from the margin.
#[must_use]
pub fn paragraph(text: &str, width: usize) -> String {
    filled(&in_one_line(text), width.min(MOST), MARGIN, MARGIN) + "\n"
}

/// A line, two characters from the margin. It continues two characters further in.
pub(super) fn hanging(text: &str, width: usize) -> String {
    filled(&in_one_line(text), width.min(MOST), MARGIN, "    ") + "\n"
}

/// Labels with their values below each other.
pub(super) fn facts(facts: &[(String, String)], width: usize) -> String {
    let label = facts.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0).min(width / 3);
    let line = |(name, value): &(String, String)| {
        let pad = " ".repeat(label.saturating_sub(name.chars().count()));
        let (first, further) = (format!("{MARGIN}{name}{pad}   "), " ".repeat(MARGIN.len() + label + 3));
        filled(&in_one_line(value), width, &first, &further) + "\n"
    };
    facts.iter().map(line).collect()
}

/// Breaks lines that are longer than this, between words. They continue two characters further in.
#[must_use]
pub fn wrapped(text: &str, width: usize) -> String {
    let broken = |line: &str| {
        if line.chars().count() <= width {
            return line.to_owned();
        }
        let margin = &line[..line.len() - line.trim_start().len()];
        filled(line.trim_start(), width, margin, &format!("{margin}  "))
    };
    text.split('\n').map(broken).collect::<Vec<_>>().join("\n")
}

/// The lines of a cell that has this much room. Words that are wider are broken. A name in it begins no line.
pub(super) fn cell(text: &str, width: usize) -> Vec<String> {
    let text = &text.replace(['\n', '\t'], " ");
    if text.chars().count() <= width {
        return vec![text.to_owned()];
    }
    let lines = textwrap::wrap(text.as_str(), options(width, "", "").break_words(true));
    lines.into_iter().map(std::borrow::Cow::into_owned).collect()
}

fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Lines of at most this many characters: as many words as fit into each.
fn filled(text: &str, width: usize, margin: &str, further: &str) -> String {
    textwrap::wrap(text, options(width, margin, further)).join("\n")
}

fn options<'a>(width: usize, margin: &'a str, further: &'a str) -> Options<'a> {
    let options = Options::new(width).initial_indent(margin).subsequent_indent(further).break_words(false);
    let options =
        options.word_separator(WordSeparator::AsciiSpace).word_splitter(WordSplitter::NoHyphenation);
    options.wrap_algorithm(WrapAlgorithm::FirstFit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_break_between_words_and_keep_their_margin() {
        assert_eq!(wrapped("  one two three\nshort\n", 9), "  one two\n    three\nshort\n");
        assert_eq!(wrapped("no-place-to-break", 9), "no-place-to-break");
    }

    #[test]
    fn values_stand_below_each_other() {
        let all = [("a", "one two three"), ("label", "two")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        assert_eq!(facts(&all, 18), "  a       one two\n          three\n  label   two\n");
    }
}

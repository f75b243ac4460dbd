//! Texts for the terminal: a name of a file must neither command it, nor hide or turn what stands beside it, nor begin a line of its own.

/// A text of several lines, with tabs. Signs that do harm are escaped as in JSON, so JSON stays what it says.
pub(crate) fn harmless(text: &str) -> String {
    escaped(text, |sign| !matches!(sign, '\n' | '\t') && does_harm(sign))
}

/// A message or a name, in one line.
pub(crate) fn in_one_line(text: &str) -> String {
    escaped(text, does_harm)
}

/// A part of a file, as long as it is: so a place in it stays where it is.
pub(super) fn excerpt(text: &str) -> String {
    let shown = |sign: char| match sign {
        '\n' | '\t' => sign.to_string(),
        '\r' => " ".to_owned(),
        sign if does_harm(sign) => "?".repeat(sign.len_utf8()),
        sign => sign.to_string(),
    };
    text.chars().map(shown).collect()
}

fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> String {
    let shown = |sign: char| match is_escaped(sign) {
        true => sign.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect(),
        false => sign.to_string(),
    };
    text.chars().map(shown).collect()
}

/// Is it a sign that controls the terminal, or one of Unicode that is invisible or changes the direction of writing?
fn does_harm(sign: char) -> bool {
    sign.is_control()
        || matches!(sign, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_harm_is_escaped_and_stays_json() {
        assert_eq!(
            in_one_line("a\nerror: b\t\u{202e}\u{7f}ä−\u{e0041}"),
            "a\\u000aerror: b\\u0009\\u202e\\u007fä−\\udb40\\udc41"
        );
        assert_eq!(harmless("a\n\tb\u{1b}[2J"), "a\n\tb\\u001b[2J");
        assert_eq!(excerpt("a\n\tb\r\u{202e}."), "a\n\tb ???.");
    }
}

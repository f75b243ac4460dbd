//! The XML of URDF and SRDF files.

use super::element::Element;
use calibrant_core::error::{InputError, Refusal};
use calibrant_recording::text::decoding::{Checked, as_text, refuse, too_large};
use calibrant_recording::text::excerpt::error_at;
use calibrant_recording::text::similar_word::shorten;
use roxmltree::{Document, ParsingOptions};

/// Largest file, bytes.
pub(super) const LARGEST_BYTES: u64 = 16 << 20;
/// Largest number of elements, attributes and texts.
const MOST_NODES: u32 = 1 << 20;
/// Largest number of attributes of an element: XML compares each with all others.
const MOST_ATTRIBUTES: usize = 1000;

/// Parses such a file and gives its text, too. `what` names it in errors.
pub(super) fn parse<'a>(bytes: &'a [u8], what: &str) -> Checked<(&'a str, Document<'a>)> {
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(too_large(&format!("a {what} file"), LARGEST_BYTES).into());
    }
    let text = as_text(bytes)?;
    // no attribute has this sign in its value
    let attributes = |element: &str| element.bytes().filter(|byte| *byte == b'=').count();
    if text.split('<').any(|element| !element.starts_with('!') && attributes(element) > MOST_ATTRIBUTES) {
        let message = format!("an element has more than {MOST_ATTRIBUTES} attributes");
        return refuse(Refusal::FileUnreadable, message, "this is hardly the file that you mean");
    }
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| syntax(text, what, &error))?;
    Ok((text, document))
}

/// The `<robot>` of a file. Other files of robots are named.
pub(super) fn robot<'a>(document: &'a Document<'a>, what: &str) -> Checked<Element<'a>> {
    let root = Element(document.root_element());
    let name = root.0.tag_name().name();
    if name != "robot" {
        let made_from = "convert it, or take the file that it was made from".to_owned();
        let (message, help) = match name {
            "sdf" => (format!("this is an SDF file, not {what}"), made_from),
            "mujoco" => (format!("this is a MuJoCo model, not {what}"), made_from),
            _ => (
                format!("this is no {what} file: its first element is not <robot>"),
                format!("give the {what} of the machine"),
            ),
        };
        return Err(root.error(Refusal::FormatUnknown, message, help));
    }
    let of_xacro =
        |node: &roxmltree::Node| node.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
    if let Some(node) = document.descendants().find(of_xacro) {
        return Err(Element(node).error(
            Refusal::FormatUnsupported,
            format!("this is a xacro file, not {what}"),
            XACRO_HELP,
        ));
    }
    Ok(root)
}

const XACRO_HELP: &str = "expand it first: `xacro FILE > machine.urdf`";

fn syntax(text: &str, what: &str, error: &roxmltree::Error) -> Box<InputError> {
    let (code, message, help) = match error {
        roxmltree::Error::UnknownNamespace(prefix, _) if prefix == "xacro" => {
            (Refusal::FormatUnsupported, format!("this is a xacro file, not {what}"), XACRO_HELP)
        }
        roxmltree::Error::NodesLimitReached => {
            let message = format!("the file has more than {MOST_NODES} elements");
            (Refusal::FileUnreadable, message, "this is hardly the file that you mean")
        }
        roxmltree::Error::DtdDetected => (
            Refusal::FormatUnsupported,
            "the file declares a document type (DTD)".to_owned(),
            "remove <!DOCTYPE …>",
        ),
        _ => {
            let words = error.to_string();
            // the place is said before the message
            let words = words.split(" at ").next().unwrap_or(&words);
            (Refusal::SyntaxInvalid, format!("not valid XML: {}", shorten(words)), "correct it at this place")
        }
    };
    use roxmltree::Error::{UnclosedRootNode, UnexpectedEndOfStream};
    let at = match error {
        // they know no place
        UnclosedRootNode | UnexpectedEndOfStream => text.trim_end().len(),
        _ => {
            let position = error.pos();
            let before = |count: u32| count.saturating_sub(1) as usize;
            let line: usize = text.split_inclusive('\n').take(before(position.row)).map(str::len).sum();
            line + text[line..].chars().take(before(position.col)).map(char::len_utf8).sum::<usize>()
        }
    };
    error_at(text, at..at + 1, InputError::new(code, message, help)).into()
}

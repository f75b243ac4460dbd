//! An element of an XML file, and errors that name it.

use calibrant_core::error::{InputError, Refusal};
use calibrant_recording::text::decoding::Checked;
use calibrant_recording::text::excerpt::error_at;
use calibrant_recording::text::similar_word::shorten;
use roxmltree::Node;
use std::ops::Range;

/// Largest length and angle that is believed, m or rad.
const LARGEST: f64 = 1000.0;

/// Where an element stands, and its name in messages: `joint elbow > axis`.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub name: String,
    pub span: Range<usize>,
}

impl Place {
    /// An error about this element.
    pub(super) fn error(
        &self,
        text: &str,
        code: Refusal,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Box<InputError> {
        let error = InputError::new(code, message, help).about_key(self.name.clone());
        Box::new(error_at(text, self.span.clone(), error))
    }
}

/// An element of the file.
#[derive(Clone, Copy)]
pub(super) struct Element<'a>(pub Node<'a, 'a>);

impl<'a> Element<'a> {
    /// The elements in it of this kind.
    pub(super) fn children(self, kind: &'static str) -> impl Iterator<Item = Element<'a>> {
        self.0.children().filter(move |node| node.has_tag_name(kind)).map(Element)
    }

    /// The one element in it of this kind, where there is one.
    pub(super) fn child(self, kind: &'static str) -> Checked<Option<Element<'a>>> {
        let mut all = self.children(kind);
        let first = all.next();
        match all.next() {
            Some(second) => Err(second.error(
                Refusal::KeyRepeated,
                format!("<{kind}> is there twice"),
                "keep one of them",
            )),
            None => Ok(first),
        }
    }

    /// The one element in it of this kind.
    pub(super) fn need_child(self, kind: &'static str) -> Checked<Element<'a>> {
        self.child(kind)?.ok_or_else(|| {
            self.error(Refusal::KeyMissing, format!("<{kind}> is missing"), format!("add <{kind} …/>"))
        })
    }

    /// The text of an attribute, where there is one.
    pub(super) fn attribute(self, key: &str) -> Option<&'a str> {
        self.0.attribute(key).map(str::trim)
    }

    /// The text of an attribute that must be there, and not empty.
    pub(super) fn need(self, key: &str) -> Checked<&'a str> {
        self.attribute(key).filter(|text| !text.is_empty()).ok_or_else(|| {
            let tag = self.0.tag_name().name();
            let help = format!("write <{tag} {key}=\"…\">");
            self.error(Refusal::KeyMissing, format!("the attribute `{key}` is missing"), help)
        })
    }

    /// The number in an attribute, where there is one.
    pub(super) fn number(self, key: &str) -> Checked<Option<f64>> {
        self.attribute(key).map(|text| self.parsed(key, text)).transpose()
    }

    /// The numbers in an attribute, where there is one.
    pub(super) fn numbers<const N: usize>(self, key: &str) -> Checked<Option<[f64; N]>> {
        let Some(text) = self.attribute(key) else { return Ok(None) };
        let mut numbers = [0.0; N];
        let words = text.split_whitespace().count();
        if words != N {
            return Err(self.error(
                Refusal::ValueInvalid,
                format!("`{key}` has {words} numbers, not {N}: \"{}\"", shorten(text)),
                "write them with spaces in between, and a point before the decimals",
            ));
        }
        for (number, word) in numbers.iter_mut().zip(text.split_whitespace()) {
            *number = self.parsed(key, word)?;
            if number.abs() > LARGEST {
                return Err(self.error(
                    Refusal::ValueOutOfRange,
                    format!("`{key}` is larger than {LARGEST}: {word}"),
                    "lengths are in m, angles in rad",
                ));
            }
        }
        Ok(Some(numbers))
    }

    fn parsed(self, key: &str, word: &str) -> Checked<f64> {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(self.error(
                Refusal::ValueOutOfRange,
                format!("`{key}` is not finite: {}", shorten(word)),
                "write a number",
            )),
            Err(_) => Err(self.error(
                Refusal::NumberMalformed,
                format!("`{key}` is not a number: \"{}\"", shorten(word)),
                "write it with a point before the decimals, and without a unit",
            )),
        }
    }

    /// Where it stands: its first tag.
    pub(super) fn place(self) -> Place {
        let range = self.0.range();
        let text = &self.0.document().input_text()[range.clone()];
        let tag = text.find(['>', '\n']).map_or(text.len(), |end| end + 1);
        Place { name: self.name(), span: range.start..range.start + text[..tag].trim_end().len() }
    }

    /// An error about this element.
    pub(super) fn error(
        self,
        code: Refusal,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Box<InputError> {
        self.place().error(self.0.document().input_text(), code, message, help)
    }

    /// Kind and name, after those of the elements that it stands in.
    fn name(self) -> String {
        let one = |node: Node| match node.attribute("name") {
            Some(name) => format!("{} {}", shorten(node.tag_name().name()), shorten(name)),
            None => shorten(node.tag_name().name()),
        };
        let outer =
            self.0.ancestors().skip(1).find(|node| node.has_tag_name("joint") || node.has_tag_name("link"));
        match outer {
            Some(outer) => format!("{} > {}", one(outer), one(self.0)),
            None => one(self.0),
        }
    }
}

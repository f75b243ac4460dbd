//! SRDF files: pairs of links that MoveIt does not check against each other.

use super::element::Element;
use super::xml;
use calibrant_core::error::{Error, Result};
use calibrant_recording::text::decoding::{Checked, parsed};
use std::path::Path;

/// Reads the pairs of `<disable_collisions>`.
///
/// # Errors
/// [`Error::Experiment`] with line and element: the text is no XML or has no `<robot>`, or a pair lacks one of its links.
pub fn read_srdf(path: &Path) -> Result<Vec<[String; 2]>> {
    read_named_srdf(path).map(|(_, pairs)| pairs)
}

/// The name of its robot, and the pairs.
pub(crate) fn read_named_srdf(path: &Path) -> Result<(String, Vec<[String; 2]>)> {
    parsed(path, (xml::LARGEST_BYTES, "an SRDF file"), named_pairs)
}

/// Reads the text of an SRDF file.
///
/// # Errors
/// As [`read_srdf`].
///
/// # Examples
/// ```
/// let text = r#"<robot name="arm"><disable_collisions link1="base" link2="shoulder" reason="Adjacent"/></robot>"#;
/// assert_eq!(calibrant_io::parse_srdf(text.as_bytes())?, [["base", "shoulder"]]);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_srdf(bytes: &[u8]) -> Result<Vec<[String; 2]>> {
    named_pairs(bytes).map(|(_, pairs)| pairs).map_err(Error::Experiment)
}

fn named_pairs(bytes: &[u8]) -> Checked<(String, Vec<[String; 2]>)> {
    let (_, document) = xml::parse(bytes, "SRDF")?;
    let robot = xml::robot(&document, "SRDF")?;
    let pair = |of: Element| Ok([of.need("link1")?.to_owned(), of.need("link2")?.to_owned()]);
    let pairs = robot.children("disable_collisions").map(pair).collect::<Checked<_>>()?;
    Ok((robot.attribute("name").unwrap_or_default().to_owned(), pairs))
}

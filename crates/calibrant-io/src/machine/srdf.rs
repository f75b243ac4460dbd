//! SRDF files: pairs of links that MoveIt does not check against each other.

use super::xml;
use crate::text::decoding::{Checked, parsed};
use calibrant_core::error::{Error, Result};
use std::path::Path;

/// Reads the pairs of `<disable_collisions>`.
///
/// # Errors
/// [`Error::Experiment`] with line and element: the text is no XML or has no `<robot>`, or a pair lacks one of its links.
pub fn read_srdf(path: &Path) -> Result<Vec<[String; 2]>> {
    parsed(path, (xml::LARGEST_BYTES, "an SRDF file"), pairs)
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
    pairs(bytes).map_err(Error::Experiment)
}

fn pairs(bytes: &[u8]) -> Checked<Vec<[String; 2]>> {
    let (_, document) = xml::parse(bytes, "SRDF")?;
    let robot = xml::robot(&document, "SRDF")?;
    robot
        .children("disable_collisions")
        .map(|pair| Ok([pair.need("link1")?.to_owned(), pair.need("link2")?.to_owned()]))
        .collect()
}

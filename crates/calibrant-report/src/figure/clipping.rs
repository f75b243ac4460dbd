//! What a page needs for its figures: their script, and names of clipping paths that are the same in every run.

use std::collections::BTreeMap;

/// Shows values, and zooms, in panels that state the ranges of their axes. It reads the drawings and the legends.
pub(crate) const CHART_SCRIPT: &str = include_str!("chart.js");

/// The prefix of the plotting library's names of clipping paths; a number follows.
const CLIP: &str = "kuva-clip-";

/// A page whose clipping paths are numbered in their order on it. The library numbers them over the whole
/// process, with figures of other threads among them.
pub(crate) fn renumbered(page: &str) -> String {
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut text = String::with_capacity(page.len());
    let mut copied = 0;
    for start in memchr::memmem::find_iter(page.as_bytes(), CLIP) {
        let at = start + CLIP.len();
        let end = page[at..].find(|c: char| !c.is_ascii_digit()).map_or(page.len(), |length| at + length);
        let (before, count) = (&page[..start], numbers.len() + 1);
        if end > at && (before.ends_with("id=\"") || before.ends_with("url(#")) {
            text.push_str(&page[copied..at]);
            text.push_str(&numbers.entry(&page[at..end]).or_insert(count).to_string());
            copied = end;
        }
    }
    text + &page[copied..]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_paths_are_numbered_in_their_order_and_text_is_left_alone() {
        let page = "<clipPath id=\"kuva-clip-17\"/><g clip-path=\"url(#kuva-clip-17)\"/>kuva-clip-17 \
                    <clipPath id=\"kuva-clip-2\"/><g clip-path=\"url(#kuva-clip-2)\"/><g clip-path=\"url(#kuva-clip-17)\"/>kuva-clip-";
        let expected = "<clipPath id=\"kuva-clip-1\"/><g clip-path=\"url(#kuva-clip-1)\"/>kuva-clip-17 \
                        <clipPath id=\"kuva-clip-2\"/><g clip-path=\"url(#kuva-clip-2)\"/><g clip-path=\"url(#kuva-clip-1)\"/>kuva-clip-";
        assert_eq!(renumbered(page), expected);
    }
}

//! Consecutive unused holds or rotations. They are not outliers: the sensor changed there, or was not at rest.

use std::ops::Range;

/// A run of this length is not by chance. Two rotations in a row may share a bad hold.
const FEWEST_IN_A_ROW: usize = 3;

/// The longest run of unused items, if it is long enough.
pub(in crate::estimate) fn longest_run(left_out: impl IntoIterator<Item = bool>) -> Option<Range<usize>> {
    let (mut longest, mut start) = (0..0, 0);
    for (place, left_out) in left_out.into_iter().enumerate() {
        if !left_out {
            start = place + 1;
        } else if place + 1 - start > longest.len() {
            longest = start..place + 1;
        }
    }
    (longest.len() >= FEWEST_IN_A_ROW).then_some(longest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_in_a_row_are_a_run() {
        let run = |flags: &str| longest_run(flags.chars().map(|flag| flag == 'x'));
        assert_eq!(run("xx.xx.x.xx"), None);
        assert_eq!(run("xx.xxx.x"), Some(3..6));
        assert_eq!(run(".xxx.xxxx"), Some(5..9));
        assert_eq!(run(""), None);
    }
}

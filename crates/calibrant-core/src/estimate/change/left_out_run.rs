//! Holds or rotations that are left out one after another are no outliers: the sensor was another one there, or not still.

use std::ops::Range;

/// So many in a row are no chance; two rotations may share a bad hold.
const FEWEST_IN_A_ROW: usize = 3;

/// The longest run of those that are left out, where it is one.
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

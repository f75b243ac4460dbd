//! A map: a cell for each value of its grid, in the colour of the band that the value lies in.

use super::panel::Map;
use super::scale::{Scale, number};

/// Colours from low to high values: matplotlib's viridis, as red, green and blue.
const VIRIDIS: [[f64; 3]; 5] =
    [[68.0, 1.0, 84.0], [59.0, 82.0, 139.0], [33.0, 145.0, 140.0], [94.0, 201.0, 98.0], [253.0, 231.0, 37.0]];

/// The colour of a band by its number from 0, the lowest; there are `bands`.
pub(super) fn colour(band: usize, bands: usize) -> String {
    let place = 4.0 * band as f64 / (bands.max(2) - 1) as f64;
    let first = (place as usize).min(3);
    let mixed = |k: usize| {
        let [from, to] = [first, first + 1].map(|of| VIRIDIS[of][k]);
        (from + (place - first as f64) * (to - from)).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mixed(0), mixed(1), mixed(2))
}

/// The cells: a path for each band, in it a rectangle for each run of cells in a row.
pub(super) fn cells(map: &Map, x: &Scale, y: &Scale) -> String {
    let bands = map.levels.len().saturating_sub(1);
    let band_of = |value: f64| map.levels.partition_point(|level| *level <= value).clamp(1, bands) - 1;
    let mut paths = vec![String::new(); bands];
    for (j, row) in map.values.iter().enumerate() {
        let mut from = 0;
        for run in row.chunk_by(|one, other| band_of(*one) == band_of(*other)) {
            let ([left, _], [_, right]) = (cell(&map.x, from, x), cell(&map.x, from + run.len() - 1, x));
            let [bottom, top] = cell(&map.y, j, y);
            paths[band_of(run[0])] += &format!("M{left} {bottom}V{top}H{right}V{bottom}Z");
            from += run.len();
        }
    }
    let path = |(band, path): (usize, &String)| {
        format!("<path d=\"{path}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>", colour(band, bands))
    };
    paths.iter().enumerate().map(path).collect()
}

/// Where a cell is drawn: from half way to the value before to half way to the next.
fn cell(values: &[f64], k: usize, scale: &Scale) -> [f64; 2] {
    let next = |other: usize| number(scale.at(0.5 * (values[k] + values[other])));
    [next(k.saturating_sub(1)), next((k + 1).min(values.len() - 1))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::panel::AxisRange;

    #[test]
    fn cells_of_a_band_in_a_row_are_one_rectangle_and_all_cover_the_map() {
        let scale = || Scale::new(AxisRange { range: (0.0, 2.0), step: None }, false).drawn(0.0, 2.0);
        let places = vec![0.0, 1.0, 2.0];
        let values = vec![vec![0.1, 0.2, 1.1], vec![1.2, 1.9, 2.0], vec![0.5; 3]];
        let map = Map { label: "", x: places.clone(), y: places, values, levels: vec![0.0, 1.0, 2.0] };
        let low = "M0 0V0.5H1.5V0ZM0 1.5V2H2V1.5Z";
        let high = "M1.5 0V0.5H2V0ZM0 0.5V1.5H2V0.5Z";
        let path = |path: &str, band: usize| {
            format!("<path d=\"{path}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>", colour(band, 2))
        };
        assert_eq!(cells(&map, &scale(), &scale()), path(low, 0) + &path(high, 1));
    }
}

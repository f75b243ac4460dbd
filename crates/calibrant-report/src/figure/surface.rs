//! The figure of the criterion over the jerks of two intervals, as a map in bands: the thesis's Figure 7.
//!
//! This file draws it itself: bands whose edges read as contours, with a bar that names them, are beyond the
//! plotting library.

use super::frame::framed;
use crate::html::escape;
use crate::number_format::{fixed, short, tick};
use calibrant_design::TraceSurface;

/// Left edge of the map.
const LEFT: f64 = 78.0;
/// Top edge of the map.
const TOP: f64 = 12.0;
/// Side of the map.
const SIDE: f64 = 360.0;
/// Width of the drawing.
const WIDTH: f64 = 556.0;
/// Height of the drawing.
const HEIGHT: f64 = 428.0;
/// Left edge and width of the colour bar.
const BAR: (f64, f64) = (462.0, 18.0);
/// Colour of lines and letters.
const INK: &str = "#1b1f24";
/// Largest number of bands.
const MOST_BANDS: f64 = 18.0;

/// The map; dark is good.
pub(crate) fn trace_map(surface: &TraceSurface) -> String {
    let settings = &surface.settings;
    let legend = if surface.log10_trace.iter().flatten().any(Option::is_none) {
        format!(
            "<ul class=\"legend\"><li><svg viewBox=\"0 0 34 14\">{}</svg>not determined: the sensor does not move</li></ul>",
            cross(17.0, 7.0)
        )
    } else {
        String::new()
    };
    let caption = format!(
        "A uniaxial sensor and two intervals of {} s, at {} Hz, starting at {} m/s²: decimal logarithm of the sum of the variances of bias \
         and scale factor (in SI units) over the jerks of both intervals. The peak lies where both jerks vanish: a sensor \
         that hardly moves does not determine its scale factor. The smallest values lie in corners, \
         where the jerks are largest, so the optimum lies on the limits. Edges of the bands are contours. The thesis estimates at each \
         point, draws a surface in space, and does not name its logarithm. The trace needs no estimation: it follows from \
         the motion alone.",
        short(settings.interval_s),
        short(settings.rate_hz),
        short(settings.start_mps2),
    );
    let title = "Figure 7 of the thesis: logarithm of the trace over the two jerks";
    framed(title, &legend, &drawing(surface), 1, &caption)
}

fn drawing(surface: &TraceSurface) -> String {
    let values = || surface.log10_trace.iter().flatten().flatten().copied().filter(|v| v.is_finite());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let count = surface.jerk_mps3.len();
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\" \
         font-family=\"system-ui, 'DejaVu Sans', Arial, sans-serif\" fill=\"{INK}\" font-size=\"13\">",
        escape("logarithm of the trace over the two jerks")
    );
    if low > high || count == 0 {
        svg.push_str(&format!("<text x=\"{LEFT}\" y=\"40\">nothing to show</text></svg>"));
        return svg;
    }
    let bands = Bands::over(low, high);
    svg.push_str("<g shape-rendering=\"crispEdges\">");
    let cell = SIDE / count as f64;
    let mut undetermined = Vec::new();
    for j in 0..count {
        let y = TOP + SIDE - (j + 1) as f64 * cell;
        let row: Vec<Option<usize>> = (0..count)
            .map(|i| surface.log10_trace.get(i).and_then(|column| column.get(j)).copied().flatten())
            .map(|value| value.map(|value| bands.index(value)))
            .collect();
        let mut start = 0;
        for i in 1..=count {
            if i < count && row[i] == row[start] {
                continue;
            }
            match row[start] {
                // a little overlap leaves no seams
                Some(band) => svg.push_str(&format!(
                    "<rect x=\"{:.2}\" y=\"{y:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>",
                    LEFT + start as f64 * cell,
                    (i - start) as f64 * cell + 0.3,
                    cell + 0.3,
                    bands.colour(band)
                )),
                None => {
                    undetermined.extend((start..i).map(|i| (LEFT + (i as f64 + 0.5) * cell, y + 0.5 * cell)))
                }
            }
            start = i;
        }
    }
    svg.push_str("</g>");
    undetermined.into_iter().for_each(|(x, y)| svg.push_str(&cross(x, y)));
    svg.push_str(&axes(surface));
    svg.push_str(&bar(&bands));
    svg + "</svg>"
}

fn axes(surface: &TraceSurface) -> String {
    let most = surface.jerk_mps3.last().copied().unwrap_or(1.0);
    let mut svg = format!(
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"#424a53\"/>"
    );
    let (bottom, middle) = (TOP + SIDE, LEFT + SIDE / 2.0);
    // the outermost cells are centred on the largest jerks
    let inset = SIDE / surface.jerk_mps3.len() as f64 / 2.0;
    for step in 0..5 {
        let share = f64::from(step) / 4.0;
        let (value, offset) = (tick(most * (2.0 * share - 1.0)), inset + (SIDE - 2.0 * inset) * share);
        let (x, y) = (LEFT + offset, bottom - offset);
        svg.push_str(&format!(
            "<path d=\"M{x:.1} {bottom}v5M{LEFT} {y:.1}h-5\" stroke=\"#424a53\"/>\
             <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{value}</text>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{value}</text>",
            bottom + 19.0,
            LEFT - 8.0,
            y + 4.5
        ));
    }
    svg.push_str(&format!(
        "<text x=\"{middle}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"14\">jerk u₁ of the first interval (m/s³)</text>\
         <text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\" font-size=\"14\">jerk u₂ of the second (m/s³)</text>",
        bottom + 42.0,
        TOP + SIDE / 2.0
    ));
    svg
}

fn bar(bands: &Bands) -> String {
    let (left, width) = BAR;
    let height = SIDE / bands.count as f64;
    let mut svg = String::new();
    for band in 0..bands.count {
        let y = TOP + SIDE - (band + 1) as f64 * height;
        svg.push_str(&format!(
            "<rect x=\"{left}\" y=\"{y:.2}\" width=\"{width}\" height=\"{:.2}\" fill=\"{}\"/>",
            height + 0.3,
            bands.colour(band)
        ));
    }
    for edge in 0..=bands.count {
        let y = TOP + SIDE - edge as f64 * height;
        svg.push_str(&format!(
            "<path d=\"M{:.1} {y:.1}h5\" stroke=\"#424a53\"/><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            left + width,
            left + width + 9.0,
            y + 4.5,
            fixed(bands.low + edge as f64 * bands.step, bands.decimals)
        ));
    }
    svg.push_str(&format!(
        "<rect x=\"{left}\" y=\"{TOP}\" width=\"{width}\" height=\"{SIDE}\" fill=\"none\" stroke=\"#424a53\"/>\
         <text x=\"{WIDTH}\" y=\"{:.1}\" text-anchor=\"end\" font-size=\"14\">log₁₀ trace</text>",
        TOP + SIDE + 42.0
    ));
    svg
}

fn cross(x: f64, y: f64) -> String {
    let path = format!("M{:.1} {:.1}l9 9m0 -9l-9 9", x - 4.5, y - 4.5);
    format!(
        "<path d=\"{path}\" stroke=\"#fff\" stroke-width=\"4.5\" fill=\"none\"/><path d=\"{path}\" stroke=\"#000\" stroke-width=\"1.8\" fill=\"none\"/>"
    )
}

/// Bands of equal height between round numbers.
struct Bands {
    low: f64,
    step: f64,
    count: usize,
    decimals: usize,
}

impl Bands {
    fn over(low: f64, high: f64) -> Self {
        let steps = [
            (0.01, 2),
            (0.02, 2),
            (0.05, 2),
            (0.1, 1),
            (0.2, 1),
            (0.25, 2),
            (0.5, 1),
            (1.0, 0),
            (2.0, 0),
            (5.0, 0),
        ];
        let fits = |&&(step, _): &&(f64, usize)| (high - low) / step <= MOST_BANDS - 1.0;
        let &(step, decimals) = steps.iter().find(fits).unwrap_or(&(50.0, 0));
        let start = (low / step).floor();
        let count = ((high / step).ceil() - start).max(1.0) as usize;
        Self { low: start * step, step, count, decimals }
    }

    fn index(&self, value: f64) -> usize {
        (((value - self.low) / self.step).floor().max(0.0) as usize).min(self.count - 1)
    }

    fn colour(&self, band: usize) -> String {
        viridis((band as f64 + 0.5) / self.count as f64)
    }
}

/// The colour map viridis, dark for 0 and bright for 1: even steps for all common kinds of colour vision, and in grey.
fn viridis(share: f64) -> String {
    /// Colours of viridis at equal steps.
    const STOPS: [[u8; 3]; 9] = [
        [68, 1, 84],
        [71, 45, 123],
        [59, 82, 139],
        [44, 114, 142],
        [33, 145, 140],
        [40, 174, 128],
        [94, 201, 98],
        [173, 220, 48],
        [253, 231, 37],
    ];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (place.floor() as usize).min(STOPS.len() - 2);
    let mix = |c: usize| {
        let (from, to) = (f64::from(STOPS[i][c]), f64::from(STOPS[i + 1][c]));
        (from + (to - from) * (place - i as f64)).round()
    };
    format!("#{:02x}{:02x}{:02x}", mix(0) as u8, mix(1) as u8, mix(2) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_hold_all_values_between_round_numbers() {
        for (low, high) in [(-9.43, -6.21), (-9.4, -9.39), (-3.0, -3.0), (-12.0, 55.0)] {
            let bands = Bands::over(low, high);
            assert!(bands.count <= 19 && bands.low <= low + 1e-12, "{low} {high}: {} bands", bands.count);
            assert!(bands.low + bands.step * bands.count as f64 >= high - 1e-12);
            assert_eq!(bands.index(low), 0);
        }
        assert_eq!(viridis(0.0), "#440154");
        assert_eq!(viridis(1.0), "#fde725");
    }
}

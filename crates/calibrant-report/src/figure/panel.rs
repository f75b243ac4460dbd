//! One pair of axes and the series in it, as data.

use super::colour::{BLACK, BLUE, VERMILLION};
use super::ticks::ticked;
use calibrant_core::sensor::Axis;

/// The look of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mark {
    /// A line; the dashes are SVG's, empty for solid.
    Line { width: f64, dashes: &'static str },
    /// Separate markers.
    Dots { shape: Shape, radius: f64 },
    /// The region within `spread` of the points.
    Band,
    /// The region between the points and zero.
    Area,
    /// A bar from `y − spread` to `y + spread` at each point.
    ErrorBars,
    /// The same, as wide as a range of values deserves.
    Ranges { width: f64 },
    /// A line from zero to each point.
    Stems,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Circle,
    Square,
    Triangle,
    Cross,
}

/// Places on the axes.
pub(super) type Points = Vec<(f64, f64)>;

/// Points that belong together.
#[derive(Debug, Clone)]
pub(super) struct Series {
    /// As in the legend; empty for none.
    pub(super) label: String,
    pub(super) colour: &'static str,
    pub(super) mark: Mark,
    pub(super) points: Points,
    /// Half widths of bands and error bars, one for each point.
    pub(super) spread: Vec<f64>,
}

impl Series {
    pub(super) fn new(label: &str, colour: &'static str, mark: Mark, points: Points) -> Self {
        Self { label: label.to_string(), colour, mark, points, spread: Vec::new() }
    }

    /// A line of this width. The dashes are SVG's, empty for solid.
    pub(super) fn stroke(
        label: &str,
        colour: &'static str,
        (width, dashes): (f64, &'static str),
        points: Points,
    ) -> Self {
        Self::new(label, colour, Mark::Line { width, dashes }, points)
    }

    pub(super) fn line(label: &str, colour: &'static str, points: Points) -> Self {
        Self::stroke(label, colour, (1.8, ""), points)
    }

    pub(super) fn dashed(label: &str, colour: &'static str, points: Points) -> Self {
        Self::stroke(label, colour, (1.8, "6 4"), points)
    }

    pub(super) fn dots(
        label: &str,
        colour: &'static str,
        (shape, radius): (Shape, f64),
        points: Points,
    ) -> Self {
        Self::new(label, colour, Mark::Dots { shape, radius }, points)
    }

    pub(super) fn band(label: &str, colour: &'static str, points: Points, spread: Vec<f64>) -> Self {
        Self { spread, ..Self::new(label, colour, Mark::Band, points) }
    }

    pub(super) fn bars(label: &str, colour: &'static str, points: Points, spread: Vec<f64>) -> Self {
        Self { spread, ..Self::new(label, colour, Mark::ErrorBars, points) }
    }

    /// Points and half widths that can be drawn: the finite ones.
    pub(super) fn finite(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        self.points.iter().enumerate().filter_map(|(i, &(x, y))| {
            let spread = self.spread.get(i).copied().unwrap_or(0.0);
            (x.is_finite() && y.is_finite() && spread.is_finite()).then_some((x, y, spread))
        })
    }

    fn starts_at_zero(&self) -> bool {
        matches!(self.mark, Mark::Area | Mark::Stems)
    }
}

/// A shaded interval of the x axis.
#[derive(Debug, Clone)]
pub(super) struct Shade {
    /// As in the legend.
    pub(super) label: &'static str,
    pub(super) colour: &'static str,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A quantity over both axes, shown as cells in bands of colours.
#[derive(Debug, Clone)]
pub(super) struct Map {
    /// Its name, beside the bar of the colours.
    pub(super) label: &'static str,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    /// A row for each y.
    pub(super) values: Vec<Vec<f64>>,
    /// Edges of the bands.
    pub(super) levels: Vec<f64>,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Panel {
    pub(super) title: String,
    pub(super) x_label: String,
    pub(super) y_label: String,
    /// A map below the series. It fills the panel.
    pub(super) map: Option<Map>,
    pub(super) series: Vec<Series>,
    pub(super) shades: Vec<Shade>,
    /// Values that the y axis must show.
    pub(super) y_includes: Vec<f64>,
    /// What the y axis shows, where that is not all values: what lies beyond it is cut.
    pub(super) y_shown: Option<(f64, f64)>,
    /// The heading of the table in whose rows the places on the x axis have names; empty for none.
    pub(super) x_names: &'static str,
    /// Distance between ticks of the x axis, where it is not left to the scale.
    pub(super) x_step: Option<f64>,
    /// The same of the y axis.
    pub(super) y_step: Option<f64>,
    /// Equal ranges of both axes in a square.
    pub(super) square: bool,
    /// Logarithmic x axis; only positive points are drawn.
    pub(super) log_x: bool,
    /// Logarithmic y axis; only positive points are drawn.
    pub(super) log_y: bool,
    /// The text in place of a plot where there is nothing to show.
    pub(super) when_empty: String,
}

impl Panel {
    pub(super) fn new(
        title: impl Into<String>,
        x_label: impl Into<String>,
        y_label: impl Into<String>,
    ) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            when_empty: "nothing to show".to_string(),
            ..Self::default()
        }
    }

    pub(super) fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Blue dots for what the computation used, and vermillion crosses for what it did not, where there is any.
    pub(super) fn with_used(
        self,
        labels: [&str; 2],
        radii: [f64; 2],
        points: impl IntoIterator<Item = (bool, (f64, f64))>,
    ) -> Self {
        let (mut used, mut left_out) = (Vec::new(), Vec::new());
        points.into_iter().for_each(|(is_used, at)| if is_used { used.push(at) } else { left_out.push(at) });
        let panel = self.with(Series::dots(labels[0], BLUE, (Shape::Circle, radii[0]), used));
        match left_out.as_slice() {
            [] => panel,
            _ => panel.with(Series::dots(labels[1], VERMILLION, (Shape::Cross, radii[1]), left_out)),
        }
    }

    /// With a logarithmic y axis where values differ widely, and else one that shows zero.
    pub(super) fn log_or_from_zero(mut self, is_wide: bool) -> Self {
        self.log_y = is_wide;
        self.y_includes.extend((!is_wide).then_some(0.0));
        self
    }

    /// A panel for each of these axes.
    pub(super) fn by_axis(
        axes: &[Axis],
        x_label: &str,
        y_label: &str,
        mut fill: impl FnMut(Axis, Self) -> Self,
    ) -> Vec<Self> {
        axes.iter().map(|&axis| fill(axis, Self::new(format!("axis {axis}"), x_label, y_label))).collect()
    }

    /// Dashed lines at plus and minus `limit` over the whole width.
    pub(super) fn with_limits(mut self, limit: f64) -> Self {
        let x = || self.series.iter().flat_map(Series::finite).map(|point| point.0);
        let (first, last) = (x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max));
        for (label, y) in [("limit", limit), ("", -limit)] {
            self.series.push(Series::stroke(label, BLACK, (1.2, "7 4"), vec![(first, y), (last, y)]));
        }
        self
    }

    /// The largest magnitude on the y axis.
    pub(super) fn largest(&self) -> f64 {
        self.series.iter().flat_map(Series::finite).fold(0.0, |most, (_, y, _)| most.max(y.abs()))
    }

    /// Can this point be drawn on these axes?
    pub(super) fn shows(&self, x: f64, y: f64) -> bool {
        (!self.log_x || x > 0.0) && (!self.log_y || y > 0.0)
    }

    /// The axes; `None` where nothing can be drawn.
    pub(super) fn axes(&self) -> Option<[AxisRange; 2]> {
        if let Some(Map { x, y, .. }) = &self.map {
            let ends = |of: &[f64]| Some((*of.first()?, *of.last()?));
            return Some([ends(x)?, ends(y)?].map(|range| AxisRange { range, step: None }));
        }
        let mut x = Range { log: self.log_x, ..Range::default() };
        let mut y = Range { log: self.log_y, ..Range::default() };
        for series in &self.series {
            for (px, py, spread) in series.finite().filter(|point| self.shows(point.0, point.1)) {
                x.include(px);
                y.include(py - spread);
                y.include(py + spread);
                if series.starts_at_zero() && !self.log_y {
                    y.include(0.0);
                }
            }
        }
        if x.is_empty() {
            return None;
        }
        self.y_includes.iter().for_each(|&value| y.include(value));
        if let Some((low, high)) = self.y_shown {
            (y.low, y.high) = (low, high);
        }
        if self.square {
            let both = Range { low: x.low.min(y.low), high: x.high.max(y.high), log: false }.padded(0.05);
            return Some([AxisRange { range: both, step: None }; 2]);
        }
        // seconds since 1970 need room
        let most = if x.low.abs().max(x.high.abs()) < 1e5 { MOST_STEPS } else { MOST_LONG_STEPS };
        let mut axes = [x.axis(most, self.x_step, 0.02), y.axis(MOST_STEPS, self.y_step, 0.07)];
        if self.series.iter().any(Series::starts_at_zero) && y.low >= 0.0 && !self.log_y {
            axes[1].range.0 = 0.0;
        }
        Some(axes)
    }
}

/// Largest number of steps between the ticks of an axis.
const MOST_STEPS: usize = 7;
/// The same where ticks have long numbers.
const MOST_LONG_STEPS: usize = 4;

/// The range of an axis, and the distance of its ticks where it is not left to the scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisRange {
    pub(super) range: (f64, f64),
    pub(super) step: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
struct Range {
    low: f64,
    high: f64,
    log: bool,
}

impl Default for Range {
    fn default() -> Self {
        Self { low: f64::INFINITY, high: f64::NEG_INFINITY, log: false }
    }
}

impl Range {
    fn include(&mut self, value: f64) {
        if value.is_finite() && (!self.log || value > 0.0) {
            self.low = self.low.min(value);
            self.high = self.high.max(value);
        }
    }

    fn is_empty(&self) -> bool {
        self.low > self.high
    }

    /// The axis that reaches all values.
    fn axis(&self, most: usize, step: Option<f64>, fraction: f64) -> AxisRange {
        match ticked((self.low, self.high), most, step).filter(|_| !self.log) {
            Some((range, step)) => AxisRange { range, step: Some(step) },
            None => AxisRange { range: self.padded(fraction), step },
        }
    }

    /// The range with some room on both sides; never of zero width.
    fn padded(&self, fraction: f64) -> (f64, f64) {
        if self.log {
            let room = (self.high / self.low).powf(fraction).max(1.2);
            let (low, high) = (self.low / room, self.high * room);
            // two round numbers at least, so that the axis can be read
            return if high / low < 5.0 { (round_below(low), round_above(high)) } else { (low, high) };
        }
        let width = self.high - self.low;
        let smallest = 1e-9 * self.low.abs().max(self.high.abs());
        if width > smallest {
            (self.low - fraction * width, self.high + fraction * width)
        } else {
            let room = (0.1 * self.high.abs()).max(if self.high == 0.0 { 1.0 } else { 0.0 });
            (self.low - room, self.high + room)
        }
    }
}

/// The largest of …, 1, 2, 5, 10, … that is not above a positive value.
fn round_below(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    [5.0, 2.0].into_iter().map(|m| m * decade).find(|&round| round <= value).unwrap_or(decade)
}

/// The smallest of …, 1, 2, 5, 10, … that is not below a positive value.
pub(super) fn round_above(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|m| m * decade).find(|&round| round >= value).unwrap_or(10.0 * decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_may_show_less_than_all_values() {
        let bars = Series::bars("", BLACK, vec![(0.0, 1.0), (1.0, 2.0)], vec![0.5, 1e6]);
        let panel = Panel { y_shown: Some((0.0, 3.0)), ..Panel::new("", "", "") };
        let [_, y] = panel.with(bars).axes().expect("bars");
        assert!(y.range.0 > -1.0 && y.range.1 < 4.0, "{y:?}");
    }

    #[test]
    fn ranges_hold_all_points_and_are_never_empty_or_infinite() {
        let points = vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 5.0)];
        let panel = Panel::new("", "", "").with(Series::line("a", "#000000", points));
        let [x, y] = panel.axes().expect("two points").map(|axis| axis.range);
        assert!(x.0 <= 0.0 && x.1 >= 2.0 && y.0 < 1.0 && y.1 > 5.0);

        for value in [0.0, 3.0, -3.0, 1e-12] {
            let panel = Panel::new("", "", "").with(Series::line("a", "#000000", vec![(value, value)]));
            let [x, y] = panel.axes().expect("one point").map(|axis| axis.range);
            assert!(x.0 < value && value < x.1 && y.0 < value && value < y.1, "{value}: {x:?} {y:?}");
        }
        assert!(Panel::new("", "", "").axes().is_none());
    }
}

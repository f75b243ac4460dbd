//! Histogram of each parameter over the sensors, with its limits and the spread of the datasheet.

use super::super::histogram::{Histogram, bin_count};
use super::super::panel::{Mark, Panel, Series};
use super::super::unit::DisplayUnit;
use super::super::{Figure, colour};
use super::groups::groups;
use super::reach::{Reach, least_width, whole_step};
use crate::batch::{Batch, BatchParameter};
use calibrant_core::diagnostic::Usability;

/// A figure for each sensor of an IMU, a panel for each of its parameters.
pub(crate) fn parameter_histograms(batch: &Batch) -> Vec<Figure> {
    let of_group = |group: super::groups::Group<'_>| {
        let mut seen = Seen::default();
        let panels = group.members.iter().filter_map(|&place| panel(batch, place, &mut seen)).collect();
        Figure::new(group.name, panels, caption(&seen)).with_columns(3)
    };
    groups(batch).into_iter().map(of_group).collect()
}

/// What the panels of a figure show, beside the bars.
#[derive(Debug, Default)]
struct Seen {
    limits: bool,
    datasheet: bool,
    outside: bool,
    far: bool,
}

fn caption(seen: &Seen) -> String {
    let mut caption = "The height is the number of sensors.".to_owned();
    if seen.outside {
        caption.push_str(
            " The axis leaves out a few sensors that are far from all others: its label counts them as outside.",
        );
    }
    if seen.far {
        caption.push_str(" The label of an axis names limits and spreads that are too far away to be drawn.");
    }
    caption.push_str(" Good: one heap");
    if seen.limits {
        caption.push_str(", well inside the limits");
    }
    if seen.datasheet {
        caption.push_str(", about as wide as the datasheet's band");
    }
    caption + ". Two heaps are two lots, or two stations."
}

/// What is drawn beside the bars.
#[derive(Default)]
struct Marks {
    limits: Option<(f64, f64)>,
    datasheet: Option<(f64, f64)>,
    /// What is too far away to be drawn.
    far: Vec<&'static str>,
}

impl Marks {
    fn of(parameter: &BatchParameter, bulk: Reach) -> Self {
        let band = parameter.nominal.zip(parameter.spread).filter(|(_, spread)| *spread > 0.0);
        let datasheet = band.map(|(nominal, spread)| (nominal - spread, nominal + spread));
        let mut marks = Self { limits: parameter.accepted, datasheet, far: Vec::new() };
        for (mark, name) in [(&mut marks.limits, "limits"), (&mut marks.datasheet, "datasheet")] {
            if mark.is_some_and(|(low, high)| bulk.with(&[low, high]).is_none()) {
                *mark = None;
                marks.far.push(name);
            }
        }
        marks
    }
}

fn panel(batch: &Batch, place: usize, seen: &mut Seen) -> Option<Panel> {
    let parameter = &batch.parameters[place];
    let found: Vec<((f64, f64), bool)> = batch
        .sensors
        .iter()
        .filter_map(|of| Some((of.estimate(place)?, of.usability() == Some(Usability::Bad))))
        .collect();
    let (values, sds): (Vec<f64>, Vec<f64>) = found.iter().map(|of| of.0).unzip();
    let bulk = Reach::of(&values, least_width(&values, &sds))?;
    let marks = Marks::of(parameter, bulk);
    let drawn = [marks.limits, marks.datasheet].into_iter().flatten().flat_map(|(low, high)| [low, high]);
    let reach = drawn.fold(bulk, Reach::including);
    let unit = DisplayUnit::suited_to(parameter.unit, [reach.low, reach.high]);
    let factor = unit.factor;

    let inside = |only_bad: bool| -> Vec<f64> {
        let inside = found.iter().filter(|((value, _), bad)| reach.contains(*value) && (*bad || !only_bad));
        inside.map(|((value, _), _)| value * factor).collect()
    };
    // the bars are as wide as the bulk deserves
    let bins = (bin_count(found.len()) as f64 * reach.width() / bulk.width()).round() as usize;
    let bars = |values: &[f64]| Histogram::within(values, reach.low * factor, reach.high * factor, bins);
    let all = bars(&inside(false));
    let most = all.most().max(1);
    let top = 1.06 * most as f64;

    let outside = found.len() - inside(false).len();
    let mut label = unit.label("estimate");
    if outside > 0 {
        label.push_str(&format!(", {outside} outside"));
    }
    if !marks.far.is_empty() {
        label.push_str(&format!(", {} far outside", marks.far.join(" and ")));
    }
    seen.limits |= marks.limits.is_some();
    seen.datasheet |= marks.datasheet.is_some();
    seen.outside |= outside > 0;
    seen.far |= !marks.far.is_empty();
    let mut panel = Panel::new(parameter.name.as_str(), label, "sensors");
    panel.y_step = Some(whole_step(most));
    if let Some((low, high)) = marks.datasheet {
        let ends = vec![(low * factor, 0.5 * top), (high * factor, 0.5 * top)];
        let name = "datasheet, nominal ± 1 sd";
        panel = panel.with(Series::band(name, colour::GREEN, ends, vec![0.5 * top; 2]));
    }
    panel = panel.with(Series::new("sensors", colour::SKY, Mark::Area, all.outline()));
    let bad = bars(&inside(true));
    if bad.most() > 0 {
        panel = panel.with(Series::new("of these bad", colour::VERMILLION, Mark::Area, bad.outline()));
    }
    if let Some((low, high)) = marks.limits {
        for (label, x) in [("acceptance limits", low), ("", high)] {
            let ends = vec![(x * factor, 0.0), (x * factor, top)];
            panel = panel.with(Series::stroke(label, colour::BLACK, (1.6, "7 4"), ends));
        }
    }
    Some(panel)
}

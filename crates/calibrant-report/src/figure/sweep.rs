//! The figure of a sweep: the best standard deviations as one quantity of the experiment changes.

use super::frame::caption;
use super::kinds::{Kind, kinds, look};
use super::panel::{Panel, Points, Series};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_design::{Sweep, SweepPoint};

/// Above this ratio of largest to smallest, an axis is logarithmic.
const WIDE: f64 = 3.0;
/// Curves within this of each other are drawn as one.
const SAME: f64 = 1e-3;

/// The sd of each parameter with the best motion against the swept value, and its lower bound where there is one.
pub(crate) fn sweep_curves(sweep: &Sweep) -> Figure {
    let mut points: Vec<&SweepPoint> = sweep.points.iter().collect();
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    let sd: Vec<Vec<f64>> = points.iter().map(|point| point.sd(sweep.parameters.len())).collect();
    let bound = |point: &SweepPoint, p: usize| {
        let certificate = point.outcome.as_ref().ok()?.certificate.as_ref()?;
        certificate.sd_lower_bound.get(p).copied().filter(|bound| *bound > 0.0)
    };
    let x_label = match sweep.variable.unit() {
        "" => sweep.variable.name().to_string(),
        unit => format!("{} ({unit})", sweep.variable.name()),
    };
    let (mut bounded, mut place) = (false, 0);
    let ratio = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        if low > 0.0 { high / low } else { 0.0 }
    };
    let mut panel = |kind: Kind| {
        let all =
            || kind.members.iter().flat_map(|&p| sd.iter().map(move |sd| sd[p])).filter(|v| v.is_finite());
        let unit = DisplayUnit::suited_to(kind.unit, all());
        let mut panel = Panel::new(kind.name, x_label.as_str(), unit.label("sd with the best motion"));
        for group in alike(&kind.members, &sd) {
            let (colour, shape) = look(place);
            place += 1;
            let names: Vec<&str> = group.iter().map(|&p| kind.suffix(&sweep.parameters[p])).collect();
            let label = format!("{} {}", kind.name, names.join(", "));
            let values = points.iter().map(|point| point.value);
            let curve: Points = values.zip(sd.iter().map(|sd| sd[group[0]] * unit.factor)).collect();
            let bounds: Points = points
                .iter()
                .filter_map(|point| Some((point.value, bound(point, group[0])? * unit.factor)))
                .collect();
            if !bounds.is_empty() {
                bounded = true;
                panel = panel.with(Series::dashed("lower bound", colour::BLACK, bounds));
            }
            panel = panel.with(Series::stroke("", colour, (1.6, ""), curve.clone())).with(Series::dots(
                &label,
                colour,
                (shape, 3.6),
                curve,
            ));
        }
        panel.log_x = ratio(&mut points.iter().map(|point| point.value)) > WIDE;
        panel.when_empty = "no motion was designed at any of the values".to_string();
        panel.log_or_from_zero(ratio(&mut all()) > WIDE)
    };
    let panels: Vec<Panel> = kinds(&sweep.parameters).into_iter().map(&mut panel).collect();
    let caption = caption(
        "Each marker is one design. Where a curve falls, a change of the value helps. Where it is flat, another limit is \
         active. Curves that coincide are drawn as one.",
        &[
            (
                bounded,
                "Dashed: the bound that no motion can beat. Where it touches the curve, the design is proved optimal.",
            ),
            (
                panels.iter().any(|panel| panel.log_x || panel.log_y),
                "Axes that span more than a factor of three are logarithmic.",
            ),
        ],
    );
    let columns = panels.len().clamp(2, 3);
    let title = format!("Standard deviations against {}", sweep.variable.name());
    Figure::new(title, panels, caption).with_columns(columns)
}

/// Parameters whose curves coincide.
fn alike(members: &[usize], sd: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for &p in members {
        let same = |q: usize| sd.iter().all(|sd| sd[p] == sd[q] || (sd[p] / sd[q] - 1.0).abs() < SAME);
        match groups.iter_mut().find(|group| same(group[0])) {
            Some(group) => group.push(p),
            None => groups.push(vec![p]),
        }
    }
    groups
}

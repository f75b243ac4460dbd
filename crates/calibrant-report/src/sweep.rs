//! The report page on a sweep: the best designs for several values of one quantity.

use super::About;
use super::design::{above, status};
use super::figure::{DisplayUnit, sweep_curves};
use super::html::{Page, verdict_box};
use super::number_format;
use crate::sheet::{Cell, Table};
use calibrant_core::information::Criterion;
use calibrant_design::{DesignStatus, Sweep, SweepPoint};

/// A sweep as one HTML file: the effect of the quantity in a sentence, the curves, a table of all values.
///
/// Self-contained as [`Sheet::html`](crate::Sheet::html) is.
#[must_use]
pub fn sweep_report(sweep: &Sweep, about: &About) -> String {
    let title = if about.title.is_empty() { "Sweep" } else { &about.title };
    let mut page = Page::opened(title, verdict(sweep, about));

    page.section(
        "Curves",
        "The best motion was designed for each value. The figure shows the standard deviation of a calibration from one recording of it.",
    );
    page.push(sweep_curves(sweep).html());
    page.section(
        "Table",
        &format!(
            "The design minimises criterion {}, {}{}.",
            sweep.criterion.letter(),
            sweep.criterion.formula(),
            sweep.criterion.scaling()
        ),
    );
    page.push(table(sweep));
    page.finish(title, &about.facts, &about.footer())
}

fn verdict(sweep: &Sweep, about: &About) -> String {
    let failed: Vec<String> = sweep
        .points
        .iter()
        .filter_map(|point| Some(format!("{}: {}", value(sweep, point), point.outcome.as_ref().err()?)))
        .collect();
    let unfinished: Vec<String> = sweep
        .points
        .iter()
        .filter_map(|point| Some((point, point.outcome.as_ref().ok()?.status)))
        .filter(|(_, ended)| *ended != DesignStatus::Converged)
        .map(|(point, ended)| format!("{}: {}", value(sweep, point), status(ended)))
        .collect();
    let (class, word) = match () {
        () if failed.len() == sweep.points.len() => ("bad", "✗ No motion is possible."),
        () if failed.is_empty() && unfinished.is_empty() => ("good", "✓ All designs converged."),
        () => ("caution", "! Look closer."),
    };
    let sentence = worth(sweep).unwrap_or_default();
    verdict_box(
        class,
        word,
        &sentence,
        &[("No design", failed), ("Not converged", unfinished), ("Findings", about.findings.clone())],
    )
}

/// The effect of the quantity on the parameter that depends on it most, from the smallest value to the largest.
fn worth(sweep: &Sweep) -> Option<String> {
    let mut points: Vec<&SweepPoint> = sweep.points.iter().filter(|point| point.outcome.is_ok()).collect();
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    let (first, last) = (*points.first()?, *points.last()?);
    let (low, high) = (first.sd(sweep.parameters.len()), last.sd(sweep.parameters.len()));
    let change = |p: usize| (low[p] / high[p]).ln().abs();
    let p = (0..sweep.parameters.len())
        .filter(|&p| change(p).is_finite())
        .max_by(|&a, &b| change(a).total_cmp(&change(b)))?;
    let parameter = &sweep.parameters[p];
    let unit = DisplayUnit::suited_to(parameter.unit, [low[p], high[p]]);
    let shown = |sd: f64| {
        format!("{} {}", number_format::significant(sd * unit.factor, 3), unit.symbol).trim_end().to_string()
    };
    let mut sentence = format!(
        "From {} to {}, the standard deviation of {} goes from {} to {}",
        value(sweep, first),
        value(sweep, last),
        parameter.name,
        shown(low[p]),
        shown(high[p])
    );
    let doublings = (last.value / first.value).log2();
    if doublings >= 0.5 {
        let ratio = (low[p] / high[p]).powf(1.0 / doublings);
        sentence.push_str(&match ratio {
            _ if (ratio - 1.0).abs() < 5e-3 => ". It hardly depends on this quantity".to_string(),
            _ if ratio > 1.0 => {
                format!(". On average, each doubling divides it by {}", number_format::significant(ratio, 3))
            }
            _ => format!(
                ". On average, each doubling multiplies it by {}",
                number_format::significant(1.0 / ratio, 3)
            ),
        });
    }
    sentence.push('.');
    if sweep.parameters.len() > 1 {
        sentence.push_str(" The other parameters change at most as much.");
    }
    Some(sentence)
}

/// The value of a point with its unit.
fn value(sweep: &Sweep, point: &SweepPoint) -> String {
    format!("{} {}", number_format::short(point.value), sweep.variable.unit()).trim_end().to_string()
}

fn table(sweep: &Sweep) -> String {
    let count = sweep.parameters.len();
    let sd: Vec<Vec<f64>> = sweep.points.iter().map(|point| point.sd(count)).collect();
    let units: Vec<DisplayUnit> = (0..count)
        .map(|p| {
            let values = sd.iter().map(|sd| sd[p]).filter(|sd| sd.is_finite());
            DisplayUnit::suited(sweep.parameters[p].unit, values.fold(f64::INFINITY, f64::min).min(1e9))
        })
        .collect();
    let nats = matches!(sweep.criterion, Criterion::D(_));
    let name = format!("{} ({})", sweep.variable.name(), sweep.variable.unit());
    let of_parameters =
        sweep.parameters.iter().zip(&units).map(|(p, unit)| unit.label(&format!("sd {}", p.name)));
    let above_label = if nats { "above the bound (nats)" } else { "above the bound" };
    let columns: Vec<String> = [name, "intervals".to_string()]
        .into_iter()
        .chain(of_parameters)
        .chain(["criterion".to_string(), above_label.to_string(), "ended".to_string()])
        .collect();
    let mut table = Table::new(columns);
    for (point, sd) in sweep.points.iter().zip(&sd) {
        let mut cells =
            vec![Cell::Name(number_format::short(point.value)), Cell::Number(point.intervals.to_string())];
        cells.extend(
            sd.iter()
                .zip(&units)
                .map(|(sd, unit)| Cell::Number(number_format::significant(sd * unit.factor, 4))),
        );
        match &point.outcome {
            Ok(design) => {
                cells.push(Cell::Number(number_format::significant(design.optimal.value, 5)));
                cells.push(Cell::Number(match &design.certificate {
                    Some(certificate) if nats => number_format::significant(certificate.gap, 2),
                    Some(certificate) => above(certificate.gap),
                    None => number_format::UNKNOWN.to_string(),
                }));
                let ended = status(design.status).to_string();
                let converged = design.status == DesignStatus::Converged;
                cells.push(if converged { Cell::Text(ended) } else { Cell::Mark(ended) });
                table.row(cells);
            }
            Err(_) => {
                cells.extend([
                    Cell::Number(number_format::UNKNOWN.into()),
                    Cell::Number(number_format::UNKNOWN.into()),
                ]);
                cells.push(Cell::Mark("no design, see above".to_string()));
                table.row_left_out(cells);
            }
        }
    }
    table.html()
}

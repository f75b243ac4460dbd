//! The sheet of a sweep: the best designs for several values of one quantity.

use super::design::{above, criterion_with_formula, ended, status};
use super::figure::{DisplayUnit, sweep_curves};
use super::report_context::{About, READINGS};
use crate::number_format::{short, significant};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Shown, Table};
use calibrant_core::information::Criterion;
use calibrant_design::{DesignStatus, Sweep, SweepPoint};

/// A sweep as a sheet: the effect of the quantity in a sentence, the curves, a table of all values.
#[must_use]
pub fn sweep_sheet<'a>(sweep: &'a Sweep, about: &'a About) -> Sheet<'a> {
    let mut curves = Section::on_page("Curves").lead(
        "The best motion was designed for each value. The figure shows the standard deviation of a calibration from one recording of it.",
    );
    curves.figure(|| Some(sweep_curves(sweep)));
    let mut values = Section::new("Best motion for each value")
        .lead(format!("The design minimises {}.", criterion_with_formula(&sweep.criterion)));
    values.table(table(sweep));
    about.sheet("Sweep", verdict(sweep, about), vec![curves, values], READINGS)
}

fn verdict(sweep: &Sweep, about: &About) -> SheetVerdict {
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
    let (grade, word) = match () {
        () if failed.len() == sweep.points.len() => (Grade::Bad, "✗ No motion was designed."),
        () if failed.is_empty() && unfinished.is_empty() => (Grade::Good, "✓ All designs converged."),
        () => (Grade::Caution, "! Look closer."),
    };
    SheetVerdict::new(grade, word, worth(sweep).unwrap_or_default())
        .with("No design", failed)
        .with("Not converged", unfinished)
        .with("Findings", about.findings.clone())
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
    let shown = |sd: f64| unit.text(sd, 3);
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
                format!(". On average, each doubling divides it by {}", significant(ratio, 3))
            }
            _ => format!(". On average, each doubling multiplies it by {}", significant(1.0 / ratio, 3)),
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
    format!("{} {}", short(point.value), sweep.variable.unit()).trim_end().to_string()
}

fn table(sweep: &Sweep) -> Table {
    let count = sweep.parameters.len();
    let sd: Vec<Vec<f64>> = sweep.points.iter().map(|point| point.sd(count)).collect();
    let units: Vec<DisplayUnit> = (0..count)
        .map(|p| {
            let values = sd.iter().map(|sd| sd[p]).filter(|sd| sd.is_finite());
            DisplayUnit::suited(sweep.parameters[p].unit, values.fold(f64::INFINITY, f64::min).min(1e9))
        })
        .collect();
    let nats = matches!(sweep.criterion, Criterion::D(_));
    let mut columns = vec![
        Column::new(sweep.variable.name()).in_unit(sweep.variable.unit()),
        Column::on_page("intervals"),
        format!("criterion {}", sweep.criterion.letter()).into(),
        if nats { "above the bound (nats)" } else { "above the bound" }.into(),
    ];
    let of_parameters = sweep.parameters.iter().zip(&units);
    // SI with fewer digits on terminals
    columns.extend(of_parameters.flat_map(|(p, unit)| {
        let name = format!("sd {}", p.name);
        [Column::on_page(unit.label(&name)), Column::new(name).shown(Shown::OnTerminal)]
    }));
    columns.push(Column::on_page("ended"));
    let mut table = Table::new(columns);
    for (point, sd) in sweep.points.iter().zip(&sd) {
        let design = point.outcome.as_ref().ok();
        let gap = design.and_then(|design| design.certificate.as_ref()).map(|certificate| certificate.gap);
        let mut cells = vec![
            Cell::name(short(point.value)),
            Cell::Number(point.intervals.to_string()),
            design.map_or(Cell::Missing, |design| Cell::significant(design.optimal.value, 4)),
            gap.map_or(Cell::Missing, |gap| match nats {
                true => Cell::significant(gap, 2),
                false => Cell::Number(above(gap)),
            }),
        ];
        let in_units = |(sd, unit): (&f64, &DisplayUnit)| {
            [Cell::significant(sd * unit.factor, 4), Cell::significant(*sd, 3)]
        };
        cells.extend(sd.iter().zip(&units).flat_map(in_units));
        match design {
            Some(design) => {
                cells.push(ended(design.status));
                table.row(cells);
            }
            None => {
                cells.push(Cell::Mark("no design, see above".to_owned()));
                table.row_left_out(cells);
            }
        }
    }
    table
}

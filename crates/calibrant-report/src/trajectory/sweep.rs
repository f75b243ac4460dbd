//! The sheet of trajectories of several durations: what time is worth.

use super::predicted::{smaller, unit};
use crate::About;
use crate::figure::{DisplayUnit, Figure, duration_curves};
use crate::number_format::{short, significant};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Table};
use calibrant_core::sensor::{ImuQuantity, Quantity, SensorKind};
use calibrant_machine_design::{TrajectorySweep, TrajectorySweepPoint};

/// Parameters of one kind: their name, and their places.
struct Group {
    name: String,
    unit: &'static str,
    members: Vec<usize>,
}

fn groups(sweep: &TrajectorySweep) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (place, quantity) in sweep.quantities.iter().enumerate() {
        let kind = match quantity {
            ImuQuantity::Of(_, Quantity::Bias(_)) => "bias",
            ImuQuantity::Of(_, Quantity::Scale(_)) => "scale",
            ImuQuantity::Of(_, Quantity::CrossAxis(..) | Quantity::Symmetric(..)) => "cross-axis",
            _ => "other",
        };
        let sensor = if quantity.sensor_kind() == SensorKind::Accelerometer { "acc." } else { "gyro." };
        let name = format!("{sensor} {kind}");
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.members.push(place),
            None => groups.push(Group { name, unit: unit(*quantity), members: vec![place] }),
        }
    }
    groups
}

/// Root mean square of the standard deviations of a group; infinite where there are none.
fn rms(point: &TrajectorySweepPoint, group: &Group) -> f64 {
    let covariance = point.outcome.as_ref().ok().and_then(|design| design.optimal.covariance.as_ref());
    covariance.map_or(f64::INFINITY, |of| {
        (group.members.iter().map(|i| of[(*i, *i)]).sum::<f64>() / group.members.len() as f64).sqrt()
    })
}

/// The best trajectories of several durations as a sheet.
#[must_use]
pub fn trajectory_sweep_sheet<'a>(sweep: &'a TrajectorySweep, about: &'a About) -> Sheet<'a> {
    let mut curves = Section::on_page("Curves")
        .lead("The best trajectory was sought for each duration. The figure shows the standard deviations that it promises.");
    curves.figure(|| Some(curves_of(sweep)));
    let mut values = Section::new("Best trajectory of each duration")
        .lead("Standard deviations are the root mean square of those of the same kind; single ones are in sweep.csv.");
    values.table(table(sweep));
    let model =
        "sd is the standard deviation that a calibration from a recording of the trajectory will state.";
    about.sheet("Durations", verdict(sweep, about), vec![values, curves], model)
}

fn table(sweep: &TrajectorySweep) -> Table {
    let groups = groups(sweep);
    let units: Vec<DisplayUnit> = groups
        .iter()
        .map(|group| DisplayUnit::suited_to(group.unit, sweep.points.iter().map(|point| rms(point, group))))
        .collect();
    let mut columns = vec![Column::new("duration (s)")];
    columns.extend(groups.iter().zip(&units).map(|(group, unit)| Column::new(unit.label(&group.name))));
    columns.push(Column::new("over plain"));
    let mut table = Table::new(columns);
    for point in &sweep.points {
        let mut row = vec![Cell::Number(short(point.duration_s))];
        let sd = |(group, unit): (&Group, &DisplayUnit)| match rms(point, group) * unit.factor {
            sd if sd.is_finite() => Cell::Number(significant(sd, 4)),
            _ => Cell::Number("–".into()),
        };
        row.extend(groups.iter().zip(&units).map(sd));
        let plain = point.outcome.as_ref().ok().and_then(|design| {
            let plain = &design.plain.as_ref()?.evaluation;
            Some(design.optimal.times_better_than(plain)).filter(|times| times.is_finite())
        });
        row.push(Cell::Number(
            plain.map_or_else(|| "–".into(), |times| format!("{} ×", significant(times, 3))),
        ));
        table.row(row);
    }
    table
}

fn verdict(sweep: &TrajectorySweep, about: &About) -> SheetVerdict {
    let failed: Vec<String> = sweep
        .points
        .iter()
        .filter_map(|point| Some(format!("{} s: {}", short(point.duration_s), point.outcome.as_ref().err()?)))
        .collect();
    let (grade, word) = match failed.len() {
        0 => (Grade::Good, "✓ All durations have a trajectory."),
        all if all == sweep.points.len() => (Grade::Bad, "✗ No trajectory was found."),
        _ => (Grade::Caution, "! Some durations have none."),
    };
    let found = || sweep.points.iter().filter(|point| point.outcome.is_ok());
    let by_time =
        |a: &&TrajectorySweepPoint, b: &&TrajectorySweepPoint| a.duration_s.total_cmp(&b.duration_s);
    let sentence = match (found().min_by(by_time), found().max_by(by_time)) {
        (Some(short_one), Some(long)) if long.duration_s > short_one.duration_s => {
            let all: Vec<f64> =
                groups(sweep).iter().map(|of| (rms(short_one, of) / rms(long, of)).ln()).collect();
            let times = (all.iter().sum::<f64>() / all.len().max(1) as f64).exp();
            format!(
                "From {} s to {} s standard deviations become {} in the mean.",
                short(short_one.duration_s),
                short(long.duration_s),
                smaller(times)
            )
        }
        _ => String::new(),
    };
    SheetVerdict::new(grade, word, sentence)
        .with("No trajectory", failed)
        .with("Findings", about.findings.clone())
}

fn curves_of(sweep: &TrajectorySweep) -> Figure {
    let curve = |group: &Group| {
        let points = sweep.points.iter().map(|point| (point.duration_s, rms(point, group)));
        let mut points: Vec<(f64, f64)> = points.filter(|(_, sd)| sd.is_finite()).collect();
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        (group.name.clone(), group.unit, points)
    };
    duration_curves(&groups(sweep).iter().map(curve).collect::<Vec<_>>())
}

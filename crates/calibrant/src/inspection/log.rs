//! What a log of a machine's motion contains.

use super::noticed::noticed;
use super::sampling::sampling_line;
use calibrant_core::sensor::Axis;
use calibrant_io::{JointInspection, Jumps, PoseInspection, ReferenceInspection, ReferenceLogFile, Seen};
use calibrant_machine::log::RecoveredStream;
use calibrant_report::number_format::{count, counted, short, significant};
use calibrant_report::{Cell, Section, Sheet, Table};

/// A log of a motion as a sheet: its times, what was seen, ranges, jumps, and the slower stream whose interpolation it is. `name`: what the file is
/// called.
#[must_use]
pub fn log_sheet(file: &ReferenceLogFile, inspection: &ReferenceInspection, name: &str) -> Sheet<'static> {
    let what = if inspection.poses.is_some() { "poses" } else { "joints" };
    let heading = format!("{name}: {}, {} rows", file.format.description(), count(file.rows));
    let mut section = Section::new(heading);
    section.paragraph(sampling_line(what, &inspection.sampling));
    if inspection.repeated > 0 {
        let samples = counted(inspection.repeated, "more sample");
        section.paragraph(format!("and {samples} with the time of the one before"));
    }
    match &inspection.poses {
        Some(found) => poses(&mut section, found),
        None => section.table(joints(&inspection.joints)),
    }
    let sections = vec![section, noticed(&file.findings, false)];
    Sheet { title: name.to_owned(), sections, ..Sheet::default() }
}

fn joints(joints: &[JointInspection]) -> Table {
    let mut table = Table::new([
        "joint",
        "least (rad, m)",
        "most (rad, m)",
        "velocities",
        "recorded",
        "longest without",
        "jumps",
    ]);
    for joint in joints {
        let mut row = vec![
            Cell::name(&joint.name),
            Cell::significant(joint.least, 5),
            Cell::significant(joint.most, 5),
            Cell::text(if joint.has_velocities { "yes" } else { "no" }),
        ];
        row.extend(seen(&joint.seen));
        row.push(jumps(joint.jumps.as_ref(), ""));
        table.row(row);
    }
    table
}

fn poses(section: &mut Section<'_>, found: &PoseInspection) {
    let mut table = Table::new(["", "seen", "longest unseen", "jumps"]);
    let mut row = |what: &str, is_seen: &Seen, jumped: Option<&Jumps>, unit: &str| {
        let [share, longest] = seen(is_seen);
        table.row(vec![Cell::name(what), share, longest, jumps(jumped, unit)]);
    };
    row("position", &found.position_seen, found.position_jumps.as_ref(), " m");
    row("orientation", &found.orientation_seen, found.orientation_jumps.as_ref(), " rad");
    section.table(table);
    if let Some((least, most)) = found.range_m {
        let mut table = Table::new(["position", "least", "most", "unit"]);
        for axis in Axis::ALL {
            let [least, most] = [least, most].map(|values| Cell::significant(values[axis.index()], 5));
            table.row(vec![Cell::Name(axis.to_string()), least, most, Cell::unit("m")]);
        }
        section.table(table);
    }
    match &found.interpolated {
        Some(stream) => interpolated(section, stream),
        None => section.paragraph("No slower stream was found whose interpolation the poses are."),
    }
}

fn interpolated(section: &mut Section<'_>, stream: &RecoveredStream) {
    let clock = stream.clock().map_or_else(String::new, |(nominal_hz, faster)| {
        let fast = if faster < 0.0 { "slow" } else { "fast" };
        let ppm = significant(1e6 * faster.abs(), 4);
        format!(" (of {} Hz by a clock that is {ppm} ppm {fast})", short(nominal_hz))
    });
    section.paragraph(format!(
        "The poses are a linear interpolation of a stream at {} Hz{clock}. Only its {} are measurements.",
        significant(stream.rate_hz(), 7),
        counted(stream.log.positions_m.iter().flatten().count(), "sample")
    ));
    let turned =
        stream.rms_rad.map_or_else(String::new, |rms| format!(" and {} µrad", significant(1e6 * rms, 2)));
    section.paragraph(format!(
        "The logged poses are within {} µm{turned} (rms) of the lines between them.",
        significant(1e6 * stream.rms_m, 2)
    ));
}

/// How often something was seen, and the longest time without it.
fn seen(seen: &Seen) -> [Cell; 2] {
    let without = match seen.longest_without_s > 0.0 {
        true => Cell::Number(format!("{} s", significant(seen.longest_without_s, 3))),
        false => Cell::Missing,
    };
    [Cell::Number(format!("{} %", significant(100.0 * seen.share, 4))), without]
}

fn jumps(jumps: Option<&Jumps>, unit: &str) -> Cell {
    Cell::Text(match jumps {
        None => "none".to_owned(),
        Some(Jumps { count, largest_after_s, largest }) => {
            let (largest, after_s) = (significant(*largest, 3), short(*largest_after_s));
            format!("{count}, the largest of {largest}{unit} after {after_s} s")
        }
    })
}

//! What a log of a machine's motion contains.

use super::sampling;
use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::io::{
    ImuReadOptions, Jumps, PoseInspection, ReferenceInspection, ReferenceInspectionFile, ReferenceLogFile,
    ReferenceLogOptions, Seen, file_name, inspect_reference_log, is_reference_log, read_reference_log,
    to_json,
};
use calibrant::machine::log::RecoveredStream;
use calibrant::report::number_format::{count, counted, short, significant};
use calibrant::sensor::Axis;
use std::path::Path;

/// Is a file, which is no recording, a log of a motion? Not where it is said to be a recording.
pub(super) fn is_one(path: &Path, options: &ImuReadOptions) -> bool {
    options.format.is_none() && options.columns.is_empty() && is_reference_log(path, &of_log(options))
}

/// Prints what a log contains.
pub(super) fn run(path: &Path, options: &ImuReadOptions, as_json: bool) -> calibrant::Result<Exit> {
    let file = read_reference_log(path, &of_log(options))?;
    let in_file = file.findings.iter().map(|found| found.clone().in_file(file_name(path)));
    in_file.filter(|found| found.is_warning()).for_each(tell);
    let inspection = inspect_reference_log(&file);
    if as_json {
        console::print_always(&to_json(&ReferenceInspectionFile { file: &file, inspection: &inspection }));
    } else {
        console::print(&text(path, &file, &inspection));
    }
    Ok(Exit::DONE)
}

/// The options that a log has of those of a recording.
fn of_log(options: &ImuReadOptions) -> ReferenceLogOptions {
    ReferenceLogOptions { time_unit: options.time_unit, topic: options.topic.clone() }
}

fn text(path: &Path, file: &ReferenceLogFile, inspection: &ReferenceInspection) -> String {
    let what = if inspection.poses.is_some() { "poses" } else { "joints" };
    let mut text =
        format!("{}: {}, {} rows\n\n", path.display(), file.format.description(), count(file.rows));
    text.push_str(&sampling::line(what, &inspection.sampling));
    if inspection.repeated > 0 {
        let samples = counted(inspection.repeated, "more sample");
        text.push_str(&format!("  and {samples} with the time of the one before\n"));
    }
    text.push('\n');
    match &inspection.poses {
        Some(found) => text.push_str(&poses(found)),
        None => text.push_str(&joints(inspection)),
    }
    if !file.findings.is_empty() {
        text.push_str("\nNoticed\n");
        file.findings.iter().for_each(|finding| text.push_str(&format!("  {finding}\n")));
    }
    text
}

fn joints(inspection: &ReferenceInspection) -> String {
    let rows: Vec<_> = inspection
        .joints
        .iter()
        .map(|joint| {
            let mut row = vec![
                joint.name.clone(),
                significant(joint.least, 5),
                significant(joint.most, 5),
                if joint.has_velocities { "yes" } else { "no" }.to_owned(),
            ];
            row.extend(seen(&joint.seen));
            row.push(jumps(joint.jumps.as_ref(), ""));
            row
        })
        .collect();
    let names =
        ["joint", "least (rad, m)", "most (rad, m)", "velocities", "recorded", "longest without", "jumps"];
    console::table(&names, &rows)
}

fn poses(found: &PoseInspection) -> String {
    let row = |what: &str, is_seen: &Seen, jumped: Option<&Jumps>, unit: &str| {
        let mut row = vec![what.to_owned()];
        row.extend(seen(is_seen));
        row.push(jumps(jumped, unit));
        row
    };
    let rows = [
        row("position", &found.position_seen, found.position_jumps.as_ref(), " m"),
        row("orientation", &found.orientation_seen, found.orientation_jumps.as_ref(), " rad"),
    ];
    let mut text = console::table(&["", "seen", "longest unseen", "jumps"], &rows);
    if let Some((least, most)) = found.range_m {
        let row = |axis: Axis| {
            let cells = [least, most].map(|values| significant(values[axis.index()], 5));
            [vec![axis.to_string()], cells.to_vec(), vec!["m".to_owned()]].concat()
        };
        text.push_str(&format!(
            "\n{}",
            console::table(&["position", "least", "most", "unit"], &Axis::ALL.map(row))
        ));
    }
    match &found.interpolated {
        Some(stream) => text.push_str(&interpolated(stream)),
        None => text.push_str("\nNo slower stream was found whose interpolation the poses are.\n"),
    }
    text
}

fn interpolated(stream: &RecoveredStream) -> String {
    let clock = stream.clock().map_or_else(String::new, |(nominal_hz, faster)| {
        let fast = if faster < 0.0 { "slow" } else { "fast" };
        format!(
            " (of {} Hz by a clock that is {} ppm {fast})",
            short(nominal_hz),
            significant(1e6 * faster.abs(), 4)
        )
    });
    let turned =
        stream.rms_rad.map_or_else(String::new, |rms| format!(" and {} µrad", significant(1e6 * rms, 2)));
    format!(
        "\nThe poses are a linear interpolation of a stream at {} Hz{clock}. Only its {} are measurements.\n\
         \u{20} The logged poses are within {} µm{turned} (rms) of the lines between them.\n",
        significant(stream.rate_hz(), 7),
        counted(stream.log.positions_m.iter().flatten().count(), "sample"),
        significant(1e6 * stream.rms_m, 2)
    )
}

/// How often something was seen, and the longest time without it.
fn seen(seen: &Seen) -> [String; 2] {
    let without = match seen.longest_without_s > 0.0 {
        true => format!("{} s", significant(seen.longest_without_s, 3)),
        false => "–".to_owned(),
    };
    [format!("{} %", significant(100.0 * seen.share, 4)), without]
}

fn jumps(jumps: Option<&Jumps>, unit: &str) -> String {
    match jumps {
        None => "none".to_owned(),
        Some(Jumps { count, largest_after_s, largest }) => {
            format!(
                "{count}, the largest of {}{unit} after {} s",
                significant(*largest, 3),
                short(*largest_after_s)
            )
        }
    }
}

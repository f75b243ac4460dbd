//! What a recording contains.

use super::columns;
use super::holds::hold_sections;
use super::noticed::noticed;
use super::sampling::sampling_line;
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{Axis, SensorKind};
use calibrant_io::{FileFormat, ImuColumn, ImuFile, Inspection, SensorInspection};
use calibrant_report::number_format::{count, short};
use calibrant_report::{Cell, Section, Sheet, Table, timeline_section};

/// A recording as a sheet: its columns, sampling, ranges, what was noticed, its holds, and what to expect of a calibration. `names`: what the
/// file is called, and that of the gyroscope of a pair.
#[must_use]
pub fn recording_sheet<'a>(file: &'a ImuFile, inspection: &'a Inspection, names: &[String]) -> Sheet<'a> {
    let mut sections = files(file, names);
    sections.push(readings(file, inspection));
    sections.push(noticed(&inspection.findings, file.second.is_some()));
    let holds: &[Hold] = inspection.holds.as_ref().map_or(&[], |found| &found.holds);
    sections.push(timeline_section(&file.recording, holds, Inspection::MINIMUM_HOLD_S));
    match &inspection.holds {
        Some(found) => sections.extend(hold_sections(found, inspection)),
        None if file.recording[SensorKind::Accelerometer].is_some() => {}
        None => {
            let mut section = Section::default();
            section.paragraph("Without an accelerometer there are no holds.");
            sections.push(section);
        }
    }
    Sheet { title: names.join(", "), sections, ..Sheet::default() }
}

/// Each file with its columns.
fn files<'a>(file: &ImuFile, names: &[String]) -> Vec<Section<'a>> {
    let of_second = file.second.as_ref().map_or(0, |second| second.columns);
    let (first, second) = file.columns.split_at(file.columns.len() - of_second);
    let formats = [(file.format, file.rows, first)].into_iter();
    let formats = formats.chain(file.second.as_ref().map(|of| (of.format, of.rows, second)));
    let one = |((format, rows, of), name): ((FileFormat, usize, &[ImuColumn]), &String)| {
        columns::file(format!("{name}: {}, {} rows", format.description(), count(rows)), of)
    };
    formats.zip(names).map(one).collect()
}

/// Times and values of each sensor.
fn readings(file: &ImuFile, inspection: &Inspection) -> Section<'static> {
    let mut section = Section::default();
    for sensor in &inspection.sensors {
        section.paragraph(sampling_line(sensor.sensor_kind.name(), &sensor.sampling));
    }
    let mut table = Table::new(["readings", "least", "mean", "most", "unit"]);
    for sensor in &inspection.sensors {
        Axis::ALL.into_iter().for_each(|axis| table.row(range(sensor, axis)));
    }
    section.table(table);
    if let Some(temperature) = &file.recording.temperature_c {
        let least = temperature.iter().copied().fold(f64::INFINITY, f64::min);
        let most = temperature.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        section.paragraph(format!("temperature from {} to {} °C", short(least), short(most)));
    }
    section
}

fn range(sensor: &SensorInspection, axis: Axis) -> Vec<Cell> {
    let values = [&sensor.least, &sensor.mean, &sensor.most];
    let mut row = vec![Cell::Name(format!("{} {axis}", sensor.sensor_kind))];
    row.extend(values.map(|of| Cell::significant(of[axis.index()], 5)));
    row.push(Cell::unit(sensor.unit.symbol()));
    row
}

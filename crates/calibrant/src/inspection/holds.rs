//! The holds of a recording, and what a calibration from them can give.

use calibrant_core::estimate::{Coverage, ExpectedCalibration};
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind};
use calibrant_io::{HoldsInspection, Inspection};
use calibrant_report::number_format::{short, significant};
use calibrant_report::{Cell, Section, Table};
use nalgebra::Vector3;

/// The holds, and the expected standard deviations.
pub(super) fn hold_sections(found: &HoldsInspection, inspection: &Inspection) -> [Section<'static>; 2] {
    let mut section = Section::new("Holds");
    section.paragraph(number_and_duration(&found.holds));
    section.list(found.coverage.iter().map(directions).collect());
    let gyroscope = inspection.sensors.iter().find(|sensor| sensor.sensor_kind == SensorKind::Gyroscope);
    if let (Some((mean, noise)), Some(gyroscope)) = (&found.gyroscope_at_rest, gyroscope) {
        section.paragraph(format!(
            "gyroscope in the holds: mean {}, noise of one sample {} {}",
            list(mean, 5),
            list(noise, 2),
            gyroscope.unit.symbol()
        ));
    }
    [section, found.expected.as_ref().map_or_else(Section::default, expected_sd)]
}

fn number_and_duration(holds: &[Hold]) -> String {
    let total: f64 = holds.iter().map(Hold::duration_s).sum();
    let longest = Hold::longest(holds).map_or(0.0, |number| holds[number].duration_s());
    let tenths = |seconds: f64| short((seconds * 10.0).round() / 10.0);
    match holds.len() {
        0 => "No holds found: the sensor is never at rest for a second.".to_owned(),
        n => format!(
            "{n} hold{} found, {} s altogether, the longest {} s",
            if n == 1 { "" } else { "s" },
            tenths(total),
            tenths(longest)
        ),
    }
}

/// How the directions of the holds cover the sphere.
fn directions(coverage: &Coverage) -> String {
    let ends = Axis::ALL.into_iter().flat_map(|axis| {
        [("+", 0), ("−", 1)].map(|(sign, k)| (format!("{sign}{axis}"), coverage.axes[axis.index()][k]))
    });
    let missing: Vec<String> = ends.filter_map(|(name, there)| (!there).then_some(name)).collect();
    let missing = match missing.as_slice() {
        [] => String::new(),
        some => format!("; no hold within 30° of {}", some.join(", ")),
    };
    let [x, y, z] = coverage.emptiest.into();
    format!(
        "directions: the largest gap is {}° from the nearest hold, at ({x:+.1}, {y:+.1}, {z:+.1}){missing}",
        significant(coverage.gap_rad.to_degrees(), 2)
    )
}

fn list(vector: &Vector3<f64>, digits: usize) -> String {
    vector.iter().map(|x| significant(*x, digits)).collect::<Vec<_>>().join(", ")
}

/// The standard deviations that a calibration from the holds will have.
fn expected_sd(expected: &ExpectedCalibration) -> Section<'static> {
    let heading =
        "Expected standard deviations of the accelerometer (upper gauge, full model), from noise alone";
    let mut section = Section::new(heading);
    let (sd, relative) = (expected.sd(), expected.relative_sd());
    let in_counts = expected.unit == ReadingUnit::Counts;
    let columns = ["parameter", "sd", "in counts"].into_iter().take(if in_counts { 3 } else { 2 });
    let mut table = Table::new(columns);
    for (k, quantity) in expected.list.quantities().iter().enumerate() {
        let in_si = match k < 3 {
            true => format!("{} m/s²", significant(relative[k], 2)),
            false => format!("{} %", significant(100.0 * relative[k], 2)),
        };
        let mut row = vec![Cell::Name(quantity.name()), Cell::Number(in_si)];
        if in_counts {
            row.push(Cell::Number(format!("{} {}", significant(sd[k], 2), quantity.unit(expected.unit))));
        }
        table.row(row);
    }
    section.table(table);
    section.paragraph(format!(
        "condition number {}; scatter between holds adds to these, and `calibrate` estimates it",
        significant(expected.condition_number, 3)
    ));
    section
}

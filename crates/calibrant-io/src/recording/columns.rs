//! The meaning of the columns of a plain text: from its header, or from the contract for text without one.

use super::ReadOptions;
use super::finding_words::list;
use super::reader_finding::{Finding, Noticed};
use super::row_parser::Layout;
use crate::delimited_text::{Delimiter, Line};
use crate::text_decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{Axis, ReadingUnit};

/// Standard gravity, m/s²: what a reading of 1 g means.
pub(super) const STANDARD_GRAVITY_MPS2: f64 = 9.80665;

/// The names of columns, for messages.
const UNITS: &str = "header t_s,ax,ay,az; the axes may end in _mps2, _counts or _g";

/// The columns of a recording.
pub(super) struct Columns {
    /// Slot 0 is the time, 1 to 3 the axes.
    pub(super) layout: Layout,
    /// Number of axes.
    pub(super) axes: usize,
    /// Unit of the readings, after the conversion.
    pub(super) unit: ReadingUnit,
    /// Factor on the readings.
    pub(super) factor: f64,
}

impl Columns {
    /// Finds the columns in the first line that is neither blank nor a comment.
    pub(super) fn find(line: Line<'_>, options: &ReadOptions, findings: &mut Vec<Finding>) -> Checked<Self> {
        let delimiter = Delimiter::of(line.text);
        let mut fields: Vec<&str> = line.fields(delimiter).map(|(_, field)| field).collect();
        if fields.len() > 1 && fields.last().is_some_and(|field| field.is_empty()) {
            fields.pop(); // a delimiter at the end of each line
        }
        let is_number = |field: &&str| field.parse::<f64>().is_ok();
        if fields.iter().any(is_number) || fields.iter().all(|field| field.is_empty()) {
            Self::without_header(fields.len(), delimiter, line, options, findings)
        } else {
            Self::from_header(&fields, delimiter, line, options, findings)
        }
    }

    fn without_header(
        columns: usize,
        delimiter: Delimiter,
        line: Line<'_>,
        options: &ReadOptions,
        findings: &mut Vec<Finding>,
    ) -> Checked<Self> {
        let needed = options.axes + 1;
        if columns < needed {
            return Err(InputError::new(
                Refusal::ColumnMissing,
                format!("{columns} column{} where {needed} are needed", if columns == 1 { "" } else { "s" }),
                format!(
                    "without a header the columns are {}",
                    ["t x", "t x y z"][usize::from(options.axes == 3)]
                ),
            )
            .at_line(line.number)
            .into());
        }
        if columns > needed {
            let noticed = Noticed::UnnamedColumnsIgnored(needed + 1, columns);
            findings.push(Finding::new(noticed).at(Some(line.number)));
        }
        let slots = (0..columns).map(|column| (column < needed).then_some(column)).collect();
        Ok(Self {
            layout: Layout { delimiter, slots, names: Vec::new(), has_header: false, ticks: false },
            axes: options.axes,
            unit: options.unit.unwrap_or(options.expected_unit),
            factor: 1.0,
        })
    }

    fn from_header(
        fields: &[&str],
        delimiter: Delimiter,
        line: Line<'_>,
        options: &ReadOptions,
        findings: &mut Vec<Finding>,
    ) -> Checked<Self> {
        let names: Vec<String> = fields.iter().map(|field| field.to_lowercase()).collect();
        let reject = |message: String, help: &str| {
            Err(InputError::new(Refusal::ColumnMissing, message, help).at_line(line.number).into())
        };
        let mut slots: Vec<Option<usize>> = vec![None; names.len()];
        let mut suffix: Option<Suffix> = None;
        for (column, name) in names.iter().enumerate() {
            let (slot, found) = match name.as_str() {
                "t_s" => (0, None),
                name => match axis_column(name) {
                    Some((axis, found)) if axis < options.axes => (axis + 1, Some(found)),
                    _ => continue,
                },
            };
            if slots.contains(&Some(slot)) {
                let what =
                    if slot == 0 { "the time".into() } else { format!("axis {}", Axis::ALL[slot - 1]) };
                return reject(format!("{what} has two columns, the second is `{name}`"), "keep one of them");
            }
            match (suffix, found) {
                (Some(before), Some(found)) if before != found => {
                    return reject(
                        format!("the axes have different units: `{name}` after one in {}", before.symbol()),
                        "all axes need the same suffix",
                    );
                }
                (None, Some(found)) => suffix = Some(found),
                _ => (),
            }
            slots[column] = Some(slot);
        }
        let missing: Vec<&str> = ["t_s", "ax", "ay", "az"][..=options.axes]
            .iter()
            .enumerate()
            .filter(|(slot, _)| !slots.contains(&Some(*slot)))
            .map(|(_, name)| *name)
            .collect();
        if !missing.is_empty() {
            let message = format!(
                "column{} {} missing; the columns are {}",
                if missing.len() == 1 { "" } else { "s" },
                missing.join(", "),
                list(&names, 20)
            );
            return reject(message, UNITS);
        }
        let ignored: Vec<String> = names
            .iter()
            .zip(&slots)
            .filter(|(_, slot)| slot.is_none())
            .map(|(name, _)| name.clone())
            .collect();
        if !ignored.is_empty() {
            findings.push(Finding::new(Noticed::ColumnsIgnored(ignored)).at(Some(line.number)));
        }
        let (unit, factor) = resolve_unit(suffix.unwrap_or(Suffix::None), line, options, findings)?;
        let layout = Layout { delimiter, slots, names, has_header: true, ticks: false };
        Ok(Self { layout, axes: options.axes, unit, factor })
    }
}

/// The unit at the end of a column's name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Suffix {
    None,
    Mps2,
    Counts,
    G,
}

impl Suffix {
    fn symbol(self) -> &'static str {
        match self {
            Self::None => "no stated unit",
            Self::Mps2 => "m/s²",
            Self::Counts => "counts",
            Self::G => "g",
        }
    }
}

/// Is this the name of an axis of a plain text, `ax` to `az_g`?
pub(super) fn is_axis(name: &str) -> bool {
    axis_column(name).is_some()
}

/// The axis (0, 1, 2) and the unit of a column of this name.
fn axis_column(name: &str) -> Option<(usize, Suffix)> {
    let axis = ["ax", "ay", "az"].iter().position(|axis| name.starts_with(axis))?;
    let suffix = match &name[2..] {
        "" => Suffix::None,
        "_mps2" => Suffix::Mps2,
        "_counts" => Suffix::Counts,
        "_g" => Suffix::G,
        _ => return None,
    };
    Some((axis, suffix))
}

/// Unit and factor of the readings: from the header; else the option; else the experiment.
fn resolve_unit(
    suffix: Suffix,
    line: Line<'_>,
    options: &ReadOptions,
    findings: &mut Vec<Finding>,
) -> Checked<(ReadingUnit, f64)> {
    let (unit, factor) = match suffix {
        Suffix::None => return Ok((options.unit.unwrap_or(options.expected_unit), 1.0)),
        Suffix::Mps2 => (ReadingUnit::MetrePerSecondSquared, 1.0),
        Suffix::Counts => (ReadingUnit::Counts, 1.0),
        Suffix::G => (ReadingUnit::MetrePerSecondSquared, STANDARD_GRAVITY_MPS2),
    };
    match options.unit {
        Some(given) if given != unit || suffix == Suffix::G => {
            return Err(InputError::new(
                Refusal::UnitContradicted,
                format!("the header says {}, but the unit was given as {}", suffix.symbol(), given.symbol()),
                "leave --unit away: the header decides (readings in g are converted to m/s²)",
            )
            .at_line(line.number)
            .into());
        }
        None if options.expected_unit != unit => {
            let noticed = Noticed::UnitUnexpected { stated: unit, expected: options.expected_unit };
            findings.push(Finding::new(noticed).at(Some(line.number)));
        }
        _ => (),
    }
    Ok((unit, factor))
}

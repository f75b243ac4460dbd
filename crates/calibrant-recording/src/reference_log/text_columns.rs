//! What the columns of a text hold: joints or a pose, and times.

use super::column_faults::without_header;
use super::content::{Content, Values};
use super::format::ReferenceFormat;
use super::joint_layout;
use super::log_columns::{LengthUnit, LogColumns};
use super::options::ReferenceLogOptions;
use super::orientation_form::OrientationForm;
use super::pose_columns::{VALUES, tcp_pose};
use super::pose_layout::of_poses;
use super::time_layout::TimeLayout;
use crate::recording::TimeUnit;
use crate::recording::row_parser::Layout;
use crate::recording::text_header::Head;
use crate::text::decoding::{Checked, refuse};
use crate::text::delimited::{Delimiter, Line};
use calibrant_core::error::Refusal;

/// The columns of a text.
pub(super) struct TextColumns {
    pub(super) format: ReferenceFormat,
    /// The values of a row.
    pub(super) values: Values,
    /// Names of the columns; their numbers, where the user names some without a header; otherwise empty without one.
    pub(super) names: Vec<String>,
    pub(super) has_header: bool,
    pub(super) time_unit: Option<TimeUnit>,
    /// Is there a column of the rest of the seconds, in this unit?
    pub(super) rest: Option<TimeUnit>,
    /// Rate of the frames, Hz, where they stand in the place of times.
    pub(super) rate_hz: Option<f64>,
}

/// Largest number of columns: no machine has so many joints.
const MOST: usize = 4096;
/// First rows that show whether two columns are one clock.
const LOOKED_AT: usize = 100;

impl TextColumns {
    /// The columns of a text that begins like this.
    pub(super) fn find(head: &Head<'_>, options: &ReferenceLogOptions) -> Checked<Self> {
        let names = names(head);
        if names.len() > MOST {
            let message = format!("the log has {} columns, more than {MOST}", names.len());
            return refuse(
                Refusal::FileUnreadable,
                message,
                "leave out those that are of no joint and no pose",
            );
        }
        let first_row: Vec<&str> = first_row(head);
        let is_comment =
            head.first_row.is_some() || head.names.first().is_some_and(|name| name.starts_with('#'));
        let is_trajectory =
            first_row.len() == 1 + VALUES && first_row.iter().all(|field| field.parse::<f64>().is_ok());
        let said = &options.columns;
        let is_said = said.time.is_some()
            || said.position.is_some()
            || said.orientation.is_some()
            || said.joints.is_some();
        let found = match names.is_empty() {
            true if is_said => {
                let numbers = (1..=first_row.len()).map(|number| number.to_string()).collect();
                Some(Self::of_names(numbers, head, options))
            }
            true => None,
            false => Some(Self::of_names(names, head, options)),
        };
        let mut columns = match found {
            Some(Ok(columns)) => columns,
            // a comment above a trajectory need not name its columns
            _ if is_comment && is_trajectory && !is_said => Self::trajectory(said),
            Some(Err(input_error)) => return Err(input_error.at_line(head.line()).into()),
            None => return Err(without_header(first_row.len()).at_line(head.line()).into()),
        };
        if is_comment && !is_said && columns.format == ReferenceFormat::Poses {
            columns.format = ReferenceFormat::Tum;
        }
        columns.set_time_unit(&first_row, options)?;
        Ok(columns)
    }

    /// `t x y z` and a quaternion, w last unless it is said otherwise.
    fn trajectory(said: &LogColumns) -> Self {
        let form = said.orientation_is.filter(|form| form.width() == 4);
        let mut factors = vec![said.position_unit.map_or(1.0, LengthUnit::factor); 3];
        factors.resize(VALUES, 1.0);
        let values = Values {
            content: Content::Poses(form.unwrap_or(OrientationForm::QuaternionXyzw)),
            slots: (0..=VALUES).map(Some).collect(),
            factors,
            assumed: None,
        };
        Self {
            format: ReferenceFormat::Tum,
            values,
            names: Vec::new(),
            has_header: false,
            time_unit: None,
            rest: None,
            rate_hz: None,
        }
    }

    fn of_names(names: Vec<String>, head: &Head<'_>, options: &ReferenceLogOptions) -> Checked<Self> {
        let said = &options.columns;
        if let Some((key, message, help)) = said.complaint() {
            let at = if key.is_empty() { String::new() } else { format!(" {key}:") };
            return refuse(Refusal::ValueInvalid, format!("[machine.log.columns]{at} {message}"), help);
        }
        let (mut values, format) = match &said.joints {
            Some(joints) => {
                (joint_layout::as_said(joints, said.joints_unit, &names)?, ReferenceFormat::Joints)
            }
            None => by_names(&names, options)?,
        };
        let times = |column: usize| {
            let rows = head.first_row.into_iter().chain(head.rest.clone()).filter(|line| !line.is_void());
            let field = |line: Line<'_>| {
                line.fields(head.delimiter).nth(column).and_then(|(_, field)| field.trim().parse().ok())
            };
            rows.take(LOOKED_AT).filter_map(field).collect()
        };
        let time = TimeLayout::find(&names, said, times)?;
        values.slots[time.column] = Some(0);
        if let Some(rest) = time.rest {
            values.slots[rest] = Some(1 + values.factors.len());
        }
        Ok(Self {
            format,
            values,
            names,
            has_header: !head.names.is_empty(),
            time_unit: time.unit,
            rest: time.unit.filter(|_| time.rest.is_some()),
            rate_hz: None,
        })
    }

    /// The unit of the times: stated by the name or the format, or given, or plain from their size.
    fn set_time_unit(&mut self, first_row: &[&str], options: &ReferenceLogOptions) -> Checked<()> {
        let contradicts =
            |message: String| refuse(Refusal::UnitContradicted, message, "leave option `time_unit` away");
        let given = options.columns.time_unit.or(options.time_unit);
        match (given, self.time_unit) {
            (Some(TimeUnit::Sample), _) => {
                return contradicts("a log of a motion has times, not numbers of samples".into());
            }
            (Some(given), Some(stated)) if given != stated => {
                return contradicts(format!(
                    "the times are in {}, but their unit was given as {}",
                    stated.symbol(),
                    given.symbol()
                ));
            }
            _ => (),
        }
        let column = self.values.slots.iter().position(|slot| *slot == Some(0));
        let first = column.and_then(|column| first_row.get(column)).and_then(|field| field.parse().ok());
        let of_format = match self.format {
            ReferenceFormat::Euroc => Some(TimeUnit::Nanosecond),
            ReferenceFormat::Tum | ReferenceFormat::Rtde => Some(TimeUnit::Second),
            _ => None,
        };
        self.time_unit = self.time_unit.or(given).or_else(|| since_1970(first?)).or(of_format);
        Ok(())
    }

    /// How the rows are to be read.
    pub(super) fn layout(&self, delimiter: Delimiter) -> Layout {
        Layout {
            decimal_comma: false,
            delimiter,
            slots: self.values.slots.clone(),
            names: self.names.clone(),
            has_header: self.has_header,
            ticks: self.time_unit != Some(TimeUnit::Second),
            text_times: false,
            only: None,
            may_be_invalid: 0..0,
        }
    }

    /// The names of the columns that are not used.
    pub(super) fn ignored(&self) -> Vec<String> {
        let unused = self.names.iter().zip(&self.values.slots).filter(|(_, slot)| slot.is_none());
        unused.map(|(name, _)| name.clone()).collect()
    }

    /// Name of the time column.
    pub(super) fn time_name(&self) -> String {
        let column = self.values.slots.iter().position(|slot| *slot == Some(0)).unwrap_or(0);
        self.names.get(column).cloned().unwrap_or_else(|| (column + 1).to_string())
    }
}

/// The unit of a time that can only count from 1970.
fn since_1970(first: f64) -> Option<TimeUnit> {
    match first {
        1e17.. => Some(TimeUnit::Nanosecond),
        1e14.. => Some(TimeUnit::Microsecond),
        1e11.. => Some(TimeUnit::Millisecond),
        _ => None,
    }
}

/// The names of the columns, without the mark of a comment.
fn names(head: &Head<'_>) -> Vec<String> {
    let mut names: Vec<String> = head.names.iter().map(|name| (*name).to_owned()).collect();
    if let Some(first) = names.first_mut() {
        *first = first.trim_start_matches('#').trim().to_owned();
        if first.is_empty() {
            names.remove(0);
        }
    }
    names
}

/// The fields of the first row.
pub(super) fn first_row<'t>(head: &Head<'t>) -> Vec<&'t str> {
    let line = head.first_row.or_else(|| head.rest.clone().find(|line| !line.is_void()));
    let mut fields: Vec<&str> =
        line.map_or_else(Vec::new, |line| line.fields(head.delimiter).map(|(_, field)| field).collect());
    if fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    fields
}

/// Joints or poses, by the names of the columns.
fn by_names(names: &[String], options: &ReferenceLogOptions) -> Checked<(Values, ReferenceFormat)> {
    let is_said = options.columns.position.is_some() || options.columns.orientation.is_some();
    let wants_poses = is_said || options.poses && tcp_pose(names).is_some();
    if !wants_poses && let Some(values) = joint_layout::of_rtde(names)? {
        return Ok((values, ReferenceFormat::Rtde));
    }
    if let Some(values) = of_poses(names, options)? {
        let is_euroc = names.iter().any(|name| name.to_lowercase().starts_with("p_rs"));
        let format = match () {
            () if tcp_pose(names).is_some() => ReferenceFormat::Rtde,
            () if is_euroc => ReferenceFormat::Euroc,
            () => ReferenceFormat::Poses,
        };
        return Ok((values, format));
    }
    joint_layout::by_names(names).map(|values| (values, ReferenceFormat::Joints))
}

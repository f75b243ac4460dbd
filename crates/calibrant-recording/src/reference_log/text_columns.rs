//! What the columns of a text hold: joints or a pose, and times.

use super::content::Content;
use super::format::ReferenceFormat;
use super::joint_columns::{JointColumn, joint_column, rtde_column};
use super::options::ReferenceLogOptions;
use super::pose_columns::{NAMES, PoseColumn, VALUES, pose_column};
use crate::recording::imu_column;
use crate::recording::row_parser::Layout;
use crate::recording::text_header::Head;
use crate::recording::{ColumnMeaning, ColumnUnit, TimeUnit};
use crate::text::decoding::{Checked, refuse};
use crate::text::delimited::Delimiter;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal};

/// The columns of a text.
pub(super) struct TextColumns {
    pub(super) format: ReferenceFormat,
    pub(super) content: Content,
    /// Names of the columns; empty where there is no header.
    pub(super) names: Vec<String>,
    /// For each column its slot: 0 is the time, values follow.
    pub(super) slots: Vec<Option<usize>>,
    /// The factor on each value.
    pub(super) factors: Vec<f64>,
    pub(super) time_unit: Option<TimeUnit>,
}

/// The names that a log may have, for errors.
const EXAMPLES: &str = "name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz; without a header a trajectory is t x y z qx qy qz qw";

/// Largest number of columns: no machine has so many joints.
const MOST: usize = 4096;

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
        let found = match names.is_empty() {
            true => None,
            false => Some(Self::of_names(names)),
        };
        let mut columns = match found {
            Some(Ok(columns)) => columns,
            // a comment above a trajectory need not name its columns
            _ if is_comment && is_trajectory => Self::trajectory(),
            Some(Err(input_error)) => return Err(input_error.at_line(head.line()).into()),
            None => return Err(without_header(first_row.len()).at_line(head.line()).into()),
        };
        if is_comment && columns.format == ReferenceFormat::Poses {
            columns.format = ReferenceFormat::Tum;
        }
        columns.set_time_unit(&first_row, options)?;
        Ok(columns)
    }

    fn trajectory() -> Self {
        Self {
            format: ReferenceFormat::Tum,
            content: Content::Poses,
            names: Vec::new(),
            slots: [0, 1, 2, 3, 5, 6, 7, 4].map(Some).to_vec(),
            factors: vec![1.0; VALUES],
            time_unit: None,
        }
    }

    fn of_names(names: Vec<String>) -> Checked<Self> {
        let rtde: Vec<_> = names.iter().map(|name| rtde_column(name)).collect();
        let numbers =
            || rtde.iter().flatten().filter(|(_, is_velocity)| !is_velocity).map(|(number, _)| *number);
        let mut columns = if let Some(last) = numbers().max() {
            if let Some(missing) = (0..last).find(|number| !numbers().any(|known| known == *number)) {
                let message = format!("the column `actual_q_{missing}` is missing");
                let help = "record actual_q with all of its joints";
                return refuse(Refusal::ColumnMissing, message, help);
            }
            let joint = |number: usize| format!("actual_q_{number}");
            let column = |(number, is_velocity)| JointColumn {
                joint: joint(number),
                derivative: usize::from(is_velocity),
                turns: true,
                factor: 1.0,
            };
            let columns = rtde.iter().map(|found| found.map(column));
            Self::of_joints(
                ReferenceFormat::Rtde,
                (0..=last).map(joint).collect(),
                names,
                &columns.collect::<Vec<_>>(),
            )?
        } else if let Some(columns) = Self::of_poses(&names)? {
            columns
        } else {
            let columns: Vec<_> = names.iter().map(|name| joint_column(name)).collect();
            let mut joints: Vec<String> = Vec::new();
            for column in columns.iter().flatten().filter(|column| column.derivative == 0) {
                if !joints.contains(&column.joint) {
                    joints.push(column.joint.clone());
                }
            }
            if joints.is_empty() {
                return Err(nothing_to_read(&names).into());
            }
            Self::of_joints(ReferenceFormat::Joints, joints, names, &columns)?
        };
        let (time, time_unit) = time_column(&columns.names)?;
        columns.slots[time] = Some(0);
        columns.time_unit = time_unit;
        Ok(columns)
    }

    /// The columns of poses; `None` where the names are not of a pose.
    fn of_poses(names: &[String]) -> Checked<Option<Self>> {
        let mut found: Vec<_> = names.iter().map(|name| pose_column(name)).collect();
        let has =
            |found: &[Option<PoseColumn>], value| found.iter().flatten().any(|column| column.value == value);
        let has_orientation = (3..VALUES).any(|value| has(&found, value));
        if !has_orientation {
            // three joints may be called x, y and z
            found.iter_mut().for_each(|column| *column = column.filter(|column| !column.is_bare));
            if !(0..3).all(|value| has(&found, value)) {
                return Ok(None);
            }
        }
        for (what, values) in [("position", 0..3), ("orientation", 3..VALUES)] {
            let missing: Vec<&str> =
                values.clone().filter(|&value| !has(&found, value)).map(|value| NAMES[value]).collect();
            if !missing.is_empty() && missing.len() < values.len() {
                let message = format!("the {what} has no column for {}", missing.join(", "));
                return refuse(Refusal::ColumnMissing, message, EXAMPLES);
            }
        }
        let mut slots = vec![None; names.len()];
        let mut factors = vec![1.0; VALUES];
        for (k, column) in found.iter().enumerate() {
            let Some(column) = column else { continue };
            check_repeated(&slots, 1 + column.value, k, names)?;
            slots[k] = Some(1 + column.value);
            factors[column.value] = column.factor;
        }
        let is_euroc = names.iter().any(|name| name.to_lowercase().starts_with("p_rs"));
        let format = if is_euroc { ReferenceFormat::Euroc } else { ReferenceFormat::Poses };
        Ok(Some(Self {
            format,
            content: Content::Poses,
            names: names.to_vec(),
            slots,
            factors,
            time_unit: None,
        }))
    }

    /// The columns of these joints.
    fn of_joints(
        format: ReferenceFormat,
        joints: Vec<String>,
        names: Vec<String>,
        columns: &[Option<JointColumn>],
    ) -> Checked<Self> {
        let mut slots = vec![None; names.len()];
        let mut factors = vec![1.0; 3 * joints.len()];
        let mut has = [true, false, false];
        let mut turning = vec![None; joints.len()];
        for (k, column) in columns.iter().enumerate() {
            let Some(JointColumn { joint, derivative, turns, factor }) = column else { continue };
            let Some(number) = joints.iter().position(|known| known == joint) else { continue };
            let value = derivative * joints.len() + number;
            check_repeated(&slots, 1 + value, k, &names)?;
            slots[k] = Some(1 + value);
            factors[value] = *factor;
            has[*derivative] = true;
            if *derivative == 0 {
                turning[number] = Some(*turns);
            }
        }
        let derivatives = has.iter().rposition(|has| *has).unwrap_or(0);
        factors.truncate((1 + derivatives) * joints.len());
        let content = Content::Joints { names: joints, turns: turning, has_velocities: has[1], derivatives };
        Ok(Self { format, content, names, slots, factors, time_unit: None })
    }

    /// The unit of the times: stated by the name or the format, or given, or plain from their size.
    fn set_time_unit(&mut self, first_row: &[&str], options: &ReferenceLogOptions) -> Checked<()> {
        let contradicts =
            |message: String| refuse(Refusal::UnitContradicted, message, "leave option `time_unit` away");
        match (options.time_unit, self.time_unit) {
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
        let column = self.slots.iter().position(|slot| *slot == Some(0));
        let first = column.and_then(|column| first_row.get(column)).and_then(|field| field.parse().ok());
        let of_format = match self.format {
            ReferenceFormat::Euroc => Some(TimeUnit::Nanosecond),
            ReferenceFormat::Tum | ReferenceFormat::Rtde => Some(TimeUnit::Second),
            _ => None,
        };
        self.time_unit = self.time_unit.or(options.time_unit).or_else(|| since_1970(first?)).or(of_format);
        Ok(())
    }

    /// How the rows are to be read.
    pub(super) fn layout(&self, delimiter: Delimiter) -> Layout {
        Layout {
            decimal_comma: false,
            delimiter,
            slots: self.slots.clone(),
            names: self.names.clone(),
            has_header: !self.names.is_empty(),
            ticks: self.time_unit != Some(TimeUnit::Second),
            text_times: false,
            only: None,
            may_be_invalid: 0..0,
        }
    }

    /// The names of the columns that are not used.
    pub(super) fn ignored(&self) -> Vec<String> {
        let unused = self.names.iter().zip(&self.slots).filter(|(_, slot)| slot.is_none());
        unused.map(|(name, _)| name.clone()).collect()
    }

    /// Name of the time column.
    pub(super) fn time_name(&self) -> String {
        let column = self.slots.iter().position(|slot| *slot == Some(0)).unwrap_or(0);
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

/// The time column and its unit: of several, the one whose unit is known.
fn time_column(names: &[String]) -> Checked<(usize, Option<TimeUnit>)> {
    let unit = |name: &String| {
        let column = imu_column(name);
        let unit = match column.unit {
            Some(ColumnUnit::Time(unit)) => Some(unit),
            _ => None,
        };
        (column.meaning == ColumnMeaning::Time).then_some(unit)
    };
    let times: Vec<_> = names.iter().enumerate().filter_map(|(k, name)| Some((k, unit(name)?))).collect();
    let known: Vec<_> = times.iter().copied().filter(|(_, unit)| unit.is_some()).collect();
    match (known.as_slice(), times.as_slice()) {
        ([one], _) | ([], [one]) => Ok(*one),
        (_, []) => {
            refuse(Refusal::ColumnMissing, "there is no column of times", "name it t_s (or t_ms, t_us, t_ns)")
        }
        (_, [(one, _), ..]) => {
            let (other, _) = times[times.len() - 1];
            Err(repeated("time", &names[*one], &names[other]).into())
        }
    }
}

/// An error where two columns have the same slot.
fn check_repeated(slots: &[Option<usize>], slot: usize, column: usize, names: &[String]) -> Checked<()> {
    match slots.iter().position(|taken| *taken == Some(slot)) {
        Some(other) => Err(repeated("same", &names[other], &names[column]).into()),
        None => Ok(()),
    }
}

fn repeated(what: &str, one: &str, other: &str) -> InputError {
    InputError::new(
        Refusal::ColumnRepeated,
        format!("two columns hold the {what}: `{one}` and `{other}`"),
        "rename one of them in the file",
    )
}

fn nothing_to_read(names: &[String]) -> InputError {
    let is_reading = |name: &String| matches!(imu_column(name).meaning, ColumnMeaning::Reading(..));
    if names.iter().any(is_reading) {
        return InputError::new(
            Refusal::FormatUnknown,
            "the columns are those of a recording of an IMU: there is no joint and no pose",
            EXAMPLES,
        );
    }
    if names.iter().any(|name| name.starts_with("target_q_")) {
        return InputError::new(
            Refusal::ColumnMissing,
            "the log holds where the joints should have been (target_q), not where they were",
            "record actual_q, too",
        );
    }
    let message =
        format!("no column is known to be of a joint or of a pose; the columns are {}", quoted(names, 20));
    InputError::new(Refusal::ColumnMissing, message, EXAMPLES)
}

fn without_header(columns: usize) -> InputError {
    let message = format!("{columns} column{} without a header", if columns == 1 { "" } else { "s" });
    InputError::new(Refusal::HeaderMissing, message, EXAMPLES)
}

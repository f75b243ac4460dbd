//! Where the values of a pose are among the columns: as the user says, or by their names.

use super::column_faults::{EXAMPLES, check_repeated, has_readings, named};
use super::content::{Content, Values};
use super::joint_columns::joint_column;
use super::log_columns::{AngleUnit, LengthUnit, LogColumns};
use super::options::ReferenceLogOptions;
use super::orientation_form::OrientationForm;
use super::pose_columns::{
    EulerNames, NAMES, PoseColumn, VALUES, angle_unit, euler_angles, length_unit, numbered_quaternion,
    pose_column, rotation_vector, tcp_pose,
};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::log::OrientationAssumed;
use calibrant_core::error::{InputError, Refusal};

/// The columns of an orientation.
struct Orientation {
    /// In the order of the form.
    columns: Vec<usize>,
    form: OrientationForm,
    /// May the names mean another thing?
    is_assumed: bool,
}

/// Where the values of poses are; `None` where the names are not of a pose.
pub(super) fn of_poses(names: &[String], options: &ReferenceLogOptions) -> Checked<Option<Values>> {
    let said = &options.columns;
    let is_said = said.position.is_some() || said.orientation.is_some();
    let found: Vec<_> = names.iter().map(|name| pose_column(name)).collect();
    let tcp = tcp_pose(names).filter(|_| !is_said);
    let orientation = match (&said.orientation, said.orientation_is) {
        (Some(columns), Some(form)) => {
            let columns = columns.iter().map(|name| named(names, name)).collect::<Checked<_>>()?;
            Some(Orientation { columns, form, is_assumed: false })
        }
        _ => match &tcp {
            Some(tcp) => {
                let columns = tcp[3..].to_vec();
                Some(Orientation { columns, form: OrientationForm::RotationVector, is_assumed: false })
            }
            None => by_names(names, &found, options)?,
        },
    };
    let position = match (&said.position, &tcp) {
        (Some(columns), _) => columns.iter().map(|name| named(names, name)).collect::<Checked<_>>()?,
        (None, Some(tcp)) => tcp[..3].to_vec(),
        (None, None) => position_by_names(names, &found, options, orientation.is_some() || is_said)?,
    };
    // three joints may be called x, y and z, and six have the names of rotations as well
    let is_of_joints = |column: &usize| {
        found[*column].is_none_or(|of| of.is_bare && of.value < 3) && joint_column(&names[*column]).is_some()
    };
    let all = || position.iter().chain(orientation.iter().flat_map(|of| &of.columns));
    if orientation.is_none()
        && !is_said
        && !has_readings(names)
        && let Some((usual, angles)) = euler_angles(names)
        && (!position.is_empty() || usual.is_plain)
        && (options.poses || !position.iter().chain(&angles).all(is_of_joints))
    {
        return Err(which_order(names, (usual, &angles)).into());
    }
    if all().next().is_none() || !options.poses && !is_said && all().all(is_of_joints) {
        return Ok(None);
    }
    let form = orientation.as_ref().map_or(OrientationForm::QuaternionWxyz, |of| of.form);
    let width = 3 + form.width();
    let (mut slots, mut factors) = (vec![None; names.len()], vec![1.0; width]);
    for (value, &column) in position.iter().enumerate() {
        check_repeated(&slots, 1 + value, column, names)?;
        slots[column] = Some(1 + value);
        factors[value] = length(&names[column], said.position_unit)?.factor();
    }
    let mut assumed = None;
    if let Some(Orientation { columns, is_assumed, .. }) = orientation {
        for (value, &column) in (3..).zip(&columns) {
            slots[column] = Some(1 + value);
            if form.has_unit() {
                factors[value] = angle(&names[column], form, said)?.factor();
            }
        }
        if is_assumed {
            let columns = columns.iter().map(|column| names[*column].trim().to_owned()).collect();
            assumed = Some(OrientationAssumed { columns, form: form.to_string() }.into());
        }
    }
    Ok(Some(Values { content: Content::Poses(form), slots, factors, assumed }))
}

/// The orientation whose names are known.
fn by_names(
    names: &[String],
    found: &[Option<PoseColumn>],
    options: &ReferenceLogOptions,
) -> Checked<Option<Orientation>> {
    let is_said = options.columns.orientation_is;
    if (3..VALUES).any(|value| column_of(found, value).is_some()) {
        let columns = all_of(found, 3..VALUES, "orientation", names)?;
        return Ok(Some(Orientation { columns, form: OrientationForm::QuaternionWxyz, is_assumed: false }));
    }
    let has_position =
        options.columns.position.is_some() || (0..3).all(|value| column_of(found, value).is_some());
    if has_readings(names) {
        return Ok(None);
    }
    let quaternion = numbered_quaternion(names).filter(|(first, _)| *first == 0 || has_position);
    let vector = rotation_vector(names).filter(|(_, is_short)| !is_short || has_position || options.poses);
    let (columns, usual, may_differ) = match (quaternion, vector) {
        (Some((_, columns)), _) => (columns, OrientationForm::QuaternionWxyz, true),
        (None, Some((columns, may_differ))) => (columns, OrientationForm::RotationVector, may_differ),
        (None, None) => return Ok(None),
    };
    match is_said {
        Some(form) if form.width() == usual.width() => {
            Ok(Some(Orientation { columns, form, is_assumed: false }))
        }
        Some(form) => {
            let message = format!("the columns of \"{form}\" are not known by their names");
            refuse(
                Refusal::ColumnMissing,
                message,
                "name them: orientation = [\"…\", \"…\"] in [machine.log.columns]",
            )
        }
        None => Ok(Some(Orientation { columns, form: usual, is_assumed: may_differ })),
    }
}

/// The columns of a position; none where there is none.
fn position_by_names(
    names: &[String],
    found: &[Option<PoseColumn>],
    options: &ReferenceLogOptions,
    is_pose: bool,
) -> Checked<Vec<usize>> {
    let has = |value: usize| column_of(found, value).is_some();
    let has_long = |value: usize| found.iter().flatten().any(|of| of.value == value && !of.is_bare);
    let may_be_bare = options.poses || euler_angles(names).is_some();
    if !is_pose && !(0..3).all(|value| has_long(value) || may_be_bare && has(value)) {
        return Ok(Vec::new());
    }
    match (0..3).any(has) {
        true => all_of(found, 0..3, "position", names),
        false => Ok(Vec::new()),
    }
}

fn column_of(found: &[Option<PoseColumn>], value: usize) -> Option<usize> {
    found.iter().position(|of| of.is_some_and(|of| of.value == value))
}

/// The columns of these values, each of which must be there once.
fn all_of(
    found: &[Option<PoseColumn>],
    values: std::ops::Range<usize>,
    what: &str,
    names: &[String],
) -> Checked<Vec<usize>> {
    let missing: Vec<&str> =
        values.clone().filter(|&value| column_of(found, value).is_none()).map(|value| NAMES[value]).collect();
    if !missing.is_empty() {
        let message = format!("the {what} has no column for {}", missing.join(", "));
        return refuse(Refusal::ColumnMissing, message, EXAMPLES);
    }
    let slots: Vec<_> = found.iter().map(|of| of.map(|of| of.value)).collect();
    for (column, slot) in
        slots.iter().enumerate().filter(|(_, slot)| slot.is_some_and(|of| values.contains(&of)))
    {
        check_repeated(&slots[..column], slot.unwrap_or(0), column, names)?;
    }
    Ok(values.filter_map(|value| column_of(found, value)).collect())
}

/// The unit of a position: of its name, or as it is said, or m.
fn length(name: &str, said: Option<LengthUnit>) -> Checked<LengthUnit> {
    match (length_unit(name), said) {
        (Some(unit), Some(said)) if unit != said => contradicts(name, "position_unit"),
        (unit, said) => Ok(unit.or(said).unwrap_or(LengthUnit::M)),
    }
}

/// The unit of an angle: of its name, or as it is said, or rad of a rotation vector.
fn angle(name: &str, form: OrientationForm, said: &LogColumns) -> Checked<AngleUnit> {
    match (angle_unit(name), said.orientation_unit) {
        (Some(unit), Some(said)) if unit != said => contradicts(name, "orientation_unit"),
        (None, None) if form != OrientationForm::RotationVector => {
            let message = format!("nothing says the unit of the angle `{name}`");
            let help = "orientation_unit = \"deg\" (or \"rad\") in [machine.log.columns]";
            refuse(Refusal::UnitUnknown, message, help)
        }
        (unit, said) => Ok(unit.or(said).unwrap_or(AngleUnit::Rad)),
    }
}

fn contradicts<T>(name: &str, key: &str) -> Checked<T> {
    let message = format!("the name of the column `{name}` states another unit than {key}");
    refuse(Refusal::UnitContradicted, message, format!("take {key} out of [machine.log.columns]"))
}

/// The error about angles whose order nothing says, with the lines that say it.
fn which_order(names: &[String], (usual, angles): (&EulerNames, &[usize])) -> InputError {
    let plain: Vec<&str> = angles.iter().map(|column| names[*column].trim()).collect();
    let unit = match angle_unit(plain[0]) {
        Some(_) => "",
        None => " and orientation_unit = \"deg\" (or \"rad\")",
    };
    let message = format!("the order of the turns {} is not known", plain.join(", "));
    let help = format!(
        "add to [machine.log.columns]: orientation = [\"{}\"] and orientation_is = \"{}\" ({}; or another order){unit}",
        plain.join("\", \""),
        usual.form,
        usual.of
    );
    InputError::new(Refusal::FormatUnknown, message, help)
}

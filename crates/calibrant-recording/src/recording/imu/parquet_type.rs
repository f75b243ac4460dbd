//! What the type of a Parquet column says of its numbers: the digits after the point, the sign, the unit of a time.
//!
//! Files state it by a logical type; older files by a converted type. Spark writes times in the physical type INT96.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names;
use super::unit::ColumnUnit;
use crate::files::parquet_decimal::{big_endian, decimal};
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;
use parquet::basic::{ConvertedType, LogicalType, TimeUnit as StatedUnit, Type};
use parquet::schema::types::ColumnDescriptor;

/// How the whole numbers of a column are stored.
#[derive(Clone, Copy)]
pub(super) struct Whole {
    /// Digits after the point of a decimal number; `None` for any other.
    pub(super) scale: Option<i32>,
    is_unsigned: bool,
}

impl Whole {
    pub(super) fn of(column: &ColumnDescriptor) -> Self {
        let (mut scale, mut is_unsigned) = (None, false);
        match (column.logical_type_ref(), column.converted_type()) {
            (Some(LogicalType::Decimal(of)), _) => scale = Some(of.scale),
            (Some(LogicalType::Integer(of)), _) => is_unsigned = !of.is_signed,
            (None, ConvertedType::DECIMAL) => scale = Some(column.type_scale()),
            (
                None,
                ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64,
            ) => is_unsigned = true,
            _ => (),
        }
        Self { scale, is_unsigned }
    }

    pub(super) fn of_i32(self, value: i32) -> i128 {
        if self.is_unsigned { i128::from(value.cast_unsigned()) } else { i128::from(value) }
    }

    pub(super) fn of_i64(self, value: i64) -> i128 {
        if self.is_unsigned { i128::from(value.cast_unsigned()) } else { i128::from(value) }
    }

    /// The number of a whole one.
    pub(super) fn number(self, whole: i128) -> f64 {
        self.scale.map_or(whole as f64, |scale| decimal(whole, scale))
    }

    /// The number of the bytes of a decimal; infinite where it is too large for any reading.
    pub(super) fn of_bytes(self, bytes: &[u8]) -> f64 {
        big_endian(bytes).map_or(f64::INFINITY, |whole| self.number(whole))
    }
}

/// The unit of a time that the type states, and whether it begins anew at midnight.
pub(super) fn time(column: &ColumnDescriptor) -> Option<(TimeUnit, bool)> {
    let unit = |stated: &StatedUnit| match stated {
        StatedUnit::MILLIS => TimeUnit::Millisecond,
        StatedUnit::MICROS => TimeUnit::Microsecond,
        StatedUnit::NANOS => TimeUnit::Nanosecond,
    };
    Some(match (column.logical_type_ref(), column.converted_type()) {
        (Some(LogicalType::Timestamp(of)), _) => (unit(&of.unit), false),
        (Some(LogicalType::Time(of)), _) => (unit(&of.unit), true),
        (None, ConvertedType::TIMESTAMP_MILLIS) => (TimeUnit::Millisecond, false),
        (None, ConvertedType::TIMESTAMP_MICROS) => (TimeUnit::Microsecond, false),
        (None, ConvertedType::TIME_MILLIS) => (TimeUnit::Millisecond, true),
        (None, ConvertedType::TIME_MICROS) => (TimeUnit::Microsecond, true),
        _ if column.physical_type() == Type::INT96 => (TimeUnit::Nanosecond, false),
        _ => return None,
    })
}

/// A column: its name as in CSV, and the unit of a time from its type.
pub(super) fn describe(column: &ColumnDescriptor) -> ImuColumn {
    let name = column.path().string();
    let unused = |why: &str| {
        let mut described = ImuColumn::new(&name, ColumnMeaning::Other, None);
        described.unused = Some(why.into());
        described
    };
    if column.max_rep_level() > 0 {
        return unused(LIST);
    }
    let is_date = column.logical_type_ref() == Some(&LogicalType::Date)
        || column.converted_type() == ConvertedType::DATE;
    if is_date {
        return unused("a date, without a time of day");
    }
    let mut described = column_names::column(&name);
    let Some((unit, is_of_day)) = time(column) else { return described };
    // a time stamp is a time whatever its name
    described.unit = Some(ColumnUnit::Time(unit));
    if described.meaning == ColumnMeaning::Other {
        let meaning = if is_of_day { ColumnMeaning::Clock } else { ColumnMeaning::Time };
        described = ImuColumn::new(&name, meaning, described.unit);
    }
    described
}

/// Why a column of lists is not used.
pub(super) const LIST: &str = "a list, not a number for each row";

/// An error for a column whose type holds no numbers, or too coarse ones.
pub(super) fn check_numbers(column: &ColumnDescriptor, is_time: bool) -> Checked<()> {
    let name = column.path().string();
    let is_bytes = [Type::BYTE_ARRAY, Type::FIXED_LEN_BYTE_ARRAY].contains(&column.physical_type());
    let is_text = column.logical_type_ref() == Some(&LogicalType::String)
        || column.converted_type() == ConvertedType::UTF8;
    let (what, help) = if column.max_rep_level() > 0 {
        (LIST, "write a column for each axis".to_owned())
    } else if column.logical_type_ref() == Some(&LogicalType::Float16) {
        let help = "write it as float or double from where it has all its digits";
        ("numbers of half precision, float16: they have three digits", help.to_owned())
    } else if is_text {
        let sql = if is_time { "TIMESTAMP" } else { "DOUBLE" };
        (
            "text, not numbers",
            format!("write numbers: in SQL, CAST(\"{name}\" AS {sql}); is it the right column?"),
        )
    } else if column.physical_type() == Type::BOOLEAN || is_bytes && Whole::of(column).scale.is_none() {
        ("no numbers", "is it the right column? numbers are float, double, whole or decimal".to_owned())
    } else {
        return Ok(());
    };
    refuse(Refusal::NumberMalformed, format!("column `{name}` holds {what}"), help)
}

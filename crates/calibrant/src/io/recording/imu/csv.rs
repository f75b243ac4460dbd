//! Delimited text whose header says what is what, or whose columns `[columns]` names.

use super::column::{ColumnMeaning, ImuColumn};
use super::draft::Draft;
use super::format::FileFormat;
use super::head::Head;
use super::naming;

pub(super) fn draft(head: &Head<'_>) -> Draft {
    let columns = if head.names.is_empty() {
        let other = |column: usize| ImuColumn::new(&(column + 1).to_string(), ColumnMeaning::Other, None);
        (0..head.fields()).map(other).collect()
    } else {
        head.names.iter().map(|name| naming::column(name)).collect()
    };
    Draft::new(FileFormat::Csv, columns)
}

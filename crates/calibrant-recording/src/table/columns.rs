//! The columns of a table.

use std::borrow::Cow;

/// Columns of equal length.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What its rows are, as Parquet names them.
    pub name: &'static str,
    /// The columns, in their order.
    pub columns: Vec<TableColumn>,
}

/// A column. The unit of its numbers ends its name.
#[derive(Debug, Clone, PartialEq)]
pub struct TableColumn {
    /// Its name.
    pub name: String,
    /// An entry for each row.
    pub values: ColumnValues,
}

/// The entries of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValues {
    /// Whole numbers; none is missing.
    Whole(Vec<i64>),
    /// Numbers; one that is not a number is missing.
    Numbers(Vec<f64>),
    /// Texts, which may be missing.
    Texts(Vec<Option<Cow<'static, str>>>),
}

impl TableColumn {
    /// A column of numbers.
    #[must_use]
    pub fn numbers(name: impl Into<String>, numbers: Vec<f64>) -> Self {
        Self { name: name.into(), values: ColumnValues::Numbers(numbers) }
    }

    /// A column of texts.
    #[must_use]
    pub fn texts(name: impl Into<String>, texts: Vec<Option<Cow<'static, str>>>) -> Self {
        Self { name: name.into(), values: ColumnValues::Texts(texts) }
    }
}

impl ColumnValues {
    /// The number of rows.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Whole(numbers) => numbers.len(),
            Self::Numbers(numbers) => numbers.len(),
            Self::Texts(texts) => texts.len(),
        }
    }
}

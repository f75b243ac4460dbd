//! Reads Parquet with the crate `parquet`, which may panic on a damaged file.

use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{InputError, Refusal};
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Does this thread read a file, so that a panic becomes an error?
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// The error for a file that cannot be read.
pub fn damaged(error: &ParquetError) -> InputError {
    InputError::new(
        Refusal::FileDamaged,
        format!("the Parquet file is damaged: {error}"),
        "was it written to its end?",
    )
}

/// Refuses a part of a column that nothing here unpacks.
pub fn check_compression(column: &ColumnChunkMetaData) -> Checked<()> {
    let found = match column.compression() {
        Compression::BROTLI(_) => "brotli",
        Compression::LZO => "LZO",
        _ => return Ok(()),
    };
    let name = column.column_path().string();
    refuse(
        Refusal::FormatUnsupported,
        format!("column `{name}` is compressed with {found}, which is not read"),
        "write the file again with zstd, snappy or no compression",
    )
}

/// A damaged file must not end the program, even where the crate that reads it panics; nor does the panic print anything.
pub fn guarded<T>(read: impl FnOnce() -> Checked<T>) -> Checked<T> {
    static HOOKED: Once = Once::new();
    HOOKED.call_once(|| {
        let others = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                others(panic)
            }
        }));
    });
    IS_GUARDED.set(true);
    let read = catch_unwind(AssertUnwindSafe(read));
    IS_GUARDED.set(false);
    read.unwrap_or_else(|_| {
        refuse(Refusal::FileDamaged, "the Parquet file is damaged", "was it written to its end?")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    thread_local! {
        static PRINTED: Cell<usize> = const { Cell::new(0) };
    }

    #[test]
    fn a_panic_that_becomes_an_error_is_not_printed_and_others_are() {
        set_hook(Box::new(|_| PRINTED.set(PRINTED.get() + 1)));
        let error = guarded::<()>(|| panic!("the crate that reads")).expect_err("damaged");
        assert_eq!((error.code, PRINTED.get()), (Refusal::FileDamaged, 0));
        assert!(catch_unwind(|| panic!("another")).is_err());
        assert_eq!(PRINTED.get(), 1);
    }
}

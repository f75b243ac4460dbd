//! A guard on pages of a Parquet file: a page may not promise more values than it has bytes for. The decoding
//! crate would reserve room for all that are promised.

use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

/// The pages of a column. Dictionaries are checked before they are decoded.
pub(super) struct Pages {
    pub(super) pages: Box<dyn PageReader>,
    /// The fewest bytes that a value takes.
    pub(super) least: usize,
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        match &page {
            Some(Page::DictionaryPage { buf, num_values, .. })
                if *num_values as usize > buf.len() / self.least =>
            {
                let (values, bytes) = (num_values, buf.len());
                Err(ParquetError::General(format!("a dictionary of {values} values has {bytes} bytes")))
            }
            _ => Ok(page),
        }
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }

    fn at_record_boundary(&mut self) -> Result<bool> {
        self.pages.at_record_boundary()
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

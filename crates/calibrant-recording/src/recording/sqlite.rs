//! Reads the tables of an SQLite database from its bytes: enough for bags, and a fraction of what SQLite itself takes to compile.
//!
//! A table is a tree of pages, which are counted from 1. Numbers are big-endian; a varint has seven bits in a byte.
//!
//! ```text
//! page     kind u8 (5 inner, 13 leaf), 2, number of cells u16, 2, 1, inner: last child u32; places of the cells u16
//! cell     inner: child u32, row varint; leaf: length varint, row varint, record, what is too long: next page u32
//! record   length of the head varint, types varint, values
//! ```
//! The first page has the head of the file, 100 bytes, before its own, and is the root of the table of tables.

use crate::text::decoding::Checked;
use calibrant_core::error::InputError;
use std::borrow::Cow;
use std::cell::Cell;

/// Bytes of the head of the file.
const HEAD: usize = 100;
/// Levels of a tree, at most.
const DEEPEST: usize = 32;

type Read<T> = Result<T, &'static str>;

const SHORT: &str = "it ends too early";

/// A database.
pub(super) struct Database<'b> {
    bytes: &'b [u8],
    page_size: usize,
    /// Bytes of a page without those that are reserved at its end.
    usable: usize,
    /// Bytes of the rows that do not fit into their page, so far. Each page belongs to one row.
    of_long_rows: Cell<usize>,
    /// May changes be in a file of their own, a write-ahead log?
    pub(super) has_log: bool,
}

/// A table.
pub(super) struct Table {
    pub(super) name: String,
    root: usize,
    columns: Vec<String>,
}

impl Table {
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

/// A value in a row.
pub(super) enum Value<'r> {
    Null,
    Integer(i64),
    Bytes(&'r [u8]),
}

impl Value<'_> {
    pub(super) fn integer(&self) -> Option<i64> {
        match self {
            Self::Integer(number) => Some(*number),
            _ => None,
        }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        match self {
            Self::Bytes(bytes) => bytes,
            _ => &[],
        }
    }

    /// A text; nothing of one that is not UTF-8.
    pub(super) fn text(&self) -> &str {
        str::from_utf8(self.bytes()).unwrap_or_default()
    }
}

impl<'b> Database<'b> {
    pub(super) fn open(bytes: &'b [u8]) -> Read<Self> {
        let head: &[u8; HEAD] = bytes.first_chunk().ok_or(SHORT)?;
        let page_size = match u16::from_be_bytes([head[16], head[17]]) {
            1 => 1 << 16,
            size => usize::from(size),
        };
        let usable = page_size.saturating_sub(head[20].into());
        if !page_size.is_power_of_two() || usable < 480 {
            return Err("its pages have no size that SQLite has");
        }
        Ok(Self { bytes, page_size, usable, of_long_rows: Cell::new(0), has_log: head[18] == 2 })
    }

    /// The tables, as the table of tables has them: its columns are type, name, name of the table, root and the text that made it.
    pub(super) fn tables(&self) -> Read<Vec<Table>> {
        let mut tables = Vec::new();
        let root = Table { name: String::new(), root: 1, columns: Vec::new() };
        self.walk(&root, |_, row| {
            if let [kind, name, _, root, made] = row
                && kind.text() == "table"
            {
                let root = root.integer().and_then(|root| usize::try_from(root).ok()).unwrap_or(0);
                tables.push(Table { name: name.text().to_owned(), root, columns: columns(made.text()) });
            }
            Ok(Ok(()))
        })??;
        Ok(tables)
    }

    /// Takes the rows of a table in their order, each with its number; `damaged` makes an error of what is wrong with the database.
    pub(super) fn rows(
        &self,
        table: &Table,
        damaged: impl Fn(&'static str) -> InputError,
        take: impl FnMut(i64, &[Value<'_>]) -> Checked<()>,
    ) -> Checked<()> {
        let mut take = take;
        self.walk(table, |number, row| Ok(take(number, row))).map_err(damaged)?
    }

    fn walk<E>(
        &self,
        table: &Table,
        mut take: impl FnMut(i64, &[Value<'_>]) -> Read<Result<(), E>>,
    ) -> Read<Result<(), E>> {
        // pages with the next of their cells
        let mut path = vec![(table.root, 0)];
        self.of_long_rows.set(0);
        let mut visited = 0;
        while let Some((number, cell)) = path.pop() {
            let (page, start) = self.page(number)?;
            let (kind, cells) =
                (page[start], usize::from(u16::from_be_bytes([page[start + 3], page[start + 4]])));
            let content = |head: usize, cell: usize| {
                let at = start + head + 2 * cell;
                let place = page.get(at..at + 2).ok_or(SHORT)?;
                page.get(usize::from(u16::from_be_bytes([place[0], place[1]]))..).ok_or(SHORT)
            };
            match kind {
                13 => {
                    for cell in 0..cells {
                        let (row, record) = self.record(content(8, cell)?)?;
                        if let Err(error) = take(row, &values(&record)?)? {
                            return Ok(Err(error));
                        }
                    }
                }
                5 => {
                    let child = match cell < cells {
                        true => content(12, cell)?.first_chunk(),
                        false => page[start + 8..].first_chunk(),
                    };
                    if cell < cells {
                        path.push((number, cell + 1));
                    }
                    path.push((u32::from_be_bytes(*child.ok_or(SHORT)?) as usize, 0));
                    visited += 1;
                }
                _ => return Err("a page is of no kind that a table has"),
            }
            if path.len() > DEEPEST || visited > self.bytes.len() / self.page_size {
                return Err("its pages form a circle");
            }
        }
        Ok(Ok(()))
    }

    /// A page, and where its own head begins.
    fn page(&self, number: usize) -> Read<(&'b [u8], usize)> {
        let begin = number
            .checked_sub(1)
            .and_then(|before| before.checked_mul(self.page_size))
            .ok_or("a page has the number 0")?;
        let page = self.bytes.get(begin..).and_then(|rest| rest.get(..self.page_size)).ok_or(SHORT)?;
        Ok((page, if number == 1 { HEAD } else { 0 }))
    }

    /// The number of a row and its record, from its cell.
    fn record(&self, cell: &'b [u8]) -> Read<(i64, Cow<'b, [u8]>)> {
        let mut rest = cell;
        let length = usize::try_from(varint(&mut rest)?).map_err(|_| SHORT)?;
        let row = varint(&mut rest)?;
        let most = self.usable - 35;
        if length <= most {
            return Ok((row, Cow::Borrowed(rest.get(..length).ok_or(SHORT)?)));
        }
        self.of_long_rows.set(self.of_long_rows.get().saturating_add(length));
        if self.of_long_rows.get() > self.bytes.len() {
            return Err("its rows are longer than the file");
        }
        let least = (self.usable - 12) * 32 / 255 - 23;
        let here = least + (length - least) % (self.usable - 4);
        let here = if here <= most { here } else { least };
        let (begin, rest) = rest.split_at_checked(here).ok_or(SHORT)?;
        let mut record = begin.to_vec();
        let mut next = rest.first_chunk().ok_or(SHORT)?;
        while record.len() < length {
            let (page, _) = self.page(u32::from_be_bytes(*next) as usize)?;
            let (following, content) = page[..self.usable].split_first_chunk().ok_or(SHORT)?;
            record.extend(&content[..content.len().min(length - record.len())]);
            next = following;
        }
        Ok((row, Cow::Owned(record)))
    }
}

/// The values of a record.
fn values(record: &[u8]) -> Read<Vec<Value<'_>>> {
    let mut head = record;
    let length = usize::try_from(varint(&mut head)?).map_err(|_| SHORT)?;
    let mut body = record.get(length..).ok_or(SHORT)?;
    let mut types = head.get(..length - (record.len() - head.len()).min(length)).ok_or(SHORT)?;
    let mut values = Vec::new();
    while !types.is_empty() {
        let kind = varint(&mut types)?;
        let size = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            12.. => usize::try_from((kind - 12) / 2).map_err(|_| SHORT)?,
            _ => return Err("a value is of no type that SQLite has"),
        };
        let (value, rest) = body.split_at_checked(size).ok_or(SHORT)?;
        body = rest;
        values.push(match kind {
            1..=6 => {
                let sign = if value[0] >= 0x80 { -1 } else { 0 };
                Value::Integer(value.iter().fold(sign, |number, byte| number << 8 | i64::from(*byte)))
            }
            8 | 9 => Value::Integer(kind - 8),
            12.. => Value::Bytes(value),
            // nothing here needs a number with a point
            _ => Value::Null,
        });
    }
    Ok(values)
}

fn varint(bytes: &mut &[u8]) -> Read<i64> {
    let mut number = 0_i64;
    for k in 0..9 {
        let (&byte, rest) = bytes.split_first().ok_or(SHORT)?;
        *bytes = rest;
        if k == 8 {
            return Ok(number << 8 | i64::from(byte));
        }
        number = number << 7 | i64::from(byte & 0x7f);
        if byte < 0x80 {
            break;
        }
    }
    Ok(number)
}

/// The names of the columns in `CREATE TABLE name(id INTEGER PRIMARY KEY, …)`.
fn columns(made: &str) -> Vec<String> {
    let list = made.split_once('(').map_or("", |(_, list)| list);
    let name = |column: &str| {
        let name = column.split_whitespace().next().unwrap_or_default();
        name.trim_matches(|c| "\"'`[]".contains(c)).to_owned()
    };
    list.split(',').map(name).collect()
}

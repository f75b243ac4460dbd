//! JSON for people and programs: indented, but with rows of numbers on one line.

use calibrant_core::error::{InputError, Refusal, Result};
use calibrant_recording::files::atomic_output::write_atomically;
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};
use std::path::Path;

/// The version of all JSON files. Added fields do not change it.
pub const SCHEMA: u32 = 2;

/// Writes a value as a JSON file. It is deterministic: fields in their order, numbers with the fewest digits
/// that read back to the same bits, no time of day. A value that is not a number is `null`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    write_atomically(path, |out| {
        value.serialize(&mut Serializer::with_formatter(&mut *out, Rows::default()))?;
        writeln!(out)
    })
}

/// The text that [`write_json`] writes.
#[must_use]
pub fn to_json(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    // writing into memory does not fail, and no map here has keys that are not strings
    if value.serialize(&mut Serializer::with_formatter(&mut out, Rows::default())).is_err() {
        return String::new();
    }
    out.push(b'\n');
    String::from_utf8(out).unwrap_or_default()
}

/// The error for serde's message on a file that should be `what`. The place moves from the end of its text to
/// the front.
pub(crate) fn broken(error: &serde_json::Error, what: &str, help: &str) -> InputError {
    let message = error.to_string();
    let message = message.split(" at line ").next().unwrap_or_default();
    let found = if error.is_data() { format!("not {what}") } else { "not valid JSON".into() };
    let input_error = InputError::new(Refusal::SyntaxInvalid, format!("{found}: {message}"), help);
    if error.line() > 0 {
        input_error.at_line(error.line()).at_column(error.column().max(1))
    } else {
        input_error
    }
}

/// Objects, and arrays of objects or arrays, take a line for each entry; arrays of scalars take one line.
///
/// The kind of an array's entry is known only when the entry begins, so the separator before it waits until
/// then.
#[derive(Default)]
struct Rows {
    depth: usize,
    /// A separator before the next value of an array: `Some(first)`.
    pending: Option<bool>,
    /// For each open array or object: does it have entries on lines of their own?
    open: Vec<bool>,
}

impl Rows {
    fn indent<W: ?Sized + Write>(&self, out: &mut W) -> io::Result<()> {
        out.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| out.write_all(b"  "))
    }

    fn before_scalar<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        match self.pending.take() {
            Some(false) => out.write_all(b", "),
            _ => Ok(()),
        }
    }

    fn before_nested<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        let Some(first) = self.pending.take() else { return Ok(()) };
        if !first {
            out.write_all(b",")?;
        }
        if let Some(lines) = self.open.last_mut() {
            *lines = true;
        }
        self.indent(out)
    }

    fn begin<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.before_nested(out)?;
        self.open.push(false);
        self.depth += 1;
        out.write_all(bracket)
    }

    fn end<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.pending = None;
        self.depth = self.depth.saturating_sub(1);
        if self.open.pop() == Some(true) {
            self.indent(out)?;
        }
        out.write_all(bracket)
    }
}

macro_rules! scalars {
    ($($method:ident($kind:ty) = $text:expr;)*) => {$(
        fn $method<W: ?Sized + Write>(&mut self, out: &mut W, value: $kind) -> io::Result<()> {
            self.before_scalar(out)?;
            let text: fn($kind) -> String = $text;
            out.write_all(text(value).as_bytes())
        }
    )*};
}

impl Formatter for Rows {
    scalars! {
        write_bool(bool) = |value| value.to_string();
        write_i64(i64) = |value| value.to_string();
        write_u64(u64) = |value| value.to_string();
        write_f64(f64) = |value| format!("{value:?}");
    }

    fn write_null<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.before_scalar(out)?;
        out.write_all(b"null")
    }

    fn begin_string<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.before_scalar(out)?;
        out.write_all(b"\"")
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.end(out, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, _: &mut W, first: bool) -> io::Result<()> {
        self.pending = Some(first);
        Ok(())
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.begin(out, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.end(out, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        if let Some(lines) = self.open.last_mut() {
            *lines = true;
        }
        self.indent(out)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Example {
        name: &'static str,
        row: Vec<f64>,
        table: Vec<[f64; 2]>,
        list: Vec<Option<f64>>,
        words: Vec<&'static str>,
        nested: Vec<Inner>,
        nothing: Vec<f64>,
    }

    #[derive(Serialize)]
    struct Inner {
        count: usize,
        yes: bool,
    }

    #[test]
    fn numbers_stay_on_one_line_and_what_is_none_is_null() {
        let value = Example {
            name: "a \"b\"\n",
            row: vec![1.0, 1e-7, -0.5, f64::NAN],
            table: vec![[1.0, 2.0], [3.0, 4.0]],
            list: vec![None, Some(2.0)],
            words: vec!["x", "y"],
            nested: vec![Inner { count: 3, yes: true }, Inner { count: 4, yes: false }],
            nothing: vec![],
        };
        let expected = r#"{
  "name": "a \"b\"\n",
  "row": [1.0, 1e-7, -0.5, null],
  "table": [
    [1.0, 2.0],
    [3.0, 4.0]
  ],
  "list": [null, 2.0],
  "words": ["x", "y"],
  "nested": [
    {
      "count": 3,
      "yes": true
    },
    {
      "count": 4,
      "yes": false
    }
  ],
  "nothing": []
}
"#;
        assert_eq!(to_json(&value), expected);
        assert!(serde_json::from_str::<serde_json::Value>(expected).is_ok());
    }
}

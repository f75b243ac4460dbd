//! Decodes the bytes of a file to text: size, encoding and binary content, each with an error that names the
//! file's real kind.

use crate::files::standard_input::open_input;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The result of a check. Its error does not yet know whether an experiment or a recording is at fault.
pub type Checked<T> = std::result::Result<T, Box<InputError>>;

/// The error about an input, without a place.
pub fn refuse<T>(code: Refusal, message: impl Into<String>, help: impl Into<String>) -> Checked<T> {
    Err(InputError::new(code, message, help).into())
}

/// The error where this build lacks a reader.
#[cfg(any(test, not(all(feature = "mcap", feature = "parquet"))))]
pub fn without<T>(feature: &str) -> Checked<T> {
    let files = if feature == "mcap" { "bags of ROS (MCAP, .db3, .bag)" } else { "Parquet" };
    let message = format!("this build of calibrant does not read {files}");
    refuse(Refusal::FormatUnsupported, message, install_with(feature))
}

/// The remedy where this build lacks what a feature adds.
#[must_use]
pub fn install_with(feature: &str) -> String {
    format!(
        "build it with the feature `{feature}`: in its sources, cargo install --locked --path crates/calibrant-cli --features {feature}"
    )
}

/// Reads a file whole, unless it is larger than `limit` bytes or plainly binary.
///
/// It reads in pieces and looks for NUL bytes, so that a device or a disk image does not fill the memory.
pub fn read_bytes(path: &Path, limit: u64, what: &str) -> Checked<Vec<u8>> {
    /// Bytes that are read at once.
    const PIECE: u64 = 1 << 20;
    let in_file = |input_error: InputError| Box::new(input_error.in_file(path));
    let mut file = open_file(path, what)?;
    // the length that a file states is not trusted far
    let expected = file.metadata().map_or(0, |metadata| metadata.len()).min(64 * PIECE);
    let mut bytes = Vec::with_capacity(expected as usize + 1);
    loop {
        let before = bytes.len();
        let read = file.by_ref().take(PIECE).read_to_end(&mut bytes);
        read.map_err(|error| in_file(unreadable(what, &error)))?;
        if bytes.len() == before {
            return Ok(bytes);
        }
        if bytes.len() as u64 > limit {
            return Err(in_file(too_large(what, limit)));
        }
        if bytes[before..].contains(&0) {
            as_text(&bytes).map_err(|input_error| input_error.in_file(path))?;
        }
    }
}

/// The text of a file of at most `limit` bytes. `what` names its content in errors.
///
/// # Errors
/// It cannot be read, is too large, or is no text.
pub fn read_text(path: &Path, limit: u64, what: &str) -> Checked<String> {
    let bytes = read_bytes(path, limit, what)?;
    let text = as_text(&bytes).map_err(|error| error.in_file(path))?;
    Ok(text.to_owned())
}

/// What `parse` makes of a file of at most `limit` bytes; an error names the file. `what` names its content in errors.
pub fn parsed<T>(
    path: &Path,
    (limit, what): (u64, &str),
    parse: impl FnOnce(&[u8]) -> Checked<T>,
) -> Result<T> {
    let read = read_bytes(path, limit, what).and_then(|bytes| parse(&bytes));
    read.map_err(|error| Error::experiment(error.in_file(path)))
}

/// Opens a file to be read; `-` is standard input. `what` names its content in the error.
///
/// # Errors
/// It cannot be read, or is a directory.
pub fn open_file(path: &Path, what: &str) -> Checked<File> {
    let input_error = if path.is_dir() {
        InputError::new(
            Refusal::FileUnreadable,
            format!("this is a directory, not {what}"),
            "name a file in it",
        )
    } else {
        match open_input(path) {
            Ok(file) => return Ok(file),
            Err(error) => unreadable(what, &error),
        }
    };
    Err(input_error.in_file(path).into())
}

pub fn unreadable(what: &str, error: &std::io::Error) -> InputError {
    let help = match error.kind() {
        std::io::ErrorKind::NotFound => "check the name and the working directory",
        std::io::ErrorKind::PermissionDenied => "check who may read it",
        _ => "check the file and its disk",
    };
    InputError::new(Refusal::FileUnreadable, format!("cannot read {what}: {error}"), help)
}

pub fn too_large(what: &str, limit: u64) -> InputError {
    InputError::new(
        Refusal::FileUnreadable,
        format!("{what} is larger than {} MiB", limit >> 20),
        "this is hardly the file that you mean",
    )
}

/// The bytes as text, without the byte order mark.
pub fn as_text(bytes: &[u8]) -> Checked<&str> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return refuse(
            Refusal::EncodingUnknown,
            "the text is encoded in UTF-16",
            "save it as UTF-8 (or plain ASCII)",
        );
    }
    if bytes.starts_with(b"H Product:Blackbox") {
        return refuse(
            Refusal::FormatUnsupported,
            "this is a blackbox log of Betaflight or INAV, which is not read",
            "decode it: `blackbox_decode FILE`, and give the .csv",
        );
    }
    // the second byte of a text may be a P, but its first is no control character
    if let [block, b'P', ..] = bytes
        && (1..9).contains(block)
    {
        return refuse(
            Refusal::FormatUnsupported,
            "this is a C3D file of motion capture, which is not read",
            "save its analog channels as CSV: in Python `pandas.DataFrame(ezc3d.c3d('FILE')['data']['analogs'][0].T, columns=[…]).to_csv('log.csv', index=False)`",
        );
    }
    if let Some((version, array)) = of_matlab(bytes) {
        return refuse(
            Refusal::FormatUnsupported,
            format!("this is a binary file of MATLAB ({version}), which is not read"),
            format!(
                "save its table as CSV: in MATLAB `writetable(T, 'log.csv')`; in Python `pandas.DataFrame({array}, columns=[…]).to_csv('log.csv', index=False)`"
            ),
        );
    }
    if let Some((program, unpack)) = packed_by(bytes) {
        let message = format!("this file is compressed with {program}");
        return refuse(Refusal::EncodingUnknown, message, format!("unpack it first: {unpack}"));
    }
    let text = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    as_text_at(text, (bytes.len() - text.len()) as u64, 0)
}

/// The version of a binary file of MATLAB, from its beginning, and how Python gets an array of it.
fn of_matlab(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let is = |signature: &[u8]| bytes.starts_with(signature);
    if is(b"MATLAB 5.0 MAT-file") {
        return Some(("MAT-file 5", "scipy.io.loadmat('FILE')['NAME']"));
    }
    // a container of HDF5, which other programs than MATLAB write without its first line
    let is_hdf5 = is(b"MATLAB 7.3 MAT-file") || is(b"\x89HDF\r\n\x1a\n");
    is_hdf5.then_some(("MAT-file 7.3, HDF5", "h5py.File('FILE')['NAME'][()].T"))
}

/// The program that compressed these bytes, from their beginning, and how to unpack them.
fn packed_by(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let begins: [(&[u8], _, _); 5] = [
        (b"\x1f\x8b", "gzip", "gunzip FILE"),
        (b"\x28\xb5\x2f\xfd", "zstd", "unzstd FILE"),
        (b"\xfd7zXZ\0", "xz", "unxz FILE"),
        (b"PK\x03\x04", "zip", "unzip FILE; a workbook of a spreadsheet program is to be saved as CSV"),
        (b"BZh", "bzip2", "bunzip2 FILE"),
    ];
    let (begin, program, unpack) = begins.into_iter().find(|(begin, ..)| bytes.starts_with(begin))?;
    // a text could begin with the letters of bzip2: check the digit and the first block, too
    let block = [&b"\x31\x41\x59\x26\x53\x59"[..], b"\x17\x72\x45\x38\x50\x90"];
    let is_text = begin == b"BZh" && !block.iter().any(|block| bytes.get(4..10) == Some(*block));
    (!is_text).then_some((program, unpack))
}

/// Bytes from within a text as text. They follow this number of bytes and lines.
pub fn as_text_at(bytes: &[u8], before: u64, lines: usize) -> Checked<&str> {
    if let Some(at) = memchr::memchr(0, bytes) {
        let offset = before + at as u64;
        return refuse(
            Refusal::EncodingUnknown,
            format!("this is binary data, not text: NUL byte at offset {offset}"),
            "export the data as text",
        );
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let line = lines + 1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count();
        InputError::new(
            Refusal::EncodingUnknown,
            format!(
                "not UTF-8 text: byte 0x{:02x} at offset {}",
                bytes.get(at).copied().unwrap_or(0),
                before + at as u64
            ),
            "save it as UTF-8 (or plain ASCII)",
        )
        .at_line(line)
        .into()
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_build_without_a_reader_names_the_feature_that_has_it() {
        let refused = super::without::<()>("mcap").expect_err("no reader").to_string();
        assert!(refused.contains("with the feature `mcap`"), "{refused}");
    }
}

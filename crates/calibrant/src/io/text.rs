//! Bytes of a file to text: size, encoding and binary content, each with a complaint that says what the file really is.

use crate::error::Complaint;
use std::io::Read;
use std::path::Path;

/// What a check gives: the thing, or a complaint that does not yet know whether an experiment or a recording is at fault.
pub(super) type Checked<T> = std::result::Result<T, Box<Complaint>>;

/// Reads a file whole, unless it is larger than `limit` bytes or plainly binary.
///
/// Reads in pieces and looks for NUL bytes on the way, so that a device or a disk image does not fill the memory.
pub(super) fn read_bytes(path: &Path, limit: u64, what: &str) -> Checked<Vec<u8>> {
    read_bytes_unless(path, limit, what, |_| false)
}

/// The same, except that files which begin as `is_known` says may be binary.
pub(super) fn read_bytes_unless(
    path: &Path,
    limit: u64,
    what: &str,
    is_known: impl Fn(&[u8]) -> bool,
) -> Checked<Vec<u8>> {
    const PIECE: u64 = 1 << 20;
    let complain = |message: String, help: &str| Box::new(Complaint::new(message, help).in_file(path));
    if path.is_dir() {
        return Err(complain(format!("this is a directory, not {what}"), "name a file in it"));
    }
    let unreadable = |error: std::io::Error| {
        let help = match error.kind() {
            std::io::ErrorKind::NotFound => "check the name and the working directory",
            std::io::ErrorKind::PermissionDenied => "check who may read it",
            _ => "check the file and its disk",
        };
        complain(format!("cannot read {what}: {error}"), help)
    };
    let mut file = std::fs::File::open(path).map_err(unreadable)?;
    // what a file says of its length is not to be trusted far
    let expected = file.metadata().map_or(0, |metadata| metadata.len()).min(64 * PIECE);
    let mut bytes = Vec::with_capacity(expected as usize + 1);
    loop {
        let before = bytes.len();
        file.by_ref().take(PIECE).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.len() == before {
            return Ok(bytes);
        }
        if bytes.len() as u64 > limit {
            return Err(complain(
                format!("{what} is larger than {} MiB", limit >> 20),
                "this is hardly the file that you mean",
            ));
        }
        if bytes[before..].contains(&0) && !is_known(&bytes) {
            as_text(&bytes).map_err(|complaint| complaint.in_file(path))?;
        }
    }
}

/// The bytes as text, without the byte order mark.
pub(super) fn as_text(bytes: &[u8]) -> Checked<&str> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(
            Complaint::new("the text is encoded in UTF-16", "save it as UTF-8 (or plain ASCII)").into()
        );
    }
    // the search for one byte is much faster than the search for its place
    if bytes.contains(&0) {
        let offset = bytes.iter().take_while(|&&byte| byte != 0).count();
        return Err(Complaint::new(
            format!("this is binary data, not text: NUL byte at offset {offset}"),
            "export the data as text",
        )
        .into());
    }
    let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let offset = error.valid_up_to();
        let line = 1 + bytes[..offset].iter().filter(|&&byte| byte == b'\n').count();
        Complaint::new(
            format!(
                "not UTF-8 text: byte 0x{:02x} at offset {offset}",
                bytes.get(offset).copied().unwrap_or(0)
            ),
            "save it as UTF-8 (or plain ASCII)",
        )
        .at_line(line)
        .into()
    })
}

//! Reads and writes `poses.csv`: the direction that is up in each pose, in the sensor's axes.

use crate::files::atomic_output::write_atomically;
use crate::text::decoding::{self, Checked, refuse};
use crate::text::delimited::{Delimiter, Line, Lines};
use calibrant_core::error::{InputError, Refusal, Result};
use nalgebra::Vector3;
use std::path::Path;

/// Largest file of poses, bytes.
const LARGEST_FILE: u64 = 1 << 24;
/// Most poses.
const MOST: usize = 100_000;
/// The names of the columns that count.
const NAMES: [&str; 3] = ["up_x", "up_y", "up_z"];
/// The remedy for a file that has no poses.
const HELP: &str =
    "poses have the header pose,up_x,up_y,up_z and a row for each pose, as `calibrant design` writes them";

/// Reads the direction that is up in each pose, as unit vectors in the sensor's axes. Columns beside `up_x`, `up_y`
/// and `up_z` are not read.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment) with file and line. The file cannot be read or is not text. A column is missing, a
/// value is no number, a direction has no length, or there is no pose.
pub fn read_poses(path: &Path) -> Result<Vec<Vector3<f64>>> {
    decoding::parsed(path, (LARGEST_FILE, "the poses"), parse)
}

/// Writes the direction that is up in each pose, and the pose in words.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_poses(path: &Path, directions: &[Vector3<f64>], words: &[String]) -> Result<()> {
    write_atomically(path, |out| {
        writeln!(out, "pose,up_x,up_y,up_z,words")?;
        for (k, (u, words)) in directions.iter().zip(words).enumerate() {
            writeln!(out, "{},{:?},{:?},{:?},\"{words}\"", k + 1, u.x, u.y, u.z)?;
        }
        Ok(())
    })
}

fn parse(bytes: &[u8]) -> Checked<Vec<Vector3<f64>>> {
    let text = decoding::as_text(bytes)?;
    let mut lines = Lines::of(text).filter(|line| !line.is_void());
    let Some(header) = lines.next() else {
        return refuse(Refusal::FileEmpty, "the file is empty", HELP);
    };
    let delimiter = Delimiter::of(header.text);
    let columns: Vec<&str> = header.fields(delimiter).map(|(_, field)| field).collect();
    let mut places = [0; 3];
    for (place, name) in places.iter_mut().zip(NAMES) {
        *place = columns.iter().position(|column| column.eq_ignore_ascii_case(name)).ok_or_else(|| {
            let message = format!("there is no column `{name}`");
            Box::new(InputError::new(Refusal::ColumnMissing, message, HELP).at_line(header.number))
        })?;
    }
    let poses = lines.map(|line| read_row(line, delimiter, places)).collect::<Checked<Vec<_>>>()?;
    match poses.len() {
        0 => refuse(Refusal::FileEmpty, "the file has no poses", HELP),
        count if count > MOST => {
            let message = format!("{count} poses are more than {MOST}");
            refuse(Refusal::ValueOutOfRange, message, HELP)
        }
        _ => Ok(poses),
    }
}

fn read_row(line: Line<'_>, delimiter: Delimiter, places: [usize; 3]) -> Checked<Vector3<f64>> {
    let reject = |message: String| {
        Box::new(InputError::new(Refusal::ValueInvalid, message, HELP).at_line(line.number))
    };
    let fields: Vec<&str> = line.fields(delimiter).map(|(_, field)| field).collect();
    let mut up = Vector3::zeros();
    for axis in 0..3 {
        let field = fields.get(places[axis]).copied().unwrap_or("");
        up[axis] = field.parse().ok().filter(|value: &f64| value.abs() <= 1e6).ok_or_else(|| {
            reject(format!("`{}` is no number for {}", super::commanded::shorten(field), NAMES[axis]))
        })?;
    }
    up.try_normalize(1e-9).ok_or_else(|| reject("a direction of no length".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_read_back_and_wrong_ones_are_told_with_their_line() {
        let text = "# by hand\npose,up_x,up_y,up_z,words\n1,0,0,2,\"z up, really\"\n2,0.6,0,-0.8,\"\"\n";
        let poses = parse(text.as_bytes()).expect("poses");
        assert_eq!(poses, [Vector3::z(), Vector3::new(0.6, 0.0, -0.8)]);
        for (wrong, word, line) in [
            ("", "empty", None),
            ("up_x,up_y\n1,0\n", "up_z", Some(1)),
            ("up_x,up_y,up_z\n", "no poses", None),
            ("up_x,up_y,up_z\n1,0,0\n1,north,0\n", "north", Some(3)),
            ("up_x,up_y,up_z\n1,0\n", "up_z", Some(2)),
            ("up_x,up_y,up_z\n0,0,0\n", "no length", Some(2)),
            ("up_x,up_y,up_z\nnan,0,0\n", "nan", Some(2)),
        ] {
            let error = parse(wrong.as_bytes()).expect_err(wrong);
            assert!(error.to_string().contains(word) && error.line == line, "{error:?}");
        }
    }
}

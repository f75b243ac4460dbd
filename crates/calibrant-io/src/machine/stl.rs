//! Meshes in STL, binary or text: the vertices of their triangles.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_recording::text::decoding::{Checked, open_file, refuse, too_large, unreadable};
use nalgebra::Vector3;
use std::io::Read;
use std::path::Path;

/// Largest file, bytes: 1.3 million triangles. The collision meshes of arms have some thousand.
const LARGEST_BYTES: u64 = 64 << 20;
/// Bytes before the triangles, and of each: a normal, three vertices, two bytes of attributes.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the vertices of a mesh.
pub(super) fn read_stl(path: &Path) -> Checked<Vec<Vector3<f64>>> {
    let mut bytes = Vec::new();
    let read = open_file(path, "a mesh")?.take(LARGEST_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| unreadable("a mesh", &error).in_file(path))?;
    vertices(&bytes).map_err(|error| Box::new(error.in_file(path)))
}

/// The vertices of the triangles of an STL file, as it has them: each as often as triangles have it.
///
/// # Errors
/// [`Error::Experiment`] with the line of a text, or the triangle. The file is no STL, is cut off, has no triangle, or a number that is none or not finite.
///
/// # Examples
/// ```
/// let text = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
/// assert_eq!(calibrant_io::parse_stl(text.as_bytes())?.len(), 3);
/// let error = calibrant_io::parse_stl(text.replace("1 0 0", "1 O 0").as_bytes()).expect_err("a letter");
/// assert_eq!(error.input_error().and_then(|error| error.line), Some(5));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_stl(bytes: &[u8]) -> Result<Vec<Vector3<f64>>> {
    vertices(bytes).map_err(Error::Experiment)
}

fn vertices(bytes: &[u8]) -> Checked<Vec<Vector3<f64>>> {
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(too_large("a mesh", LARGEST_BYTES).into());
    }
    // a binary file may begin with this word, too, but not have the next one soon after
    let begins = |word: &[u8]| bytes.windows(word.len()).take(1000).any(|at| at.eq_ignore_ascii_case(word));
    let text = (bytes.trim_ascii_start().starts_with(b"solid") && (begins(b"facet") || begins(b"endsolid")))
        .then(|| std::str::from_utf8(bytes).ok())
        .flatten();
    let vertices = match text {
        Some(text) => of_text(text)?,
        None => of_bytes(bytes)?,
    };
    if vertices.is_empty() {
        return refuse(Refusal::FileEmpty, "the mesh has no triangle", "export it anew");
    }
    Ok(vertices)
}

fn of_bytes(bytes: &[u8]) -> Checked<Vec<Vector3<f64>>> {
    let Some((head, triangles)) = bytes.split_at_checked(HEAD) else {
        let message = format!("the file has {} bytes, and a mesh in STL at least {HEAD}", bytes.len());
        return refuse(Refusal::FormatUnknown, message, "is this an STL file?");
    };
    let stated = u32::from_le_bytes([head[80], head[81], head[82], head[83]]) as usize;
    let there = triangles.len() / TRIANGLE;
    if there < stated {
        let message = format!("the file says {stated} triangles, and has {there}");
        return refuse(Refusal::FormatUnknown, message, "was it copied whole? is it an STL file?");
    }
    let mut vertices = Vec::with_capacity(3 * stated);
    for (k, triangle) in triangles.chunks_exact(TRIANGLE).take(stated).enumerate() {
        let number = |i: usize| {
            let at = 12 + 4 * i;
            f64::from(f32::from_le_bytes([
                triangle[at],
                triangle[at + 1],
                triangle[at + 2],
                triangle[at + 3],
            ]))
        };
        for corner in 0..3 {
            let vertex = Vector3::from_fn(|axis, _| number(3 * corner + axis));
            if !vertex.iter().all(|of| of.is_finite()) {
                let message = format!("triangle {} has a vertex that is not finite", k + 1);
                return refuse(Refusal::ValueOutOfRange, message, "export the mesh anew");
            }
            vertices.push(vertex);
        }
    }
    Ok(vertices)
}

fn of_text(text: &str) -> Checked<Vec<Vector3<f64>>> {
    let mut vertices = Vec::new();
    let at = |line: usize, code: Refusal, message: String, help: &str| -> Box<InputError> {
        Box::new(InputError::new(code, message, help).at_line(line))
    };
    let (mut is_whole, mut last) = (false, 1);
    for (line, content) in text.lines().enumerate().map(|(k, content)| (k + 1, content)) {
        let mut words = content.split_whitespace();
        let first = words.next().unwrap_or_default();
        if !first.is_empty() {
            (is_whole, last) = (first.eq_ignore_ascii_case("endsolid"), line);
        }
        if !first.eq_ignore_ascii_case("vertex") {
            continue;
        }
        let numbers: Vec<f64> = words
            .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()))
            .collect::<Option<_>>()
            .filter(|numbers: &Vec<f64>| numbers.len() == 3)
            .ok_or_else(|| {
                let message = "a vertex has three finite numbers, this has not".to_owned();
                at(line, Refusal::NumberMalformed, message, "vertex 0.1 0.2 0.3, for example")
            })?;
        vertices.push(Vector3::new(numbers[0], numbers[1], numbers[2]));
    }
    if !is_whole || vertices.len() % 3 != 0 {
        let message = format!("the mesh ends after {} vertices, without endsolid", vertices.len());
        let message =
            if is_whole { format!("{} vertices make no triangles", vertices.len()) } else { message };
        return Err(at(last, Refusal::FormatUnknown, message, "was it copied whole?"));
    }
    Ok(vertices)
}

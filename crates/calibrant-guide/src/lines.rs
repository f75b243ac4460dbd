//! Lines of the bytes that arrive in pieces.

/// Longest line, bytes. What is longer is no row of samples.
const LONGEST: usize = 8192;
/// Of so many bytes this share must be text.
const WATCHED: usize = 512;
const TEXT: f64 = 0.9;

/// The beginning of a line, and how much of the last bytes was text.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    rest: Vec<u8>,
    seen: usize,
    text: usize,
    /// Is what comes no text?
    pub(crate) is_noise: bool,
}

impl Lines {
    /// The lines that these bytes complete.
    pub(crate) fn push(&mut self, bytes: &[u8]) -> Vec<String> {
        let mut lines = Vec::new();
        for byte in bytes {
            self.watch(*byte);
            match byte {
                b'\n' | b'\r' => {
                    let line = std::mem::take(&mut self.rest);
                    // what is no text becomes a line that is no row, and counts as one
                    let line = String::from_utf8_lossy(&line);
                    if !line.trim().is_empty() {
                        lines.push(line.into_owned());
                    }
                }
                _ if self.rest.len() < LONGEST => self.rest.push(*byte),
                _ => {}
            }
        }
        lines
    }

    fn watch(&mut self, byte: u8) {
        self.seen += 1;
        let is_text = (b' '..=b'~').contains(&byte) || matches!(byte, b'\t' | b'\n' | b'\r');
        self.text += usize::from(is_text);
        if self.seen == WATCHED {
            self.is_noise = (self.text as f64) < TEXT * WATCHED as f64;
            (self.seen, self.text) = (0, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_in_pieces_and_noise_is_no_text() {
        let mut lines = Lines::default();
        assert!(lines.push(b"1,2").is_empty());
        assert_eq!(lines.push(b",3\r\n\r\n4"), ["1,2,3"]);
        assert_eq!(lines.push(b",5,6\n"), ["4,5,6"]);
        assert_eq!(lines.push(b"7,\xff8,9\n"), ["7,\u{fffd}8,9"], "it counts as a line");
        let noise: Vec<u8> = (0..2048_u32).map(|k| (k * 37 % 256) as u8).collect();
        lines.push(&noise);
        assert!(lines.is_noise);
        for _ in 0..100 {
            lines.push(b"0.01,-9.8,0.1,0.2\n");
        }
        assert!(!lines.is_noise);
    }
}

//! Reads the fields of a message of ROS.
//!
//! ROS 2 has them in CDR. A message begins with 4 bytes: 0, then 0 for big-endian or 1 for little-endian, and two of options. Every number is
//! aligned to its size, counted from the end of these bytes. ROS 1 has the same fields without these bytes, little-endian and not aligned; a header
//! begins with a number that counts messages.

/// The reason for a message that ends too early.
const SHORT: &str = "it is too short";

/// The reason why a message cannot be what its type says.
pub(crate) type Unreadable = &'static str;

/// How a message is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// As ROS 2 does.
    Cdr,
    /// As ROS 1 does.
    Ros1,
}

/// The fields of a message that are still to be read.
pub(crate) struct RosMessage<'b> {
    bytes: &'b [u8],
    at: usize,
    little: bool,
    encoding: Encoding,
}

impl<'b> RosMessage<'b> {
    pub(crate) fn new(bytes: &'b [u8], encoding: Encoding) -> Result<Self, Unreadable> {
        if encoding == Encoding::Ros1 {
            return Ok(Self { bytes, at: 0, little: true, encoding });
        }
        let little = match bytes.get(..2) {
            Some([0, 0]) => false,
            Some([0, 1]) => true,
            Some(_) => return Err("its encapsulation is not plain CDR"),
            None => return Err(SHORT),
        };
        Ok(Self { bytes: bytes.get(4..).ok_or(SHORT)?, at: 0, little, encoding })
    }

    /// The time stamp of a header, ns. Its frame follows: `frame_id`, a text.
    pub(crate) fn stamp_ns(&mut self) -> Result<i64, Unreadable> {
        if self.encoding == Encoding::Ros1 {
            self.u32()?;
        }
        let sec = self.u32()? as i32;
        let nanosec = self.u32()?;
        Ok(i64::from(sec) * 1_000_000_000 + i64::from(nanosec))
    }

    /// A length u32, then bytes, in ROS 2 with a NUL at their end.
    pub(crate) fn text(&mut self) -> Result<String, Unreadable> {
        let length = self.u32()? as usize;
        let bytes = self.bytes.get(self.at..).and_then(|rest| rest.get(..length)).ok_or(SHORT)?;
        self.at += length;
        Ok(String::from_utf8_lossy(bytes.strip_suffix(&[0]).unwrap_or(bytes)).into_owned())
    }

    /// A list: its length u32, then its elements.
    pub(crate) fn list<T>(
        &mut self,
        element: impl Fn(&mut Self) -> Result<T, Unreadable>,
    ) -> Result<Vec<T>, Unreadable> {
        let length = self.u32()? as usize;
        // the stated length is not trusted: memory grows with what is there
        (0..length).map(|_| element(self)).collect()
    }

    pub(crate) fn numbers<const N: usize>(&mut self) -> Result<[f64; N], Unreadable> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    pub(crate) fn f64(&mut self) -> Result<f64, Unreadable> {
        let bytes = self.take()?;
        Ok(if self.little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    fn u32(&mut self) -> Result<u32, Unreadable> {
        let bytes = self.take()?;
        Ok(if self.little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Unreadable> {
        let start = match self.encoding {
            Encoding::Cdr => self.at.next_multiple_of(N),
            Encoding::Ros1 => self.at,
        };
        let bytes = self.bytes.get(start..).and_then(|rest| rest.first_chunk::<N>()).ok_or(SHORT)?;
        self.at = start + N;
        Ok(*bytes)
    }
}

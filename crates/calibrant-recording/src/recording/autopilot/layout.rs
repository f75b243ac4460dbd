//! The fields of a message, by name: where each stands, and how it is written. All numbers are little-endian.

/// How a number is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Fields with this name: one, or several in a row.
struct Member {
    name: String,
    scalar: Scalar,
    factor: f64,
    offset: usize,
    count: usize,
}

/// The fields of a message.
#[derive(Default)]
pub(super) struct Layout {
    members: Vec<Member>,
    /// Bytes of all fields so far; `None` where one is of a type that is not known.
    size: Option<usize>,
}

/// A field of a message.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field {
    scalar: Scalar,
    factor: f64,
    offset: usize,
    /// Number of fields from this one on that have its name.
    pub(super) count: usize,
}

impl Layout {
    pub(super) fn new() -> Self {
        Self { members: Vec::new(), size: Some(0) }
    }

    /// Adds fields of this name. Numbers are to be multiplied by the factor.
    pub(super) fn add(&mut self, name: &str, (scalar, factor): (Scalar, f64), count: usize) {
        let Some(offset) = self.size else { return };
        self.members.push(Member { name: name.to_owned(), scalar, factor, offset, count });
        self.skip(scalar.size().checked_mul(count));
    }

    /// Adds bytes without a number; `None`: of unknown length, so that nothing behind them can be found.
    pub(super) fn skip(&mut self, bytes: Option<usize>) {
        self.size = self.size.zip(bytes).and_then(|(size, bytes)| size.checked_add(bytes));
    }

    /// The field of this name: `x`, or `gyro_rad[2]`.
    pub(super) fn field(&self, name: &str) -> Option<Field> {
        let (base, index) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
            Some((base, index)) => (base, index.parse().ok()?),
            None => (name, 0),
        };
        let member = self.members.iter().find(|member| member.name == base)?;
        let count = member.count.checked_sub(index).filter(|count| *count > 0)?;
        let Member { scalar, factor, .. } = *member;
        Some(Field { scalar, factor, offset: member.offset + index * scalar.size(), count })
    }
}

impl Field {
    /// Its value; `None` where the message is too short.
    pub(super) fn value(&self, message: &[u8]) -> Option<f64> {
        self.value_at(message, 0)
    }

    /// The value of the field that stands this number of fields behind it.
    pub(super) fn value_at(&self, message: &[u8], after: usize) -> Option<f64> {
        let bytes = message.get(self.offset + after * self.scalar.size()..)?;
        Some(self.scalar.value(bytes)? * self.factor)
    }
}

impl Scalar {
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    fn value(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I8 => i8::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::U8 => u8::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::I16 => i16::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::U16 => u16::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::I32 => i32::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::U32 => u32::from_le_bytes(*bytes.first_chunk()?).into(),
            Self::F32 => f32::from_le_bytes(*bytes.first_chunk()?).into(),
            // a microsecond counts: 2⁵³ of them are 285 years
            Self::I64 => i64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::U64 => u64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::F64 => f64::from_le_bytes(*bytes.first_chunk()?),
        })
    }
}

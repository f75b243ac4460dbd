//! Numbers in a blob: `f64`, little endian.

/// Numbers as bytes.
pub(super) fn bytes_of(numbers: impl IntoIterator<Item = f64>) -> Vec<u8> {
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// The numbers of bytes; `None` where a number is cut.
pub(super) fn numbers_of(bytes: &[u8]) -> Option<Vec<f64>> {
    let (numbers, rest) = bytes.as_chunks::<8>();
    rest.is_empty().then(|| numbers.iter().copied().map(f64::from_le_bytes).collect())
}

//! SHA-256 of a file, or of numbers in memory, in hexadecimal digits.

use sha2::{Digest, Sha256};

pub fn hex_sha256(bytes: &[u8]) -> String {
    hex(Sha256::new_with_prefix(bytes))
}

/// Of named lists of numbers: each name, a zero byte, the number of values, and the values, in little-endian order.
pub fn hex_of_lists<'a, N: ExactSizeIterator<Item = f64>>(
    lists: impl IntoIterator<Item = (&'a str, N)>,
) -> String {
    let mut hash = Sha256::new();
    for (name, values) in lists {
        hash.update(name.as_bytes());
        hash.update([0]);
        hash.update((values.len() as u64).to_le_bytes());
        values.for_each(|value| hash.update(value.to_le_bytes()));
    }
    hex(hash)
}

pub fn hex(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

//! Numbers for the tests.

use nalgebra::Vector3;

/// Numbers without a pattern (splitmix64).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// A number from `-size` to `size`.
    pub(crate) fn next(&mut self, size: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        size * (2.0 * ((z ^ (z >> 31)) as f64 / u64::MAX as f64) - 1.0)
    }

    /// A vector with such components.
    pub(crate) fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next(size))
    }
}

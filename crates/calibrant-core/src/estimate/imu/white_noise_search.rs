//! A search for the gyroscope's white noise that runs during the calibration.

use crate::estimate::imu::problem::WhiteNoise;
use std::fmt;
use std::sync::LazyLock;

type Search<'a> = Box<dyn FnOnce() -> Option<WhiteNoise> + Send + 'a>;

/// A search for the gyroscope's white noise. It runs once, at the first request for its result.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::{WhiteNoise, WhiteNoiseSearch};
/// use nalgebra::Vector3;
///
/// let found = WhiteNoise { sd: Vector3::repeat(1e-3), hold: 0, duration_s: 60.0 };
/// let search = WhiteNoiseSearch::new(|| Some(found));
/// assert_eq!(search.result(), Some(found));
/// ```
pub struct WhiteNoiseSearch<'a>(LazyLock<Option<WhiteNoise>, Search<'a>>);

impl<'a> WhiteNoiseSearch<'a> {
    /// A search that has not run yet. It returns `None` if no hold shows the white noise.
    #[must_use]
    pub fn new(search: impl FnOnce() -> Option<WhiteNoise> + Send + 'a) -> Self {
        Self(LazyLock::new(Box::new(search)))
    }

    /// A search with a known result.
    #[must_use]
    pub fn known(white_noise: Option<WhiteNoise>) -> Self {
        Self::new(move || white_noise)
    }

    /// The result of the search. The first caller runs it, and other callers wait.
    #[must_use]
    pub fn result(&self) -> Option<WhiteNoise> {
        *LazyLock::force(&self.0)
    }
}

impl fmt::Debug for WhiteNoiseSearch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WhiteNoiseSearch")
    }
}

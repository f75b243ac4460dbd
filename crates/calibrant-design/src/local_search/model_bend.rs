//! How much a convex model bends: a factor that the search learns from one iteration to the next.
//!
//! The bend of the linearised information bounds the criterion from above, often far above. So it is lowered
//! after each full step, and raised where only a part of the way could be gone.

/// Factor on the bend after each full step.
const BOLDER: f64 = 0.25;
/// The least factor on the bend.
const LEAST: f64 = 1e-3;

/// The factor on the model's bend, from 0 to 1.
pub(crate) struct ModelBend(f64);

impl ModelBend {
    /// The bend that bounds the criterion.
    pub(crate) fn full() -> Self {
        Self(1.0)
    }

    pub(crate) fn factor(&self) -> f64 {
        self.0
    }

    /// Learns what part of the way to the minimum was gone.
    pub(crate) fn moved(&mut self, fraction: f64) {
        self.0 =
            if fraction == 1.0 { f64::max(self.0 * BOLDER, LEAST) } else { f64::min(self.0 / BOLDER, 1.0) };
    }

    /// Learns that the criterion does not fall on the way; returns whether another model may do better.
    pub(crate) fn blocked(&mut self) -> bool {
        let bold = self.0 < 1.0;
        self.0 = 1.0;
        bold
    }
}

//! All starts: where they begin, and the best motion of each axis.

mod multistart_search;
pub(crate) mod random_starts;
mod so_far;

pub(crate) use multistart_search::search;
pub use so_far::SoFar;

//! All starts: where they begin, and the best motion of each axis.

pub(crate) mod combined_axes;
pub(crate) mod kicks;
pub(crate) mod multistart_search;
pub(crate) mod random_starts;
pub(crate) mod so_far;

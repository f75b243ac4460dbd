//! What a user asks for: the best motion, the shortest one, a sweep, and what they take.

pub(crate) mod shortest;
pub(crate) mod solve;
pub(crate) mod sweep;
pub(crate) mod trace_surface;
pub(crate) mod work;

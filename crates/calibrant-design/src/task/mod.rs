//! What a user asks for: the best motion, the shortest one, a sweep, and what they take.

mod shortest;
mod shuttle;
mod solve;
mod sweep;
mod trace_surface;

pub use shortest::{ShortestMotion, shortest_motion};
pub use shuttle::usual_motion;
pub use solve::design;
pub use sweep::{Sweep, SweepPoint, SweepVariable, sweep, sweep_work};
pub use trace_surface::{SurfaceSettings, TraceSurface, trace_surface};

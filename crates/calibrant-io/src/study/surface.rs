//! The fields of the surface: the criterion over the jerks of two intervals.

use calibrant_design::TraceSurface;
use serde::Serialize;

/// Entry `[i][j]` is at `u_1 = jerk_mps3[i]`, `u_2 = jerk_mps3[j]`; variances in SI.
#[derive(Serialize)]
pub(super) struct SurfaceFields<'a> {
    start_acceleration_mps2: f64,
    interval_s: f64,
    rate_hz: f64,
    jerk_mps3: &'a [f64],
    log10_trace: &'a [Vec<Option<f64>>],
}

impl<'a> SurfaceFields<'a> {
    pub(super) fn of(surface: &'a TraceSurface) -> Self {
        Self {
            start_acceleration_mps2: surface.settings.start_mps2,
            interval_s: surface.settings.interval_s,
            rate_hz: surface.settings.rate_hz,
            jerk_mps3: &surface.jerk_mps3,
            log10_trace: &surface.log10_trace,
        }
    }
}

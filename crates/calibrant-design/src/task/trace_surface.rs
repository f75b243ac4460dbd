//! The criterion as a surface over the jerks of two intervals: the thesis's Figure 7.

use crate::problem::DesignProblem;
use crate::result::evaluate;
use calibrant_core::error::Result;
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::AOptimality;
use calibrant_core::json_object;
use calibrant_core::motion::{JerkControlledMotion, KnownEnds, Limits, MotionClock, Trust};
use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Vector3};
use rayon::prelude::*;

/// The conditions of the surface: one axis, two intervals, the motion known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSettings {
    /// Largest jerk, m/s³; both jerks run from its negative to it.
    pub jerk_mps3: f64,
    /// Number of jerks in each direction; odd numbers have zero among them.
    pub points: usize,
    /// Acceleration at the start, m/s²: the thesis's `x_1`.
    pub start_mps2: f64,
    /// Duration of each of the two intervals, s.
    pub interval_s: f64,
    /// Sample rate, Hz.
    pub rate_hz: f64,
}

/// The trace of the covariance of one axis' bias and scale factor over the jerks `u_1`, `u_2` of two intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceSurface {
    /// Its conditions.
    pub settings: SurfaceSettings,
    /// The jerks of both intervals, m/s³, from least to most.
    pub jerk_mps3: Vec<f64>,
    /// Entry `[i][j]`: decimal logarithm of the trace (variances in SI) at `u_1 = jerk_mps3[i]`,
    /// `u_2 = jerk_mps3[j]`. `None` where the motion does not determine the parameters, as at (0, 0).
    pub log10_trace: Vec<Vec<Option<f64>>>,
}

json_object! {
    /// Decimal logarithm of the trace of a covariance over the jerks of two intervals.
    TraceSurface as of {
        start_acceleration_mps2: of.settings.start_mps2,
        interval_s: of.settings.interval_s,
        rate_hz: of.settings.rate_hz,
        jerk_mps3: &of.jerk_mps3,
        /// Entry `[i][j]` is at `u_1 = jerk_mps3[i]`, `u_2 = jerk_mps3[j]`; variances in SI.
        log10_trace: &of.log10_trace,
    }
}

/// Draws the surface for the first axis of a sensor, at its nominal parameters.
///
/// # Errors
/// As [`evaluate`].
///
/// # References
/// `vamvaka2021`
pub fn trace_surface(sensor: &Sensor, settings: &SurfaceSettings) -> Result<TraceSurface> {
    let sensor = Sensor { axes: 1, model: SensorModel::ScaleBias, ..sensor.clone() };
    let limits = Limits::default();
    let problem = DesignProblem {
        sensor: &sensor,
        at: sensor.nominal().unwrap_or_else(SensorParameters::identity),
        intervals: 2,
        interval_s: settings.interval_s,
        rate_hz: settings.rate_hz,
        trust: Trust::Known,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits: &limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(2, 1.0) }),
        prior: None,
    };
    let last = settings.points.saturating_sub(1);
    // symmetric to the bit, and zero exactly in the middle
    let jerk = |i: usize| settings.jerk_mps3 * (2.0 * i as f64 - last as f64) / (last.max(1) as f64);
    let jerk_mps3: Vec<f64> = (0..settings.points).map(jerk).collect();
    let log10_trace = jerk_mps3
        .par_iter()
        .map(|u1| {
            let row = jerk_mps3.iter().map(|u2| {
                let a1 = settings.start_mps2 + u1 * settings.interval_s;
                let a2 = a1 + u2 * settings.interval_s;
                let nodes = [settings.start_mps2, a1, a2].map(Vector3::repeat).to_vec();
                let motion = JerkControlledMotion::uniform(settings.interval_s, nodes)?;
                let trace = evaluate(&problem, &motion)?.value;
                Ok(trace.is_finite().then(|| trace.log10()))
            });
            row.collect::<Result<Vec<_>>>()
        })
        .collect::<Result<Vec<_>>>()?;
    Ok(TraceSurface { settings: *settings, jerk_mps3, log10_trace })
}

//! Jerk-controlled motion: acceleration that is continuous and linear between nodes. This file holds the
//! nodes, converts them to jerk, velocity and displacement, and writes them as a table with a row for each.
//!
//! All computations use the node form, `a_i` at breakpoint `τ_i`. Only the boundary uses the thesis's form
//! (x, u): intercept and jerk of each interval, `α(t) = x_i + u_i t`. Both describe the same motions: the
//! report's continuity constraint holds identically in node form.
//!
//! The state of a motion at any time, from exact polynomials between the nodes.
//!
//! Inside interval i, `s` after its start: `a = a_i + u_i s`, `v = v_i + a_i s + u_i s²/2`, `d = d_i + v_i s + a_i s²/2 + u_i s³/6`.

use crate::error::{Error, InputError, Refusal, Result};
use crate::form::vector_rows;
use crate::json::{flat, if_some};
use nalgebra::Vector3;

/// A motion of piecewise-linear acceleration.
///
/// # Shapes and units
/// N + 1 nodes for N intervals; times in s, strictly increasing; accelerations in m/s².
///
/// # Examples
/// ```
/// use calibrant_core::motion::JerkControlledMotion;
/// use nalgebra::Vector3;
///
/// let nodes = vec![Vector3::zeros(), Vector3::new(1.0, 0.0, 0.0), Vector3::zeros()];
/// let motion = JerkControlledMotion::uniform(2.0, nodes)?;
/// assert_eq!(motion.acceleration_at(3.0).x, 0.5);
/// assert_eq!(motion.jerk_mps3()[1].x, -0.5);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct JerkControlledMotion {
    times_s: Vec<f64>,
    acceleration_mps2: Vec<Vector3<f64>>,
    pub(super) axes: usize,
}

impl JerkControlledMotion {
    /// A motion through these nodes.
    ///
    /// # Errors
    /// [`Error::Experiment`] where there are fewer than two nodes, the lengths differ, a number is not
    /// finite, or the times do not increase. The error names the row.
    pub fn new(times_s: Vec<f64>, acceleration_mps2: Vec<Vector3<f64>>) -> Result<Self> {
        let reject = |message: String, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::MotionInvalid, message, help)))
        };
        if times_s.len() != acceleration_mps2.len() {
            return reject(
                format!("{} node times but {} node accelerations", times_s.len(), acceleration_mps2.len()),
                "give one acceleration for each time",
            );
        }
        if times_s.len() < 2 {
            return reject(
                format!("a motion needs at least two nodes, this one has {}", times_s.len()),
                "give the acceleration at the start and at the end",
            );
        }
        for (row, (time, node)) in times_s.iter().zip(&acceleration_mps2).enumerate() {
            if !time.is_finite() || node.iter().any(|a| !a.is_finite() || a.abs() > 1e9) {
                return reject(
                    format!("node {row} is not a usable number: t = {time}, a = {:?}", node.as_slice()),
                    "accelerations are in m/s²",
                );
            }
        }
        if let Some(row) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            return reject(
                format!(
                    "node times must increase: node {} is at {} s, node {} at {} s",
                    row,
                    times_s[row],
                    row + 1,
                    times_s[row + 1]
                ),
                "sort the rows and remove duplicates",
            );
        }
        Ok(Self { times_s, acceleration_mps2, axes: 3 })
    }

    /// A motion from t = 0 with intervals of equal duration `interval_s`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn uniform(interval_s: f64, acceleration_mps2: Vec<Vector3<f64>>) -> Result<Self> {
        let times_s = (0..acceleration_mps2.len()).map(|i| i as f64 * interval_s).collect();
        Self::new(times_s, acceleration_mps2)
    }

    /// The same motion with a constant added to its acceleration.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn plus(&self, constant_mps2: &Vector3<f64>) -> Result<Self> {
        let acceleration_mps2 = self.acceleration_mps2.iter().map(|a| a + constant_mps2).collect();
        Ok(Self::new(self.times_s.clone(), acceleration_mps2)?.on_axes(self.axes))
    }

    /// The motion of a sensor with this number of axes, 1 or 3. Results have as many.
    #[must_use]
    pub fn on_axes(self, axes: usize) -> Self {
        Self { axes, ..self }
    }

    /// Number of axes: 3, unless [`on_axes`](Self::on_axes) says otherwise.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.axes
    }

    /// Number of intervals N.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.times_s.len() - 1
    }

    /// Breakpoints `τ_i`, s, N + 1 of them.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Node accelerations `a_i`, m/s², N + 1 of them.
    #[must_use]
    pub fn acceleration_mps2(&self) -> &[Vector3<f64>] {
        &self.acceleration_mps2
    }

    /// Duration of interval i, s.
    #[must_use]
    pub fn interval_s(&self, i: usize) -> f64 {
        self.times_s[i + 1] - self.times_s[i]
    }

    /// Jerk `u_i = (a_{i+1} − a_i)/Δτ_i` of each interval, m/s³: the thesis's control.
    #[must_use]
    pub fn jerk_mps3(&self) -> Vec<Vector3<f64>> {
        (0..self.intervals())
            .map(|i| (self.acceleration_mps2[i + 1] - self.acceleration_mps2[i]) / self.interval_s(i))
            .collect()
    }

    /// Intercept `x_i = a_i − u_i τ_i` of each interval, m/s²: the thesis's state. It is the line's value at
    /// t = 0.
    #[must_use]
    pub fn intercept_mps2(&self) -> Vec<Vector3<f64>> {
        let jerk = self.jerk_mps3();
        (0..self.intervals()).map(|i| self.acceleration_mps2[i] - jerk[i] * self.times_s[i]).collect()
    }

    /// Velocity at the nodes, m/s, from rest: `v_{i+1} = v_i + (a_i + a_{i+1}) Δτ/2`.
    #[must_use]
    pub fn velocity_mps(&self) -> Vec<Vector3<f64>> {
        let mut velocity = vec![Vector3::zeros()];
        for i in 0..self.intervals() {
            let step =
                (self.acceleration_mps2[i] + self.acceleration_mps2[i + 1]) * (self.interval_s(i) / 2.0);
            velocity.push(velocity[i] + step);
        }
        velocity
    }

    /// Displacement at the nodes, m, from the origin at rest: `d_{i+1} = d_i + v_i Δτ + (2 a_i + a_{i+1}) Δτ²/6`.
    #[must_use]
    pub fn displacement_m(&self) -> Vec<Vector3<f64>> {
        let velocity = self.velocity_mps();
        let mut displacement = vec![Vector3::zeros()];
        for (i, v) in velocity.iter().take(self.intervals()).enumerate() {
            let dt = self.interval_s(i);
            let bend = (self.acceleration_mps2[i] * 2.0 + self.acceleration_mps2[i + 1]) * (dt * dt / 6.0);
            displacement.push(displacement[i] + v * dt + bend);
        }
        displacement
    }

    /// The interval that contains time t, and the place λ in it, from 0 to 1. Times outside the motion are
    /// clamped to its ends.
    #[must_use]
    pub fn locate(&self, t: f64) -> (usize, f64) {
        let i = self.times_s.partition_point(|&tau| tau <= t).clamp(1, self.intervals()) - 1;
        (i, ((t - self.times_s[i]) / self.interval_s(i)).clamp(0.0, 1.0))
    }

    /// Acceleration at time t, m/s². Outside the motion it is the acceleration of the nearer end.
    #[must_use]
    pub fn acceleration_at(&self, t: f64) -> Vector3<f64> {
        let (i, lambda) = self.locate(t);
        self.acceleration_mps2[i] * (1.0 - lambda) + self.acceleration_mps2[i + 1] * lambda
    }
}

/// Where a motion is at one time, counted from rest at the origin at its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionState {
    /// Displacement, m.
    pub displacement_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_mps: Vector3<f64>,
    /// Acceleration, m/s².
    pub acceleration_mps2: Vector3<f64>,
    /// Jerk, m/s³. At a node it is the jerk of the interval that begins there.
    pub jerk_mps3: Vector3<f64>,
}

impl JerkControlledMotion {
    /// The state at each of these times. Times outside the motion are clamped to its ends.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::motion::JerkControlledMotion;
    /// use nalgebra::Vector3;
    /// // jerk 2 from rest: a = 2 t, v = t², d = t³/3
    /// let motion = JerkControlledMotion::uniform(3.0, vec![Vector3::zeros(), Vector3::repeat(6.0)])?;
    /// let state = motion.states_at(&[1.5])[0];
    /// assert_eq!((state.velocity_mps.x, state.displacement_m.x), (2.25, 1.125));
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    #[must_use]
    pub fn states_at(&self, times_s: &[f64]) -> Vec<MotionState> {
        let (velocity, displacement, jerk) = (self.velocity_mps(), self.displacement_m(), self.jerk_mps3());
        let state = |&t: &f64| {
            let (i, lambda) = self.locate(t);
            let s = lambda * self.interval_s(i);
            let (a, v, d, u) = (self.acceleration_mps2()[i], velocity[i], displacement[i], jerk[i]);
            MotionState {
                displacement_m: d + v * s + a * (s * s / 2.0) + u * (s * s * s / 6.0),
                velocity_mps: v + a * s + u * (s * s / 2.0),
                acceleration_mps2: self.acceleration_at(t),
                jerk_mps3: u,
            }
        };
        times_s.iter().map(state).collect()
    }
}

/// The nodes of a motion over the first axes, and what follows from them.
pub struct MotionTable<'a> {
    /// The motion.
    pub motion: &'a JerkControlledMotion,
    /// Number of axes.
    pub axes: usize,
    /// Standard deviation of each node acceleration, where it was estimated.
    pub acceleration_sd_mps2: Option<&'a [Vector3<f64>]>,
}

crate::json_object! {
    /// A motion: a row for each node.
    MotionTable<'_> as of {
        times_s: of.motion.times_s(),
        acceleration_mps2: vector_rows(of.motion.acceleration_mps2(), of.axes),
        acceleration_sd_mps2: if_some(of.acceleration_sd_mps2.map(|sd| vector_rows(sd, of.axes))),
        jerk_mps3: vector_rows(&of.motion.jerk_mps3(), of.axes),
        velocity_mps: vector_rows(&of.motion.velocity_mps(), of.axes),
        displacement_m: vector_rows(&of.motion.displacement_m(), of.axes),
    }
}

crate::json_object! {
    /// A motion of piecewise-linear acceleration.
    JerkControlledMotion as of {
        table: flat(MotionTable { motion: of, axes: of.axes, acceleration_sd_mps2: None }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> JerkControlledMotion {
        let nodes = [0.0, 2.0, -1.0, 3.0].map(|a| Vector3::new(a, -a, 2.0 * a)).to_vec();
        JerkControlledMotion::uniform(0.5, nodes).expect("valid")
    }

    #[test]
    fn intercept_form_describes_the_same_acceleration() {
        let motion = motion();
        let (x, u) = (motion.intercept_mps2(), motion.jerk_mps3());
        for step in 0..=30 {
            let t = step as f64 * 0.05;
            let (i, _) = motion.locate(t);
            assert!((x[i] + u[i] * t - motion.acceleration_at(t)).amax() < 1e-14);
        }
        for i in 0..2 {
            let tau = motion.times_s()[i + 1];
            assert!((x[i] - x[i + 1] - (u[i + 1] - u[i]) * tau).amax() < 1e-14, "the thesis's continuity");
        }
    }

    #[test]
    fn velocity_and_displacement_equal_fine_quadrature() {
        let motion = motion();
        let steps = 30_000;
        let dt = 1.5 / f64::from(steps);
        let (mut v, mut d) = (Vector3::zeros(), Vector3::zeros());
        for k in 0..steps {
            let a = motion.acceleration_at((f64::from(k) + 0.5) * dt);
            d += v * dt + a * (dt * dt / 2.0);
            v += a * dt;
        }
        assert!((v - motion.velocity_mps()[3]).amax() < 1e-9);
        assert!((d - motion.displacement_m()[3]).amax() < 1e-8, "midpoint rule: dt² = 2.5e-9");
    }

    #[test]
    fn bad_nodes_are_refused_by_row() {
        let error = JerkControlledMotion::new(vec![0.0, 1.0, 1.0], vec![Vector3::zeros(); 3])
            .expect_err("equal times");
        assert!(error.to_string().contains("node 1 is at 1 s, node 2 at 1 s"), "{error}");
        assert!(JerkControlledMotion::new(vec![0.0, f64::NAN], vec![Vector3::zeros(); 2]).is_err());
        assert!(JerkControlledMotion::new(vec![0.0], vec![Vector3::zeros()]).is_err());
    }

    #[test]
    fn states_meet_the_nodes_and_are_each_others_derivatives() {
        let nodes = [0.5, 2.0, -1.0, 3.0].map(|a| Vector3::new(a, -a, 2.0 * a)).to_vec();
        let motion = JerkControlledMotion::uniform(0.5, nodes).expect("valid");
        let at = |t: f64| motion.states_at(&[t])[0];
        for (i, &t) in motion.times_s().iter().enumerate() {
            assert!((at(t).velocity_mps - motion.velocity_mps()[i]).amax() < 1e-14);
            assert!((at(t).displacement_m - motion.displacement_m()[i]).amax() < 1e-14);
        }
        let h = 1e-4;
        for t in [0.1, 0.3, 0.77, 1.2, 1.4] {
            let slope = (at(t + h).displacement_m - at(t - h).displacement_m) / (2.0 * h);
            assert!((slope - at(t).velocity_mps).amax() < 1e-7, "differences: h² |u|/6");
            let slope = (at(t + h).velocity_mps - at(t - h).velocity_mps) / (2.0 * h);
            assert!((slope - motion.acceleration_at(t)).amax() < 1e-9);
        }
        assert_eq!(at(0.5).jerk_mps3, motion.jerk_mps3()[1]);
        assert_eq!(at(9.0).velocity_mps, at(1.5).velocity_mps, "clamped to the end");
    }
}

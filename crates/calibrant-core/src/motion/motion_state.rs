//! The state of a motion at any time, from exact polynomials between the nodes.
//!
//! Inside interval i, `s` after its start: `a = a_i + u_i s`, `v = v_i + a_i s + u_i s²/2`, `d = d_i + v_i s + a_i s²/2 + u_i s³/6`.

use super::JerkControlledMotion;
use nalgebra::Vector3;

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

    /// Velocity at time t, m/s, from rest.
    #[must_use]
    pub fn velocity_at(&self, t: f64) -> Vector3<f64> {
        self.states_at(&[t])[0].velocity_mps
    }

    /// Displacement at time t, m, from the origin.
    #[must_use]
    pub fn displacement_at(&self, t: f64) -> Vector3<f64> {
        self.states_at(&[t])[0].displacement_m
    }

    /// Jerk at time t, m/s³. At a node it is the jerk of the interval that begins there.
    #[must_use]
    pub fn jerk_at(&self, t: f64) -> Vector3<f64> {
        self.states_at(&[t])[0].jerk_mps3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_meet_the_nodes_and_are_each_others_derivatives() {
        let nodes = [0.5, 2.0, -1.0, 3.0].map(|a| Vector3::new(a, -a, 2.0 * a)).to_vec();
        let motion = JerkControlledMotion::uniform(0.5, nodes).expect("valid");
        for (i, &t) in motion.times_s().iter().enumerate() {
            assert!((motion.velocity_at(t) - motion.velocity_mps()[i]).amax() < 1e-14);
            assert!((motion.displacement_at(t) - motion.displacement_m()[i]).amax() < 1e-14);
        }
        let h = 1e-4;
        for t in [0.1, 0.3, 0.77, 1.2, 1.4] {
            let slope = (motion.displacement_at(t + h) - motion.displacement_at(t - h)) / (2.0 * h);
            assert!((slope - motion.velocity_at(t)).amax() < 1e-7, "differences: h² |u|/6");
            let slope = (motion.velocity_at(t + h) - motion.velocity_at(t - h)) / (2.0 * h);
            assert!((slope - motion.acceleration_at(t)).amax() < 1e-9);
        }
        assert_eq!(motion.jerk_at(0.5), motion.jerk_mps3()[1]);
        assert_eq!(motion.velocity_at(9.0), motion.velocity_at(1.5), "clamped to the end");
    }
}

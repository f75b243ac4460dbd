//! The motion at the times of a grid: joints and what the sensor feels.

use crate::motion::{Grid, derivatives};
use crate::recursion::{JointAt, Links, Sweep, V};
use nalgebra::DMatrix;

/// Working memory, filled for one motion.
#[derive(Debug, Clone)]
pub(crate) struct Sampled {
    n: usize,
    joints: Vec<JointAt>,
    jerks: Vec<f64>,
    sweeps: Vec<Sweep>,
    readings: Vec<[V; 2]>,
}

impl Sampled {
    /// For this many joints and times.
    pub(crate) fn new(n: usize, times: usize) -> Self {
        Self {
            n,
            joints: vec![JointAt::REST; n * times],
            jerks: vec![0.0; n * times],
            sweeps: vec![Sweep::new(n); times],
            readings: vec![[V::ZERO; 2]; times],
        }
    }

    /// The motion of these control points.
    pub(crate) fn fill(&mut self, links: &Links, grid: &Grid, controls: &DMatrix<f64>) {
        for (k, sweep) in self.sweeps.iter_mut().enumerate() {
            let (i, rows) = grid.rows(k);
            let joints = &mut self.joints[k * self.n..(k + 1) * self.n];
            for (j, joint) in joints.iter_mut().enumerate() {
                let [q, qd, qdd, qddd] = derivatives(controls, i, rows, j);
                *joint = JointAt::new(q, qd, qdd);
                self.jerks[k * self.n + j] = qddd;
            }
            sweep.forward(links, joints);
            self.readings[k] = sweep.readings();
        }
    }

    /// The third derivatives, after [`Self::fill`].
    pub(crate) fn thirds(&mut self, links: &Links) {
        for (k, sweep) in self.sweeps.iter_mut().enumerate() {
            let of = k * self.n..(k + 1) * self.n;
            sweep.thirds(links, &self.joints[of.clone()], &self.jerks[of]);
        }
    }

    /// Number of times.
    pub(crate) fn len(&self) -> usize {
        self.sweeps.len()
    }

    /// Joints at time `k`.
    pub(crate) fn joints(&self, k: usize) -> &[JointAt] {
        &self.joints[k * self.n..(k + 1) * self.n]
    }

    /// Motions along the chain at time `k`.
    pub(crate) fn sweep(&self, k: usize) -> &Sweep {
        &self.sweeps[k]
    }

    /// `(1, f)` and `(1, w)` at time `k`.
    pub(crate) fn regressors(&self, k: usize) -> [[f64; 4]; 2] {
        let [V([fx, fy, fz]), V([wx, wy, wz])] = self.readings[k];
        [[1.0, fx, fy, fz], [1.0, wx, wy, wz]]
    }
}

/// Adds the derivative of a scalar by the joints at a time to that by the control points. `bars` are those of positions, velocities, accelerations, jerks.
pub(crate) fn scatter(gradient: &mut DMatrix<f64>, grid: &Grid, k: usize, j: usize, bars: [f64; 4]) {
    let (i, rows) = grid.rows(k);
    let mut column = gradient.column_mut(j);
    for r in 0..4 {
        column[i + r] +=
            rows[0][r] * bars[0] + rows[1][r] * bars[1] + rows[2][r] * bars[2] + rows[3][r] * bars[3];
    }
}

//! The information with the nuisances known, and its gradient.
//!
//! It is that of the moments `M_s` alone: `dΦ = −Σ_s tr(Ω_s dM_s)`, with `Ω_s` the sum of the blocks of `Ω` of the rows of sensor `s`.
//! A sample has the bars `−2 w Ω_s φ` of its reading, and `w φᵀ Ω_s φ ∂ln g` of its speed.

use super::criterion::Valued;
use super::sampled::scatter;
use super::sensing::{Quadrature, of_entries};
use super::sensor_columns::entry;
use super::{Sampled, Sensing, moments};
use crate::motion::Knots;
use crate::recursion::{JointBars, Moving, V};
use nalgebra::{DMatrix, Matrix4, Vector4};

/// Its working memory.
pub(crate) struct PlainInformation<'a> {
    sensing: &'a Sensing,
    pub(crate) quadrature: Quadrature,
    sampled: Sampled,
}

impl<'a> PlainInformation<'a> {
    pub(crate) fn new(sensing: &'a Sensing, knots: Knots, points: usize) -> Self {
        let quadrature = Quadrature::new(knots, points);
        let sampled = Sampled::new(sensing.links.len(), quadrature.grid.len());
        Self { sensing, quadrature, sampled }
    }

    /// The criterion at a motion.
    pub(crate) fn at(&mut self, controls: &DMatrix<f64>) -> Option<Valued> {
        self.sampled.fill(&self.sensing.links, &self.quadrature.grid, controls);
        let entries = of_entries(&moments(self.sensing, &self.quadrature, &self.sampled));
        let information = self.sensing.columns.of_parameters(&entries) + self.sensing.sensor_prior();
        self.sensing.criterion.at(&information)
    }

    /// The derivative by the control points, at the motion of the last value.
    pub(crate) fn gradient(&self, valued: &Valued) -> DMatrix<f64> {
        let (sensing, sampled, grid) = (self.sensing, &self.sampled, &self.quadrature.grid);
        let n = sensing.links.len();
        let omega = sensing.columns.of_entries(&valued.omega);
        let omegas: [Matrix4<f64>; 2] = [0, 1].map(|s| {
            (0..3).map(|row| omega.fixed_view::<4, 4>(entry(s, row, 0), entry(s, row, 0)).into_owned()).sum()
        });
        let mut gradient = DMatrix::zeros(grid.knots.controls(), n);
        let mut bars = vec![JointBars::ZERO; n];
        for k in 0..sampled.len() {
            let weights = sensing.weights(&self.quadrature, sampled, k);
            let (mut readings, mut told) = ([V::ZERO; 2], 0.0);
            for (s, phi) in sampled.regressors(k).into_iter().enumerate() {
                let phi = Vector4::from(phi);
                let column = omegas[s] * phi;
                told += weights[s] * phi.dot(&column);
                for i in 0..3 {
                    readings[s].0[i] = -2.0 * weights[s] * column[1 + i];
                }
            }
            let joints = sampled.joints(k);
            bars.fill(JointBars::ZERO);
            sampled.sweep(k).reverse(&sensing.links, joints, &readings, |_| Moving::ZERO, &mut bars);
            let growth = sensing.growth.at(joints);
            for (j, bar) in bars.iter().enumerate() {
                let of_growth = told * growth.slope(joints, j);
                scatter(&mut gradient, grid, k, j, [bar.q, bar.qd + of_growth, bar.qdd, 0.0]);
            }
        }
        gradient
    }
}

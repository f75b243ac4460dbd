//! Slope and second derivative of a smooth criterion (A, D, c, I) with respect to a short motion.
//!
//! With `Ω = C (∂Φ/∂C) C` and `Ω = R Rᵀ`, `C = L Lᵀ`,
//!
//! `dΦ = −⟨Ω, dF⟩`, `d²Φ = κ ‖Lᵀ dF R‖² − ⟨Ω, d²F⟩`, κ = 2, or 1 for D with `R = L`.
//!
//! The solver minimises a transformed criterion that grows in proportion to the information: `−1/Φ`, or
//! `−exp(−Φ/p)` for D. Its second derivative is smaller by `2 dΦ²/Φ`, or `dΦ²/p`. Doubling the information
//! halves a variance and no more, which makes Newton's method slow from a poor start; the transformation takes
//! that away. Both have the same optima.
//!
//! For D with a floor, `Φ = ln det (floor + C)`: `Ω = C (floor + C)⁻¹ C`, and `L Lᵀ = 2 C − Ω` in
//! `d²Φ = ‖Lᵀ dF R‖² − ⟨Ω, d²F⟩`. Without a floor this is the same as above.
//!
//! # The kinks of the noise
//! Noise in proportion to the jerk, `q = Δτ² (floor + ratio |u|)²`, has a kink of `2 floor ratio Δτ` per
//! increment at jerk zero. Slope and second derivative are those of the side on which the increment lies.

use super::Part;
use calibrant_core::information::{Criterion, Linearised};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// The model of a criterion at a motion: `Φ + slope·δ + ½ δᵀ hessian δ + Σ kinks |u|`.
pub(crate) struct SecondOrder<const D: usize> {
    /// Slope with respect to coordinate k of node i, at `i D + k`.
    pub(crate) slope: DVector<f64>,
    /// Second derivative of the transformed criterion.
    pub(crate) hessian: DMatrix<f64>,
    /// Weight of each increment's size at zero, at `i D + k`. Empty where there is no kink.
    pub(crate) kinks: Vec<f64>,
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// The model at a motion, its increments on the sides that `signs` tell. `None` for criteria that are not
    /// smooth, for motions of which nothing is known, and where the motion does not determine the parameters.
    pub(crate) fn second_order(
        &self,
        a: &[SVector<f64, D>],
        signs: &[SVector<f64, D>],
    ) -> Option<SecondOrder<D>> {
        let at = self.information.linearise(a)?;
        let c = self.covariance(&at)?;
        let value = self.criterion_at(&c);
        let (factor, transformed) = match &self.criterion {
            Criterion::E(_) | Criterion::M(_) => return None,
            Criterion::D(_) => (1.0, 1.0 / P as f64),
            _ => (2.0, 2.0 / value),
        };
        let lower = c.clone().cholesky()?.unpack();
        let right = self.right_factor(&c, &lower)?;
        let omega = &right * right.transpose();
        let lower =
            if self.floor_of_d().is_some() { (&c * 2.0 - &omega).cholesky()?.unpack() } else { lower };
        let fixed = |m: &DMatrix<f64>| SMatrix::<f64, P, P>::from_fn(|i, j| m[(i, j)]);
        let omega = self.on_information(&fixed(&omega));
        let left = self.factor_on_information(fixed(&lower)).transpose();
        let right = self.factor_on_information(fixed(&right));

        let curvature = self.information.curvature(a, &at, signs)?;
        let mut forms = DMatrix::zeros(P * P, a.len() * D);
        for (mut column, first) in forms.column_iter_mut().zip(&curvature.first) {
            column.copy_from_slice((left * first * right).as_slice());
        }
        let (slope, kinks) = self.slope(a, &at, &omega, signs);
        let mut hessian = forms.transpose() * &forms * factor - curvature.second(&omega);
        hessian.ger(-transformed, &slope, &slope, 1.0);
        Some(SecondOrder { slope, hessian, kinks })
    }

    /// R with `Ω = R Rᵀ`.
    fn right_factor(&self, c: &DMatrix<f64>, lower: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        if let Criterion::D(_) = self.criterion {
            let Some(floor) = self.floor_of_d() else { return Some(lower.clone()) };
            // C (floor + C)⁻¹ C = (K⁻¹ C)ᵀ K⁻¹ C
            let factor = (floor + c).cholesky()?.unpack();
            return Some(factor.solve_lower_triangular(c)?.transpose());
        }
        let eigen = self.criterion.derivative(c).symmetric_eigen();
        let root = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
        Some(c * eigen.eigenvectors * DMatrix::from_diagonal(&root))
    }

    /// The slope on the sides that `signs` tell, and the kinks.
    fn slope(
        &self,
        a: &[SVector<f64, D>],
        at: &Linearised<D, P>,
        omega: &SMatrix<f64, P, P>,
        signs: &[SVector<f64, D>],
    ) -> (DVector<f64>, Vec<f64>) {
        let derivative = self.information.derivative(at, omega);
        let total = self.information.total_on_sides(a, &derivative, signs);
        let slope = DVector::from_fn(a.len() * D, |at, _| -total[at / D][at % D]);
        let mut kinks = Vec::new();
        if let Some((floor, ratio)) =
            self.information.input_noise().filter(|(floor, ratio)| floor * ratio > 0.0)
        {
            for (i, variance) in derivative.variances.iter().enumerate() {
                let dt = self.information.interval_s(i);
                kinks.extend(variance.iter().map(|variance| -variance * 2.0 * floor * dt * ratio));
            }
        }
        (slope, kinks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Region;
    use crate::local_search::part::PartGravity;
    use calibrant_core::information::criterion::{AOptimality, DOptimality, IOptimality};
    use calibrant_core::information::{GravityMarginal, MotionInformation};
    use calibrant_core::motion::{
        AxisLimits, InputNoise, JerkControlledMotion, KnownEnds, MotionGravity, Trust,
    };
    use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
    use nalgebra::{Matrix3, Vector3};

    fn motion() -> JerkControlledMotion {
        let node = |i: usize| {
            Vector3::new(1.3 * i as f64, 2.1 * i as f64 + 1.0, 0.7 * i as f64 + 2.0).map(f64::sin) * 3.0
        };
        JerkControlledMotion::uniform(0.7, (0..6).map(node).collect()).expect("valid")
    }

    /// Slope and second derivative against differences, of the value and of the slope.
    fn check(
        trust: Trust,
        criterion: Criterion,
        gravity: Option<MotionGravity>,
        prior: Option<&DMatrix<f64>>,
    ) {
        let sensor =
            Sensor { noise_mps2: Some(Vector3::repeat(0.01)), ..Sensor::triaxial(SensorModel::Full) };
        let matrix = Matrix3::new(1.1, 0.1, -0.05, 0.02, 0.9, 0.03, 0.04, -0.02, 1.05);
        let at = SensorParameters { bias: Vector3::zeros(), matrix, ..SensorParameters::identity() };
        let setting = MotionInformation::new(&sensor, at, trust, KnownEnds::Start, 10.0).expect("complete");
        let information = setting.full(&motion());
        let slots = information.slots;
        let marginal =
            gravity.map(|gravity| GravityMarginal::new(&sensor.parameter_list(), &at, &gravity, prior));
        let known = marginal.as_ref().map(|marginal| &marginal.prior).or(prior);
        let part = Part {
            regions: [0, 1, 2].map(|_| Region::new(AxisLimits::default(), &information.tau)),
            criterion: criterion.restricted(&slots),
            prior: known
                .map_or_else(SMatrix::zeros, |prior| SMatrix::from_fn(|i, j| prior[(slots[i], slots[j])])),
            gravity: marginal.as_ref().and_then(|marginal| PartGravity::of(marginal, &slots)),
            inside: information.nodes(&motion()),
            slack: 1.0,
            information,
        };
        let a = part.information.nodes(&motion());
        let signs: Vec<_> = a.windows(2).map(|pair| (pair[1] - pair[0]).map(f64::signum)).collect();
        let model = |a: &[SVector<f64, 3>]| part.second_order(a, &signs).expect("regular");
        let here = model(&a);
        let value = part.value(&a);
        let factor = if let Criterion::D(_) = part.criterion { 1.0 / 12.0 } else { 2.0 / value };
        let (slope_size, size) = (here.slope.amax(), here.hessian.amax());
        for place in 0..a.len() * 3 {
            let moved = |by: f64| {
                let mut moved = a.clone();
                moved[place / 3][place % 3] += by;
                moved
            };
            let h = 2e-3;
            let near = [h, -h, 2.0 * h, -2.0 * h].map(moved);
            let [p, m, pp, mm] = near.each_ref().map(|a| part.value(a));
            let difference = (8.0 * (p - m) - (pp - mm)) / (12.0 * h);
            assert!(
                (here.slope[place] - difference).abs() < 1e-6 * slope_size,
                "{place}: {} {difference}",
                here.slope[place]
            );
            let [p, m, pp, mm] = near.each_ref().map(|a| model(a).slope);
            let second = ((p - m) * 8.0 - (pp - mm)) / (12.0 * h);
            for other in 0..a.len() * 3 {
                let expected = second[other] - factor * here.slope[place] * here.slope[other];
                let own = here.hessian[(place, other)];
                assert!((own - expected).abs() < 2e-5 * size, "{place} {other}: {own} {expected}, {size}");
            }
        }
    }

    #[test]
    fn slope_and_second_derivative_are_those_of_differences_with_gravity_and_without() {
        let noisy = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.02 });
        let list = Sensor::triaxial(SensorModel::Full).parameter_list();
        let scale = DVector::from_fn(12, |i, _| 0.5 + 0.1 * (i * i % 7) as f64);
        let prior = DMatrix::from_fn(12, 12, |i, j| 1e3 / (1.0 + (i as f64 - j as f64).abs()));
        let slanted =
            MotionGravity { tilt_sd_rad: 1e-3, ..MotionGravity::of_force(Vector3::new(3.0, -4.0, 8.4)) };
        for criterion in [
            Criterion::A(AOptimality { scale: scale.clone() }),
            Criterion::D(DOptimality { scale }),
            Criterion::I(IOptimality::new(&list, &SensorParameters::identity(), 20.0).expect("regular")),
        ] {
            for trust in [Trust::Known, noisy] {
                check(trust, criterion.clone(), None, None);
                check(trust, criterion.clone(), Some(slanted), None);
                check(trust, criterion.clone(), Some(slanted), Some(&prior));
            }
        }
    }
}

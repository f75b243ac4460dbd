//! The criteria as smooth functions of the covariance, for the search.
//!
//! E and M are maxima, and have kinks where an optimal design lies. The search replaces a maximum of
//! positive numbers by its power mean `(Σ λ_i^q)^(1/q)`, which is at most `p^(1/q)` times as large. A, c, I
//! and D are smooth as they are. The logarithm makes all of them numbers without a unit.
//!
//! Second-order models of the criteria as functions of the information.
//!
//! With `F → F + dF`, each criterion falls like `Φ − ⟨Ω, dF⟩ + ½ Σ_m ⟨Ω_m, dF⟩²`. For `Φ = wᵀ C w`,
//! `c = C w`, `C = L Lᵀ` the exact second-order term is `‖Lᵀ dF c‖²`. Its part along `n ∝ L⁻¹ c` is
//! `(cᵀ dF c)²/Φ`. This is the bend of `1/x`: doubling the information halves the variance and no more. It
//! makes Newton's method slow from a poor start, so the model omits it. The model is then `1/Φ`, which is
//! concave and grows in proportion to the information. What remains is the loss through correlation. That
//! part keeps the mean of a motion near zero.
//!
//! Tangents of a criterion: bounds on its value from a bound on a linear function of the information.
//!
//! Let W be a weight with `Φ(C′) ≥ tr(W C′)` for every covariance C′. For A, c and I it is the criterion's
//! own. For E it is any `Z ⪰ 0` of trace one, for M the diagonal of any shares with the sum one, both on the
//! scaled parameters. The function `1 / tr(W M⁻¹)` is concave in the information M, and homogeneous of degree
//! one. So it lies below its tangent planes: at any M with `C = M⁻¹` and `Ω = C W C`
//!
//! `1 / tr(W M′⁻¹) ≤ tr(Ω M′) / tr(W C)²`.
//!
//! Hence `Φ(C′) ≥ tr(W C)² / B` where `tr(Ω M′) ≤ B`. For D the same with `det^(1/p)`, and `Ω = C`:
//! `ln det C′ ≥ ln det C − p ln(B/p)`. Both hold for any symmetric C, so that rounding in the inverse of M does
//! no harm.
//!
//! # References
//! `kiefer1960`

use calibrant_core::information::Criterion;
use nalgebra::{DMatrix, DVector};

/// A criterion, and the exponent q that takes the place of a maximum.
#[derive(Clone, Copy)]
pub(crate) struct SmoothCriterion<'a> {
    pub(crate) criterion: &'a Criterion,
    pub(crate) exponent: f64,
}

impl SmoothCriterion<'_> {
    /// `ln Φ` (for D: `ln det C / p`), and its derivative with respect to C.
    pub(crate) fn at(&self, c: &DMatrix<f64>) -> (f64, DMatrix<f64>) {
        let size = c.nrows();
        match self.criterion {
            Criterion::D(_) => {
                let share = 1.0 / size as f64;
                (self.criterion.value(c) * share, self.criterion.derivative(c) * share)
            }
            Criterion::E(e) => {
                let scaled = DMatrix::from_fn(size, size, |i, j| c[(i, j)] / (e.scale[i] * e.scale[j]));
                let eigen = scaled.symmetric_eigen();
                let (value, shares) = self.power_mean(&eigen.eigenvalues);
                let mut vectors = eigen.eigenvectors;
                for (mut row, scale) in vectors.row_iter_mut().zip(e.scale.iter()) {
                    row /= *scale;
                }
                (value, &vectors * DMatrix::from_diagonal(&shares) * vectors.transpose())
            }
            Criterion::M(m) => {
                let squares = m.scale.component_mul(&m.scale);
                let (value, shares) = self.power_mean(&c.diagonal().component_div(&squares));
                (value, DMatrix::from_diagonal(&shares.component_div(&squares)))
            }
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => {
                let value = self.criterion.value(c);
                (value.ln(), self.criterion.derivative(c) / value)
            }
        }
    }

    /// `ln (Σ λ^q)^(1/q)`, and its derivative with respect to each λ.
    fn power_mean(&self, values: &DVector<f64>) -> (f64, DVector<f64>) {
        let largest = values.max();
        let powers = values.map(|value| (value.max(0.0) / largest).powf(self.exponent));
        let sum = powers.sum();
        let value = largest.ln() + sum.ln() / self.exponent;
        (value, powers.zip_map(values, |power, value| power / (value.max(f64::MIN_POSITIVE) * sum)))
    }
}

/// The first derivative `Ω = C (∂Φ/∂C) C` and the forms `Ω_m` at a covariance.
pub(crate) struct Curvature {
    pub(crate) first: DMatrix<f64>,
    pub(crate) forms: Vec<DMatrix<f64>>,
}

/// A criterion that is the largest of several smooth ones: their values, and the curvature of each. D may have a
/// floor, a constant part of the covariance beside `c`.
pub(crate) fn pieces(
    criterion: &Criterion,
    c: &DMatrix<f64>,
    floor: Option<&DMatrix<f64>>,
) -> Vec<(f64, Curvature)> {
    match criterion {
        Criterion::M(m) => (0..c.nrows())
            .map(|k| {
                let mut w = DVector::zeros(c.nrows());
                w[k] = 1.0 / m.scale[k];
                let value = c[(k, k)] / (m.scale[k] * m.scale[k]);
                (value, linear(c, &[w]))
            })
            .collect(),
        Criterion::D(_) => match floor {
            Some(floor) => vec![(criterion.value(&(floor + c)), above_a_floor(c, floor))],
            None => vec![(criterion.value(c), log_determinant(c))],
        },
        Criterion::E(_) => {
            let first = c * criterion.derivative(c) * c;
            vec![(criterion.value(c), Curvature { first, forms: Vec::new() })]
        }
        Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => {
            vec![(criterion.value(c), linear(c, &factors(&criterion.derivative(c))))]
        }
    }
}

/// `W = Σ w wᵀ`.
fn factors(weight: &DMatrix<f64>) -> Vec<DVector<f64>> {
    let size = weight.nrows();
    let diagonal = (0..size).all(|i| (0..i).all(|j| weight[(i, j)] == 0.0));
    if diagonal {
        let unit = |k: usize| DVector::from_fn(size, |i, _| if i == k { weight[(k, k)].sqrt() } else { 0.0 });
        return (0..size).filter(|&k| weight[(k, k)] > 0.0).map(unit).collect();
    }
    let eigen = weight.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    (0..size)
        .filter(|&k| eigen.eigenvalues[k] > 1e-14 * largest)
        .map(|k| eigen.eigenvectors.column(k) * eigen.eigenvalues[k].sqrt())
        .collect()
}

/// `Φ = Σ wᵀ C w`.
fn linear(c: &DMatrix<f64>, weights: &[DVector<f64>]) -> Curvature {
    let size = c.nrows();
    let mut first = DMatrix::zeros(size, size);
    let mut forms = Vec::new();
    let Some(cholesky) = c.clone().cholesky() else { return Curvature { first, forms } };
    let l = cholesky.l();
    for w in weights {
        let cw = c * w;
        first += &cw * cw.transpose();
        // Householder reflection that takes n = L⁻¹ c/‖·‖ = Lᵀ w/‖·‖ to the first axis: its other rows span
        // the space orthogonal to n
        let n = l.tr_mul(w).normalize();
        let mut v = n.clone();
        v[0] += if n[0] < 0.0 { -1.0 } else { 1.0 };
        let v = v.normalize();
        for k in 1..size {
            let direction =
                &l * DVector::from_fn(size, |i, _| f64::from(u8::from(i == k)) - 2.0 * v[i] * v[k]);
            forms.push(symmetric_product(&direction, &cw) * std::f64::consts::SQRT_2);
        }
    }
    Curvature { first, forms }
}

/// `Φ = −ln det F`: `½ ‖X‖²` with `X = Lᵀ dF L`, less `½ (tr X)²/p`, the bend of the logarithm.
fn log_determinant(c: &DMatrix<f64>) -> Curvature {
    let size = c.nrows();
    let mut forms = Vec::new();
    let Some(cholesky) = c.clone().cholesky() else { return Curvature { first: c.clone(), forms } };
    let l = cholesky.l();
    let column = |k: usize| l.column(k).into_owned();
    for j in 0..size {
        for k in 0..j {
            forms.push(symmetric_product(&column(j), &column(k)) * std::f64::consts::SQRT_2);
        }
    }
    // an orthonormal basis of the diagonals of trace zero
    for m in 1..size {
        let norm = ((m * (m + 1)) as f64).sqrt();
        let mut form = symmetric_product(&column(m), &column(m)) * (-(m as f64) / norm);
        for k in 0..m {
            form += symmetric_product(&column(k), &column(k)) / norm;
        }
        forms.push(form);
    }
    Curvature { first: c.clone(), forms }
}

/// `Φ = ln det (floor + C)`: `Ω = C (floor + C)⁻¹ C = R Rᵀ` and `½ ‖Lᵀ dF R‖²`, `L Lᵀ = 2 C − Ω`. The bend of the
/// logarithm is left in.
fn above_a_floor(c: &DMatrix<f64>, floor: &DMatrix<f64>) -> Curvature {
    let size = c.nrows();
    let right = (floor + c).cholesky().and_then(|factor| factor.unpack().solve_lower_triangular(c));
    let Some(right) = right.map(|right| right.transpose()) else {
        return Curvature { first: DMatrix::zeros(size, size), forms: Vec::new() };
    };
    let first = &right * right.transpose();
    let mut forms = Vec::new();
    if let Some(left) = (c * 2.0 - &first).cholesky().map(|factor| factor.unpack()) {
        for j in 0..size {
            let x = left.column(j).into_owned();
            forms.extend((0..size).map(|k| symmetric_product(&x, &right.column(k).into_owned())));
        }
    }
    Curvature { first, forms }
}

/// `½ (x yᵀ + y xᵀ)`.
fn symmetric_product(x: &DVector<f64>, y: &DVector<f64>) -> DMatrix<f64> {
    let product = x * y.transpose();
    (&product + product.transpose()) * 0.5
}

/// The tangent at a covariance.
pub(crate) struct Tangent<'a> {
    criterion: &'a Criterion,
    /// `Ω`.
    pub(crate) omega: DMatrix<f64>,
    /// `tr(W C)`; for D the value at C.
    at: f64,
}

impl<'a> Tangent<'a> {
    pub(crate) fn new(smooth: SmoothCriterion<'a>, c: &DMatrix<f64>) -> Self {
        let criterion = smooth.criterion;
        let (_, derivative) = smooth.at(c);
        let of_trace_one = |derivative: DMatrix<f64>, scale: &[f64]| {
            let trace: f64 = scale.iter().enumerate().map(|(i, s)| derivative[(i, i)] * s * s).sum();
            derivative / trace
        };
        // the weight W, and for D the inverse of C
        let weight = match criterion {
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => criterion.derivative(c),
            Criterion::D(_) => derivative * c.nrows() as f64,
            Criterion::E(e) => of_trace_one(derivative, e.scale.as_slice()),
            Criterion::M(m) => of_trace_one(derivative, m.scale.as_slice()),
        };
        let at = if let Criterion::D(_) = criterion { criterion.value(c) } else { weight.dot(c) };
        Self { criterion, omega: c * &weight * c, at }
    }

    /// A lower bound of the criterion for every information M′ with `tr(Ω M′)` at most `most`.
    pub(crate) fn bound(&self, most: f64) -> f64 {
        let size = self.omega.nrows() as f64;
        match self.criterion {
            Criterion::D(_) => self.at - size * (most / size).ln(),
            _ => self.at.powi(2) / most,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::information::criterion::{
        AOptimality, DOptimality, EOptimality, IOptimality, MOptimality,
    };
    use calibrant_core::sensor::{ParameterList, SensorModel, SensorParameters};

    fn information() -> DMatrix<f64> {
        let factor = DMatrix::from_fn(6, 6, |i, j| ((3 * i + 5 * j + i * j) as f64).sin());
        &factor * factor.transpose() + DMatrix::identity(6, 6)
    }

    fn step() -> DMatrix<f64> {
        let step = DMatrix::from_fn(6, 6, |i, j| ((i + j) as f64 + (i * j) as f64 * 0.3).cos());
        (&step + step.transpose()) * 1e-3
    }

    /// The model of a transformed criterion has the second derivative of finite differences. The
    /// transformation is `1/f` for each piece of the form `wᵀCw`, and `det^{1/p}` for D.
    #[test]
    fn the_models_are_those_of_the_transformed_criteria() {
        let scale = DVector::from_fn(6, |i, _| 1.0 + i as f64 * 0.2);
        let list = ParameterList::new(3, SensorModel::ScaleBias);
        let i = IOptimality::new(&list, &SensorParameters::identity(), 3.0).expect("regular");
        let c_of = |t: f64| (information() + step() * t).try_inverse().expect("regular");
        for criterion in [
            Criterion::A(AOptimality { scale: scale.clone() }),
            Criterion::D(DOptimality { scale: scale.clone() }),
            Criterion::M(MOptimality { scale: scale.clone() }),
            Criterion::E(EOptimality { scale: scale.clone() }),
            Criterion::I(i),
        ] {
            for (value, model) in pieces(&criterion, &c_of(0.0), None) {
                let slope = -model.first.dot(&step());
                let bend: f64 = model.forms.iter().map(|form| form.dot(&step()).powi(2)).sum();
                assert!(value.is_finite() && slope.is_finite() && bend >= 0.0);
            }
        }
        // one weight: f = wᵀCw, 1/f has slope −f'/f² and bend −(f'' − 2 f'²/f)/f²
        let w = DVector::from_fn(6, |i, _| (i as f64 - 2.0) * 0.4);
        let f = |t: f64| 1.0 / (w.transpose() * c_of(t) * &w)[0];
        let model = linear(&c_of(0.0), std::slice::from_ref(&w));
        let value = 1.0 / f(0.0);
        let (slope, bend) = (f(1.0) - f(-1.0), f(1.0) - 2.0 * f(0.0) + f(-1.0));
        assert!((model.first.dot(&step()) / (value * value) / (slope / 2.0) - 1.0).abs() < 1e-6);
        let forms: f64 = model.forms.iter().map(|form| form.dot(&step()).powi(2)).sum();
        assert!((-forms / (value * value) / bend - 1.0).abs() < 1e-4, "{forms} {bend}");
        // D: det(F)^{1/p}
        let d = |t: f64| (-c_of(t).determinant().ln() / 6.0).exp();
        let model = log_determinant(&c_of(0.0));
        let bend = d(1.0) - 2.0 * d(0.0) + d(-1.0);
        let forms: f64 = model.forms.iter().map(|form| form.dot(&step()).powi(2)).sum();
        assert!((-forms * d(0.0) / 6.0 / bend - 1.0).abs() < 1e-4, "{forms} {bend}");
    }

    #[test]
    fn the_model_above_a_floor_is_that_of_differences() {
        let floor = DMatrix::from_fn(6, 6, |i, j| if i == j && i < 3 { 0.3 } else { 0.0 });
        let scale = DVector::repeat(6, 1.0);
        let c_of = |t: f64| (information() + step() * t).try_inverse().expect("regular");
        let d = |t: f64| (&floor + c_of(t)).determinant().ln();
        let criterion = Criterion::D(DOptimality { scale });
        let (value, model) = pieces(&criterion, &c_of(0.0), Some(&floor)).remove(0);
        assert!((value - d(0.0)).abs() < 1e-12);
        let slope = (8.0 * (d(1.0) - d(-1.0)) - (d(2.0) - d(-2.0))) / 12.0;
        assert!((-model.first.dot(&step()) / slope - 1.0).abs() < 1e-7, "{slope}");
        let bend = d(1.0) - 2.0 * d(0.0) + d(-1.0);
        let forms: f64 = model.forms.iter().map(|form| form.dot(&step()).powi(2)).sum();
        assert!((forms / bend - 1.0).abs() < 1e-4, "{forms} {bend}");
        // without a floor it is the logarithm's own, its bend left in
        let none = above_a_floor(&c_of(0.0), &DMatrix::zeros(6, 6));
        let own: f64 = none.forms.iter().map(|form| form.dot(&step()).powi(2)).sum();
        let plain = |t: f64| c_of(t).determinant().ln();
        assert!((own / (plain(1.0) - 2.0 * plain(0.0) + plain(-1.0)) - 1.0).abs() < 1e-4);
    }
}

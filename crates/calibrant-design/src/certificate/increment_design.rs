//! The best approximate design of noisy increments: a bound on the criterion of a full sensor.
//!
//! Where only the start is known and the readings were perfect, `S⁻¹` times an increment of the readings would be
//! the increment of the motion, with its process noise. In `T = S⁻¹ dS`, the information would be
//!
//! `M = Σ_i m(u_i)`, block by block `m(u)_m = u uᵀ/σ_u(u_m)²` on row m of T.
//!
//! The rows do not want the same motion. The diagonal element `T_mm` wants a large jerk on axis m; the others
//! want axis m at rest, where its noise is at its floor. Bounds of the elements one by one let each have the
//! motion that suits it. This bound does not: replace the N intervals by N times a probability distribution of
//! the jerk, on the box that the limits leave to each interval. The best distribution solves a
//! convex problem, and what it reaches bounds every motion (Kiefer–Wolfowitz). The bound is that of the tangent
//! at any distribution, with the largest gain of an interval bounded over the whole box, so it
//! does not depend on how well the problem was solved.
//!
//! # All parameters
//! Let b be the biases, F the whole information. Then `C_SS ⪰ M⁻¹`: the information on S is smallest at the change of the biases that explains it
//! best, so it is no larger than at `db = −dS a_0`, which leaves the readings as they were. Earlier information
//! counts in full at that change, with the largest `a_0`. And `C_bb ⪰ F_bb⁻¹`. A, c and I are sums of
//! both parts, E and M no smaller than either, and `ln det C = ln det C_SS − ln det F_bb`.
//!
//! # The solver
//! The multiplicative algorithm multiplies each share by a power of its gain (`silvey1978`, `yu2010`). Shares that
//! vanish are dropped, and places of large gain that the bound has found join.
//!
//! # References
//! `kiefer1960`, `silvey1978`, `yu2010`

use super::largest_gain::IncrementGain;
use crate::Interruption;
use crate::criterion::{SmoothCriterion, Tangent};
use calibrant_core::information::{Criterion, covariance};
use calibrant_core::motion::InputNoise;
use calibrant_core::sensor::Quantity;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// What the increments of a motion can tell of S.
pub(super) struct IncrementDesign<'a> {
    pub(super) criterion: &'a Criterion,
    /// All parameters, in their order.
    pub(super) quantities: &'a [Quantity],
    /// The matrix S.
    pub(super) matrix: Matrix3<f64>,
    pub(super) noise: InputNoise,
    /// Largest jerk of each interval, m/s³.
    pub(super) jerk: Vec<Vector3<f64>>,
    /// Largest acceleration at the start, m/s².
    pub(super) start: Vector3<f64>,
    /// Largest information on all parameters that the biases can have (its block of the biases counts).
    pub(super) on_biases: &'a DMatrix<f64>,
    /// Information that is there already.
    pub(super) prior: Option<&'a DMatrix<f64>>,
}

/// Levels of the jerk of each axis in the first distribution.
const LEVELS: usize = 5;
/// Rounds of the solver and the bound.
const ROUNDS: usize = 10;
/// Steps of the solver in each round.
const STEPS: usize = 400;
/// Relative gap (nats for each parameter for D) at which the bound is as good as it gets.
const GAP: f64 = 1e-3;
/// Exponents of the power means for E and M, one for each round.
const EXPONENTS: [f64; 4] = [4.0, 8.0, 16.0, 32.0];
/// A share below this part of the largest is dropped.
const NEGLIGIBLE: f64 = 1e-5;
/// Share of an interval that a new jerk begins with.
const NEW: f64 = 0.02;
/// Most kinds of intervals; more are taken as one, with the largest jerk of any.
const MOST_KINDS: usize = 4;

/// Intervals with the same largest jerk, and the distribution of their jerk.
struct Kind {
    most: Vector3<f64>,
    count: f64,
    jerks: Vec<(f64, Vector3<f64>)>,
}

impl IncrementDesign<'_> {
    /// A lower bound of the criterion. `None` where process noise or limits leave the information unbounded.
    pub(super) fn bound(&self, interruption: &Interruption) -> Option<f64> {
        let bounded = self.jerk.iter().all(|most| most.iter().all(|u| u.is_finite()));
        if !bounded || self.noise.floor_mps3 <= 0.0 {
            return None;
        }
        let place = |is_bias: bool| -> Vec<usize> {
            let wanted = |q: &Quantity| matches!(q, Quantity::Bias(_)) == is_bias;
            (0..self.quantities.len()).filter(|&k| wanted(&self.quantities[k])).collect()
        };
        let (biases, elements) = (place(true), place(false));
        let on_biases = self.on_biases.select_rows(&biases).select_columns(&biases);
        let of_biases = self.criterion.restricted(&biases).value(&covariance(&on_biases)?);
        let criterion = self.criterion.restricted(&elements);
        let of_elements = self.of_elements(&criterion, &elements, &biases, interruption)?;
        let whole = self.criterion.combine([of_biases, of_elements]);
        let rounding = 1e-12 * (of_biases.abs() + of_elements.abs());
        whole.is_finite().then_some(whole - rounding)
    }

    /// The bound for the elements of S alone.
    fn of_elements(
        &self,
        criterion: &Criterion,
        elements: &[usize],
        biases: &[usize],
        interruption: &Interruption,
    ) -> Option<f64> {
        let to_rows = self.to_rows(elements)?;
        let prior = Prior::new(self, elements, biases)?;
        if matches!(criterion, Criterion::C(c) if c.weights.iter().all(|weight| *weight == 0.0)) {
            return Some(0.0);
        }
        let mut kinds = self.kinds();
        let mut best: Option<f64> = None;
        let is_kinked = matches!(criterion, Criterion::E(_) | Criterion::M(_));
        for round in 0..ROUNDS {
            if interruption.is_asked() {
                break;
            }
            let exponent = EXPONENTS[round.min(EXPONENTS.len() - 1)];
            let smooth = SmoothCriterion { criterion, exponent };
            // a power for which every step goes down
            let power = match criterion {
                Criterion::D(_) => 1.0,
                Criterion::E(_) | Criterion::M(_) => 1.0 / (1.0 + exponent),
                _ => 0.5,
            };
            let current = |kinds: &[Kind]| {
                let rows = self.information(kinds);
                covariance(&(to_rows.tr_mul(&rows) * &to_rows + &prior.at_rest))
            };
            for _ in 0..STEPS {
                let c = current(&kinds)?;
                let (_, derivative) = smooth.at(&c);
                let gain = self.gain(&to_rows, &(&c * derivative * &c));
                kinds.iter_mut().for_each(|kind| kind.step(&gain, power));
            }
            let c = current(&kinds)?;
            let tangent = Tangent::new(smooth, &c);
            let gain = self.gain(&to_rows, &tangent.omega);
            let mut most = prior.most(&tangent.omega);
            for kind in &mut kinds {
                let largest = gain.largest(&kind.most);
                most += kind.count * largest.bound;
                kind.join(&largest.places);
            }
            let found = tangent.bound(most);
            best = Some(best.map_or(found, |best| best.max(found)));
            let ended = criterion.gap(criterion.value(&c), found)
                <= GAP * if let Criterion::D(_) = criterion { c.nrows() as f64 } else { 1.0 };
            if ended && !(is_kinked && round + 1 < EXPONENTS.len()) {
                break;
            }
        }
        best.filter(|bound| bound.is_finite())
    }

    /// From the elements of S to those of `T = S⁻¹ dS`, row by row.
    fn to_rows(&self, elements: &[usize]) -> Option<DMatrix<f64>> {
        let inverse = self.matrix.try_inverse()?;
        let mut to_rows = DMatrix::zeros(9, elements.len());
        for (at, &place) in elements.iter().enumerate() {
            let (row, column) = match self.quantities[place] {
                Quantity::Scale(axis) => (axis.index(), axis.index()),
                Quantity::CrossAxis(row, column) => (row.index(), column.index()),
                _ => return None,
            };
            (0..3).for_each(|m| to_rows[(3 * m + column, at)] = inverse[(m, row)]);
        }
        Some(to_rows)
    }

    /// `M` on the rows of T.
    fn information(&self, kinds: &[Kind]) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(9, 9);
        for (share, u) in kinds.iter().flat_map(|kind| &kind.jerks) {
            let product = u * u.transpose();
            for m in 0..3 {
                let sd = self.noise.floor_mps3 + self.noise.ratio * u[m].abs();
                let mut block = rows.view_mut((3 * m, 3 * m), (3, 3));
                block += product * (share / (sd * sd));
            }
        }
        rows
    }

    /// The gain of an interval in `tr(Ω M)`.
    fn gain(&self, to_rows: &DMatrix<f64>, omega: &DMatrix<f64>) -> IncrementGain {
        let rows = to_rows * omega * to_rows.transpose();
        let block = |m: usize| Matrix3::from_fn(|i, j| rows[(3 * m + i, 3 * m + j)]);
        IncrementGain {
            omega: [block(0), block(1), block(2)],
            floor: self.noise.floor_mps3,
            ratio: self.noise.ratio,
        }
    }

    fn kinds(&self) -> Vec<Kind> {
        let mut found: Vec<(Vector3<f64>, f64)> = Vec::new();
        for most in &self.jerk {
            match found.iter_mut().find(|(other, _)| other == most) {
                Some((_, count)) => *count += 1.0,
                None => found.push((*most, 1.0)),
            }
        }
        if found.len() > MOST_KINDS {
            let all = found.iter().fold(Vector3::zeros(), |all: Vector3<f64>, (most, _)| all.sup(most));
            found = vec![(all, self.jerk.len() as f64)];
        }
        let levels = |most: f64| -> Vec<f64> {
            let InputNoise { floor_mps3: floor, ratio } = self.noise;
            let size = |level: usize| {
                let part = level as f64 / (LEVELS - 1) as f64;
                // the noise grows by the same factor from level to level
                if ratio * most > floor {
                    floor / ratio * ((1.0 + ratio * most / floor).powf(part) - 1.0)
                } else {
                    most * part
                }
            };
            (1..LEVELS).flat_map(|level| [size(level), -size(level)]).chain([0.0]).collect()
        };
        let kind = |(most, count): (Vector3<f64>, f64)| {
            let mut jerks = Vec::new();
            for x in levels(most.x) {
                for y in levels(most.y) {
                    jerks.extend(levels(most.z).into_iter().map(|z| Vector3::new(x, y, z)));
                }
            }
            // u and −u are equivalent
            jerks.retain(|u| u.iter().find(|u| **u != 0.0).is_some_and(|first| *first > 0.0));
            let share = count / jerks.len().max(1) as f64;
            Kind { most, count, jerks: jerks.into_iter().map(|u| (share, u)).collect() }
        };
        found.into_iter().map(kind).collect()
    }
}

impl Kind {
    /// A step of the multiplicative algorithm.
    fn step(&mut self, gain: &IncrementGain, power: f64) {
        for (share, u) in &mut self.jerks {
            *share *= gain.at(u).max(0.0).powf(power);
        }
        let largest = self.jerks.iter().map(|(share, _)| *share).fold(0.0, f64::max);
        self.jerks.retain(|(share, _)| *share > NEGLIGIBLE * largest);
        self.normalise();
    }

    /// Jerks that are not there yet join.
    fn join(&mut self, places: &[(f64, Vector3<f64>)]) {
        for (_, u) in places {
            if !self.jerks.iter().any(|(_, other)| other == u) {
                self.jerks.push((NEW * self.count, *u));
            }
        }
        self.normalise();
    }

    fn normalise(&mut self) {
        let sum: f64 = self.jerks.iter().map(|(share, _)| share).sum();
        if sum > 0.0 {
            self.jerks.iter_mut().for_each(|(share, _)| *share *= self.count / sum);
        }
    }
}

/// What earlier information says of S where the biases follow from it: `Eᵀ F⁰ E`, `db = −dS a_0`.
struct Prior {
    /// With the start at rest.
    at_rest: DMatrix<f64>,
    /// With the start at each corner of its box. It is convex in `a_0`.
    corners: Vec<DMatrix<f64>>,
}

impl Prior {
    fn new(design: &IncrementDesign<'_>, elements: &[usize], biases: &[usize]) -> Option<Self> {
        let size = elements.len();
        let Some(prior) = design.prior else {
            return Some(Self { at_rest: DMatrix::zeros(size, size), corners: Vec::new() });
        };
        let at = |start: Vector3<f64>| {
            let mut change = DMatrix::zeros(design.quantities.len(), size);
            for (column, &place) in elements.iter().enumerate() {
                change[(place, column)] = 1.0;
                let (row, axis) = match design.quantities[place] {
                    Quantity::Scale(axis) => (axis, axis),
                    Quantity::CrossAxis(row, axis) => (row, axis),
                    _ => continue,
                };
                let bias = |&&bias: &&usize| design.quantities[bias] == Quantity::Bias(row);
                if let Some(&bias) = biases.iter().find(bias) {
                    change[(bias, column)] = -start[axis.index()];
                }
            }
            change.tr_mul(prior) * &change
        };
        let corner = |corner: usize| {
            at(Vector3::from_fn(|m, _| if corner >> m & 1 == 1 { design.start[m] } else { -design.start[m] }))
        };
        let bounded = design.start.iter().all(|a| a.is_finite());
        bounded.then(|| Self { at_rest: at(Vector3::zeros()), corners: (0..8).map(corner).collect() })
    }

    /// The largest `⟨Ω, Eᵀ F⁰ E⟩`.
    fn most(&self, omega: &DMatrix<f64>) -> f64 {
        self.corners.iter().map(|corner| corner.dot(omega)).fold(0.0, f64::max)
    }
}

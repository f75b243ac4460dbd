//! The largest gain of information that one interval can bring, bounded by branch and bound.
//!
//! With perfect readings, an interval with jerk u adds `d(u) = Σ_m uᵀ Ω_m u / σ_m²`, `σ_m = floor + ratio |u_m|`,
//! to `tr(Ω M)`. Sought is its maximum over a box `|u| ≤ U`. The function is even, so four patterns of signs
//! are enough, each on a box of sizes.
//!
//! # The bound of a cell
//! In a cell, `1/σ_m²` is convex in `|u_m|` and lies below its chord. With the chords in its place, d is a
//! polynomial of degree 3 in each size. It is no larger than its largest Bernstein coefficient. Both
//! errors fall with the square of the cell's size. The cell with the largest bound is halved, until that bound
//! is close to a value that was found.
//!
//! # References
//! `garloff1993`

use nalgebra::{Matrix3, Vector3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The gain of one interval.
#[derive(Debug, Clone)]
pub(super) struct IncrementGain {
    /// `Ω_m`, one for each axis whose noise divides it. Positive semidefinite.
    pub(super) omega: [Matrix3<f64>; 3],
    /// Noise of the jerk, m/s³. Above 0.
    pub(super) floor: f64,
    /// Its share of the jerk.
    pub(super) ratio: f64,
}

/// An upper bound of the gain over a box.
pub(super) struct Largest {
    /// The bound.
    pub(super) bound: f64,
    /// Places where the gain is large, the best first, with the gain.
    pub(super) places: Vec<(f64, Vector3<f64>)>,
}

/// Relative distance between bound and value at which the search ends.
const CLOSE: f64 = 2e-4;
/// Most cells.
const MOST_CELLS: usize = 20_000;
/// Places with less than this share of the maximum are not kept.
const NEARLY: f64 = 0.97;
/// Most of those that are kept, and their distance in parts of the box.
const MOST_PLACES: usize = 16;
const APART: f64 = 0.04;
/// For the roundings of some hundred additions of numbers of one sign.
const ROUNDING: f64 = 1e-12;

/// Jerks of these sizes, with the signs of the pattern.
struct Cell {
    bound: f64,
    pattern: usize,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// The patterns of signs, up to a common one.
const PATTERNS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0]];

impl IncrementGain {
    fn weight(&self, size: f64) -> f64 {
        (self.floor + self.ratio * size).powi(-2)
    }

    /// The gain of a jerk.
    pub(super) fn at(&self, u: &Vector3<f64>) -> f64 {
        (0..3).map(|m| self.weight(u[m].abs()) * u.dot(&(self.omega[m] * u))).sum()
    }

    /// Bounds the gain over the box `|u| ≤ most`.
    pub(super) fn largest(&self, most: &Vector3<f64>) -> Largest {
        let mut places: Vec<(f64, Vector3<f64>)> = Vec::new();
        let mut cells = BinaryHeap::new();
        let mut best = 0.0_f64;
        for pattern in 0..PATTERNS.len() {
            cells.push(self.cell(pattern, Vector3::zeros(), *most, &mut places, &mut best));
        }
        let mut bound = f64::INFINITY;
        for _ in 0..MOST_CELLS {
            let Some(cell) = cells.pop() else { break };
            bound = cell.bound;
            if bound <= best * (1.0 + CLOSE) {
                break;
            }
            let relative = |m: usize| {
                let width = cell.high[m] - cell.low[m];
                self.ratio * width / (self.floor + self.ratio * cell.low[m]) + width / most[m].max(1e-300)
            };
            let split = (0..3).max_by(|&a, &b| relative(a).total_cmp(&relative(b))).unwrap_or(0);
            // the noise grows by the same factor in both halves
            let sigma = |size: f64| self.floor + self.ratio * size;
            let (low, high) = (cell.low[split], cell.high[split]);
            let middle = if self.ratio > 0.0 {
                ((sigma(low) * sigma(high)).sqrt() - self.floor) / self.ratio
            } else {
                (low + high) / 2.0
            };
            let middle = middle.clamp(low + 0.1 * (high - low), high - 0.1 * (high - low));
            let (mut inner, mut outer) = (cell.high, cell.low);
            (inner[split], outer[split]) = (middle, middle);
            cells.push(self.cell(cell.pattern, cell.low, inner, &mut places, &mut best));
            cells.push(self.cell(cell.pattern, outer, cell.high, &mut places, &mut best));
        }
        places.retain(|(value, _)| *value > NEARLY * best);
        places.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut kept: Vec<(f64, Vector3<f64>)> = Vec::new();
        for (value, u) in places {
            let is_close = |other: &Vector3<f64>| (0..3).all(|m| (u[m] - other[m]).abs() <= APART * most[m]);
            if kept.len() < MOST_PLACES && !kept.iter().any(|(_, other)| is_close(other)) {
                kept.push((value, u));
            }
        }
        Largest { bound: bound * (1.0 + ROUNDING), places: kept }
    }

    /// A cell with its bound. Its best corner joins the `places`.
    fn cell(
        &self,
        pattern: usize,
        low: Vector3<f64>,
        high: Vector3<f64>,
        places: &mut Vec<(f64, Vector3<f64>)>,
        best: &mut f64,
    ) -> Cell {
        let signs = Vector3::from(PATTERNS[pattern]);
        let corner = (0..8_usize)
            .map(|corner| {
                let u =
                    Vector3::from_fn(|m, _| signs[m] * if corner >> m & 1 == 1 { high[m] } else { low[m] });
                (self.at(&u), u)
            })
            .max_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((value, u)) = corner {
            *best = best.max(value);
            if value > NEARLY * *best {
                places.push((value, u));
            }
        }
        let bound = self.bernstein(&signs, &low, &high).into_iter().fold(0.0, f64::max);
        Cell { bound, pattern, low, high }
    }

    /// The Bernstein coefficients of d with chords, of degree 3 in each size.
    fn bernstein(&self, signs: &Vector3<f64>, low: &Vector3<f64>, high: &Vector3<f64>) -> [f64; 64] {
        let mut coefficients = [0.0; 64];
        for m in 0..3 {
            let chord = [self.weight(low[m]), self.weight(high[m])];
            for i in 0..3 {
                for j in 0..=i {
                    let twice = if i == j { 1.0 } else { 2.0 };
                    let factor = twice * signs[i] * signs[j] * self.omega[m][(i, j)];
                    // the product of the chord and two sizes, axis by axis
                    let along: [[f64; 4]; 3] = std::array::from_fn(|axis| {
                        let size = [low[axis], high[axis]];
                        let one = [1.0, 1.0];
                        cubic([
                            if axis == m { chord } else { one },
                            if axis == i { size } else { one },
                            if axis == j { size } else { one },
                        ])
                    });
                    for (k, coefficient) in coefficients.iter_mut().enumerate() {
                        *coefficient += factor * along[0][k / 16] * along[1][k / 4 % 4] * along[2][k % 4];
                    }
                }
            }
        }
        coefficients
    }
}

/// Bernstein coefficients of the product of three lines on [0, 1], each given by its ends.
fn cubic([a, b, c]: [[f64; 2]; 3]) -> [f64; 4] {
    [
        a[0] * b[0] * c[0],
        (a[1] * b[0] * c[0] + a[0] * b[1] * c[0] + a[0] * b[0] * c[1]) / 3.0,
        (a[1] * b[1] * c[0] + a[1] * b[0] * c[1] + a[0] * b[1] * c[1]) / 3.0,
        a[1] * b[1] * c[1],
    ]
}

//! A dual active-set method for dense, strictly convex quadratic programs.
//!
//! `minimise ½ xᵀ H x + gᵀ x` subject to `lower ≤ r·x ≤ upper` for each row r.
//!
//! The minimum without rows is known in closed form. The method adds the row that is violated most, moves to
//! the minimum with it among the active rows, and drops the rows whose multipliers would become negative on
//! the way. Every step raises the minimum, so no set of active rows occurs twice.
//!
//! # The factorisation
//! With `H = L Lᵀ` and the normals N of the q active rows, `L⁻¹ N = Q [R; 0]` and `J = L⁻ᵀ Q = [J₁ J₂]`. Then
//!
//! - the minimum with the rows as equalities `Nᵀ x = b` is `x = J₁ R⁻ᵀ b − J₂ J₂ᵀ g`,
//! - its multipliers are `u = R⁻¹ (R⁻ᵀ b + J₁ᵀ g)`,
//! - a new row n moves x along `z = J₂ J₂ᵀ n` and the multipliers along `−R⁻¹ J₁ᵀ n`.
//!
//! A new row costs a Householder reflection of J₂, a dropped one Givens rotations: `O(n²)` each. The next
//! program of a sequence has another H, so its factorisation is new. It starts with the active rows of the
//! last one ([`ActiveSet::begin`]), as far as their multipliers are not negative. Rows may be added to a
//! solved program, and the method goes on from there.
//!
//! # References
//! `goldfarb1983`

use nalgebra::{Cholesky, DMatrix, DVector};

/// A row `lower ≤ r·x ≤ upper`. It is an equality where both are the same.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LinearRow {
    /// The first variable that counts.
    pub(crate) first: usize,
    /// Coefficients of it and of the variables behind it.
    pub(crate) coefficients: DVector<f64>,
    /// Lower bound, or −∞.
    pub(crate) lower: f64,
    /// Upper bound, or ∞.
    pub(crate) upper: f64,
}

impl LinearRow {
    /// The row, divided by its length.
    pub(crate) fn new(first: usize, coefficients: Vec<f64>, lower: f64, upper: f64) -> Self {
        let coefficients = DVector::from_vec(coefficients);
        let length = coefficients.norm();
        Self { first, coefficients: coefficients / length, lower: lower / length, upper: upper / length }
    }

    pub(crate) fn at(&self, x: &DVector<f64>) -> f64 {
        x.rows(self.first, self.coefficients.len()).dot(&self.coefficients)
    }

    fn is_equality(&self) -> bool {
        self.lower == self.upper
    }
}

/// The side of a row that is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// `r·x ≥ lower`.
    Lower,
    /// `r·x ≤ upper`.
    Upper,
}

impl Side {
    fn sign(self) -> f64 {
        if self == Self::Lower { 1.0 } else { -1.0 }
    }
}

/// An active row, by its number.
pub(crate) type Active = (usize, Side);

/// A row counts as violated beyond this, relative to its bound and in units of x.
const VIOLATED: (f64, f64) = (1e-10, 1e-12);
/// A row that depends on the active ones may be violated by this much: that is rounding, not a contradiction.
const ROUNDING: f64 = 1e-7;
/// Square of the relative size of what is new in a row, below which it depends on the active ones.
const DEPENDENT: f64 = 1e-18;

/// The program and its active rows.
pub(crate) struct ActiveSet {
    slope: DVector<f64>,
    /// `J`, column by column.
    j: DMatrix<f64>,
    /// `R`, its first q columns.
    r: DMatrix<f64>,
    active: Vec<Active>,
    multipliers: Vec<f64>,
    x: DVector<f64>,
    /// Rows added and dropped so far.
    changes: usize,
}

impl ActiveSet {
    /// Begins at the minimum with the equalities and as many of the rows `warm` as can be active.
    pub(crate) fn begin(
        hessian: &Cholesky<f64, nalgebra::Dyn>,
        slope: DVector<f64>,
        rows: &[LinearRow],
        warm: &[Active],
    ) -> Option<Self> {
        let size = slope.len();
        let mut j = DMatrix::identity(size, size);
        if !hessian.l_dirty().tr_solve_lower_triangular_mut(&mut j) {
            return None;
        }
        let mut set = Self {
            slope,
            j,
            r: DMatrix::zeros(size, size),
            active: Vec::new(),
            multipliers: Vec::new(),
            x: DVector::zeros(size),
            changes: 0,
        };
        let equalities = (0..rows.len()).filter(|&row| rows[row].is_equality()).map(|row| (row, Side::Lower));
        let warm = warm.iter().copied().filter(|&(row, _)| !rows[row].is_equality());
        for (row, side) in equalities.chain(warm) {
            let d = set.coordinates(&rows[row], side);
            set.add((row, side), &d);
        }
        loop {
            set.restart(rows)?;
            let least = (0..set.active.len())
                .filter(|&k| !rows[set.active[k].0].is_equality())
                .min_by(|&one, &other| set.multipliers[one].total_cmp(&set.multipliers[other]));
            match least.filter(|&k| set.multipliers[k] < 0.0) {
                Some(k) => set.drop(k),
                None => return Some(set),
            }
        }
    }

    /// Goes on to the minimum with all rows. `None` where they contradict each other, or rounding prevails.
    pub(crate) fn solve(&mut self, rows: &[LinearRow]) -> Option<()> {
        let most = self.changes + 50 * (self.x.len() + 20);
        let mut redundant = Vec::new();
        loop {
            let Some((row, side, mut missing)) = self.most_violated(rows, &redundant) else {
                // the way here has left rounding in x
                self.restart(rows)?;
                if self.most_violated(rows, &redundant).is_none() {
                    return Some(());
                }
                continue;
            };
            let mut own = 0.0;
            loop {
                if self.changes >= most {
                    return None;
                }
                let q = self.active.len();
                let d = self.coordinates(&rows[row], side);
                let new = d.rows(q, d.len() - q).norm_squared();
                let mut falls = d.rows(0, q).into_owned();
                if !self.r.view((0, 0), (q, q)).solve_upper_triangular_mut(&mut falls) {
                    return None;
                }
                // how far until a multiplier vanishes, and how far until the row is kept
                let first = (0..q)
                    .filter(|&k| falls[k] > 0.0 && !rows[self.active[k].0].is_equality())
                    .map(|k| (self.multipliers[k] / falls[k], k))
                    .min_by(|one, other| one.0.total_cmp(&other.0));
                let full = if new > DEPENDENT * d.norm_squared() { missing / new } else { f64::INFINITY };
                let step = first.map_or(full, |(step, _)| step.min(full));
                if step.is_infinite() {
                    if missing > ROUNDING {
                        return None;
                    }
                    redundant.push((row, side));
                    break;
                }
                if full.is_finite() {
                    let free = d.rows(q, d.len() - q);
                    self.x.gemv(step, &self.j.columns(q, free.len()), &free, 1.0);
                    missing -= step * new;
                }
                self.multipliers.iter_mut().zip(falls.iter()).for_each(|(u, fall)| *u -= step * fall);
                own += step;
                if step == full {
                    self.add((row, side), &d);
                    self.multipliers.push(own);
                    break;
                }
                if let Some((_, k)) = first {
                    self.drop(k);
                }
            }
        }
    }

    /// The minimum.
    pub(crate) fn x(&self) -> &DVector<f64> {
        &self.x
    }

    /// The active rows and their multipliers, which are not negative but for equalities.
    pub(crate) fn active(&self) -> impl Iterator<Item = (Active, f64)> + '_ {
        self.active.iter().copied().zip(self.multipliers.iter().copied())
    }

    /// Rows added and dropped so far.
    #[cfg(test)]
    fn changes(&self) -> usize {
        self.changes
    }

    /// `Jᵀ n`, n the normal that points inwards.
    fn coordinates(&self, row: &LinearRow, side: Side) -> DVector<f64> {
        let sign = side.sign();
        self.j.rows(row.first, row.coefficients.len()).tr_mul(&row.coefficients) * sign
    }

    fn most_violated(&self, rows: &[LinearRow], redundant: &[Active]) -> Option<(usize, Side, f64)> {
        let mut worst = None;
        let mut most = 0.0;
        for (number, row) in rows.iter().enumerate() {
            let value = row.at(&self.x);
            for (side, missing, bound) in
                [(Side::Lower, row.lower - value, row.lower), (Side::Upper, value - row.upper, row.upper)]
            {
                let known = || self.active.contains(&(number, side)) || redundant.contains(&(number, side));
                if missing > most && missing > VIOLATED.0 * bound.abs() + VIOLATED.1 && !known() {
                    most = missing;
                    worst = Some((number, side, missing));
                }
            }
        }
        worst
    }

    /// Makes a row active, with `d = Jᵀ n`. A row that depends on the active ones is left out.
    fn add(&mut self, row: Active, d: &DVector<f64>) {
        let (q, size) = (self.active.len(), d.len());
        let length = d.rows(q, size - q).norm();
        if length * length <= DEPENDENT * d.norm_squared() {
            return;
        }
        // a reflection takes the new part of d to the first of its coordinates
        let head = if d[q] > 0.0 { -length } else { length };
        let mut v = d.rows(q, size - q).into_owned();
        v[0] -= head;
        let scale = 2.0 / v.norm_squared();
        let mut columns = self.j.columns_mut(q, size - q);
        let product = &columns * &v;
        columns.ger(-scale, &product, &v, 1.0);
        self.r.view_mut((0, q), (q, 1)).copy_from(&d.rows(0, q));
        self.r[(q, q)] = head;
        self.active.push(row);
        self.changes += 1;
    }

    /// Makes the active row in place k inactive.
    fn drop(&mut self, k: usize) {
        let q = self.active.len();
        self.active.remove(k);
        if k < self.multipliers.len() {
            self.multipliers.remove(k);
        }
        for column in k..q - 1 {
            let (mut before, after) = self.r.columns_range_pair_mut(column..=column, column + 1..=column + 1);
            before.rows_mut(0, column + 2).copy_from(&after.rows(0, column + 2));
            // a rotation of two rows of R removes the entry below the diagonal
            let (a, b) = (self.r[(column, column)], self.r[(column + 1, column)]);
            let length = a.hypot(b);
            if length == 0.0 {
                continue;
            }
            let (c, s) = (a / length, b / length);
            self.r[(column, column)] = length;
            self.r[(column + 1, column)] = 0.0;
            for later in column + 2..q {
                let (a, b) = (self.r[(column, later)], self.r[(column + 1, later)]);
                self.r[(column, later)] = c * a + s * b;
                self.r[(column + 1, later)] = c * b - s * a;
            }
            for row in 0..self.x.len() {
                let (a, b) = (self.j[(row, column)], self.j[(row, column + 1)]);
                self.j[(row, column)] = c * a + s * b;
                self.j[(row, column + 1)] = c * b - s * a;
            }
        }
        self.changes += 1;
    }

    /// x and multipliers of the active rows, from the factorisation alone.
    fn restart(&mut self, rows: &[LinearRow]) -> Option<()> {
        let q = self.active.len();
        let r = self.r.view((0, 0), (q, q));
        let mut b = DVector::from_fn(q, |k, _| {
            let (row, side) = self.active[k];
            if side == Side::Lower { rows[row].lower } else { -rows[row].upper }
        });
        let mut x = -self.j.tr_mul(&self.slope);
        let mut multipliers = -x.rows(0, q).into_owned();
        if !r.tr_solve_upper_triangular_mut(&mut b) {
            return None;
        }
        multipliers += &b;
        if !r.solve_upper_triangular_mut(&mut multipliers) {
            return None;
        }
        x.rows_mut(0, q).copy_from(&b);
        self.x = &self.j * x;
        self.multipliers = multipliers.as_slice().to_vec();
        self.x.iter().all(|x| x.is_finite()).then_some(())
    }
}

#[cfg(test)]
#[path = "active_set_tests.rs"]
mod tests;

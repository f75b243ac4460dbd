//! The score test for a change in time.
//!
//! Residuals of holds or rotations, whitened and in order of time, are `e = A θ + ε`. `A` has their derivatives with respect to the parameters.
//! A change adds `W B δ`. `B` is the effect of a bias or a gain on each residual. For a step, `W` is 0 before a time and 1 after it. For an episode,
//! `W` is 1 between two times. For a drift, `W` is time itself. With an orthonormal basis `Q` of the columns of `A`:
//!
//! ```text
//! r = e − Q Qᵀ e,   s = (W B)ᵀ r,   V = (W B)ᵀ (W B) − (W B)ᵀ Q Qᵀ (W B),   δ = V⁻¹ s
//! ```
//!
//! The change explains `sᵀ V⁻¹ s` of `rᵀ r`. This is Rao's score for a change of parameters. It also shows a change that leaves the mean of the
//! residuals the same. If nothing changes, the share has the distribution Beta(m/2, (ν − m)/2), with m numbers in δ and ν degrees of freedom.
//! The distribution does not depend on the scale of the noise, so the scatter of the change itself hides nothing. Every time is tried, and the
//! probability of the best is multiplied by their number (Bonferroni). Steps, episodes and drifts have a third of the significance each.
//!
//! # References
//! `andrews1993`, `levin1985`

use crate::diagnostic::{Change, Changed, Course};
use crate::sensor::SensorKind;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use statrs::function::beta::beta_reg;
use std::cmp::Ordering;

/// Significance level: share of the recordings of an unchanged sensor in which a change is found.
const SIGNIFICANCE: f64 = 5e-4;
/// Significance level of a change at its time, after any two neighbours are removed.
const STILL_SEEN: f64 = 2e-4;
/// Fewest holds or rotations on either side of a step.
const FEWEST_ON_A_SIDE: usize = 3;
/// Rows beyond the numbers of a change, on either side of a step.
const SPARE_ROWS: usize = 2;
/// Steps, episodes, drifts.
const COURSES: f64 = 3.0;
/// Number of places where an episode may begin or end.
const EDGES: usize = 24;
/// Fewest unused items that may be a change.
const MANY_LEFT_OUT: usize = 3;
/// Largest ratio of the residuals after a change to the usual ones. Beyond it, the unused items are not a change.
const USUAL_SQUARE: f64 = 9.0;
/// Another kind of change explains the residuals nearly as well if it leaves at most this multiple of them.
const RIVAL_FACTOR: f64 = 1.5;
/// Smallest share of a direction that counts, after the parameters. Also the smallest residual that counts, relative to its noise.
const SEEN_SHARE: f64 = 1e-6;

/// Residuals of holds or rotations in order of time, whitened.
#[derive(Clone)]
pub(in crate::estimate) struct Series {
    /// Of each hold or rotation.
    pub(in crate::estimate) times_s: Vec<f64>,
    /// Is it unused, because it does not fit?
    pub(in crate::estimate) left_out: Vec<bool>,
    /// `e`, with the same number of rows for each item.
    pub(in crate::estimate) errors: DVector<f64>,
    /// `A`.
    pub(in crate::estimate) parameters: DMatrix<f64>,
    /// `B`, three columns for each kind of change. Columns of axes that are not tested are zero.
    pub(in crate::estimate) kinds: Vec<(Changed, DMatrix<f64>)>,
}

/// The last item before a change, and the first after it.
pub(in crate::estimate) type Gap = (usize, usize);

/// The time of a change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::estimate) enum When {
    /// A step between two items.
    From(Gap),
    /// An episode, from between two items to between two others.
    Episode(Gap, Gap),
    Always,
}

/// A change of a series.
#[derive(Debug, Clone, Copy)]
pub(in crate::estimate) struct Found {
    pub(in crate::estimate) of: Changed,
    pub(in crate::estimate) instead: Option<Changed>,
    pub(in crate::estimate) when: When,
    pub(in crate::estimate) amount: Vector3<f64>,
    pub(in crate::estimate) sd: Vector3<f64>,
    pub(in crate::estimate) p_value: f64,
}

impl Change {
    /// The change that a series shows. `step`: the step between two items.
    pub(in crate::estimate) fn of(
        sensor_kind: SensorKind,
        found: Found,
        step: impl Fn(usize, usize) -> (usize, usize, f64),
    ) -> Self {
        let course = match found.when {
            When::Always => Course::Drift,
            When::From((last, first)) => {
                let (before, after, time_s) = step(last, first);
                Course::Step { before, after, time_s }
            }
            When::Episode(begin, end) => {
                let ((_, first, start_s), (last, _, end_s)) = (step(begin.0, begin.1), step(end.0, end.1));
                Course::Episode { first, last: last.max(first), start_s, end_s }
            }
        };
        let Found { of, instead, amount, sd, p_value, .. } = found;
        Self { sensor_kind, of, instead, course, amount, sd, p_value }
    }
}

impl Series {
    /// The most significant change, if there is one. `tests`: number of series that are tested.
    pub(in crate::estimate) fn change(&self, tests: usize) -> Option<Found> {
        let chance = |found: &Found| found.p_value * tests as f64;
        let among = |items: &[bool]| {
            let found = Residuals::of(self, items)?.change(self)?;
            (chance(&found.0) < SIGNIFICANCE && self.is_of_many(&found.0, items)).then_some(found)
        };
        let used: Vec<bool> = self.left_out.iter().map(|left_out| !left_out).collect();
        // after a late change, the remaining items look like outliers
        let of_all = || {
            let all = vec![true; used.len()];
            let usual = USUAL_SQUARE * Residuals::of(self, &used)?.variance();
            among(&all).filter(|(_, left)| *left <= usual).map(|(found, _)| found)
        };
        let left_out = self.left_out.iter().filter(|left_out| **left_out).count();
        let found = (left_out >= MANY_LEFT_OUT).then(of_all).flatten();
        let found = found.or_else(|| among(&used).map(|(found, _)| found))?;
        Some(Found { p_value: chance(&found).min(1.0), ..found })
    }

    /// Is a change significant without any two neighbours? Both rotations beside a bad hold can look like a change.
    fn is_of_many(&self, found: &Found, items: &[bool]) -> bool {
        let places: Vec<usize> = (0..items.len()).filter(|&item| items[item]).collect();
        places.windows(2).all(|pair| {
            let mut others = items.to_vec();
            pair.iter().for_each(|item| others[*item] = false);
            let chance = Residuals::of(self, &others).and_then(|others| {
                let solved = others.at(self, found.of, found.when)?;
                others.chance(&solved)
            });
            chance.is_some_and(|chance| chance < STILL_SEEN)
        })
    }

    /// A change of this kind at this time, significant or not: its amount and standard deviation.
    pub(in crate::estimate) fn amount(
        &self,
        of: Changed,
        when: When,
    ) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let used: Vec<bool> = self.left_out.iter().map(|left_out| !left_out).collect();
        let used = Residuals::of(self, &used)?;
        let solved = used.at(self, of, when)?;
        let (left, _) = used.left(&solved)?;
        Some((solved.amount, solved.sd(left)))
    }
}

/// The residuals of some items of a series, orthogonal to the parameters.
struct Residuals {
    /// Their places in the series.
    items: Vec<usize>,
    /// The rows of each item.
    width: usize,
    /// The columns of `Q`.
    basis: Vec<DVector<f64>>,
    /// `r`.
    rest: DVector<f64>,
    degrees: usize,
    /// `rᵀ r`.
    square: f64,
}

impl Residuals {
    /// `None` if they are too few, or only rounding.
    fn of(series: &Series, chosen: &[bool]) -> Option<Self> {
        let items: Vec<usize> = (0..chosen.len()).filter(|&item| chosen[item]).collect();
        let width = series.errors.len() / series.times_s.len().max(1);
        let places: Vec<usize> = items.iter().flat_map(|item| width * item..width * (item + 1)).collect();
        let mut basis: Vec<DVector<f64>> = Vec::new();
        for column in series.parameters.column_iter() {
            let column = column.select_rows(&places);
            // twice, for orthogonality to the last digit
            let left = beside(beside(column.clone(), &basis), &basis);
            let norm = left.norm();
            if norm > SEEN_SHARE * column.norm() {
                basis.push(left / norm);
            }
        }
        let rest = beside(series.errors.select_rows(&places), &basis);
        let degrees = places.len().checked_sub(basis.len()).filter(|degrees| *degrees > 0)?;
        let square = rest.norm_squared();
        (square > SEEN_SHARE * degrees as f64).then_some(Self { items, width, basis, rest, degrees, square })
    }

    fn variance(&self) -> f64 {
        self.square / self.degrees as f64
    }

    /// The rows of a kind of change, for each item.
    fn rows(&self, by: &DMatrix<f64>) -> Vec<Vec<Vector3<f64>>> {
        let row = |row: usize| Vector3::from_fn(|k, _| by[(row, k)]);
        self.items
            .iter()
            .map(|item| (self.width * item..self.width * (item + 1)).map(row).collect())
            .collect()
    }

    /// The scores of all items before each, and of all.
    fn sums(&self, rows: &[Vec<Vector3<f64>>]) -> Vec<Score> {
        let mut sums = vec![Score::none(rows, self.basis.len())];
        for (item, rows) in rows.iter().enumerate() {
            let mut sum = sums[item].clone();
            self.add(&mut sum, item, rows, 1.0);
            sums.push(sum);
        }
        sums
    }

    /// The change between two items that explains most, and the number of candidates.
    fn most(
        &self,
        sums: &[Score],
        spans: impl Iterator<Item = (usize, usize)>,
    ) -> Option<(When, Solved, f64)> {
        let mut tried = 0.0;
        let solved = spans.filter_map(|(from, to)| {
            tried += 1.0;
            Some((self.when(from, to), sums[to].less(&sums[from]).solved()?))
        });
        let most = solved.max_by(|one, other| one.1.square.total_cmp(&other.1.square));
        most.map(|(when, solved)| (when, solved, tried))
    }

    fn when(&self, from: usize, to: usize) -> When {
        let before = |place: usize| (self.items[place - 1], self.items[place]);
        if to == self.items.len() {
            When::From(before(from))
        } else {
            When::Episode(before(from), before(to))
        }
    }

    fn drift(&self, series: &Series, rows: &[Vec<Vector3<f64>>]) -> Option<Solved> {
        let times = || self.items.iter().map(|item| series.times_s[*item]);
        let (first, last) = (times().next()?, times().next_back()?);
        let mut score = Score::none(rows, self.basis.len());
        for (item, time_s) in times().enumerate() {
            self.add(&mut score, item, &rows[item], (time_s - 0.5 * (first + last)) / (last - first));
        }
        score.solved()
    }

    fn add(&self, score: &mut Score, item: usize, rows: &[Vector3<f64>], weight: f64) {
        for (k, row) in rows.iter().enumerate() {
            let place = self.width * item + k;
            score.add(&(row * weight), self.rest[place], self.basis.iter().map(|column| column[place]));
        }
    }

    /// The variance after a change, and its degrees of freedom.
    fn left(&self, solved: &Solved) -> Option<(f64, usize)> {
        let degrees = self.degrees.checked_sub(solved.numbers).filter(|left| *left >= FEWEST_ON_A_SIDE)?;
        Some(((self.square - solved.square).max(0.0) / degrees as f64, degrees))
    }

    /// A change of a kind at a time.
    fn at(&self, series: &Series, of: Changed, when: When) -> Option<Solved> {
        let (_, by) = series.kinds.iter().find(|(kind, _)| *kind == of)?;
        let rows = self.rows(by);
        match when {
            When::Always => self.drift(series, &rows),
            When::From((_, first)) => self.between(&rows, first, usize::MAX),
            When::Episode((_, first), (_, after)) => self.between(&rows, first, after),
        }
    }

    /// A change of the items from one of the series to before another.
    fn between(&self, rows: &[Vec<Vector3<f64>>], first: usize, after: usize) -> Option<Solved> {
        let [from, to] = [first, after].map(|end| self.items.partition_point(|item| *item < end));
        let sums = self.sums(rows);
        sums[to].less(&sums[from]).solved()
    }

    /// Probability, without a change, that one at the given time explains as much.
    fn chance(&self, solved: &Solved) -> Option<f64> {
        let (_, degrees) = self.left(solved)?;
        if degrees == 0 || solved.numbers == 0 {
            return None;
        }
        let unexplained = (1.0 - solved.square / self.square).clamp(0.0, 1.0);
        Some(beta_reg(0.5 * degrees as f64, 0.5 * solved.numbers as f64, unexplained))
    }

    /// The change that explains most, with the variance after it.
    fn change(&self, series: &Series) -> Option<(Found, f64)> {
        let of_kind = |(of, by): &(Changed, DMatrix<f64>)| {
            let rows = self.rows(by);
            let (sums, count) = (self.sums(&rows), rows.len());
            let side = FEWEST_ON_A_SIDE.max((sums[0].numbers() + SPARE_ROWS).div_ceil(self.width));
            let splits = side..(count + 1).saturating_sub(side);
            let edges = splits.clone().step_by(splits.len().div_ceil(EDGES).max(1));
            let episodes = edges.clone().flat_map(|from| {
                edges.clone().filter(move |to| *to >= from + side).map(move |to| (from, to))
            });
            let step = self.most(&sums, splits.map(|from| (from, count)));
            let episode = self.most(&sums, episodes);
            let drift = self.drift(series, &rows).map(|solved| (When::Always, solved, 1.0));
            let all = [step, episode, drift].into_iter().flatten().filter_map(|(when, solved, tried)| {
                let ((left, _), chance) = (self.left(&solved)?, self.chance(&solved)?);
                let p_value = (COURSES * series.kinds.len() as f64 * tried * chance).min(1.0);
                let (amount, sd) = (solved.amount, solved.sd(left));
                Some((Found { of: *of, instead: None, when, amount, sd, p_value }, left))
            });
            all.min_by(better)
        };
        let mut kinds: Vec<(Found, f64)> = series.kinds.iter().filter_map(of_kind).collect();
        kinds.sort_by(better);
        let (best, left) = kinds.first().copied()?;
        let instead = kinds.get(1).filter(|other| other.1 <= RIVAL_FACTOR * left).map(|other| other.0.of);
        Some((Found { instead, ..best }, left))
    }
}

/// The change that is less likely by chance. If both probabilities are zero, the one with the smaller variance after it.
fn better(one: &(Found, f64), other: &(Found, f64)) -> Ordering {
    one.0.p_value.total_cmp(&other.0.p_value).then(one.1.total_cmp(&other.1))
}

/// The part of a column that is orthogonal to a basis.
fn beside(mut column: DVector<f64>, basis: &[DVector<f64>]) -> DVector<f64> {
    for known in basis {
        let along = known.dot(&column);
        column.axpy(-along, known, 1.0);
    }
    column
}

/// `s`, `(W B)ᵀ (W B)` and `(W B)ᵀ Q`.
#[derive(Clone)]
struct Score {
    /// The axes that are tested.
    asked: [bool; 3],
    gradient: Vector3<f64>,
    information: Matrix3<f64>,
    along: Vec<Vector3<f64>>,
}

impl Score {
    fn none(rows: &[Vec<Vector3<f64>>], parameters: usize) -> Self {
        Self {
            asked: std::array::from_fn(|k| rows.iter().flatten().any(|row| row[k] != 0.0)),
            gradient: Vector3::zeros(),
            information: Matrix3::zeros(),
            along: vec![Vector3::zeros(); parameters],
        }
    }

    fn numbers(&self) -> usize {
        self.asked.iter().filter(|asked| **asked).count()
    }

    fn add(&mut self, row: &Vector3<f64>, rest: f64, basis: impl Iterator<Item = f64>) {
        self.gradient += row * rest;
        self.information += row * row.transpose();
        for (along, of_basis) in self.along.iter_mut().zip(basis) {
            *along += row * of_basis;
        }
    }

    /// The sums of this set less those of another.
    fn less(&self, other: &Self) -> Self {
        Self {
            asked: self.asked,
            gradient: self.gradient - other.gradient,
            information: self.information - other.information,
            along: self.along.iter().zip(&other.along).map(|(here, there)| here - there).collect(),
        }
    }

    fn solved(&self) -> Option<Solved> {
        let mut left =
            self.information - self.along.iter().map(|along| along * along.transpose()).sum::<Matrix3<f64>>();
        let before = self.information.diagonal();
        for k in (0..3).filter(|&k| !self.asked[k]) {
            left[(k, k)] = 1.0;
        }
        let factor = left.cholesky()?;
        let seen = |k: usize| factor.l_dirty()[(k, k)].powi(2) > SEEN_SHARE * before[k];
        if !(0..3).all(seen) {
            return None;
        }
        let amount = factor.solve(&self.gradient);
        let variance = factor.inverse().diagonal();
        let variance = Vector3::from_fn(|k, _| if self.asked[k] { variance[k] } else { 0.0 });
        Some(Solved { numbers: self.numbers(), amount, variance, square: self.gradient.dot(&amount) })
    }
}

/// A change whose time is given.
#[derive(Clone, Copy)]
struct Solved {
    numbers: usize,
    /// `δ`, and its variance beside noise of one.
    amount: Vector3<f64>,
    variance: Vector3<f64>,
    /// `sᵀ V⁻¹ s`.
    square: f64,
}

impl Solved {
    fn sd(&self, noise_variance: f64) -> Vector3<f64> {
        (self.variance * noise_variance).map(f64::sqrt)
    }
}

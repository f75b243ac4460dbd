//! The regression of Allan variances on some of the processes, and the coefficients that follow from it.

use super::allan_moments::PROCESSES;
use super::whitening::Whitening;
use super::{Coefficient, Estimate, Moments, NoiseModel, PowerLaw, variance_interval};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::cell::OnceCell;

/// A coefficient is determined if its square is this many standard deviations above zero. The standard
/// deviation is that of a coefficient that is zero.
pub(super) const SIGNIFICANT: f64 = 3.0;
/// Below this number of standard deviations a process is not used. In between, it stays in the fit without
/// being determined, so that the uncertainty of the others includes it. Quantisation has nothing in between.
/// It would take a share of the white noise at the cluster times that determine white noise best.
const NEGLIGIBLE: [f64; PROCESSES] = [SIGNIFICANT, 2.0, 2.0, 2.0];
/// Bias instability and rate random walk are separable if χ² differs by at least this when one replaces the
/// other.
const SEPARABLE_CHI2: f64 = 3.0;
/// Below this probability the processes do not explain the Allan deviation.
pub(super) const MISFIT: f64 = 1e-3;
/// Probability that a coefficient that is not determined exceeds its limit.
const LIMIT_TAIL: f64 = 0.05;
/// Largest number of rounds of the iteration.
const ITERATIONS: usize = 50;
/// The iteration ends at a change below this, in standard deviations of a coefficient.
const SETTLED: f64 = 1e-6;
/// Extrapolations by more changes than this are not used.
const FARTHEST: f64 = 4.0;
/// Index of quantisation noise among the processes.
const QUANTISATION: usize = PowerLaw::Quantisation as usize;
/// Index of white noise among the processes.
const WHITE: usize = PowerLaw::White as usize;

/// Generalised least squares of the Allan variances on the variances of some of the processes, for a sample
/// interval of 1.
pub(super) struct Regression<'a> {
    moments: &'a Moments,
    observed: &'a DVector<f64>,
    /// First scale that is used.
    pub(super) first: usize,
    /// The processes.
    pub(super) active: Vec<usize>,
    /// Squares of all coefficients; zero for those that are not active.
    theta: [f64; PROCESSES],
    /// `θ̂ = G ν`, a row for each active process.
    gain: DMatrix<f64>,
    pub(super) chi2: f64,
    /// Is the share of quantisation that of a filter, of either sign (see [the module](crate::noise))?
    pub(super) filtered: bool,
    /// The result of [`rival`](Self::rival), which is needed repeatedly.
    rivals: [OnceCell<Option<usize>>; PROCESSES],
    /// The result of [`beside_filter`](Self::beside_filter).
    beside_filter: OnceCell<(f64, f64)>,
}

impl<'a> Regression<'a> {
    /// Removes the least significant process until none is negligible.
    pub(super) fn reduced(
        moments: &'a Moments,
        observed: &'a DVector<f64>,
        first: usize,
        filtered: bool,
    ) -> Self {
        let mut active: Vec<usize> = (0..PROCESSES).collect();
        loop {
            let regression = Self::of(moments, observed, first, &active, filtered);
            let significance: Vec<f64> = (0..active.len()).map(|i| regression.significance(i)).collect();
            let excess = |i: usize| match active[i] {
                QUANTISATION if filtered => f64::INFINITY,
                process => significance[i] - NEGLIGIBLE[process],
            };
            let least = (0..active.len()).min_by(|&i, &j| excess(i).total_cmp(&excess(j)));
            match least {
                Some(i) if active.len() > 1 && excess(i) < 0.0 => drop(active.remove(i)),
                // of two that cannot be separated, one stands for both
                _ => match regression.weaker_rival(&significance) {
                    Some(i) => drop(active.remove(i)),
                    None => return regression,
                },
            }
        }
    }

    fn of(
        moments: &'a Moments,
        observed: &'a DVector<f64>,
        first: usize,
        active: &[usize],
        filtered: bool,
    ) -> Self {
        let size = observed.len() - first;
        let values = observed.rows(first, size);
        let design = moments.mean().view((first, 0), (size, PROCESSES)).select_columns(active);
        // to begin with, each variance has the uncertainty of white noise, without correlation
        let unit = moments.covariance(&[0.0, 1.0, 0.0, 0.0], first);
        let mut white = Whitening::of_independent((0..size).map(|j| {
            let relative = unit[(j, j)] / moments.mean()[(first + j, 1)].powi(2);
            relative * values[j] * values[j]
        }));
        let mut theta = [0.0; PROCESSES];
        let mut gain = DMatrix::zeros(active.len(), size);
        // the variances from which the weights came; the change and the estimate of the round before
        let (mut weighted_by, mut before): (Option<DVector<f64>>, _) = (None, None);
        for _ in 0..ITERATIONS {
            let whitened = white.whiten(design.clone());
            let Some(inverse) = scaled_inverse(&whitened.tr_mul(&whitened)) else { break };
            gain = inverse.clone() * white.transposed(whitened).transpose();
            let found = &gain * values;
            active.iter().zip(found.iter()).for_each(|(&a, &value)| theta[a] = value);
            let mut next = found.clone();
            if let Some(weights) = weighted_by {
                let change = (&found - weights).component_div(&inverse.diagonal().map(f64::sqrt));
                if change.amax() <= SETTLED {
                    break;
                }
                if let Some((last_change, last_found)) = before {
                    next -= (&found - last_found) * extrapolation(&change, &last_change);
                }
                before = Some((change, found));
            }
            let mut weights = [0.0; PROCESSES];
            active.iter().zip(next.iter()).for_each(|(&a, &value)| weights[a] = value.max(0.0));
            let Some(covariance) = Whitening::of_covariance(&moments.covariance(&weights, first)) else {
                break;
            };
            (white, weighted_by) = (covariance, Some(next));
        }
        let residual =
            values - &design * DVector::from_iterator(active.len(), active.iter().map(|&a| theta[a]));
        let chi2 = white.whiten(residual).norm_squared();
        let (rivals, beside_filter) = Default::default();
        let active = active.to_vec();
        Self { moments, observed, first, active, theta, gain, chi2, rivals, beside_filter, filtered }
    }

    /// Variance of the estimate of active process `i`, as a function of its assumed `θ`.
    fn variance(&self, i: usize) -> impl Fn(f64) -> f64 + use<> {
        let variance = self.moments.variance_of_sum(&self.gain.row(i).transpose(), self.first);
        let (theta, place) = (positive(self.theta), self.active[i]);
        move |theta_i| {
            let mut theta = theta;
            theta[place] = theta_i;
            variance(&theta)
        }
    }

    /// The filter's share beside the processes in standard deviations above zero; `None` where quantisation
    /// is one of the processes.
    pub(super) fn filter_significance(&self) -> Option<f64> {
        self.beside_filter().map(|(significance, _)| significance)
    }

    /// The same, and the square of N beside it.
    fn beside_filter(&self) -> Option<(f64, f64)> {
        if self.active.contains(&QUANTISATION) {
            return None;
        }
        Some(*self.beside_filter.get_or_init(|| {
            let active: Vec<usize> =
                std::iter::once(QUANTISATION).chain(self.active.iter().copied()).collect();
            let with = Self::of(self.moments, self.observed, self.first, &active, true);
            (with.significance(0), with.theta[WHITE])
        }))
    }

    /// How many standard deviations the square of a coefficient is above zero.
    fn significance(&self, i: usize) -> f64 {
        self.theta[self.active[i]] / self.variance(i)(0.0).sqrt()
    }

    /// The less significant of bias instability and rate random walk, where both are active and neither is significant.
    fn weaker_rival(&self, significance: &[f64]) -> Option<usize> {
        let position = |process: PowerLaw| self.active.iter().position(|&a| a == process as usize);
        let (b, k) = (position(PowerLaw::Flicker)?, position(PowerLaw::RandomWalk)?);
        let neither = significance[b].max(significance[k]) < SIGNIFICANT;
        neither.then_some(if significance[b] < significance[k] { b } else { k })
    }

    /// A filter's share over the white noise.
    pub(super) fn filter_share(&self) -> f64 {
        self.theta[QUANTISATION] / self.theta[WHITE]
    }

    /// The share of N² that these Allan variances would add to it; zero without white noise.
    pub(super) fn part_of_white(&self, variances: &DVector<f64>) -> f64 {
        let scales = variances.rows(self.first, variances.len() - self.first);
        self.white().map_or(0.0, |i| self.gain.row(i).transpose().dot(&scales) / self.theta[WHITE])
    }

    /// Standard deviation of N² over N².
    pub(super) fn relative_sd_of_white(&self) -> f64 {
        let theta = self.theta[WHITE];
        self.white().map_or(f64::INFINITY, |i| self.variance(i)(theta).sqrt() / theta)
    }

    /// The place of white noise among the active processes.
    fn white(&self) -> Option<usize> {
        self.active.iter().position(|&a| a == WHITE)
    }

    pub(super) fn p_value(&self) -> Option<f64> {
        let freedom = self.observed.len() - self.first - self.active.len();
        (freedom > 0).then(|| ChiSquared::new(freedom as f64).map_or(f64::NAN, |chi2| chi2.sf(self.chi2)))
    }

    pub(super) fn explains(&self) -> bool {
        self.p_value().is_none_or(|p| p >= MISFIT)
    }

    pub(super) fn model(&self, interval_s: f64) -> NoiseModel {
        let of = |process| self.coefficient(process, interval_s);
        NoiseModel {
            quantisation: of(PowerLaw::Quantisation),
            random_walk: of(PowerLaw::White),
            bias_instability: of(PowerLaw::Flicker),
            rate_random_walk: of(PowerLaw::RandomWalk),
            squares: std::array::from_fn(|a| {
                let square =
                    if self.filtered && a == QUANTISATION { self.theta[a] } else { self.theta[a].max(0.0) };
                square * interval_s.powi(-PowerLaw::ALL[a].interval_power())
            }),
        }
    }

    fn coefficient(&self, process: PowerLaw, interval_s: f64) -> Coefficient {
        let a = process as usize;
        // θ is that of the square of the coefficient for an interval of 1
        let to_coefficient = |theta: f64| (theta * interval_s.powi(-process.interval_power())).sqrt();
        let position = self.active.iter().position(|&active| active == a);
        if let Some(i) = position
            && self.is_determined(i)
        {
            let (theta, variance) = (self.theta[a], self.variance(i));
            let sd = variance(theta).sqrt();
            let (low, high) = variance_interval::bounds(theta, variance);
            let (value, high) = (to_coefficient(theta), to_coefficient(high));
            // a filter that does not show takes from N the difference to the N of a fit with its share
            let unseen = self.beside_filter().filter(|_| a == WHITE);
            let taken = unseen.map_or(0.0, |(_, beside)| to_coefficient(beside.max(theta)) - value);
            return Coefficient::Determined(Estimate {
                value,
                sd: 0.5 * value * sd / theta,
                low: to_coefficient(low),
                high: high + taken,
            });
        }
        let limit = match position {
            Some(i) if self.is_filter(i) => f64::INFINITY,
            Some(i) => self.limit(i),
            None => {
                // with the process from which it cannot be separated, or with all
                let mut with: Vec<usize> =
                    self.active.iter().copied().filter(|&b| self.rival(b) != Some(a)).collect();
                with.push(a);
                with.sort_unstable();
                let i = with.iter().position(|&active| active == a).unwrap_or(0);
                Self::of(self.moments, self.observed, self.first, &with, self.filtered).limit(i)
            }
        };
        let limit = limit.is_finite().then(|| to_coefficient(limit));
        Coefficient::NotDetermined { limit, reason: self.reason(process, interval_s) }
    }

    /// Is active process `i` determined? A single process always is.
    fn is_determined(&self, i: usize) -> bool {
        let alone = self.active.len() == 1 + usize::from(self.filtered);
        !self.is_filter(i)
            && (alone || self.significance(i) >= SIGNIFICANT)
            && self.rival(self.active[i]).is_none()
    }

    /// Is the share of active process `i` that of a filter?
    fn is_filter(&self, i: usize) -> bool {
        self.filtered && self.active[i] == QUANTISATION
    }

    /// The other of bias instability and rate random walk, where it explains as much in place of the given
    /// one.
    fn rival(&self, process: usize) -> Option<usize> {
        *self.rivals[process].get_or_init(|| self.find_rival(process))
    }

    fn find_rival(&self, process: usize) -> Option<usize> {
        /// Index of flicker noise among the processes.
        const FLICKER: usize = PowerLaw::Flicker as usize;
        /// Index of the random walk among the processes.
        const WALK: usize = PowerLaw::RandomWalk as usize;
        let other = match process {
            FLICKER => WALK,
            WALK => FLICKER,
            _ => return None,
        };
        if self.active.contains(&other) {
            return None;
        }
        let mut active: Vec<usize> =
            self.active.iter().map(|&a| if a == process { other } else { a }).collect();
        active.sort_unstable();
        let swapped = Self::of(self.moments, self.observed, self.first, &active, self.filtered);
        (swapped.theta[other] > 0.0 && swapped.chi2 < self.chi2 + SEPARABLE_CHI2).then_some(other)
    }

    /// Upper limit of the square of the coefficient of active process `i`.
    fn limit(&self, i: usize) -> f64 {
        // an estimate below zero counts as one at the standard deviation of a coefficient of zero
        let variance = self.variance(i);
        let seen = self.theta[self.active[i]].max(variance(0.0).sqrt());
        variance_interval::upper(seen, &variance, LIMIT_TAIL)
    }

    fn reason(&self, process: PowerLaw, interval_s: f64) -> String {
        let scales = self.moments.scales();
        let tau = |m: usize| crate::number_format::short_time(m as f64 * interval_s);
        let longest = tau(scales[scales.len() - 1]);
        let short = if self.filtered { "a filter" } else { "quantisation" };
        let name = |a: usize| [short, "white noise", "bias instability", "rate random walk"][a];
        let here = process as usize;
        let apart = format!(
            "bias instability and rate random walk cannot be separated with cluster times up to {longest}: record for longer"
        );
        if self.filtered && here == QUANTISATION {
            return "the samples are filtered, and what a filter takes from short cluster times hides it"
                .to_owned();
        }
        if self.active.contains(&here) {
            let flat = |a: usize| a >= PowerLaw::Flicker as usize;
            let beside = self.active.iter().copied().find(|&a| a != here && flat(a) && flat(here));
            let rival = self.rival(here).or(beside);
            return match rival {
                Some(_) => apart,
                None => format!("it is hardly seen in cluster times up to {longest}: record for longer"),
            };
        }
        if self.active.iter().any(|&a| self.rival(a) == Some(here)) {
            return apart;
        }
        let others: Vec<&str> = self.active.iter().map(|&a| name(a)).collect();
        let explain = if others.len() == 1 { "explains" } else { "explain" };
        let others = others.join(" and ");
        match process {
            PowerLaw::Quantisation => {
                format!("{others} {explain} the shortest cluster times; slope −1 is not seen")
            }
            PowerLaw::White => format!("{others} {explain} the short cluster times; slope −½ is not seen"),
            PowerLaw::Flicker => format!(
                "{others} {explain} all cluster times up to {longest}; no flat part is reached: record for longer"
            ),
            PowerLaw::RandomWalk => format!(
                "{others} {explain} all cluster times up to {longest}; slope +½ is not reached: record for longer"
            ),
        }
    }
}

/// The weight of the previous estimate in the extrapolation. It makes the change shortest if the change is
/// linear in the weights (`anderson1965`, of two rounds).
///
/// Without it every round halves the change, and the iteration takes twenty rounds.
fn extrapolation(change: &DVector<f64>, before: &DVector<f64>) -> f64 {
    let turned = change - before;
    let back = change.dot(&turned) / turned.norm_squared();
    if back.abs() < FARTHEST { back } else { 0.0 }
}

fn positive(theta: [f64; PROCESSES]) -> [f64; PROCESSES] {
    theta.map(|value| value.max(0.0))
}

/// Inverse of a symmetric positive definite matrix whose entries span many decades.
fn scaled_inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let white = Whitening::of_covariance(matrix)?;
    let factor = white.whiten(DMatrix::identity(matrix.nrows(), matrix.ncols()));
    Some(factor.tr_mul(&factor))
}

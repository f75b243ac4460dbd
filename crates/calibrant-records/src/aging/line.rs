//! Aging: the change per year of a quantity that was calibrated several times.
//!
//! A line through the values `v_i ± σ_i` at the times `t_i`, by weighted least squares. With `w_i = 1/σ_i²`, and with `t̄` the weighted mean of the times,
//!
//! ```text
//! r = Σ w_i (t_i − t̄) v_i / Σ w_i (t_i − t̄)²,   var r = 1 / Σ w_i (t_i − t̄)²,   χ² = Σ w_i (v_i − v̄ − r (t_i − t̄))²
//! ```
//!
//! With more than two values, χ² has `ν = n − 2` degrees of freedom, and shows whether a line and the standard deviations explain the values. Where
//! `χ²/ν > 1`, the standard deviation of `r` is multiplied by the Birge ratio `√(χ²/ν)` (`birge1932`), and the significance is that of Student's t with ν degrees of freedom. The
//! values then scatter by more than their calibrations know, for example because the sensor is mounted anew each time. A ratio below 1 changes nothing: a few
//! values that agree by chance do not show that the standard deviations are too large.
//!
//! Values may have errors `e_k` in common, as those of one place have that of its gravity: `v_i = v̄ + r (t_i − t̄) + Σ_k c_ik e_k + ε_i`. Each is then an unknown more, standard normal
//! beforehand, and `σ_i² − Σ_k c_ik²` is left for `ε_i`. So the error that all values of a place have hides no change.
//!
//! Without the ratio, the significance is that of Student's t with the degrees of freedom behind `var r = Σ c_i² σ_i²`, `c_i = w_i (t_i − t̄) / Σ w_j (t_j − t̄)²`, by Welch and
//! Satterthwaite (`satterthwaite1946`). For two values of sensors that did not change, this is the significance of their difference.
//!
//! # How well p holds
//! Weights of estimated standard deviations make p approximate. Without aging and with ν = 4 behind each σ, p is below 0.05 in 5.1 % of the cases for two values, in 4.1 % for three,
//! in 5.1 % for five and in 9 % for ten. With σ taken as known it would be 8.7 %, 6.2 %, 6.3 % and 9.6 %, and without the Birge ratio up to 20 %. From ν = 10 on it is at most 5.1 %.

use calibrant_core::estimate::{chi2_p_value, degrees_of_sum, f_p_value};
use calibrant_core::form::As;
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

/// Of a variance that is all of shared errors, this part is the value's own.
const LEAST_OWN: f64 = 1e-9;

/// A value with its date.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dated {
    /// Its time, years from any beginning.
    pub time_years: f64,
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sd: f64,
    /// Degrees of freedom behind the standard deviation; infinite where it is known.
    pub degrees_of_freedom: f64,
}

/// How a quantity changes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Aging {
    /// Change per year, in the unit of the quantity.
    pub per_year: f64,
    /// Its standard deviation, with the Birge ratio where that is above 1.
    #[serde(rename = "per_year_sd")]
    pub sd: f64,
    /// The Birge ratio `√(χ²/ν)`; `None` for two values.
    pub birge_ratio: Option<f64>,
    /// Squares of the residuals in standard deviations.
    pub chi2: f64,
    /// Number of values, less 2.
    pub degrees_of_freedom: usize,
    /// Probability of a larger χ² if a line and the standard deviations are right; `None` for two values.
    pub fit_p_value: Option<f64>,
    /// Degrees of freedom behind the standard deviation of the change: those of χ² where the Birge ratio widens it, and otherwise those behind the values together. None where they are known.
    #[serde(with = "As::<Option<f64>>")]
    pub degrees_behind: f64,
    /// Probability of a larger change if there is none, by Student's t of these degrees of freedom.
    pub p_value: f64,
}

impl Aging {
    /// The line through these values. `None` with fewer than two values of different times; values without a positive standard deviation do not count.
    ///
    /// # Examples
    /// Two values give the line through them:
    /// ```
    /// use calibrant_records::{Aging, Dated};
    /// let dated = |(time_years, value)| Dated { time_years, value, sd: 0.1, degrees_of_freedom: f64::INFINITY };
    /// let values = [(0.0, 1.0), (2.0, 1.6)].map(dated);
    /// let aging = Aging::of(&values).unwrap();
    /// assert!((aging.per_year - 0.3).abs() < 1e-12);
    /// assert!((aging.sd - 0.1 * 2f64.sqrt() / 2.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn of(values: &[Dated]) -> Option<Self> {
        Self::with_shared(values, &[])
    }

    /// The same where values have errors in common, which are parts of their standard deviations. Each of `shared` is one such error: what one standard
    /// deviation of it does to each value, 0 where it does nothing.
    #[must_use]
    pub fn with_shared(values: &[Dated], shared: &[Vec<f64>]) -> Option<Self> {
        let counts =
            |v: &Dated| v.sd > 0.0 && v.sd.is_finite() && v.value.is_finite() && v.time_years.is_finite();
        let kept: Vec<usize> = (0..values.len()).filter(|&i| counts(&values[i])).collect();
        let values: Vec<&Dated> = kept.iter().map(|&i| &values[i]).collect();
        let effect = DMatrix::from_fn(values.len(), shared.len(), |i, k| shared[k][kept[i]]);
        let own = |i: usize| {
            let variance = values[i].sd.powi(2);
            (variance - effect.row(i).norm_squared()).max(LEAST_OWN * variance)
        };
        let own: Vec<f64> = (0..values.len()).map(own).collect();
        let sum =
            |of: &dyn Fn(&Dated) -> f64| values.iter().zip(&own).map(|(v, own)| of(v) / own).sum::<f64>();
        let weights = sum(&|_| 1.0);
        let (mean_time, mean_value) = (sum(&|v| v.time_years) / weights, sum(&|v| v.value) / weights);
        // values of one day differ by the rounding of their mean
        let spread = values.iter().fold(0.0_f64, |most, v| most.max((v.time_years - mean_time).abs()));
        if values.len() < 2 || spread <= 1e-9 {
            return None;
        }
        // unknowns: the value at the mean time, the change, and each shared error, which is standard normal
        let design = DMatrix::from_fn(values.len(), 2 + shared.len(), |i, k| match k {
            0 => 1.0,
            1 => values[i].time_years - mean_time,
            k => effect[(i, k - 2)],
        });
        let weighted = DMatrix::from_fn(design.ncols(), design.nrows(), |k, i| design[(i, k)] / own[i]);
        let mut information = &weighted * &design;
        (2..design.ncols()).for_each(|k| information[(k, k)] += 1.0);
        let covariance = information.cholesky()?.inverse();
        let estimator = &covariance * weighted;
        let deviations = DVector::from_fn(values.len(), |i, _| values[i].value - mean_value);
        let solution = &estimator * &deviations;
        let per_year = solution[1];
        let residuals = deviations - design * &solution;
        let chi2 = residuals.iter().zip(&own).map(|(residual, own)| residual * residual / own).sum::<f64>()
            + solution.rows_range(2..).norm_squared();
        let degrees_of_freedom = values.len() - 2;
        let birge_ratio = (degrees_of_freedom > 0).then(|| (chi2 / degrees_of_freedom as f64).sqrt());
        let widened = birge_ratio.filter(|ratio| *ratio > 1.0);
        let sd = covariance[(1, 1)].sqrt() * widened.unwrap_or(1.0);
        let degrees_behind = if widened.is_some() {
            degrees_of_freedom as f64
        } else {
            let of_change = estimator.row(1);
            let part = |i: usize| (of_change[i].powi(2) * own[i], values[i].degrees_of_freedom);
            let of_shared = (of_change * &effect).norm_squared();
            let parts =
                (0..values.len()).map(part).chain((of_shared > 0.0).then_some((of_shared, f64::INFINITY)));
            degrees_of_sum(&parts.collect::<Vec<_>>())
        };
        Some(Self {
            per_year,
            sd,
            birge_ratio,
            chi2,
            degrees_of_freedom,
            degrees_behind,
            fit_p_value: chi2_p_value(chi2, degrees_of_freedom),
            p_value: f_p_value((per_year / sd).powi(2), 1, degrees_behind)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{ChiSquared, Distribution, StandardNormal};

    fn dated(values: &[(f64, f64, f64)]) -> Vec<Dated> {
        let known = f64::INFINITY;
        let dated = |&(time_years, value, sd)| Dated { time_years, value, sd, degrees_of_freedom: known };
        values.iter().map(dated).collect()
    }

    /// Four values on paper: times −1, 0, 0, 2 with weights 1, 4, 4, 1. `t̄ = 0.1`, `Σ w (t − t̄)² = 4.9`.
    #[test]
    fn the_line_is_that_on_paper() {
        let values = dated(&[(-1.0, 2.0, 1.0), (0.0, 1.0, 0.5), (0.0, 1.5, 0.5), (2.0, 4.0, 1.0)]);
        let aging = Aging::of(&values).expect("a line");
        // v̄ = 1.6, Σ w (t − t̄) v = −2.2 − 0.4 − 0.6 + 7.6
        let per_year = 4.4 / 4.9;
        assert!((aging.per_year - per_year).abs() < 1e-14, "{aging:?}");
        let residual = |t: f64, v: f64| v - 1.6 - per_year * (t - 0.1);
        let chi2 = residual(-1.0, 2.0).powi(2)
            + 4.0 * residual(0.0, 1.0).powi(2)
            + 4.0 * residual(0.0, 1.5).powi(2)
            + residual(2.0, 4.0).powi(2);
        assert!((aging.chi2 - chi2).abs() < 1e-12 && aging.degrees_of_freedom == 2, "{aging:?}");
        let ratio = (chi2 / 2.0).sqrt();
        assert!(ratio > 1.0 && (aging.sd - ratio / 4.9_f64.sqrt()).abs() < 1e-14, "{aging:?}");
        // Student's t with two degrees of freedom: p = 1 − t/√(2 + t²)
        let t = per_year / aging.sd;
        assert!((aging.p_value - (1.0 - t / (2.0 + t * t).sqrt())).abs() < 1e-10, "{aging:?}");
        // χ² with two degrees of freedom: p = exp(−χ²/2)
        assert!((aging.fit_p_value.expect("a fit") - (-chi2 / 2.0).exp()).abs() < 1e-12);
    }

    /// Beside the dense formula `r = (Xᵀ Σ⁻¹ X)⁻¹ Xᵀ Σ⁻¹ v`, with `Σ = D + U Uᵀ`.
    #[test]
    fn values_with_errors_in_common_are_those_of_the_whole_covariance() {
        let values = dated(&[(0.0, 1.0, 0.5), (0.4, 1.2, 0.6), (1.0, 1.1, 0.5), (1.7, 1.9, 0.4)]);
        let shared = [vec![0.45, 0.5, 0.0, 0.0], vec![0.0, 0.0, 0.4, 0.35]];
        let aging = Aging::with_shared(&values, &shared).expect("a line");
        let u = DMatrix::from_fn(4, 2, |i, k| shared[k][i]);
        let own =
            DMatrix::from_fn(
                4,
                4,
                |i, j| {
                    if i == j { values[i].sd.powi(2) - u.row(i).norm_squared() } else { 0.0 }
                },
            );
        let sigma = (own + &u * u.transpose()).try_inverse().expect("regular");
        let x = DMatrix::from_fn(4, 2, |i, k| if k == 0 { 1.0 } else { values[i].time_years });
        let v = DVector::from_fn(4, |i, _| values[i].value);
        let covariance = (x.transpose() * &sigma * &x).try_inverse().expect("regular");
        let line = &covariance * x.transpose() * &sigma * &v;
        let residuals = &v - x * &line;
        let chi2 = residuals.dot(&(sigma * &residuals));
        assert!((aging.per_year - line[1]).abs() < 1e-12, "{aging:?} {line}");
        assert!((aging.chi2 - chi2).abs() < 1e-12, "{aging:?} {chi2}");
        let widened = (chi2 / 2.0).sqrt().max(1.0);
        assert!((aging.sd - covariance[(1, 1)].sqrt() * widened).abs() < 1e-12, "{aging:?}");
    }

    #[test]
    fn without_two_times_there_is_no_line() {
        assert_eq!(Aging::of(&[]), None);
        assert_eq!(Aging::of(&dated(&[(0.3, 1.0, 0.1)])), None);
        assert_eq!(Aging::of(&dated(&[(0.3, 1.0, 0.1), (0.3, 2.0, 0.2), (0.3, 3.0, 0.3)])), None);
        assert_eq!(Aging::of(&dated(&[(0.3, 1.0, 0.1), (1.3, 2.0, 0.0), (2.3, 3.0, f64::NAN)])), None);
    }

    /// The error of the change in its standard deviations. `scatter` is what the calibrations do not know, in units of the largest sd.
    fn errors(scatter: f64) -> Vec<(f64, f64)> {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let design = [(0.0, 0.2), (0.5, 0.1), (1.1, 0.3), (2.0, 0.1), (3.5, 0.2)];
        let drawn = |_| {
            let value =
                |(t, sd): (f64, f64), z: f64, extra: f64| (t, 5.0 - 0.7 * t + sd * z + 0.3 * extra, sd);
            let values = design.map(|of| value(of, normal(), scatter * normal()));
            let aging = Aging::of(&dated(&values)).expect("a line");
            let known = aging.sd / aging.birge_ratio.unwrap_or(1.0).max(1.0);
            ((aging.per_year + 0.7) / known, (aging.per_year + 0.7) / aging.sd)
        };
        (0..20_000).map(drawn).collect()
    }

    #[test]
    fn the_error_in_standard_deviations_is_standard_normal() {
        let errors = errors(0.0);
        let n = errors.len() as f64;
        let mean = errors.iter().map(|(known, _)| known).sum::<f64>() / n;
        let variance = errors.iter().map(|(known, _)| known * known).sum::<f64>() / n;
        let beyond = errors.iter().filter(|(known, _)| known.abs() > 1.959_964).count() as f64 / n;
        // four standard deviations of each figure for 20 000 draws
        assert!(mean.abs() < 4.0 / n.sqrt(), "{mean}");
        assert!((variance - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{variance}");
        assert!((beyond - 0.05).abs() < 4.0 * (0.05 * 0.95 / n).sqrt(), "{beyond}");
    }

    /// With a scatter that the calibrations do not know, the known sd promises far too much, and the Birge ratio with Student's t of three
    /// degrees of freedom about what it says.
    #[test]
    fn the_birge_ratio_covers_scatter_that_the_calibrations_do_not_know() {
        let errors = errors(2.0);
        let n = errors.len() as f64;
        let share = |beyond: usize| beyond as f64 / n;
        let known = share(errors.iter().filter(|(known, _)| known.abs() > 1.959_964).count());
        let widened = share(errors.iter().filter(|(_, widened)| widened.abs() > 3.182_446).count());
        assert!(known > 0.4, "{known}");
        assert!((0.03..0.09).contains(&widened), "{widened}");
    }

    /// How often p is below 0.05 without aging, where each sd is drawn with ν degrees of freedom: as it is, and with each sd taken as known.
    fn false_alarms(times: &[f64], degrees_of_freedom: f64) -> [f64; 2] {
        const DRAWS: usize = 20_000;
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let chi2 = ChiSquared::new(degrees_of_freedom).expect("positive");
        let mut alarms = [0_usize; 2];
        for _ in 0..DRAWS {
            let draw = |&time_years: &f64| {
                let (value, scatter): (f64, f64) = (StandardNormal.sample(&mut rng), chi2.sample(&mut rng));
                Dated { time_years, value, sd: (scatter / degrees_of_freedom).sqrt(), degrees_of_freedom }
            };
            let values: Vec<Dated> = times.iter().map(draw).collect();
            let known: Vec<Dated> =
                values.iter().map(|of| Dated { degrees_of_freedom: f64::INFINITY, ..*of }).collect();
            for (count, values) in alarms.iter_mut().zip([values, known]) {
                *count += usize::from(Aging::of(&values).expect("a line").p_value < 0.05);
            }
        }
        alarms.map(|count| count as f64 / DRAWS as f64)
    }

    #[test]
    fn few_degrees_behind_the_standard_deviations_make_few_false_alarms() {
        // four standard deviations of a share of 5 % in 20 000 draws
        let tolerance = 4.0 * (0.05_f64 * 0.95 / 20_000.0).sqrt();
        let [two, known] = false_alarms(&[0.0, 1.0], 4.0);
        assert!((two - 0.05).abs() < tolerance && known > 0.08, "{two} {known}");
        let [five, known] = false_alarms(&[0.0, 0.5, 1.1, 2.0, 3.5], 4.0);
        assert!((five - 0.05).abs() < tolerance && known > five + 0.005, "{five} {known}");
        // the Birge ratio makes p cautious, and estimated weights of many values make it bold
        let ([three, _], [ten, known]) = (
            false_alarms(&[0.0, 1.0, 2.0], 4.0),
            false_alarms(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], 4.0),
        );
        assert!((three - 0.041).abs() < tolerance, "{three}");
        assert!((ten - 0.09).abs() < 0.01 && known > ten, "{ten} {known}");
    }

    #[test]
    fn two_values_have_the_degrees_of_their_difference() {
        let at = |time_years, degrees_of_freedom| Dated {
            time_years,
            value: 0.3 * time_years,
            sd: 0.1,
            degrees_of_freedom,
        };
        let of = |values: [Dated; 2]| Aging::of(&values).expect("a line").degrees_behind;
        assert!((of([at(0.0, 6.0), at(2.0, 6.0)]) - 14.0).abs() < 1e-9);
        assert_eq!(of([at(0.0, f64::INFINITY), at(2.0, f64::INFINITY)]), f64::INFINITY);
    }
}

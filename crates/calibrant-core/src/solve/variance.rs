//! The between-hold variance: scatter that the noise does not explain (`paule1982`).
//!
//! Weighted by variances `v_i + σ²`, residuals have `χ²(σ) = Σ r_i²/(v_i + σ²)`, which falls with σ. The between-hold standard deviation is the σ for which it equals its degrees of freedom ν.
//! As a function of σ², `ν/χ²` is concave, and a straight line if all `v_i` are equal. The root therefore takes few steps.

use crate::root::root;

/// Relative tolerance of χ² against its degrees of freedom.
const CHI2_TOLERANCE: f64 = 1e-10;
/// Upper end of the search, as a multiple of the first guess.
const LARGEST_FACTOR: f64 = 1e30;

/// A fit with a trial value of σ.
#[derive(Debug, PartialEq)]
pub(crate) struct Trial<T> {
    pub(crate) chi2: f64,
    /// ν. It follows σ where a prior determines a part of the unknowns.
    pub(crate) degrees_of_freedom: f64,
    pub(crate) fitted: T,
}

/// The between-hold σ with its fit. It is zero if the noise explains the scatter, or without degrees of freedom.
///
/// `fit(σ)` fits with a trial value. `None` ends the search. The first call has σ = 0, and `guess` derives a σ of the right size from its fit.
pub(crate) fn excess<T>(
    guess: impl Fn(&T) -> f64,
    fit: impl FnMut(f64) -> Option<Trial<T>>,
) -> Option<(f64, T)> {
    let mut search = Search { fit, degrees_of_freedom: 0.0, best: None };
    let zero = (0.0, search.at(0.0)?);
    if search.degrees_of_freedom > 0.0 && zero.1 < 0.0 {
        let guess = search.best.as_ref().map_or(0.0, |(_, _, fitted)| guess(fitted));
        let (mut low, mut variance) = (zero, (guess * guess).max(f64::MIN_POSITIVE));
        let largest = variance * LARGEST_FACTOR;
        let high = loop {
            let here = (variance, search.at(variance)?);
            if here.1 >= 0.0 || variance > largest {
                break here;
            }
            low = here;
            variance *= 100.0;
        };
        if high.1 >= 0.0 {
            root([low, high], CHI2_TOLERANCE, 0.0, |variance| search.at(variance).ok_or(())).ok()?;
        }
    }
    search.best.map(|(_, sd, fitted)| (sd, fitted))
}

struct Search<T, F> {
    fit: F,
    /// Those of the latest call.
    degrees_of_freedom: f64,
    /// Distance from the root, σ and fit of the closest call.
    best: Option<(f64, f64, T)>,
}

impl<T, F: FnMut(f64) -> Option<Trial<T>>> Search<T, F> {
    /// `ν/χ² − 1` for a variance.
    fn at(&mut self, variance: f64) -> Option<f64> {
        let sd = variance.sqrt();
        let Trial { chi2, degrees_of_freedom, fitted } =
            (self.fit)(sd).filter(|trial| !trial.chi2.is_nan())?;
        self.degrees_of_freedom = degrees_of_freedom;
        let value = degrees_of_freedom / chi2 - 1.0;
        if self.best.as_ref().is_none_or(|(least, ..)| value.abs() < *least) {
            self.best = Some((value.abs(), sd, fitted));
        }
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals with their variances.
    const CASES: [&[(f64, f64)]; 3] = [
        &[(3.0, 1.0), (-2.0, 1.0), (4.0, 1.0), (1.0, 1.0)],
        &[(3.0, 1e-6), (-0.1, 4.0), (40.0, 1e3), (1e-3, 1e-9)],
        &[(1e-9, 0.0), (-3e-9, 0.0)],
    ];

    #[test]
    fn chi_square_equals_its_degrees_of_freedom() {
        for residuals in CASES {
            let chi2 = |sd: f64| residuals.iter().map(|(r, v)| r * r / (v + sd * sd)).sum::<f64>();
            for degrees in [1.0, 2.0, 3.0] {
                for guess in [1e-12, 1.0, 1e6] {
                    let mut count = 0;
                    let fit = |sd: f64| {
                        count += 1;
                        Some(Trial { chi2: chi2(sd), degrees_of_freedom: degrees, fitted: sd })
                    };
                    let (sd, fitted) = excess(|_| guess, fit).expect("found");
                    assert_eq!(sd, fitted, "what was fitted with it");
                    assert!((chi2(sd) / degrees - 1.0).abs() < 1e-9, "{residuals:?} {degrees} {guess}: {sd}");
                    assert!(count < 40, "{residuals:?} {degrees} {guess}: {count} fits");
                }
            }
        }
        // all variances equal: Σ r²/(1 + σ²) = 3
        let sd = found(30.0, |_| 3.0);
        assert!((sd - 3.0).abs() < 1e-9, "{sd}");
        // degrees of freedom that follow: 30/(1 + σ²) = 3 + σ²/(1 + σ²)
        let sd = found(30.0, |sd| 3.0 + sd * sd / (1.0 + sd * sd));
        assert!((sd * sd - 27.0 / 4.0).abs() < 1e-8, "{sd}");
    }

    /// The excess of residuals of equal variances.
    fn found(chi2: f64, degrees: impl Fn(f64) -> f64) -> f64 {
        let trial =
            |sd: f64| Trial { chi2: chi2 / (1.0 + sd * sd), degrees_of_freedom: degrees(sd), fitted: () };
        excess(|_| 1.0, |sd| Some(trial(sd))).expect("found").0
    }

    #[test]
    fn there_is_none_where_the_noise_explains_the_scatter() {
        assert_eq!(found(2.0, |_| 2.5), 0.0);
        assert_eq!(found(2.0, |_| 0.0), 0.0);
        assert_eq!(excess(|_| 1.0, |_| None::<Trial<()>>), None, "a fit that fails ends the search");
    }
}

//! The between-hold variance: scatter that the noise does not explain (`paule1982`).
//!
//! Weighted by variances `v_i + σ²`, residuals have `χ²(σ) = Σ r_i²/(v_i + σ²)`, which falls with σ. The between-hold standard deviation is the σ for which it equals its degrees of freedom ν.
//! As a function of σ², `ν/χ²` is concave, and a straight line if all `v_i` are equal. The root therefore takes few steps.

use crate::root::root;

/// Relative tolerance of χ² against its degrees of freedom.
const CHI2_TOLERANCE: f64 = 1e-10;
/// Upper end of the search, as a multiple of the first guess.
const LARGEST_FACTOR: f64 = 1e30;

/// The between-hold σ with its fit. It is zero if the noise explains the scatter, or without degrees of freedom.
///
/// `fit(σ)` returns χ² and the fit. `None` ends the search. The first call has σ = 0, and `guess` derives a σ of the right size from its fit.
pub(super) fn excess<T>(
    degrees_of_freedom: f64,
    guess: impl Fn(&T) -> f64,
    fit: impl FnMut(f64) -> Option<(f64, T)>,
) -> Option<(f64, T)> {
    let mut search = Search { degrees_of_freedom, fit, best: None };
    let zero = (0.0, search.at(0.0)?);
    if degrees_of_freedom > 0.0 && zero.1 < 0.0 {
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
    degrees_of_freedom: f64,
    fit: F,
    /// Distance from the root, σ and fit of the closest call.
    best: Option<(f64, f64, T)>,
}

impl<T, F: FnMut(f64) -> Option<(f64, T)>> Search<T, F> {
    /// `ν/χ² − 1` for a variance.
    fn at(&mut self, variance: f64) -> Option<f64> {
        let sd = variance.sqrt();
        let (chi2, fitted) = (self.fit)(sd).filter(|(chi2, _)| !chi2.is_nan())?;
        let value = self.degrees_of_freedom / chi2 - 1.0;
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
                        Some((chi2(sd), sd))
                    };
                    let (sd, fitted) = excess(degrees, |_| guess, fit).expect("found");
                    assert_eq!(sd, fitted, "what was fitted with it");
                    assert!((chi2(sd) / degrees - 1.0).abs() < 1e-9, "{residuals:?} {degrees} {guess}: {sd}");
                    assert!(count < 40, "{residuals:?} {degrees} {guess}: {count} fits");
                }
            }
        }
        // all variances equal: Σ r²/(1 + σ²) = 3
        let sd = excess(3.0, |_| 1.0, |sd| Some((30.0 / (1.0 + sd * sd), ()))).expect("found").0;
        assert!((sd - 3.0).abs() < 1e-9, "{sd}");
    }

    #[test]
    fn there_is_none_where_the_noise_explains_the_scatter() {
        let of =
            |degrees: f64| excess(degrees, |_| 1.0, |sd| Some((2.0 / (1.0 + sd * sd), ()))).expect("found").0;
        assert_eq!(of(2.5), 0.0);
        assert_eq!(of(0.0), 0.0);
        assert_eq!(excess(1.0, |_| 1.0, |_| None::<(f64, ())>), None, "a fit that fails ends the search");
    }
}

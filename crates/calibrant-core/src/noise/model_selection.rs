//! Model selection of the noise: the shortest cluster time of the fit, and whether a filter acts on the
//! samples.
//!
//! # What a filter does
//! White noise through a filter whose gain is 1 at rest has autocovariances `r(k)`. `N² = Σ r(k)` over all
//! `k` is that of the white noise. Means of many samples depend on nothing else. Beyond the length of the
//! filter the generalised autocovariance of the summed readings is
//!
//! ```text
//! −½ Var(x_h − x_0) = −½ N² |h| + D,   D = Σ_{k ≥ 1} k r(k)
//! ```
//!
//! and zero at `h = 0`. Up to a constant that differences remove, this is white noise plus quantisation of
//! `Q² = −D`, *less* than none. So for clusters longer than the filter, `σ²(τ) = N²/τ − 3 D τ₀²/τ²`. This is
//! exact for a filter of finite length. For others the remainder falls like the impulse response
//! (`D = φ/(1 − φ²) N²` for the pole φ). A fit of N alone has a bias of `−3 D τ₀²/τ²` instead. The standard
//! deviation of the Allan variance falls as fast, so the bias need not show.
//!
//! # The selection
//! All cluster times are fitted without a filter where that explains them and a filter's share is not
//! significant. Otherwise the filter's share is fitted, too. Let τ be the shortest cluster time that agrees
//! with the later ones. The fit starts at 2τ: the remainder of the filter does not show at τ, and doubling
//! the cluster time squares it. A weak filter has a small share and correlates only successive samples, so it
//! needs all cluster times. Covariances are those without the filter, which are larger.
//!
//! The test of the shortest cluster time uses that time alone: the decrease of χ² without it. A total misfit
//! by chance may come from long cluster times. Dropping short ones does not remove it, and no N would be
//! left.

use super::Moments;
use super::allan_regression::{Regression, SIGNIFICANT};
use nalgebra::DVector;
use std::cell::OnceCell;

/// Fewest cluster times that are fitted.
const FEWEST_SCALES: usize = 5;
/// The shortest cluster time disagrees with the others if χ² is less by this without it. It is two standard
/// deviations: the remainder of the filter does harm before it is certain.
const DISAGREES: f64 = 4.0;
/// Above this probability a weak filter counts as no misfit.
const NO_MISFIT: f64 = 0.05;
/// A filter is weak if its share is less than this part of the white noise. The square of the share then adds
/// a fraction of a per cent to N.
const WEAK: f64 = 0.05;

/// The significant processes, on the scales that they explain.
pub(super) fn choose<'a>(moments: &'a Moments, observed: &'a DVector<f64>) -> Regression<'a> {
    let last = moments.scales().len().saturating_sub(FEWEST_SCALES);
    let without = |first: usize| Regression::reduced(moments, observed, first, false);
    let unfiltered = without(0);
    let shows = |fit: &Regression| fit.filter_significance().is_some_and(|found| found <= -SIGNIFICANT);
    if !shows(&unfiltered) {
        if unfiltered.explains() {
            return unfiltered;
        }
        if last > 0 && unfiltered.chi2 < without(1).chi2 + DISAGREES {
            // the misfit is not at the shortest cluster time; a filter of many samples shows its share only
            // without the short ones
            let mut later = (1..=last).map(without);
            match later.find(|fit| fit.explains() || shows(fit)) {
                Some(fit) if !shows(&fit) => return fit,
                Some(_) => {}
                None => return unfiltered,
            }
        }
    }
    let from = |first: usize| Regression::reduced(moments, observed, first, true);
    let weak = from(0);
    if weak.p_value().is_none_or(|p| p >= NO_MISFIT) && weak.filter_share().abs() < WEAK {
        return weak;
    }
    // two parameters explain the shortest two cluster times of any filter; only a few of these fits are
    // needed
    let fits: Vec<OnceCell<Regression>> = (1..=last).map(|_| OnceCell::new()).collect();
    let fit = |k: usize| fits.get(k).map(|cell| cell.get_or_init(|| from(k + 1)));
    let explains = |k: &usize| fit(*k).is_some_and(Regression::explains);
    let agrees = |k: &usize| match (fit(*k), fit(k + 1)) {
        (Some(with), Some(without)) => with.chi2 < without.chi2 + DISAGREES,
        _ => true,
    };
    let explained = || (0..fits.len()).filter(explains);
    let seen = explained().find(agrees).or_else(|| explained().next());
    let chosen = seen.map(|seen| if explains(&(seen + 1)) { seen + 1 } else { seen });
    chosen.and_then(|place| fits.into_iter().nth(place)?.into_inner()).unwrap_or(unfiltered)
}

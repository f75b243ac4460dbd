//! From which cluster time on the processes are fitted, and whether the samples are filtered.
//!
//! # What a filter does
//! White noise through a filter whose gain is 1 at rest has autocovariances `r(k)`; `N² = Σ r(k)` over all `k` is that of the white noise, and all that means of many samples know of
//! it. Beyond the length of the filter the generalised autocovariance of the summed readings is
//!
//! ```text
//! −½ Var(x_h − x_0) = −½ N² |h| + D,   D = Σ_{k ≥ 1} k r(k)
//! ```
//!
//! and zero at `h = 0`: up to a constant that differences do not see, white noise plus quantisation of `Q² = −D`, *less* than none. So once clusters are longer than the filter,
//! `σ²(τ) = N²/τ − 3 D τ₀²/τ²` exactly for a filter of finite length, and up to a remainder that falls like its impulse response for others (`D = φ/(1 − φ²) N²` for the pole φ).
//! A fit of N alone has a bias of `−3 D τ₀²/τ²` instead, which falls no faster than the standard deviation of the Allan variance allows to be seen.
//!
//! # The choice
//! All cluster times without a filter, where that explains them and a filter's share is not significant. Else with the filter's share, from twice the shortest cluster time on that agrees
//! with those after it: what is left of the filter is there unseen already, and doubling the cluster time squares it. A weak filter, whose share is small, is all in the lag of one
//! sample, and needs no cluster time left out. Covariances are those without the filter, which are larger.
//!
//! Whether the shortest cluster time agrees is asked of it alone, of what χ² loses without it: a total misfit by chance, at long cluster times, does not go away with short ones, and left nothing
//! of N.

use super::Moments;
use super::allan_regression::{Regression, SIGNIFICANT};
use nalgebra::DVector;
use std::cell::OnceCell;

/// Fewest cluster times that are fitted.
const FEWEST_SCALES: usize = 5;
/// The shortest cluster time disagrees with the others if χ² is less by this without it: two standard deviations, since what is left of a filter does harm before it is beyond doubt.
const DISAGREES: f64 = 4.0;
/// Above this probability the misfit of a weak filter is none.
const NO_MISFIT: f64 = 0.05;
/// A filter is weak if its share is less than this part of the white noise: what its square adds is then a fraction of a per cent of N.
const WEAK: f64 = 0.05;

/// The processes that are significant, on the scales that they explain.
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
            // the misfit is not at the shortest cluster time; a filter of many samples shows its share only where they are left out
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
    // two parameters explain the shortest two cluster times of any filter; few of these fits are asked for
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

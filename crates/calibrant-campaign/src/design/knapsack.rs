//! The linear program of each step: the soaks that gain most in the time, at most so many at each place.
//!
//! Its dual in one price `μ` of a minute, `D* = min_μ μ minutes + cycles Σ_places max (gain − μ cost)₊`, is solved by bisection. The optimum mixes the choices
//! on either side of the price.

use super::candidates::Candidates;

/// The best soaks, and what no other soaks in the time can gain.
pub(super) struct Vertex {
    /// Candidates with their numbers, which may be fractions.
    pub(super) soaks: Vec<(usize, f64)>,
    /// `D*`.
    pub(super) bound: f64,
    /// What a minute more would gain.
    pub(super) price: f64,
}

/// Halvings of the range of prices.
const HALVINGS: usize = 80;

pub(super) fn best(candidates: &Candidates, gains: &[f64], cycles: usize, minutes: f64) -> Vertex {
    let cap = cycles as f64;
    // the best choice of each place at a price; none where the price is too high
    let choice = |price: f64| -> Vec<(usize, f64)> {
        let at = |place: usize| {
            let first = place * candidates.choices();
            let net =
                (first..first + candidates.choices()).map(|k| (k, gains[k] - price * candidates.minutes(k)));
            net.max_by(|one, other| one.1.total_cmp(&other.1)).filter(|(_, net)| *net > 0.0)
        };
        (0..candidates.places.len()).filter_map(at).collect()
    };
    let time =
        |chosen: &[(usize, f64)]| cap * chosen.iter().map(|(k, _)| candidates.minutes(*k)).sum::<f64>();
    let all = choice(0.0);
    if time(&all) <= minutes {
        let bound = cap * all.iter().map(|(k, _)| gains[*k]).sum::<f64>();
        return Vertex { soaks: all.into_iter().map(|(k, _)| (k, cap)).collect(), bound, price: 0.0 };
    }
    let per_minute = (0..gains.len()).map(|k| gains[k] / candidates.minutes(k));
    let (mut low, mut high) = (0.0, per_minute.fold(0.0, f64::max) * 1.001);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if time(&choice(middle)) > minutes { &mut low } else { &mut high }) = middle;
    }
    let (more, fewer) = (choice(low), choice(high));
    let (long, short) = (time(&more), time(&fewer));
    let part = if long > short { (minutes - short) / (long - short) } else { 0.0 };
    let bound = high * minutes + cap * fewer.iter().map(|(_, net)| net).sum::<f64>();
    let mixed = more.iter().map(|(k, _)| (*k, cap * part));
    let soaks = mixed.chain(fewer.iter().map(|(k, _)| (*k, cap * (1.0 - part))));
    Vertex { soaks: soaks.filter(|(_, count)| *count > 0.0).collect(), bound, price: high }
}

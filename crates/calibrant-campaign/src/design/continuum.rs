//! The most that soaks at any temperatures can gain.
//!
//! Soaks of one pass are at least the spacing apart, so each half-open cell of this width has one of them at most, in each direction and cycle. The best of each
//! cell, at the best price of a minute, bounds what all gain, wherever they are.

use super::candidates::Candidates;
use crate::criterion::Gradient;
use crate::{Campaign, golden_section};

/// Step of the temperatures within a cell, K.
const STEP_C: f64 = 0.1;
/// Steps of the search for the best price.
const STEPS: usize = 60;

pub(super) fn any_temperature(campaign: &Campaign, gradients: &[Gradient]) -> f64 {
    let [low, high] = campaign.range_c;
    let cells = ((high - low) / campaign.spacing_c + 1e-9).floor() as usize + 1;
    let in_cell = |cell: usize| -> Vec<f64> {
        let first = low + cell as f64 * campaign.spacing_c;
        let steps = ((campaign.spacing_c.min(high - first)) / STEP_C).round() as usize;
        (0..=steps).map(|k| (first + k as f64 * STEP_C).min(high)).collect()
    };
    let cells: Vec<(Candidates, Vec<f64>)> = (0..cells)
        .map(|cell| {
            let candidates = Candidates::of(campaign, &in_cell(cell));
            let gains = candidates.gains(gradients);
            (candidates, gains)
        })
        .collect();
    // convex in the price: golden section
    let at = |price: f64| {
        let mut sum = 0.0;
        for (candidates, gains) in &cells {
            for direction in 0..campaign.directions.len() {
                let of_direction = (0..gains.len())
                    .filter(|k| k / candidates.choices() % campaign.directions.len() == direction);
                let net = of_direction.map(|k| gains[k] - price * candidates.minutes(k));
                sum += net.fold(0.0, f64::max);
            }
        }
        price * campaign.soaking_min() + campaign.cycles as f64 * sum
    };
    let per_minute = cells.iter().flat_map(|(candidates, gains)| {
        gains.iter().enumerate().map(|(k, gain)| gain / candidates.minutes(k))
    });
    at(golden_section::least(at, [0.0, per_minute.fold(0.0, f64::max)], STEPS))
}

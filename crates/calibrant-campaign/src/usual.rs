//! The campaigns that are usual, in the same time.

use crate::{Campaign, Direction, Soak};

/// A campaign without a design: evenly spaced soaks with one wait.
#[derive(Debug, Clone, PartialEq)]
pub struct UsualCampaign {
    /// Distance of the soaks, K.
    pub every_c: f64,
    /// Wait of each, min.
    pub wait_min: f64,
    /// There and back, or upwards only?
    pub both: bool,
    /// The soaks: as many blocks in each as fit.
    pub soaks: Vec<Soak>,
}

/// Distance, wait and both ways of what engineers do: there and back, and upwards with the long waits of a thermal chamber's manual.
const PATTERNS: [(f64, f64, bool); 6] = [
    (10.0, 10.0, true),
    (5.0, 5.0, true),
    (5.0, 0.0, true),
    (10.0, 20.0, false),
    (10.0, 30.0, false),
    (20.0, 45.0, false),
];

/// The usual campaigns that fit into the time of this one.
#[must_use]
pub fn usual(campaign: &Campaign) -> Vec<UsualCampaign> {
    let [low, high] = campaign.range_c;
    let goes_down = campaign.directions.contains(&Direction::Down);
    let of = |&(every_c, wait_min, both): &(f64, f64, bool)| {
        let steps = ((high - low) / every_c).round();
        let is_allowed = every_c >= campaign.spacing_c && wait_min >= campaign.shortest_wait_min;
        if steps < 1.0 || both && !goes_down || !is_allowed {
            return None;
        }
        let temperature = |k: usize| low + (high - low) * k as f64 / steps;
        let up = (0..=steps as usize).map(|k| (temperature(k), Direction::Up));
        let down = (1..steps as usize).rev().filter(|_| both).map(|k| (temperature(k), Direction::Down));
        let places: Vec<_> = up.chain(down).collect();
        let left_min = campaign.soaking_min() - places.len() as f64 * wait_min;
        let blocks = (left_min / (places.len() as f64 * campaign.block_min) + 1e-9).floor();
        let soaks = |blocks: usize| {
            places.iter().map(move |&(temperature_c, direction)| Soak {
                temperature_c,
                direction,
                wait_min,
                blocks,
            })
        };
        (blocks >= 1.0).then(|| UsualCampaign {
            every_c,
            wait_min,
            both,
            soaks: soaks(blocks as usize).collect(),
        })
    };
    PATTERNS.iter().filter_map(of).collect()
}

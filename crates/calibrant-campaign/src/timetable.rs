//! The order of soaks in a closed cycle, and when each begins.

use crate::campaign::ROOM_C;
use crate::{Campaign, Direction, Soak};

/// A soak in its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedSoak {
    /// The soak.
    pub soak: Soak,
    /// When the chamber has reached its temperature, min after the start.
    pub begin_min: f64,
    /// When its last hold ends.
    pub end_min: f64,
}

/// The soaks of a campaign in their order. A cycle begins at room temperature, goes up to the upper end, down to the lower, and up again; with a heater alone it
/// begins at the lower end.
#[must_use]
pub fn timetable(campaign: &Campaign, soaks: &[Soak]) -> Vec<TimedSoak> {
    let [low, high] = campaign.range_c;
    let goes_down = campaign.directions.contains(&Direction::Down);
    let start_c = if goes_down { ROOM_C.clamp(low, high) } else { low };
    // what is soaked at several times has one in each cycle
    let mut left = soaks.to_vec();
    let mut rows = Vec::new();
    let (mut now_min, mut at_c) = (0.0, ROOM_C);
    while !left.is_empty() {
        let mut cycle: Vec<Soak> = Vec::new();
        let is_there = |cycle: &[Soak], soak: &Soak| {
            cycle.iter().any(|of| of.temperature_c == soak.temperature_c && of.direction == soak.direction)
        };
        left.retain(|soak| {
            let later = is_there(&cycle, soak);
            if !later {
                cycle.push(*soak);
            }
            later
        });
        // leg of the cycle, and place in it
        let leg = |soak: &Soak| match soak.direction {
            Direction::Up if soak.temperature_c >= start_c => 0,
            Direction::Down => 1,
            Direction::Up => 2,
        };
        let along = |soak: &Soak| soak.direction.sign() * soak.temperature_c;
        cycle.sort_by(|one, other| leg(one).cmp(&leg(other)).then(along(one).total_cmp(&along(other))));
        let mut ramp = |to_c: f64, now_min: &mut f64| {
            *now_min += (to_c - at_c).abs() / campaign.ramp_k_per_min;
            at_c = to_c;
        };
        for (k, soak) in cycle.iter().enumerate() {
            // over both ends, whether something is soaked there or not
            let before = k.checked_sub(1).map_or(if goes_down { 0 } else { 2 }, |k| leg(&cycle[k]));
            if before == 0 && leg(soak) > 0 {
                ramp(high, &mut now_min);
            }
            if before < 2 && leg(soak) == 2 || k == 0 && !goes_down {
                ramp(low, &mut now_min);
            }
            ramp(soak.temperature_c, &mut now_min);
            let begin_min = now_min;
            now_min += campaign.minutes(soak);
            rows.push(TimedSoak { soak: *soak, begin_min, end_min: now_min });
        }
        // the next cycle begins where this one ends, over both ends
        let last = cycle.last().map_or(2, leg);
        if !left.is_empty() && goes_down && last < 2 {
            if last == 0 {
                ramp(high, &mut now_min);
            }
            ramp(low, &mut now_min);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CampaignCriterion;

    fn campaign(directions: &[Direction]) -> Campaign {
        Campaign {
            channels: Vec::new(),
            range_c: [-20.0, 60.0],
            budget_min: 200.0,
            ramp_k_per_min: 2.0,
            time_constant_min: 10.0,
            block_min: 1.5,
            directions: directions.to_vec(),
            cycles: 1,
            spacing_c: 5.0,
            shortest_wait_min: 0.0,
            criterion: CampaignCriterion::I,
            recorded: Vec::new(),
        }
    }

    fn soak(temperature_c: f64, direction: Direction) -> Soak {
        Soak { temperature_c, direction, wait_min: 5.0, blocks: 2 }
    }

    #[test]
    fn a_cycle_passes_each_temperature_once_in_each_direction() {
        use Direction::{Down, Up};
        let soaks = [soak(0.0, Up), soak(40.0, Up), soak(0.0, Down), soak(40.0, Down)];
        let campaign = campaign(&[Up, Down]);
        let rows = timetable(&campaign, &soaks);
        let order: Vec<_> = rows.iter().map(|row| (row.soak.temperature_c, row.soak.direction)).collect();
        assert_eq!(order, [(40.0, Up), (40.0, Down), (0.0, Down), (0.0, Up)]);
        // 15 K up; 20 up and 20 down; 40 down; 20 down and 20 up: at 2 K/min, and 8 min in each soak
        let begins: Vec<f64> = rows.iter().map(|row| row.begin_min).collect();
        assert_eq!(begins, [7.5, 35.5, 63.5, 91.5]);
        // and back to where it began: the ramps of a whole cycle
        let ramps = rows[3].end_min - 4.0 * 8.0 + (25.0 - 0.0) / 2.0;
        assert!((ramps - campaign.travel_min()).abs() < 1e-12, "{ramps}");
    }

    #[test]
    fn a_heater_begins_at_the_lower_end() {
        let rows =
            timetable(&campaign(&[Direction::Up]), &[soak(40.0, Direction::Up), soak(-20.0, Direction::Up)]);
        assert_eq!(rows.iter().map(|row| row.begin_min).collect::<Vec<_>>(), [22.5, 60.5]);
    }
}

//! A soak as it was recorded: the calibration at its temperature, and from where it came there.

use crate::Campaign;
use crate::campaign::ROOM_C;
use calibrant_core::estimate::{KnownTerm, SoakTemperature};
use calibrant_core::sensor::CalibratedImu;

/// The calibration of one soak.
#[derive(Debug, Clone)]
pub struct SoakCalibration {
    /// Its name: that of its folder, or of its file.
    pub name: String,
    /// The sensor at its temperature.
    pub imu: CalibratedImu,
    /// The temperature over its holds.
    pub temperature: SoakTemperature,
    /// What other soaks say of the parameters, on which the calibration rests; empty where it determines them by itself.
    pub prior: Vec<KnownTerm>,
}

/// From where a soak came to its temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoakPath {
    /// Its temperature, °C.
    pub temperature_c: f64,
    /// +1 from below, −1 from above, 0 where nobody knows.
    pub direction: f64,
    /// The share of the error at the rate of the ramp that is left: the rate over that of the ramp.
    pub lag_left: f64,
}

/// The temperature changes where its rate is more than this share of the ramp's.
pub(super) const CHANGES: f64 = 0.05;
/// Temperatures that differ by less are the same, K.
const SAME_K: f64 = 1.0;

/// The paths of soaks or holds in the order in which they were recorded. The rate of the recorded temperature tells the direction; where it does not change, the one
/// before, or the room.
#[must_use]
pub fn paths(campaign: &Campaign, temperatures: impl IntoIterator<Item = SoakTemperature>) -> Vec<SoakPath> {
    let (mut before_c, mut direction) = (ROOM_C, 0.0);
    temperatures
        .into_iter()
        .map(|SoakTemperature { mean_c, rate_k_per_min, .. }| {
            let lag_left = rate_k_per_min.abs() / campaign.ramp_k_per_min;
            if lag_left > CHANGES {
                direction = rate_k_per_min.signum();
            } else if (mean_c - before_c).abs() > SAME_K {
                direction = (mean_c - before_c).signum();
            }
            before_c = mean_c;
            SoakPath {
                temperature_c: mean_c,
                direction,
                lag_left: if direction == 0.0 { 0.0 } else { lag_left },
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::tests::campaign;

    #[test]
    fn rates_tell_directions_and_where_nothing_changes_the_soak_before_does() {
        let soak = |(mean_c, rate_k_per_min): (f64, f64)| SoakTemperature {
            mean_c,
            rate_k_per_min,
            range_c: [mean_c; 2],
        };
        let soaks =
            [(25.2, 0.0), (40.0, 0.5), (60.0, 0.01), (60.3, 0.0), (50.0, -0.02), (55.0, -1.0)].map(soak);
        let paths = paths(&campaign(), soaks);
        let found: Vec<f64> = paths.iter().map(|path| path.direction).collect();
        assert_eq!(found, [0.0, 1.0, 1.0, 1.0, -1.0, -1.0], "at a room's temperature nobody knows");
        assert_eq!(paths[5].lag_left, 0.5);
    }
}

//! A campaign: chamber, time and the soaks that it may consist of.

use crate::criterion::{Gradient, over_range};
use crate::{CampaignCriterion, Channel};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::number_format::plain;
use nalgebra::DMatrix;

/// From where a temperature is reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// From below.
    Up,
    /// From above.
    Down,
}

impl Direction {
    /// `+1` or `−1`.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Up => 1.0,
            Self::Down => -1.0,
        }
    }

    /// As in files: `up`, `down`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Up => "up",
            Self::Down => "down",
        }
    }
}

/// One soak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soak {
    /// Temperature of the chamber, °C.
    pub temperature_c: f64,
    /// From where it is reached.
    pub direction: Direction,
    /// Time from the end of the ramp to the first hold, min.
    pub wait_min: f64,
    /// Number of blocks of holds.
    pub blocks: usize,
}

/// Chamber, time, and what is to be determined.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// What follows temperature.
    pub channels: Vec<Channel>,
    /// Temperatures of use, °C; soaks lie within.
    pub range_c: [f64; 2],
    /// Time of the whole campaign, ramps included, min.
    pub budget_min: f64,
    /// Rate of the chamber, K/min.
    pub ramp_k_per_min: f64,
    /// Time constant between chamber and sense element, min.
    pub time_constant_min: f64,
    /// Time of a block of holds, moves included, min.
    pub block_min: f64,
    /// Directions in which a temperature may be reached.
    pub directions: Vec<Direction>,
    /// Closed cycles over the range: a temperature is soaked at once in each direction in each of them.
    pub cycles: usize,
    /// Soaks of one pass are at least this far apart, K: nearer ones repeat the same error.
    pub spacing_c: f64,
    /// The shortest wait, min.
    pub shortest_wait_min: f64,
    /// What is minimised.
    pub criterion: CampaignCriterion,
    /// What soaks that are recorded already tell of the coefficients of each channel; empty where there are none.
    pub recorded: Vec<DMatrix<f64>>,
}

/// Where a campaign begins and ends, °C.
pub(crate) const ROOM_C: f64 = 25.0;
/// The longest wait, in time constants.
const LONGEST_WAIT: f64 = 6.0;
/// Steps of the waits, in time constants.
const WAIT_STEP: f64 = 0.5;
/// Most blocks of a soak.
pub(crate) const MOST_BLOCKS: usize = 12;

impl Campaign {
    /// Checks that there is time for a soak.
    ///
    /// # Errors
    /// [`Error::Infeasible`] with the least budget.
    pub fn check(&self) -> Result<()> {
        let least_min = self.travel_min() + self.shortest_wait_min + self.block_min;
        if self.budget_min < least_min {
            let [low, high] = self.range_c;
            let message = format!(
                "{} min are too short: the ramps from {} to {} °C and back take {} min, and one block of holds {} min",
                plain(self.budget_min, 4),
                plain(low, 4),
                plain(high, 4),
                plain(self.travel_min(), 4),
                plain(self.shortest_wait_min + self.block_min, 4)
            );
            let help = format!(
                "give at least {} min, a smaller range, or a faster ramp",
                plain(least_min.ceil(), 5)
            );
            let error = InputError::new(Refusal::MotionInfeasible, message, help);
            return Err(Error::infeasible(error.about_key("campaign.budget_min")));
        }
        Ok(())
    }

    /// A temperature as `−1 … 1` over the range.
    #[must_use]
    pub fn x(&self, temperature_c: f64) -> f64 {
        over_range(self.range_c, temperature_c)
    }

    /// Standard deviation over sensors of the coefficient of a power of temperature, 1 or 2, at the end of the range, where it is largest.
    #[must_use]
    pub fn power_sd(&self, channel: &Channel, order: usize) -> f64 {
        let [low, high] = self.range_c;
        // P_m'(1) = m (m + 1)/2 and P_m''(1)/2 = (m − 1) m (m + 1) (m + 2)/16
        let of = |(m, sd): (usize, &Option<f64>)| {
            let at_end = match order {
                1 => (m * (m + 1)) as f64 / 2.0,
                _ => (m.saturating_sub(1) * m * (m + 1) * (m + 2)) as f64 / 16.0,
            };
            sd.unwrap_or(0.0) * at_end
        };
        let square: f64 = channel.spread.iter().enumerate().map(of).map(|sd| sd * sd).sum();
        square.sqrt() * (2.0 / (high - low)).powi(order as i32)
    }

    /// Time of the ramps, min: a closed cycle over both ends passes each temperature once in each direction. Where the room is outside the range, there and
    /// back once more.
    #[must_use]
    pub fn travel_min(&self) -> f64 {
        let [low, high] = self.range_c;
        2.0 * (self.cycles as f64 * (high - low) + (ROOM_C - ROOM_C.clamp(low, high)).abs())
            / self.ramp_k_per_min
    }

    /// Time that is left for waits and holds, min.
    #[must_use]
    pub fn soaking_min(&self) -> f64 {
        self.budget_min - self.travel_min()
    }

    /// Time of a soak, min.
    #[must_use]
    pub fn minutes(&self, soak: &Soak) -> f64 {
        soak.wait_min + soak.blocks as f64 * self.block_min
    }

    /// The share of a lag that is left after a wait.
    #[must_use]
    pub fn lag_left(&self, wait_min: f64) -> f64 {
        (-wait_min / self.time_constant_min).exp()
    }

    /// What is known of the coefficients of each channel before the campaign.
    #[must_use]
    pub fn known(&self) -> Vec<DMatrix<f64>> {
        let of = |(k, channel): (usize, &Channel)| match self.recorded.get(k) {
            Some(recorded) => channel.precision() + recorded,
            None => channel.precision(),
        };
        self.channels.iter().enumerate().map(of).collect()
    }

    /// What is known of the coefficients of each channel after these soaks.
    #[must_use]
    pub fn information(&self, soaks: &[Soak]) -> Vec<DMatrix<f64>> {
        let mut information = self.known();
        for soak in soaks {
            let (x, left) = (self.x(soak.temperature_c), self.lag_left(soak.wait_min));
            for (channel, information) in self.channels.iter().zip(&mut information) {
                let row = channel.row(x, soak.direction.sign(), left);
                information.ger(channel.variance(soak.blocks, left).recip(), &row, &row, 1.0);
            }
        }
        information
    }

    /// The criterion of these soaks; `None` where they leave a coefficient open.
    #[must_use]
    pub fn value(&self, soaks: &[Soak]) -> Option<f64> {
        self.value_of(&self.information(soaks))
    }

    /// The criterion of this information about each channel.
    pub(crate) fn value_of(&self, information: &[DMatrix<f64>]) -> Option<f64> {
        self.criterion.value(self.range_c, &self.channels, information)
    }

    /// Its negative gradient.
    pub(crate) fn gradient_of(&self, information: &[DMatrix<f64>]) -> Option<Vec<Gradient>> {
        self.criterion.gradient(self.range_c, &self.channels, information)
    }

    /// Standard deviation of each channel's polynomial with this information, root of the mean variance over the range.
    #[must_use]
    pub fn sd(&self, information: &[DMatrix<f64>]) -> Option<Vec<f64>> {
        let of = |(channel, information): (&Channel, &DMatrix<f64>)| {
            let inverse = information.clone().cholesky()?.inverse();
            let mean = (0..channel.polynomial())
                .map(|m| inverse[(m, m)] * calibrant_core::sensor::legendre::mean_square(m));
            Some(mean.sum::<f64>().sqrt())
        };
        self.channels.iter().zip(information).map(of).collect()
    }

    /// Standard deviation of a channel's polynomial at a temperature, with this information about it.
    #[must_use]
    pub fn sd_at(&self, channel: &Channel, information: &DMatrix<f64>, temperature_c: f64) -> Option<f64> {
        let row = channel.polynomial_row(self.x(temperature_c));
        Some(information.clone().cholesky()?.solve(&row).dot(&row).sqrt())
    }

    /// The temperatures of soaks: from end to end in steps of about the spacing, not below it.
    pub(crate) fn temperatures_c(&self) -> Vec<f64> {
        let [low, high] = self.range_c;
        let steps = ((high - low) / self.spacing_c + 1e-9).floor().max(1.0);
        (0..=steps as usize).map(|k| low + (high - low) * k as f64 / steps).collect()
    }

    /// The waits of soaks. Where no thermometer lags, the shortest.
    pub(crate) fn waits_min(&self) -> Vec<f64> {
        let steps = if self.channels.iter().any(|channel| !channel.lag_sd.is_empty()) {
            (LONGEST_WAIT / WAIT_STEP) as usize
        } else {
            0
        };
        let longest = (LONGEST_WAIT * self.time_constant_min).max(self.shortest_wait_min);
        let wait = |k: usize| {
            self.shortest_wait_min + (longest - self.shortest_wait_min) * k as f64 / steps.max(1) as f64
        };
        (0..=steps).map(wait).collect()
    }
}

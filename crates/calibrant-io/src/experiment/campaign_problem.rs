//! Makes the campaign over temperature that an experiment file describes.

use super::campaign::{CampaignDirections, CampaignLetter, CampaignSection, ChannelSection, Usual};
use super::number::{Count, Within};
use super::ranges::PriorSd;
use super::{Experiment, Plan};
use calibrant_campaign::{Campaign, CampaignCriterion, Channel, Direction};
use calibrant_core::error::Result;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::SensorKind;

/// The range of what is usual, K.
const USUAL_RANGE_K: f64 = 80.0;
/// Holds of a block: six faces.
const FACES: f64 = 6.0;
/// The holds of [`Usual::block_sd`], s.
const USUAL_HOLD_S: f64 = 10.0;
/// The share of the lag's error that differs from soak to soak, where nothing is known.
const LAG_SCATTER: f64 = 0.2;
impl Experiment {
    /// The campaign over temperature that `[campaign]` describes, where it is there.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) with the key, where values contradict each other.
    pub fn campaign(&self) -> Result<Option<Campaign>> {
        self.campaign.as_ref().map(|section| section.problem(self)).transpose()
    }
}

impl CampaignSection {
    fn problem(&self, experiment: &Experiment) -> Result<Campaign> {
        let hold_s = self.hold_s.map_or(USUAL_HOLD_S, f64::from);
        let [low, high] = self.range_c()?;
        let half_range_share = (high - low) / USUAL_RANGE_K;
        let there = |of: &Usual| of.sensor_kind == SensorKind::Accelerometer || experiment.imu.is_some();
        let channel = |(of, section): (&Usual, Option<&ChannelSection>)| {
            let usual = ChannelSection::default();
            let section = section.unwrap_or(&usual);
            let list = |given: &Option<Vec<Within<PriorSd>>>, usual: &[f64]| -> Vec<f64> {
                given.as_ref().map_or_else(|| usual.to_vec(), |of| of.iter().map(|sd| sd.get()).collect())
            };
            // what is usual is that of the range from −20 to 60 °C: a polynomial over a smaller one bends less
            let over_range = |usual: &[f64], first: usize| -> Vec<f64> {
                let power = |k: usize| half_range_share.powi((first + k) as i32);
                usual.iter().enumerate().map(|(k, sd)| sd * power(k)).collect()
            };
            let spread = list(&section.spread, &over_range(of.spread, 1));
            let beyond_sd = list(&section.beyond_sd, &over_range(of.beyond_sd, 1 + spread.len()));
            let orders = [spread, beyond_sd].concat();
            Channel {
                name: of.name.to_owned(),
                unit: of.unit,
                spread: std::iter::once(None).chain(orders.into_iter().map(Some)).collect(),
                hysteresis_sd: list(&section.hysteresis_sd, of.hysteresis_sd),
                lag_sd: list(&section.lag_sd, of.lag_sd),
                lag_scatter: section.lag_scatter.map_or(LAG_SCATTER, f64::from),
                soak_sd: section.soak_sd.map_or(of.soak_sd, f64::from),
                block_sd: section.block_sd.map_or_else(|| block_sd(of, experiment, hold_s), f64::from),
                goal_sd: self.goal(of),
            }
        };
        Ok(Campaign {
            channels: self.channels().into_iter().filter(|(of, _)| there(of)).map(channel).collect(),
            range_c: [low, high],
            budget_min: self.budget_min.get(),
            ramp_k_per_min: self.ramp_k_per_min.get(),
            time_constant_min: self.time_constant_min.map_or(10.0, f64::from),
            block_min: FACES * (hold_s + self.move_s.map_or(5.0, f64::from)) / 60.0,
            directions: match self.directions {
                Some(CampaignDirections::Up) => vec![Direction::Up],
                Some(CampaignDirections::Both) | None => vec![Direction::Up, Direction::Down],
            },
            cycles: self.cycles.map_or(1, Count::size),
            spacing_c: self.spacing_c(),
            shortest_wait_min: self.shortest_wait_min.map_or(0.0, f64::from),
            criterion: match (self.criterion, self.at_c) {
                (_, Some(at_c)) => CampaignCriterion::C(at_c.get()),
                (Some(CampaignLetter::D), _) => CampaignCriterion::D,
                _ => CampaignCriterion::I,
            },
        })
    }
}

/// Standard deviation from a block of six faces: where the noise is stated, two holds tell a bias and a gain. Otherwise that of usual sensors.
fn block_sd(of: &Usual, experiment: &Experiment, hold_s: f64) -> f64 {
    let usual = of.block_sd * (USUAL_HOLD_S / hold_s).sqrt();
    let Plan::Holds(holds) = &experiment.plan else { return usual };
    let samples = (hold_s * holds.rate_hz).max(1.0);
    let of_accelerometer = experiment.sensor.noise_mps2.map(|noise| {
        (noise.amax() / samples.sqrt()).hypot(holds.between_holds_sd_mps2) / std::f64::consts::SQRT_2
    });
    let of_gyroscope = experiment.imu.as_ref().and_then(|imu| imu.gyroscope.noise);
    let stated = match of.name {
        "accelerometer.bias" => of_accelerometer,
        "accelerometer.scale" => of_accelerometer.map(|sd| sd / Gravity::SOMEWHERE.magnitude_mps2),
        "gyroscope.bias" => of_gyroscope.map(|noise| noise.amax() / (FACES * samples).sqrt()),
        _ => None,
    };
    stated.unwrap_or(usual)
}

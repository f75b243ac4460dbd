//! Makes the campaign over temperature that an experiment file describes.

use super::campaign::{CampaignDirections, CampaignLetter, CampaignSection, ChannelSection, USUAL, Usual};
use super::campaign_block::{CampaignBlock, CampaignPoses};
use super::campaign_cycles::Cycles;
use super::number::Within;
use super::ranges::PriorSd;
use super::{Experiment, Plan};
use calibrant_campaign::fit::CampaignModel;
use calibrant_campaign::{Campaign, CampaignCriterion, Channel, Direction};
use calibrant_core::error::Result;
use calibrant_core::estimate::{KnownTerm, ThermalModel, ThermometerLag};
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::{ImuQuantity, ReadingUnit, SensorKind, SensorModel, ThermalPart, ThermalTerm};
use nalgebra::Vector3;
use std::ops::RangeInclusive;

/// The range of what is usual, K.
const USUAL_RANGE_K: f64 = 80.0;
/// The faces of [`Usual::block_sd`].
const FACES: f64 = 6.0;
/// Their [`CampaignBlock::sds`], of bias and of gain: each axis has two holds.
const OF_FACES: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Where biases and gains are given, where the experiment does not say, °C.
const REFERENCE_C: f64 = 25.0;
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

    /// `[campaign]` itself.
    #[must_use]
    pub fn campaign_section(&self) -> Option<&CampaignSection> {
        self.campaign.as_ref()
    }

    /// What is fitted to the soaks of the campaign: its quantities each with the order of `[temperature]`, or as many as its `spread` has numbers.
    ///
    /// # Errors
    /// As [`campaign`](Self::campaign).
    pub fn campaign_model(&self) -> Result<Option<CampaignModel>> {
        let Some((section, campaign)) = self.campaign.as_ref().zip(self.campaign()?) else { return Ok(None) };
        let [low, high] = campaign.range_c;
        let order = |((of, channel), stated): ((&Usual, Option<&ChannelSection>), Option<usize>)| {
            let spread =
                channel.and_then(|channel| channel.spread.as_ref()).map_or(of.spread.len(), Vec::len);
            stated.unwrap_or(spread)
        };
        let there =
            section.channels().into_iter().zip(section.temperature.orders()).take(campaign.channels.len());
        let stated_c = section.temperature.reference_c.map(f64::from);
        let reference_c = stated_c.unwrap_or(REFERENCE_C.clamp(low, high));
        let orders = there.map(order).collect();
        Ok(Some(CampaignModel { orders, reference_c, campaign, one_recording: false }))
    }

    /// What is fitted to a recording in one pose whose temperature goes over this range, at this rate at most: the biases, with the orders of `[temperature]`. `None`
    /// where no bias follows temperature.
    #[must_use]
    pub fn one_pose_model(&self, [low, high]: [f64; 2], ramp_k_per_min: f64) -> Option<CampaignModel> {
        let imu = self.imu.as_ref()?;
        let orders = [imu.thermal.accelerometer_bias, imu.thermal.gyroscope_bias];
        let half_range_share = (high - low) / USUAL_RANGE_K;
        let biases = USUAL.iter().filter(|of| of.name.ends_with(".bias"));
        let sections = [
            self.campaign.as_ref().and_then(|campaign| campaign.accelerometer_bias.as_ref()),
            self.campaign.as_ref().and_then(|campaign| campaign.gyroscope_bias.as_ref()),
        ];
        let channels = biases.zip(sections).map(|(of, section)| channel_of(of, section, half_range_share));
        let campaign = Campaign {
            channels: channels.collect(),
            range_c: [low, high],
            budget_min: 0.0,
            ramp_k_per_min,
            time_constant_min: 10.0,
            block_min: 1.0,
            directions: vec![Direction::Up, Direction::Down],
            cycles: 1,
            spacing_c: 5.0_f64.min(0.1 * (high - low)),
            shortest_wait_min: 0.0,
            criterion: CampaignCriterion::I,
            recorded: Vec::new(),
        };
        let reference_c = imu.thermal.reference_c.unwrap_or(REFERENCE_C.clamp(low, high));
        orders.iter().any(|order| *order > 0).then(|| CampaignModel {
            campaign,
            orders: orders.to_vec(),
            one_recording: true,
            reference_c,
        })
    }

    /// The experiment of one soak: what its own small change of temperature does is a parabola of the biases and a line of the gains, with the
    /// spread of sensors as prior, about the mean over its holds.
    ///
    /// # Errors
    /// As [`campaign`](Self::campaign).
    pub fn of_one_soak(&self) -> Result<Self> {
        let mut soak = self.clone();
        let (Some(campaign), Some(imu)) = (self.campaign()?, soak.imu.as_mut()) else { return Ok(soak) };
        imu.thermal = ThermalModel {
            reference_c: None,
            accelerometer_bias: 2,
            accelerometer_scale: 1,
            gyroscope_bias: 2,
            gyroscope_scale: 1,
        };
        // the campaign itself finds a lag
        imu.thermometer = ThermometerLag { lag_s: 0.0, sd_s: 0.0 };
        let counts = [(&self.sensor.unit, self.sensor.gain), (&imu.gyroscope.unit, imu.gyroscope.gain)];
        let gains = counts
            .map(|(unit, gain)| if *unit == ReadingUnit::Counts { gain } else { Some(Vector3::repeat(1.0)) });
        for (sensor_kind, gain) in SensorKind::ALL.into_iter().zip(gains) {
            let of_order = |part: &str, order: usize| {
                let name = format!("{sensor_kind}.{part}");
                let channel = campaign.channels.iter().find(|channel| channel.name == name);
                channel.map_or(0.0, |channel| campaign.power_sd(channel, order))
            };
            for quantity in ImuQuantity::thermal_list(sensor_kind, 2, 1) {
                let sd = match quantity {
                    ImuQuantity::Thermal(_, ThermalTerm { part: ThermalPart::Bias, axis, order }) => {
                        gain.map(|gain| of_order("bias", order) * gain[axis.index()].abs())
                    }
                    _ => Some(of_order("scale", 1)),
                };
                // of counts whose gain nobody knows, none
                let sd = sd.filter(|sd| *sd > 0.0);
                if imu.known.iter().all(|known| known.quantity != quantity) {
                    imu.usual.push(KnownTerm { quantity, value: 0.0, sd });
                }
            }
        }
        soak.stated_as_read();
        Ok(soak)
    }
}

impl CampaignSection {
    /// A block of holds.
    ///
    /// # Errors
    /// As [`CampaignPoses::block`].
    pub fn block(&self, model: SensorModel) -> Result<CampaignBlock> {
        self.poses.as_ref().unwrap_or(&CampaignPoses::Faces).block(model)
    }

    /// The numbers of cycles to try.
    #[must_use]
    pub fn cycles(&self) -> RangeInclusive<usize> {
        match self.cycles {
            None => 1..=1,
            Some(Cycles::Count(count)) => count.size()..=count.size(),
            Some(Cycles::Best) => 1..=3,
        }
    }

    /// Duration of a hold, s.
    #[must_use]
    pub fn hold_s(&self) -> f64 {
        self.hold_s.map_or(USUAL_HOLD_S, f64::from)
    }

    /// Duration of the move to the next hold, s.
    #[must_use]
    pub fn move_s(&self) -> f64 {
        self.move_s.map_or(5.0, f64::from)
    }

    fn problem(&self, experiment: &Experiment) -> Result<Campaign> {
        let hold_s = self.hold_s();
        let block = self.block(experiment.sensor.model)?;
        let [low, high] = self.range_c()?;
        let half_range_share = (high - low) / USUAL_RANGE_K;
        let there = |of: &Usual| of.sensor_kind == SensorKind::Accelerometer || experiment.imu.is_some();
        let channel = |(of, section): (&Usual, Option<&ChannelSection>)| Channel {
            block_sd: section
                .and_then(|section| section.block_sd)
                .map_or_else(|| block_sd(of, experiment, hold_s, &block), f64::from),
            goal_sd: self.goal(of),
            ..channel_of(of, section, half_range_share)
        };
        Ok(Campaign {
            channels: self.channels().into_iter().filter(|(of, _)| there(of)).map(channel).collect(),
            range_c: [low, high],
            budget_min: self.budget_min.get(),
            ramp_k_per_min: self.ramp_k_per_min.get(),
            time_constant_min: self.time_constant_min.map_or(10.0, f64::from),
            block_min: block.directions.len() as f64 * (hold_s + self.move_s()) / 60.0,
            directions: match self.directions {
                Some(CampaignDirections::Up) => vec![Direction::Up],
                Some(CampaignDirections::Both) | None => vec![Direction::Up, Direction::Down],
            },
            cycles: *self.cycles().start(),
            spacing_c: self.spacing_c(),
            shortest_wait_min: self.shortest_wait_min.map_or(0.0, f64::from),
            criterion: match (self.criterion, self.at_c) {
                (_, Some(at_c)) => CampaignCriterion::C(at_c.get()),
                (Some(CampaignLetter::D), _) => CampaignCriterion::D,
                _ => CampaignCriterion::I,
            },
            recorded: Vec::new(),
        })
    }
}

/// Standard deviation from a block: where the noise is stated, that of its holds. Otherwise that of usual sensors.
fn block_sd(of: &Usual, experiment: &Experiment, hold_s: f64, block: &CampaignBlock) -> f64 {
    let ([bias, gain], holds) = (block.sds, block.directions.len() as f64);
    let beside_faces = match of.name {
        "accelerometer.bias" => bias / OF_FACES,
        "accelerometer.scale" => gain / OF_FACES,
        _ => (FACES / holds).sqrt(),
    };
    let usual = of.block_sd * (USUAL_HOLD_S / hold_s).sqrt() * beside_faces;
    let Plan::Holds(plan) = &experiment.plan else { return usual };
    let samples = (hold_s * plan.rate_hz).max(1.0);
    let of_accelerometer = experiment
        .sensor
        .noise_mps2
        .map(|noise| (noise.amax() / samples.sqrt()).hypot(plan.between_holds_sd_mps2));
    let of_gyroscope = experiment.imu.as_ref().and_then(|imu| imu.gyroscope.noise);
    let stated = match of.name {
        "accelerometer.bias" => of_accelerometer.map(|sd| sd * bias),
        "accelerometer.scale" => of_accelerometer.map(|sd| sd * gain / Gravity::SOMEWHERE.magnitude_mps2),
        "gyroscope.bias" => of_gyroscope.map(|noise| noise.amax() / (holds * samples).sqrt()),
        _ => None,
    };
    stated.unwrap_or(usual)
}

/// What is known of a quantity, but for a block and the goal. What is usual is that of the range from −20 to 60 °C: a polynomial over a smaller one bends less.
fn channel_of(of: &Usual, section: Option<&ChannelSection>, half_range_share: f64) -> Channel {
    let usual = ChannelSection::default();
    let section = section.unwrap_or(&usual);
    let list = |given: &Option<Vec<Within<PriorSd>>>, usual: &[f64]| -> Vec<f64> {
        given.as_ref().map_or_else(|| usual.to_vec(), |of| of.iter().map(|sd| sd.get()).collect())
    };
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
        block_sd: of.block_sd,
        goal_sd: of.goal_sd,
    }
}

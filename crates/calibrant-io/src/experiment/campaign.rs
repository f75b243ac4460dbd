//! `[campaign]`: a campaign over temperature, in a chamber or a freezer.

use super::number::{Count, Within};
use super::ranges::{
    BlockSd, Celsius, Duration, HoldSd, LagScatter, Minutes, PriorSd, Ramp, Spacing, TimeConstant, Wait,
};
use super::refused_key::{missing, refused};
use super::{Experiment, Plan};
use calibrant_campaign::{Campaign, CampaignCriterion, Channel, Direction};
use calibrant_core::error::Result;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::SensorKind;
use serde::{Deserialize, Serialize};

/// In which directions temperatures are reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CampaignDirections {
    /// From below and from above.
    Both,
    /// From below: a heater alone.
    Up,
}

/// What a campaign minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CampaignLetter {
    /// The mean variance over the range, over the goals squared.
    I,
    /// `−ln det` of the information.
    D,
    /// The variance at one temperature; written `c`.
    #[serde(rename = "c")]
    C,
}

/// One number for each quantity that follows temperature.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalsSection {
    /// Of the accelerometer's bias, m/s².
    #[serde(rename = "accelerometer.bias")]
    pub accelerometer_bias: Option<Within<PriorSd>>,
    /// Of its gains, relative.
    #[serde(rename = "accelerometer.scale")]
    pub accelerometer_scale: Option<Within<PriorSd>>,
    /// Of the gyroscope's bias, rad/s.
    #[serde(rename = "gyroscope.bias")]
    pub gyroscope_bias: Option<Within<PriorSd>>,
    /// Of its gains, relative.
    #[serde(rename = "gyroscope.scale")]
    pub gyroscope_scale: Option<Within<PriorSd>>,
}

/// What is known beforehand of a quantity that follows temperature; what is not there is that of consumer MEMS sensors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelSection {
    /// Standard deviations over sensors of the type of the coefficients from order 1 on.
    pub spread: Option<Vec<Within<PriorSd>>>,
    /// Those of the coefficients above the order that is reported.
    pub beyond_sd: Option<Vec<Within<PriorSd>>>,
    /// Standard deviation from one block of holds.
    pub block_sd: Option<Within<BlockSd>>,
    /// Standard deviation of what does not average within a soak.
    pub soak_sd: Option<Within<HoldSd>>,
    /// Standard deviations of half the difference of the branches.
    pub hysteresis_sd: Option<Vec<Within<PriorSd>>>,
    /// Standard deviations of the error at the end of a ramp.
    pub lag_sd: Option<Vec<Within<PriorSd>>>,
    /// Share of that error that differs from soak to soak.
    pub lag_scatter: Option<Within<LagScatter>>,
}

/// `[campaign]`: chamber, time, and what is known of the sensor beforehand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CampaignSection {
    /// The temperatures of use.
    pub range_c: Vec<Within<Celsius>>,
    /// Time of the whole campaign.
    pub budget_min: Within<Minutes>,
    /// Rate of the chamber.
    pub ramp_k_per_min: Within<Ramp>,
    /// Time constant between chamber and sense element; 10 min without it.
    pub time_constant_min: Option<Within<TimeConstant>>,
    /// Duration of a hold; 10 s without it.
    pub hold_s: Option<Within<Duration>>,
    /// Duration of the move to the next hold; 5 s without it.
    pub move_s: Option<Within<Duration>>,
    /// Soaks of one pass are at least this far apart; 5 K without it.
    pub spacing_c: Option<Within<Spacing>>,
    /// Closed cycles over the range; 1 without it.
    pub cycles: Option<Count<1, 3>>,
    /// Directions in which temperatures are reached; both without it.
    pub directions: Option<CampaignDirections>,
    /// The shortest wait; 0 without it.
    pub shortest_wait_min: Option<Within<Wait>>,
    /// What is minimised; I without it.
    pub criterion: Option<CampaignLetter>,
    /// The temperature of criterion c.
    pub at_c: Option<Within<Celsius>>,
    /// The wanted standard deviations, on average over the range.
    pub goals: Option<GoalsSection>,
    /// The accelerometer's bias, m/s².
    #[serde(rename = "accelerometer.bias")]
    pub accelerometer_bias: Option<ChannelSection>,
    /// Its gains, relative.
    #[serde(rename = "accelerometer.scale")]
    pub accelerometer_scale: Option<ChannelSection>,
    /// The gyroscope's bias, rad/s.
    #[serde(rename = "gyroscope.bias")]
    pub gyroscope_bias: Option<ChannelSection>,
    /// Its gains, relative.
    #[serde(rename = "gyroscope.scale")]
    pub gyroscope_scale: Option<ChannelSection>,
}

/// What consumer MEMS sensors do: spread of the coefficients over 32 published calibrations of autopilots' IMUs.
struct Usual {
    name: &'static str,
    unit: &'static str,
    sensor_kind: SensorKind,
    spread: &'static [f64],
    beyond_sd: &'static [f64],
    hysteresis_sd: &'static [f64],
    lag_sd: &'static [f64],
    soak_sd: f64,
    /// Of a block of six faces of 10 s.
    block_sd: f64,
    goal_sd: f64,
}

const USUAL: [Usual; 4] = [
    Usual {
        name: "accelerometer.bias",
        unit: "m/s²",
        sensor_kind: SensorKind::Accelerometer,
        spread: &[0.07, 0.03, 0.02],
        beyond_sd: &[0.008, 0.004],
        hysteresis_sd: &[4e-3, 2e-3],
        lag_sd: &[1.5e-2, 5e-3],
        soak_sd: 1.5e-3,
        block_sd: 7e-4,
        goal_sd: 2e-3,
    },
    Usual {
        name: "accelerometer.scale",
        unit: "1",
        sensor_kind: SensorKind::Accelerometer,
        spread: &[8e-3, 1e-3],
        beyond_sd: &[5e-4],
        hysteresis_sd: &[2e-4],
        lag_sd: &[5e-4],
        soak_sd: 1e-4,
        block_sd: 7e-5,
        goal_sd: 2e-4,
    },
    Usual {
        name: "gyroscope.bias",
        unit: "rad/s",
        sensor_kind: SensorKind::Gyroscope,
        spread: &[6e-3, 2e-3, 1.5e-3],
        beyond_sd: &[6e-4, 3e-4],
        hysteresis_sd: &[3e-4, 1e-4],
        lag_sd: &[1e-3, 3e-4],
        soak_sd: 1e-4,
        block_sd: 3e-5,
        goal_sd: 2e-4,
    },
    Usual {
        name: "gyroscope.scale",
        unit: "1",
        sensor_kind: SensorKind::Gyroscope,
        spread: &[8e-3, 1e-3],
        beyond_sd: &[5e-4],
        hysteresis_sd: &[],
        lag_sd: &[5e-4],
        soak_sd: 2e-4,
        block_sd: 2e-4,
        goal_sd: 5e-4,
    },
];

/// Holds of a block: six faces.
const FACES: f64 = 6.0;
/// The holds of [`Usual::block_sd`], s.
const USUAL_HOLD_S: f64 = 10.0;
/// The share of the lag's error that differs from soak to soak, where nothing is known.
const LAG_SCATTER: f64 = 0.2;
/// Highest order of a polynomial.
const HIGHEST_ORDER: usize = 5;
/// Most terms of hysteresis or lag.
const MOST_TERMS: usize = 2;

impl Experiment {
    /// The campaign over temperature that `[campaign]` describes, where it is there.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) with the key, where values contradict each other.
    pub fn campaign(&self) -> Result<Option<Campaign>> {
        self.campaign.as_ref().map(|section| section.campaign(self)).transpose()
    }
}

impl CampaignSection {
    /// Checks what no type says.
    pub(super) fn check(&self, plan: &Plan) -> Result<()> {
        if !matches!(plan, Plan::Holds(_)) {
            let help = "a campaign calibrates at each temperature from holds: see `calibrant init campaign`";
            return Err(refused("campaign", "a campaign needs [holds]", help));
        }
        let [low, high] = self.range_c()?;
        let spacing_c = self.spacing_c();
        if spacing_c > high - low {
            let message = format!("spacing_c is {spacing_c} K, and the range {} K", high - low);
            return Err(refused("campaign.spacing_c", message, "give a smaller spacing"));
        }
        if (self.criterion == Some(CampaignLetter::C)) != self.at_c.is_some() {
            return Err(match self.at_c {
                Some(_) => {
                    refused("campaign.at_c", "at_c is of criterion c", "criterion = \"c\", or leave it away")
                }
                None => missing("campaign.at_c", "the temperature of criterion c, °C: at_c = 25.0"),
            });
        }
        for (of, section) in self.channels() {
            let Some(section) = section else { continue };
            let key = |part: &str| format!("campaign.{}.{part}", of.name);
            let count = |of: &Option<Vec<_>>, usual: &[f64]| of.as_ref().map_or(usual.len(), Vec::len);
            let orders = count(&section.spread, of.spread) + count(&section.beyond_sd, of.beyond_sd);
            if !(1..=HIGHEST_ORDER).contains(&orders) {
                let message =
                    format!("spread and beyond_sd have {orders} numbers together, one for each order");
                return Err(refused(key("spread"), message, "give 1 to 5 in all: orders 1 to 5"));
            }
            for (part, list) in [("hysteresis_sd", &section.hysteresis_sd), ("lag_sd", &section.lag_sd)] {
                if list.as_ref().is_some_and(|list| list.len() > MOST_TERMS) {
                    return Err(refused(key(part), "there are more than two numbers", "give up to two"));
                }
            }
        }
        Ok(())
    }

    fn range_c(&self) -> Result<[f64; 2]> {
        match self.range_c.as_slice() {
            [low, high] if low.get() < high.get() => Ok([low.get(), high.get()]),
            _ => Err(refused(
                "campaign.range_c",
                "the range is not two temperatures, the lower first",
                "range_c = [-20.0, 60.0]",
            )),
        }
    }

    fn spacing_c(&self) -> f64 {
        self.spacing_c.map_or(5.0, f64::from)
    }

    fn channels(&self) -> [(&'static Usual, Option<&ChannelSection>); 4] {
        let [ab, ak, gb, gk] = &USUAL;
        [
            (ab, self.accelerometer_bias.as_ref()),
            (ak, self.accelerometer_scale.as_ref()),
            (gb, self.gyroscope_bias.as_ref()),
            (gk, self.gyroscope_scale.as_ref()),
        ]
    }

    fn goal(&self, of: &Usual) -> f64 {
        let goals = self.goals.clone().unwrap_or_default();
        let given = match of.name {
            "accelerometer.bias" => goals.accelerometer_bias,
            "accelerometer.scale" => goals.accelerometer_scale,
            "gyroscope.bias" => goals.gyroscope_bias,
            _ => goals.gyroscope_scale,
        };
        given.map_or(of.goal_sd, f64::from)
    }

    fn campaign(&self, experiment: &Experiment) -> Result<Campaign> {
        let hold_s = self.hold_s.map_or(USUAL_HOLD_S, f64::from);
        let there = |of: &Usual| of.sensor_kind == SensorKind::Accelerometer || experiment.imu.is_some();
        let channel = |(of, section): (&Usual, Option<&ChannelSection>)| {
            let usual = ChannelSection::default();
            let section = section.unwrap_or(&usual);
            let list = |given: &Option<Vec<Within<PriorSd>>>, usual: &[f64]| -> Vec<f64> {
                given.as_ref().map_or_else(|| usual.to_vec(), |of| of.iter().map(|sd| sd.get()).collect())
            };
            let orders = [list(&section.spread, of.spread), list(&section.beyond_sd, of.beyond_sd)].concat();
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
            range_c: self.range_c()?,
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
                (Some(CampaignLetter::C), Some(at_c)) => CampaignCriterion::C(at_c.get()),
                (Some(CampaignLetter::D), _) => CampaignCriterion::D,
                _ => CampaignCriterion::I,
            },
            earlier: Vec::new(),
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

//! Rehearsal of campaigns: sensors drawn from the priors, their soaks as calibrations would give them, and one fit of each campaign beside the truth.

use crate::fit::{CampaignModel, SoakCalibration, fit};
use crate::{Campaign, Channel, Soak};
use calibrant_core::diagnostic::Severity;
use calibrant_core::error::Result;
use calibrant_core::estimate::{SoakTemperature, f_p_value};
use calibrant_core::sensor::{CalibratedImu, ImuParameters, ImuQuantity, PerSensor, ReadingUnit, SensorKind};
use calibrant_core::simulate::{Purpose, Rng, normal, stream};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// What campaigns would have shown of many sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct CampaignRehearsal {
    /// Number of sensors.
    pub sensors: usize,
    /// The campaigns.
    pub campaigns: Vec<RehearsedCampaign>,
}

/// A campaign, and what it would have shown.
#[derive(Debug, Clone, PartialEq)]
pub struct RehearsedCampaign {
    /// Its name.
    pub name: String,
    /// Number of its soaks.
    pub soaks: usize,
    /// The channels.
    pub channels: Vec<RehearsedChannel>,
    /// How many of the sensors had a warning of each code.
    pub warnings: BTreeMap<&'static str, usize>,
}

/// The errors of a channel over the range, the axes and the sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct RehearsedChannel {
    /// Its name.
    pub name: String,
    /// Unit of what follows.
    pub unit: &'static str,
    /// Root mean square error.
    pub rms: f64,
    /// Root of the mean stated variance.
    pub stated_sd: f64,
    /// The share of 95 % intervals that hold the truth.
    pub coverage: f64,
    /// Degrees of freedom of Student's t of these intervals, mean over the sensors: those of the scatter between soaks. `None` where too few soaks find it, so that
    /// they are of the normal distribution.
    pub degrees: Option<f64>,
}

/// Level of the intervals.
const LEVEL: f64 = 0.95;
/// Temperatures at which truth and estimate are compared.
const PLACES: usize = 17;
/// A coefficient of which nothing is known is drawn with so many times the next one.
const UNKNOWN: f64 = 10.0;

/// Draws sensors, and fits each campaign to what it would have measured of them. `done` is told how many sensors are finished.
///
/// # Errors
/// As [`fit`], where a campaign leaves coefficients open.
pub fn rehearse(
    model: &CampaignModel,
    campaigns: &[(String, Vec<Soak>)],
    sensors: usize,
    seed: u64,
    done: impl Fn(usize),
) -> Result<CampaignRehearsal> {
    let of = |(name, soaks): &(String, Vec<Soak>)| RehearsedCampaign {
        name: name.clone(),
        soaks: soaks.len(),
        channels: model.campaign.channels.iter().map(RehearsedChannel::of).collect(),
        warnings: BTreeMap::new(),
    };
    let mut rehearsed: Vec<RehearsedCampaign> = campaigns.iter().map(of).collect();
    for sensor in 0..sensors {
        let truth = draw(&model.campaign, &mut stream(seed, Purpose::Sensor, sensor as u64));
        for ((_, soaks), rehearsed) in campaigns.iter().zip(&mut rehearsed) {
            let mut rng = stream(seed, Purpose::Recording, sensor as u64);
            let fitted = fit(model, &measure(&model.campaign, soaks, &truth, &mut rng))?;
            let warnings = fitted.warnings.iter().filter(|found| found.severity() >= Severity::Warning);
            for code in warnings.map(|found| found.code().name()) {
                *rehearsed.warnings.entry(code).or_default() += 1;
            }
            for ((fitted, truth), channel) in fitted.channels.iter().zip(&truth).zip(&mut rehearsed.channels)
            {
                let degrees = fitted.scatter.found.then_some(fitted.scatter.degrees);
                channel.degrees = degrees.map(|of| channel.degrees.unwrap_or(0.0) + of / sensors as f64);
                for (axis, truth) in truth.iter().enumerate() {
                    for place in 0..PLACES {
                        let x = -1.0 + 2.0 * place as f64 / (PLACES - 1) as f64;
                        let ((value, sd), mean) = (fitted.at(axis, x), fitted.relative_to[axis]);
                        let found =
                            if channel.name.ends_with(".bias") { value } else { mean * (1.0 + value) - 1.0 };
                        channel.add(found - fitted.channel.polynomial_row(x).dot(truth), mean * sd, degrees);
                    }
                }
            }
        }
        done(sensor + 1);
    }
    for rehearsed in &mut rehearsed {
        rehearsed.channels.iter_mut().for_each(|channel| channel.finish((sensors * 3 * PLACES) as f64));
    }
    Ok(CampaignRehearsal { sensors, campaigns: rehearsed })
}

impl RehearsedChannel {
    fn of(channel: &Channel) -> Self {
        let (name, unit) = (channel.name.clone(), channel.unit);
        Self { name, unit, rms: 0.0, stated_sd: 0.0, coverage: 0.0, degrees: None }
    }

    fn add(&mut self, error: f64, sd: f64, degrees: Option<f64>) {
        self.rms += error * error;
        self.stated_sd += sd * sd;
        // with one component it is the two-sided Student's t
        let p_value = f_p_value((error / sd).powi(2), 1, degrees.unwrap_or(f64::INFINITY));
        self.coverage += f64::from(u8::from(p_value.is_some_and(|p| p > 1.0 - LEVEL)));
    }

    fn finish(&mut self, count: f64) {
        self.rms = (self.rms / count).sqrt();
        self.stated_sd = (self.stated_sd / count).sqrt();
        self.coverage /= count;
    }
}

/// A sensor drawn from the priors: coefficients of each channel and axis. The gains are relative to their mean over the soaks, so that their first is small.
pub(crate) fn draw(campaign: &Campaign, rng: &mut Rng) -> Vec<Vec<DVector<f64>>> {
    let of_axis = |channel: &Channel, rng: &mut Rng| {
        let next = channel.spread.get(1).copied().flatten().unwrap_or(0.0);
        let unknown = if channel.name.ends_with(".bias") { UNKNOWN * next } else { next };
        let of_polynomial = channel.spread.iter().map(|sd| sd.unwrap_or(unknown));
        let sds = of_polynomial.chain(channel.hysteresis_sd.clone()).chain(channel.lag_sd.clone());
        DVector::from_iterator(channel.coefficients(), sds.map(|sd| sd * normal(rng)))
    };
    campaign.channels.iter().map(|channel| (0..3).map(|_| of_axis(channel, rng)).collect()).collect()
}

/// Calibrations of the soaks of a sensor, as their blocks of holds give them.
pub(crate) fn measure(
    campaign: &Campaign,
    soaks: &[Soak],
    truth: &[Vec<DVector<f64>>],
    rng: &mut Rng,
) -> Vec<SoakCalibration> {
    let quantities: Vec<ImuQuantity> = campaign.channels.iter().flat_map(Channel::parameters).collect();
    let of_kind =
        |kind: SensorKind| quantities.iter().any(|of| of.sensor_kind() == kind).then(|| kind.stimulus_unit());
    let units: PerSensor<Option<ReadingUnit>> = PerSensor::from_fn(of_kind);
    let soak = |(number, soak): (usize, &Soak)| {
        let (x, left) = (campaign.x(soak.temperature_c), campaign.lag_left(soak.wait_min));
        let mut imu = ImuParameters::identity();
        let mut covariance = DMatrix::zeros(quantities.len(), quantities.len());
        let of_axes = campaign
            .channels
            .iter()
            .zip(truth)
            .flat_map(|(channel, axes)| axes.iter().map(move |c| (channel, c)));
        for (place, (channel, c)) in of_axes.enumerate() {
            let row = channel.row(x, soak.direction.sign(), left);
            let value = row.dot(c) + channel.variance(soak.blocks, left).sqrt() * normal(rng);
            quantities[place].add_to(&mut imu, value);
            covariance[(place, place)] = channel.block_sd.powi(2) / soak.blocks as f64;
        }
        let calibrated = CalibratedImu::new(imu, units, quantities.clone(), "");
        SoakCalibration {
            name: format!("soak_{:02}", number + 1),
            imu: CalibratedImu { covariance: Some(covariance), ..calibrated },
            temperature: SoakTemperature {
                mean_c: soak.temperature_c,
                rate_k_per_min: soak.direction.sign() * left * campaign.ramp_k_per_min,
                range_c: [soak.temperature_c; 2],
            },
            prior: Vec::new(),
        }
    };
    soaks.iter().enumerate().map(soak).collect()
}

//! Simulates a campaign over temperature: one sensor drawn from the priors, and a recording of each soak.

use super::gains::gains;
use super::imu::in_gauge;
use super::noise::one_for_all;
use super::random::Random;
use calibrant_campaign::{Campaign, Channel, Soak};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::ImuSetup;
use calibrant_core::sensor::legendre::powers_of_legendre;
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, Quantity, SensorKind, ThermalPart, ThermalTerm,
};
use calibrant_core::simulate::{
    GyroscopeToDraw, ImuSimulation, Purpose, Rng, draw_imu, normal, simulate_imu, stream,
};
use calibrant_io::{Experiment, Plan, Truth, write_imu_recording, write_json};
use nalgebra::{DVector, Vector3};
use std::path::Path;

/// A simulated campaign.
#[derive(Debug, Clone)]
pub struct SimulatedCampaign {
    /// The seed of its sensor.
    pub seed: u64,
    /// A recording of each soak, in their order.
    pub soaks: Vec<ImuRecording>,
    /// The mean of both branches.
    pub truth: Truth,
}

/// What follows temperature in one axis of a channel.
struct DrawnAxis<'a> {
    channel: &'a Channel,
    quantity: ImuQuantity,
    coefficients: DVector<f64>,
    /// What a value of the channel is in the parameter.
    unit: f64,
}

/// Draws a sensor from the spread of the datasheet and the priors of `[campaign]`, and simulates a recording of each soak. Its temperature changes at the rate that
/// is left of the ramp.
///
/// # Errors
/// [`Error::Experiment`] where the experiment has no `[campaign]`.
pub fn simulate_campaign(
    experiment: &Experiment,
    soaks: &[Soak],
    seed: Option<u64>,
) -> Result<SimulatedCampaign> {
    let missing = |message: &str, help: &str| {
        Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help))
    };
    let model = experiment.campaign_model()?;
    let (Some(model), Some(section)) = (model, experiment.campaign_section()) else {
        return Err(missing("the experiment has no [campaign]", "see `calibrant init campaign`"));
    };
    let Plan::Holds(holds) = &experiment.plan else {
        return Err(missing("a campaign needs [holds]", "see `calibrant init campaign`"));
    };
    // an accelerometer alone is that of an IMU whose perfect gyroscope nobody records
    let is_imu = experiment.imu.is_some();
    let gyroscope = experiment.imu.as_ref().map(|plan| plan.gyroscope.clone()).unwrap_or_default();
    let campaign = &model.campaign;
    let random = Random { seed: seed.unwrap_or(experiment.study.seed), recording: 1 };
    let [gain_a, gain_g] = gains(experiment)?;
    let mut rng = random.sensor();
    let to_draw =
        GyroscopeToDraw { model: gyroscope.model, gain: gain_g, g_sensitivity: gyroscope.g_sensitivity };
    let drawn = draw_imu(&experiment.sensor, &to_draw, &mut rng);
    let units = [experiment.sensor.unit, gyroscope.unit];
    let mut truth = in_gauge(&drawn, units, holds.gauge)?;
    if !is_imu {
        truth = ImuParameters::identity().with(SensorKind::Accelerometer, truth[SensorKind::Accelerometer]);
    }
    truth.thermal.reference_c = model.reference_c;
    truth.thermal.range_c = Some(campaign.range_c);
    let axes = draw(campaign, [gain_a, gain_g], &mut rng);
    for axis in &axes {
        add_polynomial(&mut truth, axis, campaign.range_c);
    }
    let usual = ImuSimulation::default();
    let (noise_a, noise_g) = (experiment.sensor.noise(&gain_a), gyroscope.noise);
    let mut notes = Vec::new();
    let setup = ImuSimulation {
        hold_s: section.hold_s(),
        turn_s: section.move_s(),
        rate_hz: holds.rate_hz,
        gravity_mps2: holds.gravity()?.magnitude_mps2,
        accelerometer_noise: one_for_all(
            SensorKind::Accelerometer,
            &noise_a.unwrap_or_else(|| gain_a * usual.accelerometer_noise),
            &mut notes,
        ),
        between_holds_sd_mps2: holds.between_holds_sd_mps2,
        gyroscope_noise: one_for_all(
            SensorKind::Gyroscope,
            &noise_g.unwrap_or_else(|| gain_g * usual.gyroscope_noise),
            &mut notes,
        ),
        accelerometer_unit: units[0],
        gyroscope_unit: units[1],
        ..usual
    };
    let directions = section.block(experiment.sensor.model)?.directions;
    let recordings = soaks.iter().enumerate().map(|(k, soak)| {
        let mut rng = stream(random.seed, Purpose::Recording, 1 + k as u64);
        let at = at_soak(campaign, &truth, &axes, soak, &mut rng);
        // over its holds
        let minutes = soak.blocks as f64 * campaign.block_min;
        let ends = [soak.wait_min, soak.wait_min + minutes].map(|wait_min| campaign.lag_left(wait_min));
        let change_c = soak.direction.sign()
            * campaign.ramp_k_per_min
            * campaign.time_constant_min
            * (ends[0] - ends[1]);
        let temperature_c = Some([-0.5, 0.5].map(|share| soak.temperature_c + share * change_c));
        let directions = Some(directions.repeat(soak.blocks));
        let setup = ImuSimulation { directions, temperature_c, ..setup.clone() };
        let mut recording = simulate_imu(&at, &setup, &mut rng);
        recording[SensorKind::Gyroscope] = recording[SensorKind::Gyroscope].take().filter(|_| is_imu);
        recording
    });
    let soaks = recordings.collect();
    let (holds, directions) = (holds.setup()?, holds.directions());
    let of_soak = ImuSetup { holds, directions, ..ImuSetup::default() };
    let mut quantities = of_soak.quantities(experiment.sensor.model, &gyroscope);
    quantities.retain(|quantity| is_imu || quantity.sensor_kind() == SensorKind::Accelerometer);
    quantities
        .extend(ImuQuantity::all_thermal(true, true).into_iter().filter(|term| term.value(&truth) != 0.0));
    let truth = Truth::of_imu(random.seed, &quantities, units, &truth);
    Ok(SimulatedCampaign { seed: random.seed, soaks, truth })
}

/// Draws the coefficients of each channel and axis from their priors; what is at the reference temperature is drawn already.
fn draw<'a>(campaign: &'a Campaign, gains: [Vector3<f64>; 2], rng: &mut Rng) -> Vec<DrawnAxis<'a>> {
    let mut axes = Vec::new();
    for channel in &campaign.channels {
        for quantity in channel.parameters() {
            let sds = channel.spread.iter().map(|sd| sd.unwrap_or(0.0));
            let sds: Vec<f64> =
                sds.chain(channel.hysteresis_sd.clone()).chain(channel.lag_sd.clone()).collect();
            let coefficients = DVector::from_iterator(sds.len(), sds.into_iter().map(|sd| sd * normal(rng)));
            let unit = match quantity {
                ImuQuantity::Of(kind, Quantity::Bias(axis)) => gains[kind as usize][axis.index()],
                _ => 1.0,
            };
            axes.push(DrawnAxis { channel, quantity, coefficients, unit });
        }
    }
    axes
}

/// Adds the polynomial of an axis as temperature terms; at the reference it is nothing.
fn add_polynomial(truth: &mut ImuParameters, axis: &DrawnAxis<'_>, range_c: [f64; 2]) {
    let count = axis.channel.polynomial();
    let powers =
        powers_of_legendre(range_c, truth.thermal.reference_c, count) * axis.coefficients.rows(0, count);
    let ImuQuantity::Of(kind, of) = axis.quantity else { return };
    let (part, of_axis) = match of {
        Quantity::Bias(of_axis) => (ThermalPart::Bias, of_axis),
        Quantity::Scale(of_axis) => (ThermalPart::Scale, of_axis),
        _ => return,
    };
    for order in 1..count {
        let term = ImuQuantity::Thermal(kind, ThermalTerm { part, axis: of_axis, order });
        term.add_to(truth, axis.unit * powers[order]);
    }
}

/// The sensor in a soak: with its branch, its lag, and what differs from soak to soak.
fn at_soak(
    campaign: &Campaign,
    truth: &ImuParameters,
    axes: &[DrawnAxis<'_>],
    soak: &Soak,
    rng: &mut Rng,
) -> ImuParameters {
    let mut at = *truth;
    let minutes = soak.blocks as f64 * campaign.block_min;
    // the mean over the holds
    let left = campaign.lag_left(soak.wait_min) * campaign.time_constant_min / minutes
        * (1.0 - (-minutes / campaign.time_constant_min).exp());
    for axis in axes {
        let channel = axis.channel;
        let mut row = channel.row(campaign.x(soak.temperature_c), soak.direction.sign(), left);
        row.rows_mut(0, channel.polynomial()).fill(0.0);
        let lag_sd = channel.lag_sd.first().map_or(0.0, |sd| channel.lag_scatter * sd * left);
        let apart = row.dot(&axis.coefficients) + channel.soak_sd.hypot(lag_sd) * normal(rng);
        match axis.quantity {
            ImuQuantity::Of(kind, Quantity::Scale(of_axis)) => {
                let mut gains = at[kind].matrix.row_mut(of_axis.index());
                gains *= 1.0 + apart;
            }
            quantity => quantity.add_to(&mut at, axis.unit * apart),
        }
    }
    at
}

impl SimulatedCampaign {
    /// The names of the recordings: `soak_01.csv`.
    #[must_use]
    pub fn names(count: usize) -> Vec<String> {
        (1..=count).map(|soak| format!("soak_{soak:02}.csv")).collect()
    }

    /// Writes `soak_01.csv` and so on, and `truth.json`.
    ///
    /// # Errors
    /// [`Error::Output`] where a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<()> {
        write_json(&directory.join("truth.json"), &self.truth)?;
        for (name, recording) in Self::names(self.soaks.len()).iter().zip(&self.soaks) {
            write_imu_recording(&directory.join(name), recording)?;
        }
        Ok(())
    }
}

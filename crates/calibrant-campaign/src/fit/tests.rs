//! Tests of the fit against drawn sensors: coverage, the scatter, and what each verdict says of a defect.

use super::*;
use crate::Channel;
use crate::{Campaign, CampaignCriterion, Direction, Soak};
use calibrant_core::estimate::SoakTemperature;
use calibrant_core::sensor::{Axis, ImuParameters, Quantity, ReadingUnit, SensorKind};
use calibrant_core::sensor::{CalibratedImu, ImuQuantity};
use nalgebra::DMatrix;
use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Accelerometer bias and scale of the reference cases.
pub(crate) fn campaign() -> Campaign {
    let channel = |name: &str,
                   unit,
                   spread: &[f64],
                   hysteresis_sd: &[f64],
                   lag_sd: &[f64],
                   soak_sd,
                   block_sd,
                   goal_sd| Channel {
        name: name.to_owned(),
        unit,
        spread: std::iter::once(None).chain(spread.iter().map(|sd| Some(*sd))).collect(),
        hysteresis_sd: hysteresis_sd.to_vec(),
        lag_sd: lag_sd.to_vec(),
        lag_scatter: 0.2,
        soak_sd,
        block_sd,
        goal_sd,
    };
    Campaign {
        channels: vec![
            channel(
                "accelerometer.bias",
                "m/s²",
                &[0.07, 0.03, 0.02, 0.008, 0.004],
                &[4e-3, 2e-3],
                &[1.5e-2, 5e-3],
                1.5e-3,
                7e-4,
                2e-3,
            ),
            channel("accelerometer.scale", "1", &[8e-3, 1e-3, 5e-4], &[2e-4], &[5e-4], 1e-4, 7e-5, 2e-4),
        ],
        range_c: [-20.0, 60.0],
        budget_min: 360.0,
        ramp_k_per_min: 2.0,
        time_constant_min: 10.0,
        block_min: 1.5,
        directions: vec![Direction::Up, Direction::Down],
        cycles: 1,
        spacing_c: 5.0,
        shortest_wait_min: 0.0,
        criterion: CampaignCriterion::I,
        recorded: Vec::new(),
    }
}

fn model() -> CampaignModel {
    CampaignModel { campaign: campaign(), orders: vec![3, 2], reference_c: 25.0 }
}

/// Every 5 K there and back with waits of 0, 5 and 10 min in turn.
fn plan() -> Vec<Soak> {
    let up = (0..=16).map(|k| (f64::from(k) * 5.0 - 20.0, Direction::Up));
    let down = (0..=16).rev().map(|k| (f64::from(k) * 5.0 - 20.0, Direction::Down));
    let soak = |(k, (temperature_c, direction)): (usize, _)| Soak {
        temperature_c,
        direction,
        wait_min: 5.0 * (k % 3) as f64,
        blocks: 1,
    };
    up.chain(down).enumerate().map(soak).collect()
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random_range(f64::MIN_POSITIVE..1.0), rng.random());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A sensor drawn from the priors: coefficients of each channel and axis.
fn sensor(campaign: &Campaign, rng: &mut ChaCha8Rng) -> Vec<Vec<DVector<f64>>> {
    let of_axis = |channel: &Channel, rng: &mut ChaCha8Rng| {
        let first = 10.0 * channel.spread[1].expect("there");
        let sds = channel
            .spread
            .iter()
            .map(|sd| sd.unwrap_or(first))
            .chain(channel.hysteresis_sd.clone())
            .chain(channel.lag_sd.clone());
        DVector::from_iterator(channel.coefficients(), sds.map(|sd| sd * normal(rng)))
    };
    // the mean gain is that of the sensor, about 1
    let mut drawn: Vec<Vec<_>> =
        campaign.channels.iter().map(|channel| (0..3).map(|_| of_axis(channel, rng)).collect()).collect();
    for axis in &mut drawn[1] {
        axis[0] *= 0.05;
    }
    drawn
}

/// Calibrations of the soaks, as six faces give them.
fn soaks(
    campaign: &Campaign,
    plan: &[Soak],
    truth: &[Vec<DVector<f64>>],
    rng: &mut ChaCha8Rng,
) -> Vec<SoakCalibration> {
    let quantities: Vec<ImuQuantity> = [Quantity::Bias as fn(Axis) -> Quantity, Quantity::Scale]
        .into_iter()
        .flat_map(|of| Axis::ALL.map(|axis| ImuQuantity::Of(SensorKind::Accelerometer, of(axis))))
        .collect();
    plan.iter()
        .enumerate()
        .map(|(k, soak)| {
            let (x, left) = (campaign.x(soak.temperature_c), campaign.lag_left(soak.wait_min));
            let mut parameters = ImuParameters::identity();
            let mut covariance = DMatrix::zeros(6, 6);
            for (number, (channel, axes)) in campaign.channels.iter().zip(truth).enumerate() {
                for (axis, c) in axes.iter().enumerate() {
                    let row = channel.row(x, soak.direction.sign(), left);
                    let place = 3 * number + axis;
                    let value = row.dot(c) + channel.variance(soak.blocks, left).sqrt() * normal(rng);
                    quantities[place].add_to(&mut parameters, value);
                    covariance[(place, place)] = channel.block_sd.powi(2) / soak.blocks as f64;
                }
            }
            let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
            let imu = CalibratedImu {
                covariance: Some(covariance),
                ..CalibratedImu::new(parameters, units, quantities.clone(), "")
            };
            let temperature = SoakTemperature {
                mean_c: soak.temperature_c,
                rate_k_per_min: soak.direction.sign() * left * campaign.ramp_k_per_min,
                range_c: [soak.temperature_c; 2],
            };
            SoakCalibration { name: format!("soak_{:02}", k + 1), imu, temperature }
        })
        .collect()
}

/// The codes of warnings about a campaign.
fn codes(fitted: &FittedCampaign) -> Vec<&'static str> {
    let warnings = fitted
        .warnings
        .iter()
        .filter(|found| found.severity() >= calibrant_core::diagnostic::Severity::Warning);
    warnings.map(|found| found.code().name()).collect()
}

#[test]
fn of_100_sensors_the_intervals_hold_and_good_campaigns_pass() {
    let (model, plan) = (model(), plan());
    let (mut inside, mut all, mut errors, mut stated) = (0.0, 0.0, [0.0; 2], [0.0; 2]);
    let mut omegas = Vec::new();
    let mut bad = Vec::new();
    for seed in 0..100 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = sensor(&model.campaign, &mut rng);
        let fitted = fit(&model, &soaks(&model.campaign, &plan, &truth, &mut rng)).expect("fits");
        for celsius in (0..=16).map(|k| -20.0 + 5.0 * f64::from(k)) {
            let at = fitted.imu.at(celsius).expect("positive gains");
            let sigma = at.covariance.as_ref().expect("there");
            for (k, quantity) in at.quantities.iter().enumerate() {
                let (channel, axis) = (k / 3, k % 3);
                let of = &model.campaign.channels[channel];
                let row = of.polynomial_row(model.campaign.x(celsius));
                let expected = row.dot(&truth[channel][axis]) + channel as f64;
                let (error, variance) = (quantity.value(&at.parameters) - expected, sigma[(k, k)]);
                inside += f64::from(u8::from(error.abs() < 1.96 * variance.sqrt()));
                all += 1.0;
                errors[channel] += error * error;
                stated[channel] += variance;
            }
        }
        omegas.push(fitted.channels[0].scatter.soak_sd);
        // hysteresis that is larger than the goal is that of the sensor
        if codes(&fitted).iter().any(|code| *code != "hysteresis-large") {
            bad.push((seed, codes(&fitted)));
        }
    }
    let coverage = inside / all;
    assert!((0.93..0.97).contains(&coverage), "{coverage}");
    for channel in 0..2 {
        let ratio = (errors[channel] / stated[channel]).sqrt();
        assert!((0.9..1.1).contains(&ratio), "{channel}: {ratio}");
    }
    omegas.sort_by(f64::total_cmp);
    assert!((1.3e-3..1.7e-3).contains(&omegas[50]), "{}", omegas[50]);
    assert!(bad.len() <= 2, "{bad:?}");
}

/// A campaign with a defect.
fn with(defect: impl Fn(&mut Vec<SoakCalibration>)) -> Vec<&'static str> {
    let model = model();
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let truth = sensor(&model.campaign, &mut rng);
    let mut soaks = soaks(&model.campaign, &plan(), &truth, &mut rng);
    defect(&mut soaks);
    codes(&fit(&model, &soaks).expect("fits"))
}

#[test]
fn each_defect_is_named() {
    let bias = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(Axis::Y));
    assert!(!with(|_| ()).iter().any(|code| *code != "hysteresis-large"));
    let knocked = with(|soaks| bias.add_to(&mut soaks[11].imu.parameters, 0.012));
    assert!(knocked.contains(&"soak-disagrees"), "{knocked:?}");
    let aged = with(|soaks| {
        let count = soaks.len() as f64;
        for (k, soak) in soaks.iter_mut().enumerate() {
            bias.add_to(&mut soak.imu.parameters, 0.02 * k as f64 / count);
        }
    });
    assert!(aged.contains(&"aged"), "{aged:?}");
    let looped = with(|soaks| {
        let campaign = campaign();
        for soak in soaks {
            let x = campaign.x(soak.temperature.mean_c);
            let up = soak.temperature.rate_k_per_min.signum();
            bias.add_to(&mut soak.imu.parameters, up * 0.02 * (1.0 - x * x));
        }
    });
    assert!(looped.contains(&"hysteresis-large"), "{looped:?}");
    let bent = with(|soaks| {
        for soak in soaks {
            let x = campaign().x(soak.temperature.mean_c);
            bias.add_to(&mut soak.imu.parameters, 0.1 * calibrant_core::sensor::legendre::legendre(x, 5)[4]);
        }
    });
    assert!(bent.contains(&"order-too-low"), "{bent:?}");
    let upwards = with(|soaks| soaks.truncate(17));
    assert!(upwards.contains(&"one-direction"), "{upwards:?}");
}

#[test]
fn soaks_that_are_not_alike_or_too_few_are_refused() {
    let model = model();
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let truth = sensor(&model.campaign, &mut rng);
    let mut soaks = soaks(&model.campaign, &plan(), &truth, &mut rng);
    let few = fit(&model, &soaks[..3]).expect_err("three temperatures, order 3").to_string();
    assert!(
        few.contains("accelerometer.bias of order 3")
            && few.contains("lower the orders in [temperature] to 2"),
        "{few}"
    );
    soaks[4].imu.parameters[SensorKind::Accelerometer].bias.x += 2.0;
    let other = fit(&model, &soaks).expect_err("another sensor").to_string();
    assert!(other.contains("these are two sensors") && other.contains("accelerometer.bias.x"), "{other}");
}

//! Tests of the fit against drawn sensors: coverage, the scatter, and what each verdict says of a defect.

use super::*;
use crate::rehearsal::{draw, measure};
use crate::{Campaign, CampaignCriterion, Channel, Direction, Soak, rehearse};
use calibrant_core::sensor::{Axis, CalibratedImu, ImuQuantity, Quantity, SensorKind, ThermalPart};
use calibrant_core::simulate::{Purpose, stream};

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
    CampaignModel { campaign: campaign(), orders: vec![3, 2], reference_c: 25.0, one_recording: false }
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
    let found = rehearse(&model(), &[("all".to_owned(), plan())], 100, 1, |_| ()).expect("fits");
    let campaign = &found.campaigns[0];
    for channel in &campaign.channels {
        assert!((0.92..0.97).contains(&channel.coverage), "{channel:?}");
        assert!((0.9..1.1).contains(&(channel.rms / channel.stated_sd)), "{channel:?}");
    }
    // hysteresis that is larger than the goal is that of the sensor
    let alarms: usize = campaign
        .warnings
        .iter()
        .filter(|(code, _)| **code != "hysteresis-large")
        .map(|(_, count)| count)
        .sum();
    assert!(alarms <= 3, "{:?}", campaign.warnings);
}

/// Soaks that just find their scatter: intervals by the normal distribution would be too narrow.
#[test]
fn where_few_soaks_find_the_scatter_the_intervals_are_of_students_t() {
    let mut model = CampaignModel { orders: vec![2, 1], ..model() };
    for channel in &mut model.campaign.channels {
        channel.spread.truncate(3);
        (channel.hysteresis_sd, channel.lag_sd) = (Vec::new(), Vec::new());
    }
    let of = |count: u32| -> (String, Vec<Soak>) {
        let soak = |k: u32| Soak {
            temperature_c: 80.0 / f64::from(count - 1) * f64::from(k) - 20.0,
            direction: Direction::Up,
            wait_min: 60.0,
            blocks: 1,
        };
        (count.to_string(), (0..count).map(soak).collect())
    };
    let found = rehearse(&model, &[of(5), of(6)], 300, 1, |_| ()).expect("fits");
    let [stated, few] = [&found.campaigns[0].channels[0], &found.campaigns[1].channels[0]];
    assert_eq!(stated.degrees, None, "two soaks more than coefficients");
    // three axes of six soaks and three coefficients
    assert!((few.degrees.expect("found") - 9.0).abs() < 0.5, "{few:?}");
    assert!((0.93..0.975).contains(&few.coverage), "{few:?}");
}

/// Sensors on the branches of a ramp that was not used: errors are as predicted.
#[test]
fn a_branch_is_predicted_with_its_hysteresis_and_lag() {
    let model = model();
    let bias = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(Axis::X));
    let (mut squares, mut of_mean, mut count) = (0.0, 0.0, 0.0);
    for seed in 0..60 {
        let mut rng = stream(seed, Purpose::Sensor, 0);
        let truth = draw(&model.campaign, &mut rng);
        let found = fit(&model, &measure(&model.campaign, &plan(), &truth, &mut rng)).expect("fits");
        let channel = &model.campaign.channels[0];
        for direction in [1.0, -1.0] {
            let path = SoakPath { temperature_c: 0.0, direction, lag_left: 0.8 };
            let imu = found.on_path(&path);
            for temperature_c in [-15.0, 5.0, 40.0] {
                let x = model.campaign.x(temperature_c);
                let of_branch = channel.row(x, direction, 0.8).dot(&truth[0][0]);
                let slope = nalgebra::DVector::from_iterator(
                    imu.quantities.len(),
                    imu.quantities.iter().map(|of| match of {
                        ImuQuantity::Thermal(SensorKind::Accelerometer, term)
                            if term.axis == Axis::X && term.part == ThermalPart::Bias =>
                        {
                            (temperature_c - imu.parameters.thermal.reference_c).powi(term.order as i32)
                        }
                        of if *of == bias => 1.0,
                        _ => 0.0,
                    }),
                );
                let variance = (imu.covariance.as_ref().expect("there") * &slope).dot(&slope);
                let of = |imu: &CalibratedImu| bias.value(&imu.parameters.at(temperature_c)) - of_branch;
                squares += of(&imu).powi(2) / variance;
                of_mean += of(&found.imu).powi(2) / variance;
                count += 1.0;
            }
        }
    }
    // the variance has the scatter of another recording, which the truth has not
    assert!((0.05..1.0).contains(&(squares / count)), "{}", squares / count);
    assert!(of_mean > 5.0 * squares, "the lag is no part of the mean: {of_mean} {squares}");
}

#[test]
fn the_scatter_between_soaks_is_found() {
    let model = model();
    let found = |seed| {
        let mut rng = stream(seed, Purpose::Sensor, 0);
        let truth = draw(&model.campaign, &mut rng);
        fit(&model, &measure(&model.campaign, &plan(), &truth, &mut rng)).expect("fits").channels[0]
            .scatter
            .soak_sd
    };
    let mut omegas: Vec<f64> = (0..81).map(found).collect();
    omegas.sort_by(f64::total_cmp);
    assert!((1.2e-3..1.8e-3).contains(&omegas[40]), "{omegas:?}");
}

/// A campaign with a defect.
fn with(defect: impl Fn(&mut Vec<SoakCalibration>)) -> Vec<&'static str> {
    let model = model();
    let mut rng = stream(5, Purpose::Sensor, 0);
    let truth = draw(&model.campaign, &mut rng);
    let mut soaks = measure(&model.campaign, &plan(), &truth, &mut rng);
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

/// Of how many sensors in a hundred nothing is seen of the bias's order 3, which is drawn `times` the size that is known.
fn with_too_high_an_order(plan: &[Soak], times: f64) -> usize {
    let model = model();
    let is_noted = |seed: &u64| {
        let mut rng = stream(*seed, Purpose::Sensor, 0);
        let mut truth = draw(&model.campaign, &mut rng);
        truth[0].iter_mut().for_each(|c| c[3] *= times);
        let found = fit(&model, &measure(&model.campaign, plan, &truth, &mut rng)).expect("fits");
        let named = |note: &calibrant_core::diagnostic::Diagnostic| {
            note.code().name() == "order-too-high" && note.to_string().starts_with("accelerometer.bias: ")
        };
        found.warnings.iter().any(named)
    };
    (0..100).filter(is_noted).count()
}

#[test]
fn an_order_of_which_nothing_is_seen_is_noted_and_one_that_is_there_is_not() {
    // of three axes all within 1 sd: a third
    assert!((20..50).contains(&with_too_high_an_order(&plan(), 0.0)));
    assert_eq!(with_too_high_an_order(&plan(), 1.0), 0);
    // of soaks that hardly see it, too
    let few: Vec<Soak> = plan().into_iter().step_by(3).collect();
    assert!(with_too_high_an_order(&few, 1.0) <= 5);
}

#[test]
fn soaks_that_are_not_alike_or_too_few_are_refused() {
    let model = model();
    let mut rng = stream(7, Purpose::Sensor, 0);
    let truth = draw(&model.campaign, &mut rng);
    let mut soaks = measure(&model.campaign, &plan(), &truth, &mut rng);
    let few = fit(&model, &soaks[..3]).expect_err("three temperatures, order 3").to_string();
    assert!(fit(&model, &[]).expect_err("no soak").to_string().contains("there is no soak"));
    assert!(
        few.contains("accelerometer.bias of order 3")
            && few.contains("lower the orders in [temperature] to 2"),
        "{few}"
    );
    soaks[4].imu.parameters[SensorKind::Accelerometer].bias.x += 2.0;
    let other = fit(&model, &soaks).expect_err("another sensor").to_string();
    assert!(other.contains("these are two sensors") && other.contains("accelerometer.bias.x"), "{other}");
}

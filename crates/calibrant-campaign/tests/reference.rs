//! The best campaigns beside reference values: closed forms of optimal points, and optima that an independent program found (numpy, the same priors).

use calibrant_campaign::{Campaign, CampaignCriterion, Channel, Direction, Soak, design, relaxed, usual};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn channel(name: &str, spread: &[f64], sds: [f64; 3], hysteresis_sd: &[f64], lag_sd: &[f64]) -> Channel {
    let [block_sd, soak_sd, goal_sd] = sds;
    Channel {
        name: name.into(),
        unit: "",
        spread: std::iter::once(None).chain(spread.iter().map(|sd| Some(*sd))).collect(),
        hysteresis_sd: hysteresis_sd.to_vec(),
        lag_sd: lag_sd.to_vec(),
        lag_scatter: 0.2,
        soak_sd,
        block_sd,
        goal_sd,
    }
}

/// A consumer MEMS accelerometer, with six faces as a block.
fn accelerometer() -> Vec<Channel> {
    vec![
        channel(
            "accelerometer.bias",
            &[0.07, 0.03, 0.02, 0.008, 0.004],
            [7e-4, 1.5e-3, 2e-3],
            &[4e-3, 2e-3],
            &[1.5e-2, 5e-3],
        ),
        channel("accelerometer.scale", &[8e-3, 1e-3, 5e-4], [7e-5, 1e-4, 2e-4], &[2e-4], &[5e-4]),
    ]
}

fn imu() -> Vec<Channel> {
    let mut channels = accelerometer();
    channels.extend([
        channel(
            "gyroscope.bias",
            &[6e-3, 2e-3, 1.5e-3, 6e-4, 3e-4],
            [3e-5, 1e-4, 2e-4],
            &[3e-4, 1e-4],
            &[1e-3, 3e-4],
        ),
        channel("gyroscope.scale", &[8e-3, 1e-3, 5e-4], [2e-4, 2e-4, 5e-4], &[], &[5e-4]),
    ]);
    channels
}

fn campaign(channels: Vec<Channel>, budget_min: f64, directions: &[Direction]) -> Campaign {
    Campaign {
        channels,
        range_c: [-20.0, 60.0],
        budget_min,
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

const BOTH: [Direction; 2] = [Direction::Up, Direction::Down];

#[test]
fn whole_campaigns_are_near_the_bound_and_beside_the_reference() {
    // relaxed, its bound, and the whole campaign that the reference found
    for (name, campaign, [value, bound, whole]) in [
        ("accelerometer-6h", campaign(accelerometer(), 360.0, &BOTH), [0.22949, 0.22940, 0.23105]),
        ("imu-6h", campaign(imu(), 360.0, &BOTH), [0.33848, 0.33833, 0.34255]),
        ("imu-3h", campaign(imu(), 180.0, &BOTH), [0.56455, 0.56440, 0.57753]),
        ("imu-6h-upwards", campaign(imu(), 360.0, &[Direction::Up]), [1.59144, 1.58949, 1.60782]),
    ] {
        let found = design(&campaign).expect("found");
        let relaxed = &found.relaxed;
        assert!((relaxed.value / value - 1.0).abs() < 1e-3, "{name}: {}", relaxed.value);
        // two bounds of one optimum: each is below the other's value
        assert!(relaxed.lower_bound <= value && bound <= relaxed.value, "{name}: {}", relaxed.lower_bound);
        assert!(relaxed.value / relaxed.lower_bound < 1.0005, "{name}: {}", relaxed.lower_bound);
        assert!(found.value >= relaxed.lower_bound && found.value < whole * 1.005, "{name}: {}", found.value);
        let minutes: f64 = found.soaks.iter().map(|soak| campaign.minutes(soak)).sum();
        assert!(minutes <= campaign.soaking_min() + 1e-6, "{name}: {minutes}");
        assert!((campaign.value(&found.soaks).expect("determined") - found.value).abs() < 1e-12);
    }
}

#[test]
fn usual_campaigns_are_worse_by_the_reference_factors() {
    for (channels, factors) in [(accelerometer(), [1.72, 1.35, 10.1, 10.3]), (imu(), [1.71, 1.34, 9.9, 10.5])]
    {
        let campaign = campaign(channels, 360.0, &BOTH);
        let bound = relaxed(&campaign).expect("found").lower_bound;
        let usual = usual(&campaign);
        let of = |every_c: f64, wait_min: f64, both: bool| {
            let found =
                usual.iter().find(|of| of.every_c == every_c && of.wait_min == wait_min && of.both == both);
            campaign.value(&found.expect("fits").soaks).expect("determined") / bound
        };
        let found = [of(10.0, 10.0, true), of(5.0, 5.0, true), of(10.0, 20.0, false), of(20.0, 45.0, false)];
        for (found, factor) in found.iter().zip(factors) {
            assert!((found / factor - 1.0).abs() < 6e-3, "{found} {factor}");
        }
    }
}

/// No campaign that fills the time beats the bound, wherever its soaks are.
#[test]
fn random_campaigns_are_above_the_bound() {
    let campaign = campaign(accelerometer(), 360.0, &BOTH);
    let bound = relaxed(&campaign).expect("found");
    assert!(bound.lower_bound_anywhere <= bound.lower_bound);
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    let mut least = f64::INFINITY;
    for _ in 0..1500 {
        let mut soaks: Vec<Soak> = Vec::new();
        let mut left = campaign.soaking_min();
        for _ in 0..200 {
            let direction = BOTH[rng.random_range(0..2)];
            let soak = Soak {
                temperature_c: rng.random_range(-20.0..=60.0),
                direction,
                wait_min: rng.random_range(0.0..30.0),
                blocks: rng.random_range(1..=8),
            };
            let is_near =
                |of: &Soak| of.direction == direction && (of.temperature_c - soak.temperature_c).abs() < 5.0;
            if campaign.minutes(&soak) <= left && !soaks.iter().any(is_near) {
                left -= campaign.minutes(&soak);
                soaks.push(soak);
            }
        }
        least = least.min(campaign.value(&soaks).unwrap_or(f64::INFINITY));
    }
    assert!(least > bound.lower_bound_anywhere && least < 2.0 * bound.lower_bound, "{least}");
}

/// Without hysteresis, lag and soaks' own scatter, and with time for all that is wanted, the relaxed optimum has the points of optimal polynomial regression:
/// for I and order 3 on −1 … 1, the ends and ±0.43662 (`polynomial` designs, a closed form of its equivalence theorem).
#[test]
fn a_polynomial_alone_has_the_points_of_optimal_regression() {
    let plain = |order: usize| Channel {
        spread: vec![None; order + 1],
        lag_scatter: 0.0,
        ..channel("q", &[], [1.0, 0.0, 1.0], &[], &[])
    };
    for (order, inner, share_inner) in [(2, 0.0, 0.5), (3, 0.43662, 0.6902)] {
        let mut campaign = campaign(vec![plain(order)], 170.0, &[Direction::Up]);
        // many soaks at one place: cycles stand for them, and the ramps cost next to nothing
        campaign.ramp_k_per_min = 1e9;
        campaign.cycles = 1000;
        campaign.spacing_c = 1.0;
        let found = relaxed(&campaign).expect("found");
        let minutes = |near: &dyn Fn(f64) -> bool| -> f64 {
            let near = found.soaks.iter().filter(|of| near(campaign.x(of.soak.temperature_c)));
            near.map(|of| of.count * campaign.minutes(&of.soak)).sum()
        };
        let all = minutes(&|_| true);
        let at_inner = minutes(&|x| (x.abs() - inner).abs() < 0.03) / all;
        assert!((at_inner - share_inner).abs() < 0.01, "{order}: {at_inner}");
        assert!((minutes(&|x| x.abs() > 0.999) / all - (1.0 - share_inner)).abs() < 0.01);
    }
}

#[test]
fn a_budget_that_the_ramps_take_is_refused_with_the_least() {
    let refused = design(&campaign(accelerometer(), 80.0, &BOTH)).expect_err("too short").to_string();
    assert!(refused.contains("80 min") && refused.contains("at least 82 min"), "{refused}");
}

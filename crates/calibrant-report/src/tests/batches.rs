//! A batch of made-up sensors for the page on batches.

use super::{Batch, BatchParameter, BatchSensor};
use calibrant_core::diagnostic::Check;
use calibrant_core::diagnostic::Verdict;
use calibrant_core::diagnostic::datasheet::{GainImplausible, ParameterImplausible};
use calibrant_core::diagnostic::samples::Spikes;
use calibrant_core::error::Refusal;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// Sensors whose x bias drifts, one of which is far off, and one of which has no result.
pub(crate) fn drifting_batch(count: usize) -> Batch {
    let parameter = |k: usize| {
        let axis = ["x", "y", "z"][k % 3];
        let (quantity, unit, nominal, spread) = match k / 3 {
            0 => ("bias", "m/s²", 0.0, 0.05),
            _ => ("scale", "1", 1.0, 0.005),
        };
        BatchParameter {
            name: format!("accelerometer.{quantity}.{axis}"),
            unit,
            nominal: Some(nominal),
            spread: Some(spread),
            accepted: (k < 3).then_some((-0.15, 0.15)),
        }
    };
    let parameters: Vec<BatchParameter> = (0..6).map(parameter).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let sensor = |number: usize| {
        let estimate = |(k, of): (usize, &BatchParameter)| {
            let spread = of.spread.unwrap_or(1.0);
            let drawn: f64 = StandardNormal.sample(&mut rng);
            let drift = if k == 0 { 4.0 * number as f64 / count as f64 } else { 0.0 };
            (of.nominal.unwrap_or(0.0) + spread * (0.5 * drawn + drift), 0.1 * spread)
        };
        let mut estimates: Vec<(f64, f64)> = parameters.iter().enumerate().map(estimate).collect();
        let mut codes = Vec::new();
        if number == count / 2 {
            estimates[3].0 = 1.4;
            codes = vec![ParameterImplausible::CODE, GainImplausible::CODE];
        } else if number % 9 == 4 {
            codes = vec![Spikes::CODE];
        }
        let failed = number == count / 3;
        let verdict =
            if failed { Err(Refusal::FileEmpty) } else { Ok(Verdict::on(codes.iter().copied(), &[])) };
        BatchSensor {
            name: format!("sensor-{}", number + 1),
            link: (!failed).then(|| format!("sensor-{}/report.html", number + 1)),
            station: Some(if number < count / 2 { "L1".into() } else { "L2".into() }),
            recorded: None,
            limits_failed: if codes.len() > 1 { vec!["accelerometer.scale.x".into()] } else { Vec::new() },
            reasons: match (failed, codes.len()) {
                (true, _) => vec!["sensor.csv: the file is empty".into()],
                (false, 2) => {
                    vec!["accelerometer.scale.x is 80 datasheet spreads from its nominal value".into()]
                }
                (false, 1) => vec!["3 spikes were cut from the readings".into()],
                _ => Vec::new(),
            },
            quality: if failed { Vec::new() } else { vec![format!("0.{}", 10 + number % 90)] },
            estimates: if failed { Vec::new() } else { estimates },
            codes,
            verdict,
        }
    };
    let sensors = (0..count).map(sensor).collect();
    Batch { parameters, quality: vec!["p-value".into()], sensors }
}

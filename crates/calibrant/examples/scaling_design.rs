//! Measures the time of a design per iteration against its number of intervals:
//! `cargo run --release --example scaling_design`.

use calibrant::design::{DesignProblem, DesignSettings, design};
use calibrant::information::Criterion;
use calibrant::information::criterion::AOptimality;
use calibrant::motion::{InputNoise, KnownEnds, Limits, Rest, Trust};
use calibrant::sensor::{Sensor, SensorParameters};
use nalgebra::{DVector, Vector3};
use std::time::Instant;

fn main() -> calibrant::Result<()> {
    let all = |limit: f64| Some(Vector3::repeat(limit));
    let plain = Limits { acceleration_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() };
    let reach =
        Limits { velocity_mps: all(10.0), displacement_m: all(10.0), rest: Rest::Both, ..plain.clone() };
    let noisy = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    println!(
        "| limits | trust | N | iterations | per iteration, ms | per iteration and interval, µs | status |"
    );
    println!("|---|---|--:|--:|--:|--:|---|");
    for (name, limits, trust) in [
        ("acceleration, jerk", &plain, Trust::Known),
        ("acceleration, jerk, velocity, displacement, rest", &reach, Trust::Known),
        ("acceleration, jerk", &plain, noisy),
    ] {
        for intervals in [10, 30, 100, 300, 1000] {
            let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
            let problem = DesignProblem {
                sensor: &sensor,
                at: SensorParameters::identity(),
                intervals,
                interval_s: 1.0,
                rate_hz: 10.0,
                trust,
                known_ends: KnownEnds::Start,
                gravity: None,
                limits,
                criterion: Criterion::A(AOptimality { scale: DVector::repeat(2, 1.0) }),
                prior: None,
            };
            let settings = DesignSettings { starts: 4, certificate: false, ..DesignSettings::default() };
            let started = Instant::now();
            let design = design(&problem, &settings, &|_| ())?;
            let per = started.elapsed().as_secs_f64() / design.iterations.max(1) as f64;
            println!(
                "| {name} | {} | {intervals} | {} | {:.3} | {:.1} | {} |",
                trust.name(),
                design.iterations,
                1e3 * per,
                1e6 * per / intervals as f64,
                design.status.name()
            );
        }
    }
    Ok(())
}

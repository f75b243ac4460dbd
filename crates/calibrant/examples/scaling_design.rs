//! Measures the design of long motions against their number of intervals:
//! `cargo run --release -p calibrant --features programs --example scaling_design [-- LARGEST [STARTS]]`.
//!
//! Intervals of 0.05 s at 100 Hz within 10 m/s², 30 m/s³, 2 m/s and 0.5 m, from rest to rest. One thread;
//! times include everything but the certificate.

use calibrant::design::{Design, DesignProblem, DesignSettings, DesignStatus, design};
use calibrant::information::Criterion;
use calibrant::information::criterion::AOptimality;
use calibrant::motion::{InputNoise, KnownEnds, Limits, MotionClock, Rest, Trust};
use calibrant::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Vector3};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let largest: usize = arguments.next().map_or(Ok(3000), |argument| argument.parse())?;
    let starts: usize = arguments.next().map_or(Ok(4), |argument| argument.parse())?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    println!(
        "| sensor | trust | N | starts | iterations per start | ms per iteration | µs per iteration and interval | total, s | value | not converged |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    let noisy = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        for trust in [Trust::Known, noisy] {
            for intervals in [30, 100, 300, 1000, 3000].into_iter().filter(|&intervals| intervals <= largest)
            {
                let started = Instant::now();
                let design = of(model, trust, intervals, starts)?;
                let seconds = started.elapsed().as_secs_f64();
                let per = seconds / design.iterations.max(1) as f64;
                let failed =
                    design.starts.iter().filter(|start| start.status != DesignStatus::Converged).count();
                println!(
                    "| {} | {} | {intervals} | {} | {:.1} | {:.2} | {:.1} | {seconds:.2} | {:.8e} | {failed} |",
                    if model == SensorModel::Full { "full" } else { "scale-bias" },
                    trust.name(),
                    design.starts.len(),
                    design.iterations as f64 / design.starts.len() as f64,
                    1e3 * per,
                    1e6 * per / intervals as f64,
                    design.optimal.value,
                );
            }
        }
    }
    Ok(())
}

fn of(model: SensorModel, trust: Trust, intervals: usize, starts: usize) -> calibrant::Result<Design> {
    let all = |limit: f64| Some(Vector3::repeat(limit));
    let limits = Limits {
        acceleration_mps2: all(10.0),
        jerk_mps3: all(30.0),
        velocity_mps: all(2.0),
        displacement_m: all(0.5),
        rest: Rest::Both,
        ..Limits::default()
    };
    let sensor = Sensor { model, ..Sensor::memsic_mxd2020u() };
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals,
        interval_s: 0.05,
        rate_hz: 100.0,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits: &limits,
        criterion: Criterion::A(AOptimality {
            scale: DVector::repeat(sensor.parameter_list().names().len(), 1.0),
        }),
        prior: None,
    };
    let settings = DesignSettings { starts, certificate: false, ..DesignSettings::default() };
    design(&problem, &settings, &|_| ())
}

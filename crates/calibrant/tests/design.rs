//! The reference cases of the design problem.

use calibrant::design::{Design, DesignProblem, DesignSettings, design};
use calibrant::information::Criterion;
use calibrant::information::criterion::AOptimality;
use calibrant::motion::{InputNoise, KnownEnds, Limits, Rest, Trust};
use calibrant::sensor::{Sensor, SensorParameters};
use nalgebra::{DVector, Vector3};

fn solve(limits: &Limits, trust: Trust, seed: u64) -> Design {
    let sensor = Sensor::memsic_mxd2020u();
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: KnownEnds::Start,
        limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(6, 1.0) }),
        prior: None,
    };
    let settings = DesignSettings { seed, certificate: false, ..DesignSettings::default() };
    design(&problem, &settings, &|_| ()).expect("solved")
}

fn case(name: &str) -> (Limits, Trust, f64) {
    let all = |limit: f64| Some(Vector3::repeat(limit));
    let d1 = Limits { acceleration_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() };
    match name {
        "D1" => (d1, Trust::Known, 3.965_463_8e-10),
        "D2" => (
            Limits { intercept_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() },
            Trust::Known,
            3.973_324_1e-10,
        ),
        "D3" => (
            Limits { velocity_mps: all(10.0), displacement_m: all(10.0), rest: Rest::Both, ..d1 },
            Trust::Known,
            3.990_274_9e-10,
        ),
        _ => (
            Limits { acceleration_mps2: all(20.0), jerk_mps3: all(20.0), ..Limits::default() },
            Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }),
            1.103_672e-5,
        ),
    }
}

#[test]
fn trace() {
    let (limits, trust, _) = case("D4");
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: KnownEnds::Start,
        limits: &limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(2, 1.0) }),
        prior: None,
    };
    let settings = DesignSettings { starts: 1, certificate: false, ..DesignSettings::default() };
    let d = design(&problem, &settings, &|_| ()).expect("solved");
    println!("{:?}", d.optimal.motion.acceleration_mps2().iter().map(|a| a.x).collect::<Vec<_>>());
}

#[test]
fn try_all() {
    for name in ["D1", "D3", "D4"] {
        let (limits, trust, reference) = case(name);
        for seed in 1..=2 {
            let start = std::time::Instant::now();
            let design = solve(&limits, trust, seed);
            let best = design.optimal.value / 3.0;
            let hits = design.starts.iter().filter(|s| s.value <= reference * (1.0 + 1e-6)).count();
            let iterations: Vec<_> = design.starts.iter().map(|s| s.iterations).collect();
            println!(
                "{name} {seed}: {:e} ratio-1 {:e} sdK {:e} hits {hits}/{} {:?} {:?} its {:?} ",
                best,
                best / reference - 1.0,
                design.optimal.sd()[3],
                design.starts.len(),
                design.status,
                start.elapsed(),
                iterations.iter().sum::<usize>()
            );
            let mut values: Vec<_> = design.starts.iter().map(|s| s.value / reference - 1.0).collect();
            values.sort_by(f64::total_cmp);
            println!("{:?}", &values[..12]);
            let mut bad: Vec<_> = design.starts.iter().map(|s| s.status).collect();
            bad.retain(|s| *s != calibrant::design::DesignStatus::Converged);
            println!("   {}", bad.len());
            if seed == 1 {
                println!(
                    "{:?}",
                    design.optimal.motion.acceleration_mps2().iter().map(|a| a.x).collect::<Vec<_>>()
                );
            }
        }
    }
}

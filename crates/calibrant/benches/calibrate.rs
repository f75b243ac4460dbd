//! Benchmark of whole calibrations: every trust and model at the thesis's size (N = 14, M = 141), and 38
//! static holds with their detection.

#[allow(unreachable_pub)]
#[path = "../tests/library/common/mod.rs"]
mod common;

use calibrant::estimate::{CalibrationProblem, CalibrationSettings, HoldsSetup, Stimulus, calibrate};
use calibrant::motion::{InputNoise, Trust};
use calibrant::sensor::{Sensor, SensorModel};
use calibrant::simulate::{HoldsSimulation, Purpose, draw_sensor, simulate_holds, stream};
use common::case::Case;
use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use std::hint::black_box;

/// The models, with their names in the benchmark.
const MODELS: [(SensorModel, &str); 2] =
    [(SensorModel::ScaleBias, "scale-bias"), (SensorModel::Full, "full")];

fn motion(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("motion N=14 M=141");
    for (model, name) in MODELS {
        for trust in
            [Trust::Known, Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }), Trust::Unknown]
        {
            if model == SensorModel::Full && trust == Trust::Unknown {
                continue; // not identifiable
            }
            let case = Case::new(model, trust, 14, 5.0, 2.0, 1);
            group.bench_function(format!("{name}/{}", trust.name()), |bencher| {
                bencher.iter(|| black_box(&case).calibrate().expect("identifiable"));
            });
        }
    }
    group.finish();
}

fn holds(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("38 holds of 4 s at 100 Hz");
    group.sample_size(30);
    for (model, name) in MODELS {
        let sensor = Sensor {
            model,
            cross_axis_sd: Some(0.01),
            noise_mps2: Some(Vector3::repeat(0.01)),
            ..Sensor::memsic_mxd2020u()
        };
        let mut rng = stream(1, Purpose::Sensor, 0);
        let truth = draw_sensor(&sensor, &mut rng);
        let simulation = HoldsSimulation {
            poses: 38,
            hold_s: 4.0,
            turn_s: 2.0,
            rate_hz: 100.0,
            gravity_mps2: 9.806_65,
            between_holds_sd_mps2: 1e-3,
        };
        let (recording, _) =
            simulate_holds(&truth, &Vector3::repeat(0.01), sensor.unit, &simulation, &mut rng);
        let setup = HoldsSetup { bias_drift_sd_mps2: 0.0, ..HoldsSetup::default() };
        let problem =
            CalibrationProblem { sensor: &sensor, recording: &recording, stimulus: Stimulus::Holds(&setup) };
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                calibrate(black_box(&problem), &CalibrationSettings::default()).expect("identifiable")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, motion, holds);
criterion_main!(benches);

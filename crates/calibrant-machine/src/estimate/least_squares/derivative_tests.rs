//! The rows of the least-squares problem against differences: all parameters, all control points, joints and poses.

use super::{Model, Pass, State, Stream, WeighedLog};
use crate::chain::chains_for_tests::{Numbers, mixed_chain};
use crate::estimate::problem::{Layout, TiltedGravity};
use crate::estimate::{MachineParameters, MachineSetup, MachineTrust};
use crate::log::{JointLog, PoseLog, ReferenceLog};
use crate::reference::{JointMotion, Motion, PoseMotion};
use crate::spline::{Degree, RotationSpline, UniformKnots, VectorSpline};
use calibrant_core::sensor::{
    Axis, ImuParameters, ImuQuantity, ParameterList, ReadingUnit, Recording, SensorKind, SensorModel,
};
use nalgebra::{UnitQuaternion, Vector3};

fn knots(degree: Degree) -> UniformKnots {
    UniformKnots { start_s: 0.0, step_s: 0.25, intervals: 3, degree }
}

fn joints(numbers: &mut Numbers) -> Motion {
    let chain = mixed_chain(4, numbers);
    let knots = knots(Degree::Cubic);
    let controls = (0..4 * knots.controls()).map(|_| numbers.next(0.5)).collect();
    Motion::Joints(JointMotion { chain, positions: VectorSpline { knots, dimension: 4, controls } })
}

fn poses(numbers: &mut Numbers) -> Motion {
    let knots = knots(Degree::Quintic);
    let controls = (0..3 * knots.controls()).map(|_| numbers.next(0.5)).collect();
    let turn = |_| UnitQuaternion::from_scaled_axis(numbers.vector(0.8));
    let orientation = RotationSpline { knots, controls: (0..knots.controls()).map(turn).collect() };
    Motion::Poses(PoseMotion { position: VectorSpline { knots, dimension: 3, controls }, orientation })
}

/// The whitened residuals are compared; so readings are those that the state predicts.
fn check(make: fn(&mut Numbers) -> Motion, seed: u64) {
    let mut numbers = Numbers(seed);
    let motion = make(&mut numbers);
    let setup = MachineSetup {
        gravity_sd_mps2: 0.01,
        lever_m: numbers.vector(0.2),
        tip_from_sensor: UnitQuaternion::from_scaled_axis(numbers.vector(1.0)),
        ..MachineSetup::default()
    };
    let list = ParameterList::new(3, SensorModel::Full);
    let mut quantities: Vec<ImuQuantity> = SensorKind::ALL
        .into_iter()
        .flat_map(|kind| list.quantities().iter().map(move |of| ImuQuantity::Of(kind, *of)))
        .collect();
    for row in Axis::ALL {
        quantities.extend(Axis::ALL.map(|column| ImuQuantity::GSensitivity(row, column)));
    }
    let mut parameters = MachineParameters::nominal(&setup, ImuParameters::identity(), motion.joints());
    let layout = Layout::new(&setup, &SensorKind::ALL, &quantities, parameters.clone());
    for quantity in &layout.quantities {
        let size = if matches!(quantity, crate::estimate::MachineQuantity::Delay(_)) { 0.01 } else { 0.05 };
        parameters.add(*quantity, numbers.next(size));
    }
    let times_s: Vec<f64> = (0..6).map(|k| 0.1 + 0.1 * f64::from(k)).collect();
    let mut recordings = SensorKind::ALL.map(|_| {
        let readings = vec![Vector3::zeros(); times_s.len()];
        Recording::new(times_s.clone(), readings, 3, ReadingUnit::MetrePerSecondSquared)
            .expect("samples in order")
    });
    let log = ReferenceLog::Poses(PoseLog { times_s: vec![], positions_m: vec![], world_from_body: vec![] });
    let state = State { motion, parameters };
    let pass = Pass::all(MachineTrust::Noisy);
    // the first pass tells what is felt, the second compares
    let predicted = {
        let model = model(&recordings, &log, &layout, &setup);
        [0, 1].map(|s| {
            let mut all = vec![Vector3::zeros(); times_s.len()];
            for of in model.residuals(&state, s, pass) {
                all[of.sample] = -of.value;
            }
            all
        })
    };
    for (recording, predicted) in recordings.iter_mut().zip(predicted) {
        recording.readings_mut().copy_from_slice(&predicted);
    }
    let model = model(&recordings, &log, &layout, &setup);
    let unknowns = state.motion.unknowns();
    let order = state.motion.knots().degree.order();
    let residuals = |state: &State, interval: usize| -> Vec<f64> {
        let mut all = Vec::new();
        for s in 0..2 {
            for of in model.residuals(state, s, pass) {
                if state.motion.knots().interval(of.time_s) == interval {
                    all.extend(of.value.component_div(&model.streams[s].sd).iter());
                }
            }
        }
        all
    };
    let places = model.places(&state);
    for interval in 0..state.motion.knots().intervals {
        let rows = model.rows(&(interval..interval + 1), &state, &places, pass);
        let all = rows.as_columns();
        for column in 0..rows.length - 1 {
            let moved = |step: f64| {
                let mut state = state.clone();
                if column < unknowns * order {
                    let mut steps = vec![0.0; unknowns * state.motion.knots().controls()];
                    steps[interval * unknowns + column] = step;
                    state.motion.step(&steps);
                } else {
                    state.parameters.add(layout.quantities[column - unknowns * order], step);
                }
                residuals(&state, interval)
            };
            let h = 1e-4;
            let [a, b, c, d] = [-2.0 * h, -h, h, 2.0 * h].map(moved);
            for row in 0..all.ncols() {
                // residuals fall where predictions rise
                let difference = -((c[row] - b[row]) * 8.0 - (d[row] - a[row])) / (12.0 * h);
                let exact = all[(column, row)];
                let size = 1.0 + exact.abs() + all.column(row).amax() * 1e-2;
                assert!(
                    (difference - exact).abs() < 1e-7 * size,
                    "interval {interval} column {column} row {row}: {difference} {exact}"
                );
            }
        }
    }
}

fn model<'a>(
    recordings: &'a [Recording; 2],
    log: &'a ReferenceLog,
    layout: &Layout,
    setup: &MachineSetup,
) -> Model<'a> {
    let streams = SensorKind::ALL.into_iter().zip(recordings);
    let streams = streams.map(|(sensor, recording)| {
        let sd = Vector3::new(0.5, 1.0, 2.0);
        Stream { sensor, recording, sd, growth: Vec::new() }
    });
    Model {
        streams: streams.collect(),
        log: WeighedLog { log, sd: vec![1.0; 6], rounding_sd: vec![0.0; 6], growth: Vec::new() },
        layout: layout.clone(),
        gravity: TiltedGravity::new(&setup.up),
        trust: MachineTrust::Noisy,
        middle_s: 0.35,
        covered: vec![true; 3],
    }
}

#[test]
fn rows_of_joints_are_differences() {
    (1..4).for_each(|seed| check(joints, seed));
}

#[test]
fn rows_of_poses_are_differences() {
    (1..4).for_each(|seed| check(poses, seed));
}

#[test]
fn a_sample_on_a_knot_is_in_the_interval_of_its_weights() {
    let mut numbers = Numbers(1);
    let knots = UniformKnots { start_s: 0.1, step_s: 0.1, intervals: 40, degree: Degree::Cubic };
    let chain = mixed_chain(1, &mut numbers);
    let positions = VectorSpline { knots, dimension: 1, controls: vec![0.0; knots.controls()] };
    let motion = Motion::Joints(JointMotion { chain, positions });
    let times_s: Vec<f64> = (0..43).map(|k| 0.1 * f64::from(k)).collect();
    let log = ReferenceLog::Joints(JointLog {
        names: vec!["joint".into()],
        positions: vec![0.0; times_s.len()],
        times_s,
        velocities: None,
    });
    let setup = MachineSetup::default();
    let parameters = MachineParameters::nominal(&setup, ImuParameters::identity(), 1);
    let layout = Layout::new(&setup, &SensorKind::ALL, &[], parameters.clone());
    let none = SensorKind::ALL.map(|_| {
        Recording::new(Vec::new(), Vec::new(), 3, ReadingUnit::MetrePerSecondSquared).expect("no samples")
    });
    let places = model(&none, &log, &layout, &setup).places(&State { motion, parameters });
    let mut seen = 0;
    for interval in 0..knots.intervals {
        for k in places.of_log(&(interval..interval + 1)) {
            assert_eq!(knots.weights(log.times_s()[k]).interval, interval, "sample {k}");
            seen += 1;
        }
    }
    assert!(seen >= 40, "{seen} of those between the first knot and the last");
}

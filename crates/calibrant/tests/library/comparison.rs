//! Two calibrations of one sensor differ by as much as their standard deviations say, however few holds there were.

use crate::common::steady_holds;
use calibrant::estimate::{
    CalibrationProblem, CalibrationSettings, Comparison, HoldsSetup, Stimulus, calibrate,
};
use calibrant::motion::Gravity;
use calibrant::sensor::{CalibratedImu, Sensor, SensorModel, SensorParameters};
use calibrant::simulate::{HoldsSimulation, Purpose, Rng, draw_sensor, simulate_holds, stream};
use nalgebra::Vector3;
use rayon::prelude::*;

const GRAVITY_MPS2: f64 = 9.806_65;

/// A calibration from so many holds that scatter far more than their noise.
fn calibrated(sensor: &Sensor, truth: &SensorParameters, poses: usize, rng: &mut Rng) -> CalibratedImu {
    let simulation = HoldsSimulation {
        poses,
        hold_s: 2.0,
        turn_s: 1.0,
        rate_hz: 50.0,
        gravity_mps2: GRAVITY_MPS2,
        between_holds_sd_mps2: 5e-3,
    };
    let noise = Vector3::repeat(2e-3);
    let (recording, _) = simulate_holds(truth, &noise, sensor.unit, &simulation, rng);
    let gravity = Gravity { magnitude_mps2: GRAVITY_MPS2, sd_mps2: 0.0 };
    let setup = HoldsSetup { gravity, ..steady_holds() };
    let problem = CalibrationProblem { sensor, recording: &recording, stimulus: Stimulus::Holds(&setup) };
    calibrate(&problem, &CalibrationSettings::default()).expect("determined").calibrated()
}

/// Shares of pairs whose p-value is below 5 %: of all parameters together, and of single quantities; and the same with the degrees of freedom unknown.
fn rejected(number: u64, model: SensorModel, poses: [usize; 2]) -> [[f64; 2]; 2] {
    let sensor = Sensor { cross_axis_sd: Some(0.01), ..Sensor::triaxial(model) };
    let pairs: Vec<[Comparison; 2]> = (0..400)
        .into_par_iter()
        .map(|pair| {
            let mut rng = stream(number, Purpose::Sensor, pair);
            let truth = draw_sensor(&sensor, &mut rng);
            let [a, b] = poses.map(|poses| calibrated(&sensor, &truth, poses, &mut rng));
            let unknown = |imu: &CalibratedImu| CalibratedImu { degrees_of_freedom: None, ..imu.clone() };
            [Comparison::of(&a, &b), Comparison::of(&unknown(&a), &unknown(&b))]
        })
        .collect();
    let share = |p: Vec<f64>| p.iter().filter(|p| **p < 0.05).count() as f64 / p.len() as f64;
    [0, 1].map(|which| {
        let all = || pairs.iter().map(|pair| &pair[which]);
        let overall = all().map(|of| of.overall.expect("covariances").p_value).collect();
        let single = all().flat_map(|of| &of.quantities).filter_map(|quantity| quantity.p_value).collect();
        [share(overall), share(single)]
    })
}

#[test]
fn few_holds_reject_no_more_pairs_of_one_sensor_than_they_say() {
    // of 400 pairs, 1.1 % is a standard deviation. One residual beside three, or three beside fifteen, are more uncertain than any
    // approximation allows for
    let cases = [
        (SensorModel::ScaleBias, [9, 9], 0.07),
        (SensorModel::ScaleBias, [9, 12], 0.07),
        (SensorModel::Full, [11, 11], 0.07),
        (SensorModel::Full, [12, 12], 0.07),
        (SensorModel::Full, [10, 12], 0.1),
        (SensorModel::Full, [12, 24], 0.1),
    ];
    let mut off = Vec::new();
    for (number, (model, poses, most)) in (201..).zip(cases) {
        let [[overall, single], [normal, single_normal]] = rejected(number, model, poses);
        println!("{model:?} {poses:?}: {overall:.3} {single:.3}; as known {normal:.3} {single_normal:.3}");
        if !(0.03..most).contains(&overall) || !(0.03..0.07).contains(&single) || normal < 0.15 {
            off.push(format!("{model:?} {poses:?}: {overall} {single}, as known {normal}"));
        }
    }
    assert!(off.is_empty(), "{off:#?}");
}

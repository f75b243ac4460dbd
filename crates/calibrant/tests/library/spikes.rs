//! Tests of spikes and invalid samples, and of the magnitudes of holds in the table.

use crate::common::messages;
use crate::common::{draw_imu, normal, xsens};
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::diagnostic::Diagnostic;
use calibrant::diagnostic::samples::Spikes;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, ImuProblem, ImuSetup, Recovered, Stimulus,
    calibrate, calibrate_imu, find_imu_holds,
};
use calibrant::sensor::{
    ImuCorrection, ImuRecording, ReadingUnit, Recording, Sensor, SensorKind, SensorModel,
};
use calibrant::simulate::{HoldsSimulation, ImuSimulation, Purpose, simulate_holds, simulate_imu, stream};
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;

fn simulated(number: u64) -> ImuRecording {
    let mut rng = stream(5, Purpose::Sensor, number);
    let truth = draw_imu(&mut rng);
    simulate_imu(&truth, &ImuSimulation::default(), &mut rng)
}

fn run(recording: &ImuRecording, setup: &ImuSetup) -> Calibration {
    let accelerometer = Sensor::triaxial(SensorModel::Full);
    let gyroscope = &unfeeling_gyroscope();
    let problem = ImuProblem { accelerometer: &accelerometer, gyroscope, recording, setup };
    calibrate_imu(&problem, &CalibrationSettings::default()).expect("determined")
}

fn sensor(recording: &mut ImuRecording, sensor_kind: SensorKind) -> &mut Recording {
    match sensor_kind {
        SensorKind::Accelerometer => recording[SensorKind::Accelerometer].as_mut(),
        SensorKind::Gyroscope => recording[SensorKind::Gyroscope].as_mut(),
    }
    .expect("recorded")
}

/// Moves one in `every` samples of one axis by 20 to 1000 standard deviations of the noise; returns how many.
fn add_spikes(recording: &mut Recording, every: f64, noise: f64, seed: u64) -> usize {
    let mut rng = stream(seed, Purpose::Sensor, 0);
    let mut count = 0;
    for reading in recording.readings_mut() {
        if rng.random::<f64>() * every < 1.0 {
            let size = noise * 10.0_f64.powf(rng.random_range(1.3..3.0));
            reading[rng.random_range(0..3)] += if rng.random::<bool>() { size } else { -size };
            count += 1;
        }
    }
    count
}

fn worst_shift(of: &Calibration, beside: &Calibration) -> f64 {
    let pairs = of.values.iter().zip(&beside.values).zip(beside.sd());
    pairs.map(|((one, other), sd)| (one - other).abs() / sd).fold(0.0, f64::max)
}

#[test]
fn one_invalid_sample_hides_no_hold_of_either_sensor() {
    let recording = simulated(0);
    let clean = find_imu_holds(&recording, 1.0).expect("found");
    assert_eq!(clean.len(), 24);
    for of in SensorKind::ALL {
        for invalid in [-2_147_483_648.0, 1e12, 1e30, f64::INFINITY] {
            for sample in [120, 1000, 3000] {
                let mut damaged = recording.clone();
                sensor(&mut damaged, of).readings_mut()[sample].y = invalid;
                let found = find_imu_holds(&damaged, 1.0).expect("found");
                assert_eq!(found.len(), 24, "{of} {invalid} {sample}");
                for (one, other) in found.iter().zip(&clean) {
                    assert!((one.mean - other.mean).amax() < 1e-3, "{of} {invalid} {sample}");
                    assert!(one.first.abs_diff(other.first) < 60 && one.end.abs_diff(other.end) < 60);
                }
            }
        }
    }
}

#[test]
fn invalid_samples_in_a_row_are_a_gap_and_are_named_with_time_and_value() {
    let recording = simulated(1);
    let clean = find_imu_holds(&recording, 1.0).expect("found");
    for of in SensorKind::ALL {
        let mut damaged = recording.clone();
        let readings = sensor(&mut damaged, of).readings_mut();
        readings[1000..1020].iter_mut().for_each(|reading| reading.x = -2_147_483_648.0);
        damaged.temperature_c =
            Some(vec![25.0; damaged[SensorKind::Accelerometer].as_ref().expect("there").len()]);
        let (without, spikes) = damaged.without_spikes();
        let [(found, spikes)] = spikes.as_slice() else { panic!("{spikes:?}") };
        assert_eq!((*found, spikes.cut.len(), spikes.time_s), (of, 20, 10.0));
        let samples = without[SensorKind::Accelerometer].as_ref().expect("there").len();
        assert_eq!(without.temperature_c.as_ref().expect("there").len(), samples);
        let words = Diagnostic::from(Spikes::of(spikes, of, ReadingUnit::MetrePerSecondSquared)).to_string();
        assert!(words.contains("20 samples are invalid") && words.contains("at 10.000 s"), "{words}");
        // the holds after the gap are where they were
        let holds = find_imu_holds(&damaged, 1.0).expect("found");
        let last = |holds: &[calibrant::motion::Hold]| holds.last().map(|hold| (hold.first, hold.end));
        assert_eq!(last(&holds), last(&clean));
    }
}

#[test]
fn spikes_divide_no_hold_and_shift_no_estimate() {
    let recording = simulated(2);
    let simulation = ImuSimulation::default();
    let clean = run(&recording, &steady_imu());
    for every in [200.0, 2000.0] {
        let mut damaged = recording.clone();
        let of_accelerometer = add_spikes(
            sensor(&mut damaged, SensorKind::Accelerometer),
            every,
            simulation.accelerometer_noise,
            1,
        );
        let of_gyroscope =
            add_spikes(sensor(&mut damaged, SensorKind::Gyroscope), every, simulation.gyroscope_noise, 2);
        assert!(of_accelerometer > 3 && of_gyroscope > 3);
        let found = run(&damaged, &steady_imu());
        assert_eq!(found.hold_results().len(), 24, "1 in {every}");
        let message: Vec<String> = messages(&found.warnings)
            .into_iter()
            .filter(|warning| warning.contains("replaced by the line"))
            .collect();
        assert_eq!(message.len(), 2, "once for each sensor: {:?}", found.warnings);
        // most of a short hold is near a movement, where a spike counts as one
        let shift = worst_shift(&found, &clean);
        assert!(shift < 1.5, "1 in {every}: {shift} standard deviations");
    }
}

/// A spike of 500 standard deviations in a turn is 0.1 rad/s for 10 ms.
#[test]
fn a_spike_of_the_gyroscope_in_a_rotation_is_replaced() {
    let recording = simulated(3);
    let clean = run(&recording, &steady_imu());
    let rotation = &clean.rotations()[4];
    let middle = 0.5 * (rotation.start_s + rotation.end_s);
    let mut damaged = recording.clone();
    let gyroscope = sensor(&mut damaged, SensorKind::Gyroscope);
    let sample = gyroscope.times_s().partition_point(|t| *t < middle);
    let read = gyroscope.readings()[sample].y;
    gyroscope.readings_mut()[sample].y += 500.0 * ImuSimulation::default().gyroscope_noise;
    let (without, spikes) = gyroscope.without_spikes(SensorKind::Gyroscope);
    assert_eq!(spikes.expect("one").samples, [sample]);
    assert!((without.readings()[sample].y - read).abs() < 6.0 * ImuSimulation::default().gyroscope_noise);
    assert!(worst_shift(&run(&damaged, &steady_imu()), &clean) < 0.1);
}

#[test]
fn honest_recordings_have_no_spikes() {
    let with_some = (0..200).into_par_iter().filter(|&k| !simulated(100 + k).without_spikes().1.is_empty());
    let count = with_some.count();
    assert!(count <= 2, "{count} of 200");
    if let Some((recording, _)) = xsens() {
        assert!(recording.without_spikes().1.is_empty(), "the hand's knocks are none");
    }
}

/// Student's t with 3 degrees of freedom: one reading in 500 is beyond 10.
#[test]
fn neither_heavy_tails_nor_coarse_steps_nor_brief_turns_are_spikes() {
    let times_s: Vec<f64> = (0..20_000).map(|k| f64::from(k) * 0.1).collect();
    let recording = |readings: Vec<Vector3<f64>>| {
        Recording::new(times_s.clone(), readings, 3, ReadingUnit::RadianPerSecond).expect("samples in order")
    };
    let mut rng = stream(7, Purpose::Sensor, 0);
    let mut heavy = || {
        let squares: f64 = (0..3).map(|_| normal(&mut rng).powi(2)).sum();
        normal(&mut rng) / (squares / 3.0).sqrt()
    };
    let heavy = recording(times_s.iter().map(|_| Vector3::from_fn(|_, _| heavy())).collect());
    let mut rng = stream(8, Purpose::Sensor, 0);
    let mut white = || Vector3::from_fn(|_, _| normal(&mut rng));
    // half a second of turning every five seconds, in five samples: a triangle
    let turn = |k: usize| [0.5, 1.0, 1.5, 1.0, 0.5].get(k % 50).copied().unwrap_or(0.0);
    let turned = recording((0..20_000).map(|k| Vector3::repeat(turn(k)) + white() * 0.001).collect());
    let coarse = recording((0..20_000).map(|_| (white() * 0.2).map(f64::round)).collect());
    for (what, recording) in [("heavy", heavy), ("turned", turned), ("coarse", coarse)] {
        for of in SensorKind::ALL {
            let count = recording.without_spikes(of).1.map_or(0, |spikes| spikes.samples.len());
            // the farthest of a heavy tail may be alone by chance; a hundred are beyond 10
            assert!(count <= usize::from(what == "heavy"), "{what} {of}: {count}");
        }
    }
}

/// The magnitude of a hold in the table is that of its mean after the correction in the file.
#[test]
fn the_magnitude_of_a_hold_is_what_the_correction_gives() {
    let calibration = run(&simulated(4), &steady_imu());
    let correction = ImuCorrection::of(&calibration.calibrated()).expect("regular");
    for result in calibration.hold_results() {
        let force = correction.force(&result.hold.mean).expect("an accelerometer");
        let residual = force.norm() - calibration.holds().expect("held").gravity.magnitude_mps2;
        assert!((residual - result.magnitude_residual_mps2).abs() < 1e-12, "{residual}");
    }
    let squares: f64 =
        calibration.hold_results().iter().map(|result| result.magnitude_residual_mps2.powi(2)).sum();
    let rms = (squares / calibration.hold_results().len() as f64).sqrt();
    assert!((rms - calibration.holds().expect("held").magnitude_residual_rms_mps2).abs() < 1e-12);
    assert_eq!(calibration.holds().expect("held").degrees_of_freedom, 24 - 9);
}

#[test]
fn as_many_holds_as_parameters_leave_nothing_to_check() {
    let mut rng = stream(3, Purpose::Sensor, 0);
    let unit = ReadingUnit::MetrePerSecondSquared;
    let simulation = HoldsSimulation {
        poses: 9,
        hold_s: 4.0,
        turn_s: 1.0,
        rate_hz: 100.0,
        gravity_mps2: 9.806_65,
        between_holds_sd_mps2: 0.0,
    };
    let truth = draw_imu(&mut rng)[SensorKind::Accelerometer];
    let (recording, _) = simulate_holds(&truth, &Vector3::repeat(0.01), unit, &simulation, &mut rng);
    let (sensor, setup) = (Sensor::triaxial(SensorModel::Full), steady_holds());
    let problem =
        CalibrationProblem { sensor: &sensor, recording: &recording, stimulus: Stimulus::Holds(&setup) };
    let calibration = calibrate(&problem, &CalibrationSettings::default()).expect("determined");
    let Recovered::Holds(holds) = &calibration.recovered else { panic!("from holds") };
    assert_eq!((holds.holds.len(), holds.degrees_of_freedom), (9, 0));
    let html =
        calibrant::report::calibration_sheet(&calibration, &recording.into(), &[], &Default::default())
            .html();
    assert!(html.contains("no data left to check") && !html.contains("|f| − g in holds, rms"));
}

//! The stages of a calibration on a machine.

use super::covered::covered;
use super::gauss_newton::{Minimum, minimise};
use super::layout::Layout;
use super::log_equations::WeighedLog;
use super::model::{Model, State};
use super::parameters::TiltedGravity;
use super::posterior::Posterior;
use super::reference_fit::fitted;
use super::stream::Stream;
use super::{MachineParameters, MachineQuantity, MachineSetup, MountingPrior, start};
use crate::chain::SensorMount;
use crate::log::ReferenceLog;
use crate::reference::Felt;
use crate::spline::{Degree, UniformKnots};
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, ParameterList, Recording, SensorKind, SensorModel,
};
use nalgebra::{UnitQuaternion, Vector3};

/// exploration
pub fn explore(
    recording: &ImuRecording,
    log: &ReferenceLog,
    setup: &MachineSetup,
    degree: Degree,
) -> Option<()> {
    let sensors: Vec<SensorKind> =
        SensorKind::ALL.into_iter().filter(|kind| recording.sensor(*kind).is_some()).collect();
    let times = log.times_s();
    let knots =
        UniformKnots::covering(times[0], times[times.len() - 1], setup.knot_step_s.unwrap_or(0.05), degree);
    let fit = fitted(log, knots)?;
    println!("log sd {:?} outliers {:?}", fit.sd, fit.outliers);
    let imu: Vec<ImuQuantity> = sensors
        .iter()
        .flat_map(|kind| {
            let list = ParameterList::new(3, SensorModel::Full);
            list.quantities().iter().map(|q| ImuQuantity::Of(*kind, *q)).collect::<Vec<_>>()
        })
        .collect();
    let mut nominal = MachineParameters::nominal(setup, ImuParameters::identity(), 0);
    let covered = covered(log, &knots);
    println!("covered {} of {}", covered.iter().filter(|c| **c).count(), covered.len());
    let gravity = TiltedGravity::new(&setup.up);
    // coarse delay
    let columns = fit.motion.columns(false);
    let gamma = gravity.vector(&nominal);
    let bare = SensorMount { lever_m: Vector3::zeros(), tip_from_sensor: UnitQuaternion::identity() };
    let felt_at = |t: f64, kind: SensorKind| -> Option<Vector3<f64>> {
        if t < knots.start_s || t > knots.end_s() || !covered[knots.interval(t)] {
            return None;
        }
        let mut felt = Felt::zeros(columns);
        let carrier = crate::reference::Carrier { gravity: gamma, mount: bare, chain: None };
        fit.motion.feel(&knots.weights(t), &carrier, columns, &mut felt);
        Some(match kind {
            SensorKind::Accelerometer => felt.force,
            SensorKind::Gyroscope => felt.rate,
        })
    };
    for &kind in &sensors {
        let found = start::delay(recording.sensor(kind)?, &|t| felt_at(t, kind), setup.delay_s, 1.0);
        println!("{kind}: delay {found:?}");
    }
    let kind = *sensors.last()?;
    let main = recording.sensor(kind)?;
    let (delay, _) = start::delay(main, &|t| felt_at(t, kind), setup.delay_s, 1.0)?;
    nominal.delays_s = [delay; 2];
    if setup.mounting == MountingPrior::Unknown {
        let pairs: Vec<_> = main
            .times_s
            .iter()
            .zip(&main.readings)
            .filter_map(|(t, y)| Some((*y, felt_at(t + delay, kind)?)))
            .collect();
        nominal.mount.tip_from_sensor = start::rotation(&pairs)?;
        println!("mounting {:?}", nominal.mount.tip_from_sensor.scaled_axis());
    }
    let layout = Layout::new(setup, &sensors, &imu, nominal.clone());
    let streams: Vec<Stream<'_>> = sensors
        .iter()
        .filter_map(|kind| {
            let recording = recording.sensor(*kind)?;
            Some(Stream {
                sensor: *kind,
                recording,
                sd: first_noise(recording),
                growth: Vec::new(),
                stride: 1,
            })
        })
        .collect();
    let middle_s = 0.5 * (main.times_s[0] + main.times_s[main.len() - 1]);
    let mut model = Model {
        streams,
        log: WeighedLog { log, sd: fit.sd.clone() },
        layout,
        gravity,
        trust: super::MachineTrust::Known,
        middle_s,
        covered,
    };
    let mut state = State { motion: fit.motion.clone(), parameters: nominal };
    let clock = std::time::Instant::now();
    for stream in &mut model.streams {
        stream.stride = (stream.recording.len() / 20_000).max(1);
    }
    for _ in 0..6 {
        for (stream, rms) in model.residual_rms(&state).into_iter().enumerate() {
            model.streams[stream].sd.component_mul_assign(&rms);
        }
        let minimum = minimise(&model, state, 2, 1e-2)?;
        state = minimum.state;
    }
    println!(
        "known: {:?} {:?}",
        clock.elapsed(),
        model.streams.iter().map(|s| s.sd.as_slice().to_vec()).collect::<Vec<_>>()
    );
    for stream in &mut model.streams {
        stream.stride = 1;
    }
    model.trust = setup.trust;
    if std::env::var("ONLY_KNOWN").is_ok() {
        return Some(());
    }
    for round in 0..15 {
        let clock = std::time::Instant::now();
        let minimum = minimise(&model, state.clone(), 1, 1e-4).or_else(|| {
            println!("minimise none");
            None
        })?;
        let solve = clock.elapsed();
        let posterior = Posterior::at(&model, &minimum).or_else(|| {
            println!("posterior none {:?}", minimum.solved.information.diagonal());
            None
        })?;
        println!(
            "round {round}: cost {:.1} iterations {} {:?} last step {} solve {:?} posterior {:?}",
            minimum.cost,
            minimum.iterations,
            minimum.status,
            minimum.last_step,
            solve,
            clock.elapsed() - solve
        );
        println!("{:?}\n{:?}", posterior.streams, posterior.log);
        let mut change = 0.0_f64;
        for (s, stream) in model.streams.iter_mut().enumerate() {
            for axis in 0..3 {
                let factor = posterior.streams[s][axis].variance_factor()?;
                change = change.max(factor.ln().abs());
                stream.sd[axis] *= factor.sqrt();
            }
            println!("  {} sd {:?}", stream.sensor, stream.sd.as_slice());
        }
        if minimum.solved.has_motion() {
            for (sd, moments) in model.log.sd.iter_mut().zip(&posterior.log) {
                let factor = moments.variance_factor()?;
                change = change.max(factor.ln().abs());
                *sd *= factor.sqrt();
            }
            println!(
                "  log sd {:?} leverage {:?}",
                model.log.sd,
                posterior.log.iter().map(|m| m.leverage / m.count as f64).collect::<Vec<_>>()
            );
        }
        println!("  change {change}");
        state = minimum.state.clone();
        if round == 14 || change < 0.02 {
            print(&model, &minimum, &posterior);
            break;
        }
    }
    Some(())
}

fn print(model: &Model<'_>, minimum: &Minimum, posterior: &Posterior) {
    // block sandwich
    let mut blocks: Vec<nalgebra::DVector<f64>> = Vec::new();
    let mut begin = f64::NEG_INFINITY;
    for (t, score) in &minimum.scores {
        if t - begin > 1.0 {
            begin = *t;
            blocks.push(score.clone());
        } else if let Some(last) = blocks.last_mut() {
            *last += score;
        }
    }
    for (k, quantity) in model.layout.quantities.iter().enumerate() {
        let sandwich: f64 =
            blocks.iter().map(|b| posterior.covariance.row(k).transpose().dot(b).powi(2)).sum::<f64>();
        println!(
            "{:28} {:12.6} sd {:.6} sandwich {:.6}",
            quantity.name(&[]),
            minimum.state.parameters.value(*quantity, &model.layout.nominal),
            posterior.covariance[(k, k)].sqrt(),
            sandwich.sqrt()
        );
    }
    let _ = MachineQuantity::Gravity;
}

/// Standard deviation of one sample, from second differences: a first guess.
fn first_noise(recording: &Recording) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| {
        let mut differences: Vec<f64> = recording
            .readings
            .windows(3)
            .map(|w| (w[0][axis] - 2.0 * w[1][axis] + w[2][axis]).abs())
            .collect();
        let middle = differences.len() / 2;
        let median = *differences.select_nth_unstable_by(middle, f64::total_cmp).1;
        (median / (0.6745 * 6.0_f64.sqrt())).max(1e-9)
    })
}

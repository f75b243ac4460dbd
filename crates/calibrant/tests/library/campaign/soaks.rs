//! Soaks of a campaign: what each says by itself, and together.

use calibrant::campaign::fit::{SoakCalibration, fit};
use calibrant::campaign::{Direction, Soak};
use calibrant::io::{Experiment, parse_soak, preset};
use calibrant::sensor::ImuRecording;
use calibrant::session::OtherSoaks;
use calibrant::{Session, SessionOptions, Source, simulate_campaign};

/// The campaign of the preset, with blocks that determine all.
fn campaign() -> Experiment {
    let text = preset("campaign").expect("it exists").replace("\"faces\"", "\"corners\"");
    Experiment::parse(&text, None).expect("valid")
}

fn soak((temperature_c, direction, wait_min): (f64, Direction, f64)) -> Soak {
    Soak { temperature_c, direction, wait_min, blocks: 1 }
}

fn json(experiment: &Experiment, recording: &ImuRecording, (name, others): (&str, OtherSoaks)) -> String {
    let session = Session::with(experiment.clone(), SessionOptions::default()).expect("one").beside(others);
    session.calibrate(&Source::from_recording(name, recording.clone())).expect("determined").json()
}

fn calibrated(
    experiment: &Experiment,
    recording: &ImuRecording,
    (name, others): (&str, OtherSoaks),
) -> SoakCalibration {
    parse_soak(&json(experiment, recording, (name, others)), name).expect("a soak").calibration
}

/// Fitted together, each with what the others say as its prior.
#[test]
fn the_joint_fit_is_that_of_two_stages_where_each_soak_determines_all() {
    let experiment = campaign();
    let of_one = experiment.of_one_soak().expect("one");
    let model = experiment.campaign_model().expect("valid").expect("there");
    let up = [-20.0, 0.0, 20.0, 40.0, 60.0].map(|of| soak((of, Direction::Up, 10.0)));
    let down = [50.0, 30.0, 10.0, -10.0].map(|of| soak((of, Direction::Down, 10.0)));
    let soaks: Vec<Soak> = up.into_iter().chain(down).collect();
    let simulated = simulate_campaign(&experiment, &soaks, Some(1)).expect("simulated");
    let recordings = simulated.soaks.iter().enumerate();
    let alone: Vec<SoakCalibration> = recordings
        .clone()
        .map(|(k, of)| calibrated(&of_one, of, (&k.to_string(), OtherSoaks::default())))
        .collect();
    let two_stages = fit(&model, &alone).expect("determined");
    let together: Vec<SoakCalibration> = recordings
        .map(|(k, of)| {
            let prior = two_stages.prior_on(&two_stages.soaks[k].path).expect("there");
            calibrated(&of_one, of, (&k.to_string(), OtherSoaks { prior, sensor: None }))
        })
        .collect();
    let joint = fit(&model, &together).expect("determined");
    let pulled = alone.iter().zip(&together).flat_map(|(one, other)| {
        let by = |of: &SoakCalibration, k: usize| of.imu.quantities[k].value(&of.imu.parameters);
        let sd = |k: usize| one.imu.covariance.as_ref().expect("there")[(k, k)].sqrt();
        (0..one.imu.quantities.len()).map(move |k| (by(other, k) - by(one, k)).abs() / sd(k))
    });
    let pulled = pulled.fold(0.0, f64::max);
    assert!(pulled > 0.2, "no prior pulls: {pulled}");
    for (one, other) in two_stages.channels.iter().zip(&joint.channels) {
        for axis in 0..3 {
            for x in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                let ((value, sd), (joint, joint_sd)) = (one.at(axis, x), other.at(axis, x));
                let off = (joint - value) / sd;
                assert!(off.abs() < 0.1, "{} at {x}: {off} sd", one.channel.name);
                assert!((joint_sd / sd - 1.0).abs() < 0.05, "{}: {joint_sd} {sd}", one.channel.name);
            }
        }
    }
}

/// The accelerometer without its temperature terms leaves three holds of the last soak out; with them it uses all.
#[test]
fn holds_that_their_temperature_explains_are_not_said_to_be_left_out() {
    let experiment = campaign();
    let up = [(25.0, 5.0), (30.0, 10.0), (35.0, 0.0), (50.0, 10.0)];
    let soaks = up.map(|(temperature_c, wait_min)| soak((temperature_c, Direction::Up, wait_min)));
    let simulated = simulate_campaign(&experiment, &soaks, Some(1)).expect("simulated");
    let json =
        json(&experiment.of_one_soak().expect("one"), &simulated.soaks[3], ("soak", OtherSoaks::default()));
    assert!(!json.contains("holds-left-out-in-a-row"));
}

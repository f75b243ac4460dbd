//! Soaks that each determine all parameters: fitted together, each with what the others say as its prior, as in two stages.

use calibrant::campaign::fit::{FittedCampaign, SoakCalibration, SoakPath, fit};
use calibrant::campaign::{Direction, Soak};
use calibrant::estimate::KnownTerm;
use calibrant::io::{Experiment, parse_soak, preset};
use calibrant::sensor::ImuRecording;
use calibrant::{Session, SessionOptions, Source, simulate_campaign};

/// A prior is so many times as wide as what the others say, as `calibrate` takes it.
const WIDER: f64 = 3.0;

fn calibrated(experiment: &Experiment, recording: &ImuRecording, name: &str) -> SoakCalibration {
    let session = Session::with(experiment.clone(), SessionOptions::default()).expect("one");
    let outcome = session.calibrate(&Source::from_recording(name, recording.clone())).expect("determined");
    parse_soak(&outcome.json(), name).expect("a soak").calibration
}

fn known(others: &FittedCampaign, path: &SoakPath) -> Vec<KnownTerm> {
    let imu = others.on_path(path).at(path.temperature_c).expect("within");
    let sd = |k: usize| imu.covariance.as_ref().map(|of| WIDER * of[(k, k)].sqrt());
    let terms = imu.quantities.iter().enumerate();
    terms.map(|(k, of)| KnownTerm { quantity: *of, value: of.value(&imu.parameters), sd: sd(k) }).collect()
}

#[test]
fn the_joint_fit_is_that_of_two_stages_where_each_soak_determines_all() {
    let text = preset("campaign").expect("it exists").replace("\"faces\"", "\"corners\"");
    let experiment = Experiment::parse(&text, None).expect("valid");
    let of_one = experiment.of_one_soak().expect("one");
    let model = experiment.campaign_model().expect("valid").expect("there");
    let soaks: Vec<Soak> = [-20.0, 0.0, 20.0, 40.0, 60.0, 50.0, 30.0, 10.0, -10.0]
        .into_iter()
        .enumerate()
        .map(|(k, temperature_c)| Soak {
            temperature_c,
            direction: if k < 5 { Direction::Up } else { Direction::Down },
            wait_min: 10.0,
            blocks: 1,
        })
        .collect();
    let simulated = simulate_campaign(&experiment, &soaks, Some(1)).expect("simulated");
    let recordings = simulated.soaks.iter().enumerate();
    let alone: Vec<SoakCalibration> =
        recordings.clone().map(|(k, of)| calibrated(&of_one, of, &k.to_string())).collect();
    let two_stages = fit(&model, &alone).expect("determined");
    let together: Vec<SoakCalibration> = recordings
        .map(|(k, of)| {
            let prior = known(&two_stages, &two_stages.soaks[k].path);
            calibrated(&of_one.with_soak_prior(prior), of, &k.to_string())
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

//! The joint fit: soaks that rest on what the others say are, without that, what they are by themselves.

use calibrant::campaign::Direction::{Down, Up};
use calibrant::campaign::Soak;
use calibrant::campaign::fit::{SoakCalibration, fit};
use calibrant::estimate::KnownTerm;
use calibrant::io::{Experiment, parse_soak, preset, write_imu_recording};
use calibrant::session::{Session, Source};
use calibrant::simulate_campaign;

#[test]
fn the_joint_fit_is_that_of_two_stages_where_each_soak_determines_its_parameters() {
    let text = preset("campaign").expect("it exists").replace("# hold_s = 10.0 ", "hold_s = 2.5 ");
    let text =
        text.replace("# move_s = 5.0 ", "move_s = 1.5 ").replace("# rate_hz = 100.0", "rate_hz = 50.0");
    let experiment = Experiment::parse(&format!("{text}\n[temperature]\naccelerometer_bias = 1\naccelerometer_scale = 1\ngyroscope_bias = 1\ngyroscope_scale = 1\n"), None).expect("valid");
    let soaks = [(-20.0, Up), (20.0, Up), (60.0, Up), (60.0, Down), (20.0, Down), (-20.0, Down)]
        .map(|(temperature_c, direction)| Soak { temperature_c, direction, wait_min: 20.0, blocks: 1 });
    let simulated = simulate_campaign(&experiment, &soaks, Some(4)).expect("an IMU");
    let directory = tempfile::tempdir().expect("a directory");
    let of_one = experiment.of_one_soak().expect("a campaign");
    let calibrated = |experiment: Experiment, number: usize| -> SoakCalibration {
        let path = directory.path().join(format!("{number}.csv"));
        write_imu_recording(&path, &simulated.soaks[number]).expect("written");
        let session = Session::new(experiment).expect("of holds");
        let outcome = session.calibrate(&Source::from_file(&path)).expect("determined");
        parse_soak(&outcome.json(), &format!("soak {number}")).expect("a soak").calibration
    };
    let alone: Vec<SoakCalibration> = (0..soaks.len()).map(|k| calibrated(of_one.clone(), k)).collect();
    // a prior that is two of its standard deviations off, ten times as wide as the estimate
    let with_prior = |soak: &SoakCalibration, number: usize| {
        let sds = soak.imu.covariance.as_ref().expect("there").diagonal().map(f64::sqrt);
        let of_soak =
            soak.imu.quantities.iter().zip(sds.iter()).filter(|(of, _)| !of.name().contains("per_k"));
        let term = |(quantity, sd): (&calibrant::sensor::ImuQuantity, &f64)| KnownTerm {
            quantity: *quantity,
            value: quantity.value(&soak.imu.parameters) + 20.0 * sd,
            sd: Some(10.0 * sd),
        };
        calibrated(of_one.with_soak_prior(of_soak.map(term).collect()), number)
    };
    let together: Vec<SoakCalibration> =
        alone.iter().enumerate().map(|(number, soak)| with_prior(soak, number)).collect();
    assert!(together.iter().all(|soak| !soak.prior.is_empty()));
    let model = experiment.campaign_model().expect("valid").expect("a campaign");
    let [alone, together] = [alone, together].map(|soaks| fit(&model, &soaks).expect("determined"));
    for (one, other) in alone.channels.iter().zip(&together.channels) {
        for axis in 0..3 {
            for x in [-1.0, 0.0, 1.0] {
                let ((value, sd), (joint, _)) = (one.at(axis, x), other.at(axis, x));
                let off = (joint - value) / sd;
                assert!(off.abs() < 0.1, "{} of axis {axis} at {x}: {off}", one.channel.name);
            }
        }
    }
}

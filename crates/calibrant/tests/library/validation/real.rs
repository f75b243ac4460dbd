//! Tests of validation on real recordings.

use crate::common::{steady_holds, steady_imu};
use crate::validation::bench::{Bench, KINDS};
use calibrant::estimate::{CovarianceVerdict, Gyroscope, HoldsSetup, ImuSetup};
use calibrant::sensor::{ImuRecording, ReadingUnit, Recording, Sensor, SensorKind, SensorModel};

/// The recording of imu_tk: half of it calibrates, the other half validates; and by folds.
#[test]
fn the_standard_deviations_on_the_xsens_recording_are_to_be_believed() {
    let Some((recording, gravity)) = crate::common::xsens() else { return };
    let unit = ReadingUnit::Counts;
    let bench = Bench {
        accelerometer: Sensor { unit, gain: None, offset: None, ..Sensor::triaxial(SensorModel::Full) },
        gyroscope: Gyroscope { unit, g_sensitivity: true, ..Gyroscope::default() },
        setup: ImuSetup { holds: HoldsSetup { gravity, ..steady_holds() }, ..steady_imu() },
    };
    let whole = bench.calibrate(&recording);
    let holds = &whole.hold_results();
    let middle = 0.5 * (holds[18].hold.end_s + holds[19].hold.start_s);
    let half = |first: bool| {
        let of = |of: &Option<Recording>| {
            let of = of.as_ref().expect("there");
            Some(of.only(|k| (of.times_s()[k] < middle) == first))
        };
        let (accelerometer, gyroscope) =
            (of(&recording[SensorKind::Accelerometer]), of(&recording[SensorKind::Gyroscope]));
        ImuRecording { sensors: [accelerometer, gyroscope].into(), temperature_c: None }
    };
    let (one, two) = (half(true), half(false));
    let found = [bench.fold(&whole, &recording, 5), bench.validate(&bench.calibrate(&one), &two)];
    for (validation, counts) in found.iter().zip([[38, 38, 33], [19, 19, 18]]) {
        for (kind, count) in KINDS.into_iter().zip(counts) {
            let errors = validation.of_kind(kind).expect("there");
            assert_eq!(errors.counted(), count, "{kind:?}");
            assert_eq!(errors.verdict, CovarianceVerdict::Believed, "{kind:?}: {}", errors.factor);
            assert!((0.6..1.4).contains(&errors.factor), "{kind:?}: {}", errors.factor);
        }
    }
}

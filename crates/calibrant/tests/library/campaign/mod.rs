//! Long simulations of recordings as people make them: what is promised of all of them together.

mod coverage;
mod defects;
mod good;
mod soaks;

use crate::common::draw_imu;
use crate::common::hand::ByHand;
use crate::common::{steady_holds, steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{
    Calibration, CalibrationSettings, Gyroscope, HoldsSetup, ImuProblem, ImuSetup, calibrate_imu,
};
use calibrant::io::{ImuReadOptions, read_imu_recording, write_imu_recording};
use calibrant::sensor::{ImuParameters, ImuRecording, Sensor, SensorModel};
use calibrant::simulate::{Purpose, Rng, stream};

/// An IMU and a recording of it that went through a file.
struct Session {
    imu: ImuParameters,
    recording: ImuRecording,
    accelerometer: Sensor,
    gyroscope: Gyroscope,
    setup: ImuSetup,
}

impl Session {
    /// The session of this number. `spoil` may change what was recorded.
    fn new(seed: u64, number: u64, hand: &ByHand, spoil: impl FnOnce(&mut ImuRecording, &mut Rng)) -> Self {
        let mut rng = stream(seed, Purpose::Sensor, number);
        let imu = draw_imu(&mut rng);
        let mut recording = hand.record(&imu, &mut rng);
        spoil(&mut recording, &mut rng);
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("recording.csv");
        write_imu_recording(&path, &recording).expect("written");
        let file = read_imu_recording(&path, &ImuReadOptions::default()).expect("read");
        // as experiment files have it
        let holds = HoldsSetup { bias_drift_sd_mps2: 0.02, ..steady_holds() };
        Self {
            imu,
            recording: file.recording,
            accelerometer: Sensor::triaxial(SensorModel::Full),
            gyroscope: unfeeling_gyroscope(),
            setup: ImuSetup { holds, ..steady_imu() },
        }
    }

    fn problem(&self) -> ImuProblem<'_> {
        ImuProblem {
            accelerometer: &self.accelerometer,
            gyroscope: &self.gyroscope,
            recording: &self.recording,
            setup: &self.setup,
        }
    }

    fn calibrate(&self) -> calibrant::Result<Calibration> {
        calibrate_imu(&self.problem(), &CalibrationSettings::default())
    }

    /// The error of each parameter in standard deviations.
    fn errors_in_sd(&self, calibration: &Calibration) -> Vec<f64> {
        let sd = calibration.sd();
        let error = |k: usize| (calibration.values[k] - calibration.quantities[k].value(&self.imu)) / sd[k];
        (0..sd.len()).map(error).collect()
    }
}

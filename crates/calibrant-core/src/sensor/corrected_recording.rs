//! The data type of a recording after its correction: corrected values, with their standard uncertainty.

use nalgebra::Vector3;

/// A corrected recording of an IMU.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CorrectedRecording<'a> {
    /// Specific force, m/s².
    pub accelerometer: Option<CorrectedSensor<'a>>,
    /// Angular rate, rad/s.
    pub gyroscope: Option<CorrectedSensor<'a>>,
}

/// Corrected readings of one sensor over time.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectedSensor<'a> {
    /// Sample times, s: those of the recording.
    pub times_s: &'a [f64],
    /// Corrected readings, in the sensor's SI unit.
    pub values: Vec<Vector3<f64>>,
    /// Standard uncertainty of the correction at each sample; `None` where the calibration has no covariance
    /// of this sensor.
    pub sd: Option<Vec<Vector3<f64>>>,
}

#[cfg(test)]
mod tests {
    use crate::sensor::gauge_change::tests::imu;
    use crate::sensor::{ImuCorrection, ImuRecording, ReadingUnit, Recording, SensorKind};
    use nalgebra::Vector3;

    fn recording(times_s: &[f64], reading: Vector3<f64>) -> Recording {
        Recording {
            times_s: times_s.to_vec(),
            readings: vec![reading; times_s.len()],
            axes: 3,
            unit: ReadingUnit::Counts,
        }
    }

    #[test]
    fn a_spike_of_the_accelerometer_is_no_force_that_is_felt() {
        let imu = imu();
        let correction = ImuCorrection::of(&imu).expect("regular");
        let times_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 0.01).collect();
        let force = |t: &f64| Vector3::new(0.01 * (700.0 * t).sin(), -5.0, 8.0 + 0.01 * (900.0 * t).cos());
        let reading = |t: &f64| imu.parameters[SensorKind::Accelerometer].reading(&force(t));
        let whole = ImuRecording {
            sensors: [
                Some(Recording {
                    readings: times_s.iter().map(reading).collect(),
                    ..recording(&times_s, Vector3::zeros())
                }),
                Some(recording(&times_s, imu.parameters[SensorKind::Gyroscope].bias)),
            ]
            .into(),
            temperature_c: None,
        };
        let rates = |of: &ImuRecording| {
            let (clean, _) = of.without_spikes();
            let found = correction.apply_feeling(of, clean[SensorKind::Accelerometer].as_ref());
            found.expect("both there").gyroscope.expect("there").values
        };
        let clean = rates(&whole);
        for invalid in [-2_147_483_648.0, 1e12] {
            let mut spiked = whole.clone();
            spiked[SensorKind::Accelerometer].as_mut().expect("there").readings[300].x = invalid;
            let by_force = imu.parameters.g_sensitivity.norm();
            for (one, other) in rates(&spiked).iter().zip(&clean) {
                assert!((one - other).norm() < 0.1 * by_force, "{one} {other}");
            }
        }
    }
}

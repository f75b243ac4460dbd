//! The gyroscope before its calibration.

use crate::estimate::imu::initial::gyroscope::mean_bias;
use crate::estimate::imu::model::HoldData;
use crate::estimate::imu::problem::Gyroscope;
use crate::estimate::uncalibrated::Uncalibrated;
use crate::sensor::{ImuParameters, ReadingUnit, SensorKind, Thermal};
use nalgebra::Matrix3;

/// The gyroscope before its calibration: the datasheet's gain and the mean reading at rest. Without a datasheet, one gain for all axes.
pub(crate) fn gyroscope_before(
    gyroscope: &Gyroscope,
    holds: &[HoldData],
    start: &ImuParameters,
    estimate: &ImuParameters,
) -> Uncalibrated {
    let mut sensor = start[SensorKind::Gyroscope];
    sensor.bias = mean_bias(holds, &Thermal::none());
    let nominal = gyroscope.gain.map(|gain| Matrix3::from_diagonal(&gain));
    let source = match gyroscope.unit {
        ReadingUnit::Counts if nominal == Some(sensor.matrix) => {
            "the datasheet's gain, less the mean reading at rest"
        }
        ReadingUnit::Counts => {
            let gain = |matrix: &Matrix3<f64>| matrix.row_iter().map(|row| row.norm()).sum::<f64>() / 3.0;
            // the search finds the order of the axes, but only a rough gain
            sensor.matrix *= gain(&estimate[SensorKind::Gyroscope].matrix) / gain(&sensor.matrix);
            "one gain for all axes, the mean of those found, less the mean reading at rest"
        }
        _ => "the readings less their mean at rest",
    };
    Uncalibrated { sensor, source: source.to_owned() }
}

/// The IMU with this gyroscope, and no other error.
pub(crate) fn with_plain_gyroscope(imu: &ImuParameters, gyroscope: &Uncalibrated) -> ImuParameters {
    ImuParameters {
        g_sensitivity: Matrix3::zeros(),
        thermal: Thermal::none(),
        ..imu.with(SensorKind::Gyroscope, gyroscope.sensor)
    }
}

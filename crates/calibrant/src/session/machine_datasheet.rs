//! A result on a machine beside the datasheets of the sensors.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::estimate::{beyond_datasheet, noise_implausible};
use calibrant_core::sensor::{ParameterList, Sensor, SensorKind, SensorParameters};
use calibrant_io::ImuPlan;
use calibrant_machine::estimate::MachineCalibration;
use nalgebra::Vector3;

/// Parameters of the accelerometer that its datasheet does not allow, and noise far beyond the given one. A machine that moves vibrates: less than ten times the noise is no fault.
pub(crate) fn beyond_datasheets(
    accelerometer: &Sensor,
    imu: Option<&ImuPlan>,
    calibration: &MachineCalibration,
) -> Vec<Diagnostic> {
    let names = calibration.names();
    let list = ParameterList::new(3, accelerometer.model);
    let like = accelerometer.nominal().unwrap_or(SensorParameters::identity());
    let place = |name: &String| names.iter().position(|of| of == name);
    let described = list.describe_accelerometer(accelerometer, &like).into_iter();
    let (parameters, places): (Vec<_>, Vec<_>) =
        described.filter_map(|parameter| place(&parameter.name).map(|k| (parameter, k))).unzip();
    let all_sd = calibration.sd();
    let values: Vec<f64> = places.iter().map(|&k| calibration.values[k]).collect();
    let sd: Vec<f64> = places.iter().map(|&k| all_sd[k]).collect();
    let given = |kind: SensorKind| match kind {
        SensorKind::Accelerometer => {
            accelerometer.noise(&accelerometer.gain.unwrap_or_else(|| Vector3::repeat(1.0)))
        }
        SensorKind::Gyroscope => imu.and_then(|imu| imu.gyroscope.noise),
    };
    let noise = calibration.noise.iter().filter_map(|of| {
        noise_implausible(of.sensor, &of.white_noise, &given(of.sensor)?).map(Diagnostic::from)
    });
    beyond_datasheet(&parameters, &values, &sd).into_iter().chain(noise).collect()
}

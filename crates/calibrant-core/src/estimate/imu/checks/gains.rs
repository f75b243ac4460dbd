//! Parameters of the accelerometer that its datasheet does not allow, and gains of readings in SI, which are near one, each axis along its own.

use crate::diagnostic::Check;
use crate::diagnostic::Code;
use crate::diagnostic::datasheet::{BiasImplausible, GainImplausible, GainUnusual, ParameterImplausible};
use crate::estimate::datasheet::{
    allows_bias, allows_gain, beyond_datasheet, implausible_bias, implausible_gains,
};
use crate::estimate::imu::checks::directions::turned_frame;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::{Axis, ImuQuantity, Parameter, ParameterList, Quantity, SensorKind};

/// What these checks say. The accelerometer's own fit says it of an accelerometer that is not final.
pub(crate) const CODES: [Code; 4] =
    [ParameterImplausible::CODE, BiasImplausible::CODE, GainImplausible::CODE, GainUnusual::CODE];

/// Parameters and gains that are not plausible.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let (parameters, sd) = (described(evidence), calibration.sd());
    let mut warnings: Diagnostics =
        beyond_datasheet(&parameters, &calibration.values, &sd).into_iter().collect();
    let is_known =
        |quantity: ImuQuantity| evidence.problem.setup.known_terms().any(|known| known.quantity == quantity);
    let accelerometer = calibration.imu[SensorKind::Accelerometer];
    warnings.extend(implausible_bias(
        calibration.unit(SensorKind::Accelerometer),
        &accelerometer.bias,
        |axis| {
            is_known(ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)))
                || allows_bias(&parameters, &calibration.values, &sd, axis)
        },
    ));
    for sensor_kind in calibration.sensor_kinds() {
        let matrix = &calibration.imu.sensor(sensor_kind).matrix;
        let reordered = sensor_kind == SensorKind::Gyroscope && evidence.axes.is_some();
        // of a turned frame the faces and turns say it better
        if reordered || calibration.frame_is_known() && turned_frame(matrix) {
            continue;
        }
        let allowed = |axis: Axis| {
            let is_accelerometer = sensor_kind == SensorKind::Accelerometer;
            is_known(ImuQuantity::Of(sensor_kind, Quantity::Scale(axis)))
                || is_accelerometer && allows_gain(&parameters, &calibration.values, &sd, axis)
        };
        warnings.extend(implausible_gains(sensor_kind, calibration.unit(sensor_kind), matrix, allowed));
    }
    warnings
}

/// The parameters of the result, those of the accelerometer with the values of its datasheet.
fn described(evidence: &Evidence<'_>) -> Vec<Parameter> {
    let (sensor, calibration) = (evidence.problem.accelerometer, evidence.calibration);
    let like = sensor.nominal().unwrap_or(calibration.imu[SensorKind::Accelerometer]);
    let lists = [
        ParameterList::new(3, sensor.model),
        evidence.problem.setup.holds.gauge.parameter_list(sensor.model),
    ];
    let known: Vec<Parameter> =
        lists.iter().flat_map(|list| list.describe_accelerometer(sensor, &like)).collect();
    let describe = |parameter: &Parameter| {
        known.iter().find(|known| known.name == parameter.name).unwrap_or(parameter).clone()
    };
    calibration.parameters.iter().map(describe).collect()
}

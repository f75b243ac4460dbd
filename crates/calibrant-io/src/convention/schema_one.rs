//! calibrant JSON, schema 1: reads `calibration.json` of one accelerometer as an IMU without a gyroscope.

use super::json_core::{check_direction, quantity_of};
use super::words::input_error;
use super::{CalibratedImuFile, ImuFormat};
use crate::calibration::Input;
use crate::earlier_calibration;
use crate::json;
use crate::text_decoding::Checked;
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{CalibratedImu, ImuParameters, Quantity, ReadingUnit, SensorKind};
use nalgebra::Matrix3;
use serde::Deserialize;

/// The fields that are read beside the estimates.
#[derive(Deserialize)]
struct Beside {
    convention: Option<Convention>,
    input: Option<Input>,
}

#[derive(Deserialize)]
struct Convention {
    direction: Option<String>,
    gauge: Option<String>,
    frame: Option<String>,
}

pub(super) fn read(text: &str) -> Checked<CalibratedImuFile> {
    let earlier = earlier_calibration::parse(text.as_bytes())?;
    let beside: Beside = serde_json::from_str(text).map_err(|error| {
        json::broken(&error, "a calibration.json", "give one that `calibrant calibrate` wrote")
    })?;
    let direction = beside.convention.as_ref().and_then(|convention| convention.direction.as_deref());
    direction.iter().try_for_each(|stated| check_direction("convention.direction", stated))?;
    let (gauge, frame) =
        beside.convention.map_or((None, None), |convention| (convention.gauge, convention.frame));
    let names: Vec<_> =
        earlier.parameters.iter().map(|(name, _)| format!("{}.{name}", SensorKind::Accelerometer)).collect();
    if !names.iter().any(|name| name.ends_with("bias.z")) {
        return Err(input_error(
            Refusal::CalibrationInvalid,
            "this is the calibration of a sensor with one axis; an IMU has three",
            "use its parameters from the file itself",
        ));
    }
    let counts = earlier.parameters.iter().any(|(name, unit)| name.starts_with("bias.") && unit == "counts");
    let unit = if counts { ReadingUnit::Counts } else { ReadingUnit::MetrePerSecondSquared };
    let mut parameters = ImuParameters::identity();
    parameters.accelerometer.matrix = Matrix3::zeros();
    let mut imu = CalibratedImu {
        parameters,
        accelerometer_unit: Some(unit),
        gyroscope_unit: None,
        quantities: Vec::new(),
        covariance: Some(earlier.covariance),
        frame: match (gauge.as_deref(), frame) {
            (Some(gauge), _) => {
                format!("fixed by the {gauge} gauge of the accelerometer, with a positive diagonal")
            }
            (None, Some(frame)) => frame,
            (None, None) => "not said".into(),
        },
    };
    let symmetric = (gauge.as_deref() == Some("symmetric")).then_some(&names);
    for ((name, (plain, found)), value) in names.iter().zip(&earlier.parameters).zip(&earlier.values) {
        let quantity = quantity_of(name, &imu, symmetric).ok_or_else(|| {
            input_error(
                Refusal::CalibrationInvalid,
                format!("\"{plain}\" is no parameter of an accelerometer"),
                "give one that calibrant wrote",
            )
        })?;
        if quantity.unit(unit) != found || imu.quantities.contains(&quantity) {
            return Err(input_error(
                Refusal::CalibrationInvalid,
                format!("{plain} is in {found} or stands twice; {} is expected once", quantity.unit(unit)),
                "give a file that calibrant wrote",
            ));
        }
        quantity.add_to(&mut imu.parameters, *value);
        imu.quantities.push(quantity);
    }
    let scales = imu
        .quantities
        .iter()
        .filter(|q| matches!(q, calibrant_core::sensor::ImuQuantity::Of(_, Quantity::Scale(_))));
    if scales.count() != 3 {
        return Err(input_error(
            Refusal::CalibrationInvalid,
            "it does not have the three scale factors",
            "give a file that calibrant wrote",
        ));
    }
    Ok(CalibratedImuFile {
        imu,
        noise: None,
        inputs: beside.input.into_iter().collect(),
        format: ImuFormat::CalibrantJson,
        findings: Vec::new(),
    })
}

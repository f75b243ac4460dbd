//! Reads `truth.json` of a simulated sensor as a calibration without a covariance: its values are exact.

use super::json_core::{check_direction, quantity_of};
use super::words::invalid;
use super::{CalibratedImuFile, ImuFormat};
use crate::results::json;
use calibrant_core::diagnostic::convention::ValuesExact;
use calibrant_core::sensor::{
    Axis, CalibratedImu, Gauge, ImuParameters, ImuQuantity, PerSensor, Quantity, ReadingUnit, SensorKind,
};
use calibrant_recording::text::decoding::Checked;
use nalgebra::Matrix3;
use serde::Deserialize;

/// The kind of file that the field `kind` names.
const KIND: &str = "the truth of a simulation";
/// The remedy for a broken file.
const HELP: &str = "give a truth.json that `calibrant simulate` wrote";

/// All fields are optional, so that the reader can name what is missing.
#[derive(Deserialize)]
struct File {
    seed: Option<u64>,
    convention: Option<String>,
    gauge: Option<String>,
    reference_c: Option<f64>,
    parameters: Option<Vec<Value>>,
    #[serde(default)]
    fixed: Vec<Value>,
}

#[derive(Deserialize)]
struct Value {
    name: String,
    unit: String,
    value: f64,
}

pub(super) fn read(text: &str) -> Checked<CalibratedImuFile> {
    let file: File = serde_json::from_str(text).map_err(|error| json::broken(&error, KIND, HELP))?;
    file.convention.iter().try_for_each(|stated| check_direction("convention", stated))?;
    let missing = |field: &str| invalid(format!("in {KIND} the field `{field}` is missing"), HELP);
    let listed = file.parameters.ok_or_else(|| missing("parameters"))?;
    let known = |gauge: &String| Gauge::ALL.iter().any(|of| of.name() == gauge.as_str());
    if let Some(gauge) = file.gauge.as_ref().filter(|gauge| !known(gauge)) {
        return Err(invalid(format!("the gauge \"{gauge}\" is none that is known"), HELP));
    }
    let names: Vec<String> = listed.iter().map(|value| value.name.clone()).collect();
    let of = |sensor_kind: SensorKind| {
        listed.iter().zip(&names).filter(move |(_, name)| name.starts_with(sensor_kind.name()))
    };
    let unit = |sensor_kind: SensorKind| {
        of(sensor_kind).next()?;
        let counts = of(sensor_kind).any(|(value, _)| value.unit.starts_with(ReadingUnit::Counts.symbol()));
        Some(if counts { ReadingUnit::Counts } else { sensor_kind.stimulus_unit() })
    };
    let frame = match &file.gauge {
        Some(gauge) => format!("fixed by the {gauge} gauge of the accelerometer, with a positive diagonal"),
        None => "that of the simulation".into(),
    };
    let mut imu = CalibratedImu::new(ImuParameters::identity(), PerSensor::from_fn(unit), Vec::new(), frame);
    // quantities that are not listed are zero
    let calibrated: Vec<SensorKind> = imu.units.present().map(|(sensor_kind, _)| sensor_kind).collect();
    for sensor_kind in &calibrated {
        imu.parameters[*sensor_kind].matrix = Matrix3::zeros();
    }
    // a sensor of which nothing was to be found may have fixed values, too
    let is_of_them = |value: &&Value| calibrated.iter().any(|of| value.name.starts_with(of.name()));
    let symmetric = (file.gauge.as_deref() == Some(Gauge::Symmetric.name())).then_some(&names);
    let estimated = listed.len();
    for (i, value) in listed.iter().chain(file.fixed.iter().filter(is_of_them)).enumerate() {
        let name = &value.name;
        let quantity = quantity_of(name, &imu, symmetric)
            .ok_or_else(|| invalid(format!("\"{name}\" is no parameter of a sensor"), HELP))?;
        let wanted =
            quantity.unit(imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit()));
        if value.unit != wanted {
            let message = format!("{name} is in \"{}\", and {wanted} is expected", value.unit);
            return Err(invalid(message, HELP));
        }
        if imu.quantities.contains(&quantity) {
            return Err(invalid(format!("{name} stands twice"), HELP));
        }
        quantity.add_to(&mut imu.parameters, value.value);
        if i < estimated {
            imu.quantities.push(quantity);
        }
    }
    for sensor_kind in SensorKind::ALL.into_iter().filter(|&sensor_kind| imu.unit(sensor_kind).is_some()) {
        let scale =
            |axis: &Axis| ImuQuantity::Of(sensor_kind, Quantity::Scale(*axis)).value(&imu.parameters) != 0.0;
        if !Axis::ALL.iter().all(scale) {
            return Err(invalid(
                format!(
                    "the truth has fewer than three scale factors of the {sensor_kind}: it has not three axes"
                ),
                "use its parameters from the file itself",
            ));
        }
    }
    if imu.quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::Thermal(..))) {
        imu.parameters.thermal.reference_c = file.reference_c.ok_or_else(|| missing("reference_c"))?;
    }
    let findings = vec![ValuesExact { seed: file.seed.map(|seed| seed as usize) }.into()];
    Ok(CalibratedImuFile { findings, ..CalibratedImuFile::new(imu, ImuFormat::CalibrantJson) })
}

//! The figures of a result that may have a limit: parameters, angles between axes, errors, and what validations say.

use super::calibrated::Calibrated;
use calibrant_core::acceptance::Figure;
use calibrant_core::estimate::{Calibration, ErrorKind, Validation};
use calibrant_core::sensor::{Axis, CalibratedImu, Invariant, SensorKind};
use calibrant_machine::estimate::MachineCalibration;
use nalgebra::Vector3;

/// All figures of a result.
pub(crate) fn figures(calibrated: &Calibrated, validations: &[Validation]) -> Vec<Figure> {
    let sensors = calibrated.sensors();
    let mut figures = match calibrated.machine().map(|machine| &machine.calibration) {
        Some(all) => parameters(all.names().into_iter(), &all.values, &all.sd()),
        None => {
            let names = sensors.parameters.iter().map(|parameter| parameter.name.clone());
            parameters(names, &sensors.values, &sensors.sd())
        }
    };
    figures.extend(axis_angles(&sensors.calibrated()));
    figures.extend(errors(sensors));
    figures.extend(validations.iter().flat_map(validated));
    if let Some(machine) = calibrated.machine() {
        figures.extend(residuals_on_machine(&machine.calibration));
        let factors = machine.validations.iter().flat_map(|of| &of.shifts).map(|shift| shift.factor);
        figures.extend(factors.map(|factor| exact("validation_ratio", factor)));
    }
    figures
}

fn exact(name: impl Into<String>, value: f64) -> Figure {
    Figure { name: name.into(), value, sd: None }
}

/// A root mean square of `count` normal numbers.
fn rms(name: impl Into<String>, value: f64, count: usize) -> Figure {
    Figure { name: name.into(), value, sd: Some(value / (2.0 * count.max(1) as f64).sqrt()) }
}

fn parameters(names: impl Iterator<Item = String>, values: &[f64], sd: &[f64]) -> Vec<Figure> {
    let figures = names.zip(values).zip(sd);
    figures.map(|((name, value), sd)| Figure { name, value: *value, sd: Some(*sd) }).collect()
}

/// The angles between the axes of each sensor, degrees.
fn axis_angles(imu: &CalibratedImu) -> Vec<Figure> {
    let angle = |found: &calibrant_core::sensor::InvariantValue| match found.invariant {
        Invariant::Angle(kind, one, other) if imu.unit(kind).is_some() => Some(Figure {
            name: format!("axis_angle_deg.{kind}.{one}{other}"),
            value: found.value.to_degrees(),
            sd: Some(found.sd?.to_degrees()),
        }),
        _ => None,
    };
    imu.invariants().iter().filter_map(angle).collect()
}

/// Errors in the holds, of the rotations, and residuals of a motion.
fn errors(calibration: &Calibration) -> Vec<Figure> {
    let mut figures = Vec::new();
    if let Some(holds) = calibration.holds().filter(|holds| holds.degrees_of_freedom > 0) {
        let value = holds.magnitude_residual_rms_mps2;
        figures.push(rms("norm_rms_mps2", value, holds.degrees_of_freedom));
    }
    let rotations = calibration.used_rotations().count();
    if rotations > 0 {
        let value = calibration.rotation_rms_rad().to_degrees();
        figures.push(rms("rotation_rms_deg", value, 2 * rotations));
    }
    if let Some(residuals) = calibration.fit.residual_rms {
        let axes = calibration.axes();
        let samples = calibration.fit.degrees_of_freedom / axes.max(1);
        figures.extend(residual_rms(SensorKind::Accelerometer, &residuals, axes, samples));
    }
    figures
}

fn residuals_on_machine(calibration: &MachineCalibration) -> Vec<Figure> {
    let of_sensor = |of: &calibrant_machine::estimate::SensorResidual| {
        residual_rms(of.sensor, &of.rms, 3, of.residuals.len())
    };
    calibration.noise.iter().flat_map(of_sensor).collect()
}

fn residual_rms(kind: SensorKind, residuals: &Vector3<f64>, axes: usize, samples: usize) -> Vec<Figure> {
    let figure = |axis: &Axis| rms(format!("residual_rms.{kind}.{axis}"), residuals[axis.index()], samples);
    Axis::ALL[..axes].iter().map(figure).collect()
}

/// What the data that were not used say.
fn validated(validation: &Validation) -> Vec<Figure> {
    let magnitudes = validation.of_kind(ErrorKind::Magnitude);
    let repeatability =
        magnitudes.map(|errors| rms("repeatability_mps2", errors.rms, errors.degrees_of_freedom));
    let factors = validation.kinds.iter().map(|errors| exact("validation_ratio", errors.factor));
    repeatability.into_iter().chain(factors).collect()
}

//! A calibration as a format takes it: what the format has no place for is refused or said, and the frame is the format's.

use super::file::{CalibratedImuFile, WrittenImu};
use super::imu_noise::ImuNoise;
use super::words::input_error;
use super::{ImuFormat, autopilot, usable_calibration};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::{
    FormatLoses, FrameTurned, PolynomialShortened, ResponseStraightened,
};
use calibrant_core::diagnostic::correction::BiasesSupposed;
use calibrant_core::error::{Error, InputError, Refusal};
use calibrant_core::motion::Gravity;
use calibrant_core::number_format::plain;
use calibrant_core::sensor::{
    CalibratedImu, Gauge, ImuParameters, ImuPart, ReadingUnit, SensorKind, SensorThermal, ThermalPart,
};
use calibrant_recording::text::decoding::Checked;
use std::path::PathBuf;

/// A calibration that a format can carry.
pub(super) struct Prepared {
    pub(super) file: CalibratedImuFile,
    /// What the format loses.
    pub(super) warnings: Vec<Diagnostic>,
}

impl Prepared {
    /// A calibration as this format takes it.
    pub(super) fn of(file: &CalibratedImuFile, format: ImuFormat) -> Checked<Self> {
        usable_calibration::usable(&file.imu)?;
        let mut file = file.clone();
        let mut warnings: Vec<Diagnostic> = Vec::new();
        let (imu, title) = (&mut file.imu, format.title());
        let loses = |what| FormatLoses { format: title, what, kept: None }.into();
        if format != ImuFormat::CalibrantJson && imu.covariance.is_some() {
            warnings.push(loses("the covariance"));
        }
        if format.is_physical() {
            refuse_counts(imu, title)?;
        }
        refuse_temperature(imu, format)?;
        refuse_parts(imu, format)?;
        if matches!(format, ImuFormat::Px4 | ImuFormat::ArduPilot) {
            let (order, shorter) = (autopilot::POWERS, imu.parameters.with_bias_order(autopilot::POWERS));
            let too_high = |(_, of): (SensorKind, &SensorThermal)| of.order(ThermalPart::Bias) > order;
            if imu.parameters.thermal.sensors.iter().any(too_high) && imu.parameters.thermal.range_c.is_some()
            {
                let errors = errors(imu, &shorter);
                warnings.push(PolynomialShortened { format: title, order, errors }.into());
                imu.parameters = shorter;
            }
        }
        let bends = &imu.parameters[SensorKind::Accelerometer].nonlinearity;
        if !bends.is_none() && !matches!(format, ImuFormat::CalibrantJson | ImuFormat::CHeader) {
            let of_axis = |axis: usize| {
                [1.0, -1.0].map(|sign| bends.bend(axis, sign * Gravity::SOMEWHERE.magnitude_mps2).abs())
            };
            let largest_mps2 = (0..3).flat_map(of_axis).fold(0.0, f64::max);
            warnings.push(ResponseStraightened { format: title, largest_mps2 }.into());
        }
        if format.is_lower() && imu.unit(SensorKind::Accelerometer).is_some() {
            let turned = imu.in_gauge(Gauge::Lower).map_err(input_error_of)?;
            if turned.parameters != imu.parameters {
                let angle_deg = Some(turn_deg(imu, &turned));
                warnings.push(FrameTurned { format: title, angle_deg }.into());
                *imu = turned;
            }
        }
        if !format.is_read() {
            let unknown =
                SensorKind::ALL.into_iter().filter(|kind| imu.unit(*kind).is_some() && !imu.has_bias(*kind));
            warnings.extend(unknown.map(|sensor_kind| BiasesSupposed { sensor_kind }.into()));
        }
        if matches!(format, ImuFormat::Kalibr | ImuFormat::OpenVins | ImuFormat::Basalt) {
            let rate = ImuNoise {
                update_rate_hz: file.inputs.first().map(|input| input.rate_hz),
                ..ImuNoise::default()
            };
            let noise = file.noise.take().unwrap_or_default().or(rate);
            warnings.extend(noise.of_rates());
            file.noise = Some(noise);
        } else if let Some(noise) = &file.noise {
            warnings.extend(match format {
                ImuFormat::CalibrantJson => noise.of_rates(),
                _ => Some(loses("the noise densities")),
            });
        }
        Ok(Self { file, warnings })
    }

    /// What was written, in these files.
    pub(super) fn written(self, files: Vec<PathBuf>) -> WrittenImu {
        WrittenImu { files, warnings: self.warnings, frame: self.file.imu.frame }
    }
}

fn impossible(message: String, help: &str) -> Checked<()> {
    Err(input_error(Refusal::ConversionImpossible, message, help))
}

fn refuse_counts(imu: &CalibratedImu, title: &str) -> Checked<()> {
    match imu.units.present().find(|(_, unit)| **unit == ReadingUnit::Counts) {
        None => Ok(()),
        Some((sensor_kind, _)) => impossible(
            format!(
                "{title} is of readings in m/s² and rad/s, and those of the {sensor_kind} are counts here"
            ),
            "calibrate readings as the driver gives them, or choose another format",
        ),
    }
}

fn refuse_temperature(imu: &CalibratedImu, format: ImuFormat) -> Checked<()> {
    if !imu.follows_temperature() || format.follows_temperature() {
        return Ok(());
    }
    // an IMU without a range has gains there
    let fixed = imu.at(imu.parameters.thermal.reference_c).map_err(input_error_of)?;
    let errors = errors(imu, &fixed.parameters);
    let errors = if errors.is_empty() { String::new() } else { format!(": {}", errors.join(", ")) };
    impossible(
        format!(
            "{} has no place for what temperature does to bias and gain, and the correction would be another without it{errors}",
            format.title()
        ),
        "choose another format, or take the values at one temperature with option `temperature` CELSIUS",
    )
}

/// What each sensor errs by if other parameters correct its readings.
fn errors(imu: &CalibratedImu, other: &ImuParameters) -> Vec<String> {
    imu.units
        .present()
        .map(|(sensor_kind, _)| (sensor_kind, imu.parameters.omission_error(other, sensor_kind)))
        .filter(|(_, error)| error.largest > 0.0)
        .map(|(kind, error)| {
            format!(
                "the {kind} by up to {} {}{}",
                plain(error.largest, 3),
                kind.stimulus_unit().symbol(),
                error.over
            )
        })
        .collect()
}

/// Refuses what the format has no place for, each part with the error without it.
fn refuse_parts(imu: &CalibratedImu, format: ImuFormat) -> Checked<()> {
    let (mut lost, mut names) = (Vec::new(), Vec::new());
    for &part in format.lacks() {
        let without = imu.without(part);
        for sensor_kind in SensorKind::ALL.into_iter().filter(|sensor_kind| part.is_of(*sensor_kind, imu)) {
            let error = imu.parameters.omission_error(&without.parameters, sensor_kind);
            let (size, unit) = (plain(error.largest, 3), sensor_kind.stimulus_unit().symbol());
            lost.push(format!(
                "the {sensor_kind}'s {} (up to {size} {unit}{})",
                part.title().trim_start_matches("the "),
                error.over
            ));
            names.push(part.name());
        }
    }
    names.dedup();
    if lost.is_empty() {
        return Ok(());
    }
    let alone = match names[..] {
        [name] if name == ImuPart::GSensitivity.name() => {
            ", write the accelerometer alone with option `sensor` accelerometer"
        }
        _ => "",
    };
    let help = format!(
        "choose another format{alone}, or leave it out on purpose with option `drop` {}",
        names.join(",")
    );
    let title = format.title();
    impossible(
        format!(
            "{title} has no place for {}, and the correction would be another without it",
            lost.join(", ")
        ),
        &help,
    )
}

/// The angle of the turn between two true frames, °.
fn turn_deg(before: &CalibratedImu, after: &CalibratedImu) -> f64 {
    let [one, other] = [before, after].map(|imu| imu.parameters[SensorKind::Accelerometer].matrix);
    let cosine = one.try_inverse().map_or(1.0, |inverse| 0.5 * ((inverse * other).trace() - 1.0));
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}

fn input_error_of(error: Error) -> Box<InputError> {
    match error {
        Error::Experiment(error) => error,
        other => input_error(Refusal::ConversionImpossible, other.to_string(), ""),
    }
}

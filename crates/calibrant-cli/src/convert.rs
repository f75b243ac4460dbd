//! `calibrant convert`: writes a calibration in another format.

use crate::calibration_file::{Format, Reading, in_words};
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{
    ImuFormat, ResultPlaces, edit_calibrated_imu, imu_tk_files, write_calibrated_imu, write_temperature_table,
};
use calibrant::report::number_format;
use calibrant::sensor::{CalibratedImu, Gauge, ImuPart};
use calibrant::{Conversion, Error};
use std::path::{Path, PathBuf};

/// Convert a calibration between formats: calibrant JSON, Kalibr, OpenVINS, basalt, PX4, ArduPilot, imufusion, librealsense, imu_calib (ROS 1, ROS 2), imu_tk, imucal, C header.
///
/// The correction stays the same to the last digits. The command reports what a format cannot store, and refuses where the correction would change, with the error
/// that this would make; --drop leaves it out on purpose. imu_tk has one file for each sensor: NAME.calib stands for NAME_acc.calib and NAME_gyro.calib. With
/// --sensor, one sensor of an IMU is written alone.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Output file. The extension gives the format: .json (calibrant), .yaml (Kalibr), .calib (imu_tk), .h (C), .params (PX4), .param (ArduPilot), .py (imufusion).
    #[arg(value_name = "OUT", required_unless_present = "into")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Format of OUT.
    #[arg(long, value_enum)]
    to: Option<Format>,
    /// A calibration of basalt that gets this IMU, in place of OUT: its own keys are replaced, everything else in the file stays.
    #[arg(long, value_name = "FILE", conflicts_with = "output")]
    into: Option<PathBuf>,
    /// Rotate the true frame of both sensors into this gauge of the accelerometer.
    #[arg(long, value_enum)]
    gauge: Option<GaugeName>,
    /// The calibration that had corrected the readings of IN, when IN was recorded and calibrated: OUT then corrects raw readings, in one step.
    #[arg(long, value_name = "FILE")]
    after: Option<PathBuf>,
    /// Noise densities for OUT: the noise.json of `calibrant noise`, or an imu.yaml of Kalibr. Repeatable: a file adds what the earlier ones lack.
    #[arg(long, value_name = "FILE")]
    noise: Vec<PathBuf>,
    /// The ROS topic of the IMU, for Kalibr and OpenVINS.
    #[arg(long, value_name = "TOPIC")]
    rostopic: Option<String>,
    /// Rate of the readings, Hz, for Kalibr, OpenVINS and basalt (default: that of the noise or of the calibrated recording).
    #[arg(long, value_name = "HZ", value_parser = rate)]
    update_rate: Option<f64>,
    /// Omit parts that OUT has no place for: cross-axis (of the accelerometer), gyroscope-matrix (its gain and alignment), gain-temperature, g-sensitivity.
    /// This changes the correction; the largest error is printed.
    #[arg(long, value_name = "PART,…", value_delimiter = ',', value_parser = part)]
    drop: Vec<ImuPart>,
    /// The same as --drop g-sensitivity.
    #[arg(long, hide = true)]
    drop_g_sensitivity: bool,
    /// Write a table of biases and gains every so many K over the calibrated range, with their standard deviations: CSV, or arrays of a C header where OUT ends in .h.
    #[arg(long, value_name = "K", value_parser = step, conflicts_with_all = ["to", "into", "temperature"])]
    table: Option<f64>,
    /// Evaluate biases and gains at this temperature, °C, and omit the temperature terms.
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = crate::recording_options::celsius)]
    temperature: Option<f64>,
}

fn part(name: &str) -> Result<ImuPart, String> {
    let all = || ImuPart::ALL.map(ImuPart::name).join(", ");
    ImuPart::by_name(name).ok_or_else(|| format!("the parts are {}", all()))
}

fn rate(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| "a rate in Hz, greater than 0".into())
}

fn step(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| "a step in K, greater than 0".into())
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum GaugeName {
    /// Lower triangular: true x along the accelerometer's x axis (Kalibr).
    Lower,
    /// Upper triangular: true z along the accelerometer's z axis (imu_tk).
    Upper,
    /// Symmetric: the true axes as close as possible to all three sensitive axes.
    Symmetric,
}

impl From<GaugeName> for Gauge {
    fn from(gauge: GaugeName) -> Self {
        match gauge {
            GaugeName::Lower => Self::Lower,
            GaugeName::Upper => Self::Upper,
            GaugeName::Symmetric => Self::Symmetric,
        }
    }
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let is_pair = |path: &Path| path.extension().is_some_and(|extension| extension == "calib");
        let pair = |path: &Path, is_pair: bool| is_pair.then(|| imu_tk_files(path)).into_iter().flatten();
        let output = self.output.iter();
        let writes_pair = |path: &Path| is_pair(path) || matches!(self.to, Some(Format::ImuTk));
        let inputs = std::iter::once(&self.input).chain(&self.noise).chain(&self.after).cloned();
        ResultPlaces {
            directory: None,
            // the file of --into is no result: it is there before, and changed on purpose
            results: output.flat_map(|path| pair(path, writes_pair(path)).chain([path.clone()])).collect(),
            inputs: inputs.chain(pair(&self.input, is_pair(&self.input))).collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

impl Arguments {
    /// The format that is written.
    fn format(&self) -> calibrant::Result<ImuFormat> {
        let refuse = |path: &Path, message: &str, help: String| {
            let input_error = InputError::new(Refusal::FormatUnknown, message, help);
            Err(Error::Experiment(Box::new(input_error.in_file(path))))
        };
        match (self.to.map(ImuFormat::from), &self.into, &self.output) {
            (Some(ImuFormat::Basalt) | None, Some(_), _) => Ok(ImuFormat::Basalt),
            (Some(_), Some(into), _) => refuse(
                into,
                "--into is for files of basalt",
                "give OUT, the file to write, in its place".into(),
            ),
            (Some(format), None, _) => Ok(format),
            (None, None, output) => {
                let output = output.as_deref().unwrap_or(Path::new(""));
                let message = "the extension does not tell the format to write";
                let help = || format!("say it with --to: {}", ImuFormat::names(false));
                ImuFormat::of_extension(output).map_or_else(|| refuse(output, message, help()), Ok)
            }
        }
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    // a table has no format of a calibration
    let format = if arguments.table.is_some() { ImuFormat::CHeader } else { arguments.format()? };
    let mut file = arguments.reading.read(&arguments.input)?;
    let read =
        format!("{} ({}): {}\n", console::name(&arguments.input), file.format.title(), in_words(&file.imu));
    let felt = arguments.drop_g_sensitivity.then_some(ImuPart::GSensitivity);
    let conversion = Conversion {
        path: Some(arguments.input.clone()),
        after: arguments.after.clone(),
        noise: arguments.noise.clone(),
        drop: arguments.drop.iter().copied().chain(felt).collect(),
        sensor: arguments.reading.sensor_kind(),
        temperature_c: arguments.temperature,
        gauge: arguments.gauge.map(Gauge::from),
        rostopic: arguments.rostopic.clone(),
        update_rate_hz: arguments.update_rate,
    };
    tell_all(&conversion.change(&mut file)?);
    if let (Some(step_k), Some(output)) = (arguments.table, &arguments.output) {
        console::print(&read);
        return table(output, &file.imu, step_k).map_err(|error| error.in_experiment(&arguments.input));
    }
    let written = match (&arguments.into, &arguments.output) {
        (Some(into), _) => edit_calibrated_imu(into, &file)?,
        (None, output) => write_calibrated_imu(output.as_deref().unwrap_or(Path::new("")), &file, format)?,
    };
    console::print(&read);
    tell_all(&written.warnings);
    let files: Vec<_> = written.files.iter().map(|path| console::name(path)).collect();
    console::print(&format!("{} ({}), true frame: {}\n", files.join(" and "), format.title(), written.frame));
    Ok(Exit::DONE)
}

/// Writes the table over temperature, and says what its lines err by.
fn table(output: &Path, imu: &CalibratedImu, step_k: f64) -> calibrant::Result<Exit> {
    for error in write_temperature_table(output, imu, step_k)? {
        console::print(&format!(
            "{}: lines between the rows err by up to {} {} of the bias and {} of the gain\n",
            error.sensor_kind,
            number_format::significant(error.bias, 2),
            imu.unit(error.sensor_kind).map_or("", |unit| unit.symbol()),
            number_format::significant(error.scale, 2)
        ));
    }
    console::print(&format!("{} (table)\n", console::name(output)));
    Ok(Exit::DONE)
}

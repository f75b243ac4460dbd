//! `calibrant convert`: writes a calibration in another format.

use crate::calibration_file::{Format, Reading, in_words};
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{ImuFormat, ResultPlaces, imu_tk_files, write_calibrated_imu};
use calibrant::sensor::Gauge;
use calibrant::{Conversion, Error};
use std::path::{Path, PathBuf};

/// Convert a calibration between formats: calibrant JSON, Kalibr, imu_tk, imucal, C header.
///
/// The correction stays the same to the last digits. The command reports what a format cannot store, and refuses where the correction would change. imu_tk has one
/// file for each sensor: NAME.calib stands for NAME_acc.calib and NAME_gyro.calib. With --sensor, one sensor of an IMU is written alone.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration.
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Output file. The extension gives the format: .json (calibrant), .yaml (Kalibr), .calib (imu_tk), .h (C).
    #[arg(value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Format of OUT.
    #[arg(long, value_enum)]
    to: Option<Format>,
    /// Rotate the true frame of both sensors into this gauge of the accelerometer.
    #[arg(long, value_enum)]
    gauge: Option<GaugeName>,
    /// Noise densities for OUT: the noise.json of `calibrant noise`, or an imu.yaml of Kalibr. Repeatable: a file adds what the earlier ones lack.
    #[arg(long, value_name = "FILE")]
    noise: Vec<PathBuf>,
    /// Omit the gyroscope's g-sensitivity. This changes the correction.
    #[arg(long)]
    drop_g_sensitivity: bool,
    /// Evaluate biases and gains at this temperature, °C, and omit the temperature terms.
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = crate::recording_options::celsius)]
    temperature: Option<f64>,
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
        let writes_pair = is_pair(&self.output) || matches!(self.to, Some(Format::ImuTk));
        let inputs = std::iter::once(&self.input).chain(&self.noise).cloned();
        ResultPlaces {
            directory: None,
            results: pair(&self.output, writes_pair).chain([self.output.clone()]).collect(),
            inputs: inputs.chain(pair(&self.input, is_pair(&self.input))).collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let format = match arguments.to {
        Some(format) => format.into(),
        None => ImuFormat::of_extension(&arguments.output).ok_or_else(|| {
            let input_error = InputError::new(
                Refusal::FormatUnknown,
                "the extension does not tell the format to write",
                "say it with --to: calibrant, kalibr, imu_tk, imucal, c",
            );
            Error::Experiment(Box::new(input_error.in_file(&arguments.output)))
        })?,
    };
    let mut file = arguments.reading.read(&arguments.input)?;
    let read =
        format!("{} ({}): {}\n", console::name(&arguments.input), file.format.title(), in_words(&file.imu));
    let conversion = Conversion {
        path: Some(arguments.input.clone()),
        noise: arguments.noise.clone(),
        drop_g_sensitivity: arguments.drop_g_sensitivity,
        sensor: arguments.reading.sensor_kind(),
        temperature_c: arguments.temperature,
        gauge: arguments.gauge.map(Gauge::from),
    };
    tell_all(&conversion.change(&mut file)?);
    let written = write_calibrated_imu(&arguments.output, &file, format)?;
    console::print(&read);
    tell_all(&written.warnings);
    let files: Vec<_> = written.files.iter().map(|path| console::name(path)).collect();
    console::print(&format!(
        "{} ({}), true frame: {}\n",
        files.join(" and "),
        format.title(),
        file.imu.frame
    ));
    Ok(Exit::DONE)
}

//! `calibrant apply`: corrects a recording, and writes the standard uncertainty of the correction.

use crate::calibration_file::{Content, in_words};
use crate::console;
use crate::diagnostics::{tell, tell_all};
use crate::exit::Exit;
use calibrant::diagnostic::settings::SettingUnused;
use calibrant::io::{
    ImuUnit, ResultPlaces, check_not_corrected, file_name, imu_tk_files, write_corrected_recording,
};
use calibrant::report::number_format;
use calibrant::sensor::{CalibratedImu, CorrectedSensor, ImuCorrection, ImuRecording, SensorKind};
use calibrant::session::{Readings, Source};
use calibrant::{Applied, read_for_correction};
use std::path::PathBuf;

/// Correct a recording with a calibration. The result is specific force and angular rate, with their standard uncertainty.
///
/// Writes CSV with the columns t_s,ax_mps2,…,ax_sd_mps2,…,gx_radps,…,gx_sd_radps,…, or in the units that --output-accelerometer-unit and
/// --output-gyroscope-unit name (ax_g, gx_degps). The uncertainty is that of the calibration. Its error is
/// the same in every sample, and does not average out. It does not include the noise of a sample.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration, in any format that `calibrant convert` reads.
    calibration: PathBuf,
    /// The recording, in any format that `calibrant inspect` knows.
    recording: PathBuf,
    /// The gyroscope's file, if each sensor has its own file (imu_tk).
    #[arg(long, value_name = "FILE")]
    gyroscope: Option<PathBuf>,
    #[command(flatten)]
    file: crate::recording_options::RecordingOptions,
    /// Experiment file whose [columns] name the columns of the recording.
    #[arg(long, value_name = "EXPERIMENT")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    content: Content,
    /// Temperature of the recording, °C, for a calibration with temperature terms. It replaces that of the recording.
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = crate::recording_options::celsius)]
    temperature: Option<f64>,
    /// Unit of the corrected accelerometer: m/s2, g or mg. Some programs take g, and check nothing.
    #[arg(long, value_name = "UNIT", default_value = "m/s2", value_parser = force_unit)]
    output_accelerometer_unit: ImuUnit,
    /// Unit of the corrected gyroscope: rad/s, deg/s or mdps.
    #[arg(long, value_name = "UNIT", default_value = "rad/s", value_parser = rate_unit)]
    output_gyroscope_unit: ImuUnit,
    /// Where to write the corrected recording; `-` is standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

fn force_unit(text: &str) -> Result<ImuUnit, String> {
    physical(text, SensorKind::Accelerometer, "m/s2, g or mg")
}

fn rate_unit(text: &str) -> Result<ImuUnit, String> {
    physical(text, SensorKind::Gyroscope, "rad/s, deg/s or mdps")
}

/// A unit of corrected values.
fn physical(text: &str, sensor_kind: SensorKind, units: &str) -> Result<ImuUnit, String> {
    let unit = ImuUnit::parse(text)
        .filter(|unit| unit.suits(sensor_kind) && *unit != ImuUnit::Counts && unit.sensitivity().is_none());
    unit.ok_or_else(|| format!("corrected values of the {sensor_kind} are in {units}"))
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let inputs =
            [&self.calibration, &self.recording].into_iter().chain(&self.gyroscope).chain(&self.columns);
        ResultPlaces {
            directory: None,
            results: vec![self.output.clone()],
            inputs: inputs.cloned().chain(imu_tk_files(&self.calibration)).collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    for recording in std::iter::once(&arguments.recording).chain(&arguments.gyroscope) {
        check_not_corrected(recording)?;
    }
    let imu = arguments.content.read(&arguments.calibration, arguments.file.raw_units())?.imu;
    let correction = ImuCorrection::of(&imu)?;
    let mut recording = read(&imu, arguments)?;
    match arguments.temperature {
        Some(celsius) if correction.follows_temperature() => recording = recording.at_temperature(celsius),
        Some(_) => tell(SettingUnused::of(&["--temperature"], "the calibration has no temperature terms")),
        None => {}
    }
    let Applied { corrected, notes } =
        calibrant::apply(&imu, &recording).map_err(|error| error.in_recording(&arguments.recording))?;
    tell_all(&notes);
    let units = [arguments.output_accelerometer_unit, arguments.output_gyroscope_unit].into();
    write_corrected_recording(&arguments.output, &corrected, &file_name(&arguments.calibration), units)?;
    console::print(&format!("{}: {}\n", console::name(&arguments.calibration), in_words(&imu)));
    for (sensor_kind, found) in
        [(SensorKind::Accelerometer, &corrected.accelerometer), (SensorKind::Gyroscope, &corrected.gyroscope)]
    {
        if let Some(found) = found {
            console::print(&summary(sensor_kind, found));
        }
    }
    console::print_lines(&format!("{}\n", console::name(&arguments.output)));
    Ok(Exit::DONE)
}

/// Reads the recording, and prints the findings of its reader.
fn read(imu: &CalibratedImu, arguments: &Arguments) -> calibrant::Result<ImuRecording> {
    let options = arguments.file.with_columns(arguments.columns.as_deref())?;
    let gyroscope = arguments.gyroscope.as_ref().map(Readings::file);
    let source = Source { gyroscope, ..Source::from_file(&arguments.recording) };
    let file = read_for_correction(imu, &source, &options)?;
    let second = arguments.gyroscope.as_ref().map(|path| path.display().to_string());
    tell_all(&file.findings_in(&arguments.recording.display().to_string(), second.as_deref()));
    Ok(file.recording)
}

/// Number of samples, mean magnitude and uncertainty of one sensor.
fn summary(sensor_kind: SensorKind, corrected: &CorrectedSensor<'_>) -> String {
    let unit = sensor_kind.stimulus_unit().symbol();
    let samples = corrected.values.len();
    let mean = corrected.values.iter().map(|value| value.norm()).sum::<f64>() / samples.max(1) as f64;
    let mut text = format!(
        "  {sensor_kind}: {} samples, mean magnitude {} {unit}\n",
        number_format::count(samples),
        number_format::significant(mean, 6)
    );
    if let Some(sd) = &corrected.sd {
        let largest = |axis: usize| sd.iter().map(|sd| sd[axis]).fold(0.0, f64::max);
        let largest: Vec<_> = (0..3).map(|axis| number_format::significant(largest(axis), 2)).collect();
        text.push_str(&format!(
            "  largest standard uncertainty of the correction: {} {unit}\n",
            largest.join(", ")
        ));
    } else {
        text.push_str("  its uncertainty is not known: the calibration has no covariance for it\n");
    }
    text
}

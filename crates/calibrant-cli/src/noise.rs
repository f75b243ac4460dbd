//! `calibrant noise`: estimates the Allan deviation and the noise of a sensor at rest.

mod arguments;

pub(crate) use arguments::Arguments;

use crate::console;
use crate::diagnostics::{tell, tell_all};
use crate::exit::Exit;
use crate::recording_options::completed;
use arguments::Gains;
use calibrant::Error;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::noise::NoiseImpossible;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{ImuFile, Input, NoiseFile, ResultPlaces, file_name, to_json, write_json, write_text};
use calibrant::noise::SensorNoise;
use calibrant::report::{About, noise_sheet};
use calibrant::sensor::SensorKind;
use calibrant::session::{Readings, Source};
use calibrant::{NoiseAtRest, NoiseOptions, read_for_noise};
use nalgebra::Vector3;

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let Some(directory) = &self.output else { return ResultPlaces::default() };
        ResultPlaces {
            directory: Some(directory.clone()),
            results: ["noise.json", "report.html"].map(|name| directory.join(name)).to_vec(),
            inputs: std::iter::once(&self.recording)
                .chain(&self.gyroscope)
                .chain(&self.columns)
                .cloned()
                .collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let options = NoiseOptions {
        sensor: arguments.sensor.map(SensorKind::from),
        hold_s: arguments.hold.as_deref().and_then(|hold| Some((*hold.first()?, *hold.last()?))),
        gains: gains(arguments)?,
        ..NoiseOptions::default()
    };
    let reading = arguments.reading.options_of(options.sensor.unwrap_or(SensorKind::Accelerometer))?;
    let reading = completed(reading, arguments.columns.as_deref())?;
    let gyroscope = arguments.gyroscope.as_ref().map(Readings::file);
    let source = Source { gyroscope, ..Source::from_file(&arguments.recording) };
    let file = read_for_noise(&source, &reading, &options)?;
    let NoiseAtRest { sensors: noise, examined, failed } = calibrant::noise(&file.recording, &options)
        .map_err(|error| error.in_recording(&arguments.recording))?;
    let inputs = source.inputs(&file.sha256, &file.recording, noise[0].sensor_kind);
    let result = NoiseFile { noise: &noise, inputs: &inputs };

    let second = arguments.gyroscope.as_deref().map(file_name);
    tell_all(&file.findings_in(&file_name(&arguments.recording), second.as_deref()));
    if let Some((sensor_kind, error)) = &failed {
        tell(NoiseImpossible { sensor_kind: *sensor_kind, why: Phrase(error.to_string()) });
    }
    tell_all(noise.iter().flat_map(SensorNoise::diagnostics));
    let about = about(arguments, &file, &inputs, examined.clone());
    let sheet = noise_sheet(&noise, examined.as_deref(), &about);
    let page = arguments.output.as_ref().map(|directory| directory.join("report.html"));
    if let (Some(directory), Some(page)) = (&arguments.output, &page) {
        write_json(&directory.join("noise.json"), &result)?;
        write_text(page, &sheet.html())?;
    }
    console::result(arguments.json, || to_json(&result), &sheet, None, page.as_slice())?;
    Ok(Exit::DONE)
}

/// The head of the report.
fn about(arguments: &Arguments, file: &ImuFile, inputs: &[Input], examined: Option<String>) -> About {
    let of_inputs = |say: &dyn Fn(&Input) -> String| inputs.iter().map(say).collect::<Vec<_>>().join(", ");
    let paths = std::iter::once(&arguments.recording).chain(&arguments.gyroscope);
    let paths: Vec<String> = paths.map(|path| path.display().to_string()).collect();
    let hold = match (&arguments.hold, examined) {
        (Some(_), _) => "as given".into(),
        (None, Some(examined)) => examined,
        (None, None) => "the longest".into(),
    };
    About {
        title: format!("Noise from {}", of_inputs(&|input| input.file.clone())),
        facts: vec![
            ("Recording".into(), paths.join(", ")),
            ("SHA-256".into(), of_inputs(&|input| input.sha256.clone())),
            ("Samples".into(), of_inputs(&Input::samples_in_words)),
            ("Hold".into(), hold),
        ],
        findings: file.all_findings().map(ToString::to_string).collect(),
        ..About::default()
    }
}

/// The gains by sensor. `--gain` is that of `--sensor`, or of the accelerometer. `--gyroscope-gain` is the gyroscope's.
fn gains(arguments: &Arguments) -> calibrant::Result<Gains> {
    let asked = arguments.sensor.map_or(SensorKind::Accelerometer, SensorKind::from);
    let mut gains = Gains::new();
    for (option, given, sensor_kind) in [
        ("--gain", &arguments.gain, asked),
        ("--gyroscope-gain", &arguments.gyroscope_gain, SensorKind::Gyroscope),
    ] {
        let Some(gain) = gain(option, given)? else { continue };
        if gains.iter().any(|(other, _)| *other == sensor_kind) {
            let message = "--gain and --gyroscope-gain are both the gyroscope's with --sensor gyroscope";
            return Err(Error::Experiment(Box::new(InputError::new(
                Refusal::OptionsContradict,
                message,
                "omit one of them",
            ))));
        }
        gains.push((sensor_kind, gain));
    }
    Ok(gains)
}

fn gain(option: &str, given: &[f64]) -> calibrant::Result<Option<Vector3<f64>>> {
    let gain = match *given {
        [] => return Ok(None),
        [all] => Vector3::repeat(all),
        [x, y, z] => Vector3::new(x, y, z),
        _ => Vector3::zeros(),
    };
    if gain.iter().all(|gain| gain.is_finite() && *gain != 0.0) {
        return Ok(Some(gain.abs()));
    }
    Err(Error::Experiment(Box::new(InputError::new(
        Refusal::ValueInvalid,
        format!("{option} is one number or three, none of them zero"),
        format!("counts per m/s² or per rad/s: {option} 415,413,415"),
    ))))
}

//! `calibrant noise`: Allan deviation and noise of a sensor at rest.

mod holds;
mod read;
mod table;

use crate::reading::{in_file, name};
use crate::{Exit, console, place};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::io::{ImuUnit, Input, noise_json, write_atomically, write_noise};
use calibrant::noise::{Stretch, TriadNoise};
use calibrant::report::{About, noise_report, number};
use calibrant::sensor::Triad;
use nalgebra::Vector3;
use std::path::PathBuf;

/// Find the noise of a sensor at rest: Allan deviation, random walks, bias instability.
///
/// The longest hold of the recording is examined, or the interval of --hold. What the recording is too short to tell is reported as not
/// determined. Writes noise.json and report.html into DIR.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Recording, in any format that `calibrant inspect` knows, or of one sensor alone: columns t x y z.
    recording: PathBuf,
    /// What the columns are readings of.
    #[arg(long, value_enum, default_value = "accelerometer")]
    sensor: SensorKind,
    /// Unit of this sensor's readings where the file does not say: m/s2, g, rad/s, deg/s or counts.
    #[arg(long, value_parser = crate::reading::any_unit)]
    unit: Option<ImuUnit>,
    #[command(flatten)]
    reading: crate::reading::RecordingOptions,
    /// Experiment file whose [columns] say what is what.
    #[arg(long, value_name = "EXPERIMENT")]
    columns: Option<PathBuf>,
    /// Nominal gain in counts per m/s² or rad/s (one number or x,y,z): states the noise of readings in counts in SI and customary units.
    #[arg(long, value_name = "GAIN", value_delimiter = ',', num_args = 1..=3, allow_negative_numbers = true)]
    gain: Vec<f64>,
    /// Start and end of the interval at rest, s (default: the longest hold that is found).
    #[arg(long, num_args = 2, value_names = ["START", "END"], allow_negative_numbers = true)]
    hold: Option<Vec<f64>>,
    /// Print noise.json on stdout in place of the tables.
    #[arg(long)]
    json: bool,
    /// Directory for noise.json and report.html.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum SensorKind {
    Accelerometer,
    Gyroscope,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    if let Some(directory) = &arguments.output {
        place::check_directory(directory)?;
    }
    let gain = gain(&arguments.gain)?;
    let triad = match arguments.sensor {
        SensorKind::Accelerometer => Triad::Accelerometer,
        SensorKind::Gyroscope => Triad::Gyroscope,
    };
    let file = read::read(arguments, triad)?;
    let imu = &file.recording;
    let in_file = |error| in_file(error, &arguments.recording);
    let recording = imu.triad(triad).ok_or_else(|| in_file(no_sensor(triad)))?;
    let found = holds::holds(imu);
    let (holds, (start_s, end_s)) = match arguments.hold.as_deref() {
        Some(&[start, end]) => (found.unwrap_or_default(), (start, end)),
        _ => {
            let holds = found.map_err(in_file)?;
            let interval = holds::longest(&holds).map(|hold| (hold.start_s, hold.end_s)).map_err(in_file)?;
            (holds, interval)
        }
    };
    let stretch = Stretch::between(recording, start_s, end_s).map_err(in_file)?;
    let found = TriadNoise::of(triad, recording, stretch).map_err(in_file)?;
    let mut found = match &gain {
        Some(gain) => found.with_gain(recording, gain)?,
        None => found,
    };
    let examined = match arguments.hold {
        Some(_) => {
            if let Some(moving) = holds::moves(&holds, &found.stretch) {
                found.doubt = Some("the sensor moves in the interval that was given".into());
                found.warnings.push(moving);
            }
            None
        }
        None => holds::examined(&holds, &found.stretch, recording),
    };
    let input = Input {
        file: name(&arguments.recording),
        sha256: file.sha256.concat(),
        samples: recording.len(),
        rate_hz: recording.rate_hz(),
    };

    for finding in &file.findings {
        console::finding(&input.file, finding);
    }
    found.warnings.iter().for_each(|warning| console::warn(warning));
    let noise = [found];
    if arguments.json {
        console::print(&noise_json(&noise, &input));
    } else {
        console::print(&table::of(&noise[0], examined.as_deref()));
    }
    if let Some(directory) = &arguments.output {
        write_noise(&directory.join("noise.json"), &noise, &input)?;
        let about = About {
            title: format!("Noise from {}", input.file),
            facts: vec![
                ("Recording".into(), arguments.recording.display().to_string()),
                ("SHA-256".into(), input.sha256.clone()),
                (
                    "Samples".into(),
                    format!(
                        "{} at {} Hz",
                        number::count(input.samples),
                        number::significant(input.rate_hz, 5)
                    ),
                ),
                (
                    "Hold".into(),
                    match (&arguments.hold, examined) {
                        (Some(_), _) => "as given".into(),
                        (None, Some(examined)) => examined,
                        (None, None) => "the longest that was found".into(),
                    },
                ),
            ],
            findings: file.findings.iter().map(ToString::to_string).collect(),
            program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
            ..About::default()
        };
        let html = noise_report(&noise, &about);
        let page = directory.join("report.html");
        write_atomically(&page, |out| out.write_all(html.as_bytes()))?;
        if !arguments.json {
            console::print(&format!("{}\n", page.display()));
        }
    }
    Ok(Exit::DONE)
}

fn no_sensor(triad: Triad) -> Error {
    let complaint = Complaint::new(format!("the file has no {triad}"), "choose the other with --sensor");
    Error::Recording(Box::new(complaint))
}

fn gain(given: &[f64]) -> calibrant::Result<Option<Vector3<f64>>> {
    let gain = match *given {
        [] => return Ok(None),
        [all] => Vector3::repeat(all),
        [x, y, z] => Vector3::new(x, y, z),
        _ => Vector3::zeros(),
    };
    if gain.iter().all(|gain| gain.is_finite() && *gain != 0.0) {
        return Ok(Some(gain.abs()));
    }
    Err(Error::Experiment(Box::new(Complaint::new(
        "--gain is one number or three, none of them zero",
        "counts per m/s² or per rad/s: --gain 415,413,415",
    ))))
}

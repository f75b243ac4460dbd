//! `calibrant noise`: Allan deviation and noise of a sensor at rest.

mod read;
mod table;

use crate::reading::{in_file, name};
use crate::{Exit, console, place};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::{find_holds, find_imu_holds};
use calibrant::io::{ImuUnit, Input, noise_json, write_atomically, write_noise};
use calibrant::motion::Hold;
use calibrant::noise::{Stretch, TriadNoise};
use calibrant::report::{About, noise_report, number};
use calibrant::sensor::{ImuRecording, Recording, Triad};
use nalgebra::Vector3;
use std::path::PathBuf;

/// Shortest hold that is looked for, s.
const SHORTEST_HOLD_S: f64 = 1.0;
/// The finder of holds may cut off this much of a hold at each end, s.
const TRIMMED_S: f64 = 0.5;

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
    #[arg(long, value_name = "GAIN", value_delimiter = ',', num_args = 1..=3)]
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
    let (start_s, end_s) = match arguments.hold.as_deref() {
        Some(&[start, end]) => (start, end),
        _ => longest_hold(imu, recording).map_err(in_file)?,
    };
    let stretch = Stretch::between(recording, start_s, end_s).map_err(in_file)?;
    let found = TriadNoise::of(triad, recording, stretch).map_err(in_file)?;
    let mut found = match &gain {
        Some(gain) => found.with_gain(recording, gain)?,
        None => found,
    };
    if arguments.hold.is_some() {
        found.warnings.extend(moves(imu, recording, &found.stretch));
    }
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
        console::print(&table::of(&noise[0]));
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
                    if arguments.hold.is_some() {
                        "as given".into()
                    } else {
                        "the longest that was found".into()
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

/// The holds: where both sensors are still, or the one that was recorded. A gyroscope alone is as calm in a turn at a steady rate.
fn holds(imu: &ImuRecording, recording: &Recording) -> calibrant::Result<Vec<Hold>> {
    match (&imu.accelerometer, &imu.gyroscope) {
        (Some(_), Some(_)) => find_imu_holds(imu, SHORTEST_HOLD_S),
        _ => find_holds(recording, SHORTEST_HOLD_S),
    }
}

/// A warning where the sensor moves in an interval that was given as at rest: where that holds more than one hold, or more than a hold.
fn moves(imu: &ImuRecording, recording: &Recording, given: &Stretch) -> Option<String> {
    let holds = holds(imu, recording).ok().filter(|holds| !holds.is_empty())?;
    let within: Vec<&Hold> =
        holds.iter().filter(|hold| hold.end_s > given.start_s && hold.start_s < given.end_s).collect();
    let Some((first, last)) = within.first().zip(within.last()) else {
        return Some(moving(given.duration_s(), given));
    };
    let ends = [first.start_s - given.start_s, given.end_s - last.end_s];
    let between: f64 = within.windows(2).map(|pair| pair[1].start_s - pair[0].end_s).sum();
    let moving_s = between + ends.into_iter().filter(|end_s| *end_s > TRIMMED_S).sum::<f64>();
    (moving_s > 0.0).then(|| moving(moving_s, given))
}

fn moving(moving_s: f64, given: &Stretch) -> String {
    format!(
        "the sensor moves in {moving_s:.1} of the {:.1} s given with --hold, or is shaken: what follows is no noise of a sensor at rest (`calibrant inspect` shows how many \
         holds there are; without --hold the longest is taken)",
        given.duration_s()
    )
}

/// The longest hold.
fn longest_hold(imu: &ImuRecording, recording: &Recording) -> calibrant::Result<(f64, f64)> {
    let holds = holds(imu, recording)?;
    let longest = Hold::longest(&holds).map(|number| &holds[number]);
    longest.map(|hold| (hold.start_s, hold.end_s)).ok_or_else(|| {
        Error::Recording(Box::new(Complaint::new(
            format!("no hold of {SHORTEST_HOLD_S} s or more is found"),
            "noise needs the sensor at rest; if it was, give the interval with --hold START END",
        )))
    })
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

//! `calibrant inspect`: shows what a recording contains, and how good a calibration from it can be; or the joints of a machine.

mod machine;

mod reference_log;
mod sampling;

use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use crate::recording_options::RecordingOptions;
use calibrant::diagnostic::{Diagnostic, samples};
use calibrant::io::{
    FileFormat, HoldsInspection, ImuColumn, ImuFile, Inspection, InspectionFile, SensorInspection, file_name,
    inspect, read_imu_pair, read_imu_recording, to_json,
};
use calibrant::motion::Hold;
use calibrant::report::number_format::{count, counted, short, significant};
use calibrant::sensor::{Axis, ReadingUnit, Saturation, SensorKind, Spikes};
use std::path::{Path, PathBuf};

/// Largest number of characters of a column's name in the table.
const LONGEST_NAME: usize = 40;
/// Largest number of unused columns that are shown.
const MOST_COLUMNS: usize = 50;

/// Show what a recording, a log of a machine's motion, or a machine (.urdf) contains, before you calibrate from it.
///
/// Prints the format, the columns with units and use, sampling, gaps, saturation and ranges. Prints the holds, how their directions cover the
/// sphere, and the standard deviations to expect of a calibration of the accelerometer. Of a log of joints or poses it prints what was seen,
/// ranges, jumps, and whether the poses are an interpolation of a slower stream. Of a machine it prints the joints between base and tip with their limits,
/// and what is missing.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The recording: MT Manager, Movella DOT, EuRoC, imucal, CSV, ROS 2 MCAP, Parquet; or the accelerometer's file of a pair. A log of a motion: joints, RTDE, TUM, EuRoC's ground truth, MCAP. A machine (.urdf).
    file: PathBuf,
    /// The gyroscope's file of a pair (imu_tk).
    second: Option<PathBuf>,
    /// The gyroscope's file, as `calibrate` and `apply` take it.
    #[arg(long, value_name = "FILE", conflicts_with = "second")]
    gyroscope: Option<PathBuf>,
    #[command(flatten)]
    reading: RecordingOptions,
    /// Experiment file whose [columns] name the columns.
    #[arg(long, value_name = "EXPERIMENT")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    machine: machine::Options,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// The gyroscope's file of a pair.
    fn second(&self) -> Option<&Path> {
        self.second.as_deref().or(self.gyroscope.as_deref())
    }
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    if machine::is_machine(&arguments.file) {
        return arguments.machine.inspect(&arguments.file, arguments.json);
    }
    arguments.machine.refuse_for_recording()?;
    let options = arguments.reading.with_columns(arguments.columns.as_deref())?;
    let file = match arguments.second() {
        Some(second) => read_imu_pair(&arguments.file, second, &options)?,
        None => match read_imu_recording(&arguments.file, &options) {
            Err(_) if reference_log::is_one(&arguments.file, &options) => {
                return reference_log::run(&arguments.file, &options, arguments.json);
            }
            file => file?,
        },
    };
    let second = arguments.second().map(file_name);
    let found = file.findings_in(&file_name(&arguments.file), second.as_deref());
    tell_all(found.iter().filter(|found| found.is_warning()));
    let inspection = inspect(&file);
    let found = InspectionFile { file: &file, inspection: &inspection };
    console::json_or(arguments.json, || to_json(&found), || text(&file, &inspection, arguments));
    Ok(Exit::DONE)
}

fn text(file: &ImuFile, inspection: &Inspection, arguments: &Arguments) -> String {
    let mut text = files(file, arguments);
    for sensor in &inspection.sensors {
        text.push_str(&sampling::line(sensor.sensor_kind.name(), &sensor.sampling));
    }
    text.push_str(&ranges(&inspection.sensors));
    if let Some(temperature) = &file.recording.temperature_c {
        let least = temperature.iter().copied().fold(f64::INFINITY, f64::min);
        let most = temperature.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        text.push_str(&format!("  temperature from {} to {} °C\n", short(least), short(most)));
    }
    let of_sensor = |(sensor_kind, spikes): &(SensorKind, Spikes)| {
        let unit = file.recording.sensor(*sensor_kind)?.unit();
        Some(Diagnostic::from(samples::Spikes::of(spikes, *sensor_kind, unit)).to_string())
    };
    let spikes = inspection.spikes.iter().filter_map(of_sensor);
    let noticed: Vec<String> = file.all_findings().map(ToString::to_string).chain(spikes).collect();
    if !noticed.is_empty() {
        text.push_str("\nNoticed\n");
        noticed.iter().for_each(|finding| text.push_str(&format!("  {finding}\n")));
    }
    match &inspection.holds {
        Some(Ok(found)) => text.push_str(&holds(found, inspection)),
        Some(Err(why)) => text.push_str(&format!("\nNo search for holds: {why}\n")),
        None => text.push_str("\nWithout an accelerometer there are no holds.\n"),
    }
    text
}

/// Each file with its columns.
fn files(file: &ImuFile, arguments: &Arguments) -> String {
    let one = |path: &Path, format: FileFormat, rows: usize, of: &[ImuColumn]| {
        format!("{}: {}, {} rows\n\n{}", path.display(), format.description(), count(rows), columns(of))
    };
    let of_second = file.second.as_ref().map_or(0, |second| second.columns);
    let (first, second) = file.columns.split_at(file.columns.len() - of_second);
    let mut text = one(&arguments.file, file.format, file.rows, first);
    if let (Some(found), Some(path)) = (&file.second, arguments.second()) {
        text.push_str(&one(path, found.format, found.rows, second));
    }
    text
}

fn columns(columns: &[ImuColumn]) -> String {
    let name = |name: &str| match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    };
    let row = |column: &ImuColumn| {
        vec![
            name(&column.name),
            column.meaning.to_string(),
            column.unit.map_or("–", |unit| unit.symbol()).to_owned(),
            column.unused.as_deref().map_or_else(|| "used".to_owned(), |why| format!("not used: {why}")),
        ]
    };
    let shown = |(k, column): &(usize, &ImuColumn)| *k < MOST_COLUMNS || column.is_used();
    let rows: Vec<_> = columns.iter().enumerate().filter(shown).map(|(_, column)| row(column)).collect();
    let more = match columns.len() - rows.len() {
        0 => String::new(),
        more => format!("  and {} that are not used\n", counted(more, "more column")),
    };
    console::table(&["column", "meaning", "unit", ""], &rows) + &more + "\n"
}

fn ranges(sensors: &[SensorInspection]) -> String {
    let row = |sensor: &SensorInspection, axis: Axis| {
        let cell = |value: f64| significant(value, 5);
        let k = axis.index();
        vec![
            format!("{} {axis}", sensor.sensor_kind),
            cell(sensor.least[k]),
            cell(sensor.mean[k]),
            cell(sensor.most[k]),
            sensor.unit.symbol().to_owned(),
        ]
    };
    let rows: Vec<_> = sensors.iter().flat_map(|sensor| Axis::ALL.map(|axis| row(sensor, axis))).collect();
    format!("\n{}", console::table(&["readings", "least", "mean", "most", "unit"], &rows))
}

fn holds(found: &HoldsInspection, inspection: &Inspection) -> String {
    let total: f64 = found.holds.iter().map(Hold::duration_s).sum();
    let longest = Hold::longest(&found.holds).map_or(0.0, |number| found.holds[number].duration_s());
    let mut text = match found.holds.len() {
        0 => "\nNo holds found: the sensor is never at rest for a second.\n".to_owned(),
        n => format!(
            "\n{n} hold{} found, {} s altogether, the longest {} s\n",
            if n == 1 { "" } else { "s" },
            short((total * 10.0).round() / 10.0),
            short((longest * 10.0).round() / 10.0)
        ),
    };
    if let Some(lost) = &found.lost {
        text.push_str(&format!("  {lost}\n"));
    }
    for axis in Axis::ALL {
        let cut = |end: &Option<Saturation>| end.is_some_and(|end| end.axis == axis);
        let numbers: Vec<String> = (1..)
            .zip(&found.clipped)
            .filter(|(_, end)| cut(end))
            .map(|(number, _)| number.to_string())
            .collect();
        if !numbers.is_empty() {
            text.push_str(&format!(
                "  the accelerometer's axis {axis} saturates in hold{} {}: not counted here, and not used in a calibration\n",
                if numbers.len() == 1 { "" } else { "s" },
                numbers.join(", ")
            ));
        }
    }
    for (sensor_kind, coarse) in &found.coarse {
        let of_kind = |sensor: &&SensorInspection| sensor.sensor_kind == *sensor_kind;
        let Some(sensor) = inspection.sensors.iter().find(of_kind) else { continue };
        text.push_str(&format!("  {}\n", coarse.check(*sensor_kind, sensor.unit).finding()));
    }
    if let Some(coverage) = &found.coverage {
        let missing: Vec<String> = Axis::ALL
            .into_iter()
            .flat_map(|axis| {
                [("+", 0), ("−", 1)]
                    .map(|(sign, k)| (format!("{sign}{axis}"), coverage.axes[axis.index()][k]))
            })
            .filter_map(|(name, there)| (!there).then_some(name))
            .collect();
        text.push_str(&format!(
            "  directions: the largest gap is {}° from the nearest hold, at {}{}\n",
            significant(coverage.gap_rad.to_degrees(), 2),
            direction(&coverage.emptiest),
            if missing.is_empty() {
                String::new()
            } else {
                format!("; no hold within 30° of {}", missing.join(", "))
            }
        ));
    }
    if let (Some((mean, noise)), Some(gyroscope)) = (
        &found.gyroscope_at_rest,
        inspection.sensors.iter().find(|sensor| sensor.sensor_kind == SensorKind::Gyroscope),
    ) {
        let list = |v: &nalgebra::Vector3<f64>, digits| {
            v.iter().map(|x| significant(*x, digits)).collect::<Vec<_>>().join(", ")
        };
        text.push_str(&format!(
            "  gyroscope in the holds: mean {}, noise of one sample {} {}\n",
            list(mean, 5),
            list(noise, 2),
            gyroscope.unit.symbol()
        ));
    }
    match &found.expected {
        Ok(expected) => {
            let (sd, relative) = (expected.sd(), expected.relative_sd());
            let in_counts = expected.unit == ReadingUnit::Counts;
            let rows: Vec<_> = expected
                .list
                .quantities()
                .iter()
                .enumerate()
                .map(|(k, quantity)| {
                    let si = if k < 3 {
                        format!("{} m/s²", significant(relative[k], 2))
                    } else {
                        format!("{} %", significant(100.0 * relative[k], 2))
                    };
                    let own = if in_counts {
                        format!("{} {}", significant(sd[k], 2), quantity.unit(expected.unit))
                    } else {
                        String::new()
                    };
                    vec![quantity.name(), si, own]
                })
                .collect();
            text.push_str("\nExpected standard deviations of the accelerometer (upper gauge, full model), from noise alone\n");
            text.push_str(&console::table(&["parameter", "sd", ""], &rows));
            text.push_str(&format!(
                "  condition number {}; scatter between holds adds to these, and `calibrate` estimates it\n",
                significant(expected.condition_number, 3)
            ));
        }
        Err(why) => text.push_str(&format!("\nThe holds do not determine the accelerometer: {why}\n")),
    }
    text
}

fn direction(unit: &nalgebra::Vector3<f64>) -> String {
    format!("({:+.1}, {:+.1}, {:+.1})", unit.x, unit.y, unit.z)
}

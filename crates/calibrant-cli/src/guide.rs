//! `calibrant guide`: calibrates at the bench, while the samples come.

use crate::diagnostics::rules;
use crate::exit::Exit;
use crate::{console, interruption};
use calibrant::io::{ResultPlaces, SensorNaming};
use calibrant::session::SessionOptions;
use calibrant_guide::{GuideOptions, Input, guide};
use std::path::PathBuf;

/// The experiment without a file.
const DEFAULT: &str = "imu";

/// Guide a calibration by hand, live: what to do next, and when it is good enough.
///
/// Samples come as lines of text from a serial port, over the network, or from standard input: a header once and then rows, as in any recording, `name:value` pairs, or a JSON
/// object for each sample. Hold the sensor still in any orientation; each hold is followed by a calibration of all so far, and by the pose that would help most.
/// The page shows both; --terminal prints them. It is good enough when each standard deviation of [accept] is reached (usual ones without it) in two holds in a row, and
/// parts of the recording agree, and the verdict is ok.
///
/// Every row is in DIR/recording.csv before it is used. At the end, DIR has what `calibrant calibrate EXPERIMENT DIR/recording.csv` writes: calibration.json and report.html.
///
/// calibrant guide --demo
///
/// calibrant guide imu.toml --from serial:/dev/ttyUSB0:115200 -o session
///
/// mosquitto_sub -t imu | calibrant guide imu.toml --from - -o session
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file, with [holds] (default: the preset imu; see `calibrant init`).
    experiment: Option<PathBuf>,
    #[command(flatten)]
    settings: crate::experiment_settings::Settings,
    /// Where samples come from: serial:PORT:BAUD, udp:HOST:PORT, tcp:HOST:PORT, - (standard input), replay:FILE@SPEED, demo.
    #[arg(long, value_name = "INPUT", required_unless_present = "demo", conflicts_with = "demo")]
    from: Option<String>,
    /// A simulated board in a simulated hand, three times as fast as a person: the same as --from demo.
    #[arg(long)]
    demo: bool,
    /// Names of the columns, if the stream has no header: t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    #[command(flatten)]
    reading: crate::recording_options::RecordingOptions,
    /// The sensor, as calibration.json names it (default: recording).
    #[arg(long, value_name = "ID")]
    sensor: Option<String>,
    /// The station.
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
    /// Address of the page. Others than 127.0.0.1 open it to the network.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:8765")]
    listen: String,
    /// Serve no page; needs --terminal.
    #[arg(long, requires = "terminal")]
    no_page: bool,
    /// Print what the page shows, as lines of 80 columns.
    #[arg(long)]
    terminal: bool,
    /// Go on with the session in DIR.
    #[arg(long)]
    resume: bool,
    /// End as soon as it is good enough, or as six holds more do not make it so.
    #[arg(long)]
    stop: bool,
    /// Folder of the session.
    #[arg(short, long, value_name = "DIR", default_value = "calibrant-session")]
    output: PathBuf,
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let names = ["calibration.json", "report.html"];
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: names.map(|name| self.output.join(name)).to_vec(),
            inputs: self.experiment.iter().cloned().collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = arguments.settings.read_or(arguments.experiment.as_deref(), DEFAULT)?;
    let input = Input::parse(arguments.from.as_deref().unwrap_or("demo"))?;
    let options = GuideOptions {
        experiment,
        session: SessionOptions {
            experiment_file: arguments.experiment.clone().unwrap_or_else(|| "imu.toml".into()),
            reading: arguments.reading.options()?,
            allowed: rules().allowed().to_vec(),
            naming: SensorNaming {
                sensor: arguments.sensor.clone(),
                station: arguments.station.clone(),
                ..SensorNaming::default()
            },
            ..SessionOptions::default()
        },
        columns: arguments.columns.clone(),
        input,
        directory: arguments.output.clone(),
        resume: arguments.resume,
        listen: (!arguments.no_page).then(|| arguments.listen.clone()),
        terminal: arguments.terminal,
        stop_when_good: arguments.stop,
        interruption: interruption::keeping_the_best(),
    };
    let said = |address: &str| eprintln!("The page: {address}");
    let outcome = guide(options, &said)?;
    let verdict = outcome.verdict();
    let files = ["report.html", "calibration.json", "recording.csv"].map(|name| arguments.output.join(name));
    console::result(false, String::new, &outcome.sheet(), None, &files)?;
    Ok(rules().exit_of(&verdict))
}

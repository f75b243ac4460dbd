//! What the page of a batch shows of each recording.

use super::quality;
use super::result::{BatchResults, BatchRow};
use super::run::Batch;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::diagnostic::{Code, Diagnostic, Severity};
use calibrant_core::sensor::{Parameter, ParameterList, Sensor};
use calibrant_io::{Finished, SummaryParameter};
use calibrant_report::{About, Batch as Page, BatchParameter, BatchSensor};

impl Batch {
    /// The recordings with their folders, as [`batch_sheet`](crate::report::batch_sheet) takes them, without those that an interruption left. The first result names the parameters.
    #[must_use]
    pub fn page(&self, results: &BatchResults) -> Page {
        let experiment = self.session().experiment();
        let named = results.rows.iter().find_map(|row| row.outcome.as_ref().ok());
        let named = named.map_or(&[][..], |kept| kept.finished.summary.parameters());
        let datasheet = datasheet(&experiment.sensor);
        let limits = self.session().limits();
        Page {
            parameters: named.iter().map(|of| parameter(of, &datasheet, limits)).collect(),
            quality: quality::columns(experiment).iter().map(|column| (*column).to_owned()).collect(),
            sensors: results
                .rows
                .iter()
                .filter(|row| !row.is_interrupted())
                .map(|row| self.sensor(row, named))
                .collect(),
        }
    }

    /// The head of the page.
    #[must_use]
    pub fn about(&self) -> About {
        let (options, count) = (self.session().options(), self.sources().len());
        let mut facts = vec![
            ("Experiment".to_owned(), options.experiment_file.display().to_string()),
            ("Recordings".to_owned(), count.to_string()),
        ];
        let motion = options.motion.as_ref().map(|motion| motion.path().display().to_string());
        facts.extend(motion.map(|motion| ("Motion".to_owned(), motion)));
        About { title: format!("Batch of {count} sensors"), facts, ..About::default() }
    }

    fn sensor(&self, row: &BatchRow, named: &[SummaryParameter]) -> BatchSensor {
        let options = self.session().options();
        let mut codes: Vec<Code> = Vec::new();
        for code in row.told().iter().map(Diagnostic::code) {
            let counts = code.severity() >= Severity::Warning && !options.allowed.contains(&code);
            if counts && !codes.contains(&code) {
                codes.push(code);
            }
        }
        let folder = &row.folder;
        // what is named of a recording that failed
        let named_by_path = || options.naming.of(&row.recording).ok();
        match &row.outcome {
            Ok(kept) => {
                let summary = &kept.finished.summary;
                let file = if options.report { "report.html" } else { "calibration.json" };
                let estimate = |column: &SummaryParameter| {
                    let found = summary.parameters().iter().find(|of| of.name == column.name);
                    found.map_or((f64::NAN, f64::NAN), |of| (of.value, of.sd))
                };
                let decides = |found: &&Diagnostic| summary.verdict().codes.contains(&found.code());
                let deciding = row.told().iter().filter(decides);
                let Finished { sensor, station, recorded, .. } = &kept.finished;
                BatchSensor {
                    name: self.name(folder, sensor.as_deref()),
                    link: Some(format!("{folder}/{file}")),
                    station: station.clone(),
                    recorded: recorded.clone(),
                    verdict: Ok(summary.verdict().clone()),
                    quality: kept.finished.cells.clone(),
                    codes,
                    limits_failed: summary.limits_failed().to_vec(),
                    reasons: deciding.map(Diagnostic::without_file).collect(),
                    estimates: named.iter().map(estimate).collect(),
                }
            }
            Err(error) => BatchSensor {
                name: self.name(folder, named_by_path().as_ref().map(|named| named.sensor.as_str())),
                link: row.has_failure_page.then(|| format!("{folder}/report.html")),
                station: named_by_path().and_then(|named| named.station),
                recorded: named_by_path().and_then(|named| named.recorded).map(|time| time.to_string()),
                verdict: Err(error.code()),
                quality: Vec::new(),
                codes,
                limits_failed: Vec::new(),
                reasons: vec![error.to_string()],
                estimates: Vec::new(),
            },
        }
    }
}

impl Batch {
    /// The name of a sensor on the page: its folder, after the name that the user gives it, where the folder does not have it.
    fn name(&self, folder: &str, sensor: Option<&str>) -> String {
        let given = sensor.filter(|_| self.session().options().naming.names_sensors());
        match given.filter(|name| !folder.contains(*name)) {
            Some(name) => format!("{name} ({folder})"),
            None => folder.to_owned(),
        }
    }
}

/// What the datasheet says of the accelerometer. The results of an IMU or on a machine do not repeat it.
fn datasheet(sensor: &Sensor) -> Vec<Parameter> {
    let list = ParameterList::new(sensor.axes, sensor.model);
    sensor.nominal().map_or_else(Vec::new, |nominal| list.describe_accelerometer(sensor, &nominal))
}

fn parameter(of: &SummaryParameter, datasheet: &[Parameter], limits: &[AcceptanceLimit]) -> BatchParameter {
    let is_same = |one: &&Parameter| one.name == of.name && one.unit == of.unit;
    let of_datasheet = datasheet.iter().find(is_same).filter(|_| of.spread.is_none());
    let (nominal, spread) =
        of_datasheet.map_or((of.nominal, of.spread), |known| (known.nominal, known.spread));
    let ranges = limits.iter().filter(|limit| limit.names(&of.name)).filter_map(|limit| limit.range);
    BatchParameter {
        name: of.name.clone(),
        unit: of.unit,
        nominal,
        spread,
        // all limits are to be kept
        accepted: ranges.reduce(|one, other| (one.0.max(other.0), one.1.min(other.1))),
    }
}

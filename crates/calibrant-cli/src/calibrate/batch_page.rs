//! What the page of a batch shows of each recording.

use super::job::Job;
use super::quality;
use super::recorded::Recorded;
use crate::console;
use crate::diagnostics::rules;
use calibrant::acceptance::AcceptanceLimit;
use calibrant::diagnostic::{Code, Diagnostic, Severity};
use calibrant::io::SummaryParameter;
use calibrant::report::{Batch, BatchParameter, BatchSensor};
use calibrant::sensor::{Parameter, ParameterList, Sensor};

/// The recordings of a batch with their folders. The first result names the parameters.
pub(super) fn batch_of(job: &Job<'_>, folders: &[String], recorded: &[Recorded]) -> Batch {
    let named = recorded.iter().find_map(|of| of.outcome.as_ref().ok());
    let named = named.map_or(&[][..], |kept| kept.finished.summary.parameters());
    let sensors = folders.iter().zip(recorded).map(|(folder, of)| sensor(job, folder, of, named)).collect();
    let datasheet = datasheet(&job.experiment.sensor);
    let parameters = named.iter().map(|of| parameter(of, &datasheet, &job.limits)).collect();
    let quality = quality::columns(job.experiment).iter().map(|column| (*column).to_owned()).collect();
    Batch { parameters, quality, sensors }
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

fn sensor(job: &Job<'_>, folder: &str, recorded: &Recorded, named: &[SummaryParameter]) -> BatchSensor {
    let allowed = rules().allowed();
    let mut codes: Vec<Code> = Vec::new();
    for code in recorded.told().iter().map(Diagnostic::code) {
        if code.severity() >= Severity::Warning && !allowed.contains(&code) && !codes.contains(&code) {
            codes.push(code);
        }
    }
    let name = folder.to_owned();
    match &recorded.outcome {
        Ok(kept) => {
            let (summary, file) = (&kept.finished.summary, job.arguments.main_file());
            let estimate = |column: &SummaryParameter| {
                let found = summary.parameters().iter().find(|of| of.name == column.name);
                found.map_or((f64::NAN, f64::NAN), |of| (of.value, of.sd))
            };
            let decides = |found: &&Diagnostic| summary.verdict().codes.contains(&found.code());
            let deciding = recorded.told().iter().filter(decides);
            BatchSensor {
                name,
                link: Some(format!("{folder}/{file}")),
                verdict: Ok(summary.verdict().clone()),
                quality: kept.finished.cells.clone(),
                codes,
                limits_failed: summary.limits_failed().to_vec(),
                reasons: deciding.map(Diagnostic::without_file).collect(),
                estimates: named.iter().map(estimate).collect(),
            }
        }
        Err(error) => BatchSensor {
            name,
            link: None,
            verdict: Err(error.code()),
            quality: Vec::new(),
            codes,
            limits_failed: Vec::new(),
            reasons: vec![console::as_flags(&error.to_string())],
            estimates: Vec::new(),
        },
    }
}

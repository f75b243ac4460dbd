//! A row of a data set: a calibration as columns, from which its record comes back to the last bit.

use crate::model::{self, Further};
use crate::record::{KeptVerdict, Record};
use calibrant_core::diagnostic::Usability;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::SharedErrors;
use calibrant_io::{Checked, HashedFile, Input, UtcTime};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// A calibration as the columns of a data set.
///
/// `names` to `covariance` have all parameters, also those of a machine. The `model` has what calibrations of one kind of sensor share, with zero in place of each estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DatasetRow {
    /// The sensor.
    pub sensor: String,
    /// When the recording was made, UTC.
    pub recorded: Option<UtcTime>,
    /// Where it was made.
    pub station: Option<String>,
    /// `motion`, `holds` or `machine`.
    pub plan: String,
    /// The program with its version.
    pub program: String,
    /// Name of the experiment's file.
    pub experiment: Option<String>,
    /// SHA-256 of the experiment.
    pub experiment_sha256: Option<String>,
    /// Name of the file of the motion.
    pub motion: Option<String>,
    /// SHA-256 of the motion.
    pub motion_sha256: Option<String>,
    /// Names of the recording's files, with slashes between them.
    pub recording: String,
    /// SHA-256 of each, with blanks between them.
    pub recording_sha256: String,
    /// May it be used?
    pub verdict: Usability,
    /// Codes of the diagnostics that decide.
    pub codes: Vec<String>,
    /// How the estimation ended.
    pub status: String,
    /// χ² of the fit.
    pub chi2: Option<f64>,
    /// Degrees of freedom of the fit.
    pub degrees_of_freedom: Option<f64>,
    /// Probability of a larger χ².
    pub p_value: Option<f64>,
    /// Samples of the recording's first sensor.
    pub samples: Option<usize>,
    /// Its sample rate, Hz.
    pub rate_hz: Option<f64>,
    /// Names of the parameters.
    pub names: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// Their standard deviations.
    pub sd: Vec<Option<f64>>,
    /// The lower triangle of their covariance, by rows.
    pub covariance: Option<Vec<f64>>,
    /// The text of the model.
    pub model: String,
    /// Reference of the temperature terms, °C.
    pub reference_c: Option<f64>,
    /// Least and greatest temperature of the recording, °C, where there are temperature terms.
    pub range_c: Option<[f64; 2]>,
    /// Degrees of freedom behind the covariance: accelerometer, gyroscope at rest, matrix of the gyroscope; `None` where they are infinite.
    pub covariance_degrees: Option<[Option<f64>; 3]>,
    /// What is not exactly known of the place, where there is something. Data sets of earlier versions have neither this nor the next column.
    pub shared_sources: Option<Vec<String>>,
    /// What one standard deviation of each source does to the sensor's parameters: by rows, one for each of them.
    pub shared_root: Option<Vec<f64>>,
}

/// What a row has of a `calibration.json` beside its record.
#[derive(Deserialize)]
struct Numbers {
    #[serde(default)]
    fit: Fit,
    inputs: Vec<Input>,
    parameters: Vec<Parameter>,
    covariance: Option<Vec<Vec<f64>>>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Fit {
    chi2: Option<f64>,
    degrees_of_freedom: Option<f64>,
    p_value: Option<f64>,
}

#[derive(Deserialize)]
struct Parameter {
    name: String,
    unit: String,
    value: f64,
    sd: Option<f64>,
}

impl DatasetRow {
    /// The row of the text of a `calibration.json`.
    ///
    /// # Errors
    /// As [`Record::parse`].
    pub fn parse(text: &str) -> Result<Self> {
        let record = Record::parse(text)?;
        let numbers: Numbers =
            serde_json::from_str(text).map_err(|error| Error::experiment(unfit(error.to_string())))?;
        Ok(Self::of(record, numbers))
    }

    fn of(record: Record, numbers: Numbers) -> Self {
        let further = Further::of(&record.imu);
        let shared = further
            .shared
            .map(|SharedErrors { sources, root }| (sources, root.transpose().as_slice().to_vec()));
        let (shared_sources, shared_root) = shared.unzip();
        let (recording, recording_sha256) = (record.names().join("/"), record.recording_sha256());
        let split = |file: Option<HashedFile>| file.map(|file| (file.file, file.sha256)).unzip();
        let (experiment, experiment_sha256) = split(record.experiment);
        let (motion, motion_sha256) = split(record.motion_file);
        let input = numbers.inputs.first();
        let parameters = &numbers.parameters;
        Self {
            sensor: record.sensor,
            recorded: record.recorded,
            station: record.station,
            plan: record.plan,
            program: record.program,
            experiment,
            experiment_sha256,
            motion,
            motion_sha256,
            recording,
            recording_sha256,
            verdict: record.verdict.usability,
            codes: record.verdict.codes,
            status: record.status,
            chi2: numbers.fit.chi2,
            degrees_of_freedom: numbers.fit.degrees_of_freedom,
            p_value: numbers.fit.p_value,
            samples: input.map(|input| input.samples),
            rate_hz: input.map(|input| input.rate_hz),
            names: parameters.iter().map(|of| of.name.clone()).collect(),
            units: parameters.iter().map(|of| of.unit.clone()).collect(),
            values: parameters.iter().map(|of| of.value).collect(),
            sd: parameters.iter().map(|of| of.sd).collect(),
            covariance: numbers.covariance.map(|rows| triangle(&rows)),
            model: model::text_of(&record.imu),
            reference_c: further.reference_c,
            range_c: further.range_c,
            covariance_degrees: further.degrees.map(|of| of.map(|of| Some(of).filter(|of| of.is_finite()))),
            shared_sources,
            shared_root,
        }
    }

    /// The record of the row.
    ///
    /// # Errors
    /// The columns do not fit together.
    pub fn into_record(self) -> Checked<Record> {
        let model = model::read(&self.model).ok_or_else(|| unfit("`model` cannot be read".to_owned()))?;
        let place = |name: String| -> Checked<usize> {
            let place = self.names.iter().position(|listed| *listed == name);
            place.ok_or_else(|| unfit(format!("{name} is in `model` and not in `names`")).into())
        };
        let places: Vec<usize> =
            model.quantities.iter().map(|of| place(of.name())).collect::<Checked<_>>()?;
        let size = self.names.len();
        let triangle = self.covariance.as_ref();
        if self.values.len() != size || triangle.is_some_and(|of| of.len() != size * (size + 1) / 2) {
            return Err(unfit(format!("{size} `names` do not fit `values` and `covariance`")).into());
        }
        let entry = |triangle: &Vec<f64>| {
            let at = |i: usize, j: usize| triangle[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
            let rows = places.iter().enumerate();
            rows.flat_map(|(k, i)| places[..=k].iter().map(move |j| at(*i, *j))).collect()
        };
        let shared = match (self.shared_sources, self.shared_root) {
            (Some(sources), Some(root)) if root.len() == places.len() * sources.len() => Some(SharedErrors {
                root: DMatrix::from_row_slice(places.len(), sources.len(), &root),
                sources,
            }),
            (None, None) => None,
            _ => {
                return Err(
                    unfit("`shared_root` does not fit `shared_sources` and `model`".to_owned()).into()
                );
            }
        };
        let further = Further {
            reference_c: self.reference_c,
            range_c: self.range_c,
            degrees: self.covariance_degrees.map(|of| of.map(|of| of.unwrap_or(f64::INFINITY))),
            covariance: triangle.map(entry),
            shared,
        };
        let estimates: Vec<f64> = places.iter().map(|place| self.values[*place]).collect();
        let imu = further.onto(&model, &estimates).ok_or_else(|| unfit("`model` does not fit".to_owned()))?;
        let file = |(file, sha256): (String, String)| HashedFile { file, sha256 };
        let files = self.recording.split('/').zip(self.recording_sha256.split(' '));
        Ok(Record {
            sensor: self.sensor,
            recorded: self.recorded,
            station: self.station,
            plan: self.plan,
            experiment: self.experiment.zip(self.experiment_sha256).map(file),
            motion_file: self.motion.zip(self.motion_sha256).map(file),
            recordings: files.map(|(name, sha256)| file((name.to_owned(), sha256.to_owned()))).collect(),
            verdict: KeptVerdict { usability: self.verdict, codes: self.codes },
            status: self.status,
            program: self.program,
            imu,
        })
    }
}

fn triangle(rows: &[Vec<f64>]) -> Vec<f64> {
    rows.iter().enumerate().flat_map(|(i, row)| row.iter().take(i + 1).copied()).collect()
}

/// The error for columns that are not those of a calibration.
pub(super) fn unfit(message: String) -> InputError {
    let help = "give a data set that `calibrant.fleet.calibrate` of this version wrote";
    InputError::new(Refusal::CalibrationInvalid, message, help)
}

//! Calibrations of any format: read, written, compared, and applied to arrays.

use crate::arrays::{Numbers, as_table, list, vectors};
use crate::failure::{invalid, raised};
use crate::options::parsed;
use crate::page::{Page, page};
use crate::work::{at_once, run};
use calibrant::error::{InputError, Refusal};
use calibrant::estimate::{Comparison, Place};
use calibrant::io::{
    CalibratedImuFile, ComparisonFile, ConventionOptions, ImuFormat, RawUnits, calibrated_imu_texts,
    edit_calibrated_imu, parse_calibrated_imu, read_calibrated_imu, to_json, write_calibrated_imu,
};
use calibrant::report::comparison_sheet;
use calibrant::sensor::{
    CalibratedImu, Gauge, ImuCorrection, ImuPart, ImuRecording, Recording, SensorKind, WORKING_C,
};
use calibrant::{Conversion, Error, Result};
use nalgebra::{Matrix3, Vector3};
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::json;
use std::path::PathBuf;

#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Convention {
    format: Option<String>,
    unit: Option<String>,
    sensor: Option<String>,
}

impl Convention {
    fn options(&self) -> Result<ConventionOptions> {
        let refused =
            |what: &str, text: &str, help: &str| Err(invalid(format!("`{what}` is {text:?}"), help));
        Ok(ConventionOptions {
            format: self.format.as_deref().map(format).transpose()?,
            units: match self.unit.as_deref() {
                None => None,
                Some("si") => Some(RawUnits::Si),
                Some("counts") => Some(RawUnits::Counts),
                Some(other) => return refused("unit", other, "readings are in \"si\" or \"counts\""),
            },
            sensor_kind: self.sensor.as_deref().map(sensor).transpose()?,
        })
    }
}

/// What is changed of a calibration that is written.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Changes {
    format: Option<String>,
    gauge: Option<String>,
    after: Option<PathBuf>,
    noise: Vec<PathBuf>,
    drop: Vec<String>,
    rostopic: Option<String>,
    update_rate: Option<f64>,
    into: bool,
    sensor: Option<String>,
    temperature_c: Option<f64>,
}

impl Changes {
    fn conversion(self) -> Result<Conversion> {
        if let Some(celsius) = self.temperature_c.filter(|celsius| !WORKING_C.contains(celsius)) {
            let help = format!("give °C from {} to {}", WORKING_C.start(), WORKING_C.end());
            return Err(invalid(format!("`temperature_c` is {celsius}"), help));
        }
        Ok(Conversion {
            path: None,
            after: self.after,
            noise: self.noise,
            drop: self.drop.iter().map(|name| part(name)).collect::<Result<_>>()?,
            rostopic: self.rostopic,
            update_rate_hz: self.update_rate,
            sensor: self.sensor.as_deref().map(sensor).transpose()?,
            temperature_c: self.temperature_c,
            gauge: self.gauge.as_deref().map(gauge).transpose()?,
        })
    }
}

fn sensor(name: &str) -> Result<SensorKind> {
    match name {
        "accelerometer" => Ok(SensorKind::Accelerometer),
        "gyroscope" => Ok(SensorKind::Gyroscope),
        other => Err(invalid(format!("`sensor` is {other:?}"), "give \"accelerometer\" or \"gyroscope\"")),
    }
}

fn format(name: &str) -> Result<ImuFormat> {
    let help = || format!("the formats are {}", ImuFormat::names(false));
    ImuFormat::by_name(name).ok_or_else(|| invalid(format!("`format` is {name:?}"), help()))
}

fn part(name: &str) -> Result<ImuPart> {
    let help = || format!("the parts are {}", ImuPart::ALL.map(ImuPart::name).join(", "));
    ImuPart::by_name(name).ok_or_else(|| invalid(format!("`drop` has {name:?}"), help()))
}

fn gauge(name: &str) -> Result<Gauge> {
    match name {
        "lower" => Ok(Gauge::Lower),
        "upper" => Ok(Gauge::Upper),
        "symmetric" => Ok(Gauge::Symmetric),
        other => Err(invalid(format!("`gauge` is {other:?}"), "the gauges are lower, upper and symmetric")),
    }
}

fn of_json(text: &str) -> Result<CalibratedImuFile> {
    parse_calibrated_imu(text.as_bytes(), &ConventionOptions::default())
}

/// Reads a calibration of any format: the text of a calibration of ours, and what was noticed.
#[pyfunction]
pub(crate) fn read_calibration(py: Python<'_>, path: PathBuf, options: &str) -> PyResult<(String, String)> {
    let options = parsed::<Convention>(options).and_then(|of| of.options());
    let options = options.map_err(|error| raised(py, &error))?;
    run(py, move || {
        let file = read_calibrated_imu(&path, &options)?;
        let findings = json!(file.findings).to_string();
        let written = calibrated_imu_texts(&file, ImuFormat::CalibrantJson)?;
        let text = written.into_iter().next().map(|(_, text)| text).unwrap_or_default();
        Ok((text, findings))
    })
}

/// Writes a calibration in another format; returns the paths, and what was noticed.
#[pyfunction]
pub(crate) fn convert_calibration(
    py: Python<'_>,
    text: String,
    path: PathBuf,
    options: &str,
) -> PyResult<(Vec<PathBuf>, String)> {
    let read = || -> Result<_> {
        let options: Changes = parsed(options)?;
        let written_as = options.format.as_deref().map(format).transpose()?;
        Ok((
            if options.into { Some(ImuFormat::Basalt) } else { written_as },
            options.into,
            options.conversion()?,
        ))
    };
    let (written_as, into, conversion) = read().map_err(|error| raised(py, &error))?;
    run(py, move || {
        let written_as = match written_as {
            Some(written_as) => written_as,
            None => ImuFormat::of_extension(&path).ok_or_else(|| {
                let message = "the ending of the path does not tell the format to write";
                let help = format!("say `format=` {}", ImuFormat::names(false));
                Error::experiment(InputError::new(Refusal::FormatUnknown, message, help).in_file(&path))
            })?,
        };
        let mut file = of_json(&text)?;
        let mut notes = conversion.change(&mut file)?;
        let written = match into {
            true => edit_calibrated_imu(&path, &file)?,
            false => write_calibrated_imu(&path, &file, written_as)?,
        };
        notes.extend(written.warnings);
        Ok((written.files, json!(notes).to_string()))
    })
}

/// Compares two calibrations.
#[pyfunction]
pub(crate) fn compare(py: Python<'_>, a: (String, String), b: (String, String)) -> PyResult<Page> {
    run(py, move || {
        let ((a, name_a), (b, name_b)) = (a, b);
        let (one, other) = (of_json(&a)?, of_json(&b)?);
        let place = Place::of_stations(one.station.as_deref(), other.station.as_deref());
        let comparison = Comparison::at(place, &one.imu, &other.imu);
        if comparison.quantities.is_empty() {
            let message = format!("{name_a} and {name_b} have no sensor in common");
            let help = "compare calibrations of one sensor";
            return Err(Error::experiment(InputError::new(Refusal::CalibrationUnsuited, message, help)));
        }
        let json = to_json(&ComparisonFile { comparison: &comparison, a: &name_a, b: &name_b });
        Ok(page(json, &comparison.notes, &comparison_sheet(&comparison, [name_a, name_b])))
    })
}

/// Corrects arrays with a calibration.
#[pyclass(frozen)]
pub(crate) struct Correction {
    imu: CalibratedImu,
    correction: ImuCorrection,
}

/// Corrected values of accelerometer and gyroscope, then their standard uncertainties.
type Corrected<'py> = [Option<Numbers<'py>>; 4];

#[pymethods]
impl Correction {
    #[new]
    fn new(py: Python<'_>, text: &str) -> PyResult<Self> {
        at_once(py, || {
            let imu = of_json(text)?.imu;
            Ok(Self { correction: ImuCorrection::of(&imu)?, imu })
        })
    }

    /// The unit of a sensor's readings; `None` where it is not calibrated.
    fn unit(&self, sensor: &str) -> Option<&'static str> {
        self.imu.unit(crate::recording::sensor_kind(sensor)).map(|unit| unit.symbol())
    }

    /// Corrects samples that were taken at the same times.
    #[pyo3(signature = (accelerometer=None, gyroscope=None, temperature_c=None, with_sd=false))]
    fn apply<'py>(
        &self,
        py: Python<'py>,
        accelerometer: Option<&[u8]>,
        gyroscope: Option<&[u8]>,
        temperature_c: Option<&[u8]>,
        with_sd: bool,
    ) -> PyResult<Corrected<'py>> {
        let (force, rate) = (accelerometer.map(vectors), gyroscope.map(vectors));
        let temperatures = temperature_c.map(list);
        let corrected = at_once(py, || self.corrected(force, rate, temperatures.as_deref(), with_sd))?;
        Ok(corrected.map(|of| of.map(|of| as_table(py, &of))))
    }
}

type Tables = [Option<Vec<Vector3<f64>>>; 4];

impl Correction {
    fn corrected(
        &self,
        force: Option<Vec<Vector3<f64>>>,
        rate: Option<Vec<Vector3<f64>>>,
        temperatures: Option<&[f64]>,
        with_sd: bool,
    ) -> Result<Tables> {
        let samples = force.as_ref().or(rate.as_ref()).map_or(0, Vec::len);
        if let (Some(force), Some(rate)) = (&force, &rate)
            && force.len() != rate.len()
        {
            let message = format!("`accelerometer` has {} samples, `gyroscope` {}", force.len(), rate.len());
            return Err(invalid(message, "give samples of the same times"));
        }
        let temperature_c = match temperatures {
            None | Some([]) => None,
            Some([all]) => Some(vec![*all; samples]),
            Some(each) if each.len() == samples => Some(each.to_vec()),
            Some(each) => {
                let message = format!("`temperature_c` has {} values for {samples} samples", each.len());
                return Err(invalid(message, "give one number, or one for each sample"));
            }
        };
        if samples == 0 {
            return Ok([force, rate, None, None]);
        }
        // the samples of both sensors are of the same times: only their order counts
        let times: Vec<f64> = (0..samples).map(|number| number as f64).collect();
        let of = |sensor_kind: SensorKind, readings: Option<Vec<Vector3<f64>>>| {
            let both = readings.zip(self.imu.unit(sensor_kind));
            both.map(|(readings, unit)| Recording::new(times.clone(), readings, 3, unit)).transpose()
        };
        let recording = ImuRecording {
            sensors: [of(SensorKind::Accelerometer, force)?, of(SensorKind::Gyroscope, rate)?].into(),
            temperature_c,
        };
        // the force that the gyroscope feels is there, or not needed
        let feels = recording[SensorKind::Accelerometer].is_some()
            || self.correction.g_sensitivity == Matrix3::zeros();
        if !with_sd && feels && !self.correction.follows_temperature() {
            return Ok(self.without_sd(&recording));
        }
        let corrected = self.correction.apply(&recording)?;
        let mut tables = Tables::default();
        for (number, of) in [corrected.accelerometer, corrected.gyroscope].into_iter().enumerate() {
            if let Some(of) = of {
                tables[number] = Some(of.values);
                tables[number + 2] = of.sd.filter(|_| with_sd);
            }
        }
        Ok(tables)
    }

    /// The same values. The uncertainty would take most of the time.
    fn without_sd(&self, recording: &ImuRecording) -> Tables {
        let readings =
            |sensor_kind: SensorKind| recording.sensor(sensor_kind).map(|of| of.readings().to_vec());
        let force: Option<Vec<_>> = readings(SensorKind::Accelerometer)
            .map(|of| of.iter().filter_map(|reading| self.correction.force(reading)).collect());
        let rate = readings(SensorKind::Gyroscope).map(|of| {
            let felt = |number: usize| force.as_ref().map_or_else(Vector3::zeros, |of| of[number]);
            let rate = |(number, reading)| self.correction.rate(reading, &felt(number));
            of.iter().enumerate().filter_map(rate).collect()
        });
        [force, rate, None, None]
    }
}

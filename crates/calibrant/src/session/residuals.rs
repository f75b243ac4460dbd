//! The residuals of a calibration, one by one, for tests and figures of one's own. They are those of the report's figures.

use super::outcome::Outcome;
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, HoldResult, Recovered, RecoveredMotion, RotationResult};
use calibrant_core::sensor::{Axis, Recording, SensorKind};
use calibrant_io::{Table, TableColumn};
use calibrant_machine::estimate::{MachineCalibration, SampleResidual, SensorResidual};
use nalgebra::Vector3;
use std::borrow::Cow;
use std::path::Path;

/// The residuals of a calibration. Each series is those of a sensor and an axis.
///
/// | calibration from | residual | unit | series |
/// |---|---|---|---|
/// | a commanded motion | reading of a sample less the model | that of the readings | the accelerometer's axes |
/// | holds | magnitude of a hold's corrected mean less gravity | m/s² | the accelerometer |
/// | rotations between holds | angle from propagated gravity to measured gravity | rad | the gyroscope |
/// | a machine's log | reading of a sample less what the motion says | that of the readings | the axes of each sensor |
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Residuals {
    /// The series: first those of the accelerometer.
    pub series: Vec<ResidualSeries>,
}

/// The residuals of a sensor, of one axis where they have axes, in the order of time. What is not known is not a number.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualSeries {
    /// Of what each of them is: `sample`, `hold` or `rotation`.
    pub kind: &'static str,
    /// The sensor.
    pub sensor: SensorKind,
    /// The axis; `None` for a magnitude or an angle.
    pub axis: Option<Axis>,
    /// Unit of residuals and standard deviations.
    pub unit: &'static str,
    /// Time of the sample, or begin of the hold or rotation, s. On a machine it is the time of the motion.
    pub times_s: Vec<f64>,
    /// The residuals.
    pub residuals: Vec<f64>,
    /// Predicted standard deviation of each: the noise of a sample; of a hold or a rotation that by which its residual is studentised, as in the figures.
    pub sd: Vec<f64>,
    /// Each in its standard deviations: the residual over `sd`; of a rotation it is studentised.
    pub whitened: Vec<f64>,
    /// The weight in the fit, 0 to 1. With 0, a hold or rotation was not used.
    pub weights: Vec<f64>,
}

/// A residual: time, value, standard deviation, whitened value, weight.
type Row = [f64; 5];

impl ResidualSeries {
    fn of(
        (kind, sensor, axis, unit): (&'static str, SensorKind, Option<Axis>, &'static str),
        rows: impl Iterator<Item = Row> + Clone,
    ) -> Self {
        let column = |k: usize| rows.clone().map(|row| row[k]).collect();
        let [times_s, residuals, sd, whitened, weights] = [0, 1, 2, 3, 4].map(column);
        Self { kind, sensor, axis, unit, times_s, residuals, sd, whitened, weights }
    }
}

impl Residuals {
    /// As one table, a row for each residual: `kind,sensor,axis,t_s,unit,residual,sd,whitened,weight`.
    #[must_use]
    pub fn table(&self) -> Table {
        let texts = |name: &str, of: &dyn Fn(&ResidualSeries) -> Option<&'static str>| {
            let repeated =
                |series: &ResidualSeries| vec![of(series).map(Cow::Borrowed); series.residuals.len()];
            TableColumn::texts(name, self.series.iter().flat_map(repeated).collect())
        };
        let numbers = |name: &str, of: fn(&ResidualSeries) -> &Vec<f64>| {
            TableColumn::numbers(name, self.series.iter().flat_map(of).copied().collect())
        };
        Table {
            name: "residuals",
            columns: vec![
                texts("kind", &|series| Some(series.kind)),
                texts("sensor", &|series| Some(series.sensor.name())),
                texts("axis", &|series| series.axis.map(|axis| ["x", "y", "z"][axis.index()])),
                numbers("t_s", |series| &series.times_s),
                texts("unit", &|series| Some(series.unit)),
                numbers("residual", |series| &series.residuals),
                numbers("sd", |series| &series.sd),
                numbers("whitened", |series| &series.whitened),
                numbers("weight", |series| &series.weights),
            ],
        }
    }

    /// Writes the [table](Self::table) as CSV or Parquet, as the ending of the name says.
    ///
    /// # Errors
    /// As [`Table::write`].
    pub fn write(&self, path: &Path) -> Result<()> {
        self.table().write(path)
    }
}

impl Outcome {
    /// The residuals.
    #[must_use]
    pub fn residuals(&self) -> Residuals {
        let calibration = self.calibration();
        let series = match &calibration.recovered {
            Recovered::Holds(holds) => {
                let rotations = calibration.gyroscope.as_ref().map(|of| of_rotations(&of.rotations));
                std::iter::once(of_holds(&holds.holds)).chain(rotations).collect()
            }
            Recovered::Motion(motion) => (self.recording[SensorKind::Accelerometer].iter())
                .flat_map(|recording| of_motion(calibration, motion, recording))
                .collect(),
            Recovered::OnMachine(_) => {
                self.calibrated.machine().map_or_else(Vec::new, |machine| of_machine(&machine.calibration))
            }
        };
        Residuals { series }
    }
}

fn of_motion<'a>(
    calibration: &'a Calibration,
    motion: &'a RecoveredMotion,
    recording: &'a Recording,
) -> impl Iterator<Item = ResidualSeries> + 'a {
    let times = recording.times_s().get(motion.first_sample..).unwrap_or_default();
    let noise = calibration.fit.sample_noise();
    recording.active_axes().iter().map(move |&axis| {
        let sd = noise.map_or(f64::NAN, |noise| noise[axis.index()]);
        let row = |(&time_s, residual): (&f64, &Vector3<f64>)| {
            let value = residual[axis.index()];
            [time_s, value, sd, value / sd, 1.0]
        };
        let unit = calibration.unit(SensorKind::Accelerometer).symbol();
        let rows = times.iter().zip(&motion.residuals).map(row);
        ResidualSeries::of(("sample", SensorKind::Accelerometer, Some(axis), unit), rows)
    })
}

fn of_holds(holds: &[HoldResult]) -> ResidualSeries {
    let row = |of: &HoldResult| {
        let (value, sd) = (of.magnitude_residual_mps2, of.magnitude_sd_mps2);
        [of.hold.start_s, value, sd, value / sd, f64::from(u8::from(of.used))]
    };
    ResidualSeries::of(("hold", SensorKind::Accelerometer, None, "m/s²"), holds.iter().map(row))
}

/// Those of rotations that could be integrated.
fn of_rotations(rotations: &[RotationResult]) -> ResidualSeries {
    let row = |of: &RotationResult| {
        let weight = f64::from(u8::from(of.used));
        [of.start_s, of.error_rad, of.error_sd_rad(), of.studentised, weight]
    };
    let integrated = rotations.iter().filter(|rotation| rotation.is_integrated());
    ResidualSeries::of(("rotation", SensorKind::Gyroscope, None, "rad"), integrated.map(row))
}

fn of_machine(calibration: &MachineCalibration) -> Vec<ResidualSeries> {
    let of_axis = |(of, axis): (&SensorResidual, Axis)| {
        let k = axis.index();
        let row = |sample: &SampleResidual| {
            let (whitened, weight) = (sample.whitened()[k], sample.weights()[k]);
            [sample.time_s, sample.value[k], sample.sd[k], whitened, weight]
        };
        let unit = calibration.sensors.unit(of.sensor).symbol();
        ResidualSeries::of(("sample", of.sensor, Some(axis), unit), of.residuals.iter().map(row))
    };
    calibration.noise.iter().flat_map(|of| Axis::ALL.map(|axis| (of, axis))).map(of_axis).collect()
}

//! A calibration over temperature on a recording that was not used for it: a ramp, or another soak.

use super::clean::take_out_repeats;
use super::kind::Kind;
use super::prepared::unsuited;
use super::reader::Reader;
use super::run::Session;
use super::setup::Setup;
use super::source::Source;
use super::validation::{extrapolated, on_recording};
use crate::CampaignCalibration;
use calibrant_campaign::fit::{SoakPath, paths};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{
    HeldOutRecording, ImuSetup, SoakTemperature, Validation, validate_over_temperature,
};
use calibrant_core::motion::Hold;
use calibrant_io::{Plan, file_name};

impl Session {
    /// Tries a calibration over temperature on a recording of the sensor: once on all holds that were reached from below, and once on those from above, each with the hysteresis
    /// and the lag of its branch. This session is of one soak ([`Experiment::of_one_soak`](calibrant_io::Experiment::of_one_soak)).
    ///
    /// # Errors
    /// [`Error::Recording`] where the recording cannot be read, has no temperature or no holds, or is another sensor's.
    /// [`Error::Experiment`] where it is one of the soaks.
    pub(crate) fn on_held_out(
        &self,
        source: &Source,
        of: &mut CampaignCalibration,
    ) -> Result<Vec<Validation>> {
        let (experiment, path) = (self.experiment(), source.path());
        let mut other = Reader::of(experiment, self.options()).read(source)?;
        let inputs = other.origin(source).inputs;
        if let Some(same) =
            inputs.iter().find(|one| of.origin.inputs.iter().any(|of| of.of_file() == one.sha256))
        {
            let message = format!("{} is among the soaks; errors on it validate nothing", same.file);
            let help = "leave it out of the soaks, or give another recording of the sensor";
            return Err(Error::experiment(InputError::new(Refusal::RecordingRepeated, message, help)));
        }
        let in_file = |found: calibrant_core::diagnostic::Diagnostic| found.in_file(file_name(path));
        let mut notes = other.findings.clone();
        let Plan::Holds(plan) = &experiment.plan else { return Err(unsuited()) };
        let kind = Kind::held(plan, experiment.imu.as_ref());
        let mut setup = kind.setup(source, &other.recording, &mut notes)?.of_other();
        notes.extend(take_out_repeats(&mut other.recording).into_iter().map(in_file));
        notes.extend(setup.prepare(&experiment.sensor, &mut other.recording).into_iter().map(in_file));
        notes.extend(extrapolated(&of.fitted.imu.parameters.thermal, &other.recording)?.map(in_file));
        of.fitted.warnings.extend(notes);
        let (gyroscope, setup) = match setup {
            Setup::Imu(gyroscope, setup) => (Some(gyroscope), *setup),
            Setup::Holds(holds) => (None, ImuSetup { holds, ..ImuSetup::default() }),
            Setup::Faces(_) | Setup::Motion(_) => return Err(unsuited()),
        };
        let held_out = HeldOutRecording {
            accelerometer: &experiment.sensor,
            gyroscope,
            recording: &other.recording,
            setup: &setup,
        };
        let validations = branches(&held_out, of).map_err(|error| error.in_recording(path))?;
        Ok(validations
            .into_iter()
            .map(|(branch, validation)| {
                let mut named = on_recording(path, validation);
                if let calibrant_core::estimate::ValidationSource::Recording { name } = &mut named.source {
                    name.push_str(branch);
                }
                named
            })
            .collect())
    }
}

/// Holds by the direction from which they were reached, and what each direction is called.
const BRANCHES: [(f64, &str); 3] = [(1.0, ", from below"), (-1.0, ", from above"), (0.0, "")];

fn branches(
    held_out: &HeldOutRecording<'_>,
    of: &CampaignCalibration,
) -> Result<Vec<(&'static str, Validation)>> {
    let holds = held_out.setup.holds.found.as_deref().unwrap_or_default();
    let spans = holds.iter().map(|hold| (hold.start_s, hold.end_s));
    let temperatures = SoakTemperature::each(held_out.recording, spans)?;
    if temperatures.is_empty() {
        let (what, help) = match holds.is_empty() {
            true => ("it has no holds", "hold the sensor still in several orientations"),
            false => ("it has no temperature", "name its column with temperature = \"…\" in [columns]"),
        };
        return Err(Error::recording(InputError::new(Refusal::HoldsMissing, what, help)));
    }
    let paths = paths(&of.model.campaign, temperatures);
    let mut found = Vec::new();
    for (direction, name) in BRANCHES {
        let chosen: Vec<(&Hold, &SoakPath)> =
            holds.iter().zip(&paths).filter(|(_, path)| path.direction == direction).collect();
        if chosen.is_empty() {
            continue;
        }
        let mean = |part: fn(&SoakPath) -> f64| {
            chosen.iter().map(|(_, path)| part(path)).sum::<f64>() / chosen.len() as f64
        };
        let path = SoakPath {
            temperature_c: mean(|of| of.temperature_c),
            direction,
            lag_left: mean(|of| of.lag_left),
        };
        let holds: Vec<Hold> = chosen.into_iter().map(|(hold, _)| hold.clone()).collect();
        found.push((
            name,
            validate_over_temperature(&of.fitted.on_path(&path), &of.scatter, held_out, &holds)?,
        ));
    }
    Ok(found)
}

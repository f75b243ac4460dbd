//! Names of sensors that many recordings share.

use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_io::SensorNaming;
use std::collections::HashMap;
use std::path::Path;

/// Refuses options that contradict each other, or what is given.
pub(super) fn refuse<T>(what: String, help: String) -> Result<T> {
    Err(Error::experiment(InputError::new(Refusal::OptionsContradict, what, help)))
}

/// Refuses one name for several recordings, unless their names have dates or stations: then they are of one sensor.
pub(super) fn check_several(naming: &SensorNaming) -> Result<()> {
    let (sensor, pattern) = (TaskOption::Sensor, TaskOption::SensorFrom);
    match (&naming.sensor, &naming.pattern) {
        (Some(_), None) => refuse(
            format!("{sensor} names one sensor, and several recordings are given"),
            format!(
                "give {pattern} '{{sensor}}_{{date}}' where they are of several, or {sensor} with {pattern} '{{}}_{{date}}' where they are of one"
            ),
        ),
        _ => Ok(()),
    }
}

/// Refuses recordings that are calibrated together and name different sensors.
pub(super) fn check_together<'p>(
    naming: &SensorNaming,
    recordings: impl Iterator<Item = &'p Path>,
) -> Result<()> {
    if !naming.names_sensors() {
        return Ok(());
    }
    let mut first: Option<String> = None;
    for recording in recordings {
        let name = naming.of(recording)?.sensor;
        let first = first.get_or_insert_with(|| name.clone());
        if *first != name {
            return refuse(
                format!(
                    "{} is for one sensor, and the recordings name {first:?} and {name:?}",
                    TaskOption::Together
                ),
                format!(
                    "name the sensor with {}, or calibrate the recordings one by one",
                    TaskOption::Sensor
                ),
            );
        }
    }
    Ok(())
}

/// Refuses recordings whose sensors nobody has named and whose files have the same name: records would take them for one sensor.
pub(super) fn check_for_records<'p>(
    naming: &SensorNaming,
    recordings: impl Iterator<Item = &'p Path> + Clone,
) -> Result<()> {
    let is_named = naming.sensor.is_some() || naming.key.is_some();
    if !is_named && recordings.clone().any(|recording| recording.as_os_str() == "-") {
        return refuse(
            "records need the sensor of what comes from standard input".to_owned(),
            format!("name it with {}", TaskOption::Sensor),
        );
    }
    if naming.names_sensors() {
        return Ok(());
    }
    let mut first: HashMap<String, &Path> = HashMap::new();
    for recording in recordings {
        let sensor = naming.of(recording)?.sensor;
        if let Some(other) = first.insert(sensor.clone(), recording) {
            let (other, recording, pattern) = (other.display(), recording.display(), TaskOption::SensorFrom);
            return refuse(
                format!("{other} and {recording} would be recorded as one sensor {sensor:?}"),
                format!(
                    "name the sensors, for example with {pattern} '{{sensor}}/{{}}' by their folders, or {pattern} '{{}}/{{sensor}}' if they are of one"
                ),
            );
        }
    }
    Ok(())
}

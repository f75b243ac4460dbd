//! The kinds of JSON files, each with its JSON Schema, from the types that are written.

use calibrant_io::{
    BatchEntry, CalibrationFile, CampaignCalibrationFile, CampaignFile, CampaignStudyFile, CampaignSweepFile,
    ComparisonFile, ConvertedFile, DesignFile, EvaluationFile, InspectionFile, JsonFile,
    MachineCalibrationFile, MachineFile, NoiseFile, PoseDesignFile, PoseEvaluationFile,
    ReferenceInspectionFile, SweepFile, TrajectoryEvaluationFile, TrajectoryFile, TrajectorySweepFile, Truth,
};
#[cfg(feature = "records")]
use calibrant_records::{Fleet, KeptRecord, RecordFile, SensorDrift, SensorHistory};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use std::borrow::Cow;

/// A kind of JSON file.
#[derive(Debug, Clone, Copy)]
pub struct FileKind {
    /// Its name: `calibration`.
    pub name: &'static str,
    /// Which file it is.
    pub file: &'static str,
    /// The command that writes or prints it: `calibrate`.
    pub command: &'static str,
    root: fn() -> Schema,
    part: fn(&mut SchemaGenerator) -> Schema,
    pub(super) type_name: fn() -> Cow<'static, str>,
}

impl FileKind {
    const fn of<T: JsonFile + JsonSchema>(file: &'static str, command: &'static str) -> Self {
        Self::list::<T>(T::KIND, file, command)
    }

    /// A list has no key that says its kind.
    const fn list<T: JsonSchema>(name: &'static str, file: &'static str, command: &'static str) -> Self {
        let root = || generator().into_root_schema_for::<T>();
        Self { name, file, command, root, part: T::json_schema, type_name: T::schema_name }
    }

    /// All kinds.
    pub const ALL: &[Self] = &[
        Self::of::<CalibrationFile<'static>>(
            "calibration.json of an accelerometer or of an IMU",
            "calibrate",
        ),
        Self::of::<CampaignCalibrationFile<'static>>(
            "calibration.json of a campaign over temperature",
            "calibrate",
        ),
        Self::of::<MachineCalibrationFile<'static>>("calibration.json of a sensor on a machine", "calibrate"),
        Self::list::<Vec<BatchEntry>>("batch", "the calibrations of several recordings", "calibrate"),
        Self::of::<ConvertedFile<'static>>("a calibration as calibrant JSON", "convert"),
        Self::of::<NoiseFile<'static>>("noise.json", "noise"),
        Self::of::<ComparisonFile<'static>>("what compare prints as JSON", "compare"),
        Self::of::<DesignFile<'static>>("design.json of a motion", "design"),
        Self::of::<EvaluationFile<'static>>("evaluation.json of a motion", "design"),
        Self::of::<SweepFile<'static>>("sweep.json", "design"),
        Self::of::<PoseDesignFile<'static>>("design.json of poses", "design"),
        Self::of::<PoseEvaluationFile<'static>>("evaluation.json of holds", "design"),
        Self::of::<CampaignFile<'static>>("design.json of a campaign over temperature", "design"),
        Self::of::<CampaignSweepFile<'static>>("sweep.json of campaigns over their time", "design"),
        Self::of::<CampaignStudyFile<'static>>("study.json of campaigns over temperature", "study"),
        Self::of::<TrajectoryFile<'static>>("design.json of the trajectory of a machine", "design"),
        Self::of::<TrajectoryEvaluationFile<'static>>("evaluation.json of a trajectory", "design"),
        Self::of::<TrajectorySweepFile<'static>>("sweep.json of trajectories", "design"),
        #[cfg(feature = "study")]
        Self::of::<calibrant_io::StudyFile<'static>>("study.json", "study"),
        Self::of::<Truth>("truth.json of a simulation", "simulate"),
        Self::of::<InspectionFile<'static>>("what inspect prints of a recording", "inspect"),
        Self::of::<ReferenceInspectionFile<'static>>("what inspect prints of a log of a motion", "inspect"),
        Self::of::<MachineFile<'static>>("what inspect prints of a machine", "inspect"),
        #[cfg(feature = "records")]
        Self::list::<Vec<KeptRecord>>("records", "the list of records", "records list"),
        #[cfg(feature = "records")]
        Self::of::<RecordFile<'static>>("a record with its parameters", "records show"),
        #[cfg(feature = "records")]
        Self::of::<SensorHistory>("the history of a sensor", "records drift"),
        #[cfg(feature = "records")]
        Self::list::<Vec<SensorDrift>>("drift", "the sensors that changed most", "records drift"),
        #[cfg(feature = "records")]
        Self::of::<Fleet>("the parameters over all sensors", "records fleet"),
    ];

    /// The kind of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name == name)
    }

    /// The JSON Schema of its files.
    ///
    /// # Examples
    /// ```
    /// use calibrant::FileKind;
    /// let schema = FileKind::named("design").expect("known").schema();
    /// assert!(schema.pointer("/properties/optimal").is_some());
    /// ```
    #[must_use]
    pub fn schema(self) -> Schema {
        (self.root)()
    }

    /// The same, with the types within it as definitions of this generator.
    pub(super) fn part(self, generator: &mut SchemaGenerator) -> Schema {
        (self.part)(generator)
    }
}

/// Of schemas of what is written, not of what is read.
pub(super) fn generator() -> SchemaGenerator {
    SchemaSettings::default().for_serialize().into_generator()
}

#[cfg(test)]
mod tests {
    use super::FileKind;

    #[test]
    fn every_kind_is_a_list_or_has_an_object_with_the_heading() {
        for kind in FileKind::ALL {
            let schema = kind.schema();
            if schema.pointer("/type").is_some_and(|of| of == "array") {
                continue;
            }
            assert_eq!(schema.pointer("/properties/kind/const"), Some(&kind.name.into()));
            for key in ["schema", "program"] {
                assert!(schema.pointer(&format!("/properties/{key}")).is_some(), "{}: {key}", kind.name);
            }
        }
    }
}

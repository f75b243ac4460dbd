//! The kinds of JSON files, each with its JSON Schema, from the types that are written.

use calibrant_io::{
    CalibrationFile, ComparisonFile, ConvertedFile, DesignFile, EvaluationFile, InspectionFile,
    MachineCalibrationFile, MachineFile, NoiseFile, PoseDesignFile, PoseEvaluationFile,
    ReferenceInspectionFile, SweepFile, Truth,
};
#[cfg(feature = "records")]
use calibrant_records::{Fleet, KeptRecord, RecordFile, SensorDrift, SensorHistory};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};

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
}

impl FileKind {
    const fn of<T: JsonSchema>(name: &'static str, file: &'static str, command: &'static str) -> Self {
        let root = || generator().into_root_schema_for::<T>();
        Self { name, file, command, root, part: T::json_schema }
    }

    /// All kinds.
    pub const ALL: &[Self] = &[
        Self::of::<CalibrationFile<'static>>(
            "calibration",
            "calibration.json of an accelerometer or of an IMU",
            "calibrate",
        ),
        Self::of::<MachineCalibrationFile<'static>>(
            "machine",
            "calibration.json of a sensor on a machine",
            "calibrate",
        ),
        Self::of::<ConvertedFile<'static>>("converted", "a calibration as calibrant JSON", "convert"),
        Self::of::<NoiseFile<'static>>("noise", "noise.json", "noise"),
        Self::of::<ComparisonFile<'static>>("comparison", "what compare prints as JSON", "compare"),
        Self::of::<DesignFile<'static>>("design", "design.json of a motion", "design"),
        Self::of::<EvaluationFile<'static>>("evaluation", "evaluation.json of a motion", "design"),
        Self::of::<SweepFile<'static>>("sweep", "sweep.json", "design"),
        Self::of::<PoseDesignFile<'static>>("poses", "design.json of poses", "design"),
        Self::of::<PoseEvaluationFile<'static>>("poses-evaluation", "evaluation.json of holds", "design"),
        #[cfg(feature = "study")]
        Self::of::<calibrant_io::StudyFile<'static>>("study", "study.json", "study"),
        Self::of::<Truth>("truth", "truth.json of a simulation", "simulate"),
        Self::of::<InspectionFile<'static>>("recording", "what inspect prints of a recording", "inspect"),
        Self::of::<ReferenceInspectionFile<'static>>(
            "log",
            "what inspect prints of a log of a motion",
            "inspect",
        ),
        Self::of::<MachineFile<'static>>("chain", "what inspect prints of a machine", "inspect"),
        #[cfg(feature = "records")]
        Self::of::<Vec<KeptRecord>>("records", "the list of records", "records list"),
        #[cfg(feature = "records")]
        Self::of::<RecordFile<'static>>("record", "a record with its parameters", "records show"),
        #[cfg(feature = "records")]
        Self::of::<SensorHistory>("history", "the history of a sensor", "records drift"),
        #[cfg(feature = "records")]
        Self::of::<Vec<SensorDrift>>("drift", "the sensors that changed most", "records drift"),
        #[cfg(feature = "records")]
        Self::of::<Fleet>("fleet", "the parameters over all sensors", "records fleet"),
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
            for key in ["schema", "kind", "program"] {
                assert!(schema.pointer(&format!("/properties/{key}")).is_some(), "{}: {key}", kind.name);
            }
        }
    }
}

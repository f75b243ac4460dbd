//! The JSON Schema of each kind of file that is written, from the types that are written.

use super::calibration::CalibrationFile;
use super::comparison::ComparisonFile;
use super::design::{DesignFile, EvaluationFile, SweepFile};
use super::machine_calibration::MachineCalibrationFile;
use super::noise::NoiseFile;
use super::pose_design::{PoseDesignFile, PoseEvaluationFile};
use crate::truth::sensors::Truth;
use schemars::{JsonSchema, Schema, schema_for};

/// A kind of JSON file.
#[derive(Debug, Clone, Copy)]
pub struct FileKind {
    /// Its name: `calibration`.
    pub name: &'static str,
    /// Which file it is.
    pub file: &'static str,
    schema: fn() -> Schema,
}

impl FileKind {
    /// All kinds.
    pub const ALL: &[Self] = &[
        Self::of::<CalibrationFile<'_>>("calibration", "calibration.json of an accelerometer or of an IMU"),
        Self::of::<MachineCalibrationFile<'_>>("machine", "calibration.json of a sensor on a machine"),
        Self::of::<NoiseFile<'_>>("noise", "noise.json"),
        Self::of::<ComparisonFile<'_>>("comparison", "what compare prints as JSON"),
        Self::of::<DesignFile<'_>>("design", "design.json of a motion"),
        Self::of::<EvaluationFile<'_>>("evaluation", "evaluation.json of a motion"),
        Self::of::<SweepFile<'_>>("sweep", "sweep.json"),
        Self::of::<PoseDesignFile<'_>>("poses", "design.json of poses"),
        Self::of::<PoseEvaluationFile<'_>>("poses-evaluation", "evaluation.json of holds"),
        #[cfg(feature = "study")]
        Self::of::<super::study::StudyFile<'_>>("study", "study.json"),
        Self::of::<Truth>("truth", "truth.json of a simulation"),
    ];

    const fn of<T: JsonSchema>(name: &'static str, file: &'static str) -> Self {
        Self { name, file, schema: || schema_for!(T) }
    }

    /// The kind of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name == name)
    }

    /// The JSON Schema of its files.
    ///
    /// # Examples
    /// ```
    /// use calibrant_io::FileKind;
    /// let schema = FileKind::named("design").expect("known").schema();
    /// assert!(schema.pointer("/properties/optimal").is_some());
    /// ```
    #[must_use]
    pub fn schema(self) -> Schema {
        (self.schema)()
    }
}

#[cfg(test)]
mod tests {
    use crate::FileKind;

    #[test]
    fn every_kind_has_an_object_with_the_heading() {
        for kind in FileKind::ALL {
            let schema = kind.schema();
            for key in ["schema", "kind", "program"] {
                assert!(schema.pointer(&format!("/properties/{key}")).is_some(), "{}: {key}", kind.name);
            }
        }
    }
}

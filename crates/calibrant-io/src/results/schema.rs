//! The JSON Schema of each kind of file that is written, from the types that are written.

use super::calibration::CalibrationFile;
use super::comparison::ComparisonFile;
use super::design::{DesignFile, EvaluationFile, SweepFile};
use super::machine_calibration::MachineCalibrationFile;
use super::noise::NoiseFile;
use super::pose_design::{PoseDesignFile, PoseEvaluationFile};
use crate::truth::sensors::Truth;
use schemars::{Schema, schema_for};

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
        Self {
            name: "calibration",
            file: "calibration.json of an accelerometer or of an IMU",
            schema: || schema_for!(CalibrationFile<'static>),
        },
        Self {
            name: "machine",
            file: "calibration.json of a sensor on a machine",
            schema: || schema_for!(MachineCalibrationFile<'static>),
        },
        Self { name: "noise", file: "noise.json", schema: || schema_for!(NoiseFile<'static>) },
        Self {
            name: "comparison",
            file: "what compare prints as JSON",
            schema: || schema_for!(ComparisonFile<'static>),
        },
        Self { name: "design", file: "design.json of a motion", schema: || schema_for!(DesignFile<'static>) },
        Self {
            name: "evaluation",
            file: "evaluation.json of a motion",
            schema: || schema_for!(EvaluationFile<'static>),
        },
        Self { name: "sweep", file: "sweep.json", schema: || schema_for!(SweepFile<'static>) },
        Self { name: "poses", file: "design.json of poses", schema: || schema_for!(PoseDesignFile<'static>) },
        Self {
            name: "poses-evaluation",
            file: "evaluation.json of holds",
            schema: || schema_for!(PoseEvaluationFile<'static>),
        },
        #[cfg(feature = "study")]
        Self { name: "study", file: "study.json", schema: || schema_for!(super::study::StudyFile<'static>) },
        Self { name: "truth", file: "truth.json of a simulation", schema: || schema_for!(Truth) },
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

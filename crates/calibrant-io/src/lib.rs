//! Files: it reads experiments, recordings and motions, and writes results. Only this crate touches files.
//!
//! | file | in | out |
//! |---|---|---|
//! | experiment (TOML) | [`Experiment::read`] | [`preset()`], [`PRESETS`] |
//! | `recording.csv` and other recordings, in many formats | [`read_imu_recording`], [`read_imu_pair`] | [`write_recording`], [`InspectionFile`] |
//! | `joints.csv`, poses of a tracker, bags | [`read_reference_log`] | |
//! | machine (URDF) | [`Urdf::read`] | [`machine_preset()`], [`MACHINE_PRESETS`], [`MachineFile`] |
//! | `motion.csv` | [`read_motion`] | [`write_motion`] |
//! | `calibration.json` | [`read_calibrated_imu`]; [`read_calibration`], as what is known before a design | [`CalibrationFile`] |
//! | calibrations, ours and of other programs | [`read_calibrated_imu`] | [`write_calibrated_imu`] |
//! | corrected recordings, comparisons | | [`write_corrected_recording`], [`ComparisonFile`] |
//! | `design.json`, `motion_dense.csv` | | [`DesignFile`], [`write_dense_motion`] |
//! | `design.json` and `evaluation.json` of poses | | [`PoseDesignFile`], [`PoseEvaluationFile`] |
//! | `poses.csv` | [`read_poses`] | [`write_poses`] |
//! | `evaluation.json`, `sweep.json`, `sweep.csv` | | [`EvaluationFile`], [`SweepFile`], [`write_sweep_csv`] |
//! | `noise.json` | | [`NoiseFile`] |
//! | `truth.json` of a simulation | [`read_calibrated_imu`], as a calibration without a covariance | [`Truth`] |
//! | `resume.json` of a batch | [`Finished::read`] | [`Finished::write`] |
//! | `study.json`, `summary.csv` | | [`StudyFile`], [`write_summary`] |
//!
//! Everything is SI inside; conversions happen here. No input makes the readers panic, and no NaN or infinity
//! passes them. Every error names file, line and column and gives a remedy. A reader repairs or notices
//! nothing silently: it returns a [`Diagnostic`](calibrant_core::diagnostic::Diagnostic). Every result is written beside its place and then renamed
//! ([`write_atomically`]), so it is whole or absent.

mod atomic_output;
mod calibration;
mod comparison;
mod convention;
mod corrected_recording;
mod delimited_text;
mod dense_motion;
mod design;
mod earlier_calibration;
mod exact_number;
mod experiment;
mod experiment_presets;
mod ferraris_sections;
mod finished;
mod hashed_file;
mod heading;
mod input;
mod inspection;
mod json;
mod judgement;
mod machine;
mod machine_calibration;
mod machine_truth;
mod machine_validation;
mod manifest;
mod motion;
mod name_pattern;
mod noise;
mod origin;
mod pose_design;
mod poses;
mod program;
mod reach;
mod recording;
mod reference_inspection;
mod reference_log;
mod result_places;
mod resume_key;
mod sampling;
mod schema;
mod sensor_naming;
mod standard_input;
mod stated_rate;
#[cfg(feature = "study")]
mod study;
mod summary;
mod sweep;
mod text_decoding;
mod text_excerpt;
mod true_parameter;
mod truth;
mod utc_time;

pub use atomic_output::{remove_unfinished, write_atomically};
pub use calibration::CalibrationFile;
pub use comparison::ComparisonFile;
pub use convention::{
    CalibratedImuFile, ConventionOptions, ImuCore, ImuFormat, ImuNoise, RawUnits, WrittenImu,
    calibrated_imu_texts, imu_tk_files, parse_calibrated_imu, parse_estimates, read_calibrated_imu,
    read_kalibr_noise, read_measured_noise, write_calibrated_imu,
};
pub use corrected_recording::{check_not_corrected, write_corrected_recording};
pub use dense_motion::write_dense_motion;
pub use design::{DesignFile, DesignSetting, EvaluationFile, SweepFile};
pub use earlier_calibration::{EarlierCalibration, parse_calibration, read_calibration};
pub use experiment::{
    CalibrateOptions, CriterionLetter, DesignOptions, Experiment, ExperimentFile, HoldsPlan, ImuPlan,
    LogNoise, MachinePlan, MachineSimulation, MachineSource, MotionPlan, NoisyVariant, Plan, Prior, ScaleBy,
    StudyOptions, UnknownVariant, UrdfSource, experiment_keys, nearest, read_acceptance, read_columns,
    sections as experiment_sections,
};
pub use experiment_presets::{PRESETS, Preset, preset};
pub use ferraris_sections::{Section, SectionKind, parse_sections, read_sections};
pub use finished::Finished;
pub use hashed_file::HashedFile;
pub use heading::Heading;
pub use input::{Input, file_name};
pub use inspection::{HoldsInspection, Inspection, InspectionFile, SensorInspection, inspect};
pub use json::{SCHEMA, to_json, write_json};
pub use judgement::Judgement;
pub use machine::{MACHINE_PRESETS, MachineFile, MissingMesh, Urdf, machine_preset, missing_limits};
pub use machine_calibration::{MachineCalibrationFile, MachineLogInput, MachineResult};
pub use machine_truth::TrueMachine;
pub use motion::{parse_motion, read_motion, write_motion};
pub use name_pattern::NamePattern;
pub use noise::NoiseFile;
pub use origin::Origin;
pub use pose_design::{PoseDesignFile, PoseEvaluationFile};
pub use poses::{read_poses, write_poses};
pub use program::program;
pub use reach::{Reached, ReachedGoal};
pub use recording::{
    AccelerometerOnly, ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile,
    ImuReadOptions, ImuUnit, SampleTimes, SecondFile, TimeUnit, USUAL_RATE_SD_PPM, imu_from_columns,
    imu_pair_of, parse_imu_pair, parse_imu_recording, read_imu_pair, read_imu_recording, read_imu_sensor,
    write_imu_recording, write_recording,
};
pub use reference_inspection::{
    JointInspection, Jumps, PoseInspection, ReferenceInspection, ReferenceInspectionFile, Seen,
    inspect_reference_log,
};
pub use reference_log::{
    ReferenceFormat, ReferenceLogFile, ReferenceLogOptions, is_reference_log, parse_reference_log,
    read_reference_log, write_joint_log, write_pose_log,
};
pub use result_places::{ClaimedPlaces, ResultPlaces};
pub use resume_key::ResumeKey;
pub use sampling::Sampling;
pub use schema::FileKind;
pub use sensor_naming::{NamedRecording, SensorNaming};
#[cfg(feature = "study")]
pub use study::StudyFile;
pub use summary::{
    Failure, Summary, SummaryParameter, SummaryRow, calibrations_json, spreadsheet_text, unit_ending,
    write_summary,
};
pub use sweep::write_sweep_csv;
pub use text_decoding::{Checked, open_file, read_text};
pub use truth::Truth;
pub use utc_time::UtcTime;

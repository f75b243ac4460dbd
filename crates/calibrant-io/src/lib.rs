//! Files: it reads experiments, recordings and motions, and writes results. Only this crate touches files.
//!
//! | file | in | out |
//! |---|---|---|
//! | experiment (TOML) | [`Experiment::read`] | [`preset()`], [`PRESETS`] |
//! | `recording.csv` and other recordings, in many formats | [`read_imu_recording`], [`read_imu_pair`] | [`write_recording`], [`InspectionFile`] |
//! | `joints.csv`, poses of a tracker, bags | [`read_reference_log`] | |
//! | machine (URDF) | [`Urdf::read`] | [`machine_preset()`], [`MACHINE_PRESETS`], [`MachineFile`] |
//! | shapes of its links (STL), pairs that may touch (SRDF), MoveIt's `joint_limits.yaml` | [`Urdf::bodies`], [`read_srdf`], [`read_joint_limits`] | |
//! | `trajectory.csv` | [`read_trajectory`], [`read_reference_log`] | [`write_trajectory`] |
//! | `follow_joint_trajectory.yaml`, `trajectory.script` | | [`write_goal`], [`write_urscript`] |
//! | `motion.csv` | [`read_motion`] | [`write_motion`] |
//! | `calibration.json` | [`read_calibrated_imu`]; [`read_calibration`] and [`read_earlier_machine`], as what is known before a design | [`CalibrationFile`] |
//! | calibrations, ours and of other programs | [`read_calibrated_imu`] | [`write_calibrated_imu`] |
//! | corrected recordings, comparisons | | [`write_corrected_recording`], [`ComparisonFile`] |
//! | `design.json`, `motion_dense.csv` | | [`DesignFile`], [`write_dense_motion`] |
//! | `design.json` and `evaluation.json` of poses | | [`PoseDesignFile`], [`PoseEvaluationFile`] |
//! | `poses.csv` | [`read_poses`] | [`write_poses`] |
//! | `evaluation.json`, `sweep.json`, `sweep.csv` | | [`EvaluationFile`], [`SweepFile`], [`write_sweep_csv`] |
//! | `noise.json` | | [`NoiseFile`] |
//! | `truth.json` of a simulation | [`read_calibrated_imu`], as a calibration without a covariance | [`Truth`] |
//! | residuals, exported records (CSV, Parquet) | | [`Table`] |
//! | data set of a fleet (Parquet) | `ParquetRows` | |
//! | `resume.json` of a batch | [`Finished::read`] | [`Finished::write`] |
//! | `study.json`, `summary.csv` | | [`StudyFile`], [`write_summary`] |
//!
//! Everything is SI inside; conversions happen here. No input makes the readers panic, and no NaN or infinity
//! passes them. Every error names file, line and column and gives a remedy. A reader repairs or notices
//! nothing silently: it returns a [`Diagnostic`](calibrant_core::diagnostic::Diagnostic). Every result is written beside its place and then renamed
//! ([`write_atomically`]), so it is whole or absent.

mod convention;
mod experiment;
mod files;
mod inspection;
mod machine;
mod motion;
mod recording;
mod reference_log;
mod results;
mod table;
mod text;
mod trajectory;
mod truth;

pub use convention::{
    CalibratedImuFile, ConventionOptions, ConvertedFile, ImuCore, ImuFormat, ImuNoise, RawUnits, WrittenImu,
    calibrated_imu_texts, imu_tk_files, parse_calibrated_imu, parse_estimates, read_calibrated_imu,
    read_kalibr_noise, read_measured_noise, write_calibrated_imu,
};
pub use experiment::presets::{PRESETS, Preset, preset};
pub use experiment::{
    CalibrateOptions, CriterionLetter, DesignOptions, Dwells, Experiment, ExperimentFile, HoldsPlan, ImuPlan,
    LinksKnown, MachineDesignPlan, MachineLimits, MachinePlan, MachineSimulation, MachineWorld, MotionPlan,
    NoisyVariant, Plan, Prior, ScaleBy, StudyOptions, UnknownVariant, UrdfSource, experiment_keys, nearest,
    read_acceptance, read_columns, sections as experiment_sections,
};
pub use files::atomic_output::{remove_unfinished, write_atomically, write_text};
pub use files::finished::Finished;
pub use files::hashed_file::HashedFile;
pub use files::name_pattern::NamePattern;
pub use files::result_places::{ClaimedPlaces, ResultPlaces};
pub use files::resume_key::ResumeKey;
pub use files::sensor_naming::{NamedRecording, SensorNaming};
pub use files::utc_time::UtcTime;
pub use inspection::recording::{HoldsInspection, Inspection, InspectionFile, SensorInspection, inspect};
pub use inspection::reference_log::{
    JointInspection, Jumps, PoseInspection, ReferenceInspection, ReferenceInspectionFile, Seen,
    inspect_reference_log,
};
pub use inspection::sampling::Sampling;
pub use machine::{
    FileJointLimits, LinkInChain, LinkWithoutMesh, MACHINE_PRESETS, MachineBodies, MachineFile, MissingMesh,
    Urdf, machine_preset, missing_limits, parse_joint_limits, parse_srdf, parse_stl, read_joint_limits,
    read_srdf,
};
pub use motion::commanded::{parse_motion, read_motion, write_motion};
pub use motion::dense::write_dense_motion;
pub use motion::poses::{read_poses, write_poses};
pub use recording::corrected::{check_not_corrected, write_corrected_recording};
pub use recording::ferraris_sections::{Section, SectionKind, parse_sections, read_sections};
pub use recording::{
    AccelerometerOnly, ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile,
    ImuReadOptions, ImuUnit, SampleTimes, SecondFile, TYPED_RATE_SD_PPM, TimeUnit, USUAL_RATE_SD_PPM,
    imu_from_columns, imu_pair_of, parse_imu_pair, parse_imu_recording, read_imu_pair, read_imu_recording,
    read_imu_sensor, write_imu_recording, write_recording,
};
pub use reference_log::{
    ReferenceFormat, ReferenceLogFile, ReferenceLogOptions, is_reference_log, parse_reference_log,
    read_reference_log, unusable_log, write_joint_log, write_pose_log,
};
pub use results::batch::{BatchEntry, calibrations_json};
pub use results::calibration::CalibrationFile;
pub use results::comparison::ComparisonFile;
pub use results::design::{DesignFile, DesignSetting, EvaluationFile, SweepFile};
pub use results::earlier_calibration::{EarlierCalibration, parse_calibration, read_calibration};
pub use results::earlier_machine::{EarlierMachine, parse_earlier_machine, read_earlier_machine};
pub use results::heading::{Heading, JsonFile, Kind, RECORD_KIND};
pub use results::input::{Input, file_name};
pub use results::json::{SCHEMA, to_json, write_json};
pub use results::judgement::Judgement;
pub use results::machine_calibration::{MachineCalibrationFile, MachineLogInput, MachineResult};
pub use results::noise::NoiseFile;
pub use results::origin::Origin;
pub use results::pose_design::{PoseDesignFile, PoseEvaluationFile};
pub use results::program::program;
pub use results::reach::{Reached, ReachedGoal};
#[cfg(feature = "study")]
pub use results::study::StudyFile;
pub use results::summary::{
    Failure, Summary, SummaryParameter, SummaryRow, spreadsheet_text, unit_ending, write_summary,
};
pub use results::sweep::write_sweep_csv;
pub use results::trajectory_design::{TrajectoryEvaluationFile, TrajectoryFile};
pub use results::trajectory_sweep::{TrajectorySweepFile, write_trajectory_sweep_csv};
#[cfg(feature = "parquet")]
pub use table::ParquetRows;
pub use table::{ColumnValues, Table, TableColumn, TableFormat};
pub use text::decoding::{Checked, install_with, open_file, read_text};
pub use trajectory::{
    MOST_POINTS, Trajectory, goal_text, read_trajectory, urscript_text, write_goal, write_trajectory,
    write_urscript,
};
pub use truth::machine::TrueMachine;
pub use truth::sensors::Truth;

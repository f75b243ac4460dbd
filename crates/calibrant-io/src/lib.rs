//! Files: it reads experiments and machines, and writes results. [`calibrant_recording`], which it re-exports, has the recordings, logs and motions.
//! Only these two touch files, and the records.
//!
//! | file | in | out |
//! |---|---|---|
//! | experiment (TOML) | [`Experiment::read`] | [`preset()`], [`PRESETS`] |
//! | machine (URDF) | [`Urdf::read`] | [`machine_preset()`], [`MACHINE_PRESETS`], [`MachineFile`] |
//! | shapes of its links (STL), pairs that may touch (SRDF), MoveIt's `joint_limits.yaml` | [`Urdf::bodies`], [`read_srdf`], [`read_joint_limits`] | |
//! | `calibration.json` | [`read_calibrated_imu`]; [`read_calibration`] and [`read_earlier_machine`], as what is known before a design | [`CalibrationFile`] |
//! | calibrations, ours and of other programs | [`read_calibrated_imu`] | [`write_calibrated_imu`] |
//! | comparisons, inspections | | [`ComparisonFile`], [`InspectionFile`] |
//! | `design.json` | | [`DesignFile`] |
//! | `design.json` and `campaign.csv` of a campaign over temperature | | [`CampaignFile`], [`write_campaign_csv`] |
//! | `design.json` and `evaluation.json` of poses | | [`PoseDesignFile`], [`PoseEvaluationFile`] |
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

mod convention;
mod experiment;
mod inspection;
mod machine;
mod places;
mod results;
mod truth;

pub use calibrant_recording::*;
pub use convention::{
    CalibratedImuFile, ConventionOptions, ConvertedFile, ImuCore, ImuFormat, ImuNoise, RawUnits, ReadSoak,
    TableError, WrittenImu, calibrated_imu_texts, edit_calibrated_imu, imu_tk_files, parse_calibrated_imu,
    parse_estimates, parse_soak, read_calibrated_imu, read_kalibr_noise, read_measured_noise,
    write_calibrated_imu, write_temperature_table,
};
pub use experiment::datasheets::{DATASHEETS, Datasheet};
pub use experiment::presets::{PRESETS, Preset, preset};
pub use experiment::{
    CalibrateOptions, CriterionLetter, DesignOptions, Dwells, Experiment, ExperimentFile, HoldsPlan, ImuPlan,
    LinksKnown, MachineDesignPlan, MachineLimits, MachinePlan, MachineSimulation, MachineWorld, MotionPlan,
    NoisyVariant, Plan, Prior, ScaleBy, StudyOptions, UnknownVariant, UrdfSource, experiment_keys,
    read_acceptance, read_columns, sections as experiment_sections,
};
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
pub use places::finished::Finished;
pub use places::name_pattern::NamePattern;
pub use places::result_places::{ClaimedPlaces, ResultPlaces};
pub use places::resume_key::ResumeKey;
pub use places::sensor_naming::{NamedRecording, SensorNaming};
pub use results::batch::{BatchEntry, calibrations_json};
pub use results::calibration::CalibrationFile;
pub use results::campaign::{
    CampaignFile, CampaignRow, CampaignSweepFile, read_campaign_csv, write_campaign_csv,
    write_campaign_sweep_csv,
};
pub use results::campaign_calibration::CampaignCalibrationFile;
pub use results::campaign_study::CampaignStudyFile;
pub use results::comparison::ComparisonFile;
pub use results::design::{DesignFile, DesignSetting, EvaluationFile, SweepFile};
pub use results::earlier_calibration::{EarlierCalibration, parse_calibration, read_calibration};
pub use results::earlier_machine::{EarlierMachine, parse_earlier_machine, read_earlier_machine};
pub use results::heading::{Heading, JsonFile, Kind, RECORD_KIND};
pub use results::input::{Input, PART};
pub use results::json::{SCHEMA, to_json, write_json};
pub use results::judgement::Judgement;
pub use results::machine_calibration::{MachineCalibrationFile, MachineLogInput, MachineResult};
pub use results::noise::NoiseFile;
pub use results::origin::Origin;
pub use results::pose_design::{PoseDesignFile, PoseEvaluationFile};
pub use results::reach::{Reached, ReachedGoal};
pub use results::recorded_campaign::{with_recorded_soaks, with_soaks_of};
#[cfg(feature = "study")]
pub use results::study::StudyFile;
pub use results::summary::{Failure, Summary, SummaryParameter, SummaryRow, unit_ending, write_summary};
pub use results::sweep::write_sweep_csv;
pub use results::trajectory_design::{TrajectoryEvaluationFile, TrajectoryFile};
pub use results::trajectory_sweep::{TrajectorySweepFile, write_trajectory_sweep_csv};
pub use truth::machine::TrueMachine;
pub use truth::sensors::Truth;

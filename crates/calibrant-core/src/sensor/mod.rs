//! The sensor model: what a sensor reads from its stimulus. Units, parameters, gauges, corrections,
//! recordings and checks of readings.
//!
//! A reading is `y = S s + b + ν` with `ν ~ N(0, diag σ²)`, in the direction **true → raw**. `s` is the
//! specific force in m/s². `y` is in the reading's unit (m/s² or counts), and so is the bias `b`. `S` holds
//! the scale factors on its diagonal. Off it are the cross-axis sensitivities (misalignment,
//! non-orthogonality). Terms of a [`Nonlinearity`] bend the response of an axis.

mod composition;
mod corrected_recording;
mod covariance_degrees;
mod datasheet;
pub(crate) mod entry_vector;
mod extremes;
mod frame_invariant;
mod gauge;
mod gauge_change;
mod imu;
mod imu_correction;
mod imu_json;
mod in_counts;
mod interpolation;
pub mod legendre;
mod nonlinearity;
mod omission;
mod parameters;
mod per_sensor;
mod recording;
mod recording_temperatures;
pub mod reference_temperature;
mod repeats;
mod sample_rate;
mod saturation;
mod sensor_kind;
mod shared_errors;
mod spikes;
mod temperature_model;

pub use corrected_recording::{CorrectedRecording, CorrectedSensor};
pub use covariance_degrees::CovarianceDegrees;
pub(crate) use covariance_degrees::CovariancePart;
pub use datasheet::{Parameter, Sensor, USUAL_NOISE_MPS2};
pub(crate) use extremes::quantile;
pub use extremes::{greater, lesser};
pub use frame_invariant::{Invariant, InvariantValue};
pub(crate) use gauge::times;
pub use gauge::{Correction, Gauge};
pub use imu::{CalibratedImu, Condition, ImuParameters, ImuQuantity, ImuRecording};
pub use imu_correction::ImuCorrection;
pub use imu_json::{ImuFields, ParameterKnowledge, correction_name};
pub use interpolation::interpolated;
pub use nonlinearity::{NonlinearTerm, Nonlinearity};
pub use omission::{ImuPart, OmissionError};
pub use parameters::{ParameterList, Quantity, SensorModel, SensorParameters};
pub use per_sensor::PerSensor;
pub(crate) use recording::gap_s;
pub use recording::{MeanReading, Recording};
pub use recording_temperatures::{Temperatures, WORKING_C};
pub use repeats::{Repeats, Stuck};
pub use sample_rate::{missing, rate_hz};
pub use saturation::Saturation;
pub use sensor_kind::{Axis, ReadingUnit, SensorKind};
pub use shared_errors::SharedErrors;
pub use spikes::Spikes;
pub use temperature_model::{HIGHEST_ORDER, PER_K, SensorThermal, Thermal, ThermalPart, ThermalTerm};

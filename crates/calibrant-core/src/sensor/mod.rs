//! What a sensor reports, given its stimulus.
//!
//! A reading is `y = S s + b + ν` with `ν ~ N(0, diag σ²)`, in the direction **true → raw**: `s` is the specific force in
//! m/s², `y` is in the reading's unit (m/s² or counts), `b` the bias in that unit, and `S` holds the scale factors on its
//! diagonal and the cross-axis sensitivities (misalignment, non-orthogonality) off it.

mod axis;
mod corrected;
mod datasheet;
mod described;
pub(crate) mod entries;
mod extremes;
mod gauge;
mod gauge_change;
mod imu;
mod imu_correction;
mod imu_thermal;
mod interpolation;
mod invariant;
mod mean_reading;
mod parameters;
mod rate;
mod recording;
mod referred;
mod resolution;
mod saturation;
mod sensor_kind;
mod sparks;
mod temperatures;
mod thermal;
mod unforced;
mod unit;

pub use axis::Axis;
pub use corrected::{CorrectedRecording, CorrectedTriad};
pub use datasheet::Sensor;
pub use described::Parameter;
pub use extremes::{greater, lesser};
pub(crate) use gauge::times;
pub use gauge::{Correction, Gauge};
pub use imu::{CalibratedImu, Condition, ImuParameters, ImuQuantity, ImuRecording};
pub use imu_correction::ImuCorrection;
pub use interpolation::interpolated;
pub use invariant::{Invariant, InvariantValue};
pub use mean_reading::MeanReading;
pub use parameters::{ParameterList, Quantity, SensorModel, SensorParameters};
pub use rate::{missing, rate_hz};
pub use recording::Recording;
pub(crate) use recording::gap_s;
pub use saturation::Saturation;
pub use sensor_kind::Triad;
pub use sparks::Sparks;
pub use temperatures::{Temperatures, WORKING_C};
pub use thermal::{HIGHEST_ORDER, Thermal, ThermalPart, ThermalTerm, TriadThermal};
pub use unforced::WithoutForce;
pub use unit::ReadingUnit;

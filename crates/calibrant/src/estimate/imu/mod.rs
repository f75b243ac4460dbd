//! A whole IMU from one recording: held still in several orientations and turned in between, or turned by known angles.
//!
//! Holds give the accelerometer, as in a static calibration, and the gyroscope's bias; the rotations between them give the gyroscope's matrix: gravity
//! before a rotation, carried through it by the gyroscope, is gravity after it. All of it is one least-squares problem with one covariance
//! (`joint`), in which the unknown directions of the holds form a chain whose links are the rotations.
//!
//! The weights come from the data: noise within holds, scatter between them, and the excess of the rotations' errors over their noise (`weights`). Rotations
//! that do not fit are left out and listed.
//!
//! The true frame is that of the accelerometer in its gauge; the gyroscope's matrix is given in it, so its misalignment to the accelerometer is in there. With
//! known directions (`ImuSetup::directions`) it is the frame of these directions.
//!
//! Bias and gain of both sensors may follow temperature, where the recording has one ([`ThermalModel`]).
//!
//! # References
//! `tedaldi2014`, `ferraris1995`

mod activity;
mod arc;
mod assemble;
mod both_still;
mod carried;
mod changing;
mod clocks;
mod contradiction;
mod earth;
mod exchanged;
mod faces;
mod joint;
mod known;
mod lag;
mod magnitudes;
mod mistaken;
mod mistaken_turns;
mod placing;
mod problem;
mod rates;
mod readings;
mod result;
mod rotation;
mod settle;
mod solver;
mod start;
mod still;
mod thermal;
mod tilted;
mod turned;
mod verdict;
mod weights;

pub use both_still::{find_clean_imu_holds, find_imu_holds};
pub(super) use carried::{Carried, Carrying, GyroscopeAtRest, HeldStill};
pub use clocks::ClockRate;
pub use exchanged::exchanged_sensors;
pub use known::{calibrate_imu, calibrate_imu_while};
pub use problem::{Gyroscope, ImuProblem, ImuSetup, KnownTerm, NoiseSource, Turn, WhiteNoise};
pub use result::{ImuCalibration, RotationResult, StillGyroscope, TurnResult};
pub(super) use solver::recordings;
pub use thermal::ThermalModel;
pub(super) use thermal::needed_temperatures;

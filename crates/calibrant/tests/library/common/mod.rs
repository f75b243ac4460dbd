//! Code that several tests share.
#![allow(dead_code, unused_imports)] // not every test needs everything

pub(crate) mod case;
mod data;
pub(crate) mod hand;
mod imu;
mod messages;
mod retimed;

pub(crate) use data::shared_data;
pub(crate) use imu::{
    draw_feeling_imu, draw_imu, normal, read_accelerometer, run_imu, steady_holds, steady_imu,
    unfeeling_gyroscope, xsens,
};
pub(crate) use messages::{WORDS, messages};
pub(crate) use retimed::retimed;

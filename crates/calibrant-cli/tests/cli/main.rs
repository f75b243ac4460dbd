//! The program as its users meet it: commands, files, messages, exit status.

mod apply;
mod bench;
mod broken;
mod change;
mod commands;
mod conventions;
#[path = "../../../calibrant/tests/library/common/data.rs"]
mod data;
mod design;
mod determinism;
mod examples;
mod ferraris;
mod filtered;
mod imu;
mod inspect;
mod many;
mod noise;
mod real;
mod repaired;
mod simulate;
mod temperature;
mod undetermined;
mod unfinished;
mod unnamed;
mod validation;
mod wild;

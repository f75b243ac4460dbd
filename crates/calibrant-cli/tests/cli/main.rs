//! Tests of the program as its users see it: commands, files, messages, exit status.

mod apply;
mod averages;
mod batch;
mod batch_page;
mod bench;
mod broken;
mod commands;
mod compare;
mod conventions;
#[path = "../../../calibrant/tests/library/common/data.rs"]
mod data;
mod design;
mod design_machine;
mod design_poses;
mod determinism;
mod diagnostics;
mod directions;
mod ferraris;
#[cfg(unix)]
mod guides;
mod headerless_text;
mod imu;
mod init;
mod inspect;
mod inspect_motion;
mod installation;
#[cfg(unix)]
mod interruption;
mod invalid_samples;
mod low_pass_filtered;
mod machine;
mod manners;
mod noise;
mod on_machine;
mod printed_width;
mod production_line;
mod quiet_and_color;
mod real_recordings;
mod records;
mod repaired_recordings;
mod residuals;
mod rest;
mod resume;
mod schemas;
mod sensitivity;
mod sensor_change;
mod sensor_names;
mod simulate;
mod simulate_machine;
mod temperature;
mod together;
mod truncated_bag;
mod undetermined;
mod validate_machine;
mod validation;
mod verdict;

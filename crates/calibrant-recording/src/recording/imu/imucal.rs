//! CSV of imucal and NilsPod: `n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z`. Neither units nor the sample rate are in the file.

use super::column_names;
use super::file_layout::Draft;
use super::format::{FileFormat, LEAVE_AWAY};
use crate::recording::text_header::Head;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;

pub(super) fn draft(head: &Head<'_>) -> Checked<Draft> {
    let names = head.lower_names();
    if !names.iter().any(|name| name == "gyr_x" || name == "acc_x") {
        return refuse(
            Refusal::FormatContradicted,
            "the format was given as imucal, but this file has no column acc_x or gyr_x",
            LEAVE_AWAY,
        );
    }
    Ok(Draft::new(FileFormat::Imucal, head.names.iter().map(|name| column_names::column(name)).collect()))
}

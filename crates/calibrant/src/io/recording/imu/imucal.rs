//! CSV of imucal and NilsPod: `n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z`. Neither units nor the sample rate are in the file.

use super::draft::Draft;
use super::format::FileFormat;
use super::head::Head;
use super::naming;

pub(super) fn draft(head: &Head<'_>) -> Draft {
    Draft::new(FileFormat::Imucal, head.names.iter().map(|name| naming::column(name)).collect())
}

//! CSV exports of the Movella DOT app: acceleration in m/s², rate in **deg/s**, `SampleTimeFine` in µs modulo
//! 2³². Some versions have `OutputRate:,60Hz` above the header.

use super::file_layout::Draft;
use super::format::FileFormat;
use super::unit::ImuUnit;
use super::xsens;
use crate::recording::text_header::Head;
use crate::recording::time_unit::TimeUnit;

pub(super) fn draft(head: &Head<'_>) -> Draft {
    Draft {
        time_wraps_at: Some(2.0_f64.powi(32)),
        counter_wraps_at: Some(2.0_f64.powi(16)),
        rate_hz: head.number("OutputRate").map(|rate| (rate, "OutputRate")),
        ..Draft::new(
            FileFormat::MovellaDot,
            xsens::columns(&head.names, ImuUnit::DegreePerSecond, TimeUnit::Microsecond),
        )
    }
}

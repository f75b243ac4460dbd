//! Text exports of Xsens/Movella MT Manager: acceleration in m/s², rate in rad/s, `SampleTimeFine` in 0.1 ms
//! (often empty), `PacketCounter` modulo 2¹⁶. Some versions have `// Update Rate: 100.0Hz` above the header.

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
        rate_hz: head.number("Update Rate").map(|rate| (rate, "Update Rate")),
        ..Draft::new(
            FileFormat::MtManager,
            xsens::columns(&head.names, ImuUnit::RadianPerSecond, TimeUnit::TenthMillisecond),
        )
    }
}

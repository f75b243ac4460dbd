//! The units in which files give times.

use serde::{Deserialize, Serialize};

/// Unit of a file's sample times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TimeUnit {
    /// Seconds.
    #[serde(rename = "s")]
    Second,
    /// Milliseconds.
    #[serde(rename = "ms")]
    Millisecond,
    /// Tenths of a millisecond: the ticks of `SampleTimeFine` in MT Manager's exports.
    #[serde(rename = "0.1 ms")]
    TenthMillisecond,
    /// Microseconds.
    #[serde(rename = "us", alias = "µs")]
    Microsecond,
    /// Nanoseconds.
    #[serde(rename = "ns")]
    Nanosecond,
    /// Samples: a counter, which the sample rate turns into times.
    #[serde(rename = "samples")]
    Sample,
}

impl TimeUnit {
    /// As it is printed and written: `s`, `ms`, `0.1 ms`, `µs`, `ns` or `samples`.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Second => "s",
            Self::Millisecond => "ms",
            Self::TenthMillisecond => "0.1 ms",
            Self::Microsecond => "µs",
            Self::Nanosecond => "ns",
            Self::Sample => "samples",
        }
    }

    /// The unit of this name: `s`, `ms`, `0.1 ms`, `us` or `µs`, `ns`, `samples`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        Some(match text.trim().to_lowercase().as_str() {
            "s" | "sec" | "second" | "seconds" => Self::Second,
            "ms" | "msec" | "millis" | "milliseconds" => Self::Millisecond,
            "0.1 ms" | "0.1ms" => Self::TenthMillisecond,
            "us" | "µs" | "μs" | "usec" | "micros" | "microseconds" => Self::Microsecond,
            "ns" | "nsec" | "nanos" | "nanoseconds" => Self::Nanosecond,
            "samples" | "sample" => Self::Sample,
            _ => return None,
        })
    }

    /// Ticks in a second; `None` for samples, which need a rate. (Times are divided by it: `1/1000` is no
    /// binary number.)
    #[must_use]
    pub fn per_second(self) -> Option<f64> {
        match self {
            Self::Second => Some(1.0),
            Self::Millisecond => Some(1e3),
            Self::TenthMillisecond => Some(1e4),
            Self::Microsecond => Some(1e6),
            Self::Nanosecond => Some(1e9),
            Self::Sample => None,
        }
    }
}

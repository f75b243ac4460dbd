//! The options that choose records.

use calibrant::diagnostic::Usability;
use calibrant::io::RecordFilter;

/// Which records.
#[derive(clap::Args)]
pub(super) struct Selection {
    /// Those of this sensor.
    #[arg(long, value_name = "ID")]
    sensor: Option<String>,
    /// Those of this station.
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
    /// Those with this verdict.
    #[arg(long, value_enum)]
    verdict: Option<Verdict>,
    /// Only the latest calibration of each recording.
    #[arg(long)]
    latest: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Verdict {
    Ok,
    Doubtful,
    Bad,
}

impl Selection {
    /// The options as a filter.
    pub(super) fn filter(&self) -> RecordFilter {
        RecordFilter {
            sensor: self.sensor.clone(),
            station: self.station.clone(),
            verdict: self.verdict.map(|verdict| match verdict {
                Verdict::Ok => Usability::Ok,
                Verdict::Doubtful => Usability::Doubtful,
                Verdict::Bad => Usability::Bad,
            }),
            latest: self.latest,
        }
    }
}

//! The options that choose records.

use calibrant::diagnostic::Usability;
use calibrant::records::RecordFilter;
use clap::builder::{PossibleValuesParser, TypedValueParser};

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
    #[arg(long, value_parser = verdicts())]
    verdict: Option<Usability>,
    /// Only the latest calibration of each recording.
    #[arg(long)]
    latest: bool,
}

/// The names of the verdicts, as the help lists them.
fn verdicts() -> impl TypedValueParser<Value = Usability> {
    let names = PossibleValuesParser::new(Usability::ALL.map(Usability::name));
    names.try_map(|name| Usability::parse(&name).ok_or("no verdict has this name"))
}

impl Selection {
    /// The options as a filter.
    pub(super) fn filter(&self) -> RecordFilter {
        RecordFilter {
            sensor: self.sensor.clone(),
            station: self.station.clone(),
            verdict: self.verdict,
            latest: self.latest,
        }
    }
}

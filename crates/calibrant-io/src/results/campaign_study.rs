//! `study.json` of campaigns over temperature.

use super::heading::{Heading, JsonFile};
use calibrant_campaign::{CampaignRehearsal, RehearsedCampaign, RehearsedChannel};
use calibrant_core::json::flat;
use calibrant_core::json_object;

/// The content of the `study.json` of campaigns.
#[derive(Debug, Clone, Copy)]
pub struct CampaignStudyFile<'a>(pub &'a CampaignRehearsal);

json_object! {
    /// What campaigns would have shown of many sensors.
    CampaignStudyFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        sensors: file.0.sensors,
        campaigns: file.0.campaigns.iter().map(CampaignOf).collect::<Vec<_>>(),
    }
}

impl JsonFile for CampaignStudyFile<'_> {
    const KIND: &'static str = "campaign-study";
}

struct CampaignOf<'a>(&'a RehearsedCampaign);

json_object! {
    /// A campaign, and what it would have shown.
    CampaignOf<'_> as of {
        name: &of.0.name,
        /// Their number.
        soaks: of.0.soaks,
        quantities: of.0.channels.iter().map(ChannelOf).collect::<Vec<_>>(),
        /// How many of the sensors had a warning of each code.
        warnings: &of.0.warnings,
    }
}

struct ChannelOf<'a>(&'a RehearsedChannel);

json_object! {
    /// The errors of a quantity over the range, the axes and the sensors.
    ChannelOf<'_> as of {
        name: &of.0.name,
        /// Unit of what follows.
        unit: of.0.unit,
        /// Root mean square error.
        rms: of.0.rms,
        /// Root of the mean stated variance.
        stated_sd: of.0.stated_sd,
        /// The share of 95 % intervals that hold the truth.
        coverage: of.0.coverage,
        /// Degrees of freedom of Student's t of these intervals, mean over the sensors; without it they are of the normal distribution, as the scatter between soaks is stated.
        degrees_of_freedom: of.0.degrees,
    }
}

//! The files of a campaign over temperature: `design.json`, and its timetable as `campaign.csv`.

use super::heading::{Heading, JsonFile};
use calibrant_campaign::{Campaign, Channel, PlannedCampaign, RelaxedSoak, Soak, TimedSoak, UsualCampaign};
use calibrant_core::error::Result;
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_recording::files::atomic_output::write_atomically;
use std::path::Path;

/// The content of the `design.json` of a campaign.
#[derive(Debug, Clone, Copy)]
pub struct CampaignFile<'a>(pub PlannedCampaign<'a>);

json_object! {
    /// The best campaign over temperature.
    CampaignFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// `I`, `D` or `c`.
        criterion: file.0.campaign.criterion.letter(),
        /// Value of the criterion.
        value: file.0.design.value,
        /// Time of the whole campaign.
        budget_min: file.0.campaign.budget_min,
        range_c: file.0.campaign.range_c,
        certificate: CampaignCertificate(file.0),
        channels: file.channels(),
        /// The soaks in their order.
        soaks: file.0.timetable.iter().map(TimedRow).collect::<Vec<_>>(),
        /// The optimum in which soaks may be fractions.
        relaxed: file.0.design.relaxed.soaks.iter().map(RelaxedRow).collect::<Vec<_>>(),
        /// Campaigns without a design in the same time.
        usual: file.0.usual.iter().map(|usual| UsualRow { campaign: file.0.campaign, usual }).collect::<Vec<_>>(),
    }
}

impl JsonFile for CampaignFile<'_> {
    const KIND: &'static str = "campaign";
}

impl<'a> CampaignFile<'a> {
    fn channels(&self) -> Vec<ChannelRow<'a>> {
        let of = self.0.campaign.channels.iter().zip(&self.0.design.sd).zip(&self.0.design.relaxed.sd);
        of.map(|((channel, sd), relaxed_sd)| ChannelRow { channel, sd: *sd, relaxed_sd: *relaxed_sd })
            .collect()
    }
}

struct CampaignCertificate<'a>(PlannedCampaign<'a>);

json_object! {
    /// The bound that no campaign in this time can beat.
    CampaignCertificate<'_> as of {
        /// Of soaks at temperatures of the spacing.
        lower_bound: of.0.design.relaxed.lower_bound,
        /// Of soaks at any temperatures as far apart, in steps of 0.1 K.
        lower_bound_anywhere: of.0.design.relaxed.lower_bound_anywhere,
        /// How far the campaign is above the first: relative, for criterion D in nats.
        gap: of.0.design.gap(of.0.campaign),
        /// The optimum in which soaks may be fractions.
        relaxed_value: of.0.design.relaxed.value,
        /// How fast more time lowers the criterion, per minute.
        price_per_min: of.0.design.relaxed.price_per_min,
    }
}

struct ChannelRow<'a> {
    channel: &'a Channel,
    sd: f64,
    relaxed_sd: f64,
}

json_object! {
    /// A quantity that follows temperature.
    ChannelRow<'_> as of {
        name: &of.channel.name,
        /// Unit of the standard deviations.
        unit: of.channel.unit,
        goal_sd: of.channel.goal_sd,
        /// Root of the mean variance over the range.
        sd: of.sd,
        /// The same at the relaxed optimum.
        relaxed_sd: of.relaxed_sd,
        /// Standard deviation from one block of holds.
        block_sd: of.channel.block_sd,
    }
}

struct TimedRow<'a>(&'a TimedSoak);

json_object! {
    /// A soak in its time.
    TimedRow<'_> as of {
        soak: flat(SoakRow(&of.0.soak)),
        /// When the chamber has reached the temperature.
        begin_min: of.0.begin_min,
        /// When the last hold ends.
        end_min: of.0.end_min,
    }
}

struct SoakRow<'a>(&'a Soak);

json_object! {
    SoakRow<'_> as of {
        temperature_c: of.0.temperature_c,
        /// `up`: reached from below.
        direction: of.0.direction.name(),
        /// From the end of the ramp to the first hold.
        wait_min: of.0.wait_min,
        /// Number of blocks of holds.
        blocks: of.0.blocks,
    }
}

struct RelaxedRow<'a>(&'a RelaxedSoak);

json_object! {
    /// A soak, and how many of it.
    RelaxedRow<'_> as of {
        soak: flat(SoakRow(&of.0.soak)),
        /// How many; it may be a fraction.
        count: of.0.count,
    }
}

struct UsualRow<'a> {
    campaign: &'a Campaign,
    usual: &'a UsualCampaign,
}

json_object! {
    /// A campaign without a design.
    UsualRow<'_> as of {
        every_c: of.usual.every_c,
        wait_min: of.usual.wait_min,
        /// There and back, or upwards?
        both_directions: of.usual.both,
        soaks: of.usual.soaks.len(),
        /// Blocks of holds in each.
        blocks: of.usual.soaks.first().map_or(0, |soak| soak.blocks),
        /// Value of the criterion; nothing where a coefficient stays open.
        value: of.campaign.value(&of.usual.soaks),
    }
}

/// Writes `campaign.csv`: a row for each soak, in their order.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_campaign_csv(path: &Path, timetable: &[TimedSoak]) -> Result<()> {
    write_atomically(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record([
            "soak",
            "temperature_c",
            "direction",
            "wait_min",
            "blocks",
            "begin_min",
            "end_min",
        ])?;
        for (k, TimedSoak { soak, begin_min, end_min }) in timetable.iter().enumerate() {
            let numbers =
                [soak.temperature_c, soak.wait_min, *begin_min, *end_min].map(|value| format!("{value:?}"));
            let [temperature, wait, begin, end] = numbers;
            let (number, blocks) = ((k + 1).to_string(), soak.blocks.to_string());
            csv.write_record([number, temperature, soak.direction.name().into(), wait, blocks, begin, end])?;
        }
        csv.flush()
    })
}

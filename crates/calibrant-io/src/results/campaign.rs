//! The files of a campaign over temperature: `design.json`, and its timetable as `campaign.csv`.

use super::heading::{Heading, JsonFile};
use calibrant_campaign::{
    Campaign, CampaignSweep, Channel, Direction, PlannedCampaign, RelaxedSoak, Soak, SweptCampaign,
    TimedSoak, UsualCampaign,
};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_recording::files::atomic_output::write_atomically;
use serde::Deserialize;
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

/// A row of `campaign.csv`, as far as a soak needs it.
#[derive(Debug, Clone, Deserialize)]
pub struct CampaignRow {
    temperature_c: f64,
    direction: String,
    wait_min: f64,
    blocks: usize,
}

impl CampaignRow {
    /// The soak.
    ///
    /// # Errors
    /// What makes no sense of it.
    pub fn soak(&self) -> std::result::Result<Soak, String> {
        let direction = match self.direction.as_str() {
            "up" => Direction::Up,
            "down" => Direction::Down,
            other => return Err(format!("the direction {other:?} is neither up nor down")),
        };
        let is_usual = (-100.0..=250.0).contains(&self.temperature_c) && (0.0..1e5).contains(&self.wait_min);
        if !is_usual || !(1..=1000).contains(&self.blocks) {
            let message = "a soak needs a temperature from -100 to 250 °C, a wait of 0 min or more, and 1 to 1000 blocks";
            return Err(message.to_owned());
        }
        Ok(Soak {
            temperature_c: self.temperature_c,
            direction,
            wait_min: self.wait_min,
            blocks: self.blocks,
        })
    }
}

/// Reads the soaks of `campaign.csv`: columns `temperature_c`, `direction` (`up` or `down`), `wait_min` and `blocks`.
///
/// # Errors
/// [`Error::Experiment`] with the line, where it cannot be read.
pub fn read_campaign_csv(path: &Path) -> Result<Vec<Soak>> {
    let refused = |message: String, line: Option<u64>| {
        let help = "give the campaign.csv of `calibrant design`, or the columns temperature_c,direction,wait_min,blocks";
        let error = InputError::new(Refusal::ValueInvalid, message, help).in_file(path);
        Error::experiment(line.map_or(error.clone(), |line| error.at_line(line as usize)))
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_path(path);
    let reader = reader.as_mut().map_err(|error| refused(error.to_string(), None))?;
    let mut soaks = Vec::new();
    for row in reader.deserialize() {
        let line = |soaks: &[Soak]| Some(soaks.len() as u64 + 2);
        let row: CampaignRow = row.map_err(|error| {
            refused(error.to_string(), error.position().map(csv::Position::line).or(line(&soaks)))
        })?;
        soaks.push(row.soak().map_err(|message| refused(message, line(&soaks)))?);
    }
    Ok(soaks)
}

/// The content of the `sweep.json` of campaigns.
#[derive(Debug, Clone, Copy)]
pub struct CampaignSweepFile<'a>(pub &'a CampaignSweep);

json_object! {
    /// The best campaigns over their time.
    CampaignSweepFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// The quantities, in the order of the standard deviations.
        quantities: file.0.channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>(),
        /// Their units.
        units: file.0.channels.iter().map(|channel| channel.unit).collect::<Vec<_>>(),
        campaigns: file.0.rows.iter().map(SweptRow).collect::<Vec<_>>(),
    }
}

impl JsonFile for CampaignSweepFile<'_> {
    const KIND: &'static str = "campaign-sweep";
}

struct SweptRow<'a>(&'a SweptCampaign);

json_object! {
    /// The best campaign of a time.
    SweptRow<'_> as of {
        budget_min: of.0.budget_min,
        cycles: of.0.cycles,
        soaks: of.0.design.soaks.len(),
        /// Value of the criterion.
        value: of.0.design.value,
        lower_bound: of.0.design.relaxed.lower_bound,
        /// Root of the mean variance over the range, for each quantity.
        sd: &of.0.design.sd,
    }
}

/// Writes `sweep.csv`: a row for each time.
///
/// # Errors
/// [`Error::Output`] where it cannot be written.
pub fn write_campaign_sweep_csv(path: &Path, sweep: &CampaignSweep) -> Result<()> {
    write_atomically(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        let mut header =
            ["budget_min", "cycles", "soaks", "value", "lower_bound"].map(str::to_owned).to_vec();
        header.extend(sweep.channels.iter().map(|channel| format!("{}_sd", channel.name)));
        csv.write_record(&header)?;
        for row in &sweep.rows {
            let (cycles, soaks) = (row.cycles.to_string(), row.design.soaks.len().to_string());
            let mut fields = vec![format!("{:?}", row.budget_min), cycles, soaks];
            fields
                .extend([row.design.value, row.design.relaxed.lower_bound].map(|value| format!("{value:?}")));
            fields.extend(row.design.sd.iter().map(|sd| format!("{sd:?}")));
            csv.write_record(&fields)?;
        }
        csv.flush()
    })
}

//! `calibrant design` of an experiment with `[campaign]`: the best soaks over temperature.

use super::Arguments;
use super::sweep_request::Request;
use crate::console;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::campaign::{
    Campaign, CampaignSweep, PlannedCampaign, design_over_cycles, time_needed_min, timetable, usual,
};
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{
    CampaignFile, CampaignSweepFile, to_json, with_recorded_soaks, write_campaign_csv,
    write_campaign_sweep_csv, write_json, write_text,
};
use calibrant::report::{About, campaign_sheet, campaign_sweep_sheet};
use std::ops::RangeInclusive;

pub(super) fn run(arguments: &Arguments, job: &DesignPlan, campaign: &Campaign) -> calibrant::Result<Exit> {
    refuse_other_options(arguments)?;
    let cycles = job.experiment.campaign_section().map_or(1..=1, |section| section.cycles());
    let mut campaign = campaign.clone();
    for path in &arguments.from {
        campaign = with_recorded_soaks(&campaign, path)?;
    }
    campaign.budget_min = arguments.add_min.unwrap_or(campaign.budget_min);
    let found = match &arguments.sweep {
        Some(request) => sweep(arguments, &campaign, cycles, request),
        None => best(arguments, &campaign, cycles),
    };
    found.map_err(|error| error.in_experiment(&arguments.experiment))
}

fn best(
    arguments: &Arguments,
    campaign: &Campaign,
    cycles: RangeInclusive<usize>,
) -> calibrant::Result<Exit> {
    let bar = console::spinner("the best campaign");
    let found = design_over_cycles(campaign, cycles);
    bar.finish_and_clear();
    let (campaign, found) = found?;
    let (rows, usual) = (timetable(&campaign, &found.soaks), usual(&campaign));
    let missed = campaign.channels.iter().zip(&found.sd).any(|(channel, sd)| *sd > channel.goal_sd);
    let time_needed_min = missed.then(|| time_needed_min(&campaign)).flatten();
    let output = &arguments.output;
    let planned = PlannedCampaign {
        campaign: &campaign,
        design: &found,
        timetable: &rows,
        usual: &usual,
        time_needed_min,
    };
    let file = CampaignFile(planned);
    write_json(&output.join("design.json"), &file)?;
    write_campaign_csv(&output.join("campaign.csv"), &rows)?;
    let about = about(arguments, &campaign, format!("{} min", campaign.budget_min));
    let sheet = campaign_sheet(planned, &about);
    write_text(&output.join("report.html"), &sheet.html())?;
    let files = ["campaign.csv", "report.html"].map(|name| output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, None, &files)?;
    Ok(Exit::DONE)
}

/// What time buys.
fn sweep(
    arguments: &Arguments,
    campaign: &Campaign,
    cycles: RangeInclusive<usize>,
    request: &Request,
) -> calibrant::Result<Exit> {
    if request.variable.is_some() {
        return Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            "a campaign over temperature is swept over its time alone",
            "--sweep budget=120,240,480, in min",
        )));
    }
    let bar = console::progress(request.values.len() as u64, "campaigns");
    let found = CampaignSweep::over(campaign, cycles, &request.values, |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let found = found?;
    let output = &arguments.output;
    let file = CampaignSweepFile(&found);
    write_json(&output.join("sweep.json"), &file)?;
    write_campaign_sweep_csv(&output.join("sweep.csv"), &found)?;
    let times: Vec<String> = request.values.iter().map(f64::to_string).collect();
    let about = about(arguments, campaign, format!("{} min", times.join(", ")));
    let sheet = campaign_sweep_sheet(&found, &about);
    write_text(&output.join("report.html"), &sheet.html())?;
    let files = ["sweep.csv", "report.html"].map(|name| output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, None, &files)?;
    Ok(Exit::DONE)
}

fn about(arguments: &Arguments, campaign: &Campaign, time: String) -> About {
    let range = campaign.range_c;
    let facts = [
        ("Experiment", arguments.experiment.display().to_string()),
        ("Range", format!("{} to {} °C", range[0], range[1])),
        ("Time", format!("{time}, {} K/min", campaign.ramp_k_per_min)),
        ("Criterion", campaign.criterion.letter().to_owned()),
    ];
    let recorded = arguments.from.iter().map(|path| ("Recorded before", path.display().to_string()));
    let facts = facts.into_iter().chain(recorded).map(|(name, value)| (name.to_owned(), value)).collect();
    About { title: "Campaign over temperature".into(), facts, ..About::default() }
}

fn refuse_other_options(arguments: &Arguments) -> calibrant::Result<()> {
    let given = [
        ("--evaluate", arguments.evaluate.is_some()),
        ("--reach", !arguments.reach.is_empty()),
        ("--add", arguments.add.is_some()),
        ("--criterion", arguments.criterion.is_some()),
        ("--starts", arguments.starts.is_some()),
        ("--seconds", arguments.seconds.is_some()),
        ("--gap", arguments.gap.is_some()),
        ("--sample-rate", arguments.sample_rate.is_some()),
        ("--slow", arguments.slow.is_some()),
        ("--no-certificate", arguments.no_certificate),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            format!("{option} is not for a campaign over temperature"),
            "leave it away; what a campaign minimises stands in [campaign]",
        ))),
        None => Ok(()),
    }
}

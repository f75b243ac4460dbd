//! `calibrant design` of an experiment with `[campaign]`: the best soaks over temperature.

use super::Arguments;
use crate::console;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::campaign::{Campaign, PlannedCampaign, design, timetable, usual};
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{CampaignFile, to_json, write_campaign_csv, write_json, write_text};
use calibrant::report::{About, campaign_sheet};

pub(super) fn run(arguments: &Arguments, job: &DesignPlan, campaign: &Campaign) -> calibrant::Result<Exit> {
    refuse_other_options(arguments, job)?;
    let bar = console::spinner("the best campaign");
    let found = design(campaign);
    bar.finish_and_clear();
    let found = found.map_err(|error| error.in_experiment(&arguments.experiment))?;
    let (rows, usual) = (timetable(campaign, &found.soaks), usual(campaign));
    let output = &arguments.output;
    let planned = PlannedCampaign { campaign, design: &found, timetable: &rows, usual: &usual };
    let file = CampaignFile(planned);
    write_json(&output.join("design.json"), &file)?;
    write_campaign_csv(&output.join("campaign.csv"), &rows)?;
    let range = campaign.range_c;
    let facts = [
        ("Experiment", arguments.experiment.display().to_string()),
        ("Range", format!("{} to {} °C", range[0], range[1])),
        ("Time", format!("{} min, {} K/min", campaign.budget_min, campaign.ramp_k_per_min)),
        ("Criterion", campaign.criterion.letter().to_owned()),
    ];
    let facts = facts.map(|(name, value)| (name.to_owned(), value)).to_vec();
    let about = About { title: "Campaign over temperature".into(), facts, ..About::default() };
    let sheet = campaign_sheet(planned, &about);
    write_text(&output.join("report.html"), &sheet.html())?;
    let files = ["campaign.csv", "report.html"].map(|name| output.join(name));
    console::result(arguments.json, || to_json(&file), &sheet, None, &files)?;
    Ok(Exit::DONE)
}

fn refuse_other_options(arguments: &Arguments, job: &DesignPlan) -> calibrant::Result<()> {
    let given = [
        ("--from", !job.earlier.is_empty()),
        ("--evaluate", arguments.evaluate.is_some()),
        ("--sweep", arguments.sweep.is_some()),
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

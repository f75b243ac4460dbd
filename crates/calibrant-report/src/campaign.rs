//! The sheet of a campaign over temperature: how good it is, beside what is usual, and its timetable.

use super::figure::{DisplayUnit, sd_over_temperature, sd_over_time, temperature_over_time};
use super::report_context::About;
use crate::number_format::{counted, plain, significant};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Table};
use calibrant_campaign::{
    CampaignCriterion, CampaignRehearsal, CampaignSweep, Channel, MOST_TIMES, PlannedCampaign, TimedSoak,
    UsualCampaign,
};
use nalgebra::DMatrix;

/// The best campaign as a sheet.
#[must_use]
pub fn campaign_sheet<'a>(of: PlannedCampaign<'a>, about: &'a About) -> Sheet<'a> {
    let beyond = missed(of);
    let (grade, word) = if beyond.is_empty() {
        (Grade::Good, "✓ All goals are met.")
    } else {
        (Grade::Caution, "! Not all goals are met in this time.")
    };
    let verdict = SheetVerdict::new(grade, word, sentence(of))
        .with("Goals", beyond)
        .with("Findings", about.findings.clone());
    let mut channels = Section::new("Standard deviations over the range").lead(
        "Root of the mean variance over the range of temperatures. A campaign in the same time is beside it: evenly spaced soaks, as many blocks of holds in each as fit.",
    );
    channels.table(channel_table(of));
    channels.figure(move || Some(sd_over_temperature(of.campaign, &campaigns(of))));
    channels.line(usual_in_words(of));
    let mut table = Section::new("Timetable").lead(
        "Temperature of the chamber, from where it is reached, wait, and number of blocks (six faces each). Times count from the start at room temperature, at the stated rate.",
    );
    table.figure(move || Some(temperature_over_time(of.timetable)));
    table.table(timetable(of.timetable));
    table.explanation(
        "The first soak, and an end of the range, are reached from the side that is said only if the chamber comes from a few kelvin beyond, which are not counted. Directions and waits that a calibration uses come from the recorded temperature.",
    );
    let mut bound = Section::on_page("The lower bound");
    bound.explanation(format!(
        "The bound is that of the relaxed problem, in which soaks may be fractions: no campaign in this time has a lower criterion, with soaks at temperatures {} K apart. With soaks at \
         any temperatures at least as far apart, examined in steps of 0.1 K, the bound is {}. Both are of waits in steps of half a time constant, up to six, and of at most 12 blocks in a soak. \
         The priors are as stated in [campaign].",
        plain(of.campaign.spacing_c, 3),
        significant(of.design.relaxed.lower_bound_anywhere, 4)
    ));
    about.sheet("Campaign", verdict, vec![channels, table, bound], MEANING)
}

/// What the numbers mean.
const MEANING: &str = "q(T) = Σ c_m P_m(x) is the mean of both branches; sd is the standard deviation.";

/// The channels whose goal is missed.
fn missed(of: PlannedCampaign<'_>) -> Vec<String> {
    let goals = of.campaign.channels.iter().zip(&of.design.sd).filter(|(channel, sd)| **sd > channel.goal_sd);
    let times = |(channel, sd): (&Channel, &f64)| {
        format!("{}: {} times the goal", channel.name, significant(sd / channel.goal_sd, 3))
    };
    goals.map(times).collect()
}

/// What would meet the goals that are missed; a proof where the bound says that no campaign does.
fn out_of_reach(of: PlannedCampaign<'_>) -> String {
    let (bound, count) = (of.design.relaxed.lower_bound, of.campaign.channels.len() as f64);
    if of.campaign.criterion != CampaignCriterion::I || missed(of).is_empty() {
        return String::new();
    }
    // the bound is of the mean of all goals: one may be missed where that is met
    if bound <= count {
        return " More time helps, or larger goals of what is met easily: those that are missed then weigh more.".to_owned();
    }
    let more = of.time_needed_min.map_or_else(
        || {
            format!(
                "Nor does the relaxed one in {MOST_TIMES} times the time, on average: ease the goals, or make soaks more repeatable (soak_sd)."
            )
        },
        |minutes| {
            format!(
                "On average they need at least about {} h: try budget_min = {}.",
                significant(minutes / 60.0, 3),
                plain((1.02 * minutes).ceil(), 6)
            )
        },
    );
    format!(
        " No campaign in this time meets all goals: the mean variance is at least {} times that of the goals. {more}",
        significant(bound / count, 3)
    )
}

fn sentence(of: PlannedCampaign<'_>) -> String {
    let gap = of.design.gap(of.campaign);
    let soaking_min: f64 = of.design.soaks.iter().map(|soak| of.campaign.minutes(soak)).sum();
    let above = if of.campaign.criterion.is_logarithm() {
        format!("{} nats", significant(gap, 2))
    } else {
        format!("{} %", significant(100.0 * gap, 2))
    };
    let price = of.design.relaxed.price_per_min;
    let more = if price > 0.0 {
        format!("More time lowers it by {} per minute at first.", significant(price, 2))
    } else {
        "Each soak has as many blocks as it may: of more time, only more cycles make use.".to_owned()
    };
    format!(
        "{} in {} of {} min; the criterion, {}, is {above} above the bound. {more}{}",
        counted(of.design.soaks.len(), "soak"),
        plain(of.campaign.travel_min() + soaking_min, 4),
        plain(of.campaign.budget_min, 6),
        significant(of.design.value, 4),
        out_of_reach(of)
    )
}

/// The usual campaigns, compared by the criterion.
fn usual_in_words(of: PlannedCampaign<'_>) -> String {
    let compared = of.usual.iter().filter_map(|usual| {
        let value = of.campaign.value(&usual.soaks)?;
        Some(if of.campaign.criterion.is_logarithm() {
            format!("{}: {} nats more", usual_name(usual), significant(value - of.design.value, 3))
        } else {
            format!("{}: {} times the criterion", usual_name(usual), significant(value / of.design.value, 3))
        })
    });
    let compared: Vec<String> = compared.collect();
    if compared.is_empty() { "no usual campaign fits into this time".into() } else { compared.join("; ") }
}

/// A usual campaign in words.
#[must_use]
pub fn usual_name(usual: &UsualCampaign) -> String {
    let way = if usual.both { "there and back" } else { "upwards" };
    let wait = if usual.wait_min > 0.0 {
        format!("{} min wait", plain(usual.wait_min, 3))
    } else {
        "no wait".into()
    };
    format!("every {} °C {way}, {wait}", plain(usual.every_c, 3))
}

/// The designed campaign, and the best of the usual ones there and back, and upwards.
fn campaigns(of: PlannedCampaign<'_>) -> Vec<(String, Vec<DMatrix<f64>>)> {
    let best = |both: bool| {
        let these = of.usual.iter().filter(move |usual| usual.both == both);
        let valued = these.filter_map(|usual| Some((usual, of.campaign.value(&usual.soaks)?)));
        valued.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(usual, _)| usual)
    };
    let usual = [best(true), best(false)].into_iter().flatten();
    let usual = usual.map(|usual| (usual_name(usual), of.campaign.information(&usual.soaks)));
    std::iter::once(("this campaign".to_owned(), of.campaign.information(&of.design.soaks)))
        .chain(usual)
        .collect()
}

fn channel_table(of: PlannedCampaign<'_>) -> Table {
    let campaigns = campaigns(of);
    let sds: Vec<_> = campaigns.iter().map(|(_, information)| of.campaign.sd(information)).collect();
    let mut columns: Vec<Column> = vec!["quantity".into(), "unit".into(), "goal".into()];
    columns.extend(campaigns.iter().map(|(name, _)| Column::new(name.clone())));
    let mut table = Table::new(columns);
    for (number, channel) in of.campaign.channels.iter().enumerate() {
        let unit = DisplayUnit::suited_to(channel.unit, [of.design.sd[number]]);
        let mut row = vec![
            Cell::name(channel.name.clone()),
            unit.cell(channel.unit),
            Cell::sd(channel.goal_sd, unit.factor),
        ];
        row.extend(
            sds.iter().map(|sd| sd.as_ref().map_or(Cell::Missing, |sd| Cell::sd(sd[number], unit.factor))),
        );
        table.row(row);
    }
    table
}

fn timetable(rows: &[TimedSoak]) -> Table {
    let mut table = Table::new([
        Column::new("soak"),
        Column::new("temperature").in_unit("°C"),
        Column::new("reached"),
        Column::new("wait").in_unit("min"),
        Column::new("blocks"),
        Column::new("begin").in_unit("min"),
        Column::new("end").in_unit("min"),
    ]);
    for (k, row) in rows.iter().enumerate() {
        table.row(vec![
            Cell::name((k + 1).to_string()),
            Cell::fixed(row.soak.temperature_c, 1),
            Cell::text(match row.soak.direction {
                calibrant_campaign::Direction::Up => "from below",
                calibrant_campaign::Direction::Down => "from above",
            }),
            Cell::fixed(row.soak.wait_min, 1),
            Cell::count(row.soak.blocks),
            Cell::fixed(row.begin_min, 1),
            Cell::fixed(row.end_min, 1),
        ]);
    }
    table
}

/// The best campaigns over their time as a sheet.
#[must_use]
pub fn campaign_sweep_sheet<'a>(of: &'a CampaignSweep, about: &'a About) -> Sheet<'a> {
    let mut times = Section::new("Standard deviations over time").lead(
        "Root of the mean variance over the range of temperatures, of the best campaign that was found in each time; the bound is that of the criterion.",
    );
    let mut columns = vec![
        Column::new("time").in_unit("h"),
        Column::new("soaks"),
        Column::new("criterion"),
        Column::new("bound"),
    ];
    columns.extend(of.channels.iter().map(|channel| Column::new(channel.name.clone()).in_unit(channel.unit)));
    let mut table = Table::new(columns);
    for row in &of.rows {
        let mut cells = vec![
            Cell::fixed(row.budget_min / 60.0, 2),
            Cell::count(row.design.soaks.len()),
            Cell::significant(row.design.value, 4),
            Cell::significant(row.design.relaxed.lower_bound, 4),
        ];
        cells.extend(row.design.sd.iter().map(|sd| Cell::sd(*sd, 1.0)));
        table.row(cells);
    }
    times.figure(move || Some(sd_over_time(of)));
    times.table(table);
    let first = of.rows.first().zip(of.rows.last());
    let sentence = first.map_or_else(String::new, |(first, last)| {
        let ratio = |k: usize| last.design.sd[k] / first.design.sd[k];
        let ratios: Vec<String> = (0..of.channels.len())
            .map(|k| format!("{} {}", of.channels[k].name, significant(ratio(k), 2)))
            .collect();
        format!(
            "From {} to {} h, standard deviations are multiplied: {}.",
            significant(first.budget_min / 60.0, 3),
            significant(last.budget_min / 60.0, 3),
            ratios.join(", ")
        )
    });
    about.sheet(
        "Campaigns",
        SheetVerdict::new(Grade::Good, "What time buys.", sentence),
        vec![times],
        MEANING,
    )
}

/// What campaigns would have shown of many sensors, as a sheet.
#[must_use]
pub fn campaign_study_sheet<'a>(of: &CampaignRehearsal, about: &'a About) -> Sheet<'a> {
    let mut errors = Section::new("Errors over the range").lead(
        "Root mean square error of the mean of both branches over range, axes and sensors, the standard deviation that the calibrations state, and the share of their 95 % intervals that hold the truth. The intervals are of Student's t, with the degrees of freedom of that variance; normal where too few soaks find the scatter between them.",
    );
    let mut table = Table::new([
        Column::new("quantity"),
        Column::new("campaign"),
        Column::new("rms error"),
        Column::new("stated sd"),
        Column::new("unit"),
        Column::new("coverage").in_unit("%"),
        Column::new("interval"),
    ]);
    for number in 0..of.campaigns.first().map_or(0, |campaign| campaign.channels.len()) {
        for campaign in &of.campaigns {
            let channel = &campaign.channels[number];
            let unit = DisplayUnit::suited_to(channel.unit, [channel.rms]);
            table.row(vec![
                Cell::name(channel.name.clone()),
                Cell::text(campaign.name.clone()),
                Cell::sd(channel.rms, unit.factor),
                Cell::sd(channel.stated_sd, unit.factor),
                unit.cell(channel.unit),
                Cell::fixed(100.0 * channel.coverage, 1),
                Cell::text(channel.degrees.map_or_else(|| "normal".to_owned(), |of| format!("t, {of:.0}"))),
            ]);
        }
    }
    errors.table(table);
    for campaign in &of.campaigns {
        let warnings: Vec<String> =
            campaign.warnings.iter().map(|(code, count)| format!("{code} {count}")).collect();
        let warnings = if warnings.is_empty() { "none".to_owned() } else { warnings.join(", ") };
        errors.line(format!("{}, {}: warnings {warnings}", campaign.name, counted(campaign.soaks, "soak")));
    }
    let sentence = format!(
        "{} drawn from what [campaign] says of them; warnings count the sensors.",
        counted(of.sensors, "sensor")
    );
    about.sheet(
        "Rehearsal of campaigns",
        SheetVerdict::new(Grade::Good, "Rehearsed.", sentence),
        vec![errors],
        MEANING,
    )
}

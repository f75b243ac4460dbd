//! The sheet of a calibration over temperature: what follows temperature and how well it is known, the soaks beside it, and the parameters.

use super::figure::{DisplayUnit, curves_over_temperature, residuals_of_soaks};
use super::report_context::About;
use super::validation::validation_section;
use crate::number_format::{counted, plain, significant};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Table};
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, FittedSoak};
use calibrant_core::diagnostic::{Diagnostic, Severity, Usability};
use calibrant_core::estimate::Validation;

/// A calibration over temperature as a sheet.
#[must_use]
pub fn campaign_fit_sheet<'a>(
    of: &'a FittedCampaign,
    model: &'a CampaignModel,
    validations: &'a [Validation],
    about: &'a About,
) -> Sheet<'a> {
    let usability = about.verdict.as_ref().map_or(Usability::Ok, |verdict| verdict.usability);
    let (grade, word) = match usability {
        Usability::Ok if missed(of).is_empty() => (Grade::Good, "✓ Usable."),
        Usability::Ok => (Grade::Caution, "! Usable, but short of the goals."),
        Usability::Doubtful => (Grade::Caution, "! Doubtful: read the warnings first."),
        Usability::Bad => (Grade::Bad, "✗ Do not use it."),
    };
    let told = |severity: Severity| -> Vec<String> {
        let these = of.warnings.iter().filter(|found| found.severity() == severity);
        these.map(Diagnostic::without_file).collect()
    };
    let verdict = SheetVerdict::new(grade, word, sentence(of, model))
        .with("Warnings", told(Severity::Warning))
        .with("Remarks", told(Severity::Note));
    let mut channels = Section::new("Over temperature").lead(
        "sd: root of the mean variance of the polynomial over the range and the axes, without what all soaks share, such as gravity that is not exactly known. Scatter: what does not average within a soak. Left out: each soak less what the others predict of it, over the predicted standard deviation, rms; 1 where these hold. Probabilities are those of chance: small ones show hysteresis, or a lag of the thermometer.",
    );
    channels.table(channel_table(of));
    channels.figure(move || Some(curves_over_temperature(of, model)));
    let mut soaks = Section::new("Soaks").lead(
        "Each soak beside the fit: from where it came to its temperature, the share of the ramp's rate that was left, and its residual that is farthest off, in standard deviations.",
    );
    soaks.figure(move || Some(residuals_of_soaks(of)));
    soaks.table(soak_table(of));
    let mut parameters = Section::on_page("Parameters").lead(format!(
        "Biases and gains at {} °C, and their temperature terms in powers of the difference from it.",
        plain(model.reference_c, 4)
    ));
    parameters.table(parameter_table(of));
    let sections = [channels, soaks].into_iter().chain(validation_section(validations)).chain([parameters]);
    about.sheet("Calibration over temperature", verdict, sections.collect(), MEANING)
}

/// What the numbers mean.
const MEANING: &str = "Readings are y = S(T) s + b(T) + ν (true → raw); the polynomials are the mean of both branches; sd is the standard deviation.";

fn sentence(of: &FittedCampaign, model: &CampaignModel) -> String {
    let range = of.imu.parameters.thermal.range_c.unwrap_or(model.campaign.range_c);
    let missed = missed(of);
    let goals = if of.with_gain.is_some() {
        String::new()
    } else if missed.is_empty() {
        " All goals are met.".to_owned()
    } else {
        format!(" Goals are exceeded: {}.", missed.join(", "))
    };
    format!(
        "{} from {} to {} °C.{goals}",
        counted(of.soaks.len(), if of.with_gain.is_some() { "piece" } else { "soak" }),
        plain(range[0], 3),
        plain(range[1], 3)
    )
}

/// The channels whose goal is missed, by how many times.
fn missed(of: &FittedCampaign) -> Vec<String> {
    // a recording in one pose has no goals
    let has_goals = of.with_gain.is_none();
    let missed = of.channels.iter().filter(|channel| has_goals && channel.sd() > channel.channel.goal_sd);
    let times = missed.map(|channel| (&channel.channel.name, channel.sd() / channel.channel.goal_sd));
    times.map(|(name, times)| format!("{name} {} times", significant(times, 2))).collect()
}

fn channel_table(of: &FittedCampaign) -> Table {
    let mut table = Table::new([
        Column::new("quantity"),
        Column::new("order"),
        Column::new("unit"),
        Column::new("goal"),
        Column::new("sd"),
        Column::new("scatter"),
        Column::on_page("left out"),
        Column::on_page("hysteresis by chance"),
        Column::on_page("lag by chance"),
    ]);
    for fitted in &of.channels {
        let (channel, sd) = (&fitted.channel, fitted.sd());
        let unit = DisplayUnit::suited_to(channel.unit, [sd]);
        let probability = |test: &Option<calibrant_campaign::fit::WaldTest>| {
            test.as_ref().map_or(Cell::Missing, |test| Cell::probability(test.p_value))
        };
        table.row(vec![
            Cell::name(channel.name.clone()),
            Cell::count(fitted.order),
            unit.cell(channel.unit),
            Cell::sd(channel.goal_sd, unit.factor),
            Cell::sd(sd, unit.factor),
            Cell::sd(fitted.scatter.soak_sd, unit.factor),
            fitted.left_out_ratio.map_or(Cell::Missing, |ratio| Cell::fixed(ratio, 2)),
            probability(&fitted.hysteresis),
            probability(&fitted.lag),
        ]);
    }
    table
}

fn soak_table(of: &FittedCampaign) -> Table {
    let mut table = Table::new([
        Column::new("soak"),
        Column::new("at").in_unit("°C"),
        Column::new("reached"),
        Column::new("left").in_unit("%"),
        Column::new("residual").in_unit("sd"),
        Column::new("of"),
    ]);
    for soak in &of.soaks {
        let (name, deviations) = farthest(of, soak);
        table.row(vec![
            Cell::name(soak.name.clone()),
            Cell::fixed(soak.path.temperature_c, 1),
            Cell::text(match soak.path.direction {
                0.0 => "unknown",
                up if up > 0.0 => "from below",
                _ => "from above",
            }),
            Cell::fixed(100.0 * soak.path.lag_left, 0),
            Cell::fixed(deviations, 1),
            Cell::name(name),
        ]);
    }
    table
}

/// The channel whose residual is farthest off, and by how many standard deviations.
fn farthest(of: &FittedCampaign, soak: &FittedSoak) -> (String, f64) {
    let of_channel = |(channel, (residuals, sds)): (usize, (&Vec<f64>, &Vec<f64>))| {
        let off = residuals.iter().zip(sds).filter(|(_, sd)| **sd > 0.0).map(|(residual, sd)| residual / sd);
        off.map(|off| (channel, off)).collect::<Vec<_>>()
    };
    let all = soak.residuals.iter().zip(&soak.residual_sds).enumerate().flat_map(of_channel);
    let worst = all.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
    worst.map_or((String::new(), 0.0), |(channel, off)| {
        (of.channels.get(channel).map_or_else(String::new, |of| of.channel.name.clone()), off)
    })
}

fn parameter_table(of: &FittedCampaign) -> Table {
    let mut table = Table::new(["parameter", "estimate ± sd", "unit"].map(Column::new));
    let imu = &of.imu;
    for (k, quantity) in imu.quantities.iter().enumerate() {
        let variance = imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(k, k)]);
        table.row(vec![
            Cell::name(quantity.name()),
            Cell::estimate(quantity.value(&imu.parameters), variance.max(0.0).sqrt()),
            Cell::unit(imu.unit_of(*quantity)),
        ]);
    }
    table
}

//! The figures of a campaign over temperature: standard deviations over the range, and the temperature over time.

use super::panel::{Panel, Series, Shape};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_campaign::{Campaign, CampaignSweep, Direction, TimedSoak};
use nalgebra::DMatrix;

/// Places over the range.
const PLACES: usize = 81;
/// Colour and dashes of the designed campaign, and of each usual one.
const LOOKS: [(&str, &str); 4] =
    [(colour::BLUE, ""), (colour::ORANGE, "7 3"), (colour::VERMILLION, "2 3"), (colour::GREY, "9 3 2 3")];

/// Standard deviation of each quantity over the range. `campaigns`: name, and what is known of each channel after it.
pub(crate) fn sd_over_temperature(campaign: &Campaign, campaigns: &[(String, Vec<DMatrix<f64>>)]) -> Figure {
    let [low, high] = campaign.range_c;
    let at = |k: usize| low + (high - low) * k as f64 / (PLACES - 1) as f64;
    let panel = |(number, channel): (usize, &calibrant_campaign::Channel)| {
        let curve = |of: &[DMatrix<f64>]| -> Vec<(f64, f64)> {
            let sd = |k| Some((at(k), campaign.sd_at(channel, &of[number], at(k))?));
            (0..PLACES).filter_map(sd).collect()
        };
        let curves: Vec<_> = campaigns.iter().map(|(_, of)| curve(of)).collect();
        let unit = DisplayUnit::suited_to(channel.unit, curves[0].iter().map(|(_, sd)| *sd));
        let mut panel = Panel::new(channel.name.clone(), "temperature (°C)", unit.label("sd"));
        for ((curve, (name, _)), (colour, dashes)) in curves.iter().zip(campaigns).zip(LOOKS) {
            let scaled = curve.iter().map(|(t, sd)| (*t, sd * unit.factor)).collect();
            panel = panel.with(Series::stroke(name, colour, (1.8, dashes), scaled));
        }
        let goal = [low, high].map(|t| (t, channel.goal_sd * unit.factor)).to_vec();
        panel.with(Series::stroke("goal", colour::BLACK, (1.0, "1 3"), goal)).log_or_from_zero(true)
    };
    let panels = campaign.channels.iter().enumerate().map(panel).collect();
    let caption = "Standard deviation of the mean of both branches after the campaign: what is not corrected of hysteresis is not in it. The goal is meant on average over the range. \
         The vertical axes are logarithmic.";
    Figure::new("Standard deviation over temperature", panels, caption.to_owned()).with_columns(2)
}

/// The temperature of the chamber over time.
pub(crate) fn temperature_over_time(rows: &[TimedSoak]) -> Figure {
    let line =
        rows.iter().flat_map(|row| [row.begin_min, row.end_min].map(|t| (t / 60.0, row.soak.temperature_c)));
    let of = |direction: Direction| {
        let here = rows.iter().filter(move |row| row.soak.direction == direction);
        here.map(|row| (row.end_min / 60.0, row.soak.temperature_c)).collect()
    };
    let panel = Panel::new("", "time (h)", "chamber (°C)")
        .with(Series::stroke("chamber", colour::GREY, (1.4, ""), line.collect()))
        .with(Series::dots(
            "reached from below",
            colour::VERMILLION,
            (Shape::Triangle, 4.0),
            of(Direction::Up),
        ))
        .with(Series::dots("reached from above", colour::BLUE, (Shape::Square, 3.4), of(Direction::Down)));
    let caption = "Level pieces are soaks, wait and holds; a marker stands at the end of each.";
    Figure::new("The chamber over time", vec![panel], caption.to_owned())
}

/// Standard deviation of each quantity over the time of the campaign.
pub(crate) fn sd_over_time(of: &CampaignSweep) -> Figure {
    let panel = |(number, channel): (usize, &calibrant_campaign::Channel)| {
        let points: Vec<_> =
            of.rows.iter().map(|row| (row.budget_min / 60.0, row.design.sd[number])).collect();
        let unit = DisplayUnit::suited_to(channel.unit, points.iter().map(|(_, sd)| *sd));
        let scaled: Vec<_> = points.iter().map(|(t, sd)| (*t, sd * unit.factor)).collect();
        let ends = [points.first(), points.last()].into_iter().flatten();
        let goal = ends.map(|(t, _)| (*t, channel.goal_sd * unit.factor)).collect();
        Panel::new(channel.name.clone(), "time (h)", unit.label("sd"))
            .with(Series::line("best campaign", colour::BLUE, scaled.clone()))
            .with(Series::dots("", colour::BLUE, (Shape::Circle, 3.0), scaled))
            .with(Series::stroke("goal", colour::BLACK, (1.0, "1 3"), goal))
            .log_or_from_zero(true)
    };
    let panels = of.channels.iter().enumerate().map(panel).collect();
    let caption = "Standard deviation, root of the mean variance over the range, of the best campaign in each time. The vertical axes are logarithmic.";
    Figure::new("Standard deviation over time", panels, caption.to_owned()).with_columns(2)
}

//! The figures of a calibration over temperature: the polynomials, and the residuals of the soaks.

use super::panel::{Panel, Series, Shape};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, FittedChannel};

/// Places over the range.
const PLACES: usize = 81;
/// Colour and dashes of each axis.
const AXES: [(&str, &str, &str); 3] =
    [("x", colour::BLUE, ""), ("y", colour::VERMILLION, "7 3"), ("z", colour::BLACK, "2 3")];

/// Each quantity over the range, less its value in the middle, within twice its standard deviation.
pub(crate) fn curves_over_temperature(of: &FittedCampaign, model: &CampaignModel) -> Figure {
    let [low, high] = model.campaign.range_c;
    let panel = |(number, channel): (usize, &FittedChannel)| {
        let at = |axis: usize, k: usize| {
            let x = -1.0 + 2.0 * k as f64 / (PLACES - 1) as f64;
            let (value, sd) = channel.at(axis, x);
            (low + (high - low) * 0.5 * (x + 1.0), value - channel.at(axis, 0.0).0, sd)
        };
        let axes: Vec<Vec<_>> =
            (0..channel.coefficients.len()).map(|axis| (0..PLACES).map(|k| at(axis, k)).collect()).collect();
        let unit =
            DisplayUnit::suited_to(channel.channel.unit, axes.iter().flatten().map(|(_, value, _)| *value));
        let mut panel = Panel::new(channel.channel.name.clone(), "temperature (°C)", unit.label("change"));
        for (number_of_axis, (points, (label, colour, dashes))) in axes.iter().zip(AXES).enumerate() {
            let line: Vec<_> = points.iter().map(|(t, value, _)| (*t, value * unit.factor)).collect();
            let spread = points.iter().map(|(_, _, sd)| 2.0 * sd * unit.factor).collect();
            panel = panel.with(Series::band("", colour, line.clone(), spread));
            panel = panel.with(Series::stroke(label, colour, (1.6, dashes), line));
            let middle = channel.at(number_of_axis, 0.0).0;
            let soaks = of.soaks.iter().filter_map(|soak| {
                let value = soak.values.get(number)?.get(number_of_axis)?;
                Some((soak.path.temperature_c, (value - middle) * unit.factor))
            });
            panel = panel.with(Series::dots("", colour, (Shape::Circle, 2.0), soaks.collect()));
        }
        panel
    };
    let panels = of.channels.iter().enumerate().map(panel).collect();
    let caption = "Change of each axis from the middle of the range: the mean of both branches, within twice its standard deviation, and the soaks. Gains are relative.";
    Figure::new("Over temperature", panels, caption.to_owned()).with_columns(2)
}

/// What each soak differs by from the fit, in standard deviations.
pub(crate) fn residuals_of_soaks(of: &FittedCampaign) -> Figure {
    let panel = |(number, channel): (usize, &FittedChannel)| {
        let deviations = |from_below: bool| -> Vec<(f64, f64)> {
            let here = of.soaks.iter().filter(move |soak| (soak.path.direction > 0.0) == from_below);
            here.flat_map(|soak| {
                let (residuals, sds) = (&soak.residuals[number], &soak.residual_sds[number]);
                let off = residuals.iter().zip(sds).filter(|(_, sd)| **sd > 0.0);
                off.map(|(residual, sd)| (soak.path.temperature_c, residual / sd)).collect::<Vec<_>>()
            })
            .collect()
        };
        Panel::new(channel.channel.name.clone(), "temperature (°C)", "residual (sd)".to_owned())
            .with(Series::dots(
                "reached from below",
                colour::VERMILLION,
                (Shape::Triangle, 3.6),
                deviations(true),
            ))
            .with(Series::dots("reached from above", colour::BLUE, (Shape::Square, 3.0), deviations(false)))
    };
    let panels = of.channels.iter().enumerate().map(panel).collect();
    let caption = "Residual of each soak and axis after hysteresis and lag, over its standard deviation. Where the two sides part, hysteresis or lag has another shape than supposed.";
    Figure::new("Residuals of the soaks", panels, caption.to_owned()).with_columns(2)
}

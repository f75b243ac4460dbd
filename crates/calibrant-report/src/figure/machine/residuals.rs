//! Residuals of a sensor on a machine over time, with the machine's speed beside them.

use super::scene::Scene;
use crate::figure::panel::{Mark, Panel, Series};
use crate::figure::point_thinning::{is_thinned, thinned};
use crate::figure::unit::DisplayUnit;
use crate::figure::{Figure, colour};
use calibrant_core::sensor::{Axis, SensorKind};
use calibrant_machine::estimate::SensorResidual;

/// Residuals of each axis, and the speed of the tip. `unit` is that of the readings.
pub(crate) fn residuals_and_speed(noise: &SensorResidual, unit: &'static str, scene: &Scene) -> Figure {
    let residuals = &noise.residuals;
    let unit = DisplayUnit::suited_to(unit, noise.rms.iter().map(|rms| 3.0 * rms));
    let thin = Mark::Line { width: 0.7, dashes: "" };
    let ends = residuals.first().zip(residuals.last()).map(|(first, last)| [first.time_s, last.time_s]);
    let mut panels: Vec<Panel> = Axis::ALL
        .iter()
        .map(|axis| {
            let k = axis.index();
            let points = thinned(residuals.iter().map(|of| (of.time_s, unit.factor * of.value[k])));
            let mut panel = Panel::new(format!("axis {axis}"), "time (s)", unit.label("residual"))
                .with(Series::new("residual", colour::BLUE, thin, points));
            for level in [2.0, -2.0] {
                let line =
                    ends.map(|ends| ends.map(|time| (time, level * unit.factor * noise.noise[k])).to_vec());
                let label = match noise.growth {
                    Some(_) => "±2 sd of the noise at rest",
                    None => "±2 sd of the noise",
                };
                panel = panel.with(Series::dashed(label, colour::BLACK, line.unwrap_or_default()));
            }
            panel
        })
        .collect();
    let (what, label, factor) = match noise.sensor {
        SensorKind::Accelerometer => ("speed", "speed (m/s)", 1.0),
        SensorKind::Gyroscope => ("angular rate", "rate (°/s)", 1.0_f64.to_degrees()),
    };
    let of = |posture: &calibrant_machine::reference::Posture| match noise.sensor {
        SensorKind::Accelerometer => posture.speed_mps,
        SensorKind::Gyroscope => factor * posture.rate_radps,
    };
    let speed = thinned(scene.path.iter().map(|posture| (posture.time_s, of(posture))));
    let what = format!("{what} of the {}", if scene.is_chain { "tip" } else { "body" });
    let line = Mark::Line { width: 1.2, dashes: "" };
    panels.push(Panel::new(what, "time (s)", label).with(Series::new("motion", colour::ORANGE, line, speed)));
    let mut caption = "Reading less what the reference’s motion says. Good: a band of even width about zero. Where the band is wider while the machine moves faster, \
                       the reference’s error grows with motion."
        .to_string();
    if is_thinned(residuals.len()) {
        caption.push_str(" The smallest and the largest residual of each pixel column are drawn, so the band shows extremes and looks wider than ±2 sd.");
    }
    Figure::new("Residuals and motion over time", panels, caption).with_columns(2)
}

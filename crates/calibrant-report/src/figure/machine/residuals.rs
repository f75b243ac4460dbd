//! Residuals of a sensor on a machine over time, with the machine's speed beside them.

use super::scene::Scene;
use crate::figure::frame::caption;
use crate::figure::panel::{Panel, Series};
use crate::figure::point_thinning::{is_thinned, thinned};
use crate::figure::residuals::over_time;
use crate::figure::unit::DisplayUnit;
use crate::figure::{Figure, colour};
use calibrant_core::sensor::{Axis, SensorKind};
use calibrant_machine::estimate::SensorResidual;
use calibrant_machine::reference::Posture;

/// Residuals of each axis, and the speed of the tip. `unit` is that of the readings.
pub(crate) fn residuals_and_speed(noise: &SensorResidual, unit: &'static str, scene: &Scene) -> Figure {
    let unit = DisplayUnit::suited_to(unit, noise.rms.iter().map(|rms| 3.0 * rms));
    let label = match noise.growth {
        Some(_) => "±2 sd of the noise at rest",
        None => "±2 sd of the noise",
    };
    let mut panels = Panel::by_axis(&Axis::ALL, "time (s)", &unit.label("residual"), |axis, panel| {
        let k = axis.index();
        let points = noise.residuals.iter().map(|of| (of.time_s, unit.factor * of.value[k])).collect();
        over_time(panel, points, Some((label, unit.factor * noise.noise[k])))
    });
    let (what, label) = match noise.sensor {
        SensorKind::Accelerometer => ("speed", "speed (m/s)"),
        SensorKind::Gyroscope => ("angular rate", "rate (°/s)"),
    };
    let of = |posture: &Posture| match noise.sensor {
        SensorKind::Accelerometer => posture.speed_mps,
        SensorKind::Gyroscope => posture.rate_radps.to_degrees(),
    };
    let speed = thinned(scene.path.iter().map(|posture| (posture.time_s, of(posture))));
    let what = format!("{what} of the {}", if scene.is_chain { "tip" } else { "body" });
    let line = Series::stroke("motion", colour::ORANGE, (1.2, ""), speed);
    panels.push(Panel::new(what, "time (s)", label).with(line));
    let caption = caption(
        "Reading less what the reference’s motion says. Good: a band of even width about zero. Where the band is wider while the machine moves faster, \
         the reference’s error grows with motion.",
        &[(
            is_thinned(noise.residuals.len()),
            "The smallest and the largest residual of each pixel column are drawn, so the band shows extremes and looks wider than ±2 sd.",
        )],
    );
    Figure::new("Residuals and motion over time", panels, caption).with_columns(2)
}

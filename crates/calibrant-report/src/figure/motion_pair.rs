//! Figures of motions over time with their limits: the thesis's Figure 8, and the motion of the arm for it.

use super::motion::{TIME, nodes, steps};
use super::panel::{Panel, Points, Series};
use super::point_thinning::thinned;
use super::{Figure, colour, frame};
use crate::design::starts::name;
use calibrant_core::motion::{AxisLimits, JerkControlledMotion, Limits};
use calibrant_core::sensor::Axis;

/// Number of points per interval, so that peaks between nodes show.
const POINTS_PER_INTERVAL: usize = 24;
/// A limit is drawn where it is below this many times the largest value. Farther away it would flatten the
/// curves.
const NEAR: f64 = 4.0;

/// Colour, width and dashes of a line.
type Look = (&'static str, (f64, &'static str));

/// A motion as it is drawn, with its name in the legend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drawn<'a> {
    pub(crate) name: &'static str,
    pub(crate) motion: &'a JerkControlledMotion,
    look: Look,
}

impl<'a> Drawn<'a> {
    /// The motion to compare with: thin and blue.
    pub(crate) fn before(name: &'static str, motion: &'a JerkControlledMotion) -> Self {
        Self { name, motion, look: (colour::BLUE, (1.4, "2 2.5")) }
    }

    /// The motion that the page is about: bold and vermillion.
    pub(crate) fn after(name: &'static str, motion: &'a JerkControlledMotion) -> Self {
        Self { name, motion, look: (colour::VERMILLION, (2.3, "")) }
    }
}

/// A quantity of a motion that is drawn over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Profile {
    Jerk,
    Acceleration,
    Intercept,
    Velocity,
    Displacement,
}

impl Profile {
    /// Its name, the label of its axis, and its limit.
    fn of(self, limits: &AxisLimits) -> (&'static str, &'static str, Option<f64>) {
        match self {
            Self::Jerk => ("jerk", "jerk uᵢ (m/s³)", limits.jerk),
            Self::Acceleration => ("acceleration", "acceleration (m/s²)", limits.acceleration),
            Self::Intercept => ("state", "state xᵢ (m/s²)", limits.intercept),
            Self::Velocity => ("velocity", "velocity (m/s)", limits.velocity),
            Self::Displacement => ("displacement", "displacement (m)", limits.displacement),
        }
    }

    fn curve(self, motion: &JerkControlledMotion, axis: Axis) -> Points {
        let a = axis.index();
        match self {
            Self::Jerk => steps(motion, &motion.jerk_mps3(), axis),
            Self::Intercept => steps(motion, &motion.intercept_mps2(), axis),
            Self::Acceleration => nodes(motion, axis),
            Self::Velocity | Self::Displacement => {
                let times = dense(motion.times_s());
                let states = motion.states_at(&times);
                let value = |i: usize| match self {
                    Self::Velocity => states[i].velocity_mps[a],
                    _ => states[i].displacement_m[a],
                };
                thinned(times.iter().enumerate().map(|(i, &t)| (t, value(i))))
            }
        }
    }
}

fn dense(nodes: &[f64]) -> Vec<f64> {
    let inside = nodes.windows(2).flat_map(|ends| {
        let step = (ends[1] - ends[0]) / POINTS_PER_INTERVAL as f64;
        (0..POINTS_PER_INTERVAL).map(move |k| ends[0] + step * k as f64)
    });
    inside.chain(nodes.last().copied()).collect()
}

/// Jerk in steps and acceleration in lines: the thesis's Figure 8.
pub(crate) fn jerk_and_acceleration(
    title: &str,
    motions: &[Drawn<'_>],
    axes: &[Axis],
    limits: &Limits,
) -> Figure {
    let caption = "(a) Jerk, constant in each interval. (b) Acceleration, its integral. A good motion uses the limits: \
                   where a curve touches a dashed line, the limit is active. Widening that limit would help most.";
    figure(title, &[Profile::Jerk, Profile::Acceleration], motions, axes, limits, caption)
}

/// The thesis's state, where it is limited: the intercept of each interval's line at t = 0.
pub(crate) fn states(motions: &[Drawn<'_>], axes: &[Axis], limits: &Limits) -> Option<Figure> {
    limits.intercept_mps2?;
    let caption = "Acceleration in interval i is α(t) = xᵢ + uᵢ t. A limit on xᵢ, the line's value at t = 0, restricts late intervals more than \
                   early ones. No arm has such a limit. Limit acceleration, velocity and displacement unless you compare with the thesis.";
    Some(figure("States xᵢ with their limits", &[Profile::Intercept], motions, axes, limits, caption))
}

/// Velocity and displacement between the nodes too.
pub(crate) fn velocity_and_displacement(motions: &[Drawn<'_>], axes: &[Axis], limits: &Limits) -> Figure {
    let bounded = limits.velocity_mps.is_some() || limits.displacement_m.is_some();
    let caption = format!(
        "From rest at the origin. {} The curves include peaks between the nodes.",
        if bounded {
            "Good: the curves stay between the dashed lines."
        } else {
            "Neither is limited: check that the arm reaches so far and moves so fast, or set limits.velocity_mps and \
             limits.displacement_m."
        }
    );
    let profiles = [Profile::Velocity, Profile::Displacement];
    figure("Velocity (a) and displacement (b)", &profiles, motions, axes, limits, &caption)
}

fn figure(
    title: &str,
    profiles: &[Profile],
    motions: &[Drawn<'_>],
    axes: &[Axis],
    limits: &Limits,
    caption: &str,
) -> Figure {
    let mut far: Vec<String> = Vec::new();
    let mut panels = Vec::new();
    for (&profile, letter) in profiles.iter().zip(["(a) ", "(b) "]) {
        let letter = if profiles.len() > 1 { letter } else { "" };
        let (mut hidden, mut what) = (Vec::new(), "");
        for &axis in axes {
            let (name, label, limit) = profile.of(&limits.axis(axis.index()));
            let mut panel = Panel::new(format!("{letter}axis {axis}"), TIME, label);
            // thin over bold: both show where they coincide
            for Drawn { name, motion, look: (colour, stroke) } in motions.iter().rev() {
                panel = panel.with(Series::stroke(name, colour, *stroke, profile.curve(motion, axis)));
            }
            what = name;
            match limit {
                Some(limit) if limit <= NEAR * panel.largest() => panel = panel.with_limits(limit),
                Some(_) => hidden.push(axis),
                None => {}
            }
            panels.push(panel);
        }
        if !hidden.is_empty() {
            far.push(format!("{what} of {}", name(&hidden)));
        }
    }
    let far_away = format!("Limits far outside the panel are not drawn: {}.", far.join("; "));
    let caption = frame::caption(caption, &[(!far.is_empty(), &far_away)]);
    let columns = if axes.len() == 1 { 2 } else { 3 };
    Figure::new(title, panels, caption).with_columns(columns)
}

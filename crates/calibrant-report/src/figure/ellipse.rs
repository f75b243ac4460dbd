//! The figure of confidence ellipses of bias and scale factor.

use super::frame::caption;
use super::panel::{Panel, Series, Shape};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::sensor::{Axis, Parameter};
use calibrant_design::Evaluation;
use nalgebra::{DMatrix, Matrix2, Vector2};

/// Mahalanobis radius that holds 95 % of two normal variables: √(−2 ln 0.05).
const RADIUS_95: f64 = 2.447_746_83;
/// Below this ratio of extents, a reader can see both ellipses in one panel.
const SAME_SIZE: f64 = 3.0;

/// The 95 % ellipse of (bias, scale factor) of each axis, for both motions to one scale. The better one has
/// its own panel where it is too small there.
pub(crate) fn confidence_ellipses(
    parameters: &[Parameter],
    before: (&str, &Evaluation),
    after: Option<(&str, &Evaluation)>,
) -> Option<Figure> {
    let pairs: Vec<(Axis, usize, usize)> = Axis::ALL
        .into_iter()
        .filter_map(|axis| {
            let place = |kind: &str| parameters.iter().position(|p| p.name == format!("{kind}.{axis}"));
            Some((axis, place("bias")?, place("scale")?))
        })
        .collect();
    let block = |evaluation: &Evaluation, i: usize, j: usize| {
        evaluation.covariance.as_ref().and_then(|c| factor(c, i, j))
    };
    let after_name = after.map_or("", |after| after.0);
    let (mut together, mut alone, mut magnified) = (Vec::new(), Vec::new(), false);
    for &(axis, i, j) in &pairs {
        let (old, new) = (block(before.1, i, j), after.and_then(|after| block(after.1, i, j)));
        let Some(largest) = old.or(new) else { continue };
        let units = units(parameters, i, j, &largest);
        let mut panel = panel(format!("axis {axis}"), units);
        if let Some(old) = old {
            panel = panel.with(ellipse(before.0, BEFORE, &old, units));
        }
        if let Some(new) = new {
            panel = panel.with(ellipse(after_name, AFTER, &new, units));
        }
        together.push(panel.with(centre()));
        if let (Some(old), Some(new)) = (old, new) {
            let own = self::units(parameters, i, j, &new);
            let ratio = (extent(&old).x / extent(&new).x).max(extent(&old).y / extent(&new).y);
            magnified |= ratio > SAME_SIZE;
            let title = format!("axis {axis}, {after_name} alone");
            alone.push(self::panel(title, own).with(ellipse(after_name, AFTER, &new, own)).with(centre()));
        }
    }
    if together.is_empty() {
        return None;
    }
    if magnified {
        together.append(&mut alone);
    }
    let again =
        format!("The {after_name} ellipse is much smaller, and is shown again on its own axes, magnified.");
    let caption = caption(
        "In 95 of 100 calibrations, the errors of bias and scale factor together lie within the ellipse. Good: small, and \
         upright rather than tilted. A tilted ellipse means that the data confuse errors of the two.",
        &[(magnified, &again)],
    );
    let title = "Confidence ellipses of bias and scale factor, 95 %";
    Some(Figure::new(title, together, caption).with_columns(if pairs.len() == 1 { 2 } else { 3 }))
}

/// The Cholesky factor of the covariance of parameters i and j.
fn factor(covariance: &DMatrix<f64>, i: usize, j: usize) -> Option<Matrix2<f64>> {
    let c = |row: usize, column: usize| covariance[(row, column)];
    Matrix2::new(c(i, i), c(i, j), c(j, i), c(j, j)).cholesky().map(|cholesky| cholesky.l())
}

/// Half width and half height.
fn extent(factor: &Matrix2<f64>) -> Vector2<f64> {
    Vector2::new(factor[(0, 0)], factor.row(1).norm()) * RADIUS_95
}

fn units(parameters: &[Parameter], i: usize, j: usize, factor: &Matrix2<f64>) -> [DisplayUnit; 2] {
    let extent = extent(factor);
    [DisplayUnit::suited(parameters[i].unit, extent.x), DisplayUnit::suited(parameters[j].unit, extent.y)]
}

fn panel(title: String, [x, y]: [DisplayUnit; 2]) -> Panel {
    Panel::new(title, x.label("error of the bias"), y.label("error of the scale factor"))
}

/// Colour, width and dashes of a line: those of the motion in the other figures.
type Look = (&'static str, (f64, &'static str));
const BEFORE: Look = (colour::BLUE, (1.6, "2 2.5"));
const AFTER: Look = (colour::VERMILLION, (2.2, ""));

fn ellipse(label: &str, (colour, stroke): Look, factor: &Matrix2<f64>, [x, y]: [DisplayUnit; 2]) -> Series {
    let points = (0..=90)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 90.0)
        .map(|angle| factor * Vector2::new(angle.cos(), angle.sin()) * RADIUS_95)
        .map(|error| (error.x * x.factor, error.y * y.factor))
        .collect();
    Series::stroke(label, colour, stroke, points)
}

fn centre() -> Series {
    Series::dots("no error", colour::BLACK, (Shape::Cross, 2.5), vec![(0.0, 0.0)])
}

//! A parallel projection of a scene, and the lines that it gives.

use nalgebra::Vector3;

/// Directions of the drawing's right and up, in the axes of the base, and its scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    pub(super) right: Vector3<f64>,
    pub(super) up: Vector3<f64>,
    /// The point of the scene in the middle of the drawing.
    pub(super) centre: Vector3<f64>,
    /// The middle of the drawing.
    pub(super) middle: (f64, f64),
    /// Units of the drawing per metre.
    pub(super) scale: f64,
}

impl View {
    /// From a direction: azimuth about z from x, and elevation; rad.
    pub(super) fn from(azimuth: f64, elevation: f64) -> Self {
        let (sa, ca) = azimuth.sin_cos();
        let (se, ce) = elevation.sin_cos();
        Self {
            right: Vector3::new(-sa, ca, 0.0),
            up: Vector3::new(-se * ca, -se * sa, ce),
            centre: Vector3::zeros(),
            middle: (0.0, 0.0),
            scale: 1.0,
        }
    }

    /// Where a point is on the drawing, whose y points down.
    pub(super) fn at(&self, point: &Vector3<f64>) -> (f64, f64) {
        let from_centre = point - self.centre;
        (
            self.middle.0 + self.scale * self.right.dot(&from_centre),
            self.middle.1 - self.scale * self.up.dot(&from_centre),
        )
    }

    pub(super) fn line<'a>(&self, points: impl IntoIterator<Item = &'a Vector3<f64>>) -> String {
        let finite = points.into_iter().map(|point| self.at(point)).filter(|(x, y)| (x + y).is_finite());
        finite
            .enumerate()
            .map(|(k, (x, y))| format!("{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' }))
            .collect()
    }

    /// A path that draws a dot at each point: a stroke of length 0.01, whose round ends are seen.
    pub(super) fn dots<'a>(&self, points: impl IntoIterator<Item = &'a Vector3<f64>>) -> String {
        let finite = points.into_iter().map(|point| self.at(point)).filter(|(x, y)| (x + y).is_finite());
        finite.map(|(x, y)| format!("M{x:.1} {y:.1}h.01")).collect()
    }
}

/// A round distance, 1, 2 or 5 times a power of ten, of which at most so many fit into a length.
pub(super) fn round_step(length: f64, most: f64) -> f64 {
    let least = length / most;
    let decade = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|m| m * decade)
        .find(|step| *step >= least * 0.999)
        .unwrap_or(10.0 * decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_along_an_axis_keeps_the_others() {
        // from −y: x to the right, z up
        let view = View { scale: 10.0, middle: (5.0, 5.0), ..View::from(-std::f64::consts::FRAC_PI_2, 0.0) };
        let (x, y) = view.at(&Vector3::new(1.0, 7.0, 2.0));
        assert!((x - 15.0).abs() < 1e-12 && (y + 15.0).abs() < 1e-12);
        let unseen = Vector3::repeat(f64::NAN);
        assert_eq!(view.line([&Vector3::zeros(), &unseen, &Vector3::x()]), "M5.0 5.0L15.0 5.0");
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([0.9, 2.0, 7.0].map(|length| round_step(length, 5.0)), [0.2, 0.5, 2.0]);
    }
}

//! How well the sensor was placed on known faces.
//!
//! A tilt by `θ` moves gravity across the direction that was given by `g θ`, and along it only by `g θ²/2`. With tilts of standard deviation `τ` about each axis, the specific force is
//! about `g (1 − τ²)` along the direction, known to `g τ²` there, and to `g τ` across it. So six faces tell the scale factors far better than the cross-axis terms. What a tilt shows
//! across passes for something along where the cross-axis terms are wrong: of `n` faces they are known to `τ √(3/n)`, two of them act on each face, and the variance along is
//! `g² τ⁴ (1 + 6/n)`. That is true of biases; in scale factors both parts cancel to some degree, and what is stated of them is up to 1.6 times too wide where tilts decide.
//!
//! `τ` is such that χ² equals its degrees of freedom, and so is what else scatters along the direction, where anything is left there to tell it: six faces fix three
//! scale factors and three biases by what they show along gravity, and leave nothing. A scatter of few residuals is known badly: for the covariance its variance is multiplied by
//! `ν/(ν − 2)`, which makes the normal distribution as wide as Student's t.

use crate::estimate::excess::excess;
use crate::estimate::{FaceTilt, TiltSource};
use nalgebra::{Matrix3, Vector3};

/// Tilt of faces whose scatter does not tell it, rad: half a degree, as of known turns.
const ASSUMED_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// A scatter of fewer degrees of freedom has no variance that could be stated.
const FEWEST: usize = 3;
/// Faces that scatter by so many times what was given of their tilt contradict it.
const CONTRADICTED: f64 = 2.5;
/// The two scatters follow each other in at most so many rounds …
const ROUNDS: usize = 30;
/// … until they change by less than this share.
const SETTLED: f64 = 1e-9;

/// Scatter of the specific force about known directions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Placing {
    /// Standard deviation of a tilt about each axis, rad.
    pub(super) tilt_rad: f64,
    /// Standard deviation along the direction beyond noise and tilt, m/s².
    pub(super) along_mps2: f64,
    /// What the tilt adds along the direction, as a variance in shares of gravity.
    pub(super) of_square: f64,
}

/// How the faces were met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Met {
    pub(super) placing: Placing,
    /// As it counts for the covariance of the estimates: for as few residuals as told it.
    pub(super) widened: Placing,
    /// As it is told.
    pub(super) tilt: FaceTilt,
    /// What is left of the magnitudes to check.
    pub(super) along_degrees: usize,
}

/// What is left of the faces to tell the scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Degrees {
    pub(super) faces: usize,
    pub(super) along: usize,
    pub(super) all: usize,
}

/// `Σ rᵀ C⁻¹ r` of the faces, and of what they show along their directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chi2 {
    pub(super) along: f64,
    pub(super) all: f64,
}

impl Placing {
    fn of(tilt_rad: f64, along_mps2: f64, faces: usize) -> Self {
        let of_square = tilt_rad.powi(4) * (1.0 + 6.0 / faces.max(1) as f64);
        Self { tilt_rad, along_mps2, of_square }
    }

    /// Share of gravity along the direction, on average.
    pub(super) fn cosine(&self) -> f64 {
        1.0 - self.tilt_rad.powi(2)
    }

    /// Covariance of the specific force, (m/s²)².
    pub(super) fn covariance(&self, force: &Vector3<f64>) -> Matrix3<f64> {
        let (g2, up) = (force.norm_squared(), force.normalize());
        let along = self.along_mps2.powi(2) + g2 * self.of_square;
        let across = g2 * self.tilt_rad.powi(2);
        Matrix3::identity() * across + up * up.transpose() * (along - across)
    }
}

impl Degrees {
    fn across(self) -> usize {
        self.all.saturating_sub(self.along)
    }

    fn source(self, given_rad: Option<f64>) -> TiltSource {
        match given_rad {
            Some(_) => TiltSource::Given,
            None if self.across() >= FEWEST => TiltSource::Recording,
            None => TiltSource::Assumed,
        }
    }

    fn met(self, placing: Placing, source: TiltSource) -> Met {
        let factor = |degrees: usize| {
            let degrees = degrees.max(FEWEST) as f64;
            (degrees / (degrees - 2.0)).sqrt()
        };
        let (of_tilt, degrees_of_freedom) = match source {
            TiltSource::Recording => (factor(self.across()), self.across()),
            TiltSource::Given | TiltSource::Assumed => (1.0, 0),
        };
        Met {
            placing,
            widened: Placing {
                tilt_rad: placing.tilt_rad * of_tilt,
                along_mps2: placing.along_mps2 * factor(self.along),
                of_square: placing.of_square * of_tilt.powi(2),
            },
            tilt: FaceTilt { sd_rad: placing.tilt_rad, source, degrees_of_freedom },
            along_degrees: self.along,
        }
    }
}

/// How the faces were met, and what was fitted with it. `fit` gives χ² and what it fitted for a scatter; `None` where it fails, which ends the search.
pub(super) fn placing<T>(
    degrees: Degrees,
    given_rad: Option<f64>,
    gravity: f64,
    mut fit: impl FnMut(&Placing) -> Option<(Chi2, T)>,
) -> Option<(Met, T)> {
    let source = degrees.source(given_rad);
    let told = source == TiltSource::Recording;
    let mut placing = Placing::of(given_rad.unwrap_or(ASSUMED_RAD), 0.0, degrees.faces);
    // where noise decides, all three components of a face share the parameters alike; where tilts do, what it shows along tells what it can alone
    let scattered = (fit(&Placing::default())?.0.all / degrees.all.max(1) as f64).max(1.0);
    let shared = (degrees.all as f64 / 3.0 - degrees.along as f64).max(0.0);
    for _ in 0..ROUNDS {
        let before = placing;
        if told {
            let at = |tilt_rad: f64| Placing::of(tilt_rad, placing.along_mps2, degrees.faces);
            let all = degrees.all as f64;
            let (tilt_rad, ()) =
                excess(all, |_| ASSUMED_RAD, |tilt| fit(&at(tilt)).map(|(chi2, _)| (chi2.all, ())))?;
            placing = at(tilt_rad);
        }
        if degrees.along >= FEWEST {
            let at = |along_mps2: f64| Placing { along_mps2, ..placing };
            let guess = gravity * ASSUMED_RAD.powi(2);
            let along = degrees.along as f64 + shared / scattered;
            placing.along_mps2 =
                excess(along, |_| guess, |along| fit(&at(along)).map(|(chi2, _)| (chi2.along, ())))?.0;
        }
        let moved = |now: f64, before: f64| (now - before).abs() > SETTLED * now;
        if degrees.along < FEWEST
            || !moved(placing.tilt_rad, before.tilt_rad) && !moved(placing.along_mps2, before.along_mps2)
        {
            break;
        }
    }
    let fitted = fit(&placing)?.1;
    Some((degrees.met(placing, source), fitted))
}

impl FaceTilt {
    /// What is to be said where the scatter of the faces, this, contradicts what was given of it.
    pub(super) fn contradicts(&self, given_rad: f64) -> Option<String> {
        let does = self.source == TiltSource::Recording && self.sd_rad > CONTRADICTED * given_rad;
        does.then(|| {
            format!(
                "the faces scatter by {:.2}° about each axis, and holds.face_sd_deg says {:.2}°: the standard deviations are too small",
                self.sd_rad.to_degrees(),
                given_rad.to_degrees()
            )
        })
    }

    /// What is to be said where so many faces do not tell how well they were met.
    pub(super) fn assumed(&self, faces: usize) -> Option<String> {
        (self.source == TiltSource::Assumed).then(|| {
            format!(
                "{faces} faces are too few to tell how well they were met: {:.1}° about each axis is assumed; add faces, or give holds.face_sd_deg",
                self.sd_rad.to_degrees()
            )
        })
    }
}

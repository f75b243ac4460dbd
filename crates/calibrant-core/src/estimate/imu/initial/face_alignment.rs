//! Face alignment: how well the sensor was placed on known faces.
//!
//! A tilt by `θ` moves gravity across the given direction by `g θ`, and along it only by `g θ²/2`. With tilts of standard deviation `τ` about each axis,
//! the specific force along the direction is about `g (1 − τ²)`, with standard deviation `g τ²`. Across it the standard deviation is `g τ`. So six faces
//! determine the scale factors far better than the cross-axis terms. Errors of the cross-axis terms turn a part of the tilt across into a residual along.
//! `n` faces determine these terms to `τ √(3/n)`, and two of them act on each face. The variance along is then `g² τ⁴ (1 + 6/n)`. This holds for biases.
//! In scale factors both parts partly cancel, and their intervals are up to 1.6 times too wide if tilts decide.
//!
//! `τ` makes χ² equal to its degrees of freedom. A further scatter along the direction is estimated in the same way, if degrees of freedom are left there.
//! Six faces leave none: along gravity, they determine three scale factors and three biases. A scatter of few residuals is uncertain. For the covariance
//! its variance is multiplied by `ν/(ν − 2)`, which makes the normal distribution as wide as Student's t. This fails if the noise's variance `v` is as
//! large as that of the tilt, and the scatter is small by chance. With `S = Σ r²`, the variance `v + τ²` is `S/χ²_ν` and at least `v`. Its mean is
//!
//! `E[v + τ²] = S/(ν − 2) · P(χ²_{ν−2} < S/v)/P(χ²_ν < S/v)`
//!
//! which is `S/(ν − 2)` for large tilts. Six faces that scatter like their noise get `τ² = v`.
//!
//! The scatter shows the part of the tilts that differs between opposite faces. Faces of a box that is off square share theirs, and no scatter shows it
//! (`shared_face_errors`). Its standard deviation is assumed where no alignment is given. A given alignment is that of a face as a whole: half of its
//! variance is added as shared, so that six faces have cross-axis terms as uncertain as one face, whether they share their errors or not.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::faces::{TiltAssumed, TiltContradicted};
use crate::estimate::hold_result::{FaceTilt, TiltSource};
use crate::solve::{Trial, excess};
use nalgebra::{Matrix3, Vector3};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Fewest degrees of freedom for a variance of the scatter.
const FEWEST_DEGREES: usize = 3;

/// Faces contradict the given tilt if only this share of sessions scatters as much, or as little.
const BY_CHANCE: f64 = 1e-3;

/// Largest number of rounds, which estimate the two scatters in turn.
const ROUNDS: usize = 30;

/// The rounds end when the scatters change by less than this share.
const CLOSE: f64 = 1e-9;

/// Scatter of the specific force about known directions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FaceScatter {
    /// Standard deviation of a tilt about each axis, rad.
    pub(crate) tilt_rad: f64,
    /// Standard deviation along the direction beyond noise and tilt, m/s².
    pub(crate) along_mps2: f64,
    /// Variance along the direction by the tilt, as a share of gravity squared.
    pub(crate) of_square: f64,
}

/// The face alignment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaceAlignment {
    pub(crate) scatter: FaceScatter,
    /// For the covariance of the estimates: enlarged, since few residuals determine it.
    pub(crate) widened: FaceScatter,
    /// As it is reported.
    pub(crate) tilt: FaceTilt,
    /// Degrees of freedom of the magnitudes.
    pub(crate) along_degrees: usize,
    /// The tilt from the scatter, rad, if it determines it.
    pub(crate) shown_rad: Option<f64>,
    /// Does it contradict the given tilt?
    pub(crate) contradicted: bool,
    /// What is new at each placement on a face, rad²: beside the scatter, which is the faces'.
    placement_rad2: f64,
}

/// The residuals of the faces, for the scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Degrees {
    pub(crate) faces: usize,
    pub(crate) along: usize,
    pub(crate) all: usize,
}

/// `Σ rᵀ C⁻¹ r` of the faces, and the part along their directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Chi2 {
    pub(crate) along: f64,
    pub(crate) all: f64,
}

impl FaceScatter {
    pub(crate) fn of(tilt_rad: f64, along_mps2: f64, faces: usize) -> Self {
        let of_square = tilt_rad.powi(4) * (1.0 + 6.0 / faces.max(1) as f64);
        Self { tilt_rad, along_mps2, of_square }
    }

    /// Covariance of the specific force, (m/s²)².
    pub(crate) fn covariance(&self, force: &Vector3<f64>) -> Matrix3<f64> {
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
            None if self.across() >= FEWEST_DEGREES => TiltSource::Recording,
            None => TiltSource::Assumed,
        }
    }

    /// `tilt2`: posterior mean of τ², if the recording determines it.
    fn alignment(self, scatter: FaceScatter, source: TiltSource, tilt2: Option<f64>) -> FaceAlignment {
        let factor = |degrees: usize| {
            let degrees = degrees.max(FEWEST_DEGREES) as f64;
            degrees / (degrees - 2.0)
        };
        let (of_square, degrees_of_freedom) = match tilt2 {
            Some(_) => (factor(self.across()), self.across()),
            None => (1.0, 0),
        };
        FaceAlignment {
            scatter,
            widened: FaceScatter {
                tilt_rad: tilt2.map_or(scatter.tilt_rad, f64::sqrt),
                along_mps2: scatter.along_mps2 * factor(self.along).sqrt(),
                of_square: scatter.of_square * of_square,
            },
            tilt: FaceTilt {
                sd_rad: scatter.tilt_rad,
                shared_sd_rad: match source {
                    TiltSource::Given => scatter.tilt_rad * std::f64::consts::FRAC_1_SQRT_2,
                    TiltSource::Recording | TiltSource::Assumed => FaceTilt::ASSUMED_RAD,
                },
                source,
                degrees_of_freedom,
            },
            along_degrees: self.along,
            shown_rad: (source == TiltSource::Recording).then_some(scatter.tilt_rad),
            contradicted: false,
            placement_rad2: 0.0,
        }
    }
}

/// Estimates the face alignment, together with a fit.
///
/// `noise`: variance of the direction of a face's mean by its noise, rad². `fit`: χ² and fit for a scatter. `None` ends the search.
pub(crate) fn align_faces<T>(
    degrees: Degrees,
    given_rad: Option<f64>,
    (gravity, noise): (f64, f64),
    mut fit: impl FnMut(&FaceScatter) -> Option<(Chi2, T)>,
) -> Option<(FaceAlignment, T)> {
    let Some(given_rad) = given_rad else {
        let (found, chi2, fitted) = search(degrees, None, gravity, &mut fit)?;
        let source = degrees.source(None);
        let is_reported = source == TiltSource::Recording;
        let tilt2 = is_reported.then(|| mean_square(degrees, &found, &chi2, noise));
        return Some((degrees.alignment(found, source, tilt2), fitted));
    };
    // the scatter, whatever the given tilt
    let shown = match degrees.source(None) {
        TiltSource::Recording => search(degrees, None, gravity, &mut fit),
        TiltSource::Given | TiltSource::Assumed => None,
    };
    let (found, chi2, fitted) = search(degrees, Some(given_rad), gravity, &mut fit)?;
    let mut alignment = degrees.alignment(found, TiltSource::Given, None);
    let Some((shown, shown_chi2, _)) = shown else { return Some((alignment, fitted)) };
    let below = probability(degrees.across(), chi2.all - chi2.along);
    alignment.shown_rad = Some(shown.tilt_rad);
    alignment.contradicted = !(BY_CHANCE..=1.0 - BY_CHANCE).contains(&below);
    if alignment.contradicted && shown.tilt_rad > given_rad {
        let tilt2 = mean_square(degrees, &shown, &shown_chi2, noise);
        alignment.widened = degrees.alignment(shown, TiltSource::Recording, Some(tilt2)).widened;
    }
    Some((alignment, fitted))
}

/// The scatter, its χ² and its fit.
fn search<T>(
    degrees: Degrees,
    given_rad: Option<f64>,
    gravity: f64,
    fit: &mut impl FnMut(&FaceScatter) -> Option<(Chi2, T)>,
) -> Option<(FaceScatter, Chi2, T)> {
    let determined = degrees.source(given_rad) == TiltSource::Recording;
    let mut scatter = FaceScatter::of(given_rad.unwrap_or(FaceTilt::ASSUMED_RAD), 0.0, degrees.faces);
    // if noise decides, all three components of a face determine the parameters together; if tilts decide, mainly the one along does
    let scattered = (fit(&FaceScatter::default())?.0.all / degrees.all.max(1) as f64).max(1.0);
    let shared = (degrees.all as f64 / 3.0 - degrees.along as f64).max(0.0);
    for _ in 0..ROUNDS {
        let before = scatter;
        if determined {
            let at = |tilt_rad: f64| FaceScatter::of(tilt_rad, scatter.along_mps2, degrees.faces);
            let degrees_of_freedom = degrees.all as f64;
            let trial = |(chi2, _): (Chi2, T)| Trial { chi2: chi2.all, degrees_of_freedom, fitted: () };
            let (tilt_rad, ()) = excess(|_| FaceTilt::ASSUMED_RAD, |tilt| fit(&at(tilt)).map(trial))?;
            scatter = at(tilt_rad);
        }
        if degrees.along >= FEWEST_DEGREES {
            let at = |along_mps2: f64| FaceScatter { along_mps2, ..scatter };
            let guess = gravity * FaceTilt::ASSUMED_RAD.powi(2);
            let degrees_of_freedom = degrees.along as f64 + shared / scattered;
            let trial = |(chi2, _): (Chi2, T)| Trial { chi2: chi2.along, degrees_of_freedom, fitted: () };
            scatter.along_mps2 = excess(|_| guess, |along| fit(&at(along)).map(trial))?.0;
        }
        let moved = |now: f64, before: f64| (now - before).abs() > CLOSE * now;
        if degrees.along < FEWEST_DEGREES
            || !moved(scatter.tilt_rad, before.tilt_rad) && !moved(scatter.along_mps2, before.along_mps2)
        {
            break;
        }
    }
    let (chi2, fitted) = fit(&scatter)?;
    Some((scatter, chi2, fitted))
}

/// Posterior mean of `τ²`, rad², from a scatter of few residuals. `noise`: `v`, rad².
fn mean_square(degrees: Degrees, found: &FaceScatter, chi2: &Chi2, noise: f64) -> f64 {
    let (nu, of_tilt) = (degrees.across() as f64, found.tilt_rad.powi(2));
    let squares = chi2.all * nu / degrees.all as f64 * (noise + of_tilt);
    let below = |degrees_of_freedom: usize| probability(degrees_of_freedom, squares / noise);
    let mean = squares / (nu - 2.0) * below(degrees.across() - 2) / below(degrees.across()) - noise;
    if mean.is_finite() { mean.max(of_tilt) } else { of_tilt }
}

/// Probability of a χ² below `x`.
fn probability(degrees_of_freedom: usize, chi2: f64) -> f64 {
    ChiSquared::new(degrees_of_freedom as f64).map_or(f64::NAN, |of| of.cdf(chi2.max(0.0)))
}

impl FaceAlignment {
    /// With what is new at each placement, which the scatter of the faces is beside. The tilt that is reported is that of a hold.
    pub(crate) fn with_placement(mut self, placement_rad2: f64, given_rad: Option<f64>) -> Self {
        self.placement_rad2 = placement_rad2;
        self.tilt.sd_rad = given_rad.unwrap_or(self.of_hold().tilt_rad);
        if let Some(given_rad) = given_rad {
            self.tilt.shared_sd_rad = given_rad * std::f64::consts::FRAC_1_SQRT_2;
        }
        self
    }

    /// The scatter of one hold.
    pub(crate) fn of_hold(&self) -> FaceScatter {
        FaceScatter { tilt_rad: self.whole(self.scatter.tilt_rad), ..self.scatter }
    }

    /// A tilt of the faces with that of each placement, rad.
    fn whole(&self, tilt_rad: f64) -> f64 {
        tilt_rad.hypot(self.placement_rad2.sqrt())
    }

    /// Mean share of gravity along the direction. It follows the scatter if this contradicts the given tilt.
    pub(crate) fn cosine(&self) -> f64 {
        let shown_rad = self.shown_rad.filter(|_| self.contradicted);
        1.0 - self.whole(shown_rad.unwrap_or(self.scatter.tilt_rad)).powi(2)
    }

    /// The warning about a scatter beyond the given tilt. A smaller one says nothing of the errors that opposite faces share.
    pub(crate) fn contradiction(&self) -> Option<Diagnostic> {
        let shown_rad = self.whole(self.shown_rad.filter(|_| self.contradicted)?);
        let given_rad = self.whole(self.scatter.tilt_rad);
        (shown_rad > given_rad).then(|| Diagnostic::from(TiltContradicted { shown_rad, given_rad }))
    }
}

impl FaceTilt {
    /// The warning about too few faces for their alignment.
    pub(crate) fn assumed(&self, faces: usize) -> Option<Diagnostic> {
        let assumed = Diagnostic::from(TiltAssumed { faces, tilt_rad: self.sd_rad });
        (self.source == TiltSource::Assumed).then_some(assumed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six faces whose residuals have the squares `S` together, each component with the same noise.
    fn widened(squares: f64, noise: f64) -> f64 {
        let degrees = Degrees { faces: 6, along: 0, all: 6 };
        let fit = |scatter: &FaceScatter| {
            let all = squares / (noise + scatter.tilt_rad.powi(2));
            Some((Chi2 { along: 0.0, all }, ()))
        };
        align_faces(degrees, None, (9.81, noise), fit).expect("found").0.widened.tilt_rad.powi(2)
    }

    #[test]
    fn a_scatter_as_small_as_its_noise_leaves_a_tilt_open() {
        let noise = 1e-6;
        for times in [1e-3, 0.1, 1.0, 1.5, 4.0, 30.0, 1e4] {
            let squares = 6.0 * times * noise;
            // the posterior of T = v + τ² is T^(−ν/2 − 1) exp(−S/(2 T)), by the sum over ln T from ln v on
            let (mut sum, mut weights) = (0.0, 0.0);
            for k in 0..400_000 {
                let both = noise * (f64::from(k) * 1e-4).exp();
                let weight = (-3.0 * (both / noise).ln() - 0.5 * squares / both
                    + 0.5 * squares / (noise * (1.0 + times)))
                    .exp()
                    * if k == 0 { 0.5 } else { 1.0 };
                sum += weight * (both - noise);
                weights += weight;
            }
            let (found, expected) = (widened(squares, noise), sum / weights);
            assert!((found / expected - 1.0).abs() < 1e-3, "{times}: {found:e} {expected:e}");
        }
        // S/(ν − 2) without noise
        assert!((widened(6e-4, 1e-14) / 1.5e-4 - 1.0).abs() < 1e-6);
    }
}

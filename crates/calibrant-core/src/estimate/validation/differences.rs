//! The diagnostics of a validation: what may explain its errors, what is another than in the calibration's recording, and
//! why errors as large as predicted confirm nothing.

use super::covariance_verdict::CovarianceVerdict;
use super::result::{ValidatedErrors, Validation};
use super::unused_error::ErrorKind;
use crate::diagnostic::validation::{
    AccelerometerMoved, AngularUnitWrong, GyroscopeBiasMoved, GyroscopeGainsMoved, NoiseUnlike,
};
use crate::diagnostic::{Check, Code, Diagnostic};
use crate::sensor::SensorKind;

/// Errors beyond this factor have another cause than the covariance.
const OTHER_CAUSE: f64 = 30.0;

impl Validation {
    /// Does a likely explanation tell why errors of this kind are larger than predicted?
    #[must_use]
    pub fn explains(&self, kind: ErrorKind) -> bool {
        let of_others: &[_] = match kind {
            ErrorKind::Magnitude => &[GyroscopeGainsMoved::CODE, AngularUnitWrong::CODE],
            ErrorKind::Rate => &[GyroscopeGainsMoved::CODE, AccelerometerMoved::CODE],
            ErrorKind::Rotation => &[],
        };
        self.likely_explanations.iter().any(|found| !of_others.contains(&found.code()))
    }

    /// Are these errors beyond what a covariance explains, without a likely explanation?
    #[must_use]
    pub fn is_beyond(&self, errors: &ValidatedErrors) -> bool {
        let is_large = errors.verdict == CovarianceVerdict::TooSmall && errors.factor > OTHER_CAUSE;
        is_large && !self.explains(errors.kind)
    }

    /// Noise, and the gyroscope's bias, that are others than the calibration's.
    #[must_use]
    pub fn differences(&self) -> Vec<Diagnostic> {
        // a wrong unit explains both; with another sensor or other axes, the bias has not moved
        let in_unit = self.likely_explanations.iter().all(|of| of.code() != AngularUnitWrong::CODE);
        let noise = self.noise.iter().filter(|noise| noise.differs());
        let noise = noise.filter(|noise| in_unit || noise.sensor_kind == SensorKind::Accelerometer);
        let bias = self.bias_shift.filter(|shift| shift.moved && in_unit);
        let bias = bias.filter(|_| !self.kinds.iter().any(|errors| self.is_beyond(errors)));
        let unlike = noise.map(|noise| {
            let (step, step_unit) = (noise.coarse.map(|of| of.step), noise.coarse.map(|of| of.unit));
            NoiseUnlike { sensor_kind: noise.sensor_kind, ratio: noise.overall(), step, step_unit }.into()
        });
        let moved = bias.map(|shift| {
            GyroscopeBiasMoved { shift_radps: shift.shift_radps, shift_sd_radps: shift.sd_radps }.into()
        });
        unlike.chain(moved).collect()
    }

    /// Its likely explanations, differences and caveats, each once.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        let caveats = self.kinds.iter().filter_map(|errors| errors.caveat.clone());
        let mut found: Vec<Diagnostic> = Vec::new();
        for one in self.likely_explanations.iter().cloned().chain(self.differences()).chain(caveats) {
            if !found.contains(&one) {
                found.push(one);
            }
        }
        found
    }

    /// States the severity of its diagnostics as allowed where their codes are.
    pub fn allow(&mut self, allowed: &[Code]) {
        let caveats = self.kinds.iter_mut().filter_map(|errors| errors.caveat.as_mut());
        for found in self.likely_explanations.iter_mut().chain(caveats) {
            *found = found.clone().allowed_by(allowed);
        }
    }
}

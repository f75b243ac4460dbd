//! What a calibration says of the holds: each of them, their scatter, and the face alignment.

use super::bias_drift::BiasDrift;
use super::imu::ThermometerLag;
use super::recording_biases::RecordingBiases;
use super::uncalibrated::Uncalibrated;
use crate::diagnostic::{Change, HoldReason};
use crate::motion::{Gravity, Hold};
use crate::sensor::Gauge;
use nalgebra::Vector3;

/// The results of a static calibration, in addition to the parameters.
#[derive(Debug, Clone)]
pub struct HoldCalibration {
    /// The holds, in order of time.
    pub holds: Vec<HoldResult>,
    /// Gravity that was assumed.
    pub gravity: Gravity,
    /// Gauge of the parameters.
    pub gauge: Gauge,
    /// Between-hold standard deviation: that of a hold's mean beyond the noise of its samples, m/s². With known directions, along these.
    pub between_holds_sd_mps2: f64,
    /// Does the scatter between holds exceed the noise within them? It then decides the covariance.
    pub between_holds_dominates: bool,
    /// Face alignment. `None` if only the magnitude of gravity is known.
    pub tilt: Option<FaceTilt>,
    /// Root mean square over the used holds of the corrected magnitude less gravity, m/s².
    pub magnitude_residual_rms_mps2: f64,
    /// Degrees of freedom of the magnitudes of the used holds, after the accelerometer's parameters and their priors. With 0, the fit is exact and
    /// checks nothing.
    pub degrees_of_freedom: usize,
    /// Condition number of the information on the parameters, each scaled by its own standard deviation when the others are known.
    pub condition_number: f64,
    /// Were the holds found in the recording (or given by the user)?
    pub detected: bool,
    /// The accelerometer before its calibration.
    pub before: Uncalibrated,
    /// Mean temperature of each hold, °C, if the model has temperature terms.
    pub temperatures_c: Option<Vec<f64>>,
    /// What is supposed of the thermometer's lag, by which they are those of the sensor. `None` where it is known, or nothing follows temperature.
    pub thermometer: Option<ThermometerLag>,
    /// The estimated drift of the accelerometer's bias, which was subtracted from the holds. `None` if no drift was allowed for.
    pub drift: Option<Box<BiasDrift>>,
    /// The accelerometer's biases in earlier recordings, which were taken out of the holds. `None`: there is one recording, or one bias.
    pub recording_biases: Option<Box<RecordingBiases>>,
    /// A change of the accelerometer within the recording. `None` without evidence, and for known directions.
    pub change: Option<Box<Change>>,
}

impl HoldCalibration {
    /// The holds that the accelerometer's parameters follow from: all but the outliers.
    pub fn used(&self) -> impl Iterator<Item = &HoldResult> {
        self.holds.iter().filter(|result| result.used)
    }

    /// Gravity residual of a hold before the calibration, m/s². `None` if it is not known.
    #[must_use]
    pub fn magnitude_residual_before_mps2(&self, hold: &Hold) -> Option<f64> {
        let residual = self.before.stimulus(&hold.mean)?.norm() - self.gravity.magnitude_mps2;
        residual.is_finite().then_some(residual)
    }

    /// Root mean square of the gravity residuals before the calibration, over the used holds, m/s². `None` if it is not known.
    #[must_use]
    pub fn magnitude_residual_rms_before_mps2(&self) -> Option<f64> {
        let used: Vec<f64> = self
            .used()
            .map(|result| self.magnitude_residual_before_mps2(&result.hold))
            .collect::<Option<_>>()?;
        (!used.is_empty()).then(|| (used.iter().map(|e| e * e).sum::<f64>() / used.len() as f64).sqrt())
    }
}

/// Face alignment: how well the sensor was placed on its faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceTilt {
    /// Standard deviation of the tilt about each axis, rad.
    pub sd_rad: f64,
    /// Standard deviation of the part that opposite faces share, rad about each axis: a box off square. Scatter does not show it. Half a degree is assumed,
    /// or half of the variance of a given alignment.
    pub shared_sd_rad: f64,
    /// The source of this value.
    pub source: TiltSource,
    /// Degrees of freedom of its estimate from the scatter, or 0 if it was not estimated.
    pub degrees_of_freedom: usize,
}

/// The source of the face alignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TiltSource {
    /// It was given.
    Given,
    /// The scatter of the faces.
    Recording,
    /// The faces are too few, and half a degree is assumed.
    Assumed,
}

impl TiltSource {
    /// In one word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Recording => "scatter",
            Self::Assumed => "assumed",
        }
    }
}

impl FaceTilt {
    /// Standard deviation of a face's tilt where none is stated, rad about each axis: half a degree, as for known turns.
    pub const ASSUMED_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

    /// The source, in words.
    #[must_use]
    pub fn source_in_words(&self) -> String {
        match self.source {
            TiltSource::Given => "as given".into(),
            TiltSource::Recording => {
                format!("by their scatter, {} degrees of freedom", self.degrees_of_freedom)
            }
            TiltSource::Assumed => "assumed, since the faces are too few".into(),
        }
    }

    /// What is assumed of the part that no scatter shows; `None` where the alignment is given.
    #[must_use]
    pub fn assumed_in_words(&self) -> Option<String> {
        (self.source != TiltSource::Given).then(|| {
            format!(
                "{:.1}° is assumed for what opposite faces share, which no scatter shows (a box off square); holds.face_sd_deg states it",
                self.shared_sd_rad.to_degrees()
            )
        })
    }
}

/// One hold and its fit.
#[derive(Debug, Clone)]
pub struct HoldResult {
    /// The hold.
    pub hold: Hold,
    /// Estimated specific force, m/s².
    pub force_mps2: Vector3<f64>,
    /// Magnitude of the mean reading less gravity, corrected with the parameters of the result, m/s².
    pub magnitude_residual_mps2: f64,
    /// Standard deviation that the static fit of the holds expects of its magnitude residual, with the hold's own influence, m/s². Not a number where it is
    /// not known.
    pub magnitude_sd_mps2: f64,
    /// The magnitude residual of the static fit in its expected standard deviations, without the hold's own influence (studentised).
    pub studentised_residual: f64,
    /// Was it used? An outlier is reported and not used.
    pub used: bool,
    /// Why it was not used, if that does not follow from its residual: the sensor saturates.
    pub reason: Option<HoldReason>,
}

impl HoldResult {
    /// Why it was not used. `None` if it was used.
    #[must_use]
    pub fn why_left_out(&self) -> Option<HoldReason> {
        let by_residual = HoldReason::MagnitudeOff {
            residual_mps2: self.magnitude_residual_mps2,
            studentised: self.studentised_residual,
        };
        (!self.used).then(|| self.reason.unwrap_or(by_residual))
    }
}

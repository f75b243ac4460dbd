//! Scatter between holds or rotations where another recording's noise is another.
//!
//! A calibration tells the scatter `σ²` as what is left of a variance `T` beyond its noise `N`, with ν degrees of freedom: it does not see what is small beside its noise, and what of the noise
//! does not average out counts for scatter. A quieter recording shows the one, a noisier one has more of the other. There the scatter is the one that the recording
//! itself shows, within what the calibration leaves open:
//!
//! ```text
//! T ν/χ²(99.5 %) − N  ≤  σ²  ≤  T ν/χ²(0.5 %) − N,   or σ² s'²/s² where noise is s'/s > 1 times the calibration's
//! ```
//!
//! Errors of rotations do not grow with the noise by themselves, or a wrong gain would hide: no more than the scatter of the gyroscope's means in the holds does.

use super::predicted_error::{Group, Item};
use super::prediction::Prediction;
use super::prediction_errors::Errors;
use super::statistics::Degrees;
use crate::estimate::holds::median;
use crate::sensor::SensorKind;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Probability that the scatter is beyond either end of what is left open.
const TAIL_PROBABILITY: f64 = 0.005;
/// With fewer degrees of freedom all is open; that the prediction is as uncertain counts already.
const FEWEST_DEGREES: f64 = 5.0;
/// Squares so many times their median say nothing of the usual scatter: 3.4 standard deviations.
const USUAL_SQUARE: f64 = 25.0;

/// The claim with the scatter that another recording shows, where its noise is another; `None` where that leaves all as it is.
pub(super) fn as_shown(prediction: &Prediction, errors: &Errors) -> Option<Prediction> {
    let noise_here = |sensor_kind: SensorKind| {
        let found = errors.noise.iter().find(|noise| noise.sensor_kind == sensor_kind && noise.differs());
        found.map(|noise| noise.axes.component_mul(&noise.axes))
    };
    let (of_accelerometer, of_gyroscope) =
        (noise_here(SensorKind::Accelerometer), noise_here(SensorKind::Gyroscope));
    if of_accelerometer.is_none() && of_gyroscope.is_none() {
        return None;
    }
    let mut adapted = prediction.clone();
    if let Some(noise_here) = of_accelerometer {
        let scatter = Scatter::of(&errors.magnitudes, &prediction.covariance, 0, &DMatrix::identity(1, 1));
        let known = (&mut adapted.between_holds_sd_mps2, &mut adapted.holds_degrees);
        scatter.show(known, noise_here.product().cbrt());
    }
    if let Some(noise_here) = of_gyroscope {
        let without_bias = prediction.covariance_without_bias();
        for axis in 0..3 {
            let row = DMatrix::from_row_slice(
                1,
                3,
                &[0, 1, 2].map(|column| prediction.imu[SensorKind::Gyroscope].matrix[(axis, column)]),
            );
            let mut scatter = Scatter::of(&errors.rates, &errors.rates.covariance, axis, &row);
            scatter.about_their_median(&Scatter::of(&errors.rates, &without_bias, axis, &row));
            scatter.show((&mut adapted.still_sd[axis], &mut adapted.still_degrees[axis]), noise_here[axis]);
        }
        let rotations = &errors.rotations;
        let scatter = Scatter::of(rotations, &rotations.covariance, 0, &DMatrix::identity(2, 2));
        // what a rotation is off beyond white noise comes from noise as far as the scatter of the holds does, which knows nothing of gains and axes
        let growth = adapted.still_sd.norm_squared() / prediction.still_sd.norm_squared();
        let growth = if growth.is_finite() { growth.min(noise_here.product().cbrt()) } else { 1.0 };
        scatter.show((&mut adapted.rotation_sd_rad, &mut adapted.rotation_degrees), growth);
    }
    Some(adapted)
}

/// Errors beside the scatter that was predicted of them, the variances of one component.
struct Scatter {
    errors: Vec<DVector<f64>>,
    /// Mean of the scatter that the calibration found, and of the noise that it told it from.
    variance: f64,
    calibrated_noise: f64,
    /// Mean of what else is in the errors.
    noise: f64,
    by_parameters: f64,
    scattered_by_parameters: f64,
}

impl Scatter {
    /// `number`: that of the scatter; `rows`: what takes errors to the components that it is one of.
    fn of(group: &Group, covariance: &DMatrix<f64>, number: usize, rows: &DMatrix<f64>) -> Self {
        let items = &group.items;
        let mean = |of: &dyn Fn(&Item) -> f64| items.iter().map(of).sum::<f64>() / items.len().max(1) as f64;
        let part = |item: &Item| item.scatters[number];
        let by_parameters = |item: &Item| {
            let by = rows * &item.by_parameters;
            (&by * covariance * by.transpose()).trace() / rows.nrows() as f64
        };
        Self {
            errors: items.iter().map(|item| rows * &item.error).collect(),
            variance: mean(&|item| part(item).scatter),
            calibrated_noise: mean(&|item| part(item).calibrated_noise),
            noise: mean(&|item| part(item).own - part(item).scatter),
            by_parameters: mean(&by_parameters),
            scattered_by_parameters: mean(&by_parameters),
        }
    }

    /// What all have in common is not scatter. `without`: the same without the covariance of what they have in common.
    fn about_their_median(&mut self, without: &Self) {
        if self.errors.is_empty() {
            return;
        }
        let middle = median(self.errors.iter().map(|error| error[0]).collect());
        self.errors.iter_mut().for_each(|error| error[0] -= middle);
        self.scattered_by_parameters = without.by_parameters;
    }

    /// Replaces a known standard deviation by the one that the errors show, as far as its degrees of freedom leave it open; not at all where they leave all open. `noise_here`: how many times
    /// the variance of the noise is here what it was in the calibration.
    fn show(&self, (sd, degrees): (&mut f64, &mut Degrees), noise_here: f64) {
        if self.errors.is_empty() || degrees.of_scatter < FEWEST_DEGREES {
            return;
        }
        let Ok(chi2) = ChiSquared::new(degrees.of_scatter) else { return };
        let squares: Vec<f64> =
            self.errors.iter().map(|error| error.norm_squared() / error.len() as f64).collect();
        let most = USUAL_SQUARE * median(squares.clone());
        let usual: Vec<f64> = squares.into_iter().filter(|square| *square <= most).collect();
        let shown =
            usual.iter().sum::<f64>() / usual.len() as f64 - self.noise - self.scattered_by_parameters;
        let all = (self.calibrated_noise + self.variance) * degrees.of_scatter;
        let end = |probability: f64| (all / chi2.inverse_cdf(probability) - self.calibrated_noise).max(0.0);
        let most = end(TAIL_PROBABILITY).max(self.variance * noise_here.max(1.0));
        let variance = shown.clamp(end(1.0 - TAIL_PROBABILITY), most);
        *sd = variance.sqrt();
        // what is left to the calibration is the covariance of its parameters
        degrees.share = Some(self.by_parameters / (self.by_parameters + self.noise + variance));
    }
}

//! A covariance, and the sources that it is made of: `Σ = F⁻¹ + Σ_s R_s R_sᵀ`.
//!
//! The inverse of the information F has the noise, the scatter, and what is known beforehand. What all data share moves the estimates by a column of `R_s`
//! for each independent error of one standard deviation. With the weights W of a prior, its part of the variances is the diagonal of `F⁻¹ W F⁻¹`.

use super::degrees::shares_of_prior;
use nalgebra::{DMatrix, DVector};

/// Where an uncertainty comes from: the columns of the budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VarianceSource {
    /// Noise of the sensors, and their scatter between holds and rotations.
    SensorNoise,
    /// Noise of the reference: encoders or tracker.
    ReferenceNoise,
    /// Geometry and zero offsets of the joints.
    Geometry,
    /// Lever arm and mounting.
    Mounting,
    /// Delays and clocks.
    Timing,
    /// Magnitude of gravity, and tilt of the base.
    Gravity,
    /// What is known of the sensor beforehand: its datasheet, or `[known]`.
    SensorPrior,
    /// Drift of the accelerometer's bias over a recording.
    BiasDrift,
    /// Biases of the other recordings that were calibrated together.
    OtherRecordings,
    /// The part of the alignment that all faces share.
    FaceAlignment,
    /// The lag of the thermometer.
    Thermometer,
    /// Steps of the readings that are coarse beside the noise.
    CoarseSteps,
    /// The part of the Earth's rate that is not known.
    EarthRate,
}

impl VarianceSource {
    /// All, in the order of tables.
    pub const ALL: [Self; 13] = [
        Self::SensorNoise,
        Self::ReferenceNoise,
        Self::Geometry,
        Self::Mounting,
        Self::Timing,
        Self::Gravity,
        Self::SensorPrior,
        Self::BiasDrift,
        Self::OtherRecordings,
        Self::FaceAlignment,
        Self::Thermometer,
        Self::CoarseSteps,
        Self::EarthRate,
    ];
    /// Those of a calibration on a machine.
    pub const ON_MACHINE: &[Self] = Self::ALL.split_at(7).0;

    /// As written in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::SensorNoise => "sensor_noise",
            Self::ReferenceNoise => "reference_noise",
            Self::Geometry => "geometry",
            Self::Mounting => "mounting",
            Self::Timing => "timing",
            Self::Gravity => "gravity",
            Self::SensorPrior => "sensor_prior",
            Self::BiasDrift => "bias_drift",
            Self::OtherRecordings => "other_recordings",
            Self::FaceAlignment => "face_alignment",
            Self::Thermometer => "thermometer",
            Self::CoarseSteps => "coarse_steps",
            Self::EarthRate => "earth_rate",
        }
    }
}

/// A covariance that says what it is made of.
#[derive(Debug, Clone)]
pub(crate) struct Uncertainty {
    pub(crate) covariance: DMatrix<f64>,
    /// `F⁻¹`, and the weights of the prior in it.
    inverse: DMatrix<f64>,
    prior: Option<Vec<f64>>,
    /// Variances by sources other than the noise.
    parts: Vec<(VarianceSource, DVector<f64>)>,
}

impl Uncertainty {
    /// The inverse of an information, of which a prior has these weights.
    pub(crate) fn of(covariance: DMatrix<f64>, prior: Option<&[f64]>) -> Self {
        let by_prior = |weight: &[f64]| {
            DVector::from_fn(covariance.nrows(), |i, _| {
                weight.iter().zip(covariance.row(i).iter()).map(|(weight, of)| weight * of * of).sum::<f64>()
            })
        };
        let parts = prior.map(|weight| (VarianceSource::SensorPrior, by_prior(weight)));
        Self {
            parts: parts.into_iter().collect(),
            inverse: covariance.clone(),
            prior: prior.map(<[f64]>::to_vec),
            covariance,
        }
    }

    /// The share of each estimate's information that comes from the prior, where there is one.
    pub(crate) fn prior_share(&self) -> Option<Vec<f64>> {
        self.prior.as_ref().map(|weight| shares_of_prior(weight, &self.inverse))
    }

    /// By how much the estimates move with something that moves by this what the data alone tell: `(I − F⁻¹ W) ∂p`. Data follow it, and a prior does not:
    /// with the information `F_d` of the data, the estimate is `F⁻¹ (F_d p_d + W m)`.
    pub(crate) fn follow(&self, of_data: DVector<f64>) -> DVector<f64> {
        let Some(weight) = &self.prior else { return of_data };
        let told = DVector::from_fn(of_data.len(), |k, _| weight[k] * of_data[k]);
        of_data - &self.inverse * told
    }

    /// Adds an error of this variance, which moves the estimates by this for each unit.
    pub(crate) fn add(&mut self, source: VarianceSource, slope: &DVector<f64>, variance: f64) {
        self.add_covariance(source, &(slope * slope.transpose() * variance));
    }

    /// Adds a covariance.
    pub(crate) fn add_covariance(&mut self, source: VarianceSource, covariance: &DMatrix<f64>) {
        self.covariance += covariance;
        self.parts.push((source, covariance.diagonal()));
    }

    /// The variance of an estimate by its sources, in the order of [`VarianceSource::ALL`]. What no other source has is the noise's.
    pub(crate) fn parts(&self, place: usize) -> [f64; VarianceSource::ALL.len()] {
        let mut parts = [0.0; VarianceSource::ALL.len()];
        for (source, variances) in &self.parts {
            parts[*source as usize] += variances[place];
        }
        let others: f64 = parts.iter().sum();
        parts[VarianceSource::SensorNoise as usize] = (self.covariance[(place, place)] - others).max(0.0);
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one number with noise of variance 1, a prior of variance 1 about it, and an offset of variance 4 that halves in the estimate.
    #[test]
    fn the_parts_of_a_variance_are_those_of_its_errors() {
        let mut uncertainty = Uncertainty::of(DMatrix::repeat(1, 1, 0.5), Some(&[1.0]));
        uncertainty.add(VarianceSource::Gravity, &DVector::repeat(1, 0.5), 4.0);
        let parts = uncertainty.parts(0);
        let of = [VarianceSource::SensorNoise, VarianceSource::SensorPrior, VarianceSource::Gravity];
        assert_eq!(of.map(|source| parts[source as usize]), [0.25, 0.25, 1.0]);
        assert_eq!(parts.iter().sum::<f64>(), uncertainty.covariance[(0, 0)]);
        assert_eq!(VarianceSource::ALL.map(|source| source as usize), std::array::from_fn(|k| k));
    }
}

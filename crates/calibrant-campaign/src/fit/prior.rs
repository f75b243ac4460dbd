//! What a soak measures by itself, where its calibration rests on what other soaks say: with few holds, or six faces, it leaves parameters open.
//!
//! The calibration with the prior `N(μ, Π⁻¹)` has the estimate `m` and the covariance `C + s sᵀ`, with `s` what it shares with other soaks. The soak alone has the
//! information `I = C⁻¹ − Π`, the estimate `m + I⁻¹ Π (m − μ)` and shares `I⁻¹ C⁻¹ s`. In directions that it leaves open the variance is a million times the prior's.

use super::result::FittedCampaign;
use super::soak::{SoakCalibration, SoakPath};
use calibrant_core::estimate::KnownTerm;
use calibrant_core::sensor::{CalibratedImu, ImuQuantity, SensorKind, SharedErrors};
use nalgebra::{DMatrix, DVector};

/// Standard deviation of a soak's prior, over that of what the others say.
pub(super) const WIDER: f64 = 3.0;
/// A direction is open where a soak has less than this share of the prior's information.
const OPEN: f64 = 1e-2;
/// With at least this many degrees of freedom, the scatter of the rotations comes from more than a few of them.
const MANY: f64 = 20.0;
/// The variance of an open direction, in that of the prior.
const WIDE: f64 = 1e6;

impl FittedCampaign {
    /// The prior of another soak on this path: what these soaks predict, three times as wide. `None` where there is no covariance.
    #[must_use]
    pub fn prior_on(&self, path: &SoakPath) -> Option<Vec<KnownTerm>> {
        let imu = self.on_path(path).at(path.temperature_c).ok()?;
        let covariance = imu.covariance.as_ref()?;
        let term = |(k, quantity): (usize, &ImuQuantity)| KnownTerm {
            quantity: *quantity,
            value: quantity.value(&imu.parameters),
            sd: Some(WIDER * covariance[(k, k)].sqrt()),
        };
        Some(imu.quantities.iter().enumerate().map(term).collect())
    }
}

impl SoakCalibration {
    /// Does it leave a gain or an angle of the gyroscope open beside this prior? A few rotations determine these far from where they are linear. Where many scatter, something
    /// happened, and that must be seen.
    #[must_use]
    pub fn leaves_open(&self, prior: &[KnownTerm]) -> bool {
        let Some(covariance) = &self.imu.covariance else { return false };
        let degrees = self.imu.degrees_of_freedom.map_or(f64::INFINITY, |of| of.gyroscope_matrix);
        if (MANY..f64::INFINITY).contains(&degrees) {
            return false;
        }
        self.imu.quantities.iter().enumerate().any(|(k, quantity)| {
            let is_of_rotations = quantity.sensor_kind() == SensorKind::Gyroscope && !quantity.is_of_bias();
            let sd = prior.iter().find(|term| term.quantity == *quantity).and_then(|term| term.sd);
            is_of_rotations && sd.is_some_and(|sd| covariance[(k, k)] * OPEN > sd * sd)
        })
    }
}

/// A calibration with its prior, in units of the prior, or of the estimate where there is none.
struct Scaled {
    unit: DVector<f64>,
    /// 1 for the parameters that have a prior, 0 for the others.
    known: DVector<f64>,
    /// The estimate less the prior's mean.
    off: DVector<f64>,
    /// `C⁻¹`.
    with_prior: DMatrix<f64>,
    /// `s`, in the units of the parameters.
    root: DMatrix<f64>,
}

impl Scaled {
    /// `None` where the covariance is singular.
    fn of(soak: &SoakCalibration) -> Option<Self> {
        let imu = &soak.imu;
        let size = imu.quantities.len();
        let root = imu.shared.as_ref().map_or_else(|| DMatrix::zeros(size, 0), |shared| shared.root.clone());
        let own = imu.covariance.as_ref()? - &root * root.transpose();
        let (mut unit, mut known) = (own.diagonal().map(f64::sqrt), DVector::zeros(size));
        let mut off = DVector::zeros(size);
        for (k, quantity) in imu.quantities.iter().enumerate() {
            let said = soak.prior.iter().find(|term| term.quantity == *quantity);
            if let Some((mean, sd)) = said.and_then(|term| Some((term.value, term.sd?))) {
                (unit[k], known[k]) = (sd, 1.0);
                off[k] = (quantity.value(&imu.parameters) - mean) / sd;
            }
        }
        let with_prior =
            DMatrix::from_fn(size, size, |i, j| own[(i, j)] / (unit[i] * unit[j])).cholesky()?.inverse();
        Some(Self { unit, known, off, with_prior, root })
    }
}

/// Each parameter as the soak measures it, without its own prior. The other parameters keep their priors, with the standard deviations that the other soaks state. From these
/// values and variances the scatter between soaks is found: in the covariance of the soak alone, open directions would hide it. `None` where the covariance is singular.
pub(super) fn one_by_one(soak: &SoakCalibration) -> Option<SoakCalibration> {
    let Scaled { unit, known, off, with_prior, .. } = Scaled::of(soak)?;
    let sharper = DMatrix::from_diagonal(&known) * (WIDER * WIDER - 1.0);
    let with_all = (&with_prior + sharper).cholesky()?.inverse();
    let found = &with_all * (&with_prior * &off);
    let mut imu = soak.imu.clone();
    let mut variances = DVector::zeros(unit.len());
    for (k, quantity) in imu.quantities.iter().enumerate() {
        // that of the data, in units of the prior
        let information = 1.0 / with_all[(k, k)] - known[k] * WIDER * WIDER;
        let is_open = information < OPEN && known[k] > 0.0;
        variances[k] = unit[k].powi(2) * if is_open { WIDE } else { information.recip() };
        let alone = if is_open { off[k] } else { found[k] / (with_all[(k, k)] * information) };
        quantity.add_to(&mut imu.parameters, (alone - off[k]) * unit[k]);
    }
    imu.shared = None;
    imu.covariance = Some(DMatrix::from_diagonal(&variances));
    Some(SoakCalibration { imu, ..soak.clone() })
}

/// The soak as it is without its prior; `None` where its covariance is singular.
pub(super) fn without_prior(soak: &SoakCalibration) -> Option<SoakCalibration> {
    if soak.prior.is_empty() {
        return Some(soak.clone());
    }
    let Scaled { unit, known, off, with_prior, root } = Scaled::of(soak)?;
    let imu = &soak.imu;
    let parts = (&with_prior - DMatrix::from_diagonal(&known)).symmetric_eigen();
    let axes = &parts.eigenvectors;
    let back = |found: &DVector<f64>| DMatrix::from_diagonal(&unit) * axes * DMatrix::from_diagonal(found);
    let spread = back(&parts.eigenvalues.map(|of| if of < OPEN { WIDE } else { of.recip() }.sqrt()));
    let alone = back(&parts.eigenvalues.map(|of| if of < OPEN { 0.0 } else { of.recip() }));
    let scaled = DMatrix::from_fn(unit.len(), root.ncols(), |i, j| root[(i, j)] / unit[i]);
    let root = &alone * axes.tr_mul(&(&with_prior * scaled));
    let covariance = &spread * spread.transpose() + &root * root.transpose();
    let mut parameters = imu.parameters;
    for (quantity, by) in imu.quantities.iter().zip((&alone * axes.tr_mul(&off)).iter()) {
        quantity.add_to(&mut parameters, *by);
    }
    let shared = imu.shared.as_ref().map(|of| SharedErrors { sources: of.sources.clone(), root });
    let imu = CalibratedImu { parameters, covariance: Some(covariance), shared, ..imu.clone() };
    Some(SoakCalibration { imu, ..soak.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::estimate::{KnownTerm, SoakTemperature};
    use calibrant_core::sensor::{Axis, CovarianceDegrees, ImuParameters, Quantity, ReadingUnit};

    /// Two biases of which the soak measures the sum, 0.3 ± 0.01, with a prior of 0 ± 1 each.
    fn of_sum() -> SoakCalibration {
        let quantities =
            [Axis::X, Axis::Y].map(|axis| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)));
        let row = DVector::from_element(2, 1.0);
        let information = &row * row.transpose() * 1e4 + DMatrix::identity(2, 2);
        let covariance = information.try_inverse().expect("regular");
        let estimate = &covariance * &row * (0.3 * 1e4);
        let mut parameters = ImuParameters::identity();
        quantities.iter().zip(estimate.iter()).for_each(|(of, value)| of.add_to(&mut parameters, *value));
        let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
        let imu = CalibratedImu {
            covariance: Some(covariance),
            ..CalibratedImu::new(parameters, units, quantities.to_vec(), "")
        };
        let temperature = SoakTemperature { mean_c: 20.0, rate_k_per_min: 0.0, range_c: [20.0; 2] };
        let prior = quantities.map(|quantity| KnownTerm { quantity, value: 0.0, sd: Some(1.0) }).to_vec();
        SoakCalibration { name: String::new(), imu, temperature, prior }
    }

    #[test]
    fn a_soak_without_its_prior_says_what_it_measured_and_leaves_the_rest_open() {
        let alone = without_prior(&of_sum()).expect("regular");
        let row = DVector::from_element(2, 1.0);
        let sigma = alone.imu.covariance.as_ref().expect("there");
        let sd = (row.transpose() * sigma * &row)[0].sqrt();
        let quantities = alone.imu.quantities.iter();
        let sum: f64 = quantities.map(|of| of.value(&alone.imu.parameters)).sum();
        assert!((sum - 0.3).abs() < 1e-6, "{sum}");
        assert!((sd - 0.01).abs() < 1e-6, "{sd}");
        assert!(sigma[(0, 0)] > 1e4, "{sigma}");
    }

    /// Of two biases of which the soak measures the sum, each by itself is the sum less what the others say of the second, as sharp as they say it: 0.3 ± (0.01² + ⅓²)^½.
    #[test]
    fn each_parameter_by_itself_rests_on_what_the_others_say_of_the_rest() {
        let alone = one_by_one(&of_sum()).expect("regular");
        let sigma = alone.imu.covariance.as_ref().expect("there");
        let expected = (1.0_f64 / 9.0 + 1e-4).sqrt();
        for (k, of) in alone.imu.quantities.iter().enumerate() {
            assert!((of.value(&alone.imu.parameters) - 0.3).abs() < 1e-9);
            assert!((sigma[(k, k)].sqrt() - expected).abs() < 1e-9, "{sigma}");
        }
    }

    #[test]
    fn a_soak_leaves_open_gains_of_the_gyroscope_that_it_tells_less_of_than_the_others() {
        let of_bias = of_sum();
        let gain = ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(Axis::X));
        let mut of_gain = of_bias.clone();
        of_gain.imu.quantities[0] = gain;
        let said = |quantity: ImuQuantity, sd: f64| vec![KnownTerm { quantity, value: 0.0, sd: Some(sd) }];
        // its own standard deviation is 0.7
        assert!(of_gain.leaves_open(&said(gain, 0.07)) && !of_gain.leaves_open(&said(gain, 0.08)));
        assert!(!of_bias.leaves_open(&said(of_bias.imu.quantities[0], 0.07)));
        // many rotations scatter: it was knocked
        let degrees = CovarianceDegrees { gyroscope_matrix: 40.0, ..CovarianceDegrees::known() };
        of_gain.imu.degrees_of_freedom = Some(degrees);
        assert!(!of_gain.leaves_open(&said(gain, 0.07)));
    }
}

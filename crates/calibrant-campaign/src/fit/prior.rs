//! What a soak measures by itself, where its calibration rests on what other soaks say: with few holds, or six faces, it leaves parameters open.
//!
//! The calibration with the prior `N(μ, Π⁻¹)` has the estimate `m` and the covariance `C + s sᵀ`, with `s` what it shares with other soaks. The soak alone has the
//! information `I = C⁻¹ − Π`, the estimate `m + I⁻¹ Π (m − μ)` and shares `I⁻¹ C⁻¹ s`. In directions that it leaves open the variance is a million times the prior's.

use super::soak::SoakCalibration;
use calibrant_core::sensor::{CalibratedImu, ImuQuantity, SharedErrors};
use nalgebra::{DMatrix, DVector};

/// A direction is open where a soak has less than this share of the prior's information.
const OPEN: f64 = 1e-2;
/// The variance of an open direction, in that of the prior.
const WIDE: f64 = 1e6;

/// What the prior says of a parameter, and its standard deviation.
fn said(soak: &SoakCalibration, quantity: ImuQuantity) -> Option<(f64, f64)> {
    let term = soak.prior.iter().find(|term| term.quantity == quantity)?;
    Some((term.value, term.sd?))
}

/// Each parameter without its own prior and with those of the others, as if they were independent: what a parameter by itself says of the scatter between soaks. The
/// covariance of the soak alone has open directions, beside which the scatter would not be seen.
pub(super) fn one_by_one(soak: &SoakCalibration) -> SoakCalibration {
    let mut imu = soak.imu.clone();
    let root = imu.shared.take().map(|shared| shared.root);
    let Some(covariance) = &imu.covariance else { return soak.clone() };
    let mut variances = covariance.diagonal();
    for (k, quantity) in imu.quantities.iter().enumerate() {
        if let Some(root) = &root {
            variances[k] -= root.row(k).norm_squared();
        }
        if let Some((value, sd)) = said(soak, *quantity) {
            let information = sd * sd / variances[k] - 1.0;
            let off = quantity.value(&imu.parameters) - value;
            if information < OPEN {
                variances[k] = WIDE * sd * sd;
            } else {
                variances[k] = sd * sd / information;
                quantity.add_to(&mut imu.parameters, off / information);
            }
        }
    }
    imu.covariance = Some(DMatrix::from_diagonal(&variances));
    SoakCalibration { imu, ..soak.clone() }
}

/// The soak as it is without its prior; `None` where its covariance is singular.
pub(super) fn without_prior(soak: &SoakCalibration) -> Option<SoakCalibration> {
    if soak.prior.is_empty() {
        return Some(soak.clone());
    }
    let imu = &soak.imu;
    let size = imu.quantities.len();
    let root = imu.shared.as_ref().map_or_else(|| DMatrix::zeros(size, 0), |shared| shared.root.clone());
    let own = imu.covariance.as_ref()? - &root * root.transpose();
    // in units of the prior, or of the estimate where there is none
    let (mut unit, mut known) = (own.diagonal().map(f64::sqrt), DVector::zeros(size));
    let mut off = DVector::zeros(size);
    for (k, quantity) in imu.quantities.iter().enumerate() {
        if let Some((value, sd)) = said(soak, *quantity) {
            (unit[k], known[k]) = (sd, 1.0);
            off[k] = (quantity.value(&imu.parameters) - value) / sd;
        }
    }
    let with_prior =
        DMatrix::from_fn(size, size, |i, j| own[(i, j)] / (unit[i] * unit[j])).cholesky()?.inverse();
    let parts = (&with_prior - DMatrix::from_diagonal(&known)).symmetric_eigen();
    let axes = &parts.eigenvectors;
    let back = |found: &DVector<f64>| DMatrix::from_diagonal(&unit) * axes * DMatrix::from_diagonal(found);
    let spread = back(&parts.eigenvalues.map(|of| if of < OPEN { WIDE } else { of.recip() }.sqrt()));
    let alone = back(&parts.eigenvalues.map(|of| if of < OPEN { 0.0 } else { of.recip() }));
    let scaled = DMatrix::from_fn(size, root.ncols(), |i, j| root[(i, j)] / unit[i]);
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
    use calibrant_core::sensor::{Axis, ImuParameters, Quantity, ReadingUnit, SensorKind};

    /// Two biases of which the soak measures the sum, 0.3 ± 0.01: with a prior of 0 ± 1 each, and without it.
    #[test]
    fn a_soak_without_its_prior_says_what_it_measured_and_leaves_the_rest_open() {
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
        let soak = SoakCalibration { name: String::new(), imu, temperature, prior };
        let alone = without_prior(&soak).expect("regular");
        let sigma = alone.imu.covariance.as_ref().expect("there");
        let sd = (row.transpose() * sigma * &row)[0].sqrt();
        let sum: f64 = quantities.iter().map(|of| of.value(&alone.imu.parameters)).sum();
        assert!((sum - 0.3).abs() < 1e-6, "{sum}");
        assert!((sd - 0.01).abs() < 1e-6, "{sd}");
        assert!(sigma[(0, 0)] > 1e4, "{sigma}");
    }
}

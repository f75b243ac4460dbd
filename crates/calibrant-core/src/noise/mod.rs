//! Noise of a sensor at rest: the Allan deviation of a long hold, and the noise coefficients that explain it.
//!
//! # The quantity
//! Let `y_1 … y_n` be readings at intervals `τ₀` while the sensor is stationary, and `x_k = Σ_{i ≤ k} y_i`.
//! The means of two adjacent clusters of `m` readings, `τ = m τ₀`, differ by
//! `d_k = (x_{k+2m} − 2 x_{k+m} + x_k)/m`. The overlapping Allan variance is
//!
//! ```text
//! σ²(τ) = 1/(2M) Σ_{k=1}^{M} d_k²,   M = n − 2m + 1
//! ```
//!
//! [`AllanDeviation`] computes it, with degrees of freedom and confidence bounds for each cluster time.
//!
//! # The model
//! There are five processes of IEEE 952 and 1293. They differ in the slope of `σ` on logarithmic axes
//! ([`PowerLaw`]):
//!
//! | process | coefficient | σ²(τ) | slope of σ |
//! |---|---|---|---|
//! | quantisation of the angle or velocity | Q | 3 Q²/τ² | −1 |
//! | angle or velocity random walk: white noise of the reading | N | N²/τ | −½ |
//! | bias instability: flicker noise of the reading | B | (2 ln 2/π) B² = (0.664 B)² | 0 |
//! | rate random walk | K | K² τ/3 | +½ |
//! | linear drift | R | R² τ²/2 | +1 |
//!
//! # The fit
//! The first four are random and their variances add. So the Allan variances at cluster times
//! `m = 1, 2, 4, …` are linear in `θ = (Q², N², B², K²)`. A linear drift is not noise. It is subtracted
//! exactly, at each cluster time, with the mean of the differences,
//!
//! ```text
//! ν_m = ½ [ mean(d²) − mean(d)² ],   E ν = A θ,   cov(ν_j, ν_k) = Σ_{a,b} θ_a θ_b V^{ab}_{jk}
//! ```
//!
//! and estimated by itself ([`Drift`]). `A` and `V` follow exactly from the generalised autocovariance of
//! each process (`allan_moments`). They include overlap and the correlation between cluster times. `θ` is the
//! generalised least-squares estimate with the covariance of its own model, iterated. This is the generalised
//! method of wavelet moments of `guerrier2013`, with the Allan variance as its wavelet variance. Negligible
//! coefficients are not used; the least significant one goes first. A coefficient that is not three standard
//! deviations above zero is **not determined** and has an upper limit.
//!
//! Nearly every sensor has a low-pass filter, which correlates near samples. For clusters longer than the
//! filter, it is a share `−3 D τ₀²/τ²` of the Allan variance, fitted in the place of quantisation. Shorter
//! cluster times are not used, and are named (`model_selection`). N is then the noise before the filter: that
//! of means of many samples.
//!
//! # What is removed first
//! No process above explains [`Outliers`]: up to one in fifty samples that are far from those beside them. No
//! process explains lines in the spectrum either ([`Vibration`]). Both are removed and named.
//!
//! # Confidence
//! An estimate of a variance is skewed. At each bound of `θ_i`, an estimate as high, or as low, as this one
//! has a probability of 2.5 %. The estimate follows a gamma distribution with the mean and the variance that
//! the model gives it *there*. With few degrees of freedom this is the familiar χ² interval. Heavy tails
//! widen that of N (`steps`). A filter that does not show may have taken a little from N. Where a fit
//! with its share has more, the upper bound is higher by the difference. The standard deviation is that of
//! noise without a filter. A Monte Carlo test checks the coverage.
//!
//! # References
//! `ieee952`, `ieee1293`, `riley2008`, `greenhall2003`, `riley2004`, `guerrier2013`, `kasdin1995`

mod allan;
mod allan_moments;
mod allan_regression;
mod coefficient;
mod coefficient_fit;
mod coefficient_unit;
mod filled;
mod json;
mod lag_sums;
mod linear_drift;
mod model_selection;
mod outliers;
mod power_law;
mod segment;
mod sensor_noise;
mod series;
mod steps;
mod unit_conversion;
mod variance_interval;
mod vibration;
mod whitening;

pub use allan::{AllanDeviation, AllanPoint};
pub use allan_moments::Moments;
pub use coefficient::{Coefficient, Estimate, NoiseModel};
pub use coefficient_fit::NoiseFit;
pub use coefficient_unit::{CoefficientUnit, coefficient_units};
pub use filled::filled;
pub use json::{NoiseLine, noise_line};
pub use linear_drift::Drift;
pub use outliers::Outliers;
pub use power_law::PowerLaw;
pub use segment::Segment;
pub use sensor_noise::{AxisNoise, SensorNoise};
pub use variance_interval::CONFIDENCE;
pub use vibration::Vibration;

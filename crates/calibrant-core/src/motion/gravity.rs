//! Gravity and Earth's rate: stated, or from latitude and height, with their uncertainty.
//!
//! Gravity in a commanded motion: the constant part of the specific force.
//!
//! The stimulus of an accelerometer is specific force. On an arm that accelerates by `α` without turning, it is
//!
//! `f = α + R(θ) (γ + δ γ/‖γ‖)`
//!
//! `γ` is the specific force of the sensor at rest, in its axes: it points up and has the magnitude of gravity.
//! The tilt `θ` says how well these axes are level: two small angles perpendicular to `γ`, each `N(0, σ_θ²)`.
//! `δ ~ N(0, σ_g²)` is the error of the magnitude. All that is unknown is one constant offset `o`,
//!
//! `f = α + γ + o`, `E o ≈ 0`, `P = cov o = σ_θ² (g² I − γ γᵀ) + (σ_g² + 2 g² σ_θ⁴) γ γᵀ/g²`
//!
//! Across `γ`, `o = θ × γ` to first order. Along `γ` a tilt makes the force smaller, whatever its sign:
//! `o = −g ‖θ‖²/2`, whose mean square is `2 g² σ_θ⁴`. Without this term the bias of the axis that is up would
//! look a hundred times better known than it is: 0.5° moves it by 0.4 mm/s².

use crate::json_object;
use nalgebra::{Matrix3, Vector3};

/// Gravity where a static calibration was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Magnitude, m/s².
    pub magnitude_mps2: f64,
    /// Standard uncertainty, m/s².
    pub sd_mps2: f64,
}

/// Heights on land scatter about their mean as those of an exponential distribution do, m: the mean height of land is 800 m.
const HEIGHT_M: f64 = 800.0;
/// Gravity falls with height by this, (m/s²)/m.
const FREE_AIR_PER_M: f64 = 3.086e-6;
/// Gravity on the surface of the Earth: from the Andes to the Arctic Ocean, m/s².
const ON_EARTH: std::ops::RangeInclusive<f64> = 9.76..=9.84;

impl Gravity {
    /// Standard uncertainty of [`from_latitude`](Self::from_latitude), m/s². It is the root mean square of
    /// gravity anomalies over land, about 35 mGal.
    pub const ANOMALY_SD_MPS2: f64 = 3.5e-4;

    /// Gravity somewhere on land: standard gravity, and how far the Earth's surface is from it.
    ///
    /// At sea level gravity is from 9.7803 m/s² (equator) to 9.8322 m/s² (poles), less 3.086e-6 m/s² for each metre of height. With any place on the
    /// globe equally likely, and heights of 800 m on average, its mean is 9.795 m/s² with the standard deviation 0.016 m/s². So the root mean square
    /// about standard gravity is 0.019 m/s². With any latitude equally likely, this is also 0.019 m/s².
    pub const SOMEWHERE: Self = Self { magnitude_mps2: 9.806_65, sd_mps2: 0.019 };

    /// Normal gravity of the WGS 84 ellipsoid by Somigliana's formula, with the free-air correction to second order in height.
    ///
    /// `γ(φ) = γ_e (1 + k sin²φ)/√(1 − e² sin²φ)`, `γ(φ, h) = γ(φ) [1 − 2 (1 + f + m − 2 f sin²φ) h/a + 3 h²/a²]`.
    ///
    /// # Shapes and units
    /// The latitude is geodetic, in degrees. The height is above the ellipsoid (in practice: above the sea),
    /// in m.
    ///
    /// # References
    /// `nga2014`
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::motion::Gravity;
    /// let pole = Gravity::from_latitude(90.0, 0.0);
    /// assert!((pole.magnitude_mps2 - 9.8321849379).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn from_latitude(latitude_deg: f64, height_m: f64) -> Self {
        const EQUATOR: f64 = 9.780_325_335_9; // γ_e, m/s²
        const K: f64 = 1.931_852_652_41e-3; // Somigliana's constant k
        const E2: f64 = 6.694_379_990_14e-3; // first eccentricity squared e²
        const A: f64 = 6_378_137.0; // semi-major axis a, m
        const F: f64 = 1.0 / 298.257_223_563; // flattening f
        const M: f64 = 3.449_786_506_84e-3; // ω² a² b/GM
        let s2 = latitude_deg.to_radians().sin().powi(2);
        let surface = EQUATOR * (1.0 + K * s2) / (1.0 - E2 * s2).sqrt();
        let h = height_m / A;
        let magnitude_mps2 = surface * (1.0 - 2.0 * (1.0 + F + M - 2.0 * F * s2) * h + 3.0 * h * h);
        Self { magnitude_mps2, sd_mps2: Self::ANOMALY_SD_MPS2 }
    }

    /// Gravity at a latitude where the height is not known: that of 800 m, the mean of land. Its standard uncertainty is that of such heights, 2.5e-3 m/s².
    #[must_use]
    pub fn at_latitude(latitude_deg: f64) -> Self {
        let gravity = Self::from_latitude(latitude_deg, HEIGHT_M);
        Self { sd_mps2: (FREE_AIR_PER_M * HEIGHT_M).hypot(Self::ANOMALY_SD_MPS2), ..gravity }
    }

    /// The least and the most on the Earth's surface, m/s², where this is neither: the Earth has it nowhere.
    pub(crate) fn elsewhere(&self) -> Option<[f64; 2]> {
        (!ON_EARTH.contains(&self.magnitude_mps2)).then_some([*ON_EARTH.start(), *ON_EARTH.end()])
    }
}

/// Earth's rate, rad/s (`nga2014`).
pub const EARTH_RATE_RADPS: f64 = 7.292_115e-5;

/// Earth's rate at a geographic latitude, `Ω (cos φ, 0, sin φ)` with x to the north and z up, rad/s. South of
/// the equator the latitude is negative, and so is the rate about the vertical.
///
/// # Examples
/// ```
/// use calibrant_core::motion::earth_rate;
/// assert!((earth_rate(-90.0).z + 7.292115e-5).abs() < 1e-20);
/// assert!((earth_rate(30.0).z / earth_rate(90.0).z - 0.5).abs() < 1e-12);
/// ```
#[must_use]
pub fn earth_rate(latitude_deg: f64) -> Vector3<f64> {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    Vector3::new(cos, 0.0, sin) * EARTH_RATE_RADPS
}

/// Gravity where a motion was recorded, in the axes of the sensor.
///
/// # Examples
/// ```
/// use calibrant_core::motion::MotionGravity;
/// use nalgebra::Vector3;
/// let gravity = MotionGravity::of_force(Vector3::new(0.0, 0.0, 9.80665));
/// let sd = gravity.offset_covariance().diagonal().map(f64::sqrt);
/// assert!((sd.x - 9.80665 * 0.5_f64.to_radians()).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionGravity {
    /// Specific force of the sensor at rest, `γ`, m/s²: it points up. It must not be zero.
    pub force_mps2: Vector3<f64>,
    /// Standard uncertainty of its magnitude, m/s².
    pub sd_mps2: f64,
    /// Standard deviation of the tilt about each of the two level axes, rad; 0 where the axes are exactly level.
    pub tilt_sd_rad: f64,
}

json_object! {
    /// Gravity where a motion was recorded, in the axes of the sensor.
    MotionGravity as of {
        /// Specific force of the sensor at rest: it points up.
        force_mps2: <[f64; 3]>::from(of.force_mps2),
        /// Standard uncertainty of its magnitude.
        sd_mps2: of.sd_mps2,
        /// Standard deviation of the tilt about each of the two level axes.
        tilt_sd_rad: of.tilt_sd_rad,
    }
}

impl MotionGravity {
    /// Usual standard deviation of the tilt, degrees.
    pub const USUAL_TILT_SD_DEG: f64 = 0.5;

    /// Gravity that makes a sensor at rest sense this force, with the usual tilt.
    #[must_use]
    pub fn of_force(force_mps2: Vector3<f64>) -> Self {
        Self { force_mps2, sd_mps2: 0.0, tilt_sd_rad: Self::USUAL_TILT_SD_DEG.to_radians() }
    }

    /// Its magnitude and the uncertainty of that.
    #[must_use]
    pub fn magnitude(&self) -> Gravity {
        Gravity { magnitude_mps2: self.force_mps2.norm(), sd_mps2: self.sd_mps2 }
    }

    /// What gravity leaves of a sensor's range, m/s²: `|α_k| ≤ R_k − |γ_k|` keeps `|α_k + γ_k| ≤ R_k`. Limits are
    /// symmetric, so the room on the other side is not used.
    #[must_use]
    pub fn range_left(&self, range_mps2: &Vector3<f64>) -> Vector3<f64> {
        range_mps2 - self.force_mps2.abs()
    }

    /// Covariance `P` of the constant offset, (m/s²)².
    #[must_use]
    pub fn offset_covariance(&self) -> Matrix3<f64> {
        let (gamma, g2) = (self.force_mps2, self.force_mps2.norm_squared());
        let up = gamma * gamma.transpose() / g2;
        let tilt = self.tilt_sd_rad * self.tilt_sd_rad;
        (Matrix3::identity() - up) * (tilt * g2) + up * (self.sd_mps2.powi(2) + 2.0 * g2 * tilt * tilt)
    }

    /// The tilt behind an offset, rad about each axis: `θ = γ × o/g²`.
    #[must_use]
    pub fn tilt(&self, offset_mps2: &Vector3<f64>) -> Vector3<f64> {
        self.force_mps2.cross(offset_mps2) / self.force_mps2.norm_squared()
    }

    /// Covariance of the tilt where that of the offset is given, rad².
    #[must_use]
    pub fn tilt_covariance(&self, offset: &Matrix3<f64>) -> Matrix3<f64> {
        let by = self.force_mps2.cross_matrix() / self.force_mps2.norm_squared();
        by * offset * by.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    #[test]
    fn a_gravity_of_another_planet_is_told() {
        let reported = |magnitude_mps2: f64| Gravity { magnitude_mps2, sd_mps2: 0.0 }.elsewhere().is_some();
        assert!([9.0, 9.7, 9.9, 1.62].into_iter().all(reported));
        // Huascarán and the Arctic Ocean have the extremes (`hirt2013`)
        assert!(![9.7639, 9.80665, 9.8337].into_iter().any(reported));
    }

    /// The mean square by the midpoint rule, over sines of the latitude and over latitudes, with the moments of an exponential distribution of heights.
    #[test]
    fn the_unknown_gravity_has_the_spread_of_the_surface() {
        const COUNT: usize = 10_000;
        let of_sine = |x: f64| x.asin().to_degrees();
        let of_angle = |x: f64| 90.0 * x;
        for latitude in [&of_sine as &dyn Fn(f64) -> f64, &of_angle] {
            let height = FREE_AIR_PER_M * HEIGHT_M;
            let square = |k: usize| {
                let x = (k as f64 + 0.5) / COUNT as f64;
                let at_sea = Gravity::from_latitude(latitude(x), 0.0).magnitude_mps2;
                let off = at_sea - height - Gravity::SOMEWHERE.magnitude_mps2;
                off * off + height * height + Gravity::ANOMALY_SD_MPS2.powi(2)
            };
            let rms = ((0..COUNT).map(square).sum::<f64>() / COUNT as f64).sqrt();
            assert!((rms - Gravity::SOMEWHERE.sd_mps2).abs() < 5e-4, "{rms}");
        }
    }

    #[test]
    fn normal_gravity_equals_the_published_wgs84_values() {
        let at = |latitude, height| Gravity::from_latitude(latitude, height).magnitude_mps2;
        assert!((at(0.0, 0.0) - 9.7803253359).abs() < 1e-10);
        assert!((at(90.0, 0.0) - 9.8321849379).abs() < 1e-10);
        assert!((at(45.0, 0.0) - 9.806197769).abs() < 1e-8);
        // the free-air gradient, 0.3086 mGal/m
        assert!((at(45.0, 0.0) - at(45.0, 1000.0) - 3.086e-3).abs() < 2e-6);
    }

    /// Quadrature over the two angles with three nodes each, exact to their fifth power.
    #[test]
    fn the_offset_has_the_moments_of_a_turned_gravity() {
        let sd = 0.01;
        let gravity = MotionGravity { sd_mps2: 0.0, tilt_sd_rad: sd, ..upright() };
        let level = [gravity.force_mps2.cross(&Vector3::x()), gravity.force_mps2.cross(&Vector3::y())];
        let one = level[0].normalize();
        let two = gravity.force_mps2.normalize().cross(&one);
        let mut second = Matrix3::zeros();
        let nodes = [(-(3.0_f64.sqrt()), 1.0 / 6.0), (0.0, 2.0 / 3.0), (3.0_f64.sqrt(), 1.0 / 6.0)];
        for (x, wx) in nodes {
            for (y, wy) in nodes {
                let theta = (one * x + two * y) * sd;
                let offset = Rotation3::new(theta) * gravity.force_mps2 - gravity.force_mps2;
                second += offset * offset.transpose() * (wx * wy);
                assert!((gravity.tilt(&offset) - theta).norm() < 0.6 * theta.norm().powi(3) + 1e-15);
            }
        }
        let difference = (second - gravity.offset_covariance()).amax();
        assert!(difference < 2.0 * 96.0 * sd.powi(4), "{difference}");
        let g2 = gravity.force_mps2.norm_squared();
        let up = gravity.force_mps2.dot(&(second * gravity.force_mps2)) / g2;
        assert!((up / (2.0 * g2 * sd.powi(4)) - 1.0).abs() < 1e-3, "{up}");
    }

    fn upright() -> MotionGravity {
        MotionGravity::of_force(Vector3::new(1.0, -2.0, 9.5))
    }

    #[test]
    fn the_tilt_has_its_own_covariance_back() {
        let gravity = upright();
        let sd = gravity.tilt_sd_rad;
        let up = gravity.force_mps2.normalize();
        let expected = (Matrix3::identity() - up * up.transpose()) * (sd * sd);
        assert!((gravity.tilt_covariance(&gravity.offset_covariance()) - expected).amax() < 1e-18);
    }
}

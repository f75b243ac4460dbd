//! The magnitude of gravity and its uncertainty: stated, or from latitude and height.

/// Gravity where a static calibration was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Magnitude, m/s².
    pub magnitude_mps2: f64,
    /// Standard uncertainty, m/s².
    pub sd_mps2: f64,
}

/// Gravity on the surface of the Earth: from the Andes to the Arctic Ocean, m/s².
const ON_EARTH: std::ops::RangeInclusive<f64> = 9.76..=9.84;

impl Gravity {
    /// Standard uncertainty of [`from_latitude`](Self::from_latitude), m/s². It is the root mean square of
    /// gravity anomalies over land, about 35 mGal.
    pub const ANOMALY_SD_MPS2: f64 = 3.5e-4;

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

    /// The least and the most on the Earth's surface, m/s², where this is neither: the Earth has it nowhere.
    pub(crate) fn elsewhere(&self) -> Option<[f64; 2]> {
        (!ON_EARTH.contains(&self.magnitude_mps2)).then_some([*ON_EARTH.start(), *ON_EARTH.end()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gravity_of_another_planet_is_told() {
        let reported = |magnitude_mps2: f64| Gravity { magnitude_mps2, sd_mps2: 0.0 }.elsewhere().is_some();
        assert!([9.0, 9.7, 9.9, 1.62].into_iter().all(reported));
        // Huascarán and the Arctic Ocean have the extremes (`hirt2013`)
        assert!(![9.7639, 9.80665, 9.8337].into_iter().any(reported));
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
}

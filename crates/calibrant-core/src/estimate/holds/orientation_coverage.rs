//! How the orientations of the holds cover the sphere.

use nalgebra::Vector3;

/// Points of the sphere that are looked at: about 2° apart.
const POINTS: usize = 8192;

/// How directions cover the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// The direction farthest from all of them, a unit vector.
    pub emptiest: Vector3<f64>,
    /// Angle from there to the nearest of them, rad.
    pub gap_rad: f64,
    /// For each axis whether one of them points along it to within 30°, in the positive and in the negative direction.
    pub axes: [[bool; 2]; 3],
}

/// How these directions (of any length above zero) cover the sphere; `None` where there is none.
///
/// A calibration needs directions all around: `u` and `−u` together tell bias from scale factor, three axes of them the cross-axis
/// sensitivities. A gap of less than about 60° is good; the six faces of a cube leave 54.7°.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::coverage;
/// use nalgebra::Vector3;
/// let faces: Vec<_> = (0..6).map(|k| Vector3::from_fn(|axis, _| if axis == k / 2 { 1.0 - 2.0 * (k % 2) as f64 } else { 0.0 })).collect();
/// let all = coverage(&faces).expect("not empty");
/// assert!((all.gap_rad.to_degrees() - 54.7).abs() < 1.5 && all.axes == [[true; 2]; 3]);
/// let upright = coverage(&faces[4..5]).expect("not empty");
/// assert!(upright.gap_rad.to_degrees() > 178.0 && upright.axes[2] == [true, false]);
/// ```
#[must_use]
pub fn coverage(directions: &[Vector3<f64>]) -> Option<Coverage> {
    let units: Vec<Vector3<f64>> =
        directions.iter().filter_map(|direction| direction.try_normalize(0.0)).collect();
    let nearest = |point: &Vector3<f64>| units.iter().map(|unit| unit.dot(point)).fold(-1.0, f64::max);
    let (emptiest, cosine) = (0..POINTS)
        .map(spiral)
        .map(|point| (point, nearest(&point)))
        .min_by(|one, other| one.1.total_cmp(&other.1))
        .filter(|_| !units.is_empty())?;
    let cosine_30 = 30.0_f64.to_radians().cos();
    let along = |axis: usize, sign: f64| units.iter().any(|unit| sign * unit[axis] > cosine_30);
    Some(Coverage {
        emptiest,
        gap_rad: cosine.clamp(-1.0, 1.0).acos(),
        axes: [0, 1, 2].map(|axis| [along(axis, 1.0), along(axis, -1.0)]),
    })
}

/// Point `k` of the golden spiral, which is spread evenly.
fn spiral(k: usize) -> Vector3<f64> {
    let z = 1.0 - (2 * k + 1) as f64 / POINTS as f64;
    let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt()) * k as f64;
    let radius = (1.0 - z * z).sqrt();
    Vector3::new(radius * turn.cos(), radius * turn.sin(), z)
}

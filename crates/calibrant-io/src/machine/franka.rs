//! The Franka Research 3: its speed limits depend on the position, and older URDF files do not say so.

use calibrant_machine::chain::SpeedNearEnds;

/// By joint: lower end, upper end, twice the deceleration, offset. "Limits for Franka Research 3" of Franka's documentation, <https://frankarobotics.github.io/docs>.
const FR3: [[f64; 4]; 7] = [
    [-2.7501, 2.7501, 12.0, 0.30],
    [-1.7918, 1.7918, 5.17, 0.20],
    [-2.9065, 2.9065, 7.00, 0.20],
    [-3.0481, -0.1458, 8.00, 0.30],
    [-2.8101, 2.8101, 34.0, 0.35],
    [0.54092, 4.5205, 11.0, 0.35],
    [-3.0196, 3.0196, 34.0, 0.35],
];

/// The limits of a joint that is named as in Franka's own files: `fr3_joint1`, or with a prefix before it.
pub(super) fn near_ends_of_fr3(name: &str) -> Option<SpeedNearEnds> {
    let (before, number) = name.rsplit_once("joint")?;
    let number: usize = number.parse().ok()?;
    let &[lower, upper, slope, offset] = FR3.get(number.checked_sub(1)?)?;
    before.ends_with("fr3_").then_some(SpeedNearEnds { lower, upper, slope, offset })
}

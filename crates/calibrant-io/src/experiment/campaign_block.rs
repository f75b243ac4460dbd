//! A block of holds of a campaign: its poses, and what they tell of bias and gain.

use calibrant_design::poses::Allowed;
use nalgebra::{SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// The poses of a block of holds: directions of a cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CampaignPoses {
    /// Its 6 faces. Without known directions they determine bias and gain of each axis, and no angle between the axes.
    Faces,
    /// 18, with the edges.
    Edges,
    /// 26, with the corners.
    Corners,
}

impl CampaignPoses {
    /// The directions of the specific force in the holds.
    #[must_use]
    pub fn directions(self) -> Vec<Vector3<f64>> {
        match Allowed::cube(self != Self::Faces, self == Self::Corners) {
            Allowed::Of(list) | Allowed::Near(list, _) => list,
            Allowed::Anywhere => Vec::new(),
        }
    }

    /// Standard deviations of bias and gain of an axis, by that of the magnitude of a hold in units of gravity: mean over the axes. The magnitude along `n`
    /// shows `n·b + Σ_i n_i² k_i + Σ_{i>j} n_i n_j c_ij`; the last are not determined by faces.
    #[must_use]
    pub fn sds(self) -> [f64; 2] {
        let mut information = SMatrix::<f64, 9, 9>::zeros();
        for n in self.directions() {
            let row = SVector::<f64, 9>::from_column_slice(&[
                n.x,
                n.y,
                n.z,
                n.x * n.x,
                n.y * n.y,
                n.z * n.z,
                n.y * n.x,
                n.z * n.x,
                n.z * n.y,
            ]);
            information += row * row.transpose();
        }
        if self == Self::Faces {
            for k in 6..9 {
                information[(k, k)] = 1.0;
            }
        }
        let covariance = information.try_inverse().unwrap_or_else(SMatrix::zeros);
        [0, 3].map(|first| ((first..first + 3).map(|k| covariance[(k, k)]).sum::<f64>() / 3.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_opposite_holds_tell_a_bias_and_a_gain_and_more_tell_more() {
        assert_eq!(CampaignPoses::Faces.directions().len(), 6);
        let [bias, gain] = CampaignPoses::Faces.sds();
        assert!((bias - 0.5_f64.sqrt()).abs() < 1e-12 && (gain - 0.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(CampaignPoses::Corners.directions().len(), 26);
        let [bias, gain] = CampaignPoses::Corners.sds();
        assert!((bias - (3.0_f64 / 26.0).sqrt()).abs() < 1e-12, "{bias}");
        assert!(gain > bias && gain < 0.5_f64.sqrt(), "{gain}");
    }
}

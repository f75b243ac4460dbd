//! A block of holds of a campaign: its poses, and what they tell of bias and gain.

use super::refused_key::refused;
use calibrant_core::error::Result;
use calibrant_core::sensor::{Axis, SensorModel};
use calibrant_design::poses::Allowed;
use calibrant_recording::read_poses;
use calibrant_recording::text::similar_word::nearest;
use nalgebra::{DMatrix, DVector, Vector3};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The poses of a block of holds: directions of a cube, or those of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum CampaignPoses {
    /// Its 6 faces. Without known directions they determine bias and gain of each axis, and no angle between the axes.
    Faces,
    /// 18, with the edges.
    Edges,
    /// 26, with the corners.
    Corners,
    /// A `poses.csv`, as `design` of poses writes it.
    File(PathBuf),
}

/// The names of those of a cube.
const OF_CUBE: [&str; 3] = ["faces", "edges", "corners"];

impl From<CampaignPoses> for String {
    fn from(poses: CampaignPoses) -> Self {
        match poses {
            CampaignPoses::Faces => "faces".to_owned(),
            CampaignPoses::Edges => "edges".to_owned(),
            CampaignPoses::Corners => "corners".to_owned(),
            CampaignPoses::File(path) => path.display().to_string(),
        }
    }
}

impl TryFrom<String> for CampaignPoses {
    type Error = String;

    fn try_from(text: String) -> std::result::Result<Self, String> {
        match text.as_str() {
            "faces" => Ok(Self::Faces),
            "edges" => Ok(Self::Edges),
            "corners" => Ok(Self::Corners),
            _ if text.contains(['.', '/', '\\']) => Ok(Self::File(text.into())),
            _ => {
                let hint = nearest(&text, OF_CUBE.into_iter())
                    .map_or(String::new(), |of| format!("did you mean \"{of}\"? "));
                Err(format!(
                    "\"{text}\" is no block of holds\n{hint}\"corners\", \"edges\" or \"faces\" of a cube, or the path of a poses.csv"
                ))
            }
        }
    }
}

/// A block of holds.
#[derive(Debug, Clone, PartialEq)]
pub struct CampaignBlock {
    /// The directions of the specific force in the holds.
    pub directions: Vec<Vector3<f64>>,
    /// Standard deviations of bias and gain of an axis, by that of the magnitude of a hold in units of gravity: the root of the mean variance of the axes. Marginals
    /// are enough: where all soaks have the same block and scatter, generalised least squares is ordinary least squares of each parameter (`zellner1962`), whatever
    /// the correlations within a block; nearly so where orders or scatters differ.
    pub sds: [f64; 2],
}

impl CampaignPoses {
    /// The same with its file in the directory of the experiment.
    pub(super) fn beside(self, directory: Option<&Path>) -> Self {
        match (self, directory) {
            (Self::File(path), Some(directory)) => Self::File(directory.join(path)),
            (poses, _) => poses,
        }
    }

    /// The block for a sensor of this model.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the file cannot be read, or its poses leave a bias or a gain open.
    pub fn block(&self, model: SensorModel) -> Result<CampaignBlock> {
        let of_cube = |edges: bool, corners: bool| match Allowed::cube(edges, corners) {
            Allowed::Of(list) | Allowed::Near(list, _) => list,
            Allowed::Anywhere => Vec::new(),
        };
        let directions = match self {
            Self::Faces => of_cube(false, false),
            Self::Edges => of_cube(true, false),
            Self::Corners => of_cube(true, true),
            Self::File(path) => read_poses(path)?,
        };
        let sds = sds(&directions, model).map_err(|open| {
            let message = format!("these poses leave open {}", open.join(", "));
            let help = match sds(&directions, SensorModel::ScaleBias) {
                Ok(_) => "hold more orientations (\"corners\" of a cube, or more poses of `design`), or set model = \"scale-bias\" in [sensor]",
                Err(_) => "hold more orientations: \"corners\" of a cube, or more poses of `design`",
            };
            refused("campaign.poses", message, help)
        })?;
        Ok(CampaignBlock { directions, sds })
    }
}

/// Standard deviations of bias and gain, or what stays open. The magnitude along `n` shows `n·b + Σ_i n_i² k_i`, and of a full model `+ Σ_{i>j} n_i n_j c_ij`.
fn sds(directions: &[Vector3<f64>], model: SensorModel) -> std::result::Result<[f64; 2], Vec<String>> {
    /// Below this share of the largest eigenvalue a combination is open.
    const OPEN: f64 = 1e-9;
    let count = if model == SensorModel::Full { 9 } else { 6 };
    let mut information = DMatrix::zeros(count, count);
    for n in directions {
        let row = [n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.x, n.z * n.x, n.z * n.y];
        let row = DVector::from_column_slice(&row[..count]);
        information.ger(1.0, &row, &row, 1.0);
    }
    let eigen = information.symmetric_eigen();
    let least = OPEN * eigen.eigenvalues.max();
    let (mut variances, mut open) = ([0.0; 6], [0.0; 6]);
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        for k in 0..6 {
            match *value > least {
                true => variances[k] += vector[k] * vector[k] / value,
                false => open[k] += vector[k] * vector[k],
            }
        }
    }
    let names = ["bias", "scale"]
        .into_iter()
        .flat_map(|part| Axis::ALL.map(|axis| format!("accelerometer.{part}.{axis}")));
    let names: Vec<String> = names.zip(open).filter(|(_, open)| *open > 1e-6).map(|(name, _)| name).collect();
    if names.is_empty() {
        Ok([0, 3].map(|first| (variances[first..first + 3].iter().sum::<f64>() / 3.0).sqrt()))
    } else {
        Err(names)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_opposite_holds_tell_a_bias_and_a_gain_and_more_tell_more() {
        let faces = CampaignPoses::Faces.block(SensorModel::Full).expect("a block");
        let [bias, gain] = faces.sds;
        assert_eq!(faces.directions.len(), 6);
        assert!((bias - 0.5_f64.sqrt()).abs() < 1e-12 && (gain - 0.5_f64.sqrt()).abs() < 1e-12);
        let corners = CampaignPoses::Corners.block(SensorModel::Full).expect("a block");
        let [bias, gain] = corners.sds;
        assert_eq!(corners.directions.len(), 26);
        assert!((bias - (3.0_f64 / 26.0).sqrt()).abs() < 1e-12, "{bias}");
        assert!(gain > bias && gain < 0.5_f64.sqrt(), "{gain}");
    }

    #[test]
    fn what_poses_leave_open_is_named_and_both_remedies_work() {
        let of = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).normalize();
        // six directions, for six parameters
        let few = [
            of(1.0, 0.2, 0.1),
            of(-1.0, 0.3, 0.2),
            of(0.1, 1.0, 0.3),
            of(0.2, -1.0, 0.1),
            of(0.3, 0.1, 1.0),
            of(0.1, 0.2, -1.0),
        ];
        let open = sds(&few, SensorModel::Full).expect_err("nine parameters");
        assert!(open.contains(&"accelerometer.bias.x".to_owned()), "{open:?}");
        assert!(sds(&few, SensorModel::ScaleBias).is_ok());
        // one axis is never along gravity
        let flat: Vec<_> =
            (0..12).map(|k| 0.5 * f64::from(k)).map(|angle| of(angle.cos(), angle.sin(), 0.0)).collect();
        for model in [SensorModel::Full, SensorModel::ScaleBias] {
            let open = sds(&flat, model).expect_err("z stays open");
            assert_eq!(open, ["accelerometer.bias.z", "accelerometer.scale.z"]);
        }
    }
}

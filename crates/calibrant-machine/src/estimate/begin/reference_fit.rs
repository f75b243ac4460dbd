//! The splines through a log: where the iteration begins, and the motion itself where the log is trusted.

use crate::chain::KinematicChain;
use crate::log::ReferenceLog;
use crate::reference::{JointMotion, Motion, PoseMotion};
use crate::spline::{UniformKnots, fit_rotations, fit_vectors};

/// A motion fitted to a log.
#[derive(Debug, Clone)]
pub(crate) struct ReferenceFit {
    pub(crate) motion: Motion,
    /// Standard deviation of one sample about the splines, for each unknown of a control point.
    pub(crate) sd: Vec<f64>,
    /// Number of outliers of each component.
    pub(crate) outliers: Vec<usize>,
}

/// Fits splines on these knots.
pub(crate) fn fitted(
    log: &ReferenceLog,
    chain: Option<&KinematicChain>,
    knots: UniformKnots,
) -> Option<ReferenceFit> {
    match log {
        ReferenceLog::Poses(log) => {
            log.world_from_body.iter().flatten().next()?;
            let nan = [f64::NAN; 3];
            let values: Vec<f64> =
                log.positions_m.iter().flat_map(|p| p.map_or(nan, |p| [p.x, p.y, p.z])).collect();
            let (position, orientation) = rayon::join(
                || fit_vectors(&log.times_s, &values, 3, knots),
                || fit_rotations(&log.times_s, &log.world_from_body, knots),
            );
            let motion = PoseMotion { position: position.spline, orientation: orientation.spline };
            Some(ReferenceFit {
                motion: Motion::Poses(motion),
                sd: [position.sd, orientation.sd_rad].concat(),
                outliers: [position.outliers, orientation.outliers].concat(),
            })
        }
        ReferenceLog::Joints(log) => {
            let fit = fit_vectors(&log.times_s, &log.positions, log.names.len(), knots);
            Some(ReferenceFit {
                motion: Motion::Joints(JointMotion { chain: chain?.clone(), positions: fit.spline }),
                sd: fit.sd,
                outliers: fit.outliers,
            })
        }
    }
}

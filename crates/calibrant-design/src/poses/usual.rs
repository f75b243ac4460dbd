//! The poses that an engineer would take without a design, with which the best ones are compared.

use super::efficiency::efficiency;
use super::hold_information::HoldInformation;
use super::problem::PoseProblem;
use calibrant_core::information::{covariance, undetermined};
use calibrant_core::json_object;
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;

/// Usual poses, as many as the designed ones.
#[derive(Debug, Clone, PartialEq)]
pub struct UsualPoses {
    /// What they are: `the six faces`, `equal turns`.
    pub name: &'static str,
    /// How many times their information the designed poses have. `None` where they leave parameters undetermined.
    pub information_over: Option<f64>,
}

json_object! {
    /// Usual poses, as many as the designed ones.
    UsualPoses as of {
        /// `the six faces`: each face in turn is up. `equal turns`: equal angles about x, then y, then z.
        name: of.name,
        /// How many times their information the designed poses have; `null` where they leave parameters undetermined.
        information_over: of.information_over,
    }
}

/// The usual poses that the problem allows, against a design with this value of the criterion.
pub(super) fn usual_poses(
    problem: &PoseProblem,
    information: &HoldInformation,
    value: f64,
) -> Vec<UsualPoses> {
    let is_allowed = |u: &Vector3<f64>| problem.allowed.nearest(u).dot(u) > 1.0 - 1e-6;
    [("the six faces", six_faces(problem.poses)), ("equal turns", equal_turns(problem.poses))]
        .into_iter()
        .filter(|(_, directions)| directions.iter().all(is_allowed))
        .map(|(name, directions)| {
            let sum = information.sum(directions.iter().map(|u| (u, 1.0)));
            let f = information.of_parameters(&sum);
            let determined = undetermined(&f, &f.diagonal(), 0).is_empty();
            let c = determined.then(|| covariance(&f)).flatten();
            let share = |own: f64| efficiency(&problem.criterion, own, value, problem.list.len());
            UsualPoses { name, information_over: c.map(|c| share(problem.criterion.value(&c)).recip()) }
        })
        .collect()
}

/// ±x, ±y, ±z, over and over.
fn six_faces(poses: usize) -> Vec<Vector3<f64>> {
    let face = |k: usize| Vector3::ith(k / 2 % 3, if k.is_multiple_of(2) { 1.0 } else { -1.0 });
    (0..poses).map(face).collect()
}

/// A third of the poses about each axis, at equal angles.
fn equal_turns(poses: usize) -> Vec<Vector3<f64>> {
    let about = |axis: Axis| {
        let k = axis.index();
        let count = (poses + 2 - k) / 3;
        (0..count).map(move |number| {
            let (sin, cos) = (std::f64::consts::TAU * number as f64 / count as f64).sin_cos();
            Vector3::ith((k + 1) % 3, cos) + Vector3::ith((k + 2) % 3, sin)
        })
    };
    Axis::ALL.into_iter().flat_map(about).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::tests::problem;
    use crate::poses::{Allowed, DirectionKnowledge};

    /// Where directions are known, the six faces have the moments of the uniform distribution: none is better. Where they are not, `matrix.xy` and
    /// its like are not determined.
    #[test]
    fn the_six_faces_are_best_or_useless() {
        let over = |directions| {
            let problem = problem(directions, 24);
            let information = HoldInformation::new(&problem).expect("regular");
            let sum = information.sum(six_faces(24).iter().map(|u| (u, 1.0)));
            let best =
                covariance(&information.of_parameters(&sum)).map_or(0.0, |c| problem.criterion.value(&c));
            usual_poses(&problem, &information, best)
        };
        let known = over(DirectionKnowledge::Known { sd_rad: 0.0 });
        assert!(known[0].information_over.is_some_and(|times| (times - 1.0).abs() < 1e-12), "{known:?}");
        let unknown = over(DirectionKnowledge::Unknown);
        assert!(
            unknown[0].information_over.is_none() && unknown[1].information_over.is_some(),
            "{unknown:?}"
        );
    }

    #[test]
    fn usual_poses_are_as_many_and_allowed() {
        for poses in [1, 9, 10, 11, 24] {
            assert_eq!((six_faces(poses).len(), equal_turns(poses).len()), (poses, poses));
        }
        let cap = PoseProblem {
            allowed: Allowed::Near(vec![Vector3::z()], 0.2),
            ..problem(DirectionKnowledge::Known { sd_rad: 0.0 }, 12)
        };
        assert!(usual_poses(&cap, &HoldInformation::new(&cap).expect("regular"), 1.0).is_empty());
    }
}

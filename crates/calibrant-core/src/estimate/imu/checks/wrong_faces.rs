//! Wrong faces, which the readings contradict: a direction of the wrong sign, two that are swapped.
//!
//! Where up is in the readings needs no direction: they lie on a sphere about the bias, distorted by errors of a few per cent. A turn of all
//! directions together is the mounting of the sensor and no mistake, so the turn that most faces agree with counts.

use crate::diagnostic::faces::FacesTurned;
use crate::diagnostic::{AGREES_RAD, Diagnostic, FaceMismatch, HoldSpan};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::sphere;
use crate::estimate::imu::checks::directions::turned_frame;
use crate::estimate::problem::FacesProblem;
use crate::motion::Hold;
use crate::sensor::{Correction, ReadingUnit};
use nalgebra::{Matrix3, Vector3};

/// Directions closer than this to each other, or to opposite ones, fix no turn, rad.
const PARALLEL_RAD: f64 = 0.2;

/// Complains of directions that the readings contradict; of none where the readings do not tell which. `mirrored`: is the fit the mirror image of a sensor?
pub(crate) fn check(problem: &FacesProblem<'_>, holds: &[Hold], mirrored: bool) -> Result<()> {
    match input_error(problem, holds) {
        Some(input_error) => Err(Error::experiment(input_error)),
        None if mirrored => Err(Error::experiment(InputError::new(
            Refusal::FacesContradicted,
            "the readings of the accelerometer are the mirror image of the directions of the holds",
            "is a direction of the wrong sign, or are two swapped? else change the sign of the column of an axis that reads with the opposite sign",
        ))),
        None => Ok(()),
    }
}

/// Warns of directions that are all turned alike against what the readings in SI show: a mounting, or axes in another order.
pub(crate) fn turned_faces(
    problem: &FacesProblem<'_>,
    holds: &[Hold],
    matrix: &Matrix3<f64>,
) -> Option<Diagnostic> {
    if problem.sensor.unit == ReadingUnit::Counts || !turned_frame(matrix) {
        return None;
    }
    let guess = problem.sensor.nominal()?;
    let correction = Correction::of(&guess)?;
    let shown = |hold: &Hold| correction.apply(&hold.mean).try_normalize(0.0);
    let wrong: Vec<FaceMismatch> = holds
        .iter()
        .zip(problem.directions)
        .enumerate()
        .filter_map(|(j, (hold, given))| {
            let shown = shown(hold).filter(|shown| shown.angle(given) >= AGREES_RAD)?;
            Some(difference(j, hold, given, &shown))
        })
        .collect();
    (!wrong.is_empty()).then_some(Diagnostic::from(FacesTurned { faces: wrong }))
}

/// What was given of a hold, and what is measured.
fn difference(j: usize, hold: &Hold, given: &Vector3<f64>, shown: &Vector3<f64>) -> FaceMismatch {
    FaceMismatch { hold: HoldSpan::of(j, hold), given: *given, shown: *shown }
}

fn input_error(problem: &FacesProblem<'_>, holds: &[Hold]) -> Option<InputError> {
    let gravity = problem.holds.gravity.magnitude_mps2;
    // the offset of counts is often not the datasheet's
    let guess = match problem.sensor.unit {
        ReadingUnit::Counts => sphere(holds, gravity),
        _ => problem.sensor.nominal(),
    }?;
    let correction = Correction::of(&guess)?;
    let up = |hold: &Hold| correction.apply(&hold.mean).try_normalize(0.0);
    let measured: Vec<Vector3<f64>> = holds.iter().map(up).collect::<Option<_>>()?;
    let given: Vec<Vector3<f64>> = problem.directions.iter().map(|direction| direction.normalize()).collect();
    let faces = Faces { given: &given, measured: &measured };
    let mounting = faces.mounting();
    let wrong: Vec<usize> = (0..given.len()).filter(|&j| !faces.agrees(&mounting, j)).collect();
    if wrong.is_empty() {
        return None;
    }
    let shown = |j: usize| mounting.transpose() * measured[j];
    let one = |&j: &usize| difference(j, &holds[j], &given[j], &shown(j)).to_string();
    let all: Vec<String> = wrong.iter().map(one).collect();
    let opposite = |j: usize| (-shown(j)).angle(&given[j]) < AGREES_RAD;
    let help = if wrong.len() == given.len() && wrong.iter().all(|&j| opposite(j)) {
        "every direction is the opposite: a direction says which way is up, not down; or the accelerometer shows gravity in place of the specific force (change the sign of its columns)"
    } else {
        "correct the directions (the axis that is up in each hold, in the order of the holds) or the times of the holds; where an axis of the accelerometer reads with the \
         opposite sign, change the sign of its column"
    };
    Some(InputError::new(Refusal::FacesContradicted, all.join("; "), help))
}

struct Faces<'a> {
    given: &'a [Vector3<f64>],
    measured: &'a [Vector3<f64>],
}

impl Faces<'_> {
    fn agrees(&self, mounting: &Matrix3<f64>, j: usize) -> bool {
        (mounting * self.given[j]).angle(&self.measured[j]) < AGREES_RAD
    }

    fn agreeing(&self, mounting: &Matrix3<f64>) -> usize {
        (0..self.given.len()).filter(|&j| self.agrees(mounting, j)).count()
    }

    /// How the sensor sits in the frame of the directions: the turn that most faces agree with, none where it is as good.
    fn mounting(&self) -> Matrix3<f64> {
        let (count, none) = (self.given.len(), Matrix3::identity());
        let pairs = || (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let fits = |sign: f64| pairs().filter_map(move |pair| self.turn(pair, sign));
        let best = fits(1.0).fold((self.agreeing(&none), none), |best, turn| {
            let agreeing = self.agreeing(&turn);
            if agreeing > best.0 { (agreeing, turn) } else { best }
        });
        // a mirror image that all faces agree with is no mounting: the axes say it better
        let mirrored = || fits(-1.0).any(|mirror| self.agreeing(&mirror) == count);
        if best.0 < count && mirrored() { none } else { best.1 }
    }

    /// The turn that takes two of the given directions to what was measured (the first one exactly), mirrored for a sign of −1.
    fn turn(&self, (i, j): (usize, usize), sign: f64) -> Option<Matrix3<f64>> {
        let frame = |of: &[Vector3<f64>], sign: f64| {
            let (first, normal) = (of[i], sign * of[i].cross(&of[j]).try_normalize(PARALLEL_RAD)?);
            Some(Matrix3::from_columns(&[first, normal, sign * normal.cross(&first)]))
        };
        Some(frame(self.measured, sign)? * frame(self.given, 1.0)?.transpose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    const FACES: [&str; 6] = ["x", "-x", "y", "-y", "z", "-z"];

    fn wrong(given: [&str; 6], mounting: &Rotation3<f64>) -> (Vec<usize>, Matrix3<f64>) {
        let direction = |name: &&str| {
            let axis = FACES.iter().position(|face| face == name).expect("a face");
            Vector3::ith(axis / 2, if axis % 2 == 0 { 1.0 } else { -1.0 })
        };
        let measured: Vec<Vector3<f64>> = FACES.iter().map(|face| mounting * direction(face)).collect();
        let given: Vec<Vector3<f64>> = given.iter().map(direction).collect();
        let faces = Faces { given: &given, measured: &measured };
        let found = faces.mounting();
        ((0..6).filter(|&j| !faces.agrees(&found, j)).collect(), found)
    }

    #[test]
    fn wrong_faces_are_found_however_the_sensor_is_mounted() {
        let oblique = Rotation3::from_euler_angles(0.7, -0.6, 2.0);
        for mounting in [Rotation3::identity(), Rotation3::from_euler_angles(0.0, 0.0, 1.57), oblique] {
            let (none, found) = wrong(FACES, &mounting);
            assert_eq!(none, [0usize; 0]);
            assert!((found - mounting.matrix()).amax() < 0.1);
            assert_eq!(wrong(["x", "x", "y", "-y", "z", "-z"], &mounting).0, [1]);
            // two faces of different axes: the four others tell which two
            assert_eq!(wrong(["x", "-x", "z", "-y", "y", "-z"], &mounting).0, [2, 4]);
        }
        // both faces of an axis: with the axes as they are, only these two are wrong
        let none = Rotation3::identity();
        assert_eq!(wrong(["-x", "x", "y", "-y", "z", "-z"], &none).0, [0, 1]);
        assert_eq!(wrong(["x", "-x", "z", "-z", "y", "-y"], &none).0, [2, 3, 4, 5]);
        assert_eq!(wrong(["-x", "x", "-y", "y", "-z", "z"], &none).0.len(), 6);
    }
}

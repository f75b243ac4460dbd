//! What would fit, where recording and log do not.
//!
//! A joint that counts the other way, the order of a quaternion, the inverse of an orientation, a left-handed frame: each is tried on the smoothed log, with the few
//! steps of the parameters that choose the knots. The score is the sum of the logarithms of the residuals. A mistake that is found makes them far smaller.

use super::knot_choice::{Candidate, candidate};
use crate::chain::KinematicChain;
use crate::estimate::result::plausible;
use crate::estimate::{MachineProblem, MachineSetup};
use crate::log::{PoseLog, ReferenceLog};
use calibrant_core::diagnostic::machine::{JointReversed, PosesOtherwise, UpOtherwise};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::sensor::{Axis, Recording, SensorKind};
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

/// A distance of knots that follows hands and machines well enough to compare, s.
const STEP_S: f64 = 0.1;
/// A mistake is named where the residuals without it are this many times smaller, in the geometric mean.
const TELLING: f64 = 2.0;
/// Residuals that differ by less than this factor are the same.
const ALIKE: f64 = 1.05;

/// Mistakes whose residuals differ by less than this factor are all named: none of them is found.
const MARGIN: f64 = 1.25;
/// More than as many tell nothing.
const MOST_NAMED: usize = 3;

type Turned = Box<dyn Fn(&UnitQuaternion<f64>) -> UnitQuaternion<f64>>;
type Placed = Box<dyn Fn(&Vector3<f64>, &UnitQuaternion<f64>) -> Vector3<f64>>;

/// The mistake without which recording and log fit; `None` where none of those that are tried is it.
pub(crate) fn suspect(problem: &MachineProblem<'_>) -> Option<Diagnostic> {
    let as_given = Tried::of(problem);
    // of two that fit alike, the simpler one stands first
    let upwards: Vec<(Mistake, Tried)> = other_directions_up(problem.setup)
        .map(|(up, setup)| (Mistake::Up(up), Tried::of(&MachineProblem { setup: &setup, ..*problem })))
        .collect();
    if let Some(found) = gravity_for_bias(&as_given, &upwards) {
        return Some(found);
    }
    let others: Vec<(Mistake, Tried)> = match problem.log {
        ReferenceLog::Joints(_) => reversed(problem.chain?)
            .map(|(found, chain)| (found, Tried::of(&MachineProblem { chain: Some(&chain), ..*problem })))
            .collect(),
        ReferenceLog::Poses(log) => conventions()
            .map(|(found, turned, placed)| {
                let log = ReferenceLog::Poses(otherwise(log, &turned, &placed));
                (Mistake::Poses(found), Tried::of(&MachineProblem { log: &log, ..*problem }))
            })
            .collect(),
    };
    let all: Vec<_> = upwards.into_iter().chain(others).collect();
    let least = all.iter().map(|(_, tried)| tried.score).fold(f64::INFINITY, f64::min);
    let mut alike: Vec<_> = all.iter().filter(|(_, tried)| tried.score < least + MARGIN.ln()).collect();
    alike.sort_by(|(_, one), (_, other)| one.score.total_cmp(&other.score));
    let found: Vec<&Mistake> = alike.into_iter().map(|(mistake, _)| mistake).collect();
    if least < as_given.score - TELLING.ln() { told(&found) } else { None }
}

/// A mistake that is tried, in words.
enum Mistake {
    /// The direction up.
    Up(String),
    /// The convention of the poses.
    Poses(String),
    /// A joint that is reversed.
    Joint(String),
}

/// The mistakes with which recording and log fit alike, the best first, as one diagnostic. `None` where they are too many to tell anything.
fn told(found: &[&Mistake]) -> Option<Diagnostic> {
    // joints turn about axes of their own: the best is the one
    if let Some(Mistake::Joint(joint)) = found.first() {
        return Some(JointReversed { joint: joint.clone() }.into());
    }
    if found.is_empty() || found.len() > MOST_NAMED {
        return None;
    }
    let is_up = |of: &&Mistake| matches!(of, Mistake::Up(_));
    let words = |between: &str| {
        let one = |of: &&Mistake| match of {
            Mistake::Up(up) if !found.iter().all(is_up) => format!("the direction up is \"{up}\""),
            Mistake::Up(words) | Mistake::Poses(words) | Mistake::Joint(words) => words.clone(),
        };
        Phrase(found.iter().map(one).collect::<Vec<_>>().join(between))
    };
    Some(match found.iter().all(is_up) {
        true => UpOtherwise { up: words("\" or \"") }.into(),
        false => PosesOtherwise { convention: words(", and as well if ") }.into(),
    })
}

/// The direction up with which the biases are those of a sensor, where the residuals are the same: the machine does not turn gravity.
fn gravity_for_bias(as_given: &Tried, upwards: &[(Mistake, Tried)]) -> Option<Diagnostic> {
    let is_it = |tried: &Tried| !tried.is_biased && (tried.score - as_given.score).abs() < ALIKE.ln();
    let fitting = upwards.iter().filter(|(_, tried)| as_given.is_biased && is_it(tried));
    let (found, _) = fitting.min_by(|(_, one), (_, other)| one.score.total_cmp(&other.score))?;
    told(&[found])
}

/// What a mistake makes of the fit.
struct Tried {
    /// Mean logarithm of the residuals; infinite where nothing fits.
    score: f64,
    /// Is half of gravity a bias?
    is_biased: bool,
}

impl Tried {
    fn of(problem: &MachineProblem<'_>) -> Self {
        let Some(found) = candidate(problem, STEP_S, None).ok().flatten() else {
            return Self { score: f64::INFINITY, is_biased: false };
        };
        let Candidate { score, components, parameters, .. } = found;
        let unit = problem.recording[SensorKind::Accelerometer].as_ref().map(Recording::unit);
        let bias = unit.and_then(|unit| plausible::bias(problem.setup, &parameters.imu, unit));
        Self { score: score / components as f64, is_biased: bias.is_some() }
    }
}

/// The chain with each joint in turn the other way.
fn reversed(chain: &KinematicChain) -> impl Iterator<Item = (Mistake, KinematicChain)> + '_ {
    chain.joints.iter().enumerate().map(|(j, joint)| {
        let mut chain = chain.clone();
        chain.joints[j].axis = Unit::new_unchecked(-joint.axis.into_inner());
        (Mistake::Joint(joint.name.clone()), chain)
    })
}

/// The other axes of the world as the direction up.
fn other_directions_up(setup: &MachineSetup) -> impl Iterator<Item = (String, MachineSetup)> + '_ {
    let directions = Axis::ALL.into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
    directions.filter_map(|(axis, sign)| {
        let mut up = Vector3::zeros();
        up[axis.index()] = sign;
        let name = format!("{}{axis}", if sign < 0.0 { "-" } else { "" });
        let is_other = up.dot(&setup.up.normalize()) < 0.7;
        is_other.then(|| (name, MachineSetup { up, ..setup.clone() }))
    })
}

fn otherwise(log: &PoseLog, turned: &Turned, placed: &Placed) -> PoseLog {
    let places = log.positions_m.iter().zip(&log.world_from_body);
    PoseLog {
        times_s: log.times_s.clone(),
        positions_m: places.map(|(at, of)| Some(placed(at.as_ref()?, &of.unwrap_or_default()))).collect(),
        world_from_body: log.world_from_body.iter().map(|of| of.as_ref().map(turned)).collect(),
    }
}

/// The usual other conventions of poses.
fn conventions() -> impl Iterator<Item = (String, Turned, Placed)> {
    let of = |values: [f64; 4]| {
        let [w, i, j, k] = values;
        UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k))
    };
    let same = || -> Placed { Box::new(|at, _| *at) };
    let w_last = move |q: &UnitQuaternion<f64>| of([q.k, q.w, q.i, q.j]);
    let w_first = move |q: &UnitQuaternion<f64>| of([q.i, q.j, q.k, q.w]);
    let mut all: Vec<(String, Turned, Placed)> = vec![
        ("their quaternions are x, y, z, w, not w, x, y, z".into(), Box::new(w_last), same()),
        ("their quaternions are w, x, y, z, not x, y, z, w".into(), Box::new(w_first), same()),
        (
            "their quaternions are x, y, z, w, and turn the world into the body".into(),
            Box::new(move |q| w_last(q).inverse()),
            same(),
        ),
        (
            "their quaternions are w, x, y, z, and turn the world into the body".into(),
            Box::new(move |q| w_first(q).inverse()),
            same(),
        ),
        ("their quaternions turn the world into the body".into(), Box::new(UnitQuaternion::inverse), same()),
        (
            "they are of the world in the body".into(),
            Box::new(UnitQuaternion::inverse),
            Box::new(|at, turned| -turned.inverse_transform_vector(at)),
        ),
    ];
    for axis in Axis::ALL {
        let mut mirror = Vector3::repeat(1.0);
        mirror[axis.index()] = -1.0;
        let placed = move || -> Placed { Box::new(move |at, _| at.component_mul(&mirror)) };
        // a mirror turns an axis of rotation by half a turn beside
        let turned = move |q: &UnitQuaternion<f64>, sign: f64| {
            let v = Vector3::new(q.i, q.j, q.k).component_mul(&mirror) * sign;
            of([q.w, v.x, v.y, v.z])
        };
        let frame = format!("they are of a left-handed frame: mirror {axis}");
        all.push((frame.clone(), Box::new(move |q| turned(q, -1.0)), placed()));
        all.push((frame + ", and invert the angles", Box::new(move |q| turned(q, 1.0)), placed()));
    }
    all.into_iter()
}

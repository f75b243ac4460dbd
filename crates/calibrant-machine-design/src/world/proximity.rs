//! The distances that a motion must keep.

use super::capsule::Nearest;
use super::pairs::pairs;
use super::{Capsule, Cuboid, LeftOutPair, Scene};
use calibrant_machine::chain::{Joint, KinematicChain};
use nalgebra::{AbstractRotation, Isometry, Unit, Vector3};

/// Distances beyond this are reported as this, m: a lower bound that no joint moves. What is so far decides nothing, and most pairs are.
pub const FAR_M: f64 = 0.3;

/// How near two bodies are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity {
    /// Negative where they overlap; at most [`FAR_M`], where both points are of the base.
    pub distance_m: f64,
    /// The frame that the first body moves with (0 the base, k the one behind joint k), and its nearest point in the axes of the base, m.
    pub a: (usize, Vector3<f64>),
    /// The same of the second body.
    pub b: (usize, Vector3<f64>),
    /// Unit vector from `a` to `b`.
    pub normal: Vector3<f64>,
}

impl Proximity {
    /// Both bodies are far.
    #[must_use]
    pub fn far() -> Self {
        let nowhere = (0, Vector3::zeros());
        Self { distance_m: FAR_M, a: nowhere, b: nowhere, normal: Vector3::z() }
    }
}

/// Two bodies whose distance is a row.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPair {
    /// Names of the bodies: links, `sensor`, `floor`, `box 1`.
    pub names: [String; 2],
    /// Their frames.
    pub frames: [usize; 2],
    /// Largest distance of a point of each from the origin of its frame, m; 0 for what does not move.
    pub extents_m: [f64; 2],
}

#[derive(Debug, Clone)]
enum Obstacle {
    /// A capsule of another body, by its place.
    Capsule(usize),
    Floor,
    Box(Cuboid),
}

#[derive(Debug, Clone)]
struct Row {
    pair: BodyPair,
    /// Place of the capsule of the first body. Against the floor it is a ball: one end of a capsule.
    capsule: usize,
    against: Obstacle,
}

/// A capsule that moves with a frame, in its axes.
#[derive(Debug, Clone)]
struct Carried {
    frame: usize,
    capsule: Capsule,
    bounding_radius_m: f64,
}

/// A machine and where it stands.
///
/// # Examples
/// An arm of two rods of 0.5 m, hanging over the floor.
/// ```
/// use calibrant_machine::chain::*;
/// use calibrant_machine_design::world::*;
/// use nalgebra::{Isometry3, Vector3};
/// let joint = |name: &str, x: f64| Joint {
///     name: name.into(),
///     kind: JointKind::Continuous,
///     axis: Vector3::y_axis(),
///     origin: Isometry3::translation(x, 0.0, 0.0),
///     limits: JointLimits::default(),
/// };
/// let arm = KinematicChain {
///     base: "base".into(),
///     tip: "hand".into(),
///     joints: vec![joint("shoulder", 0.0), joint("elbow", 0.5)],
///     tip_transform: Isometry3::translation(0.5, 0.0, 0.0),
/// };
/// let hand = Body {
///     name: "hand".into(),
///     frame: 2,
///     capsules: vec![Capsule::ball(Vector3::new(0.5, 0.0, 0.0), 0.05)],
///     source: BodySource::Given,
/// };
/// let scene = Scene { bodies: vec![hand], floor_m: Some(-0.2), ..Scene::default() };
/// let world = World::new(&arm, &[(-3.0, 3.0); 2], scene);
/// let mut distances = vec![Proximity::far(); world.rows()];
/// // the lower arm turns down by 0.1 rad
/// let frames = [vec![Isometry3::identity()], arm.nominal().frames(&[0.0, 0.1])].concat();
/// world.proximities(&frames, &mut distances);
/// assert!((distances[0].distance_m - (0.2 - 0.5 * 0.1_f64.sin() - 0.05)).abs() < 1e-12);
/// ```
#[derive(Debug, Clone)]
pub struct World {
    scene: Scene,
    left_out: Vec<LeftOutPair>,
    /// What the rows are between, each once.
    carried: Vec<Carried>,
    rows: Vec<Row>,
}

impl World {
    /// A machine whose joints move within these ranges, and what stands around it.
    ///
    /// # Panics
    /// If there is not one range for each joint, or a body moves with a frame that is not there.
    #[must_use]
    pub fn new(chain: &KinematicChain, ranges: &[(f64, f64)], scene: Scene) -> Self {
        assert_eq!(ranges.len(), chain.joints.len(), "one range for each joint");
        let bodies = &scene.bodies;
        let (kept, left_out) = pairs(chain, ranges, &scene);
        let (mut carried, mut rows) = (Vec::new(), Vec::new());
        for (near, far) in kept.into_iter().map(|(near, far)| (&bodies[near], &bodies[far])) {
            for (capsule, other) in
                far.capsules.iter().flat_map(|of| near.capsules.iter().map(move |other| (of, other)))
            {
                let pair = BodyPair {
                    names: [far.name.clone(), near.name.clone()],
                    frames: [far.frame, near.frame],
                    extents_m: [capsule.extent_m(), other.extent_m()],
                };
                let capsule = place(&mut carried, far.frame, capsule);
                let against = Obstacle::Capsule(place(&mut carried, near.frame, other));
                rows.push(Row { pair, capsule, against });
            }
        }
        for body in bodies.iter().filter(|body| body.frame > 0) {
            let mut row = |capsule: &Capsule, name: String, against: Obstacle| {
                let pair = BodyPair {
                    names: [body.name.clone(), name],
                    frames: [body.frame, 0],
                    extents_m: [capsule.extent_m(), 0.0],
                };
                rows.push(Row { pair, capsule: place(&mut carried, body.frame, capsule), against });
            };
            if scene.floor_m.is_some() && changes_height(&chain.joints[..body.frame], &scene.up) {
                let ends = body.capsules.iter().flat_map(ends);
                ends.for_each(|end| row(&end, "floor".into(), Obstacle::Floor));
            }
            for (k, cuboid) in scene.boxes.iter().enumerate() {
                let mut boxed = |of: &Capsule| row(of, format!("box {}", k + 1), Obstacle::Box(*cuboid));
                body.capsules.iter().for_each(&mut boxed);
            }
        }
        Self { scene, left_out, carried, rows }
    }

    /// Number of distances.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// All distances in one posture.
    ///
    /// `frames` are the poses, in the base, of the base itself and of the frame behind each joint.
    pub fn proximities<R: AbstractRotation<f64, 3>>(
        &self,
        frames: &[Isometry<f64, R, 3>],
        out: &mut [Proximity],
    ) {
        let of = self.carried.iter().map(|carried| carried.capsule.placed(&frames[carried.frame]));
        let placed: Vec<Capsule> = of.collect();
        for (row, out) in self.rows.iter().zip(out) {
            *out = self.proximity(row, &placed);
        }
    }

    /// Which bodies a distance is between.
    #[must_use]
    pub fn pair(&self, row: usize) -> &BodyPair {
        &self.rows[row].pair
    }

    /// The bodies, the floor and the boxes.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Pairs that are not kept apart, and why.
    #[must_use]
    pub fn left_out(&self) -> &[LeftOutPair] {
        &self.left_out
    }

    fn proximity(&self, row: &Row, placed: &[Capsule]) -> Proximity {
        let (own, bounding) = (&placed[row.capsule], self.carried[row.capsule].bounding_radius_m);
        let is_beyond = |to: &Vector3<f64>, radius: f64| {
            let reach = FAR_M + bounding + radius;
            (own.middle() - to).norm_squared() > reach * reach
        };
        let nearest = match &row.against {
            Obstacle::Capsule(other) => {
                let (other, of) = (&placed[*other], &self.carried[*other]);
                if is_beyond(&other.middle(), of.bounding_radius_m) {
                    return Proximity::far();
                }
                own.to_capsule(other)
            }
            Obstacle::Floor => self.to_floor(own),
            Obstacle::Box(cuboid) => {
                if is_beyond(&cuboid.pose.translation.vector, cuboid.half_m.norm()) {
                    return Proximity::far();
                }
                own.to_box(cuboid)
            }
        };
        if nearest.distance_m > FAR_M {
            return Proximity::far();
        }
        Proximity {
            distance_m: nearest.distance_m,
            a: (row.pair.frames[0], nearest.points[0]),
            b: (row.pair.frames[1], nearest.points[1]),
            normal: nearest.normal,
        }
    }

    /// A ball against the floor.
    fn to_floor(&self, ball: &Capsule) -> Nearest {
        let up = self.scene.up.into_inner();
        let height = ball.ends_m[0].dot(&up) - self.scene.floor_m.unwrap_or(f64::NEG_INFINITY);
        let distance_m = height - ball.radius_m;
        let lowest = ball.ends_m[0] - up * ball.radius_m;
        Nearest { distance_m, points: [lowest, lowest - up * distance_m], normal: -up }
    }
}

/// The place of a capsule among those that are carried, where it is put if it is new.
fn place(carried: &mut Vec<Carried>, frame: usize, capsule: &Capsule) -> usize {
    let known = carried.iter().position(|of| of.frame == frame && of.capsule == *capsule);
    known.unwrap_or_else(|| {
        let bounding_radius_m = capsule.bounding_radius_m();
        carried.push(Carried { frame, capsule: *capsule, bounding_radius_m });
        carried.len() - 1
    })
}

/// The ends of a capsule as balls. The lower one is nearest to the floor, and which one that is may change: each has a smooth distance.
fn ends(capsule: &Capsule) -> impl Iterator<Item = Capsule> + use<> {
    let [one, other] = capsule.ends_m;
    let radius_m = capsule.radius_m;
    let ends = [Some(one), (one != other).then_some(other)];
    ends.into_iter().flatten().map(move |end| Capsule::ball(end, radius_m))
}

/// Whether these joints change the height of what is behind them: not if all turn about the vertical or slide along the floor.
fn changes_height(joints: &[Joint], up: &Unit<Vector3<f64>>) -> bool {
    let mut up = up.into_inner();
    !joints.iter().all(|joint| {
        // the direction up, in the axes of the joint: what comes before keeps it
        up = joint.origin.rotation.inverse() * up;
        let rise = joint.axis.dot(&up);
        if joint.kind.turns() { joint.axis.cross(&up).norm() < 1e-9 } else { rise.abs() < 1e-9 }
    })
}

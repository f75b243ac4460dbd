//! What pictures of a machine show: its postures over time, and the sensor on its tip.

use calibrant_machine::chain::{KinematicChain, SensorMount};
use calibrant_machine::estimate::{MachineCalibration, MachineSetup};
use calibrant_machine::reference::{Motion, Posture};
use calibrant_machine::spline::VectorSpline;
use calibrant_machine_design::world::{Body, Capsule, Cuboid, World};
use nalgebra::Vector3;

/// Largest number of postures along the path.
const PATH: usize = 4000;
/// Time between postures along the path, s, where that many suffice.
const PATH_STEP_S: f64 = 0.01;
/// Largest number of postures that play.
const PLAYED: usize = 200;
/// Longest part of the motion that plays, s.
const PLAYED_S: f64 = 20.0;
/// Number of points along the path of the part that plays.
const PLAYED_PATH: usize = 600;
/// Farther than this from any sample of the sensor, the motion was not seen; in the usual distance of samples.
const UNSEEN: f64 = 2.0;

#[derive(Debug)]
pub(crate) struct Scene {
    /// Postures over the whole time, where samples of the sensor are.
    pub(crate) path: Vec<Posture>,
    /// Postures of the liveliest part, evenly in time. In a gap the last one before it stays.
    pub(crate) played: Vec<Posture>,
    /// The same more densely, where samples of the sensor are.
    pub(super) played_path: Vec<Posture>,
    pub(crate) mount: SensorMount,
    pub(crate) is_chain: bool,
    /// Middle of everything that is drawn, m.
    pub(crate) centre: Vector3<f64>,
    /// Half the extent along each axis of the base, m.
    pub(crate) half: Vector3<f64>,
    /// The shapes that are kept apart: their frame, as of [`Body`](calibrant_machine_design::world::Body), and the capsule.
    capsules: Vec<(usize, Capsule)>,
    /// Edges of what stands around the machine, m.
    pub(super) obstacles: Vec<Vec<Vector3<f64>>>,
}

impl Scene {
    /// `None` where no sample was used.
    pub(crate) fn of(calibration: &MachineCalibration) -> Option<Self> {
        let mut seen: Vec<f64> =
            calibration.noise.iter().flat_map(|of| of.residuals.iter().map(|sample| sample.time_s)).collect();
        seen.retain(|time| time.is_finite());
        seen.sort_by(f64::total_cmp);
        let (first, last) = (*seen.first()?, *seen.last()?);
        let mut steps: Vec<f64> =
            seen.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
        let middle = steps.len() / 2;
        let unseen_s = match steps.is_empty() {
            true => PATH_STEP_S,
            // both sensors are in the list
            false => 2.0 * UNSEEN * *steps.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        let count = (((last - first) / PATH_STEP_S) as usize + 1).clamp(2, PATH);
        let step_s = (last - first) / (count - 1) as f64;
        let is_seen = |time: f64| {
            let after = seen.partition_point(|other| *other < time);
            let near = [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|k| seen.get(k));
            near.into_iter().any(|other| (other - time).abs() <= unseen_s)
        };
        let times: Vec<f64> =
            (0..count).map(|k| first + k as f64 * step_s).filter(|time| is_seen(*time)).collect();
        let corrections = &calibration.parameters.corrections;
        let path = calibration.motion.postures(&times, corrections);
        let length_s = (last - first).min(PLAYED_S);
        let start_s = liveliest(&path, step_s, length_s).unwrap_or(first);
        let evenly =
            |count: usize| (0..count).map(move |k| start_s + length_s * k as f64 / (count - 1) as f64);
        let mut before = start_s;
        let stays = |time: f64| {
            if is_seen(time) {
                before = time;
            }
            before
        };
        let played: Vec<f64> = evenly(PLAYED).map(stays).collect();
        let along: Vec<f64> = evenly(PLAYED_PATH).filter(|time| is_seen(*time)).collect();
        let mut played = calibration.motion.postures(&played, corrections);
        played.iter_mut().zip(evenly(PLAYED)).for_each(|(posture, time)| posture.time_s = time);
        let mut scene = Self {
            path,
            played,
            played_path: calibration.motion.postures(&along, corrections),
            mount: calibration.parameters.mount,
            is_chain: matches!(calibration.motion, Motion::Joints(_)),
            centre: Vector3::zeros(),
            half: Vector3::repeat(1.0),
            capsules: Vec::new(),
            obstacles: Vec::new(),
        };
        scene.frame();
        Some(scene)
    }

    /// Of a trajectory of a chain, with the shapes that are kept apart.
    pub(crate) fn of_trajectory(
        motion: &VectorSpline,
        chain: &KinematicChain,
        setup: &MachineSetup,
        world: &World,
    ) -> Self {
        let nominal = chain.nominal();
        let knots = motion.knots;
        let duration_s = knots.step_s * knots.intervals as f64;
        let postures = |count: usize| -> Vec<Posture> {
            let at = |k: usize| {
                let time_s = knots.start_s + duration_s * k as f64 / (count - 1) as f64;
                let positions = motion.at(time_s, 0);
                let velocity = nominal.tip_velocity(&positions, &motion.at(time_s, 1));
                Posture {
                    time_s,
                    frames: nominal.frames(&positions),
                    speed_mps: velocity.linear_mps.norm(),
                    rate_radps: velocity.rate_radps.norm(),
                }
            };
            (0..count).map(at).collect()
        };
        let mount = SensorMount { lever_m: setup.lever_m, tip_from_sensor: setup.tip_from_sensor };
        let mut scene = Self {
            path: postures(((duration_s / PATH_STEP_S) as usize + 1).clamp(2, PATH)),
            played: postures(PLAYED),
            played_path: postures(PLAYED_PATH),
            mount,
            is_chain: true,
            centre: Vector3::zeros(),
            half: Vector3::repeat(1.0),
            capsules: world.scene().bodies.iter().flat_map(of_body).collect(),
            obstacles: world.scene().boxes.iter().flat_map(edges).collect(),
        };
        scene.frame();
        scene
    }

    /// Centre and extent of all that is drawn.
    fn frame(&mut self) {
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = -low;
        let postures = self.path.iter().chain(&self.played);
        let links: Vec<Vector3<f64>> = postures.flat_map(|posture| self.links(posture)).collect();
        for point in links.into_iter().chain(self.obstacles.iter().flatten().copied()) {
            if point.iter().all(|x| x.is_finite()) {
                (low, high) = (low.inf(&point), high.sup(&point));
            }
        }
        if low.x <= high.x {
            self.centre = (low + high) / 2.0;
            self.half = ((high - low) / 2.0).map(|half| half.max(1e-3));
        }
    }

    /// The points that links join: from the base to the tip, or the body alone; m.
    pub(crate) fn links(&self, posture: &Posture) -> Vec<Vector3<f64>> {
        let base = self.is_chain.then(Vector3::zeros);
        base.into_iter().chain(posture.frames.iter().map(|frame| frame.translation.vector)).collect()
    }

    /// Ends of the tip's axes x, y, z, and the sensor; m.
    pub(crate) fn tip_and_sensor(&self, posture: &Posture) -> [Vector3<f64>; 4] {
        let (tip, length) = (posture.tip(), 0.16 * self.half.max());
        let at = |point: Vector3<f64>| tip.translation.vector + tip.rotation * point;
        [
            at(Vector3::x() * length),
            at(Vector3::y() * length),
            at(Vector3::z() * length),
            at(self.mount.lever_m),
        ]
    }

    /// Ends of the capsules in a posture, m.
    pub(super) fn capsule_ends(&self, posture: &Posture) -> Vec<[Vector3<f64>; 2]> {
        let at = |(frame, capsule): &(usize, Capsule)| match frame
            .checked_sub(1)
            .and_then(|k| posture.frames.get(k))
        {
            Some(frame) => capsule.ends_m.map(|end| frame.translation.vector + frame.rotation * end),
            None => capsule.ends_m,
        };
        self.capsules.iter().map(at).collect()
    }

    /// Radii of the capsules, m.
    pub(super) fn radii_m(&self) -> impl Iterator<Item = f64> {
        self.capsules.iter().map(|(_, capsule)| capsule.radius_m)
    }

    /// A few postures, evenly over the played part.
    pub(crate) fn few(&self) -> impl Iterator<Item = &Posture> {
        const FEW: usize = 5;
        (0..FEW).filter_map(|k| self.played.get(k * (self.played.len() - 1) / (FEW - 1)))
    }
}

fn of_body(body: &Body) -> impl Iterator<Item = (usize, Capsule)> {
    body.capsules.iter().map(|capsule| (body.frame, *capsule))
}

/// The twelve edges of a box, m.
fn edges(cuboid: &Cuboid) -> Vec<Vec<Vector3<f64>>> {
    let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let at = |corner: usize| {
        let of = cuboid.half_m.component_mul(&Vector3::from_fn(|axis, _| sign(corner, axis)));
        cuboid.pose.translation.vector + cuboid.pose.rotation * of
    };
    let from = (0..8).flat_map(|corner| (0..3).map(move |axis| (corner, corner | 1 << axis)));
    from.filter(|(one, other)| one != other).map(|(one, other)| vec![at(one), at(other)]).collect()
}

/// The path of the tip in parts without a gap, m.
pub(super) fn without_gaps(postures: &[Posture]) -> Vec<Vec<Vector3<f64>>> {
    let steps = postures.windows(2).map(|pair| pair[1].time_s - pair[0].time_s);
    let step_s = steps.fold(f64::INFINITY, f64::min);
    postures
        .chunk_by(|one, next| next.time_s - one.time_s < 1.5 * step_s)
        .map(|run| run.iter().map(|posture| posture.tip().translation.vector).collect())
        .collect()
}

/// Start of the part of this length in which the tip moves and turns most.
fn liveliest(path: &[Posture], step_s: f64, length_s: f64) -> Option<f64> {
    let mean = |of: &dyn Fn(&Posture) -> f64| {
        (path.iter().map(of).sum::<f64>() / path.len().max(1) as f64).max(f64::MIN_POSITIVE)
    };
    let (speed, rate) = (mean(&|at| at.speed_mps), mean(&|at| at.rate_radps));
    let window = ((length_s / step_s).floor() as usize).clamp(1, path.len().max(1));
    let activity: Vec<f64> = path.iter().map(|at| at.speed_mps / speed + at.rate_radps / rate).collect();
    let mut sum: f64 = activity.get(..window)?.iter().sum();
    let mut best = (sum, 0);
    for first in 1..=path.len() - window {
        sum += activity[first + window - 1] - activity[first - 1];
        if sum > best.0 * (1.0 + 1e-9) {
            best = (sum, first);
        }
    }
    let latest = path.last()?.time_s - length_s;
    Some(path[best.1].time_s.min(latest).max(path[0].time_s))
}

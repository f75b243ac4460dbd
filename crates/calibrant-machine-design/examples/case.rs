//! Designs the trajectory of a case file in JSON, and writes it: `case CASE.json trajectory.csv [seed] [starts] [D or A] [knot_s]`.

use calibrant_core::progress::{Progress, Step};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use calibrant_machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use calibrant_machine_design::world::{BodyPair, Proximity};
use calibrant_machine_design::{
    Dwells, JointLimit, Surroundings, TrajectoryCriterion, TrajectoryNoise, TrajectoryProblem,
    TrajectorySettings, design_trajectory,
};
use nalgebra::{Isometry3, IsometryMatrix3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let path = Path::new(&arguments[1]);
    let case: Value = serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("JSON");
    let urdf = path.parent().expect("a folder").parent().expect("a folder").join(text(&case["urdf"]));
    let chain =
        chain(&std::fs::read_to_string(urdf).expect("readable"), text(&case["base"]), text(&case["tip"]));
    let (setup, world) = (setup(&case), Capsules::of(&case));
    let quantities = quantities();
    let argument = |k: usize, otherwise: usize| {
        arguments.get(k).map_or(otherwise, |text| text.parse().expect("a number"))
    };
    let criterion = match arguments.get(5).map(String::as_str) {
        Some("A") => TrajectoryCriterion::A { range: [2.0 * 9.80665, 500_f64.to_radians()] },
        _ => TrajectoryCriterion::D,
    };
    let mut problem = problem(&case, &chain, &setup, &quantities, &world, criterion);
    problem.knot_s = arguments.get(6).map_or(problem.knot_s, |text| text.parse().expect("a number"));
    let defaults = TrajectorySettings::default();
    let begun = std::time::Instant::now();
    let told = move |step: Step| {
        eprintln!("stage {} of {}: {:.2} s", step.done, step.of, begun.elapsed().as_secs_f64())
    };
    let settings = TrajectorySettings {
        seed: argument(3, 1) as u64,
        starts: argument(4, defaults.starts),
        progress: Progress::to(told),
        ..defaults
    };
    let design = design_trajectory(&problem, &settings).expect("a motion");
    let elapsed_s = begun.elapsed().as_secs_f64();
    println!(
        "{:.3} {} {elapsed_s:.2} s, {} iterations",
        design.optimal.value,
        design.status.name(),
        design.iterations
    );
    println!("random {:.3}, bound {:?}, dwells {:.1?}", design.random.value, design.bound, design.dwells_s);
    for start in &design.starts {
        println!("{start:?}");
    }
    for limit in design.optimal.limits.iter().filter(|limit| limit.used > 0.95) {
        println!("{limit:?}");
    }
    let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
    let mut csv = String::from("t_s");
    for unit in ["rad", "radps", "radps2"] {
        for name in &names {
            write!(csv, ",{name}_{unit}").expect("text");
        }
    }
    let motion = &design.optimal.motion;
    let knots = motion.knots;
    for k in 0..=knots.intervals {
        let t = knots.knot_s(k);
        write!(csv, "\n{t:.12}").expect("text");
        for d in 0..3 {
            for value in motion.at(t, d) {
                write!(csv, ",{value:.15}").expect("text");
            }
        }
    }
    std::fs::write(&arguments[2], csv + "\n").expect("writable");
}

fn text(value: &Value) -> &str {
    value.as_str().expect("text")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn vector(value: &Value) -> Vector3<f64> {
    Vector3::from_fn(|k, _| number(&value[k]))
}

fn quantities() -> Vec<ImuQuantity> {
    let mut all = Vec::new();
    for kind in SensorKind::ALL {
        for row in Axis::ALL {
            all.push(ImuQuantity::Of(kind, Quantity::Bias(row)));
            all.extend(Axis::ALL.map(|column| {
                ImuQuantity::Of(
                    kind,
                    if row == column { Quantity::Scale(row) } else { Quantity::CrossAxis(row, column) },
                )
            }));
        }
    }
    all
}

fn setup(case: &Value) -> MachineSetup {
    let (priors, sensor) = (&case["priors"], &case["sensor"]);
    let of = |key: &str| number(&priors[key]);
    MachineSetup {
        gravity_mps2: number(&case["gravity_mps2"]),
        gravity_sd_mps2: of("gravity_mps2"),
        up: vector(&case["up"]),
        tilt_sd_rad: of("tilt_rad"),
        lever_m: vector(&sensor["lever_m"]),
        lever_sd_m: of("lever_m"),
        tip_from_sensor: UnitQuaternion::from_scaled_axis(vector(&sensor["rotvec"])),
        mounting: if of("mount_rad") > 0.0 {
            MountingPrior::Within(of("mount_rad"))
        } else {
            MountingPrior::Exact
        },
        delay_sd_s: of("delay_s"),
        delay_difference_sd_s: of("delay_difference_s"),
        clock_rate_sd: of("clock"),
        geometry_translation_sd_m: of("geometry_m"),
        geometry_rotation_sd_rad: of("geometry_rad"),
        zero_sd: of("zero_rad"),
        ..MachineSetup::default()
    }
}

fn problem<'a>(
    case: &Value,
    chain: &'a KinematicChain,
    setup: &'a MachineSetup,
    quantities: &'a [ImuQuantity],
    world: &'a Capsules,
    criterion: TrajectoryCriterion,
) -> TrajectoryProblem<'a> {
    let joints = &case["joints"];
    let limit = |j: usize| JointLimit {
        lower: number(&joints["lower"][j]),
        upper: number(&joints["upper"][j]),
        velocity: number(&joints["velocity"][j]),
        acceleration: number(&joints["acceleration"][j]),
        jerk: number(&joints["jerk"][j]),
        near_ends: None,
    };
    TrajectoryProblem {
        chain,
        setup,
        quantities,
        cross_axis_sd: [0.0; 2],
        noise: TrajectoryNoise {
            force_density: Some(number(&case["noise"]["acc_mps2_rthz"])),
            rate_density: Some(number(&case["noise"]["gyr_radps_rthz"])),
            moving: case["noise"]["moving_factor"].as_f64().unwrap_or(1.0),
        },
        joints: (0..chain.joints.len()).map(limit).collect(),
        force_range_mps2: Vector3::repeat(number(&case["range"]["f_mps2"])),
        rate_range_radps: Vector3::repeat(number(&case["range"]["w_radps"])),
        tip_speed_mps: case["tip_speed_mps"].as_f64(),
        sensor_body: None,
        surroundings: Some(world),
        clearance_m: number(&case["clearance_m"]),
        duration_s: number(&case["duration_s"]),
        knot_s: 0.2,
        home: case["home"].as_array().map(|home| home.iter().map(number).collect()),
        criterion,
        dwells: Dwells::Auto,
    }
}

/// The chain of a URDF file of revolute and fixed joints.
fn chain(urdf: &str, base: &str, tip: &str) -> KinematicChain {
    let document = roxmltree::Document::parse(urdf).expect("XML");
    let child = |node: roxmltree::Node<'_, '_>, name: &str| {
        node.children().find(|child| child.has_tag_name(name)).map(|child| child.id())
    };
    let numbers = |text: &str| {
        let all: Vec<f64> = text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
        Vector3::new(all[0], all[1], all[2])
    };
    let node = |id| document.get_node(id).expect("a node");
    let (mut path, mut link) = (Vec::new(), tip.to_owned());
    while link != base {
        let joint = (document.descendants())
            .find(|of| {
                of.has_tag_name("joint")
                    && child(*of, "child").is_some_and(|id| node(id).attribute("link") == Some(&link))
            })
            .expect("a joint");
        link = node(child(joint, "parent").expect("a parent")).attribute("link").expect("a link").to_owned();
        path.push(joint);
    }
    let (mut joints, mut fixed) = (Vec::new(), Isometry3::identity());
    for joint in path.into_iter().rev() {
        if let Some(origin) = child(joint, "origin").map(node) {
            let of = |key| numbers(origin.attribute(key).unwrap_or("0 0 0"));
            let (xyz, rpy) = (of("xyz"), of("rpy"));
            fixed *= Isometry3::from_parts(
                Translation3::from(xyz),
                UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z),
            );
        }
        if joint.attribute("type") != Some("fixed") {
            let axis =
                child(joint, "axis").map(node).and_then(|axis| axis.attribute("xyz")).unwrap_or("1 0 0");
            joints.push(Joint {
                name: joint.attribute("name").expect("a name").to_owned(),
                kind: JointKind::Revolute,
                axis: Unit::new_normalize(numbers(axis)),
                origin: std::mem::replace(&mut fixed, Isometry3::identity()),
                limits: JointLimits::default(),
            });
        }
    }
    KinematicChain { base: base.to_owned(), tip: tip.to_owned(), joints, tip_transform: fixed }
}

struct Capsule {
    name: String,
    frame: usize,
    ends: [Point3<f64>; 2],
    radius: f64,
}

/// Capsules, pairs of them, and a floor.
struct Capsules {
    all: Vec<Capsule>,
    pairs: Vec<[usize; 2]>,
    floor: Option<f64>,
    above_floor: Vec<usize>,
}

impl Capsules {
    fn of(case: &Value) -> Self {
        let capsule = |of: &Value| Capsule {
            name: text(&of["link"]).to_owned(),
            frame: of["frame"].as_u64().expect("a number") as usize,
            ends: [Point3::from(vector(&of["a"])), Point3::from(vector(&of["b"]))],
            radius: number(&of["r"]),
        };
        let list = |value: &Value| value.as_array().expect("a list").clone();
        let all: Vec<Capsule> = list(&case["capsules"]).iter().map(capsule).collect();
        let pair = |of: &Value| [0, 1].map(|k: usize| of[k].as_u64().expect("a number") as usize);
        Self {
            pairs: list(&case["pairs"]).iter().map(pair).collect(),
            floor: case["world"]["floor_z"].as_f64(),
            above_floor: (0..all.len()).filter(|k| all[*k].frame >= 2).collect(),
            all,
        }
    }
}

impl Surroundings for Capsules {
    fn rows(&self) -> usize {
        self.pairs.len() + self.floor.map_or(0, |_| 2 * self.above_floor.len())
    }

    fn pair(&self, row: usize) -> BodyPair {
        let reach = |k: usize| {
            let Capsule { ends, radius, .. } = &self.all[k];
            ends.iter().map(|end| end.coords.norm()).fold(0.0, f64::max) + radius
        };
        let (a, b) = match row.checked_sub(self.pairs.len()) {
            None => (self.pairs[row][0], Some(self.pairs[row][1])),
            Some(row) => (self.above_floor[row / 2], None),
        };
        let other = b.map_or("floor".to_owned(), |b| self.all[b].name.clone());
        BodyPair {
            names: [self.all[a].name.clone(), other],
            frames: [self.all[a].frame, b.map_or(0, |b| self.all[b].frame)],
            extents_m: [reach(a), b.map_or(0.0, reach)],
        }
    }

    fn proximities(&self, frames: &[IsometryMatrix3<f64>], out: &mut [Proximity]) {
        let place = |of: &Capsule| {
            let [one, other] = &of.ends;
            [(frames[of.frame] * one).coords, (frames[of.frame] * other).coords]
        };
        let placed: Vec<[Vector3<f64>; 2]> = self.all.iter().map(place).collect();
        let ends = |k: usize| placed[k];
        let (pairs, floors) = out.split_at_mut(self.pairs.len());
        for (near, &[i, j]) in pairs.iter_mut().zip(&self.pairs) {
            let (one, other) = (&self.all[i], &self.all[j]);
            let [a, b] = nearest(ends(i), ends(j));
            let way = b - a;
            let distance = way.norm();
            *near = Proximity {
                distance_m: distance - one.radius - other.radius,
                a: (one.frame, a),
                b: (other.frame, b),
                normal: way / distance,
            };
        }
        for (row, near) in floors.iter_mut().enumerate() {
            let k = self.above_floor[row / 2];
            let end = ends(k)[row % 2];
            *near = Proximity {
                distance_m: end.z - self.all[k].radius - self.floor.unwrap_or(f64::NEG_INFINITY),
                a: (0, Vector3::new(end.x, end.y, 0.0)),
                b: (self.all[k].frame, end),
                normal: Vector3::z(),
            };
        }
    }
}

/// The nearest points of two segments.
fn nearest([p, q]: [Vector3<f64>; 2], [r, s]: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let (u, v, w) = (q - p, s - r, p - r);
    let (a, b, c, d, e) = (u.norm_squared(), u.dot(&v), v.norm_squared(), u.dot(&w), v.dot(&w));
    let clamp = |x: f64| x.clamp(0.0, 1.0);
    let determinant = a * c - b * b;
    let mut x = if determinant > 1e-12 { clamp((b * e - c * d) / determinant) } else { 0.5 };
    let mut y = if c > 1e-15 { (b * x + e) / c } else { 0.0 };
    if !(0.0..=1.0).contains(&y) || c <= 1e-15 {
        y = clamp(y);
        x = if a > 1e-15 { clamp((b * y - d) / a) } else { 0.0 };
    }
    [p + u * x, r + v * y]
}

//! Distances of a whole machine, against differences and sampled surfaces.

use super::*;
use crate::chains_for_tests::Numbers;
use calibrant_machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
use nalgebra::{Isometry3, Unit, Vector3};

/// An arm of joints of all kinds, with axes and transforms in all directions.
fn mixed_chain(numbers: &mut Numbers) -> KinematicChain {
    let kinds = [JointKind::Revolute, JointKind::Prismatic, JointKind::Continuous, JointKind::Revolute];
    let joint = |(i, kind): (usize, JointKind)| Joint {
        name: format!("joint_{i}"),
        kind,
        axis: Unit::new_normalize(numbers.vector(1.0)),
        origin: Isometry3::new(numbers.vector(0.15), numbers.vector(2.0)),
        limits: JointLimits::default(),
    };
    let joints = kinds.into_iter().enumerate().map(joint).collect();
    KinematicChain { base: "base".into(), tip: "tip".into(), joints, tip_transform: Isometry3::identity() }
}

fn machine(numbers: &mut Numbers) -> (KinematicChain, World) {
    let chain = mixed_chain(numbers);
    let body = |frame: usize| Body {
        name: format!("link {frame}"),
        frame,
        capsules: vec![Capsule { ends_m: [numbers.vector(0.1), numbers.vector(0.1)], radius_m: 0.02 }],
        source: BodySource::Given,
    };
    let bodies = (0..5).map(body).collect();
    let cuboid = Cuboid {
        pose: Isometry3::new(numbers.vector(0.3), numbers.vector(2.0)),
        half_m: Vector3::new(0.05, 0.1, 0.02),
    };
    let up = Unit::new_normalize(numbers.vector(1.0));
    let disabled = vec![["link 4".to_owned(), "link 0".to_owned()]];
    let scene = Scene { bodies, disabled, floor_m: Some(-0.2), boxes: vec![cuboid], up };
    let world = World::new(&chain, &[(-1.0, 1.0); 4], scene);
    (chain, world)
}

fn distances(chain: &KinematicChain, world: &World, q: &[f64]) -> Vec<Proximity> {
    let frames = [vec![Isometry3::identity()], chain.nominal().frames(q)].concat();
    let mut out = vec![Proximity::far(); world.rows()];
    world.proximities(&frames, &mut out);
    out
}

/// Derivative of a distance by the position of a joint, from its two points.
fn by_joint(joint: usize, of: &Proximity, chain: &KinematicChain, q: &[f64]) -> f64 {
    let frame = chain.nominal().frames(q)[joint];
    let axis = frame.rotation * chain.joints[joint].axis.into_inner();
    let moved = |(behind, point): (usize, Vector3<f64>)| match chain.joints[joint].kind.turns() {
        _ if behind <= joint => Vector3::zeros(),
        true => axis.cross(&(point - frame.translation.vector)),
        false => axis,
    };
    of.normal.dot(&(moved(of.b) - moved(of.a)))
}

#[test]
fn the_points_of_a_distance_give_its_gradient() {
    let mut compared = 0;
    for seed in 0..30 {
        let mut numbers = Numbers(seed);
        let (chain, world) = machine(&mut numbers);
        let q: Vec<f64> = (0..4).map(|_| numbers.next(1.0)).collect();
        let here = distances(&chain, &world, &q);
        for joint in 0..4 {
            let at = |step: f64| {
                let mut q = q.clone();
                q[joint] += step;
                distances(&chain, &world, &q)
            };
            let [before, after] = [at(-1e-6), at(1e-6)];
            for ((one, here), other) in before.iter().zip(&here).zip(&after) {
                assert!((here.normal.norm() - 1.0).abs() < 1e-12);
                let gap = (here.b.1 - here.a.1).dot(&here.normal);
                if here.distance_m == FAR_M {
                    assert_eq!((here.a.0, here.b.0), (0, 0));
                    continue;
                }
                assert!((gap - here.distance_m).abs() < 1e-12, "{here:?}");
                let difference = (other.distance_m - one.distance_m) / 2e-6;
                // where the nearest point changes side between the two, the difference is none of both
                if (one.normal - other.normal).norm() < 1e-4 {
                    let slope = by_joint(joint, here, &chain, &q);
                    assert!((slope - difference).abs() < 1e-5, "{slope} against {difference}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 800, "{compared} derivatives");
}

#[test]
fn no_sampled_points_of_two_bodies_are_nearer_than_their_distance() {
    let mut numbers = Numbers(8);
    let (chain, world) = machine(&mut numbers);
    let q = [0.3, -0.2, 0.8, -0.5];
    let frames = [vec![Isometry3::identity()], chain.nominal().frames(&q)].concat();
    let surface = |name: &str, numbers: &mut Numbers| -> Vec<Vector3<f64>> {
        let body = world.scene().bodies.iter().find(|body| body.name == name).expect("a body");
        let capsule = body.capsules[0].placed(&frames[body.frame]);
        let along = capsule.ends_m[1] - capsule.ends_m[0];
        let point = |_| {
            let share = (numbers.next(0.7) + 0.5).clamp(0.0, 1.0);
            capsule.ends_m[0] + along * share + numbers.vector(1.0).normalize() * capsule.radius_m
        };
        (0..500).map(point).collect()
    };
    let mut near = 0;
    for (row, found) in distances(&chain, &world, &q).iter().enumerate() {
        let [body, other] = &world.pair(row).names;
        if !other.starts_with("link") {
            continue;
        }
        let (one, other) = (surface(body, &mut numbers), surface(other, &mut numbers));
        let pairs = one.iter().flat_map(|p| other.iter().map(move |q| (p - q).norm()));
        let least = pairs.fold(f64::MAX, f64::min);
        assert!(least >= found.distance_m - 1e-12, "{:?}", world.pair(row));
        if found.distance_m > 0.0 && found.distance_m < FAR_M {
            assert!(least < found.distance_m + 0.03, "{least} against {found:?}");
            near += 1;
        }
    }
    assert!(near > 0, "no pair is near enough to compare");
}

fn names_of(world: &World) -> Vec<String> {
    (0..world.rows()).map(|row| world.pair(row).names.join(", ")).collect()
}

#[test]
fn neighbours_and_disabled_pairs_are_no_rows() {
    let mut numbers = Numbers(2);
    let (_, world) = machine(&mut numbers);
    let reasons: Vec<_> = world.left_out().iter().map(|pair| (pair.bodies.join(", "), pair.reason)).collect();
    assert!(reasons.contains(&("link 0, link 1".to_owned(), Reason::Neighbours)), "{reasons:?}");
    assert!(reasons.contains(&("link 0, link 4".to_owned(), Reason::Disabled)), "{reasons:?}");
    let names = names_of(&world);
    assert!(!names.contains(&"link 4, link 0".to_owned()), "{names:?}");
    assert!(names.contains(&"link 4, box 1".to_owned()), "{names:?}");
}

#[test]
fn a_turntable_does_not_come_nearer_to_the_floor() {
    let joint = |name: &str, axis| Joint {
        name: name.into(),
        kind: JointKind::Continuous,
        axis,
        origin: Isometry3::translation(0.0, 0.0, 0.3),
        limits: JointLimits::default(),
    };
    let joints = vec![joint("yaw", Vector3::z_axis()), joint("pitch", Vector3::y_axis())];
    let chain = KinematicChain {
        base: "base".into(),
        tip: "tip".into(),
        joints,
        tip_transform: Isometry3::translation(0.2, 0.0, 0.0),
    };
    let bodies = bodies_of_joints(&chain);
    assert_eq!(bodies.len(), 3);
    let scene = Scene { bodies, floor_m: Some(0.0), ..Scene::default() };
    let world = World::new(&chain, &[(-3.0, 3.0); 2], scene);
    let floor = "behind pitch, floor";
    assert_eq!(
        names_of(&world),
        ["behind pitch, base", floor, floor],
        "neither the base nor what turns about the vertical"
    );
}

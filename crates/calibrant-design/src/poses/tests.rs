//! Best poses against closed forms of the theory of design.

use super::hold_information::HoldInformation;
use super::{
    Allowed, DirectionKnowledge, PoseNuisance, PoseProblem, design_poses, evaluate_poses, fewest_poses,
};
use crate::{DesignSettings, Goal};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::{AOptimality, DOptimality, EOptimality, MOptimality};
use calibrant_core::sensor::{Gauge, ParameterList, SensorModel, SensorParameters};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, Vector3, Vector4};

pub(super) fn problem(directions: DirectionKnowledge, poses: usize) -> PoseProblem {
    let list = match directions {
        DirectionKnowledge::Unknown => Gauge::Symmetric.parameter_list(SensorModel::Full),
        DirectionKnowledge::Known { .. } => ParameterList::new(3, SensorModel::Full),
    };
    PoseProblem {
        criterion: Criterion::D(DOptimality { scale: DVector::repeat(list.len(), 1.0) }),
        list,
        at: SensorParameters::identity(),
        gravity_mps2: 9.80665,
        mean_sd: Vector3::repeat(1e-3),
        directions,
        allowed: Allowed::Anywhere,
        prior: None,
        poses,
        nuisance: PoseNuisance::none(),
    }
}

const KNOWN: DirectionKnowledge = DirectionKnowledge::Known { sd_rad: 0.0 };

fn icosahedron() -> Vec<Vector3<f64>> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (one, other) in [(1.0, golden), (1.0, -golden), (-1.0, golden), (-1.0, -golden)] {
        let v = Vector3::new(0.0, one, other);
        corners.extend([v, Vector3::new(v.z, v.x, v.y), Vector3::new(v.y, v.z, v.x)]);
    }
    corners.iter().map(Vector3::normalize).collect()
}

fn tetrahedron() -> Vec<Vector3<f64>> {
    [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)]
        .map(|(x, y, z)| Vector3::new(x, y, z).normalize())
        .to_vec()
}

fn efficiency(problem: &PoseProblem, directions: &[Vector3<f64>]) -> f64 {
    evaluate_poses(problem, directions, 1).expect("determined").efficiency
}

/// A spherical 5-design makes all monomials up to degree 4 have the moments of the uniform distribution, and
/// that distribution is optimal, being invariant.
#[test]
fn the_icosahedron_is_best_where_only_gravity_is_known() {
    let found = efficiency(&problem(DirectionKnowledge::Unknown, 12), &icosahedron());
    assert!(found > 0.999 && found <= 1.0, "{found}");
}

#[test]
fn tetrahedron_and_faces_are_best_where_the_attitude_is_known() {
    let Allowed::Of(faces) = Allowed::cube(false, false) else { panic!("a list") };
    for directions in [tetrahedron(), faces] {
        let mut problem = problem(KNOWN, directions.len());
        let found = efficiency(&problem, &directions);
        assert!(found > 0.999 && found <= 1.0, "{found}");
        problem.criterion = Criterion::A(AOptimality { scale: DVector::repeat(12, 1.0) });
        let found = efficiency(&problem, &directions);
        assert!(found > 0.999 && found <= 1.0, "{found}");
    }
}

/// Known attitude, scale and bias exactly: `M = n diag(1, g²/3 …)/σ²` is the best, so `tr C` is known.
#[test]
fn the_bound_is_the_closed_form() {
    let mut problem = problem(KNOWN, 8);
    problem.criterion = Criterion::A(AOptimality { scale: DVector::repeat(12, 1.0) });
    let design = design_poses(&problem, &DesignSettings::default(), &|_| {}).expect("determined");
    let expected = 1e-6 / 8.0 * (3.0 + 9.0 * 3.0 / 9.80665_f64.powi(2));
    assert!((design.value / expected - 1.0).abs() < 1e-9, "{} {expected}", design.value);
    assert!(design.bound.value <= expected && design.bound.value > expected * 0.999);
}

#[test]
fn the_search_reaches_the_bound_with_every_criterion() {
    let ones = || DVector::repeat(9, 1.0);
    for criterion in [
        Criterion::A(AOptimality { scale: ones() }),
        Criterion::D(DOptimality { scale: ones() }),
        Criterion::E(EOptimality { scale: ones() }),
        Criterion::M(MOptimality { scale: ones() }),
    ] {
        let problem = PoseProblem { criterion, ..problem(DirectionKnowledge::Unknown, 24) };
        let settings = DesignSettings { starts: 16, ..DesignSettings::default() };
        let design = design_poses(&problem, &settings, &|_| {}).expect("determined");
        let (found, letter) = (design.efficiency(&problem.criterion), problem.criterion.letter());
        println!("{letter}: {found}");
        assert!(found > 0.97 && found <= 1.0, "{letter}: {found}");
    }
}

#[test]
fn fewer_poses_than_are_needed_are_refused_with_the_number() {
    for (directions, poses, fewest) in [(DirectionKnowledge::Unknown, 8, "9"), (KNOWN, 3, "4")] {
        let error = design_poses(&problem(directions, poses), &DesignSettings::default(), &|_| {})
            .expect_err("too few")
            .to_string();
        assert!(error.contains(&format!("at least {fewest}")), "{error}");
    }
    let faces =
        PoseProblem { allowed: Allowed::cube(false, false), ..problem(DirectionKnowledge::Unknown, 30) };
    let error = design_poses(&faces, &DesignSettings::default(), &|_| {}).expect_err("faces").to_string();
    assert!(error.contains("matrix.xy") && error.contains("design.allowed"), "{error}");
}

/// All combinations of 26 directions, by the normal matrix of one axis: `tr C = 3 σ² tr (Σ φ φᵀ)⁻¹` with `φ = (1, f)`.
#[test]
fn the_search_on_a_finite_set_finds_the_best_of_all_combinations() {
    let Allowed::Of(list) = Allowed::cube(true, true) else { panic!("a list") };
    let squares: Vec<Matrix4<f64>> = list
        .iter()
        .map(|u| {
            let phi = Vector4::new(1.0, 9.80665 * u.x, 9.80665 * u.y, 9.80665 * u.z);
            phi * phi.transpose()
        })
        .collect();
    let mut best = f64::INFINITY;
    for (a, b, c) in (0..26).flat_map(|a| (a..26).flat_map(move |b| (b..26).map(move |c| (a, b, c)))) {
        for d in c..26 {
            let sum = squares[a] + squares[b] + squares[c] + squares[d];
            // none of the best is nearly singular
            if let Some(inverse) = sum.try_inverse().filter(|_| sum.determinant() > 1.0) {
                best = best.min(3e-6 * inverse.trace());
            }
        }
    }
    let problem = PoseProblem {
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(12, 1.0) }),
        allowed: Allowed::Of(list),
        ..problem(KNOWN, 4)
    };
    let design = design_poses(&problem, &DesignSettings::default(), &|_| {}).expect("determined");
    assert!((design.value / best - 1.0).abs() < 1e-9, "{} {best}", design.value);
}

/// Opposite faces give biases and scale factors, each edge one cross-axis sensitivity: nine equations for nine unknowns.
#[test]
fn a_fixture_with_just_enough_directions_is_not_refused() {
    let Allowed::Of(mut list) = Allowed::cube(false, false) else { panic!("a list") };
    let edges = [Vector3::new(1.0, 1.0, 0.0), Vector3::new(1.0, 0.0, 1.0), Vector3::new(0.0, 1.0, 1.0)];
    list.extend(edges.iter().map(Vector3::normalize));
    let problem =
        PoseProblem { allowed: Allowed::Of(list.clone()), ..problem(DirectionKnowledge::Unknown, 9) };
    let design = design_poses(&problem, &DesignSettings::default(), &|_| {}).expect("determined");
    assert!(list.iter().all(|u| design.directions.contains(u)), "{:?}", design.directions);
    let goals = [Goal { parameter: 3, sd: 1.0 }];
    let found = fewest_poses(&problem, &goals, &DesignSettings::default(), &|_| {}).expect("reachable");
    assert_eq!((found.at_least, found.design.directions.len()), (9, 9));
}

/// A vehicle that tilts by 10°, against poses by hand: upright and on the rim.
#[test]
fn small_tilts_are_enough_where_directions_are_known() {
    let tilt = 10.0_f64.to_radians();
    let allowed = Allowed::Near(vec![Vector3::z()], tilt);
    let criterion = Criterion::A(AOptimality { scale: DVector::repeat(12, 1.0) });
    let problem = PoseProblem { allowed, criterion, ..problem(KNOWN, 24) };
    let rim = |k: usize| {
        let (sin, cos) = (k as f64 * std::f64::consts::PI / 8.0).sin_cos();
        Vector3::new(tilt.sin() * cos, tilt.sin() * sin, tilt.cos())
    };
    let by_hand: Vec<_> = (0..16).map(rim).chain([Vector3::z(); 8]).collect();
    let by_hand = evaluate_poses(&problem, &by_hand, 1).expect("determined").value;
    let design = design_poses(&problem, &DesignSettings::default(), &|_| {}).expect("determined");
    assert!(design.value <= by_hand, "{} {by_hand}", design.value);
}

/// One hold with its direction as an explicit unknown, by dense elimination.
#[test]
fn the_information_of_a_hold_is_that_of_an_estimate_with_its_direction_unknown() {
    let at = SensorParameters {
        bias: Vector3::new(0.1, -0.2, 0.3),
        matrix: Matrix3::new(1.02, 0.01, -0.02, 0.0, 0.97, 0.03, 0.0, 0.0, 1.01),
        ..SensorParameters::identity()
    };
    let u = Vector3::new(0.4, -0.7, 0.5).normalize();
    for directions in [DirectionKnowledge::Unknown, DirectionKnowledge::Known { sd_rad: 2e-3 }] {
        let problem = PoseProblem {
            at,
            mean_sd: Vector3::new(1e-3, 2e-3, 3e-3),
            list: Gauge::Upper.parameter_list(SensorModel::Full),
            ..problem(directions, 12)
        };
        let information = HoldInformation::new(&problem).expect("regular");
        let found = information.of_parameters(&information.sum(std::iter::once((&u, 1.0))));
        // the parameters by differences, then two angles of the direction
        let reading = |k: usize, step: f64| {
            let (mut sensor, mut force) = (at, u * problem.gravity_mps2);
            let one = u.cross(&Vector3::x()).normalize();
            match k {
                9 => force = (u * step.cos() + one * step.sin()) * problem.gravity_mps2,
                10 => force = (u * step.cos() + u.cross(&one) * step.sin()) * problem.gravity_mps2,
                _ => problem.list.quantities()[k].add_to(&mut sensor, step),
            }
            sensor.reading(&force).component_div(&problem.mean_sd)
        };
        let jacobian = DMatrix::from_fn(3, 11, |row, k| (reading(k, 1e-5) - reading(k, -1e-5))[row] / 2e-5);
        let mut all = jacobian.tr_mul(&jacobian);
        if let DirectionKnowledge::Known { sd_rad } = directions {
            all[(9, 9)] += sd_rad.powi(-2);
            all[(10, 10)] += sd_rad.powi(-2);
        }
        let (own, cross) = (all.view((0, 0), (9, 9)), all.view((0, 9), (9, 2)));
        let eliminated = all.view((9, 9), (2, 2)).into_owned().try_inverse().expect("regular");
        let expected = own - cross * eliminated * cross.transpose();
        assert!((&found - &expected).amax() < 1e-7 * expected.amax(), "{directions:?}: {found} {expected}");
    }
}

//! Machines of one joint, whose best motion is known from elsewhere.

use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::DOptimality;
use calibrant_core::motion::{Limits, Rest};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, Sensor, SensorKind, SensorModel};
use calibrant_design::{DesignProblem, DesignSettings, design};
use calibrant_machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use calibrant_machine_design::{
    Dwells, JointLimit, TrajectoryCriterion, TrajectoryNoise, TrajectoryProblem, TrajectorySettings,
    design_trajectory,
};
use nalgebra::{DVector, Isometry3, Unit, Vector3};

fn chain(kind: JointKind, axis: Unit<Vector3<f64>>) -> KinematicChain {
    let joint = Joint {
        name: "joint".into(),
        kind,
        axis,
        origin: Isometry3::identity(),
        limits: JointLimits::default(),
    };
    KinematicChain {
        base: "base".into(),
        tip: "tip".into(),
        joints: vec![joint],
        tip_transform: Isometry3::identity(),
    }
}

/// Nothing but the sensor is uncertain.
fn exact() -> MachineSetup {
    MachineSetup {
        tilt_sd_rad: 0.0,
        lever_sd_m: 0.0,
        mounting: MountingPrior::Exact,
        delay_sd_s: 0.0,
        clock_rate_sd: 0.0,
        geometry_translation_sd_m: 0.0,
        geometry_rotation_sd_rad: 0.0,
        zero_sd: 0.0,
        ..MachineSetup::default()
    }
}

fn problem<'a>(
    chain: &'a KinematicChain,
    setup: &'a MachineSetup,
    quantities: &'a [ImuQuantity],
    limit: JointLimit,
) -> TrajectoryProblem<'a> {
    TrajectoryProblem {
        chain,
        setup,
        quantities,
        noise: TrajectoryNoise { force_density: Some(1e-3), rate_density: Some(1e-4), moving: 1.0 },
        cross_axis_sd: [0.0; 2],
        joints: vec![limit],
        force_range_mps2: Vector3::repeat(f64::INFINITY),
        rate_range_radps: Vector3::repeat(f64::INFINITY),
        tip_speed_mps: None,
        sensor_body: None,
        surroundings: None,
        clearance_m: 0.0,
        duration_s: 6.0,
        knot_s: 0.2,
        home: None,
        criterion: TrajectoryCriterion::D,
        dwells: Dwells::None,
    }
}

/// The report's problem: an accelerometer on a linear axis without gravity. The Cartesian design has its own search, another information and a bound.
#[test]
fn a_linear_axis_has_the_cartesian_design() {
    let rate_hz = 100.0;
    let sensor = Sensor {
        axes: 1,
        noise_mps2: Some(Vector3::repeat(1e-3 * f64::sqrt(rate_hz))),
        ..Sensor::triaxial(SensorModel::ScaleBias)
    };
    let limits = Limits {
        acceleration_mps2: Some(Vector3::repeat(2.0)),
        velocity_mps: Some(Vector3::repeat(0.5)),
        rest: Rest::Both,
        ..Limits::default()
    };
    let cartesian = DesignProblem {
        intervals: 30,
        interval_s: 0.2,
        rate_hz,
        criterion: Criterion::D(DOptimality { scale: DVector::repeat(2, 1.0) }),
        ..DesignProblem::new(&sensor, &limits, 6.0).expect("known")
    };
    let settings = DesignSettings { certificate: false, starts: 10, ..DesignSettings::default() };
    let wanted = design(&cartesian, &settings, &|_| {}).expect("feasible").optimal.value;

    let chain = chain(JointKind::Prismatic, Vector3::x_axis());
    let setup = MachineSetup { gravity_mps2: 0.0, ..exact() };
    let of = |quantity| ImuQuantity::Of(SensorKind::Accelerometer, quantity);
    let quantities = [of(Quantity::Bias(Axis::X)), of(Quantity::Scale(Axis::X))];
    let limit = JointLimit {
        lower: -10.0,
        upper: 10.0,
        velocity: 0.5,
        acceleration: 2.0,
        jerk: f64::INFINITY,
        near_ends: None,
    };
    let problem = problem(&chain, &setup, &quantities, limit);
    let found = design_trajectory(&problem, &TrajectorySettings::default()).expect("feasible");
    assert!(found.optimal.is_proved());
    // one of 30 intervals at each end begins and ends without acceleration: less than a fifth of the variance
    let gap = found.optimal.value - wanted;
    assert!((-0.02..0.2).contains(&gap), "{} {wanted}", found.optimal.value);
}

/// A rate table, on a gyroscope along its axis: the best motion is at full speed to and fro. `E q̇² = V² (1 − …)`, and the bound of the strokes is closed form.
#[test]
fn a_rate_table_goes_to_and_fro_at_full_speed() {
    let chain = chain(JointKind::Revolute, Vector3::z_axis());
    let setup = exact();
    let of = |quantity| ImuQuantity::Of(SensorKind::Gyroscope, quantity);
    let quantities = [of(Quantity::Bias(Axis::Z)), of(Quantity::Scale(Axis::Z))];
    let limit = JointLimit {
        lower: -3.0,
        upper: 3.0,
        velocity: 3.0,
        acceleration: 10.0,
        jerk: f64::INFINITY,
        near_ends: None,
    };
    let problem = problem(&chain, &setup, &quantities, limit);
    let found = design_trajectory(&problem, &TrajectorySettings::default()).expect("feasible");
    assert!(found.optimal.is_proved());
    let covariance = found.optimal.covariance.as_ref().expect("determined");
    // strokes of 6 rad take 2.3 s: two of them, and a third of 1.4 s
    let stroke = |range: f64| (range / 3.0 + 0.3, 9.0 * (range - 0.3) / 3.0);
    let [long, short] = [stroke(6.0), stroke(3.3)];
    let square = (2.0 * long.1 + short.1) / 6.0;
    assert!((2.0 * long.0 + short.0 - 6.0).abs() < 1e-12);
    let ideal = 1e-4 / (6.0 * square).sqrt();
    let sd = covariance[(1, 1)].sqrt();
    assert!(sd > 0.98 * ideal && sd < 1.15 * ideal, "{sd} {ideal}");
}

/// A table that turns about one axis tells nothing of the rates about the others: said, not designed.
#[test]
fn what_no_motion_determines_is_named() {
    let chain = chain(JointKind::Revolute, Vector3::z_axis());
    let setup = exact();
    let of = |quantity| ImuQuantity::Of(SensorKind::Gyroscope, quantity);
    let quantities = [of(Quantity::Bias(Axis::X)), of(Quantity::Scale(Axis::X))];
    let limit = JointLimit {
        lower: -3.0,
        upper: 3.0,
        velocity: 3.0,
        acceleration: 10.0,
        jerk: 100.0,
        near_ends: None,
    };
    let problem = problem(&chain, &setup, &quantities, limit);
    let error = design_trajectory(&problem, &TrajectorySettings::default()).expect_err("undetermined");
    assert!(error.is_not_identifiable(), "{error}");
    assert!(error.to_string().contains("gyroscope.scale.x"), "{error}");
    let without = JointLimit { acceleration: f64::INFINITY, ..limit };
    let refused = design_trajectory(
        &TrajectoryProblem { joints: vec![without], ..problem },
        &TrajectorySettings::default(),
    );
    assert!(refused.expect_err("no limit").to_string().contains("joint_limits"));
}

//! Made-up designs: a swinging motion in place of the optimum, evaluated as the solver would.

use super::{design, information, motion, sensor, simulate};
use design::{
    Certificate, Design, DesignProblem, DesignStatus, Evaluation, StartOutcome, Sweep, SweepPoint,
    SweepVariable,
};
use information::criterion::{AOptimality, Criterion};
use motion::{JerkControlledMotion, KnownEnds, Limits, MotionClock, Rest, Trust};
use nalgebra::{DVector, Vector3};
use sensor::{Axis, Sensor, SensorParameters};
use simulate::{Purpose, initial_motion, stream};

/// The thesis's sensor on an arm with limits on everything.
pub(crate) fn arm() -> Limits {
    Limits {
        acceleration_mps2: Some(Vector3::repeat(30.0)),
        jerk_mps3: Some(Vector3::repeat(30.0)),
        velocity_mps: Some(Vector3::new(10.0, 10.0, 5.0)),
        displacement_m: Some(Vector3::repeat(10.0)),
        rest: Rest::Both,
        ..Limits::default()
    }
}

/// The problem D3 of the thesis's sensor.
pub(crate) fn problem<'a>(sensor: &'a Sensor, limits: &'a Limits) -> DesignProblem<'a> {
    let parameters = sensor.parameter_list().len();
    DesignProblem {
        sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust: Trust::Known,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(parameters, 1.0) }),
        prior: None,
    }
}

/// A swing to and fro, `periods` times on each axis, as wide as the limits permit.
pub(crate) fn swing(problem: &DesignProblem<'_>, periods: [f64; 3]) -> Evaluation {
    let axes = problem.sensor.axes;
    let of = |amplitude: &Vector3<f64>| {
        let nodes = (0..=problem.intervals).map(|i| {
            let phase = std::f64::consts::TAU * i as f64 / problem.intervals as f64;
            Vector3::from_fn(|k, _| {
                if k < axes { periods[k].signum() * amplitude[k] * (periods[k] * phase).cos() } else { 0.0 }
            })
        });
        JerkControlledMotion::uniform(problem.interval_s, nodes.collect()).expect("valid motion")
    };
    let mut most = Vector3::repeat(f64::INFINITY);
    let unit = of(&Vector3::repeat(1.0));
    for found in design::limit_use(&problem.effective_limits(), axes, &unit) {
        if found.limit > 0.0 && found.value != 0.0 {
            let k = found.axis.index();
            most[k] = f64::min(most[k], found.limit / found.value.abs());
        }
    }
    design::evaluate(problem, &of(&most)).expect("a valid setting")
}

/// A design of this problem with a certificate and this number of starts.
pub(crate) fn design_of(problem: &DesignProblem<'_>, starts: usize) -> Design {
    let limits = problem.effective_limits();
    let random = initial_motion(10, 1.0, problem.sensor.axes, &limits, &mut stream(1, Purpose::Motion, 0));
    let initial = design::evaluate(problem, &random.expect("valid")).expect("a valid setting");
    let optimal = swing(problem, [1.0, 2.0, 1.0]);
    let sd = optimal.sd();
    let starts = (0..starts)
        .map(|number| {
            let value = optimal.value / 3.0 * (1.0 + [0.0, 0.0, 3e-7, 2.1e-4, 8e-4][number % 5]);
            StartOutcome {
                axes: problem.sensor.active_axes().iter().copied().take(2).collect::<Vec<Axis>>(),
                number,
                initial_value: value * (1.2 + number as f64),
                value,
                iterations: 9 + number % 7,
                status: if number % 11 == 9 { DesignStatus::IterationLimit } else { DesignStatus::Converged },
            }
        })
        .collect();
    Design {
        certificate: Some(Certificate {
            lower_bound: optimal.value * 0.9991,
            gap: 1.0 / 0.9991 - 1.0,
            sd_lower_bound: sd.iter().enumerate().map(|(i, sd)| sd * (1.0 - 0.001 * i as f64)).collect(),
            explanation: "Moment relaxation of order two along the chain of intervals, with velocity and displacement as states; limits \
                          on displacement are imposed at the nodes only, which may make it loose."
                .to_string(),
        }),
        optimal,
        starts,
        iterations: 312,
        status: DesignStatus::Converged,
        gap_goal: None,
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        initial,
        shuttle: Some(swing(problem, [1.0, 1.5, 2.0])),
        limits,
        floor: 0.0,
        floor_sd: Vec::new(),
    }
}

/// Designs over the allowed displacement. One is impossible and one unfinished.
pub(crate) fn sweep(sensor: &Sensor) -> Sweep {
    let asked = [0.1, 0.5, 1.0, 2.0, 5.0, 10.0];
    let points = asked.iter().map(|&asked| {
        let limits = Limits { displacement_m: Some(Vector3::repeat(asked)), ..arm() };
        let problem = problem(sensor, &limits);
        let mut design = design_of(&problem, 3);
        design.optimal = swing(&problem, [2.0; 3]);
        let sd = design.optimal.sd();
        if let Some(certificate) = &mut design.certificate {
            certificate.sd_lower_bound = sd.iter().map(|sd| sd * 0.97).collect();
        }
        if asked == 1.0 {
            design.status = DesignStatus::IterationLimit;
        }
        let outcome = if asked == 0.1 { Err("the limits <clash>".to_string()) } else { Ok(design) };
        SweepPoint { asked, value: asked, intervals: 10, outcome }
    });
    let limits = arm();
    let problem = problem(sensor, &limits);
    Sweep {
        variable: SweepVariable::Displacement,
        criterion: problem.criterion.clone(),
        parameters: sensor.parameter_list().describe(sensor, &problem.at),
        points: points.collect(),
    }
}

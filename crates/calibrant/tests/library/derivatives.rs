//! Tests of the derivatives of every criterion with respect to the motion, against finite differences.

use calibrant::information::criterion::{
    AOptimality, COptimality, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant::information::{Criterion, MotionInformation, covariance};
use calibrant::motion::{InputNoise, JerkControlledMotion, KnownEnds, MotionClock, Trust};
use calibrant::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

fn sensor_like(model: SensorModel) -> SensorParameters {
    let mut at = SensorParameters {
        bias: Vector3::new(0.1, -0.2, 0.05),
        matrix: Matrix3::from_diagonal_element(1.0),
        ..SensorParameters::identity()
    };
    at.matrix[(0, 0)] = 1.1;
    at.matrix[(1, 1)] = 0.9;
    if model == SensorModel::Full {
        at.matrix[(0, 1)] = 0.03;
        at.matrix[(1, 2)] = -0.02;
        at.matrix[(2, 0)] = 0.05;
    }
    at
}

fn nodes() -> Vec<Vector3<f64>> {
    (0..7_u32)
        .map(|i| {
            let t = f64::from(i);
            Vector3::new((1.3 * t).sin() * 5.0 + 1.0, (0.7 * t + 1.0).cos() * 7.0, (2.1 * t).sin() * 4.0 - t)
        })
        .collect()
}

fn motion(nodes: &[Vector3<f64>]) -> JerkControlledMotion {
    JerkControlledMotion::new(vec![0.0, 1.0, 1.7, 2.7, 3.2, 4.2, 5.0], nodes.to_vec()).expect("valid")
}

fn criteria(size: usize, model: SensorModel) -> Vec<Criterion> {
    let scale = DVector::from_fn(size, |i, _| 0.5 + 0.1 * (i * i % 7) as f64);
    let list = Sensor::triaxial(model).parameter_list();
    vec![
        Criterion::A(AOptimality { scale: scale.clone() }),
        Criterion::D(DOptimality { scale: scale.clone() }),
        Criterion::E(EOptimality { scale: scale.clone() }),
        Criterion::M(MOptimality { scale: scale.clone() }),
        Criterion::C(COptimality { weights: DVector::from_fn(size, |i, _| (i % 3) as f64) }),
        Criterion::I(IOptimality::new(&list, &sensor_like(model), 20.0).expect("regular")),
    ]
}

fn settings() -> Vec<MotionInformation> {
    let noise = InputNoise { floor_mps3: 0.02, ratio: 0.05 };
    let mut settings = Vec::new();
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        for (trust, ends) in [
            (Trust::Known, KnownEnds::Start),
            (Trust::Noisy(noise), KnownEnds::Start),
            (Trust::Noisy(noise), KnownEnds::Both),
            (Trust::Noisy(InputNoise { floor_mps3: 0.0, ratio: 0.05 }), KnownEnds::Start),
            (Trust::Unknown, KnownEnds::Both),
        ] {
            let sensor =
                Sensor { noise_mps2: Some(Vector3::new(0.01, 0.02, 0.03)), ..Sensor::triaxial(model) };
            settings
                .push(MotionInformation::new(&sensor, sensor_like(model), trust, ends, 9.7).expect("valid"));
        }
    }
    // axes that share no parameter share the clock, which is beyond these derivatives
    let clock = MotionClock { delay_s: 0.0, delay_sd_s: 1e-3, rate_sd: 1e-4 };
    let full = settings.iter().filter(|of| of.model == SensorModel::Full && of.trust != Trust::Unknown);
    let with_clock: Vec<_> = full.map(|of| MotionInformation { clock, ..of.clone() }).collect();
    settings.extend(with_clock);
    settings
}

/// Sixth-order central difference.
fn difference(f: &dyn Fn(f64) -> f64, h: f64) -> f64 {
    (45.0 * (f(h) - f(-h)) - 9.0 * (f(2.0 * h) - f(-2.0 * h)) + f(3.0 * h) - f(-3.0 * h)) / (60.0 * h)
}

/// Prior information, where the data alone leave the parameters undetermined (full model, unknown motion).
fn prior(setting: &MotionInformation) -> DMatrix<f64> {
    let size = if setting.model == SensorModel::Full { 12 } else { 6 };
    let strength = if setting.trust == Trust::Unknown && size == 12 { 5e3 } else { 0.0 };
    DMatrix::from_diagonal_element(size, size, strength)
}

#[test]
fn every_criterion_has_the_derivative_of_finite_differences_for_every_trust_and_model() {
    let mut checked = 0;
    for setting in settings() {
        let prior = prior(&setting);
        let value = |criterion: &Criterion, nodes: &[Vector3<f64>]| {
            let information = setting.information(&motion(nodes)).expect("determined") + &prior;
            criterion.value(&covariance(&information).expect("regular"))
        };
        let at = nodes();
        let information = setting.information(&motion(&at)).expect("determined") + &prior;
        let c = covariance(&information).expect("regular");
        for criterion in criteria(prior.nrows(), setting.model) {
            // dΦ = −⟨C (∂Φ/∂C) C, dF⟩
            let omega = &c * criterion.derivative(&c) * &c;
            let gradient = setting.derivative(&motion(&at), &omega).expect("determined");
            let scale = gradient.iter().map(Vector3::amax).fold(0.0, f64::max);
            for node in 0..at.len() {
                for axis in 0..3 {
                    let along = |step: f64| {
                        let mut moved = at.clone();
                        moved[node][axis] += step;
                        value(&criterion, &moved)
                    };
                    let expected = difference(&along, 1e-3);
                    let got = -gradient[node][axis];
                    assert!(
                        (got - expected).abs() <= 1e-7 * scale,
                        "{} {:?} {:?}: node {node} axis {axis}: {got} but {expected}, scale {scale}",
                        criterion.letter(),
                        setting.trust,
                        setting.model
                    );
                    checked += 1;
                }
            }
        }
    }
    assert_eq!(checked, 14 * 6 * 7 * 3);
}

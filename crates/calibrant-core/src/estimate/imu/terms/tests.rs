//! Every term's derivatives against differences of its residual, and the sums against the terms one by one.

use super::list::TERMS;
use super::sums::{chi2, degrees_of_freedom, normal_equations};
use super::term::{At, Place, Term};
use crate::estimate::imu::earth_rate::EarthRate;
use crate::estimate::imu::model::{
    GyroscopeNoise, HoldData, ImuModel, LocalBias, RotationData, RotationScatter, Samples, State, TurnData,
};
use crate::estimate::imu::rotations::gravity_at_ends::TurnsInHolds;
use crate::estimate::imu::rotations::knocks::Knocks;
use crate::estimate::tangent_plane::tangents;
use crate::sensor::entry_vector::ENTRIES;
use crate::sensor::{
    Axis, ImuParameters, ImuQuantity, NonlinearTerm, Quantity, SensorKind, SensorParameters, Thermal,
};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector2, Vector3};

const GRAVITY: f64 = 9.81;
const TEMPERATURES_C: [f64; 3] = [18.0, 24.0, 31.0];

/// Three holds with two rotations between them.
struct Simulated {
    times_s: Vec<f64>,
    forces: Vec<Vector3<f64>>,
    /// Of each rotation: the rates, and the forces with them.
    samples: Vec<[Vec<Vector3<f64>>; 2]>,
    imu: ImuParameters,
}

fn imu() -> ImuParameters {
    let mut thermal = Thermal::none();
    thermal.reference_c = 23.0;
    thermal[SensorKind::Accelerometer].scale[0] = Vector3::new(1e-4, -2e-4, 3e-4);
    thermal[SensorKind::Gyroscope].bias[0] = Vector3::new(1e-4, 2e-4, -1e-4);
    thermal[SensorKind::Gyroscope].scale[1] = Vector3::new(1e-6, -2e-6, 1e-6);
    let mut accelerometer = SensorParameters {
        bias: Vector3::new(0.1, -0.2, 0.3),
        matrix: Matrix3::new(1.02, 0.01, 0.0, 0.02, 0.98, -0.01, 0.01, 0.0, 1.01),
        ..SensorParameters::identity()
    };
    Quantity::Nonlinear(NonlinearTerm::SecondOrder, Axis::Y).add_to(&mut accelerometer, 1e-4);
    ImuParameters {
        sensors: [
            accelerometer,
            SensorParameters {
                bias: Vector3::new(0.02, -0.03, 0.01),
                matrix: Matrix3::new(1.05, 0.02, -0.01, 0.03, 0.97, 0.02, -0.02, 0.01, 1.02),
                ..SensorParameters::identity()
            },
        ]
        .into(),
        g_sensitivity: Matrix3::new(1.0, 0.5, -0.3, 0.2, -0.8, 0.1, 0.4, 0.3, 0.6) * 1e-3,
        thermal,
    }
}

/// All quantities but two entries of `Γ`.
fn quantities() -> Vec<ImuQuantity> {
    let mut all = ImuQuantity::full_list(true, true, true);
    all.truncate(all.len() - 2);
    all.extend(ImuQuantity::all_thermal(true, true));
    let bent = NonlinearTerm::ALL.into_iter().flat_map(|term| Axis::ALL.map(|axis| (term, axis)));
    all.extend(
        bent.map(|(term, axis)| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Nonlinear(term, axis))),
    );
    all
}

impl Simulated {
    fn new() -> Self {
        let (duration_s, imu) = (2.0, imu());
        let times_s: Vec<f64> = (0..=400).map(|k| duration_s * f64::from(k) / 400.0).collect();
        let mut forces = vec![Vector3::new(2.0, -3.0, 9.0).normalize() * GRAVITY];
        let mut samples = Vec::new();
        let turns = [Vector3::new(1.5, 0.6, -0.4), Vector3::new(-0.5, 1.2, 0.9)];
        for (turn, temperatures_c) in turns.into_iter().zip(TEMPERATURES_C.array_windows::<2>()) {
            let start = forces[forces.len() - 1];
            let biases = temperatures_c.map(|celsius| imu.at(celsius)[SensorKind::Gyroscope].bias);
            let matrix = imu.at(0.5 * (temperatures_c[0] + temperatures_c[1]))[SensorKind::Gyroscope].matrix;
            let turned = |t: f64| {
                let full = std::f64::consts::TAU;
                t / duration_s - (full * t / duration_s).sin() / full
            };
            let speed = |t: f64| (1.0 - (std::f64::consts::TAU * t / duration_s).cos()) / duration_s;
            let felt: Vec<Vector3<f64>> =
                times_s.iter().map(|t| Rotation3::new(-turn * turned(*t)) * start).collect();
            let readings = times_s.iter().zip(&felt);
            let readings = readings.map(|(t, force)| {
                let bias = biases[0].lerp(&biases[1], t / duration_s);
                bias + matrix * turn * speed(*t) + imu.g_sensitivity * force
            });
            samples.push([readings.collect(), felt]);
            // the two numbers of a residual turn with the direction after it, which derivatives leave out: it is small
            forces.push(Rotation3::new(-turn + Vector3::new(1e-5, -2e-5, 3e-5)) * start);
        }
        Self { times_s, forces, samples, imu }
    }

    /// What the gyroscope reads in a hold.
    fn at_rest(&self, hold: usize, earth: &EarthRate) -> Vector3<f64> {
        let (imu, force) = (self.imu.at(TEMPERATURES_C[hold]), &self.forces[hold]);
        imu[SensorKind::Gyroscope].reading(&earth.rate(hold, force)) + imu.g_sensitivity * force
    }

    fn state(&self) -> State {
        State { imu: self.imu, forces: self.forces.clone() }
    }

    fn model(&self) -> ImuModel<'_> {
        let quantities = quantities();
        let mut fixed = Matrix3::repeat(1.0);
        for quantity in &quantities {
            if let ImuQuantity::GSensitivity(row, column) = quantity {
                fixed[(row.index(), column.index())] = 0.0;
            }
        }
        let earth = EarthRate {
            vertical_sd: Some(4e-5),
            fixed,
            unknowns: DVector::from_vec(vec![0.4, 0.5, -0.6]),
            seen: self.forces.iter().map(|force| (0, tangents(force))).collect(),
            ..EarthRate::at_place(1e-6, 5e-5, GRAVITY)
        };
        let hold = |(force, temperature_c): (&Vector3<f64>, f64)| HoldData {
            accelerometer: force + Vector3::new(0.02, 0.01, -0.03),
            accelerometer_weight: Matrix3::new(9e4, 1e4, 0.0, 1e4, 8e4, -1e4, 0.0, -1e4, 7e4),
            gyroscope: Some((Vector3::new(0.03, -0.02, 0.02), Vector3::new(1e8, 2e8, 3e8))),
            known: None,
            temperature_c,
        };
        let drift = |hold: usize| LocalBias {
            mean: self.at_rest(hold, &earth) + Vector3::new(1e-5, -2e-5, 1e-5),
            force: self.forces[hold],
            rate: earth.rate(hold, &self.forces[hold]),
            share: Vector3::new(0.3, 0.5, 0.8),
            variance: Vector3::repeat(1e-12),
            temperature_c: TEMPERATURES_C[hold],
        };
        let rotation = |from: usize| RotationData {
            from,
            samples: Samples {
                times_s: &self.times_s,
                readings: &self.samples[from][0],
                forces: Some(&self.samples[from][1]),
                drift: [drift(from), drift(from + 1)],
            },
            knocks: Knocks::default(),
            beside_means: [Vector3::zeros(); 2],
            used: true,
            counts: true,
        };
        let turn = TurnData {
            integral: Vector3::new(0.1, 6.4, -0.2),
            duration_s: 4.0,
            force: Vector3::new(2.0, 38.0, 1.0),
            angle: Vector3::new(0.0, std::f64::consts::TAU, 0.0),
            weight: Vector3::new(1e4, 2e4, 1e4),
            temperature_c: 27.0,
        };
        let prior = quantities.iter().enumerate().map(|(k, of)| (of.value(&self.imu) + 1e-3, 1e6 + k as f64));
        ImuModel {
            gravity: GRAVITY,
            holds: self.forces.iter().zip(TEMPERATURES_C).map(hold).collect(),
            rotations: (0..self.samples.len()).map(rotation).collect(),
            turns: vec![turn],
            gyroscope_noise: GyroscopeNoise { of_sample: Vector3::repeat(1e-4), of_mean: Vector3::zeros() },
            rotation_scatter: RotationScatter { between_sd_rad: 1e-3, ..RotationScatter::none() },
            turns_in_holds: TurnsInHolds::default(),
            prior: Some(prior.unzip()),
            earth,
            quantities,
        }
    }
}

fn residual(term: &dyn Term, k: usize, model: &ImuModel<'_>, state: &State) -> Vector3<f64> {
    let rotations = model.gravity_residuals(state).expect("regular");
    term.residual(&At { model, state, rotations: &rotations }, k).expect("it counts").r
}

/// Derivative of what is expected, by central differences. `moved`: the problem after a step.
fn difference<'a>(
    (term, k): (&dyn Term, usize),
    step: f64,
    moved: impl Fn(f64) -> (ImuModel<'a>, State),
) -> Vector3<f64> {
    let at = |step: f64| {
        let (model, state) = moved(step);
        residual(term, k, &model, &state)
    };
    (at(-step) - at(step)) / (2.0 * step)
}

fn turned(state: &State, hold: usize, by: &Vector2<f64>) -> State {
    let mut state = state.clone();
    let force = &mut state.forces[hold];
    *force = (*force + tangents(force) * by * GRAVITY).normalize() * GRAVITY;
    state
}

/// One unknown of the Earth's rate, where `Γ` with what looks like it stays.
fn with_earth<'a>(model: &ImuModel<'a>, state: &State, unknown: usize, step: f64) -> (ImuModel<'a>, State) {
    let (mut model, mut state) = (model.clone(), state.clone());
    if unknown == 0 {
        for quantity in &model.quantities {
            let taken = model.earth.taken_off(*quantity, &state.imu);
            quantity.add_to(&mut state.imu, -taken * step);
        }
    }
    model.earth.step((0..3).map(|k| if k == unknown { step } else { 0.0 }));
    for rotation in &mut model.rotations {
        for (end, hold) in rotation.samples.drift.iter_mut().zip(rotation.from..) {
            end.rate = model.earth.rate(hold, &state.forces[hold]);
        }
    }
    (model, state)
}

#[test]
fn derivatives_are_those_of_the_residuals() {
    let simulated = Simulated::new();
    let (model, state) = (simulated.model(), simulated.state());
    let rotations = model.gravity_residuals(&state).expect("regular");
    let at = At { model: &model, state: &state, rotations: &rotations };
    let mut wrong = Vec::new();
    for term in TERMS {
        assert!(term.count(&model) > 0, "{term:?}");
        // a rotation's are exact to second order in the sample step, (5 ms · 1.5 rad/s)², and for small residuals, here 1e-4 rad
        let exact = if term.place() == Place::BetweenHolds { 3e-4 } else { 1e-7 };
        for k in 0..term.count(&model) {
            let of = term.derivatives(&at, k);
            let mut compare = |name: &str, found: Vector3<f64>, expected: Vector3<f64>, most: f64| {
                let off = (found - expected).amax();
                if off.is_nan() || off > most {
                    wrong.push(format!(
                        "{term:?} {k} {name}: {found:?} expected {expected:?} within {most:e}"
                    ));
                }
            };
            for (place, quantity) in model.quantities.iter().enumerate() {
                let moved = |step: f64| {
                    let mut state = state.clone();
                    quantity.add_to(&mut state.imu, step);
                    (model.clone(), state)
                };
                // up to 8 K from the reference
                let order = if let ImuQuantity::Thermal(_, term) = quantity { term.order as i32 } else { 1 };
                let expected = difference((term, k), 1e-4 / 8f64.powi(order - 1), moved);
                // a high power is less linear over a rotation
                let most = exact * f64::from(order * order) * expected.norm().max(1e-2);
                compare(&quantity.name(), of.by_quantities.column(place).into(), expected, most);
            }
            for hold in 0..model.holds.len() {
                let seen = match term.place() {
                    Place::Hold => [None, Some(k)],
                    Place::BetweenHolds => [Some(k), Some(k + 1)],
                    Place::Alone => [None, None],
                };
                for side in 0..2 {
                    let moved = |step: f64| (model.clone(), turned(&state, hold, &Vector2::ith(side, step)));
                    let expected = difference((term, k), 1e-5, moved);
                    let end = seen.iter().position(|seen| *seen == Some(hold));
                    let by = end.and_then(|end| of.by_directions[end]);
                    let found = by.map_or_else(Vector3::zeros, |by| by.column(side).into());
                    let most = exact * expected.norm().max(1e-2);
                    compare(&format!("direction {hold}"), found, expected, most);
                }
            }
            let by_earth = term.by_earth(&at, k);
            for unknown in 0..3 {
                let expected = difference((term, k), 1e-2, |step| with_earth(&model, &state, unknown, step));
                // `Γ` takes up the rate with the gain at the reference temperature, which differs by 1e-4; 8e-5 rad is what the Earth turns
                let most = 3e-4 * expected.norm().max(8e-5);
                compare(&format!("earth {unknown}"), by_earth.column(unknown).into(), expected, most);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Dense least squares over directions and quantities, from residuals and differences alone.
#[test]
fn the_normal_equations_are_those_of_dense_least_squares() {
    let simulated = Simulated::new();
    let mut model = simulated.model();
    // one direction is known
    let state = simulated.state();
    model.holds[1].known = Some(state.forces[1]);
    let rotations = model.gravity_residuals(&state).expect("regular");
    let at = At { model: &model, state: &state, rotations: &rotations };
    let size = model.quantities.len();
    let (free, columns) = ([0, 2], size + 4);
    let (mut f, mut g, mut square) = (DMatrix::zeros(columns, columns), DVector::zeros(columns), 0.0);
    let mut rows = 0;
    for term in TERMS {
        for k in 0..term.count(&model) {
            let one = term.residual(&at, k).expect("it counts");
            let of = term.derivatives(&at, k);
            let mut j = DMatrix::zeros(3, columns);
            j.columns_mut(0, size).copy_from(&of.by_quantities.columns(0, size));
            for (place, hold) in free.into_iter().enumerate() {
                let end = match term.place() {
                    Place::Hold => (hold == k).then_some(1),
                    Place::BetweenHolds => [k, k + 1].iter().position(|seen| *seen == hold),
                    Place::Alone => None,
                };
                if let Some(by) = end.and_then(|end| of.by_directions[end]) {
                    j.columns_mut(size + 2 * place, 2).copy_from(&by);
                }
            }
            let w = one.weight.matrix();
            f += j.transpose() * w * &j;
            g += j.transpose() * w * one.r;
            square += (one.r.transpose() * w * one.r)[0];
            rows += term.rows();
        }
    }
    assert!((chi2(&at) / square - 1.0).abs() < 1e-12);
    assert_eq!(degrees_of_freedom(&at), rows - columns);
    // units of different sizes
    let scale = f.diagonal().map(|f| f.sqrt().recip());
    let scaled = DMatrix::from_fn(columns, columns, |i, j| f[(i, j)] * scale[i] * scale[j]);
    let covariance = scaled.cholesky().expect("determined").inverse();
    let dense = (&covariance * g.component_mul(&scale)).component_mul(&scale);
    let (system, unreduced) = normal_equations::<ENTRIES>(&at).expect("determined");
    let step = system.border_step(0.0).expect("determined");
    for k in 0..size {
        let sd = scale[k] * covariance[(k, k)].sqrt();
        assert!((step[k] - dense[k]).abs() < 1e-6 * sd, "{k}: {} {} ± {sd}", step[k], dense[k]);
        assert!((unreduced[k] / f[(k, k)] - 1.0).abs() < 1e-12, "{k}");
    }
}

//! Does what carries the sensor give way? A gain is then wrong by the same amount in every part of the recording: folds agree, and so does the scatter of blocks.
//!
//! Small motions of the sensor against what is logged are tried as terms of the model, which are 0 where the mount is rigid:
//!
//! ```text
//! soft mount:   d = −C f,   φ = −K ω̇       (displacement, turn; diagonal, entries 1/ω₀², frequencies below that of the mount)
//! bending:      d = b |ω|²,  φ = β |ω|²
//! the sensor reads f + Rᵀ d²(R d)/dt² − φ × f  and  w + φ̇ + ω × φ
//! ```
//!
//! With them on the border of the normal equations, motion and all parameters eliminated, one Gauss–Newton step estimates them. Each block of time has its
//! influence `J⁻¹ g_b`, whose scatter gives the covariance (`newey1987`): errors of a tracker that are correlated in time do not count as a mount. Wald's statistic
//! follows Fisher's F (`hotelling1931`).
//!
//! Terms `θ` move the parameters by `M θ`. So what a mount may have done unseen has the second moment `M (C_θ ν/(ν − 2) + θ θᵀ) Mᵀ`, with the `ν` degrees of
//! freedom of the scatter.

use crate::estimate::least_squares::{Block, Front, Minimum, Model, Pass, Scaled, State, huber};
use crate::estimate::{MachineCalibration, MachineQuantity};
use calibrant_core::diagnostic::Phrase;
use calibrant_core::diagnostic::machine::MountGivesWay;
use calibrant_core::sensor::SensorKind;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3, Vector6};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Terms that are tried together, one for each axis, and what the residuals then follow.
const FAMILIES: [&str; 4] = [
    "the specific force, as of a sensor on something soft",
    "the angular acceleration, as of a sensor on something soft",
    "the square of the angular rate, as of a sensor that is displaced where what carries it bends",
    "the square of the angular rate, as of a sensor that is turned where what carries it bends",
];
const TERMS: usize = 3 * FAMILIES.len();
/// Blocks of time at most, and the least length of one, s: an error of a tracker lasts about so long.
const BLOCKS: usize = 60;
const SHORTEST_S: f64 = 0.5;
/// Residuals of this probability are no chance.
const NO_CHANCE: f64 = 1e-4;
/// Fewest blocks that tell the terms.
const FEWEST: f64 = 3.5;
/// What moves no parameter by more than this many of its standard deviations is covered by them.
const COVERED: f64 = 1.0;

/// What the residuals say of the mount.
pub(crate) struct Flexure {
    /// It gives way: what the residuals follow, the most certain alone.
    pub(crate) found: Option<MountGivesWay>,
    /// What it may do to the parameters unseen, as a covariance. `None` where too few blocks of time tell it.
    pub(crate) unseen: Option<DMatrix<f64>>,
}

/// Tries the terms.
pub(crate) fn find(model: &Model<'_>, minimum: &Minimum, calibration: &MachineCalibration) -> Flexure {
    let blocks = blocks(model, &minimum.state);
    let own = model.layout.len();
    let mut found: Option<MountGivesWay> = None;
    let mut unseen = Some(DMatrix::zeros(own, own));
    for (family, how) in FAMILIES.into_iter().enumerate() {
        let trial = Trial::of(model, &minimum.state, &blocks, 3 * family);
        let Some((trial, (parameter, deviations))) =
            trial.and_then(|trial| trial.moves(calibration).map(|moved| (trial, moved)))
        else {
            unseen = None;
            continue;
        };
        let is_more_certain = found.as_ref().is_none_or(|before| trial.p_value < before.p_value);
        if trial.p_value < NO_CHANCE && deviations > COVERED && is_more_certain {
            let how = Phrase(how.to_owned());
            found = Some(MountGivesWay { how, parameter, deviations, p_value: trial.p_value });
        }
        unseen = unseen.map(|sum| sum + trial.unseen);
    }
    Flexure { found, unseen }
}

/// A family of terms, estimated with everything else.
struct Trial {
    /// The step of the parameters.
    step: DVector<f64>,
    p_value: f64,
    /// Second moment of what the terms do to the parameters.
    unseen: DMatrix<f64>,
}

impl Trial {
    /// `first`: the first of its terms.
    fn of(model: &Model<'_>, state: &State, blocks: &[Block], first: usize) -> Option<Self> {
        let own = model.layout.len();
        let places: Vec<usize> = (0..own).chain((0..3).map(|axis| own + first + axis)).collect();
        let number = blocks.len() as f64;
        let part = |of: &Block| Block {
            score: of.score.select_rows(&places),
            information: of.information.select_columns(&places).select_rows(&places),
        };
        let blocks: Vec<Block> = blocks.iter().map(part).collect();
        let (first, others) = blocks.split_first()?;
        let mut whole = others.iter().fold(first.clone(), Block::with);
        let deviation = model.layout.deviation(&state.parameters);
        let mut corner = whole.information.view_mut((0, 0), (own, own));
        corner += &model.layout.prior;
        let mut head = whole.score.rows_mut(0, own);
        head -= &model.layout.prior * &deviation;
        let all = Scaled::new(&whole.information)?;
        let (step, inverse) = (all.solve(&whole.score), all.inverse());
        let estimate = step.rows(own, 3).into_owned();
        let mut covariance = DMatrix::zeros(3, 3);
        let mut shares = [(0.0, 0.0); 3];
        for block in &blocks {
            let left = &block.score - &block.information * &step;
            let without = Scaled::new(&(&whole.information - &block.information))?;
            let moved = without.solve(&left).rows(own, 3).into_owned();
            covariance += &moved * moved.transpose() * ((number - 1.0) / number);
            let part = inverse.rows(own, 3) * &block.information * inverse.columns(own, 3);
            for (k, share) in shares.iter_mut().enumerate() {
                *share = (share.0 + part[(k, k)], share.1 + part[(k, k)].powi(2));
            }
        }
        // blocks that tell the terms, and the degrees of freedom of their scatter
        let told = shares.iter().map(|(sum, squares)| sum * sum / squares).fold(number, f64::min);
        if told < FEWEST {
            return None;
        }
        let squares = estimate.dot(&Scaled::new(&covariance)?.solve(&estimate));
        let ratio = squares * (told - 3.0) / (3.0 * (told - 1.0));
        let p_value = FisherSnedecor::new(3.0, told - 3.0).ok()?.sf(ratio);
        let alone = Scaled::new(&whole.information.view((0, 0), (own, own)).into_owned())?;
        let solved = |axis: usize| {
            alone.solve(&whole.information.view((0, own + axis), (own, 1)).column(0).into_owned())
        };
        let effect = DMatrix::from_columns(&[solved(0), solved(1), solved(2)]);
        // so few blocks tell the covariance no better than Student's distribution has it
        let covariance = covariance * ((told - 1.0) / (told - 3.0));
        let unseen = &effect * (covariance + &estimate * estimate.transpose()) * effect.transpose();
        ratio.is_finite().then(|| Self { step: step.rows(0, own).into_owned(), p_value, unseen })
    }

    /// The parameter of a sensor that the terms move most, and by how many of its standard deviations.
    fn moves(&self, calibration: &MachineCalibration) -> Option<(String, f64)> {
        let sd = calibration.sd();
        let of_sensor = |k: &usize| matches!(calibration.quantities[*k], MachineQuantity::Imu(_));
        let moved = |k: usize| (k, (self.step[k] / sd[k]).abs());
        let most =
            (0..sd.len()).filter(of_sensor).map(moved).max_by(|one, other| one.1.total_cmp(&other.1))?;
        most.1.is_finite().then(|| (calibration.names().swap_remove(most.0), most.1))
    }
}

/// The blocks of time of the normal equations with all terms behind the parameters.
fn blocks(model: &Model<'_>, state: &State) -> Vec<Block> {
    let pass = Pass::all(model.trust);
    let (places, knots, unknowns) = (model.places(state), state.motion.knots(), state.motion.unknowns());
    let order = if pass.noisy() { knots.degree.order() } else { 0 };
    let border = model.layout.len() + TERMS;
    let mut front = Front::new(unknowns, order, border);
    let residuals: Vec<_> = (0..model.streams.len()).map(|s| model.residuals(state, s, pass)).collect();
    let mut next = vec![0; residuals.len()];
    let carrier = model.carrier(state);
    let step_s = knots.step_s;
    let mut joints = Default::default();
    let mut terms_at = |time_s: f64| {
        let mut at = |time_s: f64| {
            let felt = state.motion.sensor(&knots.weights(time_s), &carrier, &mut joints);
            [felt.specific_force, felt.rate, felt.angular_acceleration]
        };
        terms(&[at(time_s - step_s), at(time_s), at(time_s + step_s)], step_s)
    };
    let length_s = ((knots.end_s() - knots.start_s) / BLOCKS as f64).max(SHORTEST_S);
    let (mut end_s, mut before, mut blocks) = (knots.start_s + length_s, front.border(), Vec::new());
    for group in model.groups(state, pass) {
        let rows = model.rows(&group, state, &places, pass);
        let (own, samples) = (rows.length - 1, rows.streams.len());
        let mut columns = DMatrix::zeros(rows.length + TERMS, 3 * samples);
        columns.rows_mut(0, own).copy_from(&rows.as_columns().rows(0, own));
        columns.row_mut(own + TERMS).copy_from(&rows.as_columns().row(own));
        for (n, &s) in rows.streams.iter().enumerate() {
            let Some(residual) = residuals[s].get(next[s]) else { continue };
            next[s] += 1;
            let (stream, imu) = (&model.streams[s], &state.parameters.imu);
            let sd = stream.sd_of(residual.sample);
            for (k, term) in terms_at(residual.time_s).iter().enumerate() {
                let (force, rate) = (term.fixed_rows::<3>(0), term.fixed_rows::<3>(3));
                let change = match stream.sensor {
                    SensorKind::Accelerometer => imu[SensorKind::Accelerometer].matrix * force,
                    SensorKind::Gyroscope => {
                        imu[SensorKind::Gyroscope].matrix * rate + imu.g_sensitivity * force
                    }
                };
                for axis in 0..3 {
                    let (weight, _) = huber(residual.value[axis] / sd[axis]);
                    columns[(own + k, 3 * n + axis)] = weight / sd[axis] * change[axis];
                }
            }
        }
        let mut equations = &columns * columns.transpose();
        if pass.noisy() {
            model.log.add(places.of_log(&group), &state.motion, &mut equations);
        }
        front.add(&equations);
        if knots.knot_s(group.end) >= end_s || group.end == knots.intervals {
            let now = front.border();
            let (score, information) = (&now.score - &before.score, &now.information - &before.information);
            if score.amax() > 0.0 {
                blocks.push(Block { score, information });
            }
            (end_s, before) = (knots.knot_s(group.end) + length_s, now);
        }
    }
    blocks
}

/// What the terms add to specific force and rate. `at`: force, rate and angular acceleration before, at and after the sample.
fn terms(at: &[[Vector3<f64>; 3]; 3], step_s: f64) -> [Vector6<f64>; TERMS] {
    let [f, w, wd] = at[1];
    let first = |of: usize| (at[2][of] - at[0][of]) / (2.0 * step_s);
    let second = |of: &dyn Fn(usize) -> Vector3<f64>| (of(2) - of(1) * 2.0 + of(0)) / (step_s * step_s);
    let turn = w.cross_matrix();
    let gradient = wd.cross_matrix() + turn * turn;
    let displaced = |d: Vector3<f64>, rate: Vector3<f64>, acceleration: Vector3<f64>| {
        acceleration + turn * rate * 2.0 + gradient * d
    };
    let both = |force: Vector3<f64>, rate: Vector3<f64>| {
        Vector6::new(force.x, force.y, force.z, rate.x, rate.y, rate.z)
    };
    let turned = |phi: Vector3<f64>, rate: Vector3<f64>| both(-phi.cross(&f), rate + w.cross(&phi));
    let square = |k: usize| Vector3::repeat(at[k][1].norm_squared());
    let (u, u_rate, u_second) = (square(1).x, 2.0 * w.dot(&wd), second(&square).x);
    let axes = Matrix3::identity();
    std::array::from_fn(|term| {
        let e: Vector3<f64> = axes.column(term % 3).into_owned();
        let along = |of: Vector3<f64>| e * e.dot(&of);
        match term / 3 {
            0 => both(-displaced(along(f), along(first(0)), along(second(&|k| at[k][0]))), Vector3::zeros()),
            1 => turned(-along(wd), -along(first(2))),
            2 => both(displaced(e * u, e * u_rate, e * u_second), Vector3::zeros()),
            _ => turned(e * u, e * u_rate),
        }
    })
}

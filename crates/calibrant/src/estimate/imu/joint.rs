//! The one least-squares problem of a whole IMU, for given weights: Gauss–Newton on directions and parameters.
//!
//! The unknown directions `f_j` of the holds are a chain whose links are the rotations between them, with the parameters as the border: the arrowhead
//! again. Residuals:
//!
//! | of | residual | unknowns |
//! |---|---|---|
//! | a hold, accelerometer | `ȳ_a − S_a f_j − b_a` | `f_j`, accelerometer |
//! | a hold, gyroscope | `ȳ_g − b_g − Γ f_j − S_g ω_j` | `f_j`, gyroscope |
//! | a rotation | the arc from `f_k` to `Rᵀ (f_i + T ω_i × f_i)`: 2 numbers | `f_i`, `f_k`, gyroscope |
//! | a turn of known angle | `∫ (y_g − b_g − Γ f − S_g κ f) dt − S_g φ e` | gyroscope |
//!
//! `S` and `b` are those at the temperature of the hold, the rotation or the turn. `ω_j = κ f_j + E_j h` is the Earth's rate ([`Earth`]), which is held fixed here and settled beside the weights; `T` is the
//! duration of the rotation.

use super::arc::Arc;
use super::earth::Earth;
use super::rates::Samples;
use super::rotation::Rotation;
use super::still::StillNoise;
use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::estimate::tangents::tangents;
use crate::estimate::{CalibrationSettings, CalibrationStatus};
use crate::sensor::entries::{AT_REFERENCE, ENTRIES};
use crate::sensor::{Condition, ImuParameters, ImuQuantity, Triad};
use nalgebra::{
    DMatrix, DVector, Matrix2, Matrix2x3, Matrix2xX, Matrix3, SMatrix, SVector, Vector2, Vector3,
};

/// A step this short, in standard deviations, needs no test: the derivatives of a rotation are exact to second order in the sample step only, so that the last steps
/// may not lower χ².
const CLOSE: f64 = 0.1;

/// A hold with its weights.
#[derive(Debug, Clone)]
pub(super) struct HoldData {
    pub(super) accelerometer: Vector3<f64>,
    /// Inverse covariance of the mean.
    pub(super) accelerometer_weight: Matrix3<f64>,
    /// Mean reading of the gyroscope and its inverse variances.
    pub(super) gyroscope: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Specific force, where its direction is known.
    pub(super) known: Option<Vector3<f64>>,
    pub(super) temperature_c: f64,
}

/// A rotation from one hold to the next one used.
#[derive(Clone)]
pub(super) struct RotationData<'a> {
    /// Place among the holds of the one it begins with.
    pub(super) from: usize,
    pub(super) samples: Samples<'a>,
    /// Can it be integrated?
    pub(super) used: bool,
    /// Does it count, or is it an outlier?
    pub(super) counts: bool,
}

/// A turn of known angle about an axis that is fixed in the sensor.
#[derive(Debug, Clone)]
pub(super) struct TurnData {
    /// `∫ y_g dt` and the duration.
    pub(super) integral: Vector3<f64>,
    pub(super) duration_s: f64,
    /// `∫ f dt`.
    pub(super) force: Vector3<f64>,
    /// `φ e`, rad.
    pub(super) angle: Vector3<f64>,
    /// Inverse variances of the integral.
    pub(super) weight: Vector3<f64>,
    pub(super) temperature_c: f64,
}

impl TurnData {
    /// What the gyroscope of an IMU adds up to beyond its bias, in the unit of its readings times s.
    pub(super) fn beyond_bias(&self, imu: &ImuParameters) -> Vector3<f64> {
        self.integral - imu.at(self.temperature_c).gyroscope.bias * self.duration_s
    }
}

/// The problem for given weights.
#[derive(Clone)]
pub(super) struct Joint<'a> {
    pub(super) quantities: Vec<ImuQuantity>,
    pub(super) gravity: f64,
    pub(super) earth: Earth,
    pub(super) holds: Vec<HoldData>,
    pub(super) rotations: Vec<RotationData<'a>>,
    pub(super) turns: Vec<TurnData>,
    /// Noise of the gyroscope's samples, and of its coarse steps.
    pub(super) gyroscope_noise: StillNoise,
    /// Standard deviation of a rotation's error beyond this noise, rad per axis.
    pub(super) excess_rad: f64,
    /// Mean and inverse variance of each quantity; 0 where nothing is known beforehand.
    pub(super) prior: Option<(Vec<f64>, Vec<f64>)>,
}

/// A point of the iteration.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) imu: ImuParameters,
    pub(super) forces: Vec<Vector3<f64>>,
}

/// A rotation at a state: what is left of gravity across the direction found, and how it depends on everything.
pub(super) struct Miss {
    /// The arc from `f_k` to where gravity would be by the gyroscope, rad.
    pub(super) error: Vector2<f64>,
    by_from: Matrix2<f64>,
    by_to: Matrix2<f64>,
    /// Derivative with respect to a turn of the start's frame.
    pub(super) by_turn: Matrix2x3<f64>,
    pub(super) by_parameters: Matrix2xX<f64>,
    /// Covariance of the error from the gyroscope's noise.
    pub(super) covariance: Matrix2<f64>,
    pub(super) rotation: Rotation,
}

/// What each rotation says at a state; `None` for those that cannot be integrated.
pub(super) type Misses = Vec<Option<Miss>>;

/// Where it ended.
pub(super) struct Fit {
    pub(super) state: State,
    pub(super) misses: Misses,
    pub(super) information: DMatrix<f64>,
    /// Diagonal of the information before the directions were eliminated.
    pub(super) unreduced: DVector<f64>,
    pub(super) chi2: f64,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

impl Miss {
    /// Derivative of the error with respect to the specific forces before and after the rotation, across which they may turn.
    pub(super) fn by_forces(
        &self,
        from: &Vector3<f64>,
        to: &Vector3<f64>,
        gravity: f64,
    ) -> (Matrix2x3<f64>, Matrix2x3<f64>) {
        let across = |force: &Vector3<f64>| tangents(force).transpose() / gravity;
        (self.by_from * across(from), self.by_to * across(to))
    }
}

impl Joint<'_> {
    /// Number of quantities of which something is known beforehand.
    pub(super) fn priors(&self) -> usize {
        self.prior.as_ref().map_or(0, |(_, weight)| weight.iter().filter(|weight| **weight > 0.0).count())
    }

    /// Places of the gyroscope's quantities.
    pub(super) fn gyroscope_places(&self) -> Vec<usize> {
        (0..self.quantities.len()).filter(|&k| self.quantities[k].triad() == Triad::Gyroscope).collect()
    }

    fn sensitivity<const P: usize>(&self, triad: Triad, at: &Condition<'_>) -> SMatrix<f64, 3, P> {
        let mut matrix = SMatrix::<f64, 3, P>::zeros();
        for (k, quantity) in self.quantities.iter().enumerate() {
            if quantity.triad() == triad {
                matrix.set_column(k, &quantity.derivative(at));
            }
        }
        matrix
    }

    /// What a rotation says at a state; `None` where the gyroscope's matrix is singular.
    pub(super) fn miss(&self, data: &RotationData<'_>, state: &State) -> Option<Miss> {
        let rotation = data.samples.integrate(&state.imu, &self.gyroscope_noise.of_sample)?;
        let (before, to) = (state.forces[data.from], state.forces[data.from + 1]);
        // where the Earth turns gravity meanwhile
        let from = before + self.earth.rate(data.from, &before).cross(&before) * data.samples.duration_s();
        let back = rotation.start_from_end.transpose();
        let arc = Arc::of(&(back * from / self.gravity), &(to / self.gravity));
        let by_turn = arc.by_missing * back * (from / self.gravity).cross_matrix();
        let mut by_parameters = Matrix2xX::zeros(self.quantities.len());
        for (k, quantity) in self.quantities.iter().enumerate() {
            if quantity.triad() == Triad::Gyroscope {
                by_parameters.set_column(k, &(by_turn * rotation.derivative(*quantity, &state.imu)));
            }
        }
        // an axis that hardly turns reads as in a hold
        let by_reading = rotation.by_reading();
        let of_steps =
            by_reading * Matrix3::from_diagonal(&self.gyroscope_noise.of_mean) * by_reading.transpose();
        Some(Miss {
            error: arc.error,
            by_from: arc.by_missing * back * tangents(&before),
            by_to: arc.by_missed,
            by_turn,
            by_parameters,
            covariance: by_turn * (rotation.covariance + of_steps) * by_turn.transpose(),
            rotation,
        })
    }

    /// Weight of a rotation.
    pub(super) fn weight(&self, miss: &Miss) -> Matrix2<f64> {
        let variance = miss.covariance + Matrix2::identity() * (self.excess_rad.powi(2) + 1e-18);
        variance.try_inverse().unwrap_or_else(Matrix2::zeros)
    }

    /// All rotations that can be integrated.
    pub(super) fn misses(&self, state: &State) -> Option<Misses> {
        use rayon::prelude::*;
        self.rotations
            .par_iter()
            .map(|data| if data.used { self.miss(data, state).map(Some) } else { Some(None) })
            .collect()
    }

    /// What the gyroscope of an IMU at its temperature reads in a hold.
    pub(super) fn at_rest(&self, hold: usize, imu: &ImuParameters, force: &Vector3<f64>) -> Vector3<f64> {
        imu.gyroscope.reading(&self.earth.rate(hold, force)) + imu.g_sensitivity * force
    }

    /// What a turn leaves unexplained.
    pub(super) fn turn_residual(&self, turn: &TurnData, imu: &ImuParameters) -> Vector3<f64> {
        let imu = imu.at(turn.temperature_c);
        turn.integral
            - imu.gyroscope.bias * turn.duration_s
            - imu.g_sensitivity * turn.force
            - imu.gyroscope.matrix * self.turned(turn)
    }

    /// The rotation of a turn, the Earth's about the vertical with it, rad.
    pub(super) fn turned(&self, turn: &TurnData) -> Vector3<f64> {
        turn.angle + turn.force * self.earth.vertical_rate()
    }

    fn chi2(&self, state: &State, misses: &[Option<Miss>]) -> f64 {
        let weighted = |r: Vector3<f64>, w: &Vector3<f64>| r.component_mul(&r).dot(w);
        let imu = &state.imu;
        let holds: f64 = self
            .holds
            .iter()
            .zip(&state.forces)
            .enumerate()
            .map(|(j, (hold, force))| {
                let imu = imu.at(hold.temperature_c);
                let r = hold.accelerometer - imu.accelerometer.reading(force);
                let own = r.dot(&(hold.accelerometer_weight * r));
                own + hold
                    .gyroscope
                    .as_ref()
                    .map_or(0.0, |(mean, weight)| weighted(mean - self.at_rest(j, &imu, force), weight))
            })
            .sum();
        let rotations: f64 = misses
            .iter()
            .zip(&self.rotations)
            .filter(|(_, data)| data.counts)
            .filter_map(|(miss, _)| miss.as_ref())
            .map(|miss| miss.error.dot(&(self.weight(miss) * miss.error)))
            .sum();
        let turns: f64 =
            self.turns.iter().map(|turn| weighted(self.turn_residual(turn, imu), &turn.weight)).sum();
        let prior = self.prior.as_ref().map_or(0.0, |(mean, weight)| {
            let off = self.quantities.iter().zip(mean.iter().zip(weight));
            off.map(|(quantity, (mean, weight))| (mean - quantity.of(imu)).powi(2) * weight).sum()
        });
        holds + rotations + turns + prior
    }

    fn factor<const P: usize>(
        &self,
        state: &State,
        misses: &[Option<Miss>],
    ) -> Option<(Arrowhead<2, P>, SVector<f64, P>)> {
        let imu = &state.imu;
        let (mut border, mut rhs) = (SMatrix::<f64, P, P>::zeros(), SVector::<f64, P>::zeros());
        if let Some((mean, weight)) = &self.prior {
            for (k, quantity) in self.quantities.iter().enumerate() {
                border[(k, k)] += weight[k];
                rhs[k] += (mean[k] - quantity.of(imu)) * weight[k];
            }
        }
        for turn in &self.turns {
            let (stimulus, force, temperature_c) = (self.turned(turn), turn.force, turn.temperature_c);
            let mut j: SMatrix<f64, 3, P> =
                self.sensitivity(Triad::Gyroscope, &Condition { imu, stimulus, force, temperature_c });
            for (k, quantity) in self.quantities.iter().enumerate() {
                if quantity.is_of_bias() {
                    j.column_mut(k).scale_mut(turn.duration_s);
                }
            }
            let w = Matrix3::from_diagonal(&turn.weight);
            border += j.tr_mul(&(w * j));
            rhs += j.tr_mul(&turn.weight.component_mul(&self.turn_residual(turn, imu)));
        }
        let mut unreduced = border.diagonal();
        // places that no quantity takes
        for k in self.quantities.len()..P {
            border[(k, k)] = 1.0;
        }
        let link = |j: usize| {
            let (hold, force) = (&self.holds[j], &state.forces[j]);
            let turn = tangents(force) * self.gravity;
            let mut link = Link {
                h00: SMatrix::zeros(),
                h01: SMatrix::zeros(),
                h11: SMatrix::zeros(),
                b0: SMatrix::zeros(),
                b1: SMatrix::zeros(),
                c: SMatrix::zeros(),
                g0: SVector::zeros(),
                g1: SVector::zeros(),
                gp: SVector::zeros(),
            };
            let mut add =
                |by_force: Matrix3<f64>, g: SMatrix<f64, 3, P>, r: Vector3<f64>, w: Matrix3<f64>| {
                    let wr = w * r;
                    link.c += g.tr_mul(&(w * g));
                    link.gp += g.tr_mul(&wr);
                    if hold.known.is_none() {
                        let turn = by_force * turn;
                        link.h11 += turn.tr_mul(&(w * turn));
                        link.b1 += turn.tr_mul(&(w * g));
                        link.g1 += turn.tr_mul(&wr);
                    }
                };
            let temperature_c = hold.temperature_c;
            let felt = Condition { imu: &state.imu, stimulus: *force, force: *force, temperature_c };
            let imu = state.imu.at(temperature_c);
            let g = self.sensitivity(Triad::Accelerometer, &felt);
            let r = hold.accelerometer - imu.accelerometer.reading(force);
            add(imu.accelerometer.matrix, g, r, hold.accelerometer_weight);
            if let Some((mean, weight)) = &hold.gyroscope {
                let stimulus = self.earth.rate(j, force);
                let g = self.sensitivity(Triad::Gyroscope, &Condition { stimulus, ..felt });
                let by_force = imu.g_sensitivity + imu.gyroscope.matrix * self.earth.vertical_rate();
                add(by_force, g, mean - self.at_rest(j, &imu, force), Matrix3::from_diagonal(weight));
            }
            let counted =
                |before: &usize| self.rotations.get(*before).is_some_and(|rotation| rotation.counts);
            if let Some(miss) = j.checked_sub(1).filter(counted).and_then(|before| misses[before].as_ref()) {
                let w = self.weight(miss);
                let wr = -(w * miss.error);
                let mut g = SMatrix::<f64, 2, P>::zeros();
                g.columns_mut(0, self.quantities.len()).copy_from(&miss.by_parameters);
                let wg = w * g;
                link.c += g.tr_mul(&wg);
                link.gp += g.tr_mul(&wr);
                if self.holds[j - 1].known.is_none() {
                    link.h00 += miss.by_from.tr_mul(&(w * miss.by_from));
                    link.b0 += miss.by_from.tr_mul(&wg);
                    link.g0 += miss.by_from.tr_mul(&wr);
                }
                if hold.known.is_none() {
                    link.h11 += miss.by_to.tr_mul(&(w * miss.by_to));
                    link.b1 += miss.by_to.tr_mul(&wg);
                    link.g1 += miss.by_to.tr_mul(&wr);
                }
                if hold.known.is_none() && self.holds[j - 1].known.is_none() {
                    link.h01 += miss.by_from.tr_mul(&(w * miss.by_to));
                }
            }
            unreduced += link.c.diagonal();
            link
        };
        let increment =
            |j: usize| Increment { fixed: [self.holds[j].known.is_some(); 2], ..Increment::unknown() };
        let system = Arrowhead::eliminate(self.holds.len(), link, increment, border, rhs).ok()?;
        Some((system, unreduced))
    }

    /// Iterates from a state with its misses; `None` where a matrix is or becomes singular.
    pub(super) fn fit(&self, start: State, misses: Misses, settings: &CalibrationSettings) -> Option<Fit> {
        match self.quantities.len() {
            ..=AT_REFERENCE => self.iterate::<AT_REFERENCE>(start, misses, settings),
            _ => self.iterate::<ENTRIES>(start, misses, settings),
        }
    }

    fn iterate<const P: usize>(
        &self,
        start: State,
        misses: Misses,
        settings: &CalibrationSettings,
    ) -> Option<Fit> {
        let (mut state, mut misses) = (start, misses);
        let mut chi2 = self.chi2(&state, &misses);
        let (mut system, mut unreduced) = self.factor::<P>(&state, &misses)?;
        let (mut status, mut iterations) = (CalibrationStatus::IterationLimit, 0);
        let (mut damping, mut norm, mut last_norm) = (0.0_f64, f64::INFINITY, f64::INFINITY);
        while iterations < settings.max_iterations {
            iterations += 1;
            norm = system.gradient_norm();
            if norm <= settings.tolerance || (norm < 1e-6 && norm > 0.5 * last_norm) {
                status = CalibrationStatus::Converged;
                break;
            }
            last_norm = norm;
            let trial = system.border_step(damping).and_then(|step| self.take(&state, &system, &step));
            let accepted = trial.and_then(|trial| {
                let trial_misses = self.misses(&trial)?;
                let trial_chi2 = self.chi2(&trial, &trial_misses);
                (trial_chi2 <= chi2 * (1.0 + 1e-9) || norm < CLOSE).then_some((
                    trial,
                    trial_misses,
                    trial_chi2,
                ))
            });
            match accepted.and_then(|found| Some((self.factor(&found.0, &found.1)?, found))) {
                Some(((next, diagonal), found)) => {
                    (state, misses, chi2) = found;
                    (system, unreduced) = (next, diagonal);
                    damping = if damping < 1e-6 { 0.0 } else { damping / 10.0 };
                }
                None => {
                    damping = (damping * 10.0).max(1e-4);
                    last_norm = f64::INFINITY;
                    if damping > 1e14 {
                        status = CalibrationStatus::Stalled;
                        break;
                    }
                }
            }
        }
        let size = self.quantities.len();
        Some(Fit {
            state,
            misses,
            information: DMatrix::from_fn(size, size, |i, j| system.information[(i, j)]),
            unreduced: DVector::from_fn(size, |k, _| unreduced[k]),
            chi2,
            status,
            iterations,
            gradient_norm: norm,
        })
    }

    /// The state after a step, the directions scaled back to gravity.
    fn take<const P: usize>(
        &self,
        state: &State,
        system: &Arrowhead<2, P>,
        step: &SVector<f64, P>,
    ) -> Option<State> {
        let mut imu = state.imu;
        for (quantity, step) in self.quantities.iter().zip(step.iter()) {
            quantity.add_to(&mut imu, *step);
        }
        if imu.accelerometer.matrix.determinant() <= 0.0 {
            return None;
        }
        let turns = system.chain_step(step);
        let forces = state
            .forces
            .iter()
            .zip(&turns[1..])
            .zip(&self.holds)
            .map(|((force, turn), hold)| {
                if hold.known.is_some() {
                    return Some(*force);
                }
                (force + tangents(force) * turn * self.gravity)
                    .try_normalize(1e-300)
                    .map(|u| u * self.gravity)
            })
            .collect::<Option<Vec<_>>>()?;
        Some(State { imu, forces })
    }
}

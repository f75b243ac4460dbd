//! The least-squares problem of an IMU for given weights: Gauss–Newton on directions and parameters.
//!
//! The unknown directions `f_j` of the holds are a chain, and the rotations between them are its links. With the parameters as its border, this is an
//! arrowhead. Residuals:
//!
//! | of | residual | unknowns |
//! |---|---|---|
//! | a hold, accelerometer | `ȳ_a − S_a f_j − b_a` | `f_j`, accelerometer |
//! | a hold, gyroscope | `ȳ_g − b_g − Γ f_j − S_g ω_j` | `f_j`, gyroscope |
//! | a rotation | the arc from `f_k` to `Rᵀ (f_i + T ω_i × f_i)`: 2 numbers | `f_i`, `f_k`, gyroscope |
//! | a turn of known angle | `∫ (y_g − b_g − Γ f − S_g κ f) dt − S_g φ e` | gyroscope |
//!
//! `S` and `b` are those at the temperature of the hold, the rotation or the turn. `ω_j = κ f_j + E_j h` is the Earth's rate (`earth_rate`). It is fixed
//! here, and estimated with the weights. `T` is the duration of the rotation.

use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::error::Result;
use crate::estimate::imu::model::{Fit, GravityResidual, GravityResiduals, ImuModel, State, singular};
use crate::estimate::settings::CalibrationSettings;
use crate::estimate::tangent_plane::tangents;
use crate::sensor::entry_vector::{AT_REFERENCE, ENTRIES};
use crate::sensor::{Condition, SensorKind};
use crate::solve::{Equations, LeastSquares, LoopSettings, minimise};
use nalgebra::{DVector, Matrix3, SMatrix, SVector, Vector3};

/// A step below this length, in standard deviations, needs no test. The derivatives of a rotation are only exact to second order in the sample step,
/// so the last steps may not lower χ².
const CLOSE: f64 = 0.1;

impl ImuModel<'_> {
    fn sensitivity<const P: usize>(&self, sensor_kind: SensorKind, at: &Condition<'_>) -> SMatrix<f64, 3, P> {
        let mut matrix = SMatrix::<f64, 3, P>::zeros();
        for (k, quantity) in self.quantities.iter().enumerate() {
            if quantity.sensor_kind() == sensor_kind {
                matrix.set_column(k, &quantity.derivative(at));
            }
        }
        matrix
    }

    fn equations_at<const P: usize>(
        &self,
        state: &State,
        residuals: &[Option<GravityResidual>],
    ) -> Option<Equations<2, P>> {
        let imu = &state.imu;
        let (mut border, mut rhs) = (SMatrix::<f64, P, P>::zeros(), SVector::<f64, P>::zeros());
        if let Some((mean, weight)) = &self.prior {
            for (k, quantity) in self.quantities.iter().enumerate() {
                border[(k, k)] += weight[k];
                rhs[k] += (mean[k] - quantity.value(imu)) * weight[k];
            }
        }
        for turn in &self.turns {
            let (stimulus, force, temperature_c) = (self.turned(turn), turn.force, turn.temperature_c);
            let mut j: SMatrix<f64, 3, P> =
                self.sensitivity(SensorKind::Gyroscope, &Condition { imu, stimulus, force, temperature_c });
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
        // places without a quantity
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
            let g = self.sensitivity(SensorKind::Accelerometer, &felt);
            let r = hold.accelerometer - imu.accelerometer.reading(force);
            add(imu.accelerometer.by_stimulus(force), g, r, hold.accelerometer_weight);
            if let Some((mean, weight)) = &hold.gyroscope {
                let stimulus = self.earth.rate(j, force);
                let g = self.sensitivity(SensorKind::Gyroscope, &Condition { stimulus, ..felt });
                let by_force = imu.g_sensitivity + imu.gyroscope.matrix * self.earth.vertical_rate();
                add(by_force, g, mean - self.at_rest(j, &imu, force), Matrix3::from_diagonal(weight));
            }
            let counted =
                |before: &usize| self.rotations.get(*before).is_some_and(|rotation| rotation.counts);
            if let Some(residual) =
                j.checked_sub(1).filter(counted).and_then(|before| residuals[before].as_ref())
            {
                let w = self.rotation_weight(j - 1, residual);
                let wr = -(w * residual.error);
                let mut g = SMatrix::<f64, 2, P>::zeros();
                g.columns_mut(0, self.quantities.len()).copy_from(&residual.by_parameters);
                let wg = w * g;
                link.c += g.tr_mul(&wg);
                link.gp += g.tr_mul(&wr);
                if self.holds[j - 1].known.is_none() {
                    link.h00 += residual.by_from.tr_mul(&(w * residual.by_from));
                    link.b0 += residual.by_from.tr_mul(&wg);
                    link.g0 += residual.by_from.tr_mul(&wr);
                }
                if hold.known.is_none() {
                    link.h11 += residual.by_to.tr_mul(&(w * residual.by_to));
                    link.b1 += residual.by_to.tr_mul(&wg);
                    link.g1 += residual.by_to.tr_mul(&wr);
                }
                if hold.known.is_none() && self.holds[j - 1].known.is_none() {
                    link.h01 += residual.by_from.tr_mul(&(w * residual.by_to));
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

    /// Iterates from a state with its residuals. `None` if a matrix is or becomes singular.
    pub(crate) fn fit(
        &self,
        start: State,
        residuals: GravityResiduals,
        settings: &CalibrationSettings,
    ) -> Option<Fit> {
        match self.quantities.len() {
            ..=AT_REFERENCE => self.iterate::<AT_REFERENCE>(start, residuals, settings),
            _ => self.iterate::<ENTRIES>(start, residuals, settings),
        }
    }

    /// The undamped step of the quantities from a state with its residuals. `None` if a matrix is singular.
    pub(crate) fn step(&self, state: &State, residuals: &[Option<GravityResidual>]) -> Option<DVector<f64>> {
        match self.quantities.len() {
            ..=AT_REFERENCE => self.step_of::<AT_REFERENCE>(state, residuals),
            _ => self.step_of::<ENTRIES>(state, residuals),
        }
    }

    fn step_of<const P: usize>(
        &self,
        state: &State,
        residuals: &[Option<GravityResidual>],
    ) -> Option<DVector<f64>> {
        let step = self.equations_at::<P>(state, residuals)?.0.border_step(0.0)?;
        Some(DVector::from_fn(self.quantities.len(), |k, _| step[k]))
    }

    fn iterate<const P: usize>(
        &self,
        start: State,
        residuals: GravityResiduals,
        settings: &CalibrationSettings,
    ) -> Option<Fit> {
        let equations = self.equations_at::<P>(&start, &residuals)?;
        let settings = LoopSettings {
            most: settings.max_iterations,
            tolerance: settings.tolerance,
            rounding: &[(1e-6, 1)],
            untested_below: CLOSE,
            least_chi2: 0.0,
            damping: [1e-4, 1e14],
            has_last_step: false,
        };
        let end = minimise(self, (start, residuals), equations, &settings);
        let size = self.quantities.len();
        let (information, unreduced) = (end.information(size), end.unreduced(size));
        let (state, residuals) = end.point;
        Some(Fit {
            state,
            residuals,
            information,
            unreduced,
            chi2: end.chi2,
            status: end.status,
            iterations: end.iterations,
            gradient_norm: end.gradient_norm,
        })
    }

    /// The problem linearised at a state.
    pub(crate) fn linearised(&self, state: &State, settings: &CalibrationSettings) -> Result<Fit> {
        let none = CalibrationSettings { max_iterations: 0, ..settings.clone() };
        let residuals = self.gravity_residuals(state).ok_or_else(singular)?;
        self.fit(state.clone(), residuals, &none).ok_or_else(singular)
    }
}

impl<const P: usize> LeastSquares<2, P> for ImuModel<'_> {
    type Point = (State, GravityResiduals);

    fn chi2(&self, (state, residuals): &Self::Point) -> f64 {
        self.chi2(state, residuals)
    }

    fn equations(&self, (state, residuals): &Self::Point) -> Option<Equations<2, P>> {
        self.equations_at(state, residuals)
    }

    /// The directions are scaled back to gravity.
    fn moved(
        &self,
        (state, _): &Self::Point,
        system: &Arrowhead<2, P>,
        step: &SVector<f64, P>,
    ) -> Option<Self::Point> {
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
        let state = State { imu, forces };
        let residuals = self.gravity_residuals(&state)?;
        Some((state, residuals))
    }
}

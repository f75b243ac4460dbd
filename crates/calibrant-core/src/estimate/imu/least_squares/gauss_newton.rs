//! Gauss–Newton on the directions of the holds and the quantities of an IMU, for given weights. `terms` has what is summed.

use crate::arrowhead::Arrowhead;
use crate::error::Result;
use crate::estimate::imu::model::{Fit, GravityResidual, GravityResiduals, ImuModel, State, singular};
use crate::estimate::imu::terms::sums::{chi2, normal_equations};
use crate::estimate::imu::terms::term::At;
use crate::estimate::settings::CalibrationSettings;
use crate::estimate::tangent_plane::tangents;
use crate::sensor::entry_vector::{AT_REFERENCE, ENTRIES};
use crate::sensor::{NonlinearTerm, SensorKind};
use crate::solve::{Equations, LeastSquares, LoopSettings, minimise};
use nalgebra::{DVector, SVector};

/// A step below this length, in standard deviations, needs no test. The derivatives of a rotation are only exact to second order in the sample step,
/// so the last steps may not lower χ².
const CLOSE: f64 = 0.1;

/// The most quantities of an accelerometer in a gauge, and with all terms that bend its response.
const LINEAR_ACCELEROMETER: usize = 9;
const BENT_ACCELEROMETER: usize = LINEAR_ACCELEROMETER + 3 * NonlinearTerm::ALL.len();

impl ImuModel<'_> {
    /// Iterates from a state with its residuals. `None` if a matrix is or becomes singular.
    pub(crate) fn fit(
        &self,
        start: State,
        residuals: GravityResiduals,
        settings: &CalibrationSettings,
    ) -> Option<Fit> {
        let settings = LoopSettings {
            most: settings.max_iterations,
            tolerance: settings.tolerance,
            rounding: &[(1e-6, 1)],
            untested_below: CLOSE,
            least_chi2: 0.0,
            damping: [1e-4, 1e14],
            has_last_step: false,
        };
        self.minimise((start, residuals), &settings)
    }

    /// Iterates from a state with its residuals, until these settings say that it is enough. `None` if a matrix is or becomes singular.
    pub(in crate::estimate) fn minimise(
        &self,
        start: (State, GravityResiduals),
        settings: &LoopSettings<'_>,
    ) -> Option<Fit> {
        // the smallest that is large enough
        match self.quantities.len() {
            n if n <= LINEAR_ACCELEROMETER => self.iterate::<LINEAR_ACCELEROMETER>(start, settings),
            n if n <= BENT_ACCELEROMETER => self.iterate::<BENT_ACCELEROMETER>(start, settings),
            n if n <= AT_REFERENCE => self.iterate::<AT_REFERENCE>(start, settings),
            _ => self.iterate::<ENTRIES>(start, settings),
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
        let at = At { model: self, state, rotations: residuals };
        let step = normal_equations::<P>(&at)?.0.border_step(0.0)?;
        Some(DVector::from_fn(self.quantities.len(), |k, _| step[k]))
    }

    fn iterate<const P: usize>(
        &self,
        start: (State, GravityResiduals),
        settings: &LoopSettings<'_>,
    ) -> Option<Fit> {
        let equations = LeastSquares::<2, P>::equations(self, &start)?;
        let end = minimise(self, start, equations, settings);
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

    fn chi2(&self, (state, rotations): &Self::Point) -> f64 {
        chi2(&At { model: self, state, rotations })
    }

    fn equations(&self, (state, rotations): &Self::Point) -> Option<Equations<2, P>> {
        normal_equations(&At { model: self, state, rotations })
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
        if imu[SensorKind::Accelerometer].matrix.determinant() <= 0.0 {
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

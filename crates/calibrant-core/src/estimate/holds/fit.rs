//! Gauss–Newton on the directions and the parameters, for given weights of the holds.

use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::estimate::tangent_plane::tangents;
use crate::estimate::{CalibrationSettings, CalibrationStatus};
use crate::motion::Hold;
use crate::sensor::{Correction, NonlinearTerm, ParameterList, SensorParameters};
use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector3};

/// The problem for given weights.
pub(super) struct Directions<'a> {
    pub(super) list: &'a ParameterList,
    pub(super) holds: Vec<&'a Hold>,
    /// Inverse variance of each hold's mean, per axis.
    pub(super) weights: Vec<Vector3<f64>>,
    pub(super) gravity: f64,
    /// Prior on the parameters: mean and inverse variance.
    pub(super) prior: Option<Prior>,
}

/// Mean and inverse variance of each parameter, 0 where nothing is known of it.
pub(super) type Prior = (DVector<f64>, DVector<f64>);

/// Number of parameters of a linear response, and of one with all terms: fits have room for so many.
const LINEAR: usize = 9;
const BENT: usize = LINEAR + 3 * NonlinearTerm::ALL.len();

/// Where the iteration ended.
pub(super) struct Fit {
    pub(super) sensor: SensorParameters,
    pub(super) forces: Vec<Vector3<f64>>,
    pub(super) information: DMatrix<f64>,
    /// Diagonal of the information before the directions were eliminated.
    pub(super) unreduced: DVector<f64>,
    /// That of the data and of the prior.
    pub(super) chi2: f64,
    pub(super) prior_chi2: f64,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

impl Directions<'_> {
    /// The force of each hold that the sensor's correction gives, scaled to gravity.
    pub(super) fn forces(&self, sensor: &SensorParameters) -> Option<Vec<Vector3<f64>>> {
        let correction = Correction::of(sensor)?;
        let force = |hold: &&Hold| correction.apply(&hold.mean).try_normalize(1e-300);
        self.holds.iter().map(|hold| force(hold).map(|u| u * self.gravity)).collect()
    }

    fn chi2(&self, sensor: &SensorParameters, forces: &[Vector3<f64>]) -> f64 {
        let data: f64 = self
            .holds
            .iter()
            .zip(forces)
            .zip(&self.weights)
            .map(|((hold, force), weight)| {
                let r = hold.mean - sensor.reading(force);
                r.component_mul(&r).dot(weight)
            })
            .sum();
        data + self.prior_chi2(sensor)
    }

    /// A step below this many standard deviations may be rounding. For nearly exact data that is the rounding of the means themselves.
    fn rounding(&self) -> f64 {
        let sum = self.holds.iter().zip(&self.weights);
        let squares: f64 = sum.map(|(hold, weight)| hold.mean.component_mul(&hold.mean).dot(weight)).sum();
        (8.0 * f64::EPSILON * squares.sqrt()).max(1e-6)
    }

    fn prior_chi2(&self, sensor: &SensorParameters) -> f64 {
        self.prior.as_ref().map_or(0.0, |(mean, weight)| {
            let off = mean - self.values(sensor);
            off.component_mul(&off).dot(weight)
        })
    }

    fn values(&self, sensor: &SensorParameters) -> DVector<f64> {
        DVector::from_fn(self.list.len(), |k, _| self.list.quantities()[k].value(sensor))
    }

    /// Derivative of the reading with respect to the parameters; columns beyond them are zero.
    pub(super) fn sensitivity<const P: usize>(
        &self,
        sensor: &SensorParameters,
        force: &Vector3<f64>,
    ) -> SMatrix<f64, 3, P> {
        let mut matrix = SMatrix::<f64, 3, P>::zeros();
        for (k, quantity) in self.list.quantities().iter().enumerate() {
            matrix.set_column(k, &quantity.derivative(sensor, force));
        }
        matrix
    }

    fn factor<const P: usize>(
        &self,
        sensor: &SensorParameters,
        forces: &[Vector3<f64>],
    ) -> Option<(Arrowhead<2, P>, SVector<f64, P>)> {
        let (mut border, mut rhs) = (SMatrix::<f64, P, P>::zeros(), SVector::<f64, P>::zeros());
        if let Some((mean, weight)) = &self.prior {
            for (k, value) in self.values(sensor).iter().enumerate() {
                border[(k, k)] = weight[k];
                rhs[k] = (mean[k] - value) * weight[k];
            }
        }
        let mut unreduced = border.diagonal();
        // places without a parameter
        for k in self.list.len()..P {
            border[(k, k)] = 1.0;
        }
        let link = |j: usize| {
            let (hold, force, weight) = (self.holds[j], &forces[j], &self.weights[j]);
            let w = SMatrix::from_diagonal(weight);
            let turn = sensor.by_stimulus(force) * tangents(force) * self.gravity;
            let g = self.sensitivity::<P>(sensor, force);
            let wr = weight.component_mul(&(hold.mean - sensor.reading(force)));
            let c = g.tr_mul(&(w * g));
            unreduced += c.diagonal();
            Link {
                h00: SMatrix::zeros(),
                h01: SMatrix::zeros(),
                h11: turn.tr_mul(&(w * turn)),
                b0: SMatrix::zeros(),
                b1: turn.tr_mul(&(w * g)),
                c,
                g0: SVector::zeros(),
                g1: turn.tr_mul(&wr),
                gp: g.tr_mul(&wr),
            }
        };
        // a hold with weight zero has no direction of its own: it is not in `holds`
        let system =
            Arrowhead::eliminate(self.holds.len(), link, |_| Increment::unknown(), border, rhs).ok()?;
        Some((system, unreduced))
    }

    /// Iterates from a sensor; `None` where its matrix is singular.
    pub(super) fn fit(&self, start: &SensorParameters, settings: &CalibrationSettings) -> Option<Fit> {
        match self.list.len() {
            ..=LINEAR => self.iterate::<LINEAR>(start, settings),
            _ => self.iterate::<BENT>(start, settings),
        }
    }

    fn iterate<const P: usize>(
        &self,
        start: &SensorParameters,
        settings: &CalibrationSettings,
    ) -> Option<Fit> {
        let mut sensor = *start;
        let mut forces = self.forces(&sensor)?;
        let mut chi2 = self.chi2(&sensor, &forces);
        let (mut system, mut unreduced) = self.factor::<P>(&sensor, &forces)?;
        let (mut status, mut iterations) = (CalibrationStatus::IterationLimit, 0);
        let rounding = self.rounding();
        let (mut damping, mut norm, mut last_norm) = (0.0_f64, f64::INFINITY, f64::INFINITY);
        while iterations < settings.max_iterations {
            iterations += 1;
            norm = system.gradient_norm();
            if norm <= settings.tolerance || (norm < rounding && norm > 0.5 * last_norm) {
                status = CalibrationStatus::Converged;
                // the parameters rest; the directions still follow their last step
                let last =
                    system.border_step(0.0).and_then(|step| self.take(&sensor, &forces, &system, &step));
                if let Some((next, turned)) = last
                    && let Some(factored) = self.factor(&next, &turned)
                {
                    (sensor, forces) = (next, turned);
                    (system, unreduced) = factored;
                    chi2 = self.chi2(&sensor, &forces);
                }
                break;
            }
            last_norm = norm;
            let trial =
                system.border_step(damping).and_then(|step| self.take(&sensor, &forces, &system, &step));
            let accepted = trial.and_then(|(trial, trial_forces)| {
                let trial_chi2 = self.chi2(&trial, &trial_forces);
                (trial_chi2 <= chi2 * (1.0 + 1e-9) || norm < rounding).then_some((
                    trial,
                    trial_forces,
                    trial_chi2,
                ))
            });
            match accepted.and_then(|found| Some((self.factor(&found.0, &found.1)?, found))) {
                Some(((next, diagonal), found)) => {
                    (sensor, forces, chi2) = found;
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
        let size = self.list.len();
        Some(Fit {
            prior_chi2: self.prior_chi2(&sensor),
            sensor,
            forces,
            information: DMatrix::from_fn(size, size, |i, j| system.information[(i, j)]),
            unreduced: DVector::from_fn(size, |k, _| unreduced[k]),
            chi2,
            status,
            iterations,
            gradient_norm: norm,
        })
    }

    /// Parameters and directions after a step, the directions scaled back to gravity.
    fn take<const P: usize>(
        &self,
        sensor: &SensorParameters,
        forces: &[Vector3<f64>],
        system: &Arrowhead<2, P>,
        step: &SVector<f64, P>,
    ) -> Option<(SensorParameters, Vec<Vector3<f64>>)> {
        let mut next = *sensor;
        for (quantity, step) in self.list.quantities().iter().zip(step.iter()) {
            quantity.add_to(&mut next, *step);
        }
        if next.matrix.determinant() <= 0.0 {
            return None;
        }
        let turns = system.chain_step(step);
        let forces = forces
            .iter()
            .zip(&turns[1..])
            .map(|(force, turn)| {
                (force + tangents(force) * turn * self.gravity)
                    .try_normalize(1e-300)
                    .map(|u| u * self.gravity)
            })
            .collect::<Option<Vec<_>>>()?;
        Some((next, forces))
    }
}

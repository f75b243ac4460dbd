//! Gauss–Newton on the directions and the parameters, for given weights of the holds.

use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::estimate::CalibrationSettings;
use crate::estimate::tangent_plane::tangents;
use crate::motion::Hold;
use crate::sensor::{Correction, NonlinearTerm, ParameterList, SensorParameters};
use crate::solve::{CalibrationStatus, Equations, LeastSquares, LoopSettings, minimise};
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

/// Sizes of the border: the most parameters of a linear response, and of one with all terms.
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
    fn sensitivity<const P: usize>(
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
        let at = (*start, self.forces(start)?);
        let equations = LeastSquares::<2, P>::equations(self, &at)?;
        let rounding = self.rounding();
        let settings = LoopSettings {
            most: settings.max_iterations,
            tolerance: settings.tolerance,
            rounding: &[(rounding, 1)],
            untested_below: rounding,
            least_chi2: 0.0,
            damping: [1e-4, 1e14],
            has_last_step: true,
        };
        let end = minimise(self, at, equations, &settings);
        let size = self.list.len();
        let (information, unreduced) = (end.information(size), end.unreduced(size));
        let (sensor, forces) = end.point;
        Some(Fit {
            prior_chi2: self.prior_chi2(&sensor),
            sensor,
            forces,
            information,
            unreduced,
            chi2: end.chi2,
            status: end.status,
            iterations: end.iterations,
            gradient_norm: end.gradient_norm,
        })
    }
}

impl<const P: usize> LeastSquares<2, P> for Directions<'_> {
    /// A sensor with the forces of the holds.
    type Point = (SensorParameters, Vec<Vector3<f64>>);

    fn chi2(&self, (sensor, forces): &Self::Point) -> f64 {
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

    fn equations(&self, (sensor, forces): &Self::Point) -> Option<Equations<2, P>> {
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

    /// The directions are scaled back to gravity.
    fn moved(
        &self,
        (sensor, forces): &Self::Point,
        system: &Arrowhead<2, P>,
        step: &SVector<f64, P>,
    ) -> Option<Self::Point> {
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

//! The sensor on the chain: what every information of it needs.

use super::sensor_columns::{ENTRIES, SensorColumns, entry};
use super::{Sampled, Smooth};
use crate::TrajectoryProblem;
use crate::motion::{Grid, Knots, gauss_legendre};
use crate::recursion::{JointAt, Links};
use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuParameters, ImuQuantity, SensorKind};
use calibrant_machine::chain::{Joint, SensorMount};
use calibrant_machine::estimate::{Layout, MachineParameters, MachineQuantity, MountingPrior, TiltedGravity};
use nalgebra::{DMatrix, Matrix4, Vector3};

/// How much noise grows while joints move.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NoiseGrowth {
    /// `κ`: the squared ratio of noise while moving to noise at rest, less 1.
    pub(crate) kappa: f64,
    /// Speed of each joint at which half of the growth is there, rad/s or m/s.
    pub(crate) speeds: Vec<f64>,
}

impl NoiseGrowth {
    /// At one time.
    pub(crate) fn at(&self, joints: &[JointAt]) -> GrowthAt<'_> {
        if self.kappa == 0.0 {
            return GrowthAt { factor: 1.0, of_square: 0.0, speeds: &self.speeds };
        }
        let s: f64 = joints.iter().zip(&self.speeds).map(|(joint, speed)| (joint.qd / speed).powi(2)).sum();
        let factor = 1.0 + self.kappa * s / (s + 1.0);
        GrowthAt { factor, of_square: self.kappa / (s + 1.0).powi(2) / factor, speeds: &self.speeds }
    }
}

/// The growth of noise at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GrowthAt<'a> {
    /// `g`.
    factor: f64,
    /// `∂ ln g/∂s`.
    of_square: f64,
    speeds: &'a [f64],
}

impl GrowthAt<'_> {
    /// `∂ ln g/∂q̇_j`.
    pub(crate) fn slope(&self, joints: &[JointAt], j: usize) -> f64 {
        self.of_square * 2.0 * joints[j].qd / self.speeds[j].powi(2)
    }
}

/// The sensor on the chain.
#[derive(Debug, Clone)]
pub(crate) struct Sensing {
    pub(crate) links: Links,
    pub(crate) mount: SensorMount,
    /// Derivatives of gravity in the base by the two tilts and by its magnitude.
    pub(crate) by_gravity: [Vector3<f64>; 3],
    /// Information of a second of each sensor's readings at rest, `1/N²`; 0 for a sensor that is not there.
    pub(crate) rates: [f64; 2],
    pub(crate) growth: NoiseGrowth,
    pub(crate) columns: SensorColumns,
    /// The unknowns, the sensor's first, and their priors.
    pub(crate) layout: Layout,
    pub(crate) criterion: Smooth,
}

/// The times of an information and their weights.
#[derive(Debug, Clone)]
pub(crate) struct Quadrature {
    pub(crate) grid: Grid,
    /// Weight of each place of an interval, s.
    weights: Vec<f64>,
    /// Half of the duration, s: the clock's rate counts about it.
    middle_s: f64,
}

impl Quadrature {
    /// This number of points in each interval.
    pub(crate) fn new(knots: Knots, points: usize) -> Self {
        let gauss = gauss_legendre(points);
        let grid = Grid::at(knots, gauss.iter().map(|(place, _)| *place));
        let weights = gauss.iter().map(|(_, weight)| weight * knots.step_s).collect();
        Self { grid, weights, middle_s: knots.duration_s() / 2.0 }
    }

    /// Time `k` after the middle of the motion, s.
    pub(crate) fn after_middle_s(&self, k: usize) -> f64 {
        self.grid.time_s(k) - self.middle_s
    }

    /// Weight of time `k`, s.
    pub(crate) fn weight_s(&self, k: usize) -> f64 {
        self.weights[k % self.weights.len()]
    }
}

/// Speed of a joint at which half of the growth of noise is there, rad/s and m/s. A joint that turns at 0.2 rad/s moves what is half a metre from it at 0.1 m/s.
const GROWN_AT: [f64; 2] = [0.2, 0.1];

impl Sensing {
    /// # Errors
    /// Parameters that no motion of a machine determines.
    pub(crate) fn new(problem: &TrajectoryProblem<'_>) -> Result<Self> {
        let (chain, setup, noise) = (problem.chain, problem.setup, &problem.noise);
        let densities = [noise.force_density, noise.rate_density];
        let kinds: Vec<SensorKind> = (SensorKind::ALL.into_iter())
            .filter(|kind| problem.quantities.iter().any(|quantity| quantity.sensor_kind() == *kind))
            .collect();
        let nominal = MachineParameters::nominal(setup, ImuParameters::identity(), chain.joints.len());
        let gravity = TiltedGravity::new(&setup.up);
        let (by_gravity, vector) = (gravity.derivatives(&nominal), gravity.vector(&nominal));
        let mount = nominal.mount;
        let layout = Layout::new(setup, &kinds, problem.quantities, nominal);
        let quantities: Vec<ImuQuantity> = (layout.quantities.iter())
            .filter_map(|quantity| match quantity {
                MachineQuantity::Imu(of) => Some(*of),
                _ => None,
            })
            .collect();
        let columns = SensorColumns::new(&quantities)?;
        let exact = setup.mounting == MountingPrior::Exact && setup.geometry_rotation_sd_rad == 0.0;
        let criterion = Smooth::new(&problem.criterion, &quantities, &columns.entries, densities, exact);
        let grown_at = |joint: &Joint| if joint.kind.turns() { GROWN_AT[0] } else { GROWN_AT[1] };
        let there = |s: usize| kinds.iter().any(|kind| *kind as usize == s);
        Ok(Self {
            links: Links::new(chain, &mount, &vector),
            mount,
            by_gravity,
            rates: [0, 1].map(|s| densities[s].filter(|_| there(s)).map_or(0.0, |density| density.powi(-2))),
            growth: NoiseGrowth {
                kappa: noise.moving.powi(2) - 1.0,
                speeds: chain.joints.iter().map(grown_at).collect(),
            },
            columns,
            layout,
            criterion,
        })
    }

    /// The information of a second of readings at time `k` times its weight, for each sensor.
    pub(crate) fn weights(&self, quadrature: &Quadrature, sampled: &Sampled, k: usize) -> [f64; 2] {
        let weight = quadrature.weight_s(k) / self.growth.at(sampled.joints(k)).factor;
        let [force, rate] = self.rates;
        [force * weight, rate * weight]
    }

    /// The sensor's parameters.
    pub(crate) fn quantities(&self) -> Vec<ImuQuantity> {
        let of = |quantity: &MachineQuantity| match quantity {
            MachineQuantity::Imu(of) => Some(*of),
            _ => None,
        };
        self.layout.quantities.iter().filter_map(of).collect()
    }

    /// The prior of the sensor's parameters.
    pub(crate) fn sensor_prior(&self) -> DMatrix<f64> {
        let p = self.columns.len();
        self.layout.prior.view((0, 0), (p, p)).into_owned()
    }
}

/// `Σ w φ φᵀ` of each sensor.
pub(crate) fn moments(sensing: &Sensing, quadrature: &Quadrature, sampled: &Sampled) -> [Matrix4<f64>; 2] {
    let mut moments = [Matrix4::zeros(); 2];
    for k in 0..sampled.len() {
        let weights = sensing.weights(quadrature, sampled, k);
        for ((moment, weight), phi) in moments.iter_mut().zip(weights).zip(sampled.regressors(k)) {
            for i in 0..4 {
                for j in 0..=i {
                    moment[(i, j)] += weight * phi[i] * phi[j];
                }
            }
        }
    }
    moments.map(|moment| Matrix4::from_fn(|i, j| moment[(i.max(j), i.min(j))]))
}

/// The information of the 24 entries: each row of a sensor has its moments.
pub(crate) fn of_entries(moments: &[Matrix4<f64>; 2]) -> DMatrix<f64> {
    let mut information = DMatrix::zeros(ENTRIES, ENTRIES);
    for (s, moment) in moments.iter().enumerate() {
        for row in 0..3 {
            let first = entry(s, row, 0);
            information.fixed_view_mut::<4, 4>(first, first).copy_from(moment);
        }
    }
    information
}

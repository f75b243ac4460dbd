//! Bounds on variances and on the criterion, from the bounds on the motion. This makes the certificate.

use super::AxisChain;
use super::bounds::StateBounds;
use super::gravity::{GravityBound, MeanFacts, largest_mean};
use super::increment_design::IncrementDesign;
use super::motion_variance::{MotionVarianceBound, motion_variance_bound};
use crate::{Certificate, DesignProblem, Interruption};
use calibrant_core::error::Result;
use calibrant_core::information::{Criterion, covariance};
use calibrant_core::motion::{
    AxisLimits, InputNoise, IntervalSums, JerkControlledMotion, KnownEnds, MotionClock, Trust,
};
use calibrant_core::sensor::{Quantity, SensorModel};
use nalgebra::{DMatrix, DVector, Vector3};

/// What no admissible motion can beat.
#[derive(Debug, Clone)]
pub(crate) struct LowerBound {
    /// The bound on the criterion.
    pub(crate) value: f64,
    /// Smallest variance of each parameter.
    variances: DVector<f64>,
    explanation: String,
}

impl LowerBound {
    /// The bound on the criterion of the parameters at these places, which share no information with the
    /// others.
    pub(crate) fn of_part(&self, criterion: &Criterion, places: &[usize]) -> f64 {
        if places.len() == self.variances.len() {
            return self.value;
        }
        let own = DVector::from_iterator(places.len(), places.iter().map(|&place| self.variances[place]));
        let smallest = DMatrix::from_diagonal(&own);
        let criterion = criterion.restricted(places);
        criterion.value(&smallest) * independence(&criterion, &smallest)
    }

    /// The certificate of a design whose criterion has this value. No motion changes its part `floor`.
    pub(crate) fn certificate(self, criterion: &Criterion, value: f64, floor: f64) -> Certificate {
        Certificate {
            lower_bound: self.value,
            gap: criterion.gap(value - floor, self.value - floor),
            sd_lower_bound: self.variances.iter().map(|variance| variance.sqrt()).collect(),
            explanation: self.explanation,
        }
    }
}

/// The bound of a design problem.
///
/// `None` where nothing bounds the motion, or the limits leave it no freedom at all. Once it is interrupted, it
/// takes the bounds that need no solver.
///
/// # Errors
/// As [`MotionInformation::information`](calibrant_core::information::MotionInformation::information).
pub(crate) fn lower_bound(
    problem: &DesignProblem<'_>,
    interruption: &Interruption,
) -> Result<Option<LowerBound>> {
    // a clock that is not exact only takes information away: the bound of an exact one holds
    let problem = &DesignProblem { clock: MotionClock::default(), ..problem.clone() };
    let setting = problem.setting()?;
    let rest =
        JerkControlledMotion::uniform(problem.interval_s, vec![Vector3::zeros(); problem.intervals + 1])?;
    let still = setting.information(&rest)?;
    let mut bounds = Bounds {
        problem,
        noise: setting.noise,
        sums: IntervalSums::all(&rest, problem.rate_hz),
        gravity: GravityBound::of(problem, &setting, &rest, &still),
        still,
        ramp: if problem.trust == Trust::Unknown {
            Some(setting.information(&ramp(problem)?)?)
        } else {
            None
        },
        interruption,
        known: Vec::new(),
        reasons: Vec::new(),
    };
    let quantities = problem.sensor.parameter_list().quantities().to_vec();
    let Some(variances) = (0..quantities.len())
        .map(|place| bounds.variance(place, quantities[place], &quantities))
        .collect::<Option<Vec<_>>>()
    else {
        return Ok(None);
    };
    let variances = DVector::from_vec(variances);
    let mut value = bounds.criterion(&variances);
    if let Some(together) =
        bounds.increment_design(&quantities).filter(|together| value.is_nan() || *together > value)
    {
        value = together;
        bounds.explain("criterion: the process noise alone, as if the readings were perfect, and the best distribution of the jerk in place of a motion; close where the process noise dominates and intervals are many");
    }
    Ok(value.is_finite().then(|| LowerBound { value, variances, explanation: bounds.explanation() }))
}

/// A straight line from −1 to 1 m/s² on every axis.
fn ramp(problem: &DesignProblem<'_>) -> Result<JerkControlledMotion> {
    let n = problem.intervals;
    let nodes = (0..=n).map(|i| Vector3::repeat(2.0 * i as f64 / n as f64 - 1.0)).collect();
    JerkControlledMotion::uniform(problem.interval_s, nodes)
}

/// The λ in `W ⪰ λ diag(W)` of criterion I; 1 for all others, whose weights are diagonal.
fn independence(criterion: &Criterion, at: &DMatrix<f64>) -> f64 {
    let Criterion::I(_) = criterion else { return 1.0 };
    let weight = criterion.derivative(at);
    let scale = weight.diagonal().map(|w| if w > 0.0 { 1.0 / w.sqrt() } else { 0.0 });
    let mut scaled = DMatrix::from_diagonal(&scale) * &weight * DMatrix::from_diagonal(&scale);
    scaled.fill_diagonal(0.0);
    if scaled.amax() == 0.0 { 1.0 } else { (1.0 + scaled.symmetric_eigenvalues().min() - 1e-14).max(0.0) }
}

/// Relative amount by which rounding may have made a bound on the information too small. A bound that the
/// motion attains exactly must not end above its value.
const ROUNDING: f64 = 1e-12;

/// Lower bounds on variances, and what they share.
struct Bounds<'a> {
    problem: &'a DesignProblem<'a>,
    noise: Vector3<f64>,
    sums: Vec<IntervalSums>,
    gravity: Option<GravityBound>,
    /// Information at rest. On the biases it does not depend on the motion; with process noise it is largest
    /// at rest.
    still: DMatrix<f64>,
    /// Information of a straight line from −1 to 1, where the motion is unknown.
    ramp: Option<DMatrix<f64>>,
    interruption: &'a Interruption,
    /// Motion variances that have bounds already.
    known: Vec<(AxisLimits, [f64; 2], Option<MotionVarianceBound>)>,
    /// Why the scale factors cannot be known better.
    reasons: Vec<String>,
}

impl Bounds<'_> {
    /// Lower bound on the variance of the parameter at a place; `None` where there is none.
    fn variance(&mut self, place: usize, quantity: Quantity, all: &[Quantity]) -> Option<f64> {
        let known = self.gravity.as_ref().map(|gravity| &gravity.prior).or(self.problem.prior.as_ref());
        let prior = |i: usize, j: usize| known.map_or(0.0, |prior| prior[(i, j)]);
        let (row, column) = match quantity {
            Quantity::Bias(_) if self.gravity.is_some() => return self.bias_under_gravity(place, all),
            Quantity::Bias(_) => {
                let information = self.still[(place, place)] + prior(place, place);
                return Some(1.0 / (information * (1.0 + ROUNDING)));
            }
            Quantity::Scale(axis) => (axis.index(), axis.index()),
            Quantity::CrossAxis(row, column) => (row.index(), column.index()),
            // no motion is designed for this parametrisation
            Quantity::Symmetric(..) | Quantity::Nonlinear(..) => return None,
        };
        let bias =
            all.iter().position(|other| matches!(other, Quantity::Bias(axis) if axis.index() == row))?;
        let (own, cross, on_bias) = (prior(place, place), prior(place, bias), prior(bias, bias));
        let bounds = StateBounds::of(&self.chain(column, 0.0, f64::INFINITY));
        // what earlier information on the bias adds where the bias follows from the scale factor and a known
        // acceleration
        let anchored = |a: f64| own + 2.0 * a * cross.abs() + a * a * on_bias;

        let mut information = f64::INFINITY;
        if let (Some(ramp), SensorModel::ScaleBias) = (&self.ramp, self.problem.sensor.model) {
            let apart = self.ends_apart(column, &bounds);
            let per_unit = if self.problem.prior.is_none() {
                let block = DMatrix::from_fn(2, 2, |i, j| ramp[([bias, place][i], [bias, place][j])]);
                1.0 / covariance(&block).map_or(0.0, |c| c[(1, 1)])
            } else {
                ramp[(place, place)]
            };
            information =
                per_unit * apart * apart / 4.0 + anchored(bounds.a[0].max(bounds.a[bounds.a.len() - 1]));
            self.explain("scale factors: the two ends of the motion, which is all that is known of it, can be no further apart than the limits allow; exact where the ends are free to be so");
        } else {
            let noise = self.noise[row] * self.noise[row];
            let samples: f64 = self.sums.iter().map(|sum| sum.samples).sum();
            if let Some(bound) = self.motion_variance(column, noise * cross, samples + noise * on_bias) {
                information = bound.value / noise + own;
                let known = if self.problem.trust == Trust::Known {
                    ""
                } else {
                    "as if the motion were known exactly: "
                };
                let shared = if self.problem.sensor.model == SensorModel::Full {
                    "; each axis as if it could be moved independently of what the others need"
                } else {
                    ""
                };
                let solver = if bound.solved {
                    ""
                } else {
                    "; the conic solver stopped early, which makes the bound looser, not wrong"
                };
                self.explain(&format!("scale factors: {known}{}{shared}{solver}", bound.kind.explanation()));
            }
            if let (Trust::Noisy(input), KnownEnds::Start) = (self.problem.trust, self.problem.known_ends) {
                let from_increments = self.increments(input, row, column) + anchored(bounds.a[0]);
                if from_increments < information {
                    information = from_increments;
                    self.reasons.clear(); // all are of the scale factors
                    self.explain("scale factors: the process noise alone, as if the readings were perfect and every interval had the largest jerk; close where the process noise dominates");
                }
            }
        }
        (information.is_finite() && information > 0.0).then(|| 1.0 / (information * (1.0 + ROUNDING)))
    }

    /// Lower bound on the variance of the bias at a place, with gravity.
    fn bias_under_gravity(&mut self, place: usize, all: &[Quantity]) -> Option<f64> {
        let gravity = self.gravity.as_ref()?;
        let (base, force) = (gravity.biases[(place, place)], gravity.force);
        let least_known = gravity.least_known[place];
        let mut most = 0.0_f64;
        for (k, &quantity) in all.iter().enumerate() {
            let column = match quantity {
                Quantity::Scale(axis) if axis.index() == place => place,
                Quantity::CrossAxis(row, column) if row.index() == place => column.index(),
                _ => continue,
            };
            if self.problem.prior.is_some() || force[column] == 0.0 {
                continue;
            }
            let single = self.problem.sensor.model == SensorModel::ScaleBias;
            let facts = MeanFacts {
                trust: self.problem.trust,
                known_ends: self.problem.known_ends,
                rate_hz: self.problem.rate_hz,
                least_known,
                noise: self.noise[place] * self.noise[place],
                increments: match self.problem.trust {
                    Trust::Noisy(input) => self.increments(input, place, column),
                    _ => f64::INFINITY,
                },
                ends: self
                    .ramp
                    .as_ref()
                    .filter(|_| single)
                    .map(|ramp| (self.still[(place, place)], ramp[(k, k)])),
            };
            let beyond = force[column].abs() - largest_mean(&self.chain(column, 0.0, f64::INFINITY), &facts);
            if beyond > 0.0 {
                most = most.max(beyond * beyond * self.variance(k, quantity, all)?);
            }
        }
        Some((base + most) * (1.0 - ROUNDING))
    }

    /// Lower bound on the criterion from those on the variances.
    fn criterion(&self, variances: &DVector<f64>) -> f64 {
        let criterion = &self.problem.criterion;
        let mut smallest = DMatrix::from_diagonal(variances);
        let Some(gravity) = &self.gravity else {
            return criterion.value(&smallest) * independence(criterion, &smallest);
        };
        match criterion {
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => {
                let above = variances.zip_map(&gravity.floor.diagonal(), |all, floor| (all - floor).max(0.0));
                let above = DMatrix::from_diagonal(&above);
                criterion.value(&gravity.floor) + criterion.value(&above) * independence(criterion, &above)
            }
            Criterion::D(_) => {
                smallest.view_mut((0, 0), gravity.biases.shape()).copy_from(&gravity.biases);
                criterion.value(&smallest)
            }
            Criterion::E(_) | Criterion::M(_) => criterion.value(&smallest),
        }
    }

    fn explain(&mut self, reason: &str) {
        if !self.reasons.iter().any(|known| known == reason) {
            self.reasons.push(reason.to_owned());
        }
    }

    fn explanation(&self) -> String {
        let bias = match self.problem.trust {
            _ if self.gravity.is_some() => {
                "biases: the tilt, the noise of the readings averaged over all samples, and the error of the scale factors times the part of gravity that the mean of the motion cannot cancel"
            }
            Trust::Known => "biases: the noise of the readings averaged over all samples",
            Trust::Noisy(_) => {
                "biases: as if the scale factors were known and the process noise at its floor"
            }
            Trust::Unknown => "biases: as if the scale factors were known",
        };
        let mut all = vec![bias.to_owned()];
        all.extend(self.reasons.iter().cloned());
        format!("No admissible motion can do better than this, since for the {}.", all.join(". For the "))
    }

    fn chain(&self, axis: usize, shift: f64, mass: f64) -> AxisChain {
        let limits = self.problem.effective_limits().axis(axis);
        AxisChain { interval_s: self.problem.interval_s, sums: self.sums.clone(), limits, shift, mass }
    }

    fn motion_variance(&mut self, axis: usize, shift: f64, mass: f64) -> Option<MotionVarianceBound> {
        let chain = self.chain(axis, shift, mass);
        if let Some((.., bound)) =
            self.known.iter().find(|(l, at, _)| *l == chain.limits && *at == [shift, mass])
        {
            return bound.clone();
        }
        let bound = motion_variance_bound(&chain, self.interruption);
        self.known.push((chain.limits, [shift, mass], bound.clone()));
        bound
    }

    /// Largest `|a_N − a_0|`.
    fn ends_apart(&self, axis: usize, bounds: &StateBounds) -> f64 {
        let l = self.problem.effective_limits().axis(axis);
        let n = self.problem.intervals;
        let apart = match (l.start, l.end) {
            (Some(start), Some(end)) => (end - start).abs(),
            _ => bounds.a[0] + bounds.a[n],
        };
        apart.min(l.jerk.unwrap_or(f64::INFINITY) * self.problem.interval_s * n as f64)
    }

    /// Largest information on `S_rk` that noisy increments can carry with perfect readings:
    /// `Σ_i u_ik² Σ_m (S⁻¹)²_mr/σ_u,m²`.
    fn increments(&self, input: InputNoise, row: usize, column: usize) -> f64 {
        let problem = self.problem;
        let active: Vec<usize> = problem.sensor.active_axes().iter().map(|axis| axis.index()).collect();
        let full = problem.sensor.model == SensorModel::Full;
        let Some(inverse) = problem.at.matrix.try_inverse() else { return f64::INFINITY };
        self.largest_jerk(column)
            .into_iter()
            .map(|u| {
                if u == 0.0 {
                    return 0.0;
                }
                let mut sum = 0.0;
                for &m in &active {
                    let share = if full {
                        inverse[(m, row)]
                    } else if m == row {
                        1.0 / problem.at.matrix[(row, row)]
                    } else {
                        0.0
                    };
                    // the jerk of axis k excites; that of any other axis may be zero, and its noise at the
                    // floor
                    let sd = input.floor_mps3 + if m == column { input.ratio * u } else { 0.0 };
                    if share != 0.0 {
                        sum += (share * u / sd).powi(2);
                    }
                }
                sum
            })
            .sum()
    }

    /// Largest jerk of each interval that the limits leave to an axis.
    fn largest_jerk(&self, axis: usize) -> Vec<f64> {
        let jerk = self.problem.effective_limits().axis(axis).jerk.unwrap_or(f64::INFINITY);
        let bounds = StateBounds::of(&self.chain(axis, 0.0, f64::INFINITY));
        bounds.a.windows(2).map(|a| jerk.min((a[0] + a[1]) / self.problem.interval_s)).collect()
    }

    /// The bound of [`super::increment_design`], for a full sensor with a noisy motion from a known start,
    /// without gravity.
    fn increment_design(&self, quantities: &[Quantity]) -> Option<f64> {
        let problem = self.problem;
        let Trust::Noisy(noise) = problem.trust else { return None };
        let is_full = problem.sensor.model == SensorModel::Full && problem.sensor.axes == 3;
        if !is_full || problem.known_ends != KnownEnds::Start || problem.gravity.is_some() {
            return None;
        }
        let jerk = [0, 1, 2].map(|axis| self.largest_jerk(axis));
        let on_biases =
            problem.prior.as_ref().map_or_else(|| self.still.clone(), |prior| &self.still + prior);
        let design = IncrementDesign {
            criterion: &problem.criterion,
            quantities,
            matrix: problem.at.matrix,
            noise,
            jerk: (0..problem.intervals).map(|i| Vector3::from_fn(|axis, _| jerk[axis][i])).collect(),
            start: Vector3::from_fn(|axis, _| StateBounds::of(&self.chain(axis, 0.0, f64::INFINITY)).a[0]),
            on_biases: &on_biases,
            prior: problem.prior.as_ref(),
        };
        design.bound(self.interruption)
    }
}

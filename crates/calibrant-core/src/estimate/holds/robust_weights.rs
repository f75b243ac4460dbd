//! Weights of the holds: scatter within and between holds, and the holds that must be left out.
//!
//! A prior adds information and weighs no hold: the weights are those of the fit without it. Only where the holds leave something open
//! do they come from the fit with the prior. There `n − tr(Σ F)` degrees of freedom are left to n holds of information F, with Σ the covariance.

use super::HoldsSetup;
use super::fit::{self, Fit};
use super::robust::{Conditions, Magnitude, Robust};
use super::sphere::sphere;
use super::verdict::explain;
use crate::error::{Error, InputError, NotIdentifiable, Refusal, Result};
use crate::estimate::change::longest_run;
use crate::estimate::datasheet::prior;
use crate::estimate::hold_variance::{between_variance, noise_variance};
use crate::estimate::imu::{HoldData, ImuModel, KnownTerm, Prior};
use crate::estimate::{CalibrationProblem, CalibrationSettings};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{Correction, ImuQuantity, ParameterList, Quantity, SensorParameters};
use crate::solve::{
    Judged, ScaledInformation, Scatter, Trial, degrees_left, excess, hardly_determined, leave_out,
    shares_of_prior, studentised,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A hold is left out when a residual as large as its own would be seen in fewer than this share of recordings.
const SIGNIFICANCE: f64 = 0.01;
/// Most rounds of the robust fit.
const ROUNDS: usize = 20;
/// Its weights rest when none changes by more than this.
const WEIGHT_TOLERANCE: f64 = 1e-3;
/// Tukey's constant: 95 % efficiency at the normal distribution.
const BIWEIGHT: f64 = 4.685;

/// A fit with its weights.
struct Weighted {
    fit: Fit,
    covariance: DMatrix<f64>,
    between: f64,
    /// Degrees of freedom that the holds leave.
    degrees: f64,
    /// The sensor whose gains turned `between` into the unit of the readings.
    gains_of: SensorParameters,
}

/// The holds with what weighs them.
#[derive(Clone)]
struct Problem<'a> {
    holds: &'a [Hold],
    /// Places of those that may be used.
    sound: Vec<usize>,
    list: ParameterList,
    gravity: f64,
    within: Vector3<f64>,
    /// Variance of a mean that more samples do not lower: that of coarse steps.
    of_mean: Vector3<f64>,
    prior: Option<Prior>,
    conditions: Conditions,
    settings: &'a CalibrationSettings,
}

/// Fits, finds the scatter between holds, leaves bad holds out. `sound`: places of the holds that may be used; `of_mean`: variance of a mean that more samples do not lower.
pub(super) fn fit(
    problem: &CalibrationProblem<'_>,
    setup: &HoldsSetup,
    settings: &CalibrationSettings,
    holds: &[Hold],
    (sound, of_mean, conditions): (Vec<usize>, Vector3<f64>, Conditions),
) -> Result<Robust> {
    let list = setup.parameter_list(problem.sensor.model);
    let usable: Vec<Hold> = sound.iter().map(|&j| holds[j].clone()).collect();
    let start = match problem.sensor.nominal() {
        Some(nominal) if usable.len() >= 2 => nominal,
        _ => sphere(&usable, setup.gravity.magnitude_mps2)
            .ok_or_else(|| Error::NotIdentifiable(Box::new(too_few(&usable, &list))))?,
    };
    let within = pooled_sd(&usable, &start, setup.gravity.magnitude_mps2);
    let nominal = problem.sensor.nominal().filter(|_| settings.datasheet_prior);
    let prior = nominal.map(|nominal| prior(&list.describe(problem.sensor, &nominal)));
    let prior = prior.or_else(|| known(&setup.known, &list));
    let problem = Problem {
        holds,
        sound,
        list,
        gravity: setup.gravity.magnitude_mps2,
        within,
        of_mean,
        prior,
        conditions,
        settings,
    };
    problem.information(&start)?;
    let without = Problem { prior: None, ..problem.clone() };
    if problem.prior.is_none() || without.information(&start).is_err() {
        let (used, weighted) = problem.select(&start)?;
        return Ok(problem.summarise(used, weighted));
    }
    let (used, weighted) = without.select(&start)?;
    let weighted = problem.with_weights_of(&used, &weighted)?;
    Ok(problem.summarise(used, weighted))
}

/// The sensor that the holds look like, their scatter, and the information that they would give on its parameters.
pub(super) fn expect(
    holds: &[Hold],
    list: ParameterList,
    gravity: f64,
) -> Result<(SensorParameters, Vector3<f64>, DMatrix<f64>)> {
    let settings = CalibrationSettings::default();
    let start =
        sphere(holds, gravity).ok_or_else(|| Error::NotIdentifiable(Box::new(too_few(holds, &list))))?;
    let within = pooled_sd(holds, &start, gravity);
    let (sound, of_mean) = ((0..holds.len()).collect(), Vector3::zeros());
    let (prior, conditions, settings) = (None, Conditions::default(), &settings);
    let problem = Problem { holds, sound, list, gravity, within, of_mean, prior, conditions, settings };
    let information = problem.information(&start)?;
    Ok((start, within, information))
}

/// The prior of what is known.
fn known(known: &[KnownTerm], list: &ParameterList) -> Option<Prior> {
    let of = |quantity: ImuQuantity| {
        let term = known.iter().find(|term| term.quantity == quantity);
        term.and_then(|term| Some((term.value, term.sd?.powi(-2)))).unwrap_or_default()
    };
    (!known.is_empty()).then(|| list.of_accelerometer().into_iter().map(of).unzip())
}

fn too_few(holds: &[Hold], list: &ParameterList) -> NotIdentifiable {
    NotIdentifiable { groups: vec![explain(holds, list, &[], 0)] }
}

/// Standard deviation of samples within holds, pooled over the holds, not below the rounding of the readings.
fn pooled_sd(holds: &[Hold], start: &SensorParameters, gravity: f64) -> Vector3<f64> {
    let pooled = Hold::pooled_sd(holds);
    Vector3::from_fn(|axis, _| pooled[axis].max(1e-9 * gravity * start.matrix[(axis, axis)].abs()))
}

impl Problem<'_> {
    /// Number of parameters.
    fn size(&self) -> usize {
        self.list.len()
    }

    /// Number of parameters of which something is known beforehand.
    fn priors(&self) -> usize {
        self.prior.as_ref().map_or(0, |(_, weight)| weight.iter().filter(|weight| **weight > 0.0).count())
    }

    /// Inverse variances of the prior, where there is one.
    fn prior_weight(&self) -> Option<DVector<f64>> {
        self.prior.as_ref().map(|(_, weight)| DVector::from_column_slice(weight))
    }

    /// Variance of a hold's mean, per axis.
    fn variance(&self, hold: &Hold, between: f64, sensor: &SensorParameters) -> Vector3<f64> {
        noise_variance(hold, &self.within, &self.of_mean) + between_variance(between, &sensor.matrix)
    }

    /// The least squares of these holds for a scatter between holds. `at`: the sensor whose gains count.
    fn model(
        &self,
        chosen: &[usize],
        weight: &dyn Fn(usize) -> f64,
        between: f64,
        at: &SensorParameters,
    ) -> ImuModel<'static> {
        let hold = |&j: &usize| {
            let weights = self.variance(&self.holds[j], between, at).map(|v| weight(j) / v);
            HoldData::of_accelerometer(self.holds[j].mean, Matrix3::from_diagonal(&weights))
        };
        let holds = chosen.iter().map(hold).collect();
        ImuModel::of_accelerometer(self.list.of_accelerometer(), self.gravity, holds, self.prior.clone())
    }

    /// The information that the holds give on a sensor's parameters; an error where it does not determine them all.
    fn information(&self, start: &SensorParameters) -> Result<DMatrix<f64>> {
        let holds: Vec<Hold> = self.sound.iter().map(|&j| self.holds[j].clone()).collect();
        let none = CalibrationSettings { max_iterations: 0, ..self.settings.clone() };
        let fit = fit::iterate(&self.model(&self.sound, &|_| 1.0, 0.0, start), start, &none)
            .ok_or_else(|| Error::NotIdentifiable(Box::new(too_few(&holds, &self.list))))?;
        let information = fit.information;
        let groups = information::undetermined(&information, &fit.unreduced, holds.len());
        if groups.is_empty() {
            let prior = self.prior_weight().unwrap_or_else(|| DVector::zeros(self.size()));
            return match hardly_determined(&information, &prior) {
                tangled if tangled.is_empty() => Ok(information),
                tangled => {
                    let group = explain(&holds, &self.list, &tangled, 1);
                    Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups: vec![group] })))
                }
            };
        }
        let groups = groups
            .iter()
            .map(|group| explain(&holds, &self.list, &group.parameters, group.free_combinations))
            .collect();
        Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups })))
    }

    /// The holds that are used, and the fit of these.
    fn select(&self, start: &SensorParameters) -> Result<(Vec<bool>, Weighted)> {
        if let Some(used) = &self.conditions.used {
            return Ok((used.clone(), self.weigh(used, start)?));
        }
        let is_sound: Vec<bool> = (0..self.holds.len()).map(|j| self.sound.contains(&j)).collect();
        let (used, weighted) = leave_out(
            &is_sound,
            self.first_guess(start),
            3 * self.sound.len(),
            |used, before: Option<&Weighted>| {
                self.weigh(used, before.map_or(start, |before| &before.fit.sensor))
            },
            |used, weighted| Judged {
                studentised: self.studentise(used, weighted, &self.magnitudes(weighted)),
                limit: critical(self.sound.len(), weighted.degrees as usize),
                may_leave_out: weighted.degrees > 2.0,
            },
        )?;
        self.plausible(&used, &weighted)?;
        Ok((used, weighted))
    }

    /// Do the holds look like gravity at all?
    fn plausible(&self, used: &[bool], weighted: &Weighted) -> Result<()> {
        let residuals = self.magnitude_residuals(&weighted.fit.sensor);
        let count = used.iter().filter(|used| **used).count();
        let squares: f64 = residuals.iter().zip(used).filter(|(_, used)| **used).map(|(e, _)| e * e).sum();
        let rms = (squares / count as f64).sqrt();
        let all = self.sound.len();
        let shares = 3 * count >= 2 * all;
        if shares && rms < 0.02 * self.gravity && rms.is_finite() {
            return Ok(());
        }
        let in_a_row = longest_run(self.sound.iter().map(|&j| !used[j])).map_or_else(String::new, |run| {
            let (first, last) = (&self.holds[self.sound[run.start]], &self.holds[self.sound[run.end - 1]]);
            let (start_s, end_s) = (first.start_s, last.end_s);
            format!("; those from {start_s:.1} to {end_s:.1} s do not: did the sensor change there?")
        });
        Err(Error::recording(InputError::new(
            Refusal::HoldsContradict,
            format!(
                "the holds do not look like gravity: {count} of {all} fit, with magnitudes that scatter by {:.0} mm/s²{in_a_row}",
                1e3 * rms
            ),
            "is this an accelerometer, still in each hold, in the unit that was given? Give the holds yourself with holds.intervals_s otherwise",
        )))
    }

    /// Holds that a robust fit does not find far off.
    fn first_guess(&self, start: &SensorParameters) -> Vec<bool> {
        let all = &self.sound;
        let mut weights = vec![1.0; self.holds.len()];
        let mut sensor = *start;
        let chosen = |of: &dyn Fn(usize) -> bool| -> Vec<bool> {
            (0..self.holds.len()).map(|j| all.contains(&j) && of(j)).collect()
        };
        let every = || chosen(&|_| true);
        // of few holds beside what other recordings say, some that agree with it would do
        let of_others = self.prior.is_some() && !self.settings.datasheet_prior;
        let fewest = if of_others { 2 * self.size() } else { self.size() + 3 };
        if all.len() < fewest {
            return every();
        }
        let mut scale = 0.0;
        for round in 0..ROUNDS {
            let model = self.model(all, &|j| weights[j], 0.0, &sensor);
            // the weights move on: after the first round a step or two are enough
            let max_iterations = if round == 0 { self.settings.max_iterations } else { 2 };
            let settings = CalibrationSettings { max_iterations, ..self.settings.clone() };
            let Some(fit) = fit::iterate(&model, &sensor, &settings) else { return every() };
            sensor = fit.sensor;
            let residuals = self.magnitude_residuals(&sensor);
            let mut sizes: Vec<f64> = all.iter().map(|&j| residuals[j].abs()).collect();
            let middle = sizes.len() / 2;
            let mad = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
            let correction = (all.len() as f64 / (all.len() - self.size()) as f64).sqrt();
            scale = (1.4826 * mad * correction).max(1e-12 * self.gravity);
            let mut change = 0.0_f64;
            for (weight, e) in weights.iter_mut().zip(&residuals) {
                let x = e / (BIWEIGHT * scale);
                let before = std::mem::replace(weight, (1.0 - x * x).max(0.0).powi(2).max(1e-9));
                change = change.max((*weight - before).abs());
            }
            if change < WEIGHT_TOLERANCE {
                break;
            }
        }
        let residuals = self.magnitude_residuals(&sensor);
        let good = chosen(&|j| residuals[j].abs() <= 6.0 * scale);
        if good.iter().filter(|good| **good).count() >= self.size() + 2 { good } else { every() }
    }

    /// `|C (ȳ − b)| − g` of every hold.
    fn magnitude_residuals(&self, sensor: &SensorParameters) -> Vec<f64> {
        let correction = Correction::of(sensor);
        let force = |hold: &Hold| correction.map_or(hold.mean - sensor.bias, |of| of.apply(&hold.mean));
        self.holds.iter().map(|hold| force(hold).norm() - self.gravity).collect()
    }

    /// Fits the used holds with the scatter between holds that makes χ² equal its degrees of freedom.
    fn weigh(&self, used: &[bool], start: &SensorParameters) -> Result<Weighted> {
        let chosen = chosen(used);
        let rms = |fit: &Fit| {
            let residuals = self.magnitude_residuals(&fit.sensor);
            let squares: f64 = chosen.iter().map(|&j| residuals[j].powi(2)).sum();
            (squares / chosen.len() as f64).sqrt().max(1e-12 * self.gravity)
        };
        // the gains are those of the fit without a scatter between holds, in which they are of no account
        let (mut gains_of, mut from) = (None, *start);
        let mut trial = |between: f64| {
            let model = self.model(&chosen, &|_| 1.0, between, gains_of.as_ref().unwrap_or(start));
            let fit = fit::iterate(&model, &from, self.settings)?;
            gains_of.get_or_insert(fit.sensor);
            from = fit.sensor;
            Some(Trial {
                chi2: fit.chi2 - fit.prior_chi2,
                degrees_of_freedom: self.degrees_left(chosen.len(), &fit)?,
                fitted: fit,
            })
        };
        let least = self.conditions.least_between;
        let (between, fit) = match excess(rms, &mut trial).ok_or_else(singular)? {
            (between, _) if between < least => (least, trial(least).ok_or_else(singular)?.fitted),
            found => found,
        };
        self.weighted(chosen.len(), fit, between, gains_of.unwrap_or(*start))
    }

    /// The fit of the used holds, with weights that were found without the prior.
    fn with_weights_of(&self, used: &[bool], without: &Weighted) -> Result<Weighted> {
        let chosen = chosen(used);
        let model = self.model(&chosen, &|_| 1.0, without.between, &without.gains_of);
        let fit = fit::iterate(&model, &without.fit.sensor, self.settings).ok_or_else(singular)?;
        self.weighted(chosen.len(), fit, without.between, without.gains_of)
    }

    fn weighted(&self, count: usize, fit: Fit, between: f64, gains_of: SensorParameters) -> Result<Weighted> {
        let covariance = covariance_of(&fit).ok_or_else(singular)?;
        let degrees = self.degrees_left(count, &fit).ok_or_else(singular)?;
        Ok(Weighted { fit, covariance, between, degrees, gains_of })
    }

    /// Degrees of freedom that holds leave: their number less `tr(Σ F)`, the parameters that they determine.
    fn degrees_left(&self, count: usize, fit: &Fit) -> Option<f64> {
        let left = count as f64 - self.conditions.taken;
        let Some((_, weight)) = &self.prior else { return Some(degrees_left(left, self.size(), None)) };
        let of_prior = shares_of_prior(weight, &covariance_of(fit)?);
        Some(degrees_left(left, self.size(), Some(&of_prior)))
    }

    fn magnitudes(&self, weighted: &Weighted) -> Vec<Magnitude> {
        let sensor = &weighted.fit.sensor;
        let correction = Correction::of(sensor);
        let of_hold = |hold: &Hold| {
            let s = correction.map_or(hold.mean - sensor.bias, |of| of.apply(&hold.mean));
            let magnitude = s.norm();
            let along = s / magnitude;
            let force = along * self.gravity;
            let by_reading = correction.map_or_else(Matrix3::identity, |of| of.by_reading(sensor, &force));
            let row = by_reading.tr_mul(&along); // uᵀ C
            let v = self.variance(hold, weighted.between, &weighted.gains_of);
            let quantities = self.list.quantities();
            Magnitude {
                error: magnitude - self.gravity,
                own: row.component_mul(&row).dot(&v),
                along,
                by_parameters: DVector::from_fn(self.size(), |k, _| {
                    quantities[k].derivative(sensor, &force).dot(&row)
                }),
            }
        };
        self.holds.iter().map(of_hold).collect()
    }

    /// Residual of each hold in standard deviations expected of it, its own influence removed.
    fn studentise(&self, used: &[bool], weighted: &Weighted, magnitudes: &[Magnitude]) -> Vec<f64> {
        let chi2 = weighted.fit.chi2 - weighted.fit.prior_chi2;
        let scatter = Scatter { chi2, degrees_of_freedom: weighted.degrees };
        magnitudes
            .iter()
            .zip(used)
            .map(|(Magnitude { error, own, by_parameters, .. }, &used)| {
                let from_parameters = (&weighted.covariance * by_parameters).dot(by_parameters);
                studentised(*error, (*own, from_parameters), used, scatter)
            })
            .collect()
    }

    fn summarise(&self, used: Vec<bool>, weighted: Weighted) -> Robust {
        let Weighted { fit, covariance, between, .. } = &weighted;
        let size = self.size();
        // how spread the holds are shows in the linear part: terms that bend the response look alike however the holds lie
        let is_linear = |of: &&Quantity| !matches!(of, Quantity::Nonlinear(..));
        let linear = self.list.quantities().iter().filter(is_linear).count();
        let scaled = ScaledInformation::of(&fit.information.view((0, 0), (linear, linear)).into_owned());
        let direction = scaled.weakest();
        let quantities = self.list.of_accelerometer();
        let shares: Vec<String> =
            (0..linear).filter(|&k| direction[k].powi(2) > 0.1).map(|k| quantities[k].name()).collect();
        // the directions of the fit for the holds that were used, those of the correction for the others
        let mut forces = fit::forces(self.holds.iter().map(|hold| hold.mean), &fit.sensor, self.gravity)
            .unwrap_or_else(|| vec![Vector3::zeros(); self.holds.len()]);
        for (j, force) in (0..used.len()).filter(|&j| used[j]).zip(&fit.forces) {
            forces[j] = *force;
        }
        let magnitudes = self.magnitudes(&weighted);
        Robust {
            sensor: fit.sensor,
            forces,
            studentised: self.studentise(&used, &weighted, &magnitudes),
            magnitudes,
            condition_number: scaled.condition_number(),
            weakest: shares,
            covariance: covariance.clone(),
            prior_weight: self.prior_weight(),
            chi2: fit.chi2,
            degrees_of_freedom: (chosen(&used).len() + self.priors()).saturating_sub(size),
            within_sd: self.within,
            between_holds_sd: *between,
            status: fit.status,
            iterations: fit.iterations,
            gradient_norm: fit.gradient_norm,
            used,
        }
    }
}

fn singular() -> Error {
    Error::recording(InputError::new(
        Refusal::FitFailed,
        "the fit of the holds breaks down: the estimated matrix becomes singular",
        "check the unit of the recording and that the holds are what they should be",
    ))
}

fn covariance_of(fit: &Fit) -> Option<DMatrix<f64>> {
    information::covariance(&fit.information)
}

/// Places of the holds that are used.
fn chosen(used: &[bool]) -> Vec<usize> {
    (0..used.len()).filter(|&j| used[j]).collect()
}

/// Largest studentised residual that chance explains, among so many holds.
pub(in crate::estimate) fn critical(holds: usize, degrees_of_freedom: usize) -> f64 {
    if degrees_of_freedom < 2 {
        return f64::INFINITY;
    }
    StudentsT::new(0.0, 1.0, (degrees_of_freedom - 1) as f64)
        .map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - SIGNIFICANCE / (2.0 * holds as f64)))
}

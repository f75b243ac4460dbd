//! The accelerometer from holds whose directions are known: six faces on a table, a turntable, a robot.
//!
//! `ȳ_j = S f_j + b + ε_j` with known `f_j`: linear least squares, and no gauge, since the directions are the true frame. `ε_j` is the noise of the mean and how
//! well the sensor was placed, `σ_b` in m/s² per axis, chosen so that χ² equals its degrees of freedom (Paule and Mandel).

use super::ImuProblem;
use crate::error::{Complaint, Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::estimate::excess::excess;
use crate::estimate::holds::{clipped_reason, coarse_words, left_out, magnitude_rms, with_clipped};
use crate::estimate::one_sided::one_sided;
use crate::estimate::quantisation::of_means;
use crate::estimate::{
    HoldCalibration, HoldResult, Uncalibrated, clipped_holds, coarse_axes_in, holds_between,
};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{ParameterList, Recording, SensorParameters, Triad, TriadThermal};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Faces that scatter by more than this share of gravity were not placed badly: a direction is wrong.
const SCATTERED: f64 = 0.05;
/// A scatter between faces of the usual size, m/s².
const USUAL: f64 = 0.03;

/// The accelerometer, before the joint problem.
pub(super) struct First {
    pub(super) sensor: SensorParameters,
    /// Standard deviation of a sample within holds.
    pub(super) within: Vector3<f64>,
    /// Variance of a hold's mean that more samples do not lower.
    pub(super) of_mean: Vector3<f64>,
    pub(super) holds: HoldCalibration,
    pub(super) warnings: Vec<String>,
    /// Its temperature terms, and the recording as it would be at the reference temperature, where they were fitted.
    pub(super) thermal: TriadThermal,
    pub(super) adjusted: Option<Recording>,
}

impl First {
    /// Inverse variances of a hold's mean, for a scatter between holds in m/s².
    pub(super) fn weight(&self, hold: &Hold, between: f64) -> Vector3<f64> {
        let gain = Vector3::from_fn(|axis, _| self.sensor.matrix.row(axis).norm_squared());
        let variance = self.within.component_mul(&self.within) / hold.samples() as f64
            + self.of_mean
            + gain * between.powi(2);
        variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE))
    }
}

/// Fits the accelerometer to holds of known directions.
pub(super) fn fit(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    directions: &[Vector3<f64>],
) -> Result<First> {
    let setup = &problem.setup.holds;
    let intervals = setup.intervals_s.as_deref().unwrap_or_default();
    if intervals.len() != directions.len() {
        return Err(Error::experiment(Complaint::new(
            format!("{} holds are given, and {} directions", intervals.len(), directions.len()),
            "each hold of holds.intervals_s needs one direction, in the same order",
        )));
    }
    if intervals.windows(2).any(|pair| pair[1].0 < pair[0].0) {
        return Err(Error::experiment(Complaint::new(
            "the holds are not in order of time, and each has its direction",
            "sort holds.intervals_s together with the directions",
        )));
    }
    let holds = holds_between(recording, intervals)?;
    let forces: Vec<Vector3<f64>> =
        directions.iter().map(|direction| direction.normalize() * setup.gravity.magnitude_mps2).collect();
    let list = ParameterList::new(3, problem.accelerometer.model);
    let as_read = problem.recording.accelerometer.as_ref().unwrap_or(recording);
    let clipped = clipped_holds(as_read, &holds);
    let sound = (0..holds.len()).filter(|&j| clipped[j].is_none());
    let (usable, along): (Vec<Hold>, Vec<Vector3<f64>>) =
        sound.map(|j| (holds[j].clone(), forces[j])).unzip();
    let coarse = coarse_axes_in(as_read, &usable);
    let (within, of_mean) = (Hold::pooled_sd(&usable), of_means(&coarse));
    let linear = Linear { holds: &usable, forces: &along, list: &list, within, of_mean };
    let (sensor, between, condition) =
        linear.solve().map_err(|error| with_clipped(error, &clipped, as_read))?;
    let mirrored = sensor.matrix.determinant() <= 0.0;
    if mirrored || between > SCATTERED * setup.gravity.magnitude_mps2 {
        super::mistaken::directions(problem, &holds, directions, mirrored)?;
    }
    let turned = super::mistaken::turned_alike(problem, &holds, &forces, &sensor.matrix);
    let correction = sensor.matrix.try_inverse().unwrap_or_else(Matrix3::identity);
    let results: Vec<HoldResult> = holds
        .iter()
        .zip(&forces)
        .zip(&clipped)
        .map(|((hold, force), clipped)| {
            let corrected = correction * (hold.mean - sensor.bias);
            HoldResult {
                hold: hold.clone(),
                force_mps2: *force,
                magnitude_residual_mps2: corrected.norm() - setup.gravity.magnitude_mps2,
                studentised_residual: if between > 0.0 { (corrected - force).norm() / between } else { 0.0 },
                used: clipped.is_none(),
                reason: clipped.map(|end| clipped_reason(&end, as_read)),
            }
        })
        .collect();
    let scattered = (between > SCATTERED * setup.gravity.magnitude_mps2)
        .then(|| scattered(&results, &sensor, &correction, between));
    let holds = HoldCalibration {
        magnitude_residual_rms_mps2: magnitude_rms(&results),
        degrees_of_freedom: (3 * usable.len()).saturating_sub(list.len()),
        holds: results,
        gravity: setup.gravity,
        gauge: setup.gauge,
        between_holds_sd_mps2: between,
        between_holds_dominates: between > 0.0,
        condition_number: condition,
        detected: false,
        before: Uncalibrated::accelerometer(problem.accelerometer, &sensor),
        change: None,
    };
    Ok(First {
        sensor,
        within,
        of_mean,
        warnings: turned
            .into_iter()
            .chain(left_out(&holds))
            .chain(scattered)
            .chain(coarse_words(&coarse, as_read))
            .chain(one_sided(recording, Triad::Accelerometer, &usable))
            .collect(),
        holds,
        thermal: TriadThermal::default(),
        adjusted: None,
    })
}

/// The faces that fit least, of faces that scatter too much: both of an axis, where only these tell its direction.
fn scattered(
    results: &[HoldResult],
    sensor: &SensorParameters,
    correction: &Matrix3<f64>,
    between: f64,
) -> String {
    let used = || results.iter().enumerate().filter(|(_, result)| result.used);
    let off: Vec<f64> = results
        .iter()
        .map(|result| (correction * (result.hold.mean - sensor.bias)).angle(&result.force_mps2))
        .collect();
    let most = used().map(|(k, _)| off[k]).fold(0.0, f64::max);
    let worst: Vec<String> =
        used().filter(|(k, _)| off[*k] > 0.8 * most).map(|(k, result)| result.hold.named(k)).collect();
    format!(
        "the faces scatter by {between:.2} m/s² beyond their noise; by {:.1}° and least of all fits {}: are directions and times of the holds right?",
        most.to_degrees(),
        worst.join(", or ")
    )
}

struct Linear<'a> {
    holds: &'a [Hold],
    forces: &'a [Vector3<f64>],
    list: &'a ParameterList,
    within: Vector3<f64>,
    of_mean: Vector3<f64>,
}

impl Linear<'_> {
    /// The sensor, `σ_b` and the condition number of the scaled information.
    fn solve(&self) -> Result<(SensorParameters, f64, f64)> {
        let ones = Vector3::repeat(1.0);
        let (f, _) = self.normal(0.0, &ones);
        let groups = information::undetermined(&f, &f.diagonal());
        if !groups.is_empty() {
            return Err(Error::NotIdentifiable(Box::new(self.undetermined(&groups))));
        }
        let size = self.list.len();
        let scaled = DMatrix::from_fn(size, size, |i, j| f[(i, j)] / (f[(i, i)] * f[(j, j)]).sqrt());
        let eigenvalues = scaled.symmetric_eigenvalues();
        let condition = eigenvalues.max() / eigenvalues.min().max(f64::MIN_POSITIVE);
        let singular = || {
            Error::recording(Complaint::new(
                "the fit of the faces breaks down",
                "check the directions of the holds and the unit of the recording",
            ))
        };
        let sensor = self.fit(0.0, &ones).ok_or_else(singular)?;
        let gain = Vector3::from_fn(|axis, _| sensor.matrix.row(axis).norm());
        let degrees = (3 * self.holds.len()).saturating_sub(size) as f64;
        let (between, sensor) = excess(
            degrees,
            |_| USUAL,
            |between| {
                let sensor = self.fit(between, &gain)?;
                Some((self.chi2(&sensor, between, &gain), sensor))
            },
        )
        .ok_or_else(singular)?;
        Ok((sensor, between, condition))
    }

    fn weight(&self, hold: &Hold, between: f64, gain: &Vector3<f64>) -> Vector3<f64> {
        let variance = self.within.component_mul(&self.within) / hold.samples() as f64
            + self.of_mean
            + gain.component_mul(gain) * (between * between);
        variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE))
    }

    fn normal(&self, between: f64, gain: &Vector3<f64>) -> (DMatrix<f64>, DVector<f64>) {
        let size = self.list.len();
        let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (hold, force) in self.holds.iter().zip(self.forces) {
            let weight = self.weight(hold, between, gain);
            let columns: Vec<Vector3<f64>> =
                self.list.quantities().iter().map(|quantity| quantity.derivative(force)).collect();
            for i in 0..size {
                let weighted = columns[i].component_mul(&weight);
                g[i] += weighted.dot(&hold.mean);
                for j in 0..size {
                    f[(i, j)] += weighted.dot(&columns[j]);
                }
            }
        }
        (f, g)
    }

    fn fit(&self, between: f64, gain: &Vector3<f64>) -> Option<SensorParameters> {
        let (f, g) = self.normal(between, gain);
        let values = information::covariance(&f)? * g;
        let mut sensor = SensorParameters { bias: Vector3::zeros(), matrix: Matrix3::zeros() };
        for (quantity, value) in self.list.quantities().iter().zip(values.iter()) {
            quantity.add_to(&mut sensor, *value);
        }
        Some(sensor)
    }

    fn chi2(&self, sensor: &SensorParameters, between: f64, gain: &Vector3<f64>) -> f64 {
        self.holds
            .iter()
            .zip(self.forces)
            .map(|(hold, force)| {
                let r = hold.mean - sensor.reading(force);
                r.component_mul(&r).dot(&self.weight(hold, between, gain))
            })
            .sum()
    }

    fn undetermined(&self, groups: &[information::Undetermined]) -> NotIdentifiable {
        let names = self.list.names();
        let groups = groups
            .iter()
            .map(|group| UndeterminedGroup {
                parameters: group.parameters.iter().map(|&k| format!("accelerometer.{}", names[k])).collect(),
                free_combinations: group.free_combinations,
                reason: format!("the {} directions do not span all axes, up and down", self.holds.len()),
                remedy: "hold each axis up and down: six faces".into(),
            })
            .collect();
        NotIdentifiable { groups }
    }
}

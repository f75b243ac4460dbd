//! The accelerometer from holds whose directions are known: six faces on a table, a turntable, a robot.
//!
//! `ȳ_j = S f_j + b + ε_j` with known `f_j`: linear least squares, and no gauge, since the directions are the true frame. `ε_j` is the noise of the mean and how
//! well the sensor was placed (`placing`).

use super::ImuProblem;
use super::placing::{Chi2, Degrees, Met, Placing, placing};
use crate::error::{Complaint, Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::estimate::holds::{clipped_reason, coarse_words, left_out, magnitude_rms, with_clipped};
use crate::estimate::one_sided::one_sided;
use crate::estimate::quantisation::of_means;
use crate::estimate::{
    HoldCalibration, HoldResult, Uncalibrated, clipped_holds, coarse_axes_in, holds_between,
};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{ParameterList, Quantity, Recording, SensorParameters, Triad, TriadThermal};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Faces that scatter by more than this share of gravity were not placed badly: a direction is wrong.
const SCATTERED: f64 = 0.05;
/// A face of fewer samples is a mistake of its times.
const BRIEF: usize = 10;
/// Noise of a face's mean, m/s², that none is below: readings without noise have a last digit still.
const LEAST_MPS2: f64 = 3e-8;
/// Equations along gravity that differ by less than this share are one.
const RANK: f64 = 1e-6;

/// The accelerometer, before the joint problem.
pub(super) struct First {
    pub(super) sensor: SensorParameters,
    /// Standard deviation of a sample within holds.
    pub(super) within: Vector3<f64>,
    /// Variance of a hold's mean that more samples do not lower.
    pub(super) of_mean: Vector3<f64>,
    pub(super) holds: HoldCalibration,
    /// How well the faces were met, where the directions are known.
    pub(super) met: Option<Met>,
    pub(super) warnings: Vec<String>,
    /// Its temperature terms, and the recording as it would be at the reference temperature, where they were fitted.
    pub(super) thermal: TriadThermal,
    pub(super) adjusted: Option<Recording>,
}

impl First {
    /// Inverse covariance of a hold's mean, for a scatter between holds in m/s².
    pub(super) fn weight(&self, hold: &Hold, between: f64) -> Matrix3<f64> {
        let gain = Vector3::from_fn(|axis, _| self.sensor.matrix.row(axis).norm_squared());
        let variance = of_noise(hold, &self.within, &self.of_mean) + gain * between.powi(2);
        Matrix3::from_diagonal(&variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)))
    }

    /// Inverse covariance of the mean on a face.
    pub(super) fn weight_on_face(
        &self,
        hold: &Hold,
        force: &Vector3<f64>,
        placing: &Placing,
    ) -> Matrix3<f64> {
        inverse(&of_noise(hold, &self.within, &self.of_mean), &self.sensor.matrix, &placing.covariance(force))
    }
}

/// Variance of a hold's mean by the noise in it.
fn of_noise(hold: &Hold, within: &Vector3<f64>, of_mean: &Vector3<f64>) -> Vector3<f64> {
    within.component_mul(within) / hold.samples() as f64 + of_mean
}

/// The inverse of `diag(variance) + S C Sᵀ`.
fn inverse(variance: &Vector3<f64>, s: &Matrix3<f64>, c: &Matrix3<f64>) -> Matrix3<f64> {
    let least = LEAST_MPS2.powi(2) * s.norm_squared() / 3.0;
    let variance = variance.map(|variance| variance.max(least));
    (Matrix3::from_diagonal(&variance) + s * c * s.transpose()).try_inverse().unwrap_or_else(Matrix3::zeros)
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
    let given_rad = problem.setup.face_sd_rad;
    let (mut sensor, met, condition) = match linear.solve(given_rad) {
        Ok(solved) => solved,
        Err(error) => {
            if !matches!(error, Error::NotIdentifiable(_)) {
                super::mistaken::directions(problem, &holds, directions, false)?;
            }
            return Err(with_clipped(error, &clipped, as_read));
        }
    };
    let of_tilt = met.contradiction().or_else(|| met.tilt.assumed(usable.len()));
    sensor.matrix /= met.cosine();
    let mirrored = sensor.matrix.determinant() <= 0.0;
    let shown_rad = met.shown_rad.unwrap_or(met.placing.tilt_rad);
    let is_scattered = shown_rad.max(met.placing.along_mps2 / setup.gravity.magnitude_mps2) > SCATTERED;
    if mirrored || is_scattered {
        super::mistaken::directions(problem, &holds, directions, mirrored)?;
    }
    super::mistaken::absurd(problem.accelerometer.unit, &sensor.matrix)?;
    let turned = super::mistaken::turned_alike(problem, &holds, &forces, &sensor.matrix);
    let correction = sensor.matrix.try_inverse().unwrap_or_else(Matrix3::identity);
    let results: Vec<HoldResult> = holds
        .iter()
        .zip(&forces)
        .zip(&clipped)
        .map(|((hold, force), clipped)| {
            let off = (correction * (hold.mean - sensor.bias)).norm() - setup.gravity.magnitude_mps2;
            let along = sensor.matrix * force.normalize();
            let weight = linear.weight(hold, force, &sensor.matrix, &met.placing);
            HoldResult {
                hold: hold.clone(),
                force_mps2: *force,
                magnitude_residual_mps2: off,
                studentised_residual: off * along.dot(&(weight * along)).sqrt(),
                used: clipped.is_none(),
                reason: clipped.map(|end| clipped_reason(&end, as_read)),
            }
        })
        .collect();
    let brief: Vec<String> = holds.iter().enumerate().filter_map(|(k, hold)| brief(k, hold)).collect();
    let scattered =
        is_scattered.then(|| scattered(&results, &sensor, &correction, (shown_rad, met.placing.along_mps2)));
    let holds = HoldCalibration {
        magnitude_residual_rms_mps2: magnitude_rms(&results),
        degrees_of_freedom: met.along_degrees,
        holds: results,
        gravity: setup.gravity,
        gauge: setup.gauge,
        between_holds_sd_mps2: met.placing.along_mps2,
        between_holds_dominates: met.placing.along_mps2 > 0.0,
        tilt: Some(met.tilt),
        condition_number: condition,
        detected: false,
        before: Uncalibrated::accelerometer(problem.accelerometer, &sensor),
        change: None,
    };
    Ok(First {
        sensor,
        met: Some(met),
        within,
        of_mean,
        warnings: turned
            .into_iter()
            .chain(setup.gravity.elsewhere())
            .chain(left_out(&holds))
            .chain(brief)
            .chain(scattered)
            .chain(of_tilt)
            .chain(coarse_words(&coarse, as_read))
            .chain(one_sided(recording, Triad::Accelerometer, &usable))
            .collect(),
        holds,
        thermal: TriadThermal::default(),
        adjusted: None,
    })
}

/// What is left of faces along these forces to tell their scatter, `others` further parameters estimated.
pub(super) fn degrees(forces: &[Vector3<f64>], quantities: &[Quantity], others: usize) -> Degrees {
    // along gravity, in a sensor without errors: one equation for each face
    let rows = DMatrix::from_fn(forces.len(), quantities.len(), |j, k| {
        let up = forces[j].normalize();
        up.dot(&quantities[k].derivative(&up))
    });
    let all = (3 * forces.len()).saturating_sub(quantities.len() + others);
    Degrees {
        faces: forces.len(),
        along: (forces.len() - rows.rank(RANK)).saturating_sub(others).min(all),
        all,
    }
}

/// Variance of the direction that the mean of a face shows, by noise alone, rad². `weights`: inverse covariances of the means.
pub(super) fn noise_rad2(
    weights: impl ExactSizeIterator<Item = Matrix3<f64>>,
    s: &Matrix3<f64>,
    gravity: f64,
) -> f64 {
    let count = weights.len() as f64;
    let precision: f64 = weights.map(|weight| (s.transpose() * weight * s).trace() / 3.0).sum();
    count / (precision * gravity * gravity)
}

/// What a face adds to χ²: `r` is left of its mean, `weight` the inverse covariance of that.
pub(super) fn of_face(
    r: &Vector3<f64>,
    s: &Matrix3<f64>,
    force: &Vector3<f64>,
    weight: &Matrix3<f64>,
) -> Option<Chi2> {
    let (up, to_force) = (force.normalize(), s.try_inverse()?);
    let covariance = to_force * weight.try_inverse()? * to_force.transpose();
    let along = up.dot(&(to_force * r)).powi(2) / up.dot(&(covariance * up));
    Some(Chi2 { along, all: r.dot(&(weight * r)) })
}

/// What is to be said of a face that is hardly there.
fn brief(number: usize, hold: &Hold) -> Option<String> {
    (hold.samples() < BRIEF).then(|| {
        let (named, samples) = (hold.named(number), hold.samples());
        format!("{named} has {samples} samples only: are its times right? A face is held for seconds")
    })
}

/// The faces that fit least, of faces that scatter too much: both of an axis, where only these tell its direction.
fn scattered(
    results: &[HoldResult],
    sensor: &SensorParameters,
    correction: &Matrix3<f64>,
    (tilt_rad, along_mps2): (f64, f64),
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
        "the faces scatter by {:.1}° and {:.2} m/s² along gravity beyond their noise; by {:.1}° and least of all fits {}: are directions and times of the holds right?",
        tilt_rad.to_degrees(),
        along_mps2,
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
    /// The sensor, how the faces were met, and the condition number of the scaled information.
    fn solve(&self, given_rad: Option<f64>) -> Result<(SensorParameters, Met, f64)> {
        let (one, none) = (Matrix3::identity(), Placing::default());
        let (f, _) = self.normal(&one, &none);
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
        let rough = self.fit(&one, &none).ok_or_else(singular)?.matrix;
        let degrees = degrees(self.forces, self.list.quantities(), 0);
        let gravity = self.forces.first().map_or(0.0, Vector3::norm);
        let weights =
            self.holds.iter().zip(self.forces).map(|(hold, force)| self.weight(hold, force, &rough, &none));
        let noise = noise_rad2(weights, &rough, gravity);
        let (met, sensor) = placing(degrees, given_rad, (gravity, noise), |placing| {
            let sensor = self.fit(&rough, placing)?;
            Some((self.chi2(&sensor, &rough, placing)?, sensor))
        })
        .ok_or_else(singular)?;
        Ok((sensor, met, condition))
    }

    fn weight(&self, hold: &Hold, force: &Vector3<f64>, s: &Matrix3<f64>, placing: &Placing) -> Matrix3<f64> {
        inverse(&of_noise(hold, &self.within, &self.of_mean), s, &placing.covariance(force))
    }

    fn normal(&self, s: &Matrix3<f64>, placing: &Placing) -> (DMatrix<f64>, DVector<f64>) {
        let size = self.list.len();
        let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (hold, force) in self.holds.iter().zip(self.forces) {
            let weight = self.weight(hold, force, s, placing);
            let columns: Vec<Vector3<f64>> =
                self.list.quantities().iter().map(|quantity| quantity.derivative(force)).collect();
            for i in 0..size {
                let weighted = weight * columns[i];
                g[i] += weighted.dot(&hold.mean);
                for j in 0..size {
                    f[(i, j)] += weighted.dot(&columns[j]);
                }
            }
        }
        (f, g)
    }

    fn fit(&self, s: &Matrix3<f64>, placing: &Placing) -> Option<SensorParameters> {
        let (f, g) = self.normal(s, placing);
        let values = information::covariance(&f)? * g;
        let mut sensor = SensorParameters { bias: Vector3::zeros(), matrix: Matrix3::zeros() };
        for (quantity, value) in self.list.quantities().iter().zip(values.iter()) {
            quantity.add_to(&mut sensor, *value);
        }
        Some(sensor)
    }

    fn chi2(&self, sensor: &SensorParameters, s: &Matrix3<f64>, placing: &Placing) -> Option<Chi2> {
        let of = |(hold, force): (&Hold, &Vector3<f64>)| {
            let weight = self.weight(hold, force, s, placing);
            of_face(&(hold.mean - sensor.reading(force)), s, force, &weight)
        };
        self.holds.iter().zip(self.forces).map(of).try_fold(Chi2 { along: 0.0, all: 0.0 }, |sum, of| {
            let of = of?;
            Some(Chi2 { along: sum.along + of.along, all: sum.all + of.all })
        })
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

//! The accelerometer from holds whose directions are known: six faces on a table, a turntable, a robot.
//!
//! `ȳ_j = S f_j + b + ε_j` with known `f_j`: linear least squares, and no gauge, since the directions are the true frame. Where terms bend the response, a
//! few steps of Gauss–Newton. `ε_j` is the noise of the mean and
//! the face alignment (`face_alignment`).

use crate::diagnostic::faces::{FaceBrief, FacesScatter};
use crate::diagnostic::{Diagnostic, HoldSpan};
use crate::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use crate::estimate::gravity_off_earth::gravity_off_earth;
use crate::estimate::hold_result::{HoldCalibration, HoldResult};
use crate::estimate::hold_variance::noise_variance;
use crate::estimate::holds::{
    TermsFit, clipped_holds, clipped_reason, coarse_steps, finding_of_terms, holds_between, left_out,
    magnitude_rms, with_clipped,
};
use crate::estimate::imu::checks::accelerometer_gains;
use crate::estimate::imu::checks::wrong_faces::{self, turned_faces};
use crate::estimate::imu::initial::accelerometer::{InitialAccelerometer, inverse_covariance};
use crate::estimate::imu::initial::face_alignment::{Chi2, FaceAlignment, FaceScatter, align_faces};
use crate::estimate::imu::initial::face_repeats::FaceRepeats;
use crate::estimate::imu::initial::face_statistics::{chi2_of_face, face_degrees, noise_rad2};
use crate::estimate::imu::model::{HoldData, ImuModel, Prior};
use crate::estimate::problem::FacesProblem;
use crate::estimate::quantisation::{coarse_axes_in, of_means};
use crate::estimate::uncalibrated::Uncalibrated;
use crate::information;
use crate::motion::Hold;
use crate::sensor::{
    Correction, NonlinearTerm, ParameterList, Recording, SensorModel, SensorParameters, SensorThermal,
};
use crate::solve::ScaledInformation;
use nalgebra::{Matrix3, Vector3};

/// If faces scatter by more than this share of gravity, a direction is wrong. Bad alignment does not explain it.
const WRONG_SCATTER: f64 = 0.05;

/// Fewest degrees of freedom that tell whether a term bends the response.
const FEWEST_FREE: usize = 5;

/// Fewest samples of a face. A face with fewer has wrong times.
const FEWEST_SAMPLES: usize = 10;

/// Fits the accelerometer to holds of known directions. `recording`: that of the problem, or the same at one temperature. `prior`: what is known
/// beforehand, for directions that alone do not determine it, such as one pose.
pub(crate) fn from_faces(
    problem: &FacesProblem<'_>,
    recording: &Recording,
    prior: Option<&Prior>,
) -> Result<InitialAccelerometer> {
    let (setup, directions) = (problem.holds, problem.directions);
    let intervals = setup.intervals_s.as_deref().unwrap_or_default();
    if intervals.len() != directions.len() {
        return Err(Error::experiment(InputError::new(
            Refusal::HoldsInvalid,
            format!("{} holds are given, and {} directions", intervals.len(), directions.len()),
            "each hold of holds.intervals_s, or row of a table, needs one direction, in the same order",
        )));
    }
    if intervals.windows(2).any(|pair| pair[1].0 < pair[0].0) {
        return Err(Error::experiment(InputError::new(
            Refusal::HoldsInvalid,
            "the holds are not in order of time, and each has its direction",
            "sort holds.intervals_s together with the directions",
        )));
    }
    let holds = holds_between(recording, intervals)?;
    let forces: Vec<Vector3<f64>> =
        directions.iter().map(|direction| direction.normalize() * setup.gravity.magnitude_mps2).collect();
    let list = setup.parameter_list_on_faces(problem.sensor.model);
    let as_read = problem.recording;
    let clipped = clipped_holds(as_read, &holds);
    let sound = (0..holds.len()).filter(|&j| clipped[j].is_none());
    let (usable, along): (Vec<Hold>, Vec<Vector3<f64>>) =
        sound.map(|j| (holds[j].clone(), forces[j])).unzip();
    let coarse = coarse_axes_in(as_read, &usable);
    let (within, of_mean) = (Hold::pooled_sd(&usable), of_means(&coarse));
    let gravity = setup.gravity.magnitude_mps2;
    let repeats = FaceRepeats::of(&along);
    let each: Vec<&Hold> = usable.iter().collect();
    let (means, of_means) = repeats.means(&each, &along);
    let mut faces =
        Faces { holds: &means, forces: &of_means, list, gravity, within, of_mean, prior: None, repeats };
    if let Some(rough) = faces.fit(&Matrix3::identity(), &FaceScatter::default()) {
        faces.repeats = faces.repeats.with_placement(&each, &along, &rough.matrix, (&within, &of_mean));
    }
    let solved = match (faces.solve(problem.face_sd_rad), prior) {
        (Err(Error::NotIdentifiable(_)), Some(_)) => {
            Faces { prior, ..faces.clone() }.solve(problem.face_sd_rad)
        }
        (solved, _) => solved,
    };
    let (mut sensor, alignment, condition) = match solved {
        Ok(solved) => solved,
        Err(error) => {
            if !matches!(error, Error::NotIdentifiable(_)) {
                wrong_faces::check(problem, &holds, false)?;
            }
            return Err(with_clipped(error, &clipped, as_read));
        }
    };
    let of_tilt = alignment.contradiction().or_else(|| alignment.tilt.assumed(means.len()));
    sensor.matrix /= alignment.cosine();
    let mirrored = sensor.matrix.determinant() <= 0.0;
    let shown_rad = alignment.shown_rad.unwrap_or(alignment.scatter.tilt_rad);
    let is_scattered =
        shown_rad.max(alignment.scatter.along_mps2 / setup.gravity.magnitude_mps2) > WRONG_SCATTER;
    if mirrored || is_scattered {
        wrong_faces::check(problem, &holds, mirrored)?;
    }
    accelerometer_gains::check(problem.sensor.unit, &sensor.matrix)?;
    let bent = finding_of_terms(&setup.nonlinearity, |terms| {
        faces.with_terms(problem.sensor.model, terms, &sensor, &alignment.scatter)
    });
    let turned = turned_faces(problem, &holds, &sensor.matrix);
    let correction = Correction::of(&sensor);
    let corrected = |hold: &Hold| correction.map_or(hold.mean - sensor.bias, |of| of.apply(&hold.mean));
    let results: Vec<HoldResult> = holds
        .iter()
        .zip(&forces)
        .zip(&clipped)
        .map(|((hold, force), clipped)| {
            let off = corrected(hold).norm() - setup.gravity.magnitude_mps2;
            let along = sensor.by_stimulus(force) * force.normalize();
            let noise = noise_variance(hold, &within, &of_mean);
            let covariance = alignment.of_hold().covariance(force);
            let weight = inverse_covariance(&noise, &sensor.by_stimulus(force), &covariance);
            let precision = along.dot(&(weight * along)).sqrt();
            HoldResult {
                hold: hold.clone(),
                force_mps2: *force,
                magnitude_residual_mps2: off,
                magnitude_sd_mps2: precision.recip(),
                studentised_residual: off * precision,
                used: clipped.is_none(),
                reason: clipped.map(|end| clipped_reason(&end, as_read)),
            }
        })
        .collect();
    let brief: Vec<Diagnostic> = holds.iter().enumerate().filter_map(|(k, hold)| brief(k, hold)).collect();
    let scattered =
        is_scattered.then(|| scattered(&results, corrected, (shown_rad, alignment.scatter.along_mps2)));
    let holds = HoldCalibration {
        magnitude_residual_rms_mps2: magnitude_rms(&results),
        degrees_of_freedom: alignment.along_degrees,
        holds: results,
        gravity: setup.gravity,
        gauge: setup.gauge,
        between_holds_sd_mps2: alignment.scatter.along_mps2,
        drift: None,
        recording_biases: None,
        between_holds_dominates: alignment.scatter.along_mps2 > 0.0,
        tilt: Some(alignment.tilt),
        condition_number: condition,
        detected: !setup.times_are_given(),
        before: Uncalibrated::accelerometer(problem.sensor, &sensor),
        temperatures_c: None,
        thermometer: None,
        change: None,
    };
    Ok(InitialAccelerometer {
        sensor,
        alignment: Some(alignment),
        repeats: faces.repeats,
        within,
        of_mean,
        warnings: turned
            .into_iter()
            .chain(gravity_off_earth(&setup.gravity))
            .chain(left_out(&holds))
            .chain(brief)
            .chain(scattered)
            .chain(of_tilt)
            .chain(bent)
            .chain(coarse_steps(&coarse, as_read))
            .collect(),
        holds,
        thermal: SensorThermal::default(),
        adjusted: None,
    })
}

/// The warning about a face with few samples.
fn brief(number: usize, hold: &Hold) -> Option<Diagnostic> {
    let brief = Diagnostic::from(FaceBrief { hold: HoldSpan::of(number, hold), samples: hold.samples() });
    // one is a mean
    (2..FEWEST_SAMPLES).contains(&hold.samples()).then_some(brief)
}

/// The faces with the largest residuals. If only two faces determine the direction of an axis, both are named.
fn scattered(
    results: &[HoldResult],
    corrected: impl Fn(&Hold) -> Vector3<f64>,
    (tilt_rad, along_mps2): (f64, f64),
) -> Diagnostic {
    let used = || results.iter().enumerate().filter(|(_, result)| result.used);
    let off: Vec<f64> =
        results.iter().map(|result| corrected(&result.hold).angle(&result.force_mps2)).collect();
    let most = used().map(|(k, _)| off[k]).fold(0.0, f64::max);
    let is_worst = |(k, _): &(usize, &HoldResult)| off[*k] > 0.8 * most;
    let worst = used().filter(is_worst).map(|(k, result)| HoldSpan::of(k, &result.hold)).collect();
    Diagnostic::from(FacesScatter { tilt_rad, along_mps2, worst_rad: most, worst })
}

/// The mean of each face.
#[derive(Clone)]
struct Faces<'a> {
    holds: &'a [Hold],
    forces: &'a [Vector3<f64>],
    list: ParameterList,
    gravity: f64,
    within: Vector3<f64>,
    of_mean: Vector3<f64>,
    prior: Option<&'a Prior>,
    repeats: FaceRepeats,
}

impl Faces<'_> {
    /// The sensor, the face alignment, and the condition number of the scaled information.
    fn solve(&self, given_rad: Option<f64>) -> Result<(SensorParameters, FaceAlignment, f64)> {
        let (one, none) = (Matrix3::identity(), FaceScatter::default());
        let singular = || {
            Error::recording(InputError::new(
                Refusal::FitFailed,
                "the fit of the faces breaks down",
                "check the directions of the holds and the unit of the recording",
            ))
        };
        let ideal = SensorParameters::identity();
        let f = self.model(&one, &none).information_on_faces(&ideal).ok_or_else(singular)?;
        let groups = information::undetermined(&f, &f.diagonal(), 0);
        if !groups.is_empty() {
            return Err(Error::NotIdentifiable(Box::new(self.undetermined(&groups))));
        }
        let condition = ScaledInformation::of(&f).condition_number();
        let rough = self.fit(&one, &none).ok_or_else(singular)?.matrix;
        let degrees = face_degrees(self.forces, self.list.quantities(), 0);
        let weights =
            self.holds.iter().zip(self.forces).map(|(hold, force)| self.weight(hold, force, &rough, &none));
        let noise = noise_rad2(weights, &rough, self.gravity);
        let placement_rad2 = self.repeats.placement_rad2;
        let fixed_rad = given_rad.map(|given| (given * given - placement_rad2).max(0.0).sqrt());
        let (alignment, sensor) = align_faces(degrees, fixed_rad, (self.gravity, noise), |scatter| {
            let sensor = self.fit(&rough, scatter)?;
            Some((self.chi2(&sensor, &rough, scatter)?, sensor))
        })
        .ok_or_else(singular)?;
        Ok((sensor, alignment.with_placement(placement_rad2, given_rad), condition))
    }

    /// The fit with other terms, the weights those of this sensor. `None` where the faces do not determine it.
    fn with_terms(
        &self,
        model: SensorModel,
        terms: &[NonlinearTerm],
        sensor: &SensorParameters,
        scatter: &FaceScatter,
    ) -> Option<TermsFit> {
        let list = ParameterList::new(3, model).with_terms(terms);
        let free = (3 * self.holds.len()).checked_sub(list.len() + FEWEST_FREE)? + FEWEST_FREE;
        let with = Self { list, ..self.clone() };
        let f = with.model(&sensor.matrix, scatter).information_on_faces(&SensorParameters::identity())?;
        if !information::undetermined(&f, &f.diagonal(), 0).is_empty() {
            return None;
        }
        let found = with.fit(&sensor.matrix, scatter)?;
        let without = self.model(&sensor.matrix, scatter).information_on_faces(sensor)?;
        let covariance = information::covariance(&without)?;
        Some(TermsFit {
            biases: found.bias.component_div(&Vector3::from_fn(|axis, _| covariance[(axis, axis)].sqrt())),
            coefficients: terms.last().map_or_else(Vector3::zeros, |term| *found.nonlinearity.of(*term)),
            chi2: with.chi2(&found, &sensor.matrix, scatter)?.all,
            free: free as f64,
        })
    }

    fn weight(
        &self,
        hold: &Hold,
        force: &Vector3<f64>,
        s: &Matrix3<f64>,
        scatter: &FaceScatter,
    ) -> Matrix3<f64> {
        let noise = noise_variance(hold, &self.within, &self.of_mean);
        inverse_covariance(&noise, s, &self.repeats.of_face(scatter, force))
    }

    /// The least squares. `s`: the matrix by which tilts move the readings.
    fn model(&self, s: &Matrix3<f64>, scatter: &FaceScatter) -> ImuModel<'static> {
        let on_face = |(hold, force): (&Hold, &Vector3<f64>)| {
            HoldData::on_face(hold.mean, self.weight(hold, force, s, scatter), *force)
        };
        let holds = self.holds.iter().zip(self.forces).map(on_face).collect();
        ImuModel::of_accelerometer(self.list.of_accelerometer(), self.gravity, holds, self.prior.cloned())
    }

    fn fit(&self, s: &Matrix3<f64>, scatter: &FaceScatter) -> Option<SensorParameters> {
        self.model(s, scatter).sensor_on_faces()
    }

    fn chi2(&self, sensor: &SensorParameters, s: &Matrix3<f64>, scatter: &FaceScatter) -> Option<Chi2> {
        let of = |(hold, force): (&Hold, &Vector3<f64>)| {
            let weight = self.weight(hold, force, s, scatter);
            chi2_of_face(&(hold.mean - sensor.reading(force)), s, force, &weight)
        };
        self.holds.iter().zip(self.forces).map(of).try_fold(Chi2 { along: 0.0, all: 0.0 }, |sum, of| {
            let of = of?;
            Some(Chi2 { along: sum.along + of.along, all: sum.all + of.all })
        })
    }

    fn undetermined(&self, groups: &[information::Undetermined]) -> NotIdentifiable {
        let names = self.list.names_in_results();
        let groups = groups
            .iter()
            .map(|group| UndeterminedGroup {
                parameters: group.parameters.iter().map(|&k| names[k].clone()).collect(),
                free_combinations: group.free_combinations,
                reason: format!("the {} directions do not span all axes, up and down", self.holds.len()),
                remedy: "hold each axis up and down: six faces; or state the gains: with prior = \"datasheet\" in [calibrate] one pose gives the bias"
                    .into(),
            })
            .collect();
        NotIdentifiable { groups }
    }
}

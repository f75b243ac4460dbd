//! What the holds tell so far: the same calibration as that of a recording, of the samples in memory.

use crate::advice::{NextPose, faces, first_poses, is_on, next_pose};
use crate::goals::Goals;
use calibrant::session::{Session, Source};
use calibrant_core::diagnostic::{Diagnostic, Severity, Usability};
use calibrant_core::error::Error;
use calibrant_core::estimate::{CovarianceVerdict, VarianceSource};
use calibrant_core::sensor::{
    ImuQuantity, ImuRecording, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use nalgebra::Vector3;
use std::time::{Duration, Instant};

/// What is asked.
pub(crate) struct Question {
    pub(crate) number: u64,
    /// Does it follow a hold that is new?
    pub(crate) of_new_hold: bool,
    pub(crate) recording: ImuRecording,
    /// Holds by the gate: begin, end, and which way was up, where that is known.
    pub(crate) held: Vec<(f64, f64, Option<Vector3<f64>>)>,
    pub(crate) asked: Instant,
    /// Of the readings.
    pub(crate) units: [ReadingUnit; 2],
    pub(crate) now: Option<Vector3<f64>>,
    pub(crate) put_off: Vec<Vector3<f64>>,
}

/// A parameter so far.
#[derive(Debug, Clone)]
pub(crate) struct Known {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
    pub(crate) sd: f64,
    pub(crate) goal: Option<f64>,
    /// What gravity that is not exactly known, and faces that are not exactly level, leave of it.
    pub(crate) floor: f64,
    /// Are it the faces that leave most of that?
    pub(crate) floor_is_of_faces: bool,
    /// Standard deviation after the next pose.
    pub(crate) after: Option<f64>,
}

impl Known {
    /// The standard deviation without what gravity and faces leave.
    fn sd_beside_floor(&self) -> f64 {
        (self.sd.powi(2) - self.floor.powi(2)).max(0.0).sqrt()
    }

    /// The standard deviation over its goal.
    pub(crate) fn ratio(&self) -> Option<f64> {
        Some(self.sd / self.goal?)
    }
}

/// A hold so far.
#[derive(Debug, Clone)]
pub(crate) struct KnownHold {
    pub(crate) start_s: f64,
    pub(crate) end_s: f64,
    pub(crate) up: Vector3<f64>,
    /// Why it is not used.
    pub(crate) left_out: Option<String>,
}

/// What the holds tell.
#[derive(Debug, Clone, Default)]
pub(crate) struct Estimate {
    /// Of the question.
    pub(crate) number: u64,
    pub(crate) of_new_hold: bool,
    pub(crate) parameters: Vec<Known>,
    pub(crate) holds: Vec<KnownHold>,
    pub(crate) accelerometer: Option<SensorParameters>,
    pub(crate) usability: Option<Usability>,
    pub(crate) warnings: Vec<String>,
    /// Do folds agree? Asked where all goals are reached.
    pub(crate) folds_agree: Option<bool>,
    pub(crate) next: Option<NextPose>,
    /// How many of the faces were held, and how many there are, where these are known.
    pub(crate) faces: Option<(usize, usize)>,
    /// Why there is no calibration yet.
    pub(crate) missing: Option<String>,
}

impl Estimate {
    /// Are all goals reached, and was each known face held?
    pub(crate) fn reaches_all(&self) -> bool {
        let mut ratios = self.parameters.iter().filter_map(Known::ratio);
        !self.parameters.is_empty()
            && self.faces.is_none_or(|(held, all)| held == all)
            && ratios.all(|ratio| ratio <= 1.0)
    }

    /// The largest standard deviation over its goal, without what gravity leaves.
    pub(crate) fn worst_ratio(&self) -> Option<f64> {
        let ratios = self.parameters.iter().filter_map(|of| Some(of.sd_beside_floor() / of.goal?));
        ratios.reduce(f64::max)
    }
}

/// An answer, in two parts.
pub(crate) enum Answer {
    /// Number of the question, the parameters so far, and how long they took.
    First(u64, Vec<Known>, Duration),
    /// All of it.
    Whole(Box<Estimate>),
}

/// Estimates.
pub(crate) struct Estimator<'s> {
    pub(crate) session: &'s Session,
    pub(crate) with_folds: &'s Session,
    pub(crate) goals: &'s Goals,
}

impl Estimator<'_> {
    /// The calibration of the samples so far, and what to do next. `first` gets the parameters early: the next pose and the folds take longer.
    pub(crate) fn answer(&self, mut question: Question, first: impl FnOnce(Answer)) -> Estimate {
        let recording = std::mem::take(&mut question.recording);
        let source = Source::from_recording("recording.csv", recording);
        let outcome = match self.session.calibrate(&source) {
            Ok(outcome) => outcome,
            Err(error) => {
                let held: Vec<Vector3<f64>> = question.held.iter().filter_map(|(.., up)| *up).collect();
                let next =
                    first_poses(self.session.experiment(), question.held.len(), &held, &question.put_off);
                let known = |(start_s, end_s, up): &(f64, f64, Option<Vector3<f64>>)| {
                    Some(KnownHold { start_s: *start_s, end_s: *end_s, up: (*up)?, left_out: None })
                };
                let holds: Vec<KnownHold> = question.held.iter().filter_map(known).collect();
                // another error is said, whatever was held
                let is_early = matches!(error, Error::NotIdentifiable(_));
                let faces = if is_early { self.faces_held(&holds) } else { None };
                let of_new_hold = question.of_new_hold;
                return Estimate {
                    number: question.number,
                    of_new_hold,
                    holds,
                    next,
                    faces,
                    missing: Some(missing(&error, question.held.len())),
                    ..Estimate::default()
                };
            }
        };
        let calibration = outcome.calibration();
        let sds = calibration.covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let imu = &calibration.imu;
        let gravity_sd = calibration.holds().map_or(0.0, |holds| holds.gravity.sd_mps2);
        let mut parameters: Vec<Known> = Vec::new();
        for (k, quantity) in calibration.quantities.iter().enumerate() {
            let name = quantity.name();
            let by_gravity = calibration.gravity_slope.get(k).map_or(0.0, |slope| (slope * gravity_sd).abs());
            let of_faces =
                calibration.budget.get(k).map_or(0.0, |row| row.part(VarianceSource::FaceAlignment));
            let by_faces = of_faces.max(0.0).sqrt();
            let floor = by_gravity.hypot(by_faces);
            parameters.push(Known {
                goal: self.goals.of(*quantity, imu, question.units[quantity.sensor_kind() as usize], floor),
                floor,
                floor_is_of_faces: by_faces > by_gravity,
                unit: calibration.unit_of(*quantity),
                value: quantity.value(imu),
                sd: sds[k],
                after: None,
                name,
            });
        }
        first(Answer::First(question.number, parameters.clone(), question.asked.elapsed()));
        let next = next_pose(
            self.session.experiment(),
            calibration,
            question.now,
            &question.put_off,
            weakest_axis(&calibration.quantities, &parameters),
        );
        let rotations = calibration.used_rotations().count() as f64;
        for known in &mut parameters {
            let by_pose = next.as_ref().and_then(|next| next.after.get(&known.name)).copied();
            let beside = known.sd_beside_floor();
            // one rotation more, whatever its axis
            let by_rotation =
                known.name.starts_with("gyroscope").then(|| (rotations / (rotations + 1.0)).sqrt());
            known.after = by_pose.or(by_rotation).map(|ratio| (ratio * beside).hypot(known.floor));
        }
        let holds: Vec<KnownHold> = calibration
            .hold_results()
            .iter()
            .map(|hold| KnownHold {
                start_s: hold.hold.start_s,
                end_s: hold.hold.end_s,
                up: hold.force_mps2.try_normalize(0.0).unwrap_or_else(Vector3::z),
                left_out: hold.why_left_out().map(|why| why.to_string()),
            })
            .collect();
        let told = |severity: Severity| -> Vec<String> {
            let these = outcome.warnings().iter().filter(|found| found.severity() >= severity);
            these.map(Diagnostic::without_file).collect()
        };
        let mut estimate = Estimate {
            number: question.number,
            of_new_hold: question.of_new_hold,
            faces: self.faces_held(&holds),
            holds,
            accelerometer: Some(*imu.sensor(SensorKind::Accelerometer)),
            usability: Some(outcome.verdict().usability),
            warnings: told(Severity::Warning),
            next,
            parameters,
            ..Estimate::default()
        };
        if estimate.reaches_all() && estimate.of_new_hold && estimate.faces.is_none() {
            let folds = self.with_folds.calibrate(&source).ok();
            estimate.folds_agree = folds.map(|of| {
                let too_small = |kind: CovarianceVerdict| kind == CovarianceVerdict::TooSmall;
                !of.validations.iter().flat_map(|of| &of.kinds).any(|kind| too_small(kind.verdict))
            });
        }
        estimate
    }

    /// How many of the known directions have a hold that counts, and how many there are.
    fn faces_held(&self, holds: &[KnownHold]) -> Option<(usize, usize)> {
        let faces = faces(self.session.experiment())?;
        let has_hold =
            |face: &&Vector3<f64>| holds.iter().any(|hold| hold.left_out.is_none() && is_on(face, &hold.up));
        Some((faces.iter().filter(has_hold).count(), faces.len()))
    }
}

/// Holds that mostly determine a sensor.
const USUALLY: usize = 14;

/// Why there is no calibration yet: mostly since there are too few holds.
fn missing(error: &Error, holds: usize) -> String {
    match error {
        Error::NotIdentifiable(_) if holds < USUALLY => {
            "hold it in other orientations, each axis up, down and between".to_owned()
        }
        other => other.to_string(),
    }
}

/// The axis whose gain is known least of the gyroscope's.
fn weakest_axis(quantities: &[ImuQuantity], parameters: &[Known]) -> Option<Vector3<f64>> {
    let of = quantities.iter().zip(parameters).filter_map(|(quantity, known)| match quantity {
        ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(axis)) => Some((axis.index(), known.sd)),
        _ => None,
    });
    let (axis, _) = of.max_by(|one, other| one.1.total_cmp(&other.1))?;
    Some(Vector3::from_fn(|k, _| f64::from(u8::from(k == axis))))
}

//! The initial temperature terms of the accelerometer.
//!
//! The static fit of the holds has no temperature terms. A drift would count as scatter between holds, or as outliers. So these terms are fitted first, with
//! the accelerometer alone. The between-hold variance is estimated with them (`paule1982`, degrees of freedom less these terms). The static fit then uses the
//! recording converted to the reference temperature, and finds the outliers.

use crate::error::Result;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::holds::{critical, left_out, magnitude_rms};
use crate::estimate::imu::checks::identifiability;
use crate::estimate::imu::estimated::{estimated_quantities, prior_of, set_fixed};
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::initial::face_alignment::{Chi2, Degrees, FaceAlignment, FaceScatter, align_faces};
use crate::estimate::imu::initial::face_statistics::{chi2_of_face, face_degrees, noise_rad2};
use crate::estimate::imu::model::{Fit, HoldData, ImuModel, State, singular};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::temperature::{RecordingTemperature, at_reference};
use crate::estimate::imu::terms::sums::degrees_of_freedom;
use crate::estimate::imu::terms::term::At;
use crate::estimate::settings::CalibrationSettings;
use crate::motion::Hold;
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, Recording, SensorKind};
use crate::solve::{Trial, excess};
use nalgebra::{Matrix3, Vector3};

/// Largest number of rounds, which estimate terms and outliers in turn.
const ROUNDS: usize = 5;

/// The accelerometer with its temperature terms, beginning with a fit without them. `refit` is that fit with another recording and the times of its holds.
pub(crate) fn with_temperature_terms(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    first: InitialAccelerometer,
    temperature: &RecordingTemperature<'_>,
    settings: &CalibrationSettings,
    refit: impl Fn(&Recording, Vec<(f64, f64)>) -> Result<InitialAccelerometer>,
) -> Result<InitialAccelerometer> {
    let follows =
        problem.setup.thermal.quantities().iter().any(|q| q.sensor_kind() == SensorKind::Accelerometer);
    if !follows {
        return Ok(first);
    }
    let raw: Vec<Hold> = first.holds.holds.iter().map(|result| result.hold.clone()).collect();
    let intervals: Vec<(f64, f64)> = raw.iter().map(|hold| (hold.start_s, hold.end_s)).collect();
    let detected = first.holds.detected;
    let mut first = first;
    let mut used: Vec<bool> = first.holds.holds.iter().map(|result| result.reason.is_none()).collect();
    for _ in 0..ROUNDS {
        let alone = AccelerometerOnly::new(problem, &first, &raw, &used, temperature);
        let (state, scatter) = alone.fit(settings)?;
        let thermal = state.imu.thermal;
        let adjusted = at_reference(
            recording,
            SensorKind::Accelerometer,
            &state.imu[SensorKind::Accelerometer],
            &thermal,
            temperature,
        );
        let mut next = refit(&adjusted, intervals.clone())?;
        let left_out_before = left_out(&next.holds);
        reconsider(&mut next.holds, alone.degrees(), alone.terms());
        next.warnings.retain(|warning| !left_out_before.contains(warning));
        next.warnings.splice(0..0, left_out(&next.holds));
        let between = match scatter {
            Scatter::OfMagnitudes(between) => between,
            Scatter::OfFaces(alignment) => {
                next.alignment = Some(alignment);
                // the tilt is that of a hold: all of it may be the face's
                next.repeats.placement_rad2 = 0.0;
                next.holds.tilt = Some(alignment.tilt);
                next.holds.degrees_of_freedom = alignment.along_degrees;
                alignment.scatter.along_mps2
            }
        };
        next.holds.between_holds_sd_mps2 = between;
        next.holds.between_holds_dominates = between > 0.0;
        next.holds.detected = detected;
        next.thermal = thermal[SensorKind::Accelerometer];
        next.adjusted = Some(adjusted);
        first = next;
        let chosen: Vec<bool> = first.holds.holds.iter().map(|result| result.used).collect();
        if chosen == used {
            break;
        }
        used = chosen;
    }
    for (result, hold) in first.holds.holds.iter_mut().zip(raw) {
        result.hold = hold;
    }
    Ok(first)
}

/// The outliers, with the degrees of freedom that the temperature terms take. The static fit does not count these, and its residuals look too large.
fn reconsider(holds: &mut HoldCalibration, degrees: usize, terms: usize) {
    let shrink = (degrees as f64 / (degrees + terms).max(1) as f64).sqrt();
    let limit = critical(holds.holds.len(), degrees);
    for result in &mut holds.holds {
        result.studentised_residual *= shrink;
        result.magnitude_sd_mps2 /= shrink;
        result.used |= result.reason.is_none() && result.studentised_residual.abs() <= limit;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
}

/// The between-hold scatter.
enum Scatter {
    /// Their magnitudes, m/s².
    OfMagnitudes(f64),
    OfFaces(FaceAlignment),
}

/// The accelerometer alone, with its temperature terms.
struct AccelerometerOnly<'a> {
    first: &'a InitialAccelerometer,
    face_sd_rad: Option<f64>,
    raw: Vec<&'a Hold>,
    model: ImuModel<'static>,
    start: State,
}

impl<'a> AccelerometerOnly<'a> {
    fn new(
        problem: &ImuProblem<'_>,
        first: &'a InitialAccelerometer,
        raw: &'a [Hold],
        used: &[bool],
        temperature: &RecordingTemperature<'_>,
    ) -> Self {
        let chosen: Vec<usize> = (0..raw.len()).filter(|&j| used[j]).collect();
        let known = problem.setup.directions.is_some();
        let mut quantities = estimated_quantities(problem);
        quantities.retain(|quantity| quantity.sensor_kind() == SensorKind::Accelerometer);
        let forces: Vec<Vector3<f64>> = chosen.iter().map(|&j| first.holds.holds[j].force_mps2).collect();
        let holds = chosen
            .iter()
            .zip(&forces)
            .map(|(&j, force)| HoldData {
                known: known.then_some(*force),
                temperature_c: temperature.of_hold(&raw[j]),
                ..HoldData::of_accelerometer(raw[j].mean, Matrix3::zeros())
            })
            .collect();
        let prior = prior_of(problem, &quantities);
        let mut imu = ImuParameters {
            thermal: temperature.start,
            ..ImuParameters::identity().with(SensorKind::Accelerometer, first.sensor)
        };
        imu.thermal[SensorKind::Accelerometer] = if first.adjusted.is_some() {
            first.thermal
        } else {
            temperature.start[SensorKind::Accelerometer]
        };
        set_fixed(&mut imu, problem.setup);
        Self {
            first,
            face_sd_rad: problem.setup.face_sd_rad,
            raw: chosen.iter().map(|&j| &raw[j]).collect(),
            model: ImuModel::of_accelerometer(
                quantities,
                problem.setup.holds.gravity.magnitude_mps2,
                holds,
                prior,
            ),
            start: State { imu, forces },
        }
    }

    /// Number of temperature terms that are estimated.
    fn terms(&self) -> usize {
        self.model.quantities.iter().filter(|quantity| matches!(quantity, ImuQuantity::Thermal(..))).count()
    }

    /// Residuals and priors less unknowns.
    fn degrees(&self) -> usize {
        degrees_of_freedom(&At { model: &self.model, state: &self.start, rotations: &[] })
    }

    /// Degrees of freedom of the scatter of known faces.
    fn degrees_of_all_faces(&self) -> Degrees {
        let of = |quantity: &ImuQuantity| match quantity {
            ImuQuantity::Of(_, of) => Some(*of),
            _ => None,
        };
        let quantities: Vec<Quantity> = self.model.quantities.iter().filter_map(of).collect();
        let others = self.model.quantities.len() - quantities.len();
        face_degrees(&self.start.forces, &quantities, others.saturating_sub(self.model.priors()))
    }

    /// The problem for given weights of the holds.
    fn weighed(&self, weight: impl Fn(&Hold, &Vector3<f64>) -> Matrix3<f64>) -> ImuModel<'static> {
        let mut model = self.model.clone();
        for ((hold, raw), force) in model.holds.iter_mut().zip(&self.raw).zip(&self.start.forces) {
            hold.accelerometer_weight = weight(raw, force);
        }
        model
    }

    /// The fit, and the scatter between holds that makes χ² equal its degrees of freedom.
    fn fit(&self, settings: &CalibrationSettings) -> Result<(State, Scatter)> {
        let mut from = self.start.clone();
        let mut fit = |weighed: &ImuModel<'_>| {
            let fit = weighed.fit(from.clone(), weighed.gravity_residuals(&from)?, settings)?;
            from = fit.state.clone();
            Some(fit)
        };
        if let Some(rough) = &self.first.alignment {
            let on_faces = |scatter: &FaceScatter| {
                self.weighed(|hold, force| self.first.weight_by(hold, force, &scatter.covariance(force)))
            };
            let model = on_faces(&rough.scatter);
            identifiability::check(&model, &self.start, &model.linearised(&self.start, settings)?)?;
            let weights = on_faces(&FaceScatter::default()).holds;
            let weights = weights.iter().map(|hold| hold.accelerometer_weight);
            let noise = noise_rad2(weights, &self.first.sensor.matrix, self.model.gravity);
            let (alignment, state) = align_faces(
                self.degrees_of_all_faces(),
                self.face_sd_rad,
                (self.model.gravity, noise),
                |scatter| {
                    let weighed = on_faces(scatter);
                    let fit = fit(&weighed)?;
                    Some((self.chi2_of_faces(&weighed, &fit)?, fit.state))
                },
            )
            .ok_or_else(singular)?;
            return Ok((state, Scatter::OfFaces(alignment)));
        }
        let rough = self.first.holds.between_holds_sd_mps2;
        let of_magnitudes = |between: f64| self.weighed(|hold, _| self.first.weight(hold, between));
        let model = of_magnitudes(rough);
        identifiability::check(&model, &self.start, &model.linearised(&self.start, settings)?)?;
        let degrees_of_freedom = self.degrees() as f64;
        let trial = |fit: Fit| Trial { chi2: fit.chi2, degrees_of_freedom, fitted: fit.state };
        let (between, state) = excess(
            |_| rough.max(1e-9 * self.model.gravity),
            |between| fit(&of_magnitudes(between)).map(trial),
        )
        .ok_or_else(singular)?;
        Ok((state, Scatter::OfMagnitudes(between)))
    }

    /// χ² of the faces, priors included.
    fn chi2_of_faces(&self, weighed: &ImuModel<'_>, fit: &Fit) -> Option<Chi2> {
        let along = weighed.holds.iter().zip(&fit.state.forces).map(|(hold, force)| {
            let r = hold.accelerometer
                - fit.state.imu.at(hold.temperature_c)[SensorKind::Accelerometer].reading(force);
            let s = &self.first.sensor.matrix;
            chi2_of_face(&r, s, force, &hold.accelerometer_weight).map(|of| of.along)
        });
        Some(Chi2 { along: along.sum::<Option<f64>>()?, all: fit.chi2 })
    }
}

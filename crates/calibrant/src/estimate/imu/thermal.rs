//! Temperature: what is asked to follow it, the temperatures of the holds, and the accelerometer's first fit with them.
//!
//! The static fit of the holds knows no temperature, so that a drift would count as scatter between holds, or as bad holds. Where terms of the accelerometer
//! are asked for, they are therefore fitted first, with the accelerometer alone, and the scatter between holds with them (Paule and Mandel, degrees of
//! freedom less these terms). The static fit is then made with the recording as it would be at the reference temperature: it tells the bad holds.

use super::earth::Earth;
use super::faces::{self, First};
use super::joint::{Fit, HoldData, Joint, State};
use super::placing::{Chi2, Degrees, Met, Placing, placing};
use super::solver::{self, singular};
use super::still::StillNoise;
use super::{ImuProblem, KnownTerm};
use crate::error::{Complaint, Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::estimate::excess::excess;
use crate::estimate::holds::{critical, left_out, magnitude_rms};
use crate::estimate::{CalibrationSettings, HoldCalibration};
use crate::motion::Hold;
use crate::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, Quantity, Recording, SensorParameters, Temperatures, Thermal,
    ThermalTerm, Triad,
};
use nalgebra::{Matrix3, Vector3};

/// Temperatures of holds count as different from here on, K: closer ones are noise and rounding of a thermometer.
const LEVEL_K: f64 = 0.5;
/// Rounds of terms and bad holds in turn.
const ROUNDS: usize = 5;

/// What is to follow temperature: orders of the polynomials, 0 where nothing follows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ThermalModel {
    /// The reference `T₀`, °C; the mean over the holds, to the degree, where it is not given.
    pub reference_c: Option<f64>,
    /// Order of the accelerometer's bias, to 2.
    pub accelerometer_bias: usize,
    /// Order of the accelerometer's gains.
    pub accelerometer_scale: usize,
    /// Order of the gyroscope's bias.
    pub gyroscope_bias: usize,
    /// Order of the gyroscope's gains.
    pub gyroscope_scale: usize,
}

impl ThermalModel {
    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.quantities().is_empty()
    }

    /// The terms, in the order of a result.
    #[must_use]
    pub fn quantities(&self) -> Vec<ImuQuantity> {
        let mut list = ImuQuantity::thermal_list(
            Triad::Accelerometer,
            self.accelerometer_bias,
            self.accelerometer_scale,
        );
        list.extend(ImuQuantity::thermal_list(Triad::Gyroscope, self.gyroscope_bias, self.gyroscope_scale));
        list
    }
}

/// The temperatures of a recording of which something follows them.
pub(in crate::estimate) fn needed_temperatures(recording: &ImuRecording) -> Result<Temperatures<'_>> {
    Temperatures::of(recording)?.ok_or_else(|| {
        Error::recording(Complaint::new(
            "the calibration is to follow temperature, and the recording has none",
            "name its column with temperature = \"…\" in [columns], or take [temperature] out of the experiment",
        ))
    })
}

/// The temperatures of a problem in which something follows them.
pub(super) struct Climate<'a> {
    temperatures: Option<Temperatures<'a>>,
    /// Nothing but the fixed terms.
    pub(super) start: Thermal,
}

impl<'a> Climate<'a> {
    /// That of a problem with these holds: where nothing follows temperature, it is the reference always.
    pub(super) fn of(problem: &ImuProblem<'a>, holds: &[Hold]) -> Result<Self> {
        let model = problem.setup.thermal;
        let mut start = Thermal::none();
        if model.is_none() {
            return Ok(Self { temperatures: None, start });
        }
        let temperatures = needed_temperatures(problem.recording)?;
        let of_holds: Vec<f64> =
            holds.iter().map(|hold| temperatures.mean(hold.start_s, hold.end_s)).collect();
        let mean = of_holds.iter().sum::<f64>() / of_holds.len().max(1) as f64;
        start.reference_c = model.reference_c.unwrap_or(mean.round());
        start.range_c =
            of_holds.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)]);
        let mut imu = ImuParameters { thermal: start, ..ImuParameters::identity() };
        set_fixed(&mut imu, &problem.setup.known);
        let climate = Self { temperatures: Some(temperatures), start: imu.thermal };
        climate.enough(problem, &of_holds)?;
        Ok(climate)
    }

    /// Mean temperature between two times.
    pub(super) fn mean(&self, start_s: f64, end_s: f64) -> f64 {
        self.temperatures.map_or(self.start.reference_c, |temperatures| temperatures.mean(start_s, end_s))
    }

    /// That of a hold.
    pub(super) fn of_hold(&self, hold: &Hold) -> f64 {
        self.mean(hold.start_s, hold.end_s)
    }

    /// Least and greatest of the whole recording.
    pub(super) fn of_recording(&self) -> Option<[f64; 2]> {
        let values = self.temperatures?.values_c.iter();
        values.map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)])
    }

    /// Are the temperatures of the holds different enough for the terms of which nothing is known beforehand?
    fn enough(&self, problem: &ImuProblem<'_>, of_holds: &[f64]) -> Result<()> {
        let mut sorted = of_holds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (mut levels, mut last) = (0, f64::NEG_INFINITY);
        for t in &sorted {
            if *t >= last + LEVEL_K {
                (levels, last) = (levels + 1, *t);
            }
        }
        let known =
            |quantity: &ImuQuantity| problem.setup.known.iter().any(|term| term.quantity == *quantity);
        let unknown: Vec<ImuQuantity> =
            problem.setup.thermal.quantities().into_iter().filter(|quantity| !known(quantity)).collect();
        // the terms of one polynomial, which need one temperature more than there are
        let siblings = |quantity: &ImuQuantity| {
            let family = |quantity: &ImuQuantity| match quantity {
                ImuQuantity::Thermal(triad, ThermalTerm { part, axis, .. }) => Some((*triad, *part, *axis)),
                _ => None,
            };
            unknown.iter().filter(|other| family(other) == family(quantity)).count()
        };
        let most = unknown.iter().map(siblings).max().unwrap_or(0);
        if levels > most || most == 0 {
            return Ok(());
        }
        let short: Vec<&ImuQuantity> =
            unknown.iter().filter(|quantity| siblings(quantity) >= levels).collect();
        let span = sorted.last().zip(sorted.first()).map_or(0.0, |(high, low)| high - low);
        let reason = match levels {
            0 | 1 => format!("the temperature of the holds changed by {span:.1} K only"),
            _ => format!(
                "the holds have {levels} temperatures that differ by {LEVEL_K} K or more, and polynomials of order {most} need {}",
                most + 1
            ),
        };
        Err(Error::NotIdentifiable(Box::new(NotIdentifiable {
            groups: vec![UndeterminedGroup {
                parameters: short.iter().map(|quantity| quantity.name()).collect(),
                free_combinations: short.len(),
                reason,
                remedy: "record over a wider range of temperatures, with holds all along it; or lower the order in [temperature], or give the terms in [known]"
                    .into(),
            }],
        })))
    }
}

/// Sets the quantities that are fixed beforehand.
pub(super) fn set_fixed(imu: &mut ImuParameters, known: &[KnownTerm]) {
    for known in known.iter().filter(|known| known.sd.is_none()) {
        let now = known.quantity.of(imu);
        known.quantity.add_to(imu, known.value - now);
    }
}

/// The readings of a sensor as they would be at the reference temperature.
pub(super) fn at_reference(
    recording: &Recording,
    triad: Triad,
    sensor: &SensorParameters,
    thermal: &Thermal,
    climate: &Climate<'_>,
) -> Recording {
    let mut adjusted = recording.clone();
    let Some(temperatures) = climate.temperatures else { return adjusted };
    let terms = thermal.triad(triad);
    for (reading, &time_s) in adjusted.readings.iter_mut().zip(&recording.times_s) {
        let tau_k = thermal.tau_k(temperatures.at(time_s));
        let excess = *reading - sensor.bias - terms.bias_change(tau_k);
        *reading = sensor.bias + excess.component_div(&terms.gain_factor(tau_k));
    }
    adjusted
}

/// The accelerometer with its temperature terms, beginning with a fit without them. `refit` is that fit with another recording and the times of its holds.
pub(super) fn accelerometer(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    first: First,
    climate: &Climate<'_>,
    settings: &CalibrationSettings,
    refit: impl Fn(&Recording, Vec<(f64, f64)>) -> Result<First>,
) -> Result<First> {
    let follows = problem.setup.thermal.quantities().iter().any(|q| q.triad() == Triad::Accelerometer);
    if !follows {
        return Ok(first);
    }
    let raw: Vec<Hold> = first.holds.holds.iter().map(|result| result.hold.clone()).collect();
    let intervals: Vec<(f64, f64)> = raw.iter().map(|hold| (hold.start_s, hold.end_s)).collect();
    let detected = first.holds.detected;
    let mut first = first;
    let mut used: Vec<bool> = first.holds.holds.iter().map(|result| result.reason.is_none()).collect();
    for _ in 0..ROUNDS {
        let alone = Alone::new(problem, &first, &raw, &used, climate);
        let (state, scatter) = alone.fit(settings)?;
        let thermal = state.imu.thermal;
        let adjusted =
            at_reference(recording, Triad::Accelerometer, &state.imu.accelerometer, &thermal, climate);
        let mut next = refit(&adjusted, intervals.clone())?;
        let left_out_before = left_out(&next.holds);
        reconsider(&mut next.holds, alone.degrees(), alone.terms());
        next.warnings.retain(|warning| !left_out_before.contains(warning));
        next.warnings.splice(0..0, left_out(&next.holds));
        let between = match scatter {
            Scatter::OfMagnitudes(between) => between,
            Scatter::OfFaces(met) => {
                next.met = Some(met);
                next.holds.tilt = Some(met.tilt);
                next.holds.degrees_of_freedom = met.along_degrees;
                met.placing.along_mps2
            }
        };
        next.holds.between_holds_sd_mps2 = between;
        next.holds.between_holds_dominates = between > 0.0;
        next.holds.detected = detected;
        next.thermal = thermal.accelerometer;
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

/// The static fit does not know that temperature terms took degrees of freedom, so that its residuals look larger than they are: says again which holds are bad.
fn reconsider(holds: &mut HoldCalibration, degrees: usize, terms: usize) {
    let shrink = (degrees as f64 / (degrees + terms).max(1) as f64).sqrt();
    let limit = critical(holds.holds.len(), degrees);
    for result in &mut holds.holds {
        result.studentised_residual *= shrink;
        result.used |= result.reason.is_none() && result.studentised_residual.abs() <= limit;
    }
    holds.magnitude_residual_rms_mps2 = magnitude_rms(&holds.holds);
}

/// What scatters between holds.
enum Scatter {
    /// Their magnitudes, m/s².
    OfMagnitudes(f64),
    OfFaces(Met),
}

/// The accelerometer alone, with what follows temperature.
struct Alone<'a> {
    first: &'a First,
    face_sd_rad: Option<f64>,
    raw: Vec<&'a Hold>,
    joint: Joint<'static>,
    start: State,
}

impl<'a> Alone<'a> {
    fn new(
        problem: &ImuProblem<'_>,
        first: &'a First,
        raw: &'a [Hold],
        used: &[bool],
        climate: &Climate<'_>,
    ) -> Self {
        let chosen: Vec<usize> = (0..raw.len()).filter(|&j| used[j]).collect();
        let known = problem.setup.directions.is_some();
        let mut quantities = solver::quantities(problem);
        quantities.retain(|quantity| quantity.triad() == Triad::Accelerometer);
        let forces: Vec<Vector3<f64>> = chosen.iter().map(|&j| first.holds.holds[j].force_mps2).collect();
        let holds = chosen
            .iter()
            .zip(&forces)
            .map(|(&j, force)| HoldData {
                accelerometer: raw[j].mean,
                accelerometer_weight: Matrix3::zeros(),
                gyroscope: None,
                known: known.then_some(*force),
                temperature_c: climate.of_hold(&raw[j]),
            })
            .collect();
        let mut imu = ImuParameters {
            accelerometer: first.sensor,
            thermal: climate.start,
            ..ImuParameters::identity()
        };
        imu.thermal.accelerometer =
            if first.adjusted.is_some() { first.thermal } else { climate.start.accelerometer };
        set_fixed(&mut imu, &problem.setup.known);
        Self {
            first,
            face_sd_rad: problem.setup.face_sd_rad,
            raw: chosen.iter().map(|&j| &raw[j]).collect(),
            joint: Joint {
                gravity: problem.setup.holds.gravity.magnitude_mps2,
                earth: Earth::of(problem.setup, &quantities),
                holds,
                rotations: Vec::new(),
                turns: Vec::new(),
                gyroscope_noise: StillNoise::none(),
                excess_rad: 0.0,
                prior: solver::prior(problem, &quantities),
                quantities,
            },
            start: State { imu, forces },
        }
    }

    /// Number of temperature terms that are estimated.
    fn terms(&self) -> usize {
        self.joint.quantities.iter().filter(|quantity| matches!(quantity, ImuQuantity::Thermal(..))).count()
    }

    /// Residuals and priors less unknowns.
    fn degrees(&self) -> usize {
        let of_hold = |hold: &HoldData| if hold.known.is_some() { 3 } else { 1 };
        let equations = self.joint.holds.iter().map(of_hold).sum::<usize>() + self.joint.priors();
        equations.saturating_sub(self.joint.quantities.len())
    }

    /// What is left of known faces to tell their scatter.
    fn face_degrees(&self) -> Degrees {
        let of = |quantity: &ImuQuantity| match quantity {
            ImuQuantity::Of(_, of) => Some(*of),
            _ => None,
        };
        let quantities: Vec<Quantity> = self.joint.quantities.iter().filter_map(of).collect();
        let others = self.joint.quantities.len() - quantities.len();
        faces::degrees(&self.start.forces, &quantities, others.saturating_sub(self.joint.priors()))
    }

    /// The problem for such weights of the holds.
    fn weighed(&self, weight: impl Fn(&Hold, &Vector3<f64>) -> Matrix3<f64>) -> Joint<'static> {
        let mut joint = self.joint.clone();
        for ((hold, raw), force) in joint.holds.iter_mut().zip(&self.raw).zip(&self.start.forces) {
            hold.accelerometer_weight = weight(raw, force);
        }
        joint
    }

    /// The fit, and the scatter between holds that makes χ² equal its degrees of freedom.
    fn fit(&self, settings: &CalibrationSettings) -> Result<(State, Scatter)> {
        let mut from = self.start.clone();
        let mut fit = |weighed: &Joint<'_>| {
            let fit = weighed.fit(from.clone(), weighed.misses(&from)?, settings)?;
            from = fit.state.clone();
            Some(fit)
        };
        if let Some(rough) = &self.first.met {
            let on_faces = |placing: &Placing| {
                self.weighed(|hold, force| self.first.weight_on_face(hold, force, placing))
            };
            solver::check(&on_faces(&rough.placing), &self.start, settings)?;
            let weights = on_faces(&Placing::default()).holds;
            let weights = weights.iter().map(|hold| hold.accelerometer_weight);
            let noise = faces::noise_rad2(weights, &self.first.sensor.matrix, self.joint.gravity);
            let (met, state) =
                placing(self.face_degrees(), self.face_sd_rad, (self.joint.gravity, noise), |placing| {
                    let weighed = on_faces(placing);
                    let fit = fit(&weighed)?;
                    Some((self.chi2_of_faces(&weighed, &fit)?, fit.state))
                })
                .ok_or_else(singular)?;
            return Ok((state, Scatter::OfFaces(met)));
        }
        let rough = self.first.holds.between_holds_sd_mps2;
        let of_magnitudes = |between: f64| self.weighed(|hold, _| self.first.weight(hold, between));
        solver::check(&of_magnitudes(rough), &self.start, settings)?;
        let (between, state) = excess(
            self.degrees() as f64,
            |_| rough.max(1e-9 * self.joint.gravity),
            |between| fit(&of_magnitudes(between)).map(|fit| (fit.chi2, fit.state)),
        )
        .ok_or_else(singular)?;
        Ok((state, Scatter::OfMagnitudes(between)))
    }

    /// χ² of the faces; what was known beforehand is in all of it.
    fn chi2_of_faces(&self, weighed: &Joint<'_>, fit: &Fit) -> Option<Chi2> {
        let along = weighed.holds.iter().zip(&fit.state.forces).map(|(hold, force)| {
            let r = hold.accelerometer - fit.state.imu.at(hold.temperature_c).accelerometer.reading(force);
            let s = &self.first.sensor.matrix;
            faces::of_face(&r, s, force, &hold.accelerometer_weight).map(|of| of.along)
        });
        Some(Chi2 { along: along.sum::<Option<f64>>()?, all: fit.chi2 })
    }
}

/// The gyroscope's bias terms per axis for the fit of its means: power, expected value and inverse variance (0 where nothing is known).
pub(super) fn bias_terms(
    quantities: &[ImuQuantity],
    prior: Option<&(Vec<f64>, Vec<f64>)>,
    axis: usize,
) -> Vec<(ThermalTerm, f64, f64)> {
    quantities
        .iter()
        .enumerate()
        .filter(|(_, quantity)| quantity.triad() == Triad::Gyroscope && quantity.is_of_bias())
        .filter_map(|(k, quantity)| match quantity {
            ImuQuantity::Thermal(_, term) if term.axis.index() == axis => {
                let (mean, weight) = prior.map_or((0.0, 0.0), |(mean, weight)| (mean[k], weight[k]));
                Some((*term, mean, weight))
            }
            _ => None,
        })
        .collect()
}

//! From the recording to the joint problem, its weights, and its solution.

use super::activity::with_clocks;
use super::assemble::Finished;
use super::both_still::find_clean_imu_holds;
use super::earth::Earth;
use super::exchanged::with_exchanged;
use super::faces::{self, First};
use super::joint::{HoldData, Joint, Misses, State};
use super::mistaken_turns;
use super::readings::{Integrable, felt_forces, rotation_spans, turns};
use super::settle::{apply, follow_drift, reweigh, settle};
use super::still::{Explanation, Means, StillNoise, between_sd, still, weigh};
use super::thermal::{self, Climate};
use super::verdict::{self, undetermined, vague};
use super::{Gyroscope, ImuCalibration, ImuProblem, NoiseSource, WhiteNoise, start, turned};
use crate::error::{Complaint, Error, Result};
use crate::estimate::holds::{beyond, with_filter, with_pauses};
use crate::estimate::problem::sound;
use crate::estimate::quantisation::of_means;
use crate::estimate::{
    CalibrationProblem, CalibrationSettings, HoldResult, HoldsSetup, Recovered, Stimulus, coarse_axes_in,
    holds, holds_lost_to_filter,
};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{
    Axis, ImuParameters, ImuQuantity, MeanReading, ReadingUnit, Recording, SensorParameters, Thermal, Triad,
    TriadThermal,
};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use std::borrow::Cow;

/// A fit that is followed by another, in standard deviations.
const ROUGH: f64 = 1e-2;

/// Calibrates an IMU, whatever is known beforehand.
pub(super) fn calibrate_imu(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    fit(problem, settings, white_noise).map_err(|error| with_clocks(error, problem.recording))
}

fn fit(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    let (accelerometer, gyroscope) = recordings(problem)?;
    let setup = problem.setup;
    let (first, white_noise) = rayon::join(|| first_look(problem, accelerometer, settings), white_noise);
    let (first, climate) = first?;
    let accelerometer = first.adjusted.as_ref().unwrap_or(accelerometer);
    let holds = &first.holds;
    let chosen: Vec<usize> = (0..holds.holds.len()).filter(|&j| holds.holds[j].used).collect();
    let met = first.met.map_or(1.0, |met| met.cosine());
    let forces: Vec<Vector3<f64>> = chosen.iter().map(|&j| holds.holds[j].force_mps2 * met).collect();
    let used: Vec<&Hold> = chosen.iter().map(|&j| &holds.holds[j].hold).collect();
    let mut stills: Vec<Option<MeanReading>> = used.par_iter().map(|hold| still(gyroscope, hold)).collect();
    if stills.iter().flatten().count() == 0 {
        return Err(Error::recording(Complaint::new(
            "the gyroscope has no samples in the holds of the accelerometer",
            "both need the same clock: are these files of one recording?",
        )));
    }
    let measured = stills.clone();
    let mut said =
        turned::take_out(&mut stills, (&used, &chosen), gyroscope, setup.thermal.gyroscope_bias > 0);
    let given = setup.holds.intervals_s.as_deref().unwrap_or_default();
    said.extend(beyond(accelerometer, given).into_iter().filter(|other| !first.warnings.contains(other)));
    let (noise, noise_source) = sample_noise(problem.gyroscope, white_noise, &stills);
    let at_rest = used.iter().zip(&stills).filter(|(_, still)| still.is_some());
    let coarse = coarse_axes_in(gyroscope, at_rest.map(|(hold, _)| *hold));
    let noise = StillNoise::of(noise, &coarse);
    let quantities = quantities(problem);
    let prior = prior(problem, &quantities);
    let mut data = hold_data(&first, &chosen, &climate);
    let mut thermal = Thermal { accelerometer: first.thermal, ..climate.start };
    let by = Explanation {
        forces: problem.gyroscope.g_sensitivity.then_some(forces.as_slice()),
        of_earth: of_earth(problem, &forces),
        by_earth: Vec::new(),
        tau_k: data.iter().map(|hold| thermal.tau_k(hold.temperature_c)).collect(),
        fixed: thermal.gyroscope,
        terms: std::array::from_fn(|axis| thermal::bias_terms(&quantities, prior.as_ref(), axis)),
    };
    let means = Means { stills: &stills, noise: &noise, by };
    let mut between;
    (between, thermal.gyroscope) = between_sd(&means);
    weigh(&mut data, &stills, &noise, &between);
    let start = start_values(problem, &first, &data, thermal);

    let feels = problem.gyroscope.g_sensitivity;
    let needs_forces = feels || !setup.turns.is_empty();
    let felt = needs_forces.then(|| felt_forces(accelerometer, gyroscope, &first.sensor)).flatten();
    let spans = match setup.directions {
        // the sensor was put down anew on each face: what it went through in between says less than the turns
        Some(_) if !setup.turns.is_empty() => Vec::new(),
        _ => rotation_spans(gyroscope, &used),
    };
    let integrable = Integrable::of(gyroscope, problem.recording.accelerometer.as_ref().filter(|_| feels));
    let rotations = integrable.rotations(felt.as_deref().filter(|_| feels), &spans, &data);
    let mut joint = Joint {
        gravity: setup.holds.gravity.magnitude_mps2,
        earth: Earth::of(setup, &quantities),
        holds: data,
        rotations,
        turns: turns(problem, &integrable, &noise, felt.as_deref(), (&start, &climate))?,
        gyroscope_noise: noise,
        excess_rad: 0.0,
        prior,
        quantities,
    };
    let mut state = State { imu: start, forces: forces.clone() };
    if setup.directions.is_some() {
        said.extend(mistaken_turns::turns(problem.gyroscope, &state.imu, &joint.turns, &setup.turns)?);
    }
    let obstacles: Vec<String> = spans.iter().filter_map(|span| integrable.obstacle(span)).collect();
    let explained = |error: Error| verdict::with_obstacles(error, &obstacles);
    if joint.rotations.iter().all(|rotation| !rotation.used) && joint.turns.is_empty() {
        return Err(explained(Error::NotIdentifiable(Box::new(undetermined(&joint, &[])))));
    }
    let mut axes = None;
    if joint.rotations.iter().any(|rotation| rotation.used) {
        let nominal = match (problem.gyroscope.unit, problem.gyroscope.gain) {
            (ReadingUnit::Counts, gain) => gain.map(|gain| Matrix3::from_diagonal(&gain)),
            _ => Some(Matrix3::identity()),
        };
        let found = start::find(&joint, &state, problem.gyroscope.unit, nominal)
            .ok_or_else(|| explained(Error::NotIdentifiable(Box::new(undetermined(&joint, &[])))))?;
        verdict::plausible(&joint, &state, &found, problem.gyroscope.unit, holds)?;
        state.imu = found.imu;
        thermal::set_fixed(&mut state.imu, &setup.known);
        axes = found.axes;
    }
    let before = state.imu;
    follow_drift(&mut joint, &state, &between);
    let misses = check(&joint, &state, settings).map_err(explained)?;
    let (weighed, misses) = settle(&mut joint, &mut state, misses, &means, &mut between)?;
    let rough = CalibrationSettings { tolerance: ROUGH, ..settings.clone() };
    let close = joint.fit(state, misses, &rough).ok_or_else(singular)?;
    // the weights once more, where directions and parameters go together
    let again = reweigh(&joint, &close.state, &close.misses)?;
    let moved = (again.excess_rad - joint.excess_rad).abs() > 0.01 * joint.excess_rad;
    if moved || again.used != weighed.used {
        apply(&mut joint, &again);
    }
    let fit = joint.fit(close.state, close.misses, settings).ok_or_else(singular)?;
    let finished = Finished {
        joint: &joint,
        fit: &fit,
        weighed: &again,
        before: &before,
        between,
        integrable: &integrable,
        noise_source,
        said: &said,
        coarse: &coarse,
        scatter: MeanReading::pooled_sd(stills.iter().flatten()),
        spans: &spans,
        chosen: &chosen,
        climate: &climate,
        stills: &measured,
    };
    finished.assemble(problem, holds, axes, &first)
}

/// What the gyroscope reads of the Earth's turn about the vertical at these forces, where no g-sensitivity takes it up; by the datasheet's gain, and nothing where that is not known.
fn of_earth(problem: &ImuProblem<'_>, forces: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    let gain = match problem.gyroscope.unit {
        ReadingUnit::Counts => problem.gyroscope.gain?,
        _ => Vector3::repeat(1.0),
    };
    let reading = gain * problem.setup.vertical_rate();
    let is_free = problem.gyroscope.g_sensitivity;
    (!is_free).then(|| forces.iter().map(|force| force.component_mul(&reading)).collect())
}

pub(super) fn singular() -> Error {
    Error::recording(Complaint::new(
        "the fit of the rotations breaks down: an estimated matrix becomes singular",
        "check the units of both sensors and that the files belong together",
    ))
}

/// Noise of a gyroscope's sample: that of the datasheet, else what a long hold shows, else the scatter within holds.
fn sample_noise(
    gyroscope: &Gyroscope,
    white_noise: Option<WhiteNoise>,
    stills: &[Option<MeanReading>],
) -> (Vector3<f64>, NoiseSource) {
    match (gyroscope.noise, white_noise) {
        (Some(noise), _) => (noise, NoiseSource::Datasheet),
        (None, Some(white)) => {
            (white.sd, NoiseSource::AllanDeviation { hold: white.hold, duration_s: white.duration_s })
        }
        (None, None) => (MeanReading::pooled_sd(stills.iter().flatten()), NoiseSource::ScatterWithinHolds),
    }
}

/// Both recordings, of three axes and the units that are expected.
pub(in crate::estimate) fn recordings<'a>(
    problem: &ImuProblem<'a>,
) -> Result<(&'a Recording, &'a Recording)> {
    let need = |triad: Triad| {
        problem.recording.triad(triad).filter(|recording| recording.len() > 1).ok_or_else(|| {
            Error::recording(Complaint::new(
                format!("the recording has no {triad}"),
                "an IMU needs both sensors; kind = \"accelerometer\" calibrates that one alone",
            ))
        })
    };
    let moves = |triad: Triad| {
        let recording = need(triad)?;
        match Axis::ALL.into_iter().find(|&axis| recording.constant(axis).is_some()) {
            None => Ok(recording),
            Some(axis) => Err(Error::recording(Complaint::new(
                format!("axis {axis} of the {triad} never changes"),
                "is it connected, and are the columns right?",
            ))),
        }
    };
    let (accelerometer, gyroscope) = (moves(Triad::Accelerometer)?, moves(Triad::Gyroscope)?);
    let stimulus = Stimulus::Holds(&problem.setup.holds);
    let alone = CalibrationProblem { sensor: problem.accelerometer, recording: accelerometer, stimulus };
    let (one, other) = rayon::join(|| alone.validate(), || sound(gyroscope));
    one.and(other)?;
    if gyroscope.unit != problem.gyroscope.unit {
        return Err(Error::recording(Complaint::new(
            format!(
                "the gyroscope's readings are in {}, the experiment expects {}",
                gyroscope.unit.symbol(),
                problem.gyroscope.unit.symbol()
            ),
            "set gyroscope.unit",
        )));
    }
    Ok((accelerometer, gyroscope))
}

/// The accelerometer by itself, and the temperatures of its holds: what needs nothing of the gyroscope.
fn first_look<'a>(
    problem: &ImuProblem<'a>,
    accelerometer: &Recording,
    settings: &CalibrationSettings,
) -> Result<(First, Climate<'a>)> {
    let setup = problem.setup;
    let from = |recording: &Recording, intervals: Option<Vec<(f64, f64)>>| match &setup.directions {
        Some(directions) => faces::fit(problem, recording, directions),
        None => from_holds(problem, recording, settings, intervals),
    };
    let first = from(accelerometer, setup.holds.intervals_s.clone())?;
    let found: Vec<Hold> = first.holds.holds.iter().map(|result| result.hold.clone()).collect();
    let climate = Climate::of(problem, &found)?;
    let first =
        thermal::accelerometer(problem, accelerometer, first, &climate, settings, |recording, intervals| {
            from(recording, Some(intervals))
        })?;
    Ok((first, climate))
}

/// The accelerometer by its static calibration.
fn from_holds(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    settings: &CalibrationSettings,
    intervals_s: Option<Vec<(f64, f64)>>,
) -> Result<First> {
    let detected = intervals_s.is_none();
    let minimum_s = problem.setup.holds.minimum_hold_s;
    let found = match (&problem.setup.found, detected) {
        (_, false) => Cow::Borrowed(&[][..]),
        (Some(found), true) => Cow::Borrowed(found.as_slice()),
        (None, true) => Cow::Owned(find_clean_imu_holds(problem.recording, minimum_s)?),
    };
    let intervals_s =
        intervals_s.unwrap_or_else(|| found.iter().map(|hold| (hold.start_s, hold.end_s)).collect());
    let setup = HoldsSetup { intervals_s: Some(intervals_s), ..problem.setup.holds.clone() };
    let stimulus = Stimulus::Holds(&setup);
    let as_read = problem.recording.accelerometer.as_ref().unwrap_or(recording);
    let alone = CalibrationProblem { sensor: problem.accelerometer, recording, stimulus };
    let mut first = holds::calibrate(&alone, &setup, settings, as_read).map_err(|error| match detected {
        true => {
            let error = with_pauses(with_filter(error, as_read, &found, minimum_s), as_read);
            with_exchanged(error, problem.recording, minimum_s)
        }
        false => error,
    })?;
    if detected {
        first.warnings.extend(holds_lost_to_filter(as_read, &found, minimum_s));
    }
    let Recovered::Holds(mut holds) = first.recovered else {
        return Err(Error::experiment(Complaint::new("an IMU is calibrated from holds", "use [holds]")));
    };
    holds.detected = detected;
    let within = first.fit.noise_estimate.unwrap_or_else(Vector3::zeros);
    let sound = holds.holds.iter().filter(|result| result.reason.is_none());
    let of_mean = of_means(&coarse_axes_in(as_read, sound.map(|result| &result.hold)));
    let (thermal, adjusted) = (TriadThermal::default(), None);
    let warnings = first.warnings;
    Ok(First { sensor: first.sensor, within, of_mean, holds, met: None, warnings, thermal, adjusted })
}

/// The used holds with the accelerometer's weights.
fn hold_data(first: &First, chosen: &[usize], climate: &Climate<'_>) -> Vec<HoldData> {
    let holds = &first.holds;
    chosen
        .iter()
        .map(|&j| {
            let HoldResult { hold, force_mps2, .. } = &holds.holds[j];
            HoldData {
                accelerometer: hold.mean,
                accelerometer_weight: match &first.met {
                    Some(met) => first.weight_on_face(hold, force_mps2, &met.widened),
                    None => first.weight(hold, holds.between_holds_sd_mps2),
                },
                gyroscope: None,
                known: first.met.map(|met| force_mps2 * met.cosine()),
                temperature_c: climate.of_hold(hold),
            }
        })
        .collect()
}

/// The quantities that are estimated: all but the fixed ones.
pub(super) fn quantities(problem: &ImuProblem<'_>) -> Vec<ImuQuantity> {
    let setup = problem.setup;
    let mut quantities = setup.quantities(problem.accelerometer.model, problem.gyroscope);
    let fixed = |quantity: &ImuQuantity| {
        setup.known.iter().any(|known| known.quantity == *quantity && known.sd.is_none())
    };
    quantities.retain(|quantity| !fixed(quantity));
    quantities
}

/// Mean and inverse variance of each estimated quantity that is known beforehand.
pub(super) fn prior(problem: &ImuProblem<'_>, quantities: &[ImuQuantity]) -> Option<(Vec<f64>, Vec<f64>)> {
    let of = |quantity: &ImuQuantity| problem.setup.known.iter().find(|known| known.quantity == *quantity);
    if quantities.iter().all(|quantity| of(quantity).is_none()) {
        return None;
    }
    Some(
        quantities
            .iter()
            .map(|quantity| {
                of(quantity).map_or((0.0, 0.0), |known| (known.value, known.sd.map_or(0.0, |sd| sd.powi(-2))))
            })
            .unzip(),
    )
}

fn start_values(
    problem: &ImuProblem<'_>,
    first: &First,
    holds: &[HoldData],
    thermal: Thermal,
) -> ImuParameters {
    let mut imu = ImuParameters {
        accelerometer: first.sensor,
        gyroscope: SensorParameters { bias: start::mean_bias(holds, &thermal), matrix: Matrix3::identity() },
        g_sensitivity: Matrix3::zeros(),
        thermal,
    };
    if let Some(gain) = problem.gyroscope.gain {
        imu.gyroscope.matrix = Matrix3::from_diagonal(&gain);
    }
    thermal::set_fixed(&mut imu, &problem.setup.known);
    imu
}

/// Are all parameters determined? Gives what the rotations say at this state.
pub(super) fn check(joint: &Joint<'_>, state: &State, settings: &CalibrationSettings) -> Result<Misses> {
    let none = CalibrationSettings { max_iterations: 0, ..settings.clone() };
    let misses = joint.misses(state).ok_or_else(singular)?;
    let fit = joint.fit(state.clone(), misses, &none).ok_or_else(singular)?;
    let groups = information::undetermined(&fit.information, &fit.unreduced);
    if !groups.is_empty() {
        return Err(Error::NotIdentifiable(Box::new(undetermined(joint, &groups))));
    }
    match information::covariance(&fit.information).and_then(|covariance| vague(joint, state, &covariance)) {
        Some(vague) => Err(Error::NotIdentifiable(Box::new(vague))),
        None => Ok(fit.misses),
    }
}

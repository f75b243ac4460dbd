//! From the recording to the joint problem, its weights, and its solution.

use super::assemble::Finished;
use super::faces::{self, First};
use super::joint::{HoldData, Joint, RotationData, State};
use super::readings::{felt_forces, rotation_spans, samples, turns, usable};
use super::settle::{apply, reweigh, settle};
use super::still::{Still, between_sd, pooled_noise, still, weigh};
use super::verdict::{self, undetermined};
use super::{ImuCalibration, ImuProblem, start};
use crate::error::{Complaint, Error, Result};
use crate::estimate::{CalibrationProblem, CalibrationSettings, Recovered, Stimulus, calibrate};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{
    ImuParameters, ImuQuantity, ParameterList, ReadingUnit, Recording, SensorParameters, Triad,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Calibrates an IMU.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where a sensor's recording is missing or is none, where gyroscope and accelerometer do not overlap, or where the
/// gyroscope's readings cannot be angular rates in the unit given; [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names what the holds or the
/// rotations do not determine, and what would.
pub fn calibrate_imu(problem: &ImuProblem<'_>, settings: &CalibrationSettings) -> Result<ImuCalibration> {
    let (accelerometer, gyroscope) = recordings(problem)?;
    let setup = problem.setup;
    let first = match &setup.directions {
        Some(directions) => faces::fit(problem, accelerometer, directions)?,
        None => from_holds(problem, accelerometer, settings)?,
    };
    let holds = &first.holds;
    let chosen: Vec<usize> = (0..holds.holds.len()).filter(|&j| holds.holds[j].used).collect();
    let forces: Vec<Vector3<f64>> = chosen.iter().map(|&j| holds.holds[j].force_mps2).collect();
    let used: Vec<&Hold> = chosen.iter().map(|&j| &holds.holds[j].hold).collect();
    let stills: Vec<Option<Still>> = used.iter().map(|hold| still(gyroscope, hold)).collect();
    if stills.iter().flatten().count() == 0 {
        return Err(Error::recording(Complaint::new(
            "the gyroscope has no samples in the holds of the accelerometer",
            "both need the same clock: are these files of one recording?",
        )));
    }
    let noise = problem.gyroscope.noise.unwrap_or_else(|| pooled_noise(&stills));
    let g_forces = problem.gyroscope.g_sensitivity.then_some(forces.as_slice());
    let between = between_sd(&stills, &noise, g_forces);
    let mut data = hold_data(&first, &chosen, setup.directions.is_some());
    weigh(&mut data, &stills, &noise, &between);

    let still_bias = start::mean_bias(&data);
    let felt = problem
        .gyroscope
        .g_sensitivity
        .then(|| felt_forces(accelerometer, gyroscope, &first.sensor))
        .flatten();
    let spans = match setup.directions {
        // the sensor was put down anew on each face: what it went through in between says less than the turns
        Some(_) if !setup.turns.is_empty() => Vec::new(),
        _ => rotation_spans(gyroscope, &used),
    };
    let rate = gyroscope.rate_hz();
    let rotations: Vec<RotationData<'_>> = spans
        .iter()
        .enumerate()
        .map(|(from, span)| RotationData {
            from,
            samples: samples(gyroscope, felt.as_deref(), span),
            used: usable(gyroscope, span, rate).is_ok(),
            counts: true,
        })
        .collect();
    let quantities = quantities(problem);
    let mut joint = Joint {
        gravity: setup.holds.gravity.magnitude_mps2,
        holds: data,
        rotations,
        turns: turns(problem, gyroscope, &noise, felt.as_deref(), &still_bias)?,
        gyroscope_noise: noise,
        excess_rad: 0.0,
        prior: prior(problem, &quantities),
        quantities,
    };
    let mut state = State { imu: start_values(problem, &first, &joint), forces };
    if joint.rotations.iter().all(|rotation| !rotation.used) && joint.turns.is_empty() {
        return Err(Error::NotIdentifiable(Box::new(undetermined(&joint, &[]))));
    }
    let mut axes = None;
    if joint.rotations.iter().any(|rotation| rotation.used) {
        let nominal = match (problem.gyroscope.unit, problem.gyroscope.gain) {
            (ReadingUnit::Counts, gain) => gain.map(|gain| Matrix3::from_diagonal(&gain)),
            _ => Some(Matrix3::identity()),
        };
        let found = start::find(&joint, &state, problem.gyroscope.unit, nominal)
            .ok_or_else(|| Error::NotIdentifiable(Box::new(undetermined(&joint, &[]))))?;
        verdict::plausible(&joint, &state, &found, problem.gyroscope.unit)?;
        state.imu = found.imu;
        axes = found.axes;
    }
    let before = state.imu;
    check(&joint, &state, settings)?;
    let weighed = settle(&mut joint, &mut state, &between)?;
    let mut fit = joint.fit(state, settings).ok_or_else(singular)?;
    // the weights once more, at the joint optimum
    let weighed = match reweigh(&joint, &fit.state)? {
        Some(again)
            if again.used != weighed.used
                || (again.excess_rad - joint.excess_rad).abs() > 0.01 * joint.excess_rad =>
        {
            apply(&mut joint, &again);
            fit = joint.fit(fit.state, settings).ok_or_else(singular)?;
            again
        }
        Some(again) => again,
        None => weighed,
    };
    let finished = Finished {
        joint: &joint,
        fit: &fit,
        weighed: &weighed,
        before: &before,
        between,
        spans: &spans,
        chosen: &chosen,
    };
    finished.assemble(problem, holds, gyroscope, axes, &first)
}

pub(super) fn singular() -> Error {
    Error::recording(Complaint::new(
        "the fit of the rotations breaks down: an estimated matrix becomes singular",
        "check the units of both sensors and that the files belong together",
    ))
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
    let (accelerometer, gyroscope) = (need(Triad::Accelerometer)?, need(Triad::Gyroscope)?);
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
    if let Some(k) = gyroscope
        .times_s
        .windows(2)
        .position(|pair| pair[1].partial_cmp(&pair[0]) != Some(std::cmp::Ordering::Greater))
    {
        return Err(Error::recording(Complaint::new(
            format!("the gyroscope's time does not increase after sample {k}"),
            "sort the samples, remove duplicates",
        )));
    }
    Ok((accelerometer, gyroscope))
}

/// The accelerometer by its static calibration.
fn from_holds(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    settings: &CalibrationSettings,
) -> Result<First> {
    let stimulus = Stimulus::Holds(&problem.setup.holds);
    let first =
        calibrate(&CalibrationProblem { sensor: problem.accelerometer, recording, stimulus }, settings)?;
    let Recovered::Holds(holds) = first.recovered else {
        return Err(Error::experiment(Complaint::new("an IMU is calibrated from holds", "use [holds]")));
    };
    let within = first.fit.noise_estimate.unwrap_or_else(Vector3::zeros);
    Ok(First { sensor: first.sensor, within, holds, warnings: first.warnings })
}

/// The used holds with the accelerometer's weights.
fn hold_data(first: &First, chosen: &[usize], known: bool) -> Vec<HoldData> {
    let (holds, within) = (&first.holds, first.within);
    let gain = Vector3::from_fn(|axis, _| first.sensor.matrix.row(axis).norm_squared());
    let between = holds.between_holds_sd_mps2.powi(2);
    chosen
        .iter()
        .map(|&j| {
            let hold = &holds.holds[j].hold;
            let variance = within.component_mul(&within) / hold.samples() as f64 + gain * between;
            HoldData {
                accelerometer: hold.mean,
                accelerometer_weight: variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)),
                gyroscope: None,
                known: known.then_some(holds.holds[j].force_mps2),
            }
        })
        .collect()
}

/// The quantities that are estimated: the accelerometer's in its gauge, then the gyroscope's.
fn quantities(problem: &ImuProblem<'_>) -> Vec<ImuQuantity> {
    let setup = problem.setup;
    let accelerometer = match setup.directions {
        Some(_) => ParameterList::new(3, problem.accelerometer.model),
        None => setup.holds.gauge.parameter_list(problem.accelerometer.model),
    };
    let gyroscope = ParameterList::new(3, problem.gyroscope.model);
    let of = |triad: Triad, list: &ParameterList| -> Vec<ImuQuantity> {
        list.quantities().iter().map(|quantity| ImuQuantity::Of(triad, *quantity)).collect()
    };
    let mut quantities = of(Triad::Accelerometer, &accelerometer);
    quantities.extend(of(Triad::Gyroscope, &gyroscope));
    if problem.gyroscope.g_sensitivity {
        quantities.extend(ImuQuantity::full_list(false, false, true));
    }
    let fixed = |quantity: &ImuQuantity| {
        setup.known.iter().any(|known| known.quantity == *quantity && known.sd.is_none())
    };
    quantities.retain(|quantity| !fixed(quantity));
    quantities
}

/// Mean and inverse variance of each estimated quantity that is known beforehand.
fn prior(problem: &ImuProblem<'_>, quantities: &[ImuQuantity]) -> Option<(Vec<f64>, Vec<f64>)> {
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

fn start_values(problem: &ImuProblem<'_>, first: &First, joint: &Joint<'_>) -> ImuParameters {
    let mut imu = ImuParameters {
        accelerometer: first.sensor,
        gyroscope: SensorParameters { bias: start::mean_bias(&joint.holds), matrix: Matrix3::identity() },
        g_sensitivity: Matrix3::zeros(),
    };
    if let Some(gain) = problem.gyroscope.gain {
        imu.gyroscope.matrix = Matrix3::from_diagonal(&gain);
    }
    for known in problem.setup.known.iter().filter(|known| known.sd.is_none()) {
        let now = known.quantity.of(&imu);
        known.quantity.add_to(&mut imu, known.value - now);
    }
    imu
}

/// Are all parameters determined?
fn check(joint: &Joint<'_>, state: &State, settings: &CalibrationSettings) -> Result<()> {
    let none = CalibrationSettings { max_iterations: 0, ..settings.clone() };
    let fit = joint.fit(state.clone(), &none).ok_or_else(singular)?;
    let size = joint.quantities.len();
    let information = DMatrix::from_fn(size, size, |i, j| fit.information[(i, j)]);
    let groups = information::undetermined(&information, &DVector::from_fn(size, |i, _| fit.unreduced[i]));
    if groups.is_empty() {
        return Ok(());
    }
    Err(Error::NotIdentifiable(Box::new(undetermined(joint, &groups))))
}

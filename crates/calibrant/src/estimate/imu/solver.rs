//! From the recording to the joint problem, its weights, and its solution.

use super::faces::{self, First};
use super::joint::{Fit, HoldData, Joint, Miss, RotationData, State, TurnData};
use super::rotation::{LocalBias, Samples};
use super::still::{Still, between_sd, pooled_noise, still, weigh};
use super::verdict::{self, undetermined};
use super::weights::{self, Weighed};
use super::{ImuCalibration, ImuProblem, RotationResult, StillGyroscope, TurnResult, start};
use crate::error::{Complaint, Error, Result};
use crate::estimate::{
    CalibrationProblem, CalibrationSettings, HoldCalibration, Recovered, Stimulus, calibrate,
};
use crate::information;
use crate::motion::Hold;
use crate::sensor::{
    ImuParameters, ImuQuantity, ParameterList, Quantity, ReadingUnit, Recording, SensorParameters, Triad,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::ops::Range;

/// A rotation begins this long before the end of a hold, s: a hand begins to turn so gently that the first milliradians look still.
const MARGIN_S: f64 = 0.3;
/// A pause between samples longer than so many steps makes a rotation useless.
const GAP: f64 = 5.0;
/// Rounds in which weights and estimate follow each other.
const ROUNDS: usize = 12;
/// Steps below this many standard deviations end the rounds.
const SETTLED: f64 = 0.02;

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
    let stills: Vec<Option<Still>> = chosen.iter().map(|&j| still(gyroscope, &holds.holds[j].hold)).collect();
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
        _ => rotation_spans(gyroscope, holds, &chosen),
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
    let mut joint = Joint {
        quantities: quantities(problem),
        gravity: setup.holds.gravity.magnitude_mps2,
        holds: data,
        rotations,
        turns: turns(problem, gyroscope, &noise, felt.as_deref(), &still_bias)?,
        gyroscope_noise: noise,
        excess_rad: 0.0,
        prior: prior(problem),
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

fn singular() -> Error {
    Error::recording(Complaint::new(
        "the fit of the rotations breaks down: an estimated matrix becomes singular",
        "check the units of both sensors and that the files belong together",
    ))
}

/// Both recordings, of three axes and the units that are expected.
fn recordings<'a>(problem: &ImuProblem<'a>) -> Result<(&'a Recording, &'a Recording)> {
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
        use crate::sensor::Axis;
        let pairs = Axis::ALL.iter().flat_map(|row| Axis::ALL.iter().map(|column| (*row, *column)));
        quantities.extend(pairs.map(|(row, column)| ImuQuantity::GSensitivity(row, column)));
    }
    let fixed = |quantity: &ImuQuantity| {
        setup.known.iter().any(|known| known.quantity == *quantity && known.sd.is_none())
    };
    quantities.retain(|quantity| !fixed(quantity));
    quantities
}

/// Mean and inverse variance of each estimated quantity that is known beforehand.
fn prior(problem: &ImuProblem<'_>) -> Option<(Vec<f64>, Vec<f64>)> {
    let of = |quantity: &ImuQuantity| problem.setup.known.iter().find(|known| known.quantity == *quantity);
    let quantities = quantities(problem);
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

/// The specific force at the gyroscope's sample times.
fn felt_forces(
    accelerometer: &Recording,
    gyroscope: &Recording,
    sensor: &SensorParameters,
) -> Option<Vec<Vector3<f64>>> {
    let correction = sensor.matrix.try_inverse()?;
    let force = |k: usize| correction * (accelerometer.readings[k] - sensor.bias);
    let last = accelerometer.len() - 1;
    Some(
        gyroscope
            .times_s
            .iter()
            .map(|&t| {
                let after = accelerometer.times_s.partition_point(|&at| at < t).min(last);
                let before = after.saturating_sub(1);
                let (from, to) = (accelerometer.times_s[before], accelerometer.times_s[after]);
                let part = if to > from { ((t - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
                force(before) * (1.0 - part) + force(after) * part
            })
            .collect(),
    )
}

/// The gyroscope's samples from shortly before the end of each used hold to shortly after the start of the next.
fn rotation_spans(gyroscope: &Recording, holds: &HoldCalibration, chosen: &[usize]) -> Vec<Range<usize>> {
    chosen
        .windows(2)
        .map(|pair| {
            let (from, to) = (&holds.holds[pair[0]].hold, &holds.holds[pair[1]].hold);
            let margin = |hold: &Hold| (0.25 * hold.duration_s()).min(MARGIN_S);
            let (start_s, end_s) = (from.end_s - margin(from), to.start_s + margin(to));
            let first = gyroscope.times_s.partition_point(|&t| t <= start_s).saturating_sub(1);
            let end = (gyroscope.times_s.partition_point(|&t| t < end_s) + 1).min(gyroscope.len());
            let covers = gyroscope.times_s[first] <= from.end_s && gyroscope.times_s[end - 1] >= to.start_s;
            first..if covers { end } else { first + 1 }
        })
        .collect()
}

fn samples<'a>(
    gyroscope: &'a Recording,
    felt: Option<&'a [Vector3<f64>]>,
    span: &Range<usize>,
) -> Samples<'a> {
    Samples {
        times_s: &gyroscope.times_s[span.clone()],
        readings: &gyroscope.readings[span.clone()],
        forces: felt.map(|felt| &felt[span.clone()]),
        drift: [LocalBias::none(); 2],
    }
}

/// Can a rotation be integrated?
fn usable(gyroscope: &Recording, span: &Range<usize>, rate_hz: f64) -> std::result::Result<(), String> {
    if span.len() < 3 {
        return Err("the gyroscope's recording does not cover it".into());
    }
    let longest = gyroscope.times_s[span.clone()].windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    if longest * rate_hz > GAP {
        return Err(format!("the gyroscope pauses for {longest:.3} s in it"));
    }
    Ok(())
}

/// The turns of known angle, with the integrals of the readings.
fn turns(
    problem: &ImuProblem<'_>,
    gyroscope: &Recording,
    noise: &Vector3<f64>,
    felt: Option<&[Vector3<f64>]>,
    still_bias: &Vector3<f64>,
) -> Result<Vec<TurnData>> {
    problem
        .setup
        .turns
        .iter()
        .enumerate()
        .map(|(number, turn)| {
            let first = gyroscope.times_s.partition_point(|&t| t < turn.start_s);
            let end = gyroscope.times_s.partition_point(|&t| t <= turn.end_s);
            if end < first + 3 {
                return Err(Error::recording(Complaint::new(
                    format!(
                        "turn {} from {} to {} s has {} samples",
                        number + 1,
                        turn.start_s,
                        turn.end_s,
                        end.saturating_sub(first)
                    ),
                    "correct the times of the turns",
                )));
            }
            let (times, readings) = (&gyroscope.times_s[first..end], &gyroscope.readings[first..end]);
            let (mut integral, mut variance, mut force) =
                (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
            for k in 0..times.len() {
                let before = if k > 0 { times[k] - times[k - 1] } else { 0.0 };
                let after = if k + 1 < times.len() { times[k + 1] - times[k] } else { 0.0 };
                let weight = 0.5 * (before + after);
                integral += readings[k] * weight;
                force += felt.map_or_else(Vector3::zeros, |felt| felt[first + k]) * weight;
                variance += noise.component_mul(noise) * (weight * weight);
            }
            let duration_s = times[times.len() - 1] - times[0];
            // the gain, roughly: what the readings add up to beyond their bias, over the angle
            let bias = still_bias * duration_s;
            let gain = (integral - bias).norm() / turn.angle_rad.abs();
            variance += Vector3::repeat((gain * turn.angle_sd_rad).powi(2));
            Ok(TurnData {
                integral,
                duration_s,
                force,
                angle: turn.axis * turn.angle_rad,
                weight: variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)),
            })
        })
        .collect()
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

/// What holds, turns and prior say of the gyroscope, directions fixed: the rest of the problem beside the rotations.
fn rest(joint: &Joint<'_>, state: &State) -> (DMatrix<f64>, DVector<f64>) {
    let places: Vec<usize> =
        (0..joint.quantities.len()).filter(|&k| joint.quantities[k].triad() == Triad::Gyroscope).collect();
    let size = places.len();
    let (mut f, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    let imu = &state.imu;
    let mut add =
        |stimulus: Vector3<f64>, force: Vector3<f64>, time: f64, r: Vector3<f64>, weight: &Vector3<f64>| {
            let columns: Vec<Vector3<f64>> = places
                .iter()
                .map(|&k| {
                    let quantity = joint.quantities[k];
                    let scale =
                        if matches!(quantity, ImuQuantity::Of(_, Quantity::Bias(_))) { time } else { 1.0 };
                    quantity.derivative(&stimulus, &force) * scale
                })
                .collect();
            for i in 0..size {
                let weighted = columns[i].component_mul(weight);
                g[i] += weighted.dot(&r);
                for j in 0..size {
                    f[(i, j)] += weighted.dot(&columns[j]);
                }
            }
        };
    for (hold, force) in joint.holds.iter().zip(&state.forces) {
        if let Some((mean, weight)) = &hold.gyroscope {
            add(Vector3::zeros(), *force, 1.0, mean - imu.gyroscope.bias - imu.g_sensitivity * force, weight);
        }
    }
    for turn in &joint.turns {
        let r = turn.integral - imu.gyroscope.bias * turn.duration_s - imu.gyroscope.matrix * turn.angle;
        add(turn.angle, turn.force, turn.duration_s, r, &turn.weight);
    }
    if let Some((mean, weight)) = &joint.prior {
        for (i, &k) in places.iter().enumerate() {
            f[(i, i)] += weight[k];
            g[i] += weight[k] * (mean[k] - joint.quantities[k].of(imu));
        }
    }
    (f, g)
}

fn reweigh(joint: &Joint<'_>, state: &State) -> Result<Option<Weighed>> {
    if joint.rotations.is_empty() {
        return Ok(None);
    }
    let misses = joint.misses(state).ok_or_else(singular)?;
    if misses.iter().all(Option::is_none) {
        return Ok(None);
    }
    let (f, g) = rest(joint, state);
    weights::weigh(joint, &misses, &f, &g).map(Some).ok_or_else(singular)
}

fn apply(joint: &mut Joint<'_>, weighed: &Weighed) {
    joint.excess_rad = weighed.excess_rad;
    for (rotation, used) in joint.rotations.iter_mut().zip(&weighed.used) {
        rotation.counts = *used;
    }
}

/// The bias of a rotation is that of the holds before and after it, as far as these tell: a hold's deviation from the mean bias counts by the share of it that
/// is not noise.
fn follow_drift(joint: &mut Joint<'_>, state: &State, between: &Vector3<f64>) {
    let biases: Vec<LocalBias> = joint
        .holds
        .iter()
        .zip(&state.forces)
        .map(|(hold, force)| {
            hold.gyroscope.map_or_else(LocalBias::none, |(mean, weight)| {
                let true_variance = between.component_mul(between);
                LocalBias {
                    mean,
                    force: *force,
                    share: true_variance.component_mul(&weight),
                    variance: weight.map(|weight| 1.0 / weight) - true_variance,
                }
            })
        })
        .collect();
    for rotation in &mut joint.rotations {
        rotation.samples.drift = [biases[rotation.from], biases[rotation.from + 1]];
    }
}

/// Weights and the gyroscope's parameters in turn, directions fixed, until both rest.
fn settle(joint: &mut Joint<'_>, state: &mut State, between: &Vector3<f64>) -> Result<Weighed> {
    let places: Vec<usize> =
        (0..joint.quantities.len()).filter(|&k| joint.quantities[k].triad() == Triad::Gyroscope).collect();
    let mut last = Weighed::none(joint.rotations.len());
    for _ in 0..ROUNDS {
        follow_drift(joint, state, between);
        let Some(weighed) = reweigh(joint, state)? else { break };
        apply(joint, &weighed);
        let mut imu = state.imu;
        for (&k, step) in places.iter().zip(weighed.step.iter()) {
            joint.quantities[k].add_to(&mut imu, *step);
        }
        let rests = weighed.length < SETTLED;
        last = weighed;
        state.imu = imu;
        if rests {
            break;
        }
    }
    Ok(last)
}

/// Everything that the result is put together from.
struct Finished<'a> {
    joint: &'a Joint<'a>,
    fit: &'a Fit,
    weighed: &'a Weighed,
    before: &'a ImuParameters,
    between: Vector3<f64>,
    spans: &'a [Range<usize>],
    chosen: &'a [usize],
}

impl Finished<'_> {
    fn assemble(
        &self,
        problem: &ImuProblem<'_>,
        holds: &HoldCalibration,
        gyroscope: &Recording,
        axes: Option<[String; 3]>,
        first: &First,
    ) -> Result<ImuCalibration> {
        let (joint, fit) = (self.joint, self.fit);
        let size = joint.quantities.len();
        let information = DMatrix::from_fn(size, size, |i, j| fit.information[(i, j)]);
        let mut covariance = information::covariance(&information).ok_or_else(singular)?;
        let prior_share = (0..size)
            .map(|k| {
                joint
                    .prior
                    .as_ref()
                    .map_or(0.0, |(_, weight)| (weight[k] * covariance[(k, k)]).clamp(0.0, 1.0))
            })
            .collect();
        let imu = fit.state.imu;
        let g = problem.setup.holds.gravity;
        // what gravity's own uncertainty adds: it is a common factor of the accelerometer's matrix and of the g-sensitivity
        let slope = DVector::from_iterator(
            size,
            joint.quantities.iter().map(|quantity| match quantity {
                ImuQuantity::Of(Triad::Accelerometer, Quantity::Bias(_))
                | ImuQuantity::Of(Triad::Gyroscope, _) => 0.0,
                _ => -quantity.of(&imu) / g.magnitude_mps2,
            }),
        );
        covariance += &slope * slope.transpose() * (g.sd_mps2 * g.sd_mps2);
        let rotations = self.rotations(gyroscope);
        let counted = rotations.iter().filter(|rotation| rotation.used).count();
        let stills = joint.holds.iter().filter(|hold| hold.gyroscope.is_some()).count();
        let equations = 3 * joint.holds.len() + 3 * stills + 2 * counted + 3 * joint.turns.len();
        let unknowns = size + 2 * joint.holds.iter().filter(|hold| hold.known.is_none()).count();
        let mut holds = holds.clone();
        for (&j, force) in self.chosen.iter().zip(&fit.state.forces) {
            holds.holds[j].force_mps2 = *force;
        }
        let correction = imu.gyroscope.matrix.try_inverse().ok_or_else(singular)?;
        let turns = joint
            .turns
            .iter()
            .zip(&problem.setup.turns)
            .map(|(data, turn)| TurnResult {
                start_s: turn.start_s,
                end_s: turn.end_s,
                angle_rad: data.angle,
                measured_rad: correction * (data.integral - imu.gyroscope.bias * data.duration_s),
            })
            .collect();
        let mut calibration = ImuCalibration {
            status: fit.status,
            iterations: fit.iterations,
            gradient_norm: fit.gradient_norm,
            values: joint.quantities.iter().map(|quantity| quantity.of(&imu)).collect(),
            quantities: joint.quantities.clone(),
            covariance,
            prior_share,
            imu,
            accelerometer_unit: problem.accelerometer.unit,
            gyroscope_unit: problem.gyroscope.unit,
            chi2: fit.chi2,
            degrees_of_freedom: equations.saturating_sub(unknowns),
            holds,
            still: StillGyroscope { noise: joint.gyroscope_noise, between_holds_sd: self.between },
            rotations,
            rotation_excess_sd_rad: joint.excess_rad,
            turns,
            warnings: first.warnings.clone(),
        };
        calibration.warnings.extend(verdict::warnings(&calibration, axes.as_ref()));
        Ok(calibration)
    }

    fn rotations(&self, gyroscope: &Recording) -> Vec<RotationResult> {
        let joint = self.joint;
        let rate = gyroscope.rate_hz();
        let state = &self.fit.state;
        let angle = |miss: &Miss| miss.error.norm().min(1.0).asin();
        joint
            .rotations
            .iter()
            .zip(self.spans)
            .enumerate()
            .map(|(i, (data, span))| {
                let (from_hold, to_hold) = (self.chosen[i], self.chosen[i + 1]);
                let at = |imu: &ImuParameters| {
                    joint.miss(data, &State { imu: *imu, forces: state.forces.clone() })
                };
                let (after, before) =
                    if data.used { (at(&state.imu), at(self.before)) } else { (None, None) };
                let studentised = self.weighed.studentised.get(i).copied().unwrap_or(f64::INFINITY);
                let reason = match usable(gyroscope, span, rate) {
                    Err(reason) => Some(reason),
                    Ok(()) if !data.counts => Some(format!(
                        "it misses gravity by {:.2}°, {studentised:.1} standard deviations",
                        after.as_ref().map_or(0.0, &angle).to_degrees()
                    )),
                    Ok(()) => None,
                };
                RotationResult {
                    from_hold,
                    to_hold,
                    start_s: gyroscope.times_s[span.start],
                    end_s: gyroscope.times_s[span.end - 1],
                    path_rad: after.as_ref().map_or(0.0, |miss| miss.rotation.path_rad),
                    peak_radps: after.as_ref().map_or(0.0, |miss| miss.rotation.peak_radps),
                    error_rad: after.as_ref().map_or(0.0, &angle),
                    error_before_rad: before.as_ref().map_or(0.0, &angle),
                    studentised: if studentised.is_finite() { studentised } else { 0.0 },
                    used: data.used && data.counts,
                    reason,
                }
            })
            .collect()
    }
}

//! What a user should know about the calibration of an IMU, in words.

use super::joint::{Joint, RotationData, State, TurnData};
use super::start::{Axes, FirstLook, Start, WRONG};
use super::tilted;
use super::{ImuCalibration, RotationResult};
use crate::error::{Complaint, Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::estimate::change::longest_run;
use crate::estimate::{CalibrationStatus, Changed, HoldCalibration};
use crate::information::Undetermined;
use crate::sensor::{Axis, ImuParameters, ImuQuantity, Quantity, ReadingUnit, Thermal, Triad};
use nalgebra::DMatrix;

/// Holds that scatter by more than this share of gravity are none.
const MOVING: f64 = 0.005;

/// Entries of the gyroscope's matrix known to less than this share of its gain are not determined.
const VAGUE: f64 = 0.1;
/// An axis that shows less than this in all rotations does not turn, rad: noise and drift of the bias.
const HARDLY: f64 = 0.05;
const REMEDY: &str = "turn the sensor between the holds, by 90° and more, about each of its axes, away from the vertical; at least 8 rotations";

/// Says what is not determined, and what would determine it.
pub(super) fn undetermined(joint: &Joint<'_>, groups: &[Undetermined]) -> NotIdentifiable {
    let rotations = joint.rotations.iter().filter(|rotation| rotation.used).count();
    let by_rotations = || {
        match rotations {
        0 if joint.holds.len() < 2 => "there is no rotation between two holds".to_owned(),
        0 => "no rotation between the holds can be integrated: the gyroscope has too few samples in them, pauses, or saturates".to_owned(),
        1 => "one rotation between two holds gives two equations".to_owned(),
        count => match axes_of(joint, &groups.iter().flat_map(|found| found.parameters.clone()).collect::<Vec<_>>()) {
            Some(axes) => format!("the {count} rotations between the holds do not turn about {axes}, or by too little"),
            None => format!("the {count} rotations between the holds do not turn about all axes, or turn by too little"),
        },
    }
    };
    let (reason, remedy) = missing_turns(joint).unwrap_or_else(|| (by_rotations(), REMEDY.into()));
    let names =
        |places: &[usize]| -> Vec<String> { places.iter().map(|&k| joint.quantities[k].name()).collect() };
    let all = joint.gyroscope_places();
    let group = |parameters: Vec<String>, free_combinations: usize| UndeterminedGroup {
        parameters,
        free_combinations,
        reason: reason.clone(),
        remedy: remedy.clone(),
    };
    let by_temperature = |found: &Undetermined| {
        UndeterminedGroup {
        parameters: names(&found.parameters),
        free_combinations: found.free_combinations,
        reason: format!(
            "the {} holds and what lies between them have too few temperatures, or each temperature has its own orientation",
            joint.holds.len()
        ),
        remedy: "record over a wider range of temperatures, in several orientations at each; or lower the order in [temperature], or give the terms in [known]".into(),
    }
    };
    let thermal = |found: &Undetermined| {
        found.parameters.iter().any(|&k| matches!(joint.quantities[k], ImuQuantity::Thermal(..)))
    };
    let of_accelerometer = |found: &Undetermined| {
        found.parameters.iter().all(|&k| joint.quantities[k].triad() == Triad::Accelerometer)
    };
    NotIdentifiable {
        groups: if groups.is_empty() {
            vec![group(names(&all), all.len().saturating_sub(3 + 2 * rotations).max(1))]
        } else {
            groups
                .iter()
                .map(|found| match (thermal(found), of_accelerometer(found)) {
                    (true, _) => by_temperature(found),
                    (false, true) => UndeterminedGroup {
                        reason: format!("the {} holds do not spread enough", joint.holds.len()),
                        remedy: "hold the sensor still in at least 12 well-spread orientations".into(),
                        ..group(names(&found.parameters), found.free_combinations)
                    },
                    (false, false) => group(names(&found.parameters), found.free_combinations),
                })
                .collect()
        },
    }
}

/// The same error, where rotations were left out before it: it says how many, and why one of them.
pub(super) fn with_obstacles(error: Error, obstacles: &[String]) -> Error {
    let (Error::NotIdentifiable(undetermined), Some(first)) = (&error, obstacles.first()) else {
        return error;
    };
    let mut groups = undetermined.groups.clone();
    for group in &mut groups {
        group.reason = format!(
            "{}; {} rotation{} could not be integrated: {first}",
            group.reason,
            obstacles.len(),
            if obstacles.len() == 1 { "" } else { "s" }
        );
    }
    Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
}

/// The axes, in words, whose scale factor of the gyroscope is among these quantities, where not all three are.
fn axes_of(joint: &Joint<'_>, places: &[usize]) -> Option<String> {
    let is_scale = |axis: &Axis| {
        let scale = ImuQuantity::Of(Triad::Gyroscope, Quantity::Scale(*axis));
        places.iter().any(|&k| joint.quantities[k] == scale)
    };
    let axes: Vec<Axis> = Axis::ALL.into_iter().filter(is_scale).collect();
    match axes.len() {
        1 => Some(format!("axis {}", listed(&axes, ""))),
        2 => Some(format!("axes {}", listed(&axes, ""))),
        _ => None,
    }
}

/// `x_rot, y_rot and z_rot`: axes with an ending.
fn listed(axes: &[Axis], ending: &str) -> String {
    let names: Vec<String> = axes.iter().map(|axis| format!("{axis}{ending}")).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}

/// What turns of known angle are missing on known faces, between which nothing is integrated, and what to add.
fn missing_turns(joint: &Joint<'_>) -> Option<(String, String)> {
    let on_faces = joint.holds.iter().all(|hold| hold.known.is_some());
    if !on_faces || joint.rotations.iter().any(|rotation| rotation.used) {
        return None;
    }
    let about =
        |axis: &Axis| joint.turns.iter().any(|turn| turn.angle[axis.index()].abs() > 0.5 * turn.angle.norm());
    let (turned, missing): (Vec<Axis>, Vec<Axis>) = Axis::ALL.into_iter().partition(about);
    let reason = match (turned.as_slice(), joint.turns.len()) {
        _ if missing.is_empty() => return None,
        ([], 0) => {
            "there is no turn of known angle, and no rotation between the faces that can be integrated".into()
        }
        (_, 1) => format!("the one turn of known angle is about {}", listed(&turned, "")),
        (_, count) => format!("the {count} turns of known angle are about {} only", listed(&turned, "")),
    };
    let remedy = format!(
        "add a turn about {}: in gyroscope.turns, or as {} in the list of sections",
        listed(&missing, ""),
        listed(&missing, "_rot")
    );
    Some((reason, remedy))
}

/// Axes of the gyroscope that show hardly a turn in any rotation, in a complaint; nothing where gravity does not move much either.
fn unturned(joint: &Joint<'_>, state: &State) -> Option<Complaint> {
    let used = || joint.rotations.iter().filter(|rotation| rotation.used);
    let moved = used()
        .map(|rotation| state.forces[rotation.from].angle(&state.forces[rotation.from + 1]))
        .fold(0.0, f64::max);
    let turned = |axis: &Axis| {
        let angle = |rotation: &RotationData<'_>| {
            let samples = &rotation.samples;
            let bias = state.imu.at(samples.temperature_c()).gyroscope.bias[axis.index()];
            let gain = state.imu.gyroscope.matrix.row(axis.index()).norm();
            let steps = samples.times_s.windows(2).zip(samples.readings);
            steps.map(|(t, y)| (t[1] - t[0]) * (y[axis.index()] - bias)).sum::<f64>().abs() / gain
        };
        used().map(angle).fold(0.0, f64::max)
    };
    let still: Vec<Axis> = Axis::ALL.into_iter().filter(|axis| turned(axis) < HARDLY).collect();
    if still.is_empty() || moved < WRONG {
        return None;
    }
    let most = still.iter().map(turned).fold(0.0, f64::max);
    Some(Complaint::new(
        format!(
            "the gyroscope hardly turns about its ax{} {}: by less than {:.0}° between two holds, while gravity turns by up to {:.0}°",
            if still.len() == 1 { "is" } else { "es" },
            listed(&still, ""),
            most.to_degrees().floor() + 1.0,
            moved.to_degrees()
        ),
        "are its columns the right ones, in the right unit, and of this recording? is each axis connected?",
    ))
}

/// Entries of the gyroscope's matrix that the data determine so little that the iteration has nothing to hold on to, although no combination is quite free:
/// the noise of a gyroscope that does not turn looks like a small rotation.
pub(super) fn vague(joint: &Joint<'_>, state: &State, covariance: &DMatrix<f64>) -> Option<NotIdentifiable> {
    let rotations = joint.rotations.iter().filter(|rotation| rotation.used).count();
    let gain = match turned_gain(joint, &state.imu).filter(|_| rotations == 0) {
        // no start was looked for: the matrix is still any
        Some(gain) => gain,
        None => (state.imu.gyroscope.matrix.norm_squared() / 3.0).sqrt(),
    };
    let is_known = |k: usize| joint.prior.as_ref().is_some_and(|(_, weight)| weight[k] > 0.0);
    let sd = |k: usize| covariance[(k, k)].max(0.0).sqrt() / gain;
    let entries: Vec<usize> = joint
        .gyroscope_places()
        .into_iter()
        .filter(|&k| match joint.quantities[k] {
            ImuQuantity::Of(_, Quantity::Bias(_))
            | ImuQuantity::GSensitivity(..)
            | ImuQuantity::Thermal(..) => false,
            ImuQuantity::Of(..) => sd(k) > VAGUE && !is_known(k),
        })
        .collect();
    let most = entries.iter().map(|&k| sd(k)).fold(0.0, f64::max);
    let hardly = || {
        let reason = format!(
            "the {rotations} rotations between the holds hardly turn about {}: the gain would be known to {:.0} % at best",
            axes_of(joint, &entries).unwrap_or_else(|| "some axis".into()),
            100.0 * most
        );
        (reason, REMEDY.into())
    };
    let (reason, remedy) = missing_turns(joint).unwrap_or_else(hardly);
    (!entries.is_empty()).then(|| NotIdentifiable {
        groups: vec![UndeterminedGroup {
            parameters: entries.iter().map(|&k| joint.quantities[k].name()).collect(),
            free_combinations: entries.len(),
            reason,
            remedy,
        }],
    })
}

/// The largest gain that the turns of known angle show.
fn turned_gain(joint: &Joint<'_>, imu: &ImuParameters) -> Option<f64> {
    let gain = |turn: &TurnData| turn.beyond_bias(imu).norm() / turn.angle.norm();
    joint.turns.iter().map(gain).reduce(f64::max)
}

/// Refuses readings that cannot be angular rates in the unit given.
pub(super) fn plausible(
    joint: &Joint<'_>,
    state: &State,
    start: &Start,
    unit: ReadingUnit,
    holds: &HoldCalibration,
) -> Result<()> {
    if start.median_rad <= WRONG {
        return Ok(());
    }
    let degrees = start.median_rad.to_degrees();
    let message = format!(
        "half of the rotations miss gravity by more than {degrees:.0}°: the gyroscope's readings do not fit the accelerometer's"
    );
    if unit == ReadingUnit::RadianPerSecond {
        let per_degree = state.imu.gyroscope.matrix * (180.0 / std::f64::consts::PI);
        let so_read = FirstLook::of(joint, state).judge(&per_degree);
        if so_read.is_some_and(|look| look.median_rad < 0.5 * start.median_rad) {
            return Err(Error::recording(Complaint::new(
                format!(
                    "the gyroscope's readings are in deg/s, not rad/s: so read, the rotations miss gravity by {degrees:.0}°"
                ),
                "say that the gyroscope is in deg/s",
            )));
        }
    }
    if let Some(complaint) = unturned(joint, state) {
        return Err(Error::recording(complaint));
    }
    let scatter = holds.between_holds_sd_mps2;
    if scatter > MOVING * joint.gravity {
        let message = format!(
            "{message}, and the holds themselves scatter by {:.0} mm/s² beyond their noise",
            1e3 * scatter
        );
        let help = "was the sensor still in them? they are the calmest parts of the recording (holds.minimum_hold_s, holds.intervals_s)";
        return Err(Error::recording(Complaint::new(message, help)));
    }
    Err(Error::recording(Complaint::new(
        message,
        "do both files belong to one recording, with one clock? are the axes of the gyroscope those of the accelerometer? does the gyroscope saturate?",
    )))
}

/// Warnings about a fit.
pub(super) fn warnings(calibration: &ImuCalibration, axes: Option<&Axes>) -> Vec<String> {
    let mut warnings = Vec::new();
    if calibration.status != CalibrationStatus::Converged {
        warnings.push(format!(
            "the iteration did not converge ({}): the numbers are the best found, not the optimum",
            calibration.status.name()
        ));
    }
    warnings.extend(axes.map(|axes| match axes {
        Axes::InOrder([x, y, z]) => format!(
            "the gyroscope's axes are not the accelerometer's: along x, y and z of the accelerometer lie {x}, {y} and {z} of the gyroscope"
        ),
        Axes::Turned => tilted::in_words(&calibration.imu.gyroscope.matrix),
    }));
    for rotation in calibration.rotations.iter().filter(|rotation| !rotation.used) {
        let reason = rotation.reason.as_deref().unwrap_or("it does not fit");
        warnings.push(format!(
            "the rotation from hold {} to hold {} ({:.1} to {:.1} s) was left out: {reason}",
            rotation.from_hold + 1,
            rotation.to_hold + 1,
            rotation.start_s,
            rotation.end_s
        ));
    }
    warnings.extend(rotations_in_a_row(calibration));
    warnings
}

/// Rotations that were left out one after another, where no change explains them.
fn rotations_in_a_row(calibration: &ImuCalibration) -> Option<String> {
    let rotations: Vec<&RotationResult> =
        calibration.rotations.iter().filter(|rotation| rotation.is_integrated()).collect();
    let run = longest_run(rotations.iter().map(|rotation| !rotation.used))?;
    let explained = calibration
        .changes
        .iter()
        .any(|change| change.of != Changed::Bias || change.triad == Triad::Accelerometer);
    (!explained).then(|| {
        format!(
            "the {} rotations from {:.1} to {:.1} s were left out one after another, which is no chance: did the gyroscope saturate there, or one of the sensors change?",
            run.len(),
            rotations[run.start].start_s,
            rotations[run.end - 1].end_s
        )
    })
}

/// Warns where the polynomials of temperature are used beyond the temperatures of the holds.
pub(super) fn extrapolation(thermal: &Thermal, recording_c: Option<[f64; 2]>) -> Vec<String> {
    let (Some([low, high]), Some([coldest, hottest])) = (thermal.range_c, recording_c) else {
        return Vec::new();
    };
    let beyond = |t: f64| thermal.extrapolates_to(t);
    let mut warnings = Vec::new();
    if beyond(coldest) || beyond(hottest) {
        warnings.push(format!(
            "the recording goes from {coldest:.1} to {hottest:.1} °C, its holds from {low:.1} to {high:.1} °C only: beyond these the polynomials of temperature extrapolate"
        ));
    }
    if beyond(thermal.reference_c) {
        warnings.push(format!(
            "biases and gains are given at the reference of {:.1} °C, beyond the {low:.1} to {high:.1} °C of the holds: there they are extrapolated",
            thermal.reference_c
        ));
    }
    warnings
}

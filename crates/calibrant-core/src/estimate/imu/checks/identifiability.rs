//! Are all parameters determined? If not, which, and what would determine them.

use crate::diagnostic::RotationReason;
use crate::error::{Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::estimate::imu::checks::axes_in_words::axes_in_words;
use crate::estimate::imu::model::{Fit, ImuModel, State, TurnData};
use crate::information::{self, Undetermined};
use crate::sensor::{Axis, ImuParameters, ImuQuantity, Quantity, SensorKind};
use nalgebra::DMatrix;

/// An entry of the gyroscope's matrix is not determined where it is known to less than this share of its gain.
const VAGUE_SHARE: f64 = 0.1;

/// What determines the gyroscope's matrix.
const REMEDY: &str = "turn the sensor between the holds, by 90° and more, about each of its axes, away from the vertical; at least 8 rotations";

/// Refuses a problem that leaves parameters open at this state. `fit`: the problem linearised there.
pub(crate) fn check(model: &ImuModel<'_>, state: &State, fit: &Fit) -> Result<()> {
    let groups = information::undetermined(&fit.information, &fit.unreduced, model.holds.len());
    if !groups.is_empty() {
        return Err(Error::NotIdentifiable(Box::new(undetermined(model, &groups))));
    }
    match information::covariance(&fit.information).and_then(|covariance| vague(model, state, &covariance)) {
        Some(vague) => Err(Error::NotIdentifiable(Box::new(vague))),
        None => Ok(()),
    }
}

/// Says what is not determined, and what would determine it.
pub(crate) fn undetermined(model: &ImuModel<'_>, groups: &[Undetermined]) -> NotIdentifiable {
    let rotations = model.rotations.iter().filter(|rotation| rotation.used).count();
    let by_rotations = || {
        match rotations {
        0 if model.holds.len() < 2 => "there is no rotation between two holds".to_owned(),
        0 => "no rotation between the holds can be integrated: the gyroscope has too few samples in them, pauses, or saturates".to_owned(),
        1 => "one rotation between two holds gives two equations".to_owned(),
        count => match axes_of(model, &groups.iter().flat_map(|found| found.parameters.clone()).collect::<Vec<_>>()) {
            Some(axes) => format!("the {count} rotations between the holds do not turn about {axes}, or by too little"),
            None => format!("the {count} rotations between the holds do not turn about all axes, or turn by too little"),
        },
    }
    };
    let (reason, remedy) = missing_turns(model).unwrap_or_else(|| (by_rotations(), REMEDY.into()));
    let names =
        |places: &[usize]| -> Vec<String> { places.iter().map(|&k| model.quantities[k].name()).collect() };
    let all = model.gyroscope_places();
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
            model.holds.len()
        ),
        remedy: "record over a wider range of temperatures, in several orientations at each; or lower the order in [temperature], or give the terms in [known]".into(),
    }
    };
    let thermal = |found: &Undetermined| {
        found.parameters.iter().any(|&k| matches!(model.quantities[k], ImuQuantity::Thermal(..)))
    };
    let of_accelerometer = |found: &Undetermined| {
        found.parameters.iter().all(|&k| model.quantities[k].sensor_kind() == SensorKind::Accelerometer)
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
                        reason: format!("the {} holds do not spread enough", model.holds.len()),
                        remedy: "hold the sensor still in at least 14 well-spread orientations".into(),
                        ..group(names(&found.parameters), found.free_combinations)
                    },
                    (false, false) => group(names(&found.parameters), found.free_combinations),
                })
                .collect()
        },
    }
}

/// The same error, where rotations were left out before it: it says how many, and why one of them.
pub(crate) fn with_obstacles(error: Error, obstacles: &[RotationReason]) -> Error {
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
fn axes_of(model: &ImuModel<'_>, places: &[usize]) -> Option<String> {
    let is_scale = |axis: &Axis| {
        let scale = ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(*axis));
        places.iter().any(|&k| model.quantities[k] == scale)
    };
    let axes: Vec<Axis> = Axis::ALL.into_iter().filter(is_scale).collect();
    match axes.len() {
        1 => Some(format!("axis {}", axes_in_words(&axes, ""))),
        2 => Some(format!("axes {}", axes_in_words(&axes, ""))),
        _ => None,
    }
}

/// What turns of known angle are missing on known faces, between which nothing is integrated, and what to add.
fn missing_turns(model: &ImuModel<'_>) -> Option<(String, String)> {
    let on_faces = model.holds.iter().all(|hold| hold.known.is_some());
    if !on_faces || model.rotations.iter().any(|rotation| rotation.used) {
        return None;
    }
    let about =
        |axis: &Axis| model.turns.iter().any(|turn| turn.angle[axis.index()].abs() > 0.5 * turn.angle.norm());
    let (turned, missing): (Vec<Axis>, Vec<Axis>) = Axis::ALL.into_iter().partition(about);
    let reason = match (turned.as_slice(), model.turns.len()) {
        _ if missing.is_empty() => return None,
        ([], 0) => {
            "there is no turn of known angle, and no rotation between the faces that can be integrated".into()
        }
        (_, 1) => format!("the one turn of known angle is about {}", axes_in_words(&turned, "")),
        (_, count) => {
            format!("the {count} turns of known angle are about {} only", axes_in_words(&turned, ""))
        }
    };
    let remedy = format!(
        "add a turn about {}: in gyroscope.turns, or as {} in the list of sections",
        axes_in_words(&missing, ""),
        axes_in_words(&missing, "_rot")
    );
    Some((reason, remedy))
}

/// Entries of the gyroscope's matrix that the data determine so little that the iteration has nothing to hold on to, although no combination is quite free:
/// the noise of a gyroscope that does not turn looks like a small rotation.
fn vague(model: &ImuModel<'_>, state: &State, covariance: &DMatrix<f64>) -> Option<NotIdentifiable> {
    let rotations = model.rotations.iter().filter(|rotation| rotation.used).count();
    let gain = match turned_gain(model, &state.imu).filter(|_| rotations == 0) {
        // no start was looked for: the matrix is still any
        Some(gain) => gain,
        None => (state.imu[SensorKind::Gyroscope].matrix.norm_squared() / 3.0).sqrt(),
    };
    let is_known = |k: usize| model.prior.as_ref().is_some_and(|(_, weight)| weight[k] > 0.0);
    let sd = |k: usize| covariance[(k, k)].max(0.0).sqrt() / gain;
    let entries: Vec<usize> = model
        .gyroscope_places()
        .into_iter()
        .filter(|&k| match model.quantities[k] {
            ImuQuantity::Of(_, Quantity::Bias(_))
            | ImuQuantity::GSensitivity(..)
            | ImuQuantity::Thermal(..) => false,
            ImuQuantity::Of(..) => sd(k) > VAGUE_SHARE && !is_known(k),
        })
        .collect();
    let most = entries.iter().map(|&k| sd(k)).fold(0.0, f64::max);
    let hardly = || {
        let reason = format!(
            "the {rotations} rotations between the holds hardly turn about {}: the gain would be known to {:.0} % at best",
            axes_of(model, &entries).unwrap_or_else(|| "some axis".into()),
            100.0 * most
        );
        (reason, REMEDY.into())
    };
    let (reason, remedy) = missing_turns(model).unwrap_or_else(hardly);
    (!entries.is_empty()).then(|| NotIdentifiable {
        groups: vec![UndeterminedGroup {
            parameters: entries.iter().map(|&k| model.quantities[k].name()).collect(),
            free_combinations: entries.len(),
            reason,
            remedy,
        }],
    })
}

/// The largest gain that the turns of known angle show.
fn turned_gain(model: &ImuModel<'_>, imu: &ImuParameters) -> Option<f64> {
    let gain = |turn: &TurnData| turn.beyond_bias(imu).norm() / turn.angle.norm();
    model.turns.iter().map(gain).reduce(f64::max)
}

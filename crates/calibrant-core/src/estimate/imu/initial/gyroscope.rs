//! Initial values of the gyroscope: its bias, and the scatter of its means between holds.
//!
//! Its gain and the order of its axes come from the rotations (`alignment`).

use crate::estimate::hold_result::HoldResult;
use crate::estimate::imu::estimated::set_fixed;
use crate::estimate::imu::initial::accelerometer::{InitialAccelerometer, UsedHolds};
use crate::estimate::imu::model::{HoldData, Prior};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::imu::variance_components::between_holds::{
    Explanation, Means, between_sd, set_gyroscope_means,
};
use crate::estimate::recording_biases::Recordings;
use crate::sensor::{
    ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorParameters, Thermal, ThermalTerm,
};
use nalgebra::{Matrix3, Vector3};

/// The start of the least squares.
pub(crate) struct InitialValues {
    pub(crate) imu: ImuParameters,
    /// The holds with the weights of both sensors.
    pub(crate) holds: Vec<HoldData>,
    /// Scatter of the gyroscope's means between holds.
    pub(crate) between: Vector3<f64>,
}

/// The gyroscope's means, and their explaining variables.
pub(crate) fn explained_means<'a>(
    problem: &ImuProblem<'_>,
    (first, temperature): (&InitialAccelerometer, &RecordingTemperature<'_>),
    used: &'a UsedHolds<'_>,
    gyroscope: &'a StationaryGyroscope,
    (quantities, prior): (&[ImuQuantity], Option<&Prior>),
) -> Means<'a> {
    let thermal = temperature.start.with(SensorKind::Accelerometer, first.thermal);
    let by = Explanation {
        recordings: Recordings::default(),
        forces: problem.gyroscope.g_sensitivity.then_some(used.forces.as_slice()),
        of_earth: earth_in_holds(problem, &used.forces),
        by_earth: Vec::new(),
        tau_k: used.holds.iter().map(|hold| thermal.tau_k(temperature.of_hold(hold))).collect(),
        fixed: thermal[SensorKind::Gyroscope],
        terms: std::array::from_fn(|axis| bias_terms(quantities, prior, axis)),
    };
    Means { readings: &gyroscope.readings, noise: &gyroscope.noise, by }
}

/// Computes the initial values from the holds.
pub(crate) fn initial_values(
    problem: &ImuProblem<'_>,
    (first, temperature): (&InitialAccelerometer, &RecordingTemperature<'_>),
    numbers: &[usize],
    means: &Means<'_>,
) -> InitialValues {
    let mut holds = hold_data(first, numbers, temperature);
    let mut thermal = temperature.start.with(SensorKind::Accelerometer, first.thermal);
    let between;
    (between, thermal[SensorKind::Gyroscope]) = between_sd(means);
    set_gyroscope_means(&mut holds, means.readings, means.noise, &between);
    InitialValues { imu: start_values(problem, first, &holds, thermal), holds, between }
}

/// The gyroscope's readings of the Earth's rate about the vertical at these forces, with the datasheet's gain.
///
/// Zero if the g-sensitivity is estimated, which includes this rate, or if the gain is unknown.
fn earth_in_holds(problem: &ImuProblem<'_>, forces: &[Vector3<f64>]) -> Option<Vec<Vector3<f64>>> {
    let gain = match problem.gyroscope.unit {
        ReadingUnit::Counts => problem.gyroscope.gain?,
        _ => Vector3::repeat(1.0),
    };
    let reading = gain * problem.setup.vertical_rate();
    let is_free = problem.gyroscope.g_sensitivity;
    (!is_free).then(|| forces.iter().map(|force| force.component_mul(&reading)).collect())
}

/// The used holds with the accelerometer's weights.
fn hold_data(
    first: &InitialAccelerometer,
    numbers: &[usize],
    temperature: &RecordingTemperature<'_>,
) -> Vec<HoldData> {
    let holds = &first.holds;
    numbers
        .iter()
        .map(|&j| {
            let HoldResult { hold, force_mps2, .. } = &holds.holds[j];
            HoldData {
                accelerometer: hold.mean,
                accelerometer_weight: match &first.alignment {
                    Some(alignment) => first.weight_on_face(hold, force_mps2, &alignment.widened),
                    None => first.weight(hold, holds.between_holds_sd_mps2),
                },
                gyroscope: None,
                known: first.alignment.map(|alignment| force_mps2 * alignment.cosine()),
                temperature_c: temperature.of_hold(hold),
            }
        })
        .collect()
}

fn start_values(
    problem: &ImuProblem<'_>,
    first: &InitialAccelerometer,
    holds: &[HoldData],
    thermal: Thermal,
) -> ImuParameters {
    let mut imu = ImuParameters {
        sensors: [
            first.sensor,
            SensorParameters {
                bias: mean_bias(holds, &thermal),
                matrix: Matrix3::identity(),
                ..SensorParameters::identity()
            },
        ]
        .into(),
        g_sensitivity: Matrix3::zeros(),
        thermal,
    };
    if let Some(gain) = problem.gyroscope.gain {
        imu[SensorKind::Gyroscope].matrix = Matrix3::from_diagonal(&gain);
    }
    set_fixed(&mut imu, problem.setup);
    imu
}

/// The mean of the gyroscope's readings over the holds, converted to the reference temperature: its bias.
pub(crate) fn mean_bias(holds: &[HoldData], thermal: &Thermal) -> Vector3<f64> {
    let (mut sum, mut weights) = (Vector3::zeros(), Vector3::zeros());
    for hold in holds {
        let Some((mean, weight)) = &hold.gyroscope else { continue };
        let change = thermal[SensorKind::Gyroscope].bias_change(thermal.tau_k(hold.temperature_c));
        sum += (mean - change).component_mul(weight);
        weights += weight;
    }
    sum.component_div(&weights.map(|weight| weight.max(f64::MIN_POSITIVE)))
}

/// The gyroscope's bias terms per axis for the fit of its means: power, expected value and inverse variance (0 where nothing is known).
fn bias_terms(
    quantities: &[ImuQuantity],
    prior: Option<&Prior>,
    axis: usize,
) -> Vec<(ThermalTerm, f64, f64)> {
    quantities
        .iter()
        .enumerate()
        .filter(|(_, quantity)| quantity.sensor_kind() == SensorKind::Gyroscope && quantity.is_of_bias())
        .filter_map(|(k, quantity)| match quantity {
            ImuQuantity::Thermal(_, term) if term.axis.index() == axis => {
                let (mean, weight) = prior.map_or((0.0, 0.0), |(mean, weight)| (mean[k], weight[k]));
                Some((*term, mean, weight))
            }
            _ => None,
        })
        .collect()
}

//! What a user should know of a result on a machine.

use super::flexure::Flexure;
use super::unseen_mount::allow_for;
use super::{plausible, separability};
use crate::estimate::problem::Layout;
use crate::estimate::{
    MachineCalibration, MachineQuantity, MachineSetup, MachineTrust, SensorDrift, SensorResidual,
};
use calibrant_core::diagnostic::change::SensorDrifts;
use calibrant_core::diagnostic::datasheet::ScaleNegative;
use calibrant_core::diagnostic::fit::{ModelContradicted, NotConverged};
use calibrant_core::diagnostic::machine::{
    LogCoversPart, LogOutliers, MachineResiduals, PriorContradicted, PriorRefuted, ReferenceUndermodelled,
    ResidualsCorrelated,
};
use calibrant_core::diagnostic::{Changed, Check, Diagnostic, Severity};
use calibrant_core::estimate::{CalibrationStatus, HoldsSetup, implausible_gains};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, ReadingUnit, SensorKind};

/// Largest usual ratio of the residuals to the noise between neighbouring samples, with noisy trust,
pub(crate) const LARGEST_EXCESS: f64 = 1.1;
/// and with known trust.
const WITH_KNOWN_TRUST: f64 = 1.25;
/// Largest usual distance of a quantity from its prior mean, in prior standard deviations.
const CONTRADICTED: f64 = 4.0;
/// A quantity that is farther than this is not what was described: a standard deviation that is stated ten times too small leaves three tenths of it.
const REFUTED: f64 = 30.0;
/// From this ratio of the residuals on, a mistake is looked for.
const LARGE: f64 = 2.0;
/// A ratio of the residuals beyond this refuses the model.
pub(crate) const REFUSED: f64 = 10.0;
/// From this factor on, nine tenths of a variance are of errors that the model does not have.
const UNDERMODELLED: f64 = 3.0;
/// A drift of this p-value is no chance.
const NO_CHANCE: f64 = 1e-4;
/// Usual drifts of a gyroscope's bias, rad/s, and of gains, over a recording: 0.005 °/s and 0.01 % per kelvin (MEMS), ten kelvin.
const USUAL_DRIFT_RADPS: f64 = 8.7e-4;
const USUAL_DRIFT_OF_GAINS: f64 = 1e-3;
/// A drift beyond this many usual ones, or whose half is beyond this many standard deviations of the parameter, is not covered by what is stated.
const FAR: f64 = 3.0;
/// Largest usual share of outliers in the log.
pub(crate) const OUTLIERS: f64 = 1e-3;
/// Least usual share of the sensor's samples that are used.
const USED: f64 = 0.95;

/// Adds all of it, the most important first.
pub(crate) fn add(
    setup: &MachineSetup,
    layout: &Layout,
    calibration: &mut MachineCalibration,
    flexure: Flexure,
) {
    let mut found = Vec::new();
    if calibration.sensors.status != CalibrationStatus::Converged {
        found.push(NotConverged { status: calibration.sensors.status.name() }.into());
    }
    found.extend(residuals(calibration));
    found.extend(correlated(calibration));
    found.extend(flexure.found.clone().map(Diagnostic::from));
    found.extend(calibration.noise.iter().flat_map(|of| {
        let matrix = &calibration.parameters.imu.sensor(of.sensor).matrix;
        let unit = calibration.sensors.units[of.sensor].unwrap_or(of.sensor.stimulus_unit());
        let scale = |axis| ImuQuantity::Of(of.sensor, Quantity::Scale(axis));
        implausible_gains(of.sensor, unit, matrix, move |axis| plausible::is_known(setup, scale(axis)))
    }));
    found.extend(reversed_axes(calibration));
    found.extend(plausible::check(setup, calibration));
    found.extend(separability::check(setup, calibration));
    found.extend(contradicted(setup, layout, calibration));
    let (outliers, samples) = calibration.outliers();
    if outliers as f64 > OUTLIERS * samples as f64 {
        found.push(LogOutliers { outliers, samples }.into());
    }
    if calibration.used_share < USED {
        found.push(LogCoversPart { used_share: calibration.used_share }.into());
    }
    allow_for(&flexure, calibration, &mut found);
    let is_doubtful = found.iter().any(Diagnostic::is_warning);
    found.extend(calibration.noise.iter().filter_map(|of| drifts(of, calibration, is_doubtful)));
    calibration.sensors.warnings = found;
}

/// Axes of counts whose gain has the other sign than the nominal one.
fn reversed_axes(calibration: &MachineCalibration) -> impl Iterator<Item = Diagnostic> + '_ {
    let of_counts = |of: &&SensorResidual| calibration.sensors.units[of.sensor] == Some(ReadingUnit::Counts);
    calibration.noise.iter().filter(of_counts).flat_map(|of| {
        let [found, nominal] =
            [&calibration.parameters, &calibration.nominal].map(|of_all| of_all.imu.sensor(of.sensor).matrix);
        let is_reversed = move |axis: &Axis| {
            let along = (axis.index(), axis.index());
            found[along] * nominal[along] < 0.0
        };
        Axis::ALL.into_iter().filter(is_reversed).map(|axis| ScaleNegative { axis }.into())
    })
}

/// Does the result contradict the log, so that a mistake in it is likely?
pub(crate) fn contradict(calibration: &MachineCalibration) -> bool {
    let is_contradiction =
        |found: &Diagnostic| found.severity() == Severity::Error || found.code() == PriorContradicted::CODE;
    let is_large = |of: &SensorResidual| of.excess() > LARGE;
    calibration.sensors.warnings.iter().any(is_contradiction) || calibration.noise.iter().any(is_large)
}

/// Residuals that are larger than the noise of neighbouring samples.
fn residuals(calibration: &MachineCalibration) -> impl Iterator<Item = Diagnostic> + '_ {
    let limit = match calibration.trust {
        MachineTrust::Noisy => LARGEST_EXCESS,
        MachineTrust::Known => WITH_KNOWN_TRUST,
    };
    calibration.noise.iter().filter_map(move |of| {
        let ratio = of.excess();
        let sensor_kind = of.sensor;
        match ratio > limit {
            true if ratio > REFUSED => Some(Diagnostic::from(ModelContradicted { sensor_kind, ratio })),
            true => Some(Diagnostic::from(MachineResiduals { sensor_kind, ratio })),
            false => None,
        }
    })
}

/// The drift of a sensor: beyond what is usual, or the reason of other warnings.
fn drifts(of: &SensorResidual, calibration: &MachineCalibration, is_doubtful: bool) -> Option<Diagnostic> {
    let (sensor_kind, drift) = (of.sensor, of.drift.filter(|drift| drift.p_value < NO_CHANCE)?);
    let unit = calibration.sensors.units[sensor_kind]?;
    let matrix = calibration.parameters.imu.sensor(sensor_kind).matrix;
    let gain = |axis: Axis| matrix[(axis.index(), axis.index())].abs();
    let usual = |axis: Axis| match (drift.of, sensor_kind) {
        (Changed::Bias, SensorKind::Accelerometer) => HoldsSetup::USUAL_DRIFT_SD_MPS2 * gain(axis),
        (Changed::Bias, SensorKind::Gyroscope) => USUAL_DRIFT_RADPS * gain(axis),
        _ => USUAL_DRIFT_OF_GAINS,
    };
    let of_noise = |axis: Axis| {
        let (quantity, size) = match drift.of {
            Changed::Bias => (Quantity::Bias(axis), 1.0),
            _ => (Quantity::Scale(axis), gain(axis)),
        };
        let place = calibration.position(MachineQuantity::Imu(ImuQuantity::Of(sensor_kind, quantity)))?;
        // a drift widens the stated standard deviation as errors of the reference do
        let sd = calibration.linear_covariance[(place, place)].sqrt();
        Some(sd / size)
    };
    let counts = |axis: Axis| {
        let size = drift.amount[axis.index()].abs();
        let refutes = of_noise(axis).is_some_and(|sd| 0.5 * size > FAR * sd);
        let is_reason = is_doubtful && size > usual(axis);
        (is_reason || refutes && size > FAR * usual(axis)) && size > CONTRADICTED * drift.sd[axis.index()]
    };
    let SensorDrift { of, amount, p_value, .. } = drift;
    let is_one = Axis::ALL.into_iter().any(counts);
    is_one.then(|| SensorDrifts { sensor_kind, of, drift: amount, unit, p_value }.into())
}

/// The parameter of the sensor whose standard deviation correlation widens most.
fn correlated(calibration: &MachineCalibration) -> Option<Diagnostic> {
    let of_sensor = |k: &usize| matches!(calibration.quantities[*k], MachineQuantity::Imu(_));
    let widest = (0..calibration.inflation.len())
        .filter(of_sensor)
        .max_by(|one, other| calibration.inflation[*one].total_cmp(&calibration.inflation[*other]))?;
    let (factor, parameter) = (calibration.inflation[widest], calibration.names().swap_remove(widest));
    match factor > 1.0 {
        true if factor > UNDERMODELLED => Some(ReferenceUndermodelled { parameter, factor }.into()),
        true => Some(ResidualsCorrelated { parameter, factor }.into()),
        false => None,
    }
}

/// Quantities that the data move far from what was expected.
fn contradicted(setup: &MachineSetup, layout: &Layout, calibration: &MachineCalibration) -> Vec<Diagnostic> {
    let names = calibration.names();
    let deviation = layout.deviation(&calibration.parameters);
    (0..layout.len())
        .filter_map(|k| {
            let deviations =
                deviation[k].abs() / setup.prior_sd(layout.quantities[k], calibration.noise.len());
            let parameter = names[k].clone();
            match deviations > CONTRADICTED {
                true if deviations > REFUTED => Some(PriorRefuted { parameter, deviations }.into()),
                true => Some(PriorContradicted { parameter, deviations }.into()),
                false => None,
            }
        })
        .collect()
}

//! A result beside the datasheet: parameters, gains and noise that no sensor of the type has.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::datasheet::{BiasImplausible, GainImplausible, GainUnusual, ParameterImplausible};
use crate::diagnostic::fit::{NoiseImplausible, NoiseNotAsGiven};
use crate::diagnostic::holds::HoldsTremble;
use crate::estimate::imu::Prior;
use crate::sensor::{Axis, Parameter, ReadingUnit, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Number of datasheet spreads that a parameter may be from its nominal value.
pub const ALLOWED_SPREADS: f64 = 6.0;
/// Gains of readings in SI that are plausible.
const PLAUSIBLE_GAINS: std::ops::RangeInclusive<f64> = 0.8..=1.25;
/// Gains of readings in SI that sensors have without a word in their datasheet: that says 1 to 3 %.
const USUAL_GAINS: std::ops::RangeInclusive<f64> = 0.96..=1.04;
/// What the uncertainty of an estimate adds to what a datasheet allows, in its standard deviations.
const ALLOWED_DEVIATIONS: f64 = 2.0;
/// A bias of an accelerometer beyond this is gravity that was taken for a bias: half of it. Accelerometers are delivered within a tenth of gravity.
const LARGEST_BIAS_MPS2: f64 = 0.5 * 9.806_65;
/// Logarithm of a factor that is not that of a sensor: sensors are off by 1 to 5 %.
pub(crate) const FACTOR: f64 = 0.05;
/// The gains differ from a common factor by less than this share of its logarithm. Those of a sensor would differ by as much as they are off.
const ALIKE: f64 = 1.0 / 3.0;
/// A noise beyond this multiple of the given one, or below its inverse, is not as given.
const NOT_AS_GIVEN: f64 = 2.0;
/// A noise beyond this multiple of the given one is a fault.
const IMPLAUSIBLE: f64 = 10.0;

/// What the datasheet says of the parameters beforehand: nothing of those without a spread.
pub(super) fn prior(parameters: &[Parameter]) -> Prior {
    let of = |parameter: &Parameter| Some((parameter.nominal?, parameter.spread?.powi(-2)));
    parameters.iter().map(|parameter| of(parameter).unwrap_or_default()).unzip()
}

/// How far a value is from its nominal one, in spreads of datasheet and estimate together. `None` where the datasheet does not say.
fn deviations(parameter: &Parameter, value: f64, sd: f64) -> Option<f64> {
    let spread = parameter.spread.filter(|spread| *spread > 0.0)?.hypot(sd);
    Some(((value - parameter.nominal?) / spread).abs())
}

/// The parameter that is farthest beyond what the datasheet allows: a mistake is more likely than a rare sensor.
#[must_use]
pub fn beyond_datasheet(parameters: &[Parameter], values: &[f64], sd: &[f64]) -> Option<Diagnostic> {
    let (name, times) = (parameters.iter().zip(values).zip(sd))
        .filter_map(|((parameter, value), sd)| Some((&parameter.name, deviations(parameter, *value, *sd)?)))
        .max_by(|one, other| one.1.total_cmp(&other.1))?;
    (times > ALLOWED_SPREADS)
        .then(|| Diagnostic::from(ParameterImplausible { parameter: name.clone(), deviations: times }))
}

/// The gains of readings in SI that are far from one, and those that are off by more than is usual. `allowed`: does the datasheet allow for the gain of this axis?
pub fn implausible_gains(
    sensor_kind: SensorKind,
    unit: ReadingUnit,
    matrix: &Matrix3<f64>,
    allowed: impl Fn(Axis) -> bool,
) -> Vec<Diagnostic> {
    let along = |axis: Axis| matrix[(axis.index(), axis.index())];
    let is_off = |axis: &Axis| !USUAL_GAINS.contains(&along(*axis)) && !allowed(*axis);
    let off = Axis::ALL.into_iter().filter(is_off).filter(|_| unit != ReadingUnit::Counts);
    let said = |axis: Axis| match along(axis) {
        gain if PLAUSIBLE_GAINS.contains(&gain) => Diagnostic::from(GainUnusual { sensor_kind, axis, gain }),
        gain => GainImplausible { sensor_kind, axis, gain, unit }.into(),
    };
    off.map(said).collect()
}

/// The bias of an accelerometer of SI readings that is more than half of gravity. `allowed`: does the datasheet allow for the bias of this axis?
pub fn implausible_bias(
    unit: ReadingUnit,
    bias: &Vector3<f64>,
    allowed: impl Fn(Axis) -> bool,
) -> Option<Diagnostic> {
    let own = Vector3::from_fn(|k, _| if allowed(Axis::ALL[k]) { 0.0 } else { bias[k] });
    let is_far = unit == ReadingUnit::MetrePerSecondSquared && own.norm() > LARGEST_BIAS_MPS2;
    is_far.then(|| BiasImplausible { bias_mps2: bias.norm() }.into())
}

/// The one factor by which all three gains are off, where they are: a sensor's own differ from each other. `nominal`: the gains of its datasheet.
#[must_use]
pub fn common_factor(matrix: &Matrix3<f64>, nominal: &Vector3<f64>) -> Option<f64> {
    let logarithms = Axis::ALL.map(|axis| (matrix.row(axis.index()).norm() / nominal[axis.index()]).ln());
    let mean = logarithms.iter().sum::<f64>() / 3.0;
    let is_common = logarithms.iter().all(|of_axis| (of_axis - mean).abs() < ALIKE * mean.abs());
    (is_common && mean.abs() > FACTOR).then(|| mean.exp())
}

/// Does the datasheet allow for the gain of an axis, from a list that ends in the scale factors' names?
#[must_use]
pub fn allows_gain(parameters: &[Parameter], values: &[f64], sd: &[f64], axis: Axis) -> bool {
    allows(&format!("scale.{axis}"), parameters, values, sd)
}

/// The same of the accelerometer's bias.
pub(crate) fn allows_bias(parameters: &[Parameter], values: &[f64], sd: &[f64], axis: Axis) -> bool {
    allows(&format!("accelerometer.bias.{axis}"), parameters, values, sd)
}

/// An estimate that is hardly determined is not allowed anything for that: 5.7 ± 0.9 is no gain of a sensor of 1.00 ± 0.01.
fn allows(ending: &str, parameters: &[Parameter], values: &[f64], sd: &[f64]) -> bool {
    (parameters.iter().zip(values).zip(sd))
        .filter(|((parameter, _), _)| parameter.name.ends_with(ending))
        .filter_map(|((parameter, value), sd)| {
            let spread = parameter.spread.filter(|spread| *spread > 0.0)?;
            Some((value - parameter.nominal?).abs() <= ALLOWED_SPREADS * spread + ALLOWED_DEVIATIONS * sd)
        })
        .any(|is_allowed| is_allowed)
}

/// The noise within holds, where it differs from the given noise by more than a factor of two on an axis. A calibration from holds uses the noise that it finds.
#[must_use]
pub fn noise_not_as_given(
    sensor_kind: SensorKind,
    found: &Vector3<f64>,
    given: &Vector3<f64>,
) -> Option<Diagnostic> {
    let (axis, ratio) = farthest(found, given)?;
    match ratio.max(1.0 / ratio) > NOT_AS_GIVEN {
        true if ratio > IMPLAUSIBLE => Some(Diagnostic::from(HoldsTremble { sensor_kind, axis, ratio })),
        true => Some(Diagnostic::from(NoiseNotAsGiven { sensor_kind, axis, ratio })),
        false => None,
    }
}

/// The noise of residuals, where it is so far above the given noise that sensor, unit or given noise is wrong.
#[must_use]
pub fn noise_implausible(
    sensor_kind: SensorKind,
    found: &Vector3<f64>,
    given: &Vector3<f64>,
) -> Option<NoiseImplausible> {
    let (axis, ratio) = farthest(found, given)?;
    (ratio > IMPLAUSIBLE).then_some(NoiseImplausible { sensor_kind, axis, ratio })
}

/// The axis whose noise differs most from the given one, and its ratio to that.
fn farthest(found: &Vector3<f64>, given: &Vector3<f64>) -> Option<(Axis, f64)> {
    let ratio = |axis: Axis| found[axis.index()] / given[axis.index()];
    let off = |axis: &Axis| ratio(*axis).max(1.0 / ratio(*axis));
    let axis = Axis::ALL.into_iter().max_by(|one, other| off(one).total_cmp(&off(other)))?;
    Some((axis, ratio(axis)))
}

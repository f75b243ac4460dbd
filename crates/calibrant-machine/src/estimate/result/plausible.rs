//! Is a result that of a sensor? What a machine is described wrongly by hides in the sensor's parameters, which have no prior: gravity in its bias, a lever arm
//! or a scale in its gains, the mounting in its matrix. No datasheet is needed to see it: a sensor has its own errors, each axis by itself.
//!
//! The matrix of a sensor is `S = D P R` with its gains `D`, the non-orthogonality `P` (symmetric) and a turn `R` of the frame. Misalignments of single axes of
//! variance `τ²` give each of the six entries of `P` and of the vector of `R` the variance `τ²/2`, so that `P` tells how large a turn is the sensor's own. A
//! turn that both sensors share has `τ²/4`, as has half their difference.

use crate::estimate::{MachineCalibration, MachineQuantity, MachineSetup, MountingPrior};
use calibrant_core::diagnostic::machine::{GainsShareFactor, MountingOtherwise};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::estimate::{common_factor, implausible_bias};
use calibrant_core::sensor::{Axis, ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind};
use nalgebra::{DVector, Matrix3, Rotation3, UnitQuaternion, Vector3};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Misalignment of an axis that is usual: that of common MEMS sensors, which [`draw_imu`](calibrant_core::simulate::draw_imu) draws. Three or nine entries alone know
/// their variance roughly.
const USUAL_MISALIGNMENT: f64 = 0.01;
/// A turn of this probability is no chance.
const NO_CHANCE: f64 = 1e-3;

/// What no sensor has.
pub(super) fn check(setup: &MachineSetup, calibration: &MachineCalibration) -> Vec<Diagnostic> {
    let factors = calibration.noise.iter().filter_map(|of| factor(of.sensor, setup, calibration));
    let unit = calibration.sensors.units[SensorKind::Accelerometer];
    let bias = unit.and_then(|unit| bias(setup, &calibration.parameters.imu, unit));
    bias.into_iter().chain(factors).chain(turned(setup, calibration)).collect()
}

/// A bias that is gravity.
pub(crate) fn bias(setup: &MachineSetup, imu: &ImuParameters, unit: ReadingUnit) -> Option<Diagnostic> {
    implausible_bias(unit, &imu[SensorKind::Accelerometer].bias, |axis| {
        is_known(setup, ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)))
    })
}

/// One factor of all gains.
fn factor(
    sensor_kind: SensorKind,
    setup: &MachineSetup,
    calibration: &MachineCalibration,
) -> Option<Diagnostic> {
    let scale = |axis| ImuQuantity::Of(sensor_kind, Quantity::Scale(axis));
    let [found, nominal] =
        [&calibration.parameters, &calibration.nominal].map(|of| of.imu.sensor(sensor_kind).matrix);
    let gains = match calibration.sensors.units[sensor_kind]? {
        ReadingUnit::Counts => nominal.diagonal().abs(),
        _ => Vector3::repeat(1.0),
    };
    let is_free = Axis::ALL.into_iter().all(|axis| !is_known(setup, scale(axis)));
    let factor = common_factor(&found, &gains).filter(|_| is_free)?;
    Some(GainsShareFactor { sensor_kind, factor }.into())
}

/// Is it stated beforehand, with an uncertainty of its own?
pub(super) fn is_known(setup: &MachineSetup, quantity: ImuQuantity) -> bool {
    setup.known.iter().any(|known| known.quantity == quantity)
}

/// A sensor's matrix: `P − I` above the diagonal, and the turn `R` as a rotation vector, rad.
struct Form {
    symmetric: Vector3<f64>,
    turn: Vector3<f64>,
}

impl Form {
    /// `None` where a mirror is in it, which says something else, or a row of zeros.
    fn of(matrix: &Matrix3<f64>) -> Option<Self> {
        let rows = Matrix3::from_fn(|i, j| matrix[(i, j)] / matrix.row(i).norm());
        if !rows.iter().all(|value| value.is_finite()) {
            return None;
        }
        let svd = rows.svd(true, true);
        let (u, v) = svd.u.zip(svd.v_t)?;
        let rotation = u * v;
        if rotation.determinant() < 0.0 {
            return None;
        }
        let stretch = rows * rotation.transpose();
        Some(Self {
            symmetric: Vector3::new(stretch[(0, 1)], stretch[(0, 2)], stretch[(1, 2)]),
            turn: Rotation3::from_matrix_unchecked(rotation).scaled_axis(),
        })
    }
}

/// A turn of all matrices that the mounting would be.
fn turned(setup: &MachineSetup, calibration: &MachineCalibration) -> Option<Diagnostic> {
    if setup.mounting == MountingPrior::Unknown {
        return None;
    }
    let sensors = calibration.sensors.sensor_kinds();
    let is_full = |sensor: &SensorKind| entries(*sensor).all(|(of, _)| calibration.position(of).is_some());
    if !sensors.iter().all(is_full) {
        return None;
    }
    let matrix = |sensor: &SensorKind| calibration.parameters.imu.sensor(*sensor).matrix;
    let forms: Vec<Form> = sensors.iter().map(|sensor| Form::of(&matrix(sensor))).collect::<Option<_>>()?;
    let number = forms.len() as f64;
    let turn = forms.iter().map(|of| of.turn).sum::<Vector3<f64>>() / number;
    // the sensors' own: mean squares that estimate the variance of a component of the shared turn
    let own = forms.iter().map(|of| of.symmetric.norm_squared() + (of.turn - turn).norm_squared());
    let own_degrees = 3.0 * number + 3.0 * (number - 1.0);
    let own = own.sum::<f64>() / own_degrees / number;
    let stated = Axis::ALL.map(|axis| shared_variance(&sensors, axis, calibration)).iter().sum::<f64>() / 3.0;
    // of the sum of a variance that is estimated and one that is known (`satterthwaite1946`)
    let chance = |own: f64, own_degrees: f64| {
        let degrees = own_degrees * ((own + stated) / own).powi(2);
        let distribution = FisherSnedecor::new(3.0, degrees.min(1e6)).ok()?;
        let ratio = turn.norm_squared() / 3.0 / (own + stated);
        ratio.is_finite().then(|| distribution.sf(ratio))
    };
    let usual = 0.5 * USUAL_MISALIGNMENT * USUAL_MISALIGNMENT / number;
    let beside_usual = if own < usual { chance(usual, f64::INFINITY) } else { chance(own, own_degrees) };
    if f64::min(chance(own, own_degrees)?, beside_usual?) > NO_CHANCE {
        return None;
    }
    // `S f = D P R f`: the sensor's axes are those of the mounting turned by `Rᵀ`
    let rotation = calibration.parameters.mount.tip_from_sensor * UnitQuaternion::from_scaled_axis(-turn);
    let values = [rotation.w, rotation.i, rotation.j, rotation.k].map(|value| format!("{value:.5}"));
    Some(
        MountingOtherwise {
            angle_rad: turn.norm(),
            rotation: Phrase(format!("[{}]", values.join(", "))),
            is_of_both: sensors.len() > 1,
        }
        .into(),
    )
}

/// The entries of a sensor's matrix beside its diagonal, and their places.
fn entries(sensor: SensorKind) -> impl Iterator<Item = (MachineQuantity, (usize, usize))> {
    let pairs = Axis::ALL.into_iter().flat_map(|row| Axis::ALL.map(|column| (row, column)));
    pairs.filter(|(row, column)| row != column).map(move |(row, column)| {
        let quantity = ImuQuantity::Of(sensor, Quantity::CrossAxis(row, column));
        (MachineQuantity::Imu(quantity), (row.index(), column.index()))
    })
}

/// The stated variance of the shared turn about an axis, rad²: to first order it is half the difference of two entries, over the gains.
fn shared_variance(sensors: &[SensorKind], axis: Axis, calibration: &MachineCalibration) -> f64 {
    let mut weights = DVector::zeros(calibration.quantities.len());
    for &sensor in sensors {
        let matrix = calibration.parameters.imu.sensor(sensor).matrix;
        for (quantity, (row, column)) in entries(sensor) {
            let mut generator = Vector3::zeros();
            generator[axis.index()] = 1.0;
            let weight = 0.5 * generator.cross_matrix()[(row, column)] / matrix.row(row).norm();
            if let Some(place) = calibration.position(quantity) {
                weights[place] += weight / sensors.len() as f64;
            }
        }
    }
    weights.dot(&(&calibration.covariance * &weights))
}

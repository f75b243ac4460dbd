//! Errors that the calibrations of a sensor on one machine share.
//!
//! With `I` the information of a prior, what is wrong with a quantity of the machine by one standard deviation `σ` moves the estimates by `Σ I σ`, which
//! is the column `Σ_k/σ` of their covariance. The sensor is mounted anew each time, and delays, clock and tilt belong to each recording.

use crate::estimate::MachineQuantity;
use crate::estimate::problem::Layout;
use calibrant_core::estimate::gravity_source;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::SharedErrors;
use nalgebra::DMatrix;

/// Widened in different measure, a covariance no longer contains what is shared: some combination keeps less than this part of its own.
const KEPT: f64 = 0.5;

/// A standard deviation without the rounding of its information.
fn rounded(sd: f64) -> f64 {
    format!("{sd:.9e}").parse().unwrap_or(sd)
}

/// Those of the sensor's parameters. `linear` is the covariance of independent residuals, `stated` the one of the result. `None` where nothing of the
/// machine is uncertain, or where correlated residuals widen the parameters so differently that the stated covariance does not contain it.
pub(super) fn shared_errors(
    layout: &Layout,
    joints: &[String],
    linear: &DMatrix<f64>,
    stated: &DMatrix<f64>,
) -> Option<SharedErrors> {
    let quantities = layout.quantities.iter().enumerate();
    let (imu, machine): (Vec<_>, Vec<_>) =
        quantities.partition(|(_, quantity)| matches!(quantity, MachineQuantity::Imu(_)));
    let imu: Vec<usize> = imu.into_iter().map(|(place, _)| place).collect();
    let (mut sources, mut columns) = (Vec::new(), Vec::new());
    for (place, quantity) in machine {
        // nothing is known beforehand of what has no prior
        let sd = layout.prior[(place, place)].sqrt().recip();
        let source = match quantity {
            MachineQuantity::Gravity => {
                gravity_source(&Gravity { magnitude_mps2: layout.nominal.gravity_mps2, sd_mps2: rounded(sd) })
            }
            MachineQuantity::Zero(_) | MachineQuantity::Geometry(..) => {
                format!("{} ± {}", quantity.name(joints), rounded(sd))
            }
            _ => continue,
        };
        if sd.is_finite() {
            sources.push(source);
            columns.push(linear.select_rows(&imu).column(place) / sd);
        }
    }
    if columns.is_empty() {
        return None;
    }
    let root = DMatrix::from_columns(&columns);
    let own = |of: &DMatrix<f64>| of.select_rows(&imu).select_columns(&imu);
    let (linear, stated) = (own(linear), own(stated));
    let sd = stated.diagonal().map(|variance| variance.max(f64::MIN_POSITIVE).sqrt());
    let least = |of: DMatrix<f64>| {
        let rest = of - &root * root.transpose();
        DMatrix::from_fn(imu.len(), imu.len(), |i, j| rest[(i, j)] / (sd[i] * sd[j]))
            .symmetric_eigenvalues()
            .min()
    };
    (least(stated.clone()) >= KEPT * least(linear)).then_some(SharedErrors { sources, root })
}

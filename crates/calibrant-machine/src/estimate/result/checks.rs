//! What a user should know of a result on a machine.

use crate::estimate::problem::{Layout, place};
use crate::estimate::{MachineCalibration, MachineSetup, MachineTrust};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::fit::{ModelContradicted, NotConverged};
use calibrant_core::diagnostic::machine::{
    LogCoversPart, LogOutliers, MachineResiduals, PriorContradicted, ResidualsCorrelated,
};
use calibrant_core::estimate::{CalibrationStatus, implausible_gains};

/// Largest usual ratio of the residuals to the noise between neighbouring samples: with noisy trust, and with known trust.
const RESIDUALS: [f64; 2] = [1.1, 1.25];
/// Largest usual distance of a quantity from its prior mean, in prior standard deviations.
const CONTRADICTED: f64 = 4.0;
/// A ratio of the residuals beyond this refuses the model.
const REFUSED: f64 = 10.0;
/// Largest usual share of outliers in the log.
const OUTLIERS: f64 = 1e-3;
/// Least usual share of the sensor's samples that are used.
const USED: f64 = 0.95;

/// All of it, the most important first.
pub(crate) fn all(
    setup: &MachineSetup,
    layout: &Layout,
    calibration: &MachineCalibration,
) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    if calibration.status != CalibrationStatus::Converged {
        found.push(NotConverged { status: calibration.status.name() }.into());
    }
    found.extend(residuals(calibration));
    found.extend(correlated(calibration));
    found.extend(calibration.noise.iter().flat_map(|of| {
        let matrix = &calibration.parameters.imu.sensor(of.sensor).matrix;
        let unit = calibration.units[place(of.sensor)].unwrap_or(of.sensor.stimulus_unit());
        implausible_gains(of.sensor, unit, matrix, |_| false)
    }));
    found.extend(contradicted(setup, layout, calibration));
    let (outliers, samples) = (calibration.reference_noise.iter())
        .fold((0, 0), |(outliers, samples), of| (outliers + of.outliers, samples + of.samples));
    if outliers as f64 > OUTLIERS * samples as f64 {
        found.push(LogOutliers { outliers, samples }.into());
    }
    if calibration.used_share < USED {
        found.push(LogCoversPart { used_share: calibration.used_share }.into());
    }
    found
}

/// Residuals that are larger than the noise of neighbouring samples.
fn residuals(calibration: &MachineCalibration) -> impl Iterator<Item = Diagnostic> + '_ {
    let limit = RESIDUALS[usize::from(calibration.trust == MachineTrust::Known)];
    calibration.noise.iter().filter_map(move |of| {
        let ratio = (of.rms.norm_squared() / of.white_noise.norm_squared()).sqrt();
        let sensor_kind = of.sensor;
        match ratio > limit {
            true if ratio > REFUSED => Some(Diagnostic::from(ModelContradicted { sensor_kind, ratio })),
            true => Some(Diagnostic::from(MachineResiduals { sensor_kind, ratio })),
            false => None,
        }
    })
}

/// The parameter whose standard deviation correlation widens most.
fn correlated(calibration: &MachineCalibration) -> Option<Diagnostic> {
    let widest = (0..calibration.inflation.len())
        .max_by(|one, other| calibration.inflation[*one].total_cmp(&calibration.inflation[*other]))?;
    let factor = calibration.inflation[widest];
    (factor > 1.0).then(|| {
        Diagnostic::from(ResidualsCorrelated { parameter: calibration.names().swap_remove(widest), factor })
    })
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
            (deviations > CONTRADICTED)
                .then_some(Diagnostic::from(PriorContradicted { parameter, deviations }))
        })
        .collect()
}

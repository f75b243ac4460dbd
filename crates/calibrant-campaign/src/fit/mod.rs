//! One calibration over temperature from the calibrations of several soaks: generalised least squares on their values and covariances, with hysteresis, lag and
//! the scatter between soaks.

mod branch;
mod check;
mod entry;
mod least_squares;
mod model;
mod prepared;
mod prior;
mod result;
mod scatter;
mod soak;
#[cfg(test)]
pub(crate) mod tests;
mod verdicts;
mod warnings;

pub use model::CampaignModel;
pub use result::{FittedCampaign, FittedChannel, FittedSoak};
pub use scatter::SoakScatter;
pub use soak::{SoakCalibration, SoakPath, paths};
pub use verdicts::WaldTest;

use calibrant_core::error::Result;
use check::{at_its_temperature, check, open};
use prepared::Prepared;
use prior::{one_by_one, without_prior};

/// One calibration over all soaks, which are in the order of time.
///
/// # Errors
/// [`Error::Recording`](calibrant_core::Error::Recording) where the soaks are of different sensors, gauges or units;
/// [`Error::NotIdentifiable`](calibrant_core::Error::NotIdentifiable) with the coefficients that they leave open.
pub fn fit(model: &CampaignModel, soaks: &[SoakCalibration]) -> Result<FittedCampaign> {
    let quantities = check(model, soaks)?;
    let alone = soaks.iter().map(|soak| without_prior(soak).unwrap_or_else(|| soak.clone()));
    let at: Vec<SoakCalibration> = alone.map(|soak| at_its_temperature(&soak)).collect::<Result<_>>()?;
    // the others are what they are by themselves
    let each = |soak: &SoakCalibration| {
        let rests = (!soak.prior.is_empty()).then(|| at_its_temperature(soak));
        rests.transpose().map(|soak| soak.as_ref().and_then(one_by_one))
    };
    let each = soaks.iter().map(each).collect::<Result<Vec<_>>>()?;
    let prepared = Prepared::of(model, &at, &each, &quantities)?;
    let solution = prepared.solve().ok_or_else(|| open(&prepared.channels, &prepared.paths))?;
    Ok(prepared.result(&solution))
}

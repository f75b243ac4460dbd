//! The soaks of a campaign that do not determine all parameters by themselves: with few holds, or on six faces. What the other soaks say of them is their prior, which
//! the fit over all soaks takes out again, so that nothing counts twice.

use crate::batch::{Batch, BatchRow, in_parallel};
use crate::session::{OtherSoaks, Session, Source};
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, SoakCalibration, SoakPath, fit};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::campaign::SoaksTogether;
use calibrant_core::error::{Error, Refusal, Result};
use calibrant_core::estimate::{KnownTerm, SoakTemperature};
use calibrant_core::sensor::{ImuParameters, ImuQuantity};
use calibrant_io::{Experiment, ReadSoak, parse_soak};

/// The temperature of an accelerometer alone changes in a soak where the means of its holds differ by so much, K.
const CHANGES_K: f64 = 0.1;
/// Temperature terms are unusual beyond so many standard deviations of usual sensors.
const UNUSUAL: f64 = 3.0;

/// Calibrates soaks once more with what the others say of them:
/// - those that leave parameters open, or fail, first with those that determine all, then with all. Without one of these they stay as they are;
/// - those whose temperature terms are not like those of usual sensors, which are their priors;
/// - all of an accelerometer alone, whose calibrations have no temperature terms: at their mean temperatures.
///
/// Where the experiment is no campaign, the rows stay as they are. `batch` is of one soak; its rows are in the order of its recordings.
///
/// # Errors
/// Where the experiment makes no sense.
pub(crate) fn calibrate_with_the_others(
    experiment: &Experiment,
    batch: &Batch,
    rows: &mut [BatchRow],
) -> Result<Option<Diagnostic>> {
    let Some(model) = experiment.campaign_model()? else { return Ok(None) };
    let (of_one, options) = (batch.session().experiment(), batch.session().options());
    let mut is_open: Vec<bool> = rows.iter().map(is_open_alone).collect();
    let temperatures: Vec<Option<f64>> = in_parallel(rows.len(), |k| {
        rows[k].outcome.is_err().then(|| temperature_of(batch.session(), &batch.sources()[k])).flatten()
    });
    let of_spread = CampaignModel { orders: vec![0; model.orders.len()], ..model.clone() };
    let first = is_open.contains(&true).then_some(&of_spread);
    for model in first.into_iter().chain([&model]) {
        let soaks: Vec<Option<ReadSoak>> = in_parallel(rows.len(), |k| soak_of(&rows[k]));
        let Some(all) = fitted(model, soaks.iter().flatten()) else { break };
        let path = |k: usize| {
            let of_fit = all.soaks.iter().find(|soak| soak.name == rows[k].folder).map(|soak| soak.path);
            let mean_c = soaks[k].as_ref().map(|soak| soak.calibration.temperature.mean_c);
            let alone = |temperature_c| SoakPath { temperature_c, direction: 0.0, lag_left: 0.0 };
            of_fit.or_else(|| mean_c.or(temperatures[k]).map(alone))
        };
        let leaves_open = |k: &usize| {
            let prior = path(*k).and_then(|path| all.prior_on(&path));
            soaks[*k].as_ref().zip(prior).is_some_and(|(soak, prior)| soak.calibration.leaves_open(&prior))
        };
        let weak: Vec<usize> = (0..rows.len()).filter(leaves_open).collect();
        // what they say may be far off
        let others = (0..rows.len()).filter(|k| !weak.contains(k)).filter_map(|k| soaks[k].as_ref());
        let without = if weak.is_empty() { None } else { fitted(model, others) };
        let found = without.as_ref().unwrap_or(&all);
        let again = in_parallel(rows.len(), |k| -> Option<(bool, Result<BatchRow>)> {
            let soak = soaks[k].as_ref().map(|soak| &soak.calibration);
            let path = path(k)?;
            let prior = found.prior_on(&path)?;
            let about = found.on_path(&path).at_reference_temperature(path.temperature_c);
            let sensor = about.ok()?.parameters;
            let is_open = is_open[k] || weak.contains(&k);
            let is_unusual = match &of_one.imu {
                Some(imu) => is_unusual(&imu.usual, &sensor),
                None => soak.is_some_and(changes),
            };
            (is_open || is_unusual).then(|| {
                let prior = if is_open { prior } else { Vec::new() };
                let others = OtherSoaks { prior, sensor: Some(sensor) };
                let session = Session::with(of_one.clone(), options.clone());
                (is_open, session.and_then(|session| batch.again(k, &rows[k], session.beside(others))))
            })
        });
        for (k, again) in again.into_iter().enumerate() {
            let Some((rests, row)) = again else { continue };
            let row = row?;
            // why it failed by itself says more
            if row.outcome.is_ok() || rows[k].outcome.is_ok() {
                (is_open[k], rows[k]) = (rests, row);
            }
        }
    }
    let done = rows.iter().zip(&is_open).filter(|(row, is_open)| **is_open && !is_open_alone(row));
    let soaks: Vec<String> = done.map(|(row, _)| row.folder.clone()).collect();
    Ok((!soaks.is_empty()).then(|| SoaksTogether { soaks }.into()))
}

/// Does its recording by itself not do?
fn is_open_alone(row: &BatchRow) -> bool {
    match &row.outcome {
        Ok(_) => soak_of(row).is_some_and(|soak| soak.bad.is_some()),
        Err(Error::NotIdentifiable(_)) => true,
        Err(error) => matches!(error.code(), Refusal::HoldsContradict | Refusal::FitFailed),
    }
}

/// Is a temperature term of this sensor far from what is usual?
fn is_unusual(usual: &[KnownTerm], sensor: &ImuParameters) -> bool {
    usual
        .iter()
        .filter(|term| matches!(term.quantity, ImuQuantity::Thermal(..)))
        .any(|term| term.sd.is_some_and(|sd| (term.quantity.value(sensor) - term.value).abs() > UNUSUAL * sd))
}

/// Do the temperatures of a soak's holds differ?
fn changes(soak: &SoakCalibration) -> bool {
    let [low, high] = soak.temperature.range_c;
    high - low >= CHANGES_K
}

fn soak_of(row: &BatchRow) -> Option<ReadSoak> {
    parse_soak(&row.outcome.as_ref().ok()?.json, &row.folder).ok()
}

/// The fit of the soaks that can be used; `None` where they do not determine it.
fn fitted<'s>(model: &CampaignModel, soaks: impl Iterator<Item = &'s ReadSoak>) -> Option<FittedCampaign> {
    let good = soaks.filter(|soak| soak.bad.is_none());
    fit(model, &good.map(|soak| soak.calibration.clone()).collect::<Vec<_>>()).ok()
}

/// The mean temperature of a recording whose holds nobody knows.
fn temperature_of(session: &Session, source: &Source) -> Option<f64> {
    let recording = session.read(source).ok()?.recording;
    let everything = std::iter::once((f64::NEG_INFINITY, f64::INFINITY));
    SoakTemperature::each(&recording, everything).ok()?.first().map(|of| of.mean_c)
}

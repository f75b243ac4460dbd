//! The soaks of a campaign that do not determine all parameters by themselves: with few holds, or on six faces. What the other soaks say of them is their prior, which
//! the fit over all soaks takes out again, so that nothing counts twice.

use crate::batch::{Batch, BatchRow, in_parallel};
use crate::session::{Session, Source};
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, SoakCalibration, SoakPath, fit};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::campaign::SoaksTogether;
use calibrant_core::error::{Error, Result};
use calibrant_core::estimate::{KnownTerm, SoakTemperature};
use calibrant_core::sensor::ImuQuantity;
use calibrant_io::{Experiment, parse_soak};

/// Standard deviation of a soak's prior, over that of what the others say.
const WIDER: f64 = 3.0;
/// The temperature of an accelerometer alone changes in a soak where the means of its holds differ by so much, K.
const CHANGES_K: f64 = 0.1;

/// Calibrates soaks of an IMU that leave parameters open with what the others say of them: first with those that determine all, then with all. Without one of these, or
/// where the experiment is no campaign, the rows stay as they are. `batch` is of one soak; its rows are in the order of its recordings.
///
/// Soaks of an accelerometer alone are taken to their mean temperatures by what all say; those that leave parameters open stay without a result.
///
/// # Errors
/// Where the experiment makes no sense.
pub(crate) fn calibrate_with_the_others(
    experiment: &Experiment,
    batch: &Batch,
    rows: &mut [BatchRow],
) -> Result<Option<Diagnostic>> {
    let model = experiment.campaign_model()?;
    if let Some(model) = model.as_ref().filter(|_| experiment.imu.is_none()) {
        return at_one_temperature_each(model, batch, rows).map(|()| None);
    }
    let is_open = |row: &BatchRow| matches!(row.outcome, Err(Error::NotIdentifiable(_)));
    let open: Vec<usize> = (0..rows.len()).filter(|k| is_open(&rows[*k])).collect();
    let (Some(model), false) = (model, open.is_empty()) else { return Ok(None) };
    let temperatures: Vec<Option<f64>> =
        in_parallel(open.len(), |k| temperature_of(batch.session(), &batch.sources()[open[k]]));
    let of_spread = CampaignModel { orders: vec![0; model.orders.len()], ..model.clone() };
    for model in [&of_spread, &model] {
        let Some(others) = fitted(model, rows) else { break };
        let again = in_parallel(open.len(), |k| -> Option<Result<BatchRow>> {
            let row = &rows[open[k]];
            let path = match others.soaks.iter().find(|soak| soak.name == row.folder) {
                Some(soak) => soak.path,
                None => SoakPath { temperature_c: temperatures[k]?, direction: 0.0, lag_left: 0.0 },
            };
            let prior = prior(&others, &path)?;
            let experiment = batch.session().experiment().with_soak_prior(prior);
            let session = Session::with(experiment, batch.session().options().clone());
            Some(session.and_then(|session| batch.again(open[k], row, session)))
        });
        for (number, row) in open.iter().zip(again) {
            if let Some(row) = row.transpose()? {
                rows[*number] = row;
            }
        }
    }
    let done = open.iter().filter(|k| rows[**k].outcome.is_ok());
    let soaks: Vec<String> = done.map(|k| rows[*k].folder.clone()).collect();
    Ok((!soaks.is_empty()).then(|| SoaksTogether { soaks }.into()))
}

/// The soaks of an accelerometer alone, whose calibration has no temperature terms: once more, with their holds taken to the mean temperature by what all soaks say of the
/// sensor.
fn at_one_temperature_each(model: &CampaignModel, batch: &Batch, rows: &mut [BatchRow]) -> Result<()> {
    let Some(all) = fitted(model, rows) else { return Ok(()) };
    let again = in_parallel(rows.len(), |k| -> Option<Result<BatchRow>> {
        let row = &rows[k];
        let soak = parse_soak(&row.outcome.as_ref().ok()?.json, &row.folder).ok()?.calibration;
        let [low, high] = soak.temperature.range_c;
        if high - low < CHANGES_K {
            return None;
        }
        let found = all.soaks.iter().find(|found| found.name == row.folder);
        let imu = found.map_or(all.imu.parameters, |found| all.on_path(&found.path).parameters);
        let (experiment, options) = (batch.session().experiment(), batch.session().options());
        let session = Session::with(experiment.clone(), options.clone());
        Some(session.and_then(|of| batch.again(k, row, of.with_sensor_over_temperature(imu))))
    });
    for (row, again) in rows.iter_mut().zip(again) {
        if let Some(again) = again.transpose()? {
            *row = again;
        }
    }
    Ok(())
}

/// The fit of the rows that have a result; `None` where they do not determine it.
fn fitted(model: &CampaignModel, rows: &[BatchRow]) -> Option<FittedCampaign> {
    let soak = |row: &BatchRow| -> Option<SoakCalibration> {
        let text = &row.outcome.as_ref().ok()?.json;
        parse_soak(text, &row.folder).ok().filter(|soak| soak.bad.is_none()).map(|soak| soak.calibration)
    };
    fit(model, &rows.iter().filter_map(soak).collect::<Vec<_>>()).ok()
}

/// The mean temperature of a recording whose holds nobody knows.
fn temperature_of(session: &Session, source: &Source) -> Option<f64> {
    let recording = session.read(source).ok()?.recording;
    let everything = std::iter::once((f64::NEG_INFINITY, f64::INFINITY));
    SoakTemperature::each(&recording, everything).ok()?.first().map(|of| of.mean_c)
}

/// What the others say of the parameters of a soak.
fn prior(others: &FittedCampaign, path: &SoakPath) -> Option<Vec<KnownTerm>> {
    let imu = others.on_path(path).at(path.temperature_c).ok()?;
    let covariance = imu.covariance.as_ref()?;
    let terms = imu.quantities.iter().enumerate();
    let term = |(k, quantity): (usize, &ImuQuantity)| KnownTerm {
        quantity: *quantity,
        value: quantity.value(&imu.parameters),
        sd: Some(WIDER * covariance[(k, k)].sqrt()),
    };
    Some(terms.map(term).collect())
}

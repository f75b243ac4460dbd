//! The soaks of a campaign that are calibrated once more with what the others say: those that leave parameters open, with few holds or on six faces, and those of a sensor
//! that follows temperature unusually. The prior is taken out again by the fit over all soaks, so that nothing counts twice.

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
/// A slope or a curvature over temperature is unusual beyond this multiple of the standard deviation over sensors.
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
    let mut is_open: Vec<bool> = in_parallel(rows.len(), |k| is_open_alone(&rows[k]));
    let temperatures: Vec<Option<f64>> = in_parallel(rows.len(), |k| {
        rows[k].outcome.is_err().then(|| temperature_of(batch.session(), &batch.sources()[k])).flatten()
    });
    let of_spread = CampaignModel { orders: vec![0; model.orders.len()], ..model.clone() };
    let first = is_open.contains(&true).then_some(&of_spread);
    for model in first.into_iter().chain([&model]) {
        let Some(round) = Round::of(model, of_one, rows, &temperatures) else { break };
        let again = in_parallel(rows.len(), |k| -> Option<(bool, Result<BatchRow>)> {
            options.interruption.check().ok()?;
            let (rests, others) = round.others(k, is_open[k])?;
            if rows[k].outcome.is_ok() {
                batch.forget(&rows[k]);
            }
            let session = Session::with(of_one.clone(), options.clone());
            Some((rests, session.and_then(|session| batch.again(k, &rows[k], session.beside(others)))))
        });
        for (k, again) in again.into_iter().enumerate() {
            let Some((rests, row)) = again else { continue };
            let row = row?;
            // what is missing by itself says more than what is missing still
            if rows[k].outcome.is_ok() || !matches!(row.outcome, Err(Error::NotIdentifiable(_))) {
                (is_open[k], rows[k]) = (rests, row);
            }
        }
    }
    let done = rows.iter().zip(&is_open).filter(|(row, is_open)| **is_open && !is_open_alone(row));
    let soaks: Vec<String> = done.map(|(row, _)| row.folder.clone()).collect();
    Ok((!soaks.is_empty()).then(|| SoaksTogether { soaks }.into()))
}

/// What all soaks say before they are calibrated once more.
struct Round<'e> {
    of_one: &'e Experiment,
    /// Those that have a result.
    soaks: Vec<Option<ReadSoak>>,
    /// From where each came to its temperature; `None` where nobody knows that.
    paths: Vec<Option<SoakPath>>,
    /// Does it hardly determine parameters?
    is_weak: Vec<bool>,
    /// The fit of those that are not weak: what these say may be far off.
    found: FittedCampaign,
}

impl<'e> Round<'e> {
    /// `temperatures`: of the recordings without a result. `None` where the soaks do not determine a fit.
    fn of(
        model: &CampaignModel,
        of_one: &'e Experiment,
        rows: &[BatchRow],
        temperatures: &[Option<f64>],
    ) -> Option<Self> {
        let soaks: Vec<Option<ReadSoak>> = in_parallel(rows.len(), |k| soak_of(&rows[k]));
        let all = fitted(model, soaks.iter().flatten())?;
        let path = |k: usize| {
            let of_fit = all.soaks.iter().find(|soak| soak.name == rows[k].folder).map(|soak| soak.path);
            let mean_c = soaks[k].as_ref().map(|soak| soak.calibration.temperature.mean_c);
            let alone = |temperature_c| SoakPath { temperature_c, direction: 0.0, lag_left: 0.0 };
            of_fit.or_else(|| mean_c.or(temperatures[k]).map(alone))
        };
        let paths: Vec<Option<SoakPath>> = (0..rows.len()).map(path).collect();
        let is_weak = |(soak, path): (&Option<ReadSoak>, &Option<SoakPath>)| {
            let prior = path.as_ref().and_then(|path| all.prior_on(path));
            soak.as_ref().zip(prior).is_some_and(|(soak, prior)| soak.calibration.leaves_open(&prior))
        };
        let is_weak: Vec<bool> = soaks.iter().zip(&paths).map(is_weak).collect();
        let strong = soaks.iter().zip(&is_weak).filter(|(_, is_weak)| !**is_weak);
        let without =
            is_weak.contains(&true).then(|| fitted(model, strong.filter_map(|(soak, _)| soak.as_ref())));
        Some(Self { of_one, soaks, paths, is_weak, found: without.flatten().unwrap_or(all) })
    }

    /// What the others say of a soak, and whether it rests on that; `None` where it need not be calibrated once more.
    fn others(&self, k: usize, is_open: bool) -> Option<(bool, OtherSoaks)> {
        let path = self.paths[k].as_ref()?;
        let prior = self.found.prior_on(path)?;
        let about = self.found.on_path(path).at_reference_temperature(path.temperature_c);
        let sensor = about.ok()?.parameters;
        let rests = is_open || self.is_weak[k];
        let is_unusual = self.soaks[k].as_ref().is_some_and(|soak| match &self.of_one.imu {
            Some(imu) => is_unusual(&imu.usual, &sensor),
            None => changes(&soak.calibration),
        });
        let prior = if rests { prior } else { Vec::new() };
        (rests || is_unusual).then_some((rests, OtherSoaks { prior, sensor: Some(sensor) }))
    }
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

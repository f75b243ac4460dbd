//! Campaigns over temperature: the best soaks, and simulated ones.

use crate::arrays::{Numbers, as_array};
use crate::choice::teller;
use crate::experiment::Experiment;
use crate::failure::{invalid, raised};
use crate::options::{parsed, positive};
use crate::page::{Page, page};
use crate::recording::{Samples, samples, sensor_kind};
use crate::sweep::checked;
use crate::work::{How, run, run_as};
use calibrant::campaign::{
    Campaign, CampaignSweep, PlannedCampaign, Soak, design_over_cycles, time_needed_min, timetable, usual,
};
use calibrant::error::{InputError, Refusal};
use calibrant::io::{CampaignFile, CampaignRow, CampaignSweepFile, to_json, with_soaks_of};
use calibrant::report::{About, campaign_sheet, campaign_sweep_sheet};
use calibrant::{Error, Result, SimulatedCampaign, simulate_campaign as simulated};
use pyo3::prelude::*;
use serde_json::json;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

/// Finds the best soaks; `known`: the texts of earlier calibrations over temperature, whose soaks count.
#[pyfunction]
#[pyo3(signature = (experiment, known, *, add_min=None, threads=None))]
pub(crate) fn design_campaign(
    py: Python<'_>,
    experiment: &Experiment,
    known: Vec<String>,
    add_min: Option<f64>,
    threads: Option<usize>,
) -> PyResult<Page> {
    let add_min = positive("add_min", add_min).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, ..How::default() }, move |_| {
        best(&experiment, &known, add_min).map_err(Experiment::placed(&experiment.file))
    })
}

/// The campaign of an experiment after these soaks, and the numbers of cycles to try.
fn campaign_of(experiment: &Experiment, known: &[String]) -> Result<(Campaign, RangeInclusive<usize>)> {
    let read = &experiment.read;
    let (Some(campaign), Some(section)) = (read.campaign()?, read.campaign_section()) else {
        let help = "see `calibrant init campaign`";
        return Err(Error::experiment(InputError::new(
            Refusal::KeyMissing,
            "the experiment has no [campaign]",
            help,
        )));
    };
    let campaign = known.iter().try_fold(campaign, |campaign, text| with_soaks_of(&campaign, text))?;
    Ok((campaign, section.cycles()))
}

/// Finds the best campaign in each of these times.
#[pyfunction]
#[pyo3(signature = (experiment, known, budgets_min, *, threads=None, progress=None))]
pub(crate) fn sweep_campaign(
    py: Python<'_>,
    experiment: &Experiment,
    known: Vec<String>,
    budgets_min: Vec<f64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Page> {
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: false }, move |given| {
        checked(&budgets_min)?;
        let told = teller(&given, "campaigns", budgets_min.len());
        let swept = campaign_of(&experiment, &known)
            .and_then(|(campaign, cycles)| CampaignSweep::over(&campaign, cycles, &budgets_min, told));
        let swept = swept.map_err(Experiment::placed(&experiment.file))?;
        let about = About { title: "Campaign over temperature".into(), ..About::default() };
        Ok(page(to_json(&CampaignSweepFile(&swept)), &[], &campaign_sweep_sheet(&swept, &about)))
    })
}

fn best(experiment: &Experiment, known: &[String], add_min: Option<f64>) -> Result<Page> {
    let (campaign, cycles) = campaign_of(experiment, known)?;
    let budget_min = add_min.unwrap_or(campaign.budget_min);
    let (campaign, found) = design_over_cycles(&Campaign { budget_min, ..campaign }, cycles)?;
    let (rows, usual) = (timetable(&campaign, &found.soaks), usual(&campaign));
    let missed = campaign.channels.iter().zip(&found.sd).any(|(channel, sd)| *sd > channel.goal_sd);
    let planned = PlannedCampaign {
        campaign: &campaign,
        design: &found,
        timetable: &rows,
        usual: &usual,
        time_needed_min: missed.then(|| time_needed_min(&campaign)).flatten(),
    };
    let about = About { title: "Campaign over temperature".into(), ..About::default() };
    Ok(page(to_json(&CampaignFile(planned)), &[], &campaign_sheet(planned, &about)))
}

/// The recordings of a simulated campaign.
#[pyclass(frozen)]
pub(crate) struct CampaignSimulation(Arc<SimulatedCampaign>);

/// Simulates a recording of each soak, which come as JSON.
#[pyfunction]
#[pyo3(signature = (experiment, soaks, *, seed=None))]
pub(crate) fn simulate_campaign(
    py: Python<'_>,
    experiment: &Experiment,
    soaks: &str,
    seed: Option<u64>,
) -> PyResult<CampaignSimulation> {
    let soaks = parsed::<Vec<CampaignRow>>(soaks).and_then(|rows| rows.iter().map(soak).collect());
    let soaks: Vec<Soak> = soaks.map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run(py, move || {
        let made = simulated(&experiment.read, &soaks, seed).map_err(Experiment::placed(&experiment.file))?;
        Ok(CampaignSimulation(Arc::new(made)))
    })
}

fn soak(row: &CampaignRow) -> Result<Soak> {
    let help = "give the soaks of a design, or dicts with temperature_c, direction, wait_min and blocks";
    row.soak().map_err(|why| invalid(format!("`soaks`: {why}"), help))
}

#[pymethods]
impl CampaignSimulation {
    /// Times in s, readings, unit of a sensor in a soak.
    fn samples<'py>(&self, py: Python<'py>, soak: usize, sensor: &str) -> Option<Samples<'py>> {
        samples(py, self.0.soaks.get(soak)?, sensor_kind(sensor))
    }

    /// Temperatures of a soak, °C.
    fn temperature_c<'py>(&self, py: Python<'py>, soak: usize) -> Option<Numbers<'py>> {
        self.0.soaks.get(soak)?.temperature_c.as_ref().map(|of| as_array(py, of))
    }

    /// The text of `truth.json`.
    fn truth(&self) -> String {
        to_json(&self.0.truth)
    }

    /// Its seed, and the names of its recordings.
    fn about(&self) -> String {
        json!({ "seed": self.0.seed, "names": SimulatedCampaign::names(self.0.soaks.len()) }).to_string()
    }

    /// Writes the files of `calibrant simulate`.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let of = Arc::clone(&self.0);
        run(py, move || of.write(&directory))
    }
}

//! Rehearses a campaign over temperature beside the usual ones in its time.

use calibrant_campaign::{CampaignRehearsal, design_over_cycles, rehearse, usual};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_io::Experiment;
use calibrant_report::usual_name;

/// Sensors where nobody says how many.
const SENSORS: usize = 30;

/// The rehearsal of a campaign.
#[derive(Debug, Clone, Copy)]
pub struct CampaignStudy<'a> {
    /// With `[campaign]`.
    pub experiment: &'a Experiment,
    /// Number of sensors.
    pub sensors: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl<'a> CampaignStudy<'a> {
    /// Of this number of sensors (default 30), and with this seed (default: that of the experiment).
    #[must_use]
    pub fn new(experiment: &'a Experiment, sensors: Option<usize>, seed: Option<u64>) -> Self {
        let seed = seed.unwrap_or(experiment.study.seed);
        Self { experiment, sensors: sensors.unwrap_or(SENSORS), seed }
    }

    /// Designs the best campaign, draws sensors from the priors of the experiment, and fits each of them by the best campaign and by the usual ones. `done` gets the
    /// number of sensors that are finished.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the experiment has no `[campaign]`, or no time for a soak. As [`rehearse`] where a campaign leaves coefficients open.
    pub fn run(&self, done: impl Fn(usize)) -> Result<CampaignRehearsal> {
        let (model, section) = (self.experiment.campaign_model()?, self.experiment.campaign_section());
        let (model, section) = model.zip(section).ok_or_else(|| {
            let help = "see `calibrant init campaign`";
            Error::experiment(InputError::new(Refusal::KeyMissing, "the experiment has no [campaign]", help))
        })?;
        let (campaign, best) = design_over_cycles(&model.campaign, section.cycles())?;
        let best = std::iter::once(("this campaign".to_owned(), best.soaks));
        let usual = usual(&campaign).into_iter().map(|usual| (usual_name(&usual), usual.soaks));
        let campaigns: Vec<_> = best.chain(usual).collect();
        rehearse(&model, &campaigns, self.sensors, self.seed, done)
    }
}

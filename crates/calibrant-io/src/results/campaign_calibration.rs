//! `calibration.json` of a campaign over temperature: one calibration from several soaks. Every reader of calibrations takes it.

use super::heading::{Heading, JsonFile};
use super::judgement::Judgement;
use super::origin::Origin;
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, FittedChannel, FittedSoak};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::estimate::{CalibrationStatus, Validation};
use calibrant_core::json::{flat, if_any, if_some};
use calibrant_core::json_object;
use calibrant_core::sensor::ImuFields;

/// The content of the `calibration.json` of a campaign.
#[derive(Clone, Copy)]
pub struct CampaignCalibrationFile<'a> {
    /// The calibration.
    pub fitted: &'a FittedCampaign,
    /// What was fitted.
    pub model: &'a CampaignModel,
    /// Of which sensor it is, and from which files.
    pub origin: &'a Origin,
    /// The calibration on recordings that were not used.
    pub validations: &'a [Validation],
    /// What judges it.
    pub judgement: Judgement<'a>,
}

impl CampaignCalibrationFile<'_> {
    fn warnings(&self) -> Vec<Diagnostic> {
        self.judgement.stated(&self.fitted.warnings)
    }
}

json_object! {
    /// A calibration over temperature from several soaks, where it comes from, and what judges it.
    CampaignCalibrationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        origin: flat(file.origin),
        verdict: file.judgement.verdict(&file.fitted.warnings),
        /// How the estimate ended: least squares have one step.
        status: CalibrationStatus::Converged,
        imu: flat(ImuFields::of(file.fitted.imu.clone())),
        /// The range of Legendre polynomials and goals.
        campaign_range_c: file.model.campaign.range_c,
        /// The axis whose bias contains its gain at 1 g, of a recording in one pose.
        with_gain: if_some(file.fitted.with_gain),
        /// The quantities that follow temperature.
        channels: file.fitted.channels.iter().map(ChannelOf).collect::<Vec<_>>(),
        /// The soaks in their order.
        soaks: file.fitted.soaks.iter().map(|soak| SoakOf { soak, channels: &file.fitted.channels }).collect::<Vec<_>>(),
        /// Errors on recordings that were not used, one for each direction of their temperature.
        validations: if_any(file.validations),
        warnings: file.warnings(),
    }
}

impl JsonFile for CampaignCalibrationFile<'_> {
    const KIND: &'static str = "campaign-calibration";
}

struct ChannelOf<'a>(&'a FittedChannel);

json_object! {
    /// A quantity over temperature. Gains are relative to their mean over the soaks.
    ChannelOf<'_> as of {
        name: &of.0.channel.name,
        /// Unit of what follows.
        unit: of.0.channel.unit,
        /// The order that is reported; what is above it has a small prior.
        order: of.0.order,
        /// Root of the mean variance over the range.
        sd: of.0.sd(),
        goal_sd: of.0.channel.goal_sd,
        /// What does not average within a soak.
        soak_sd: of.0.scatter.soak_sd,
        /// The share of the lag's error that differs from soak to soak.
        lag_scatter: of.0.scatter.lag_scatter,
        /// Was `soak_sd` found from the soaks?
        scatter_found: of.0.scatter.found,
        /// Coefficients of each axis in Legendre polynomials over the range, then of hysteresis and of lag.
        coefficients: of.0.coefficients.iter().map(|of| of.iter().copied().collect::<Vec<f64>>()).collect::<Vec<_>>(),
        /// Root mean square of each soak less what the others predict of it, over the standard deviations: 1 where these hold.
        left_out_ratio: if_some(of.0.left_out_ratio),
        /// Probability that there is no hysteresis; nothing where the soaks do not determine it.
        hysteresis_p_value: if_some(of.0.hysteresis.as_ref().map(|test| test.p_value)),
        /// Probability that the thermometer does not lag.
        lag_p_value: if_some(of.0.lag.as_ref().map(|test| test.p_value)),
    }
}

struct SoakOf<'a> {
    soak: &'a FittedSoak,
    channels: &'a [FittedChannel],
}

json_object! {
    /// A soak beside the fit.
    SoakOf<'_> as of {
        name: &of.soak.name,
        temperature_c: of.soak.path.temperature_c,
        /// 1 from below, -1 from above, 0 where nobody knows.
        direction: of.soak.path.direction,
        /// Its rate over that of the ramps.
        lag_left: of.soak.path.lag_left,
        /// Standard deviations of each channel by the soak's own calibration, by axis.
        sds: of.residuals(|soak| &soak.sds),
        /// The residuals of each channel in its unit, by axis.
        residuals: of.residuals(|soak| &soak.residuals),
        /// Their standard deviations.
        residual_sds: of.residuals(|soak| &soak.residual_sds),
    }
}

impl SoakOf<'_> {
    fn residuals(
        &self,
        of: fn(&FittedSoak) -> &Vec<Vec<f64>>,
    ) -> std::collections::BTreeMap<String, Vec<f64>> {
        self.channels
            .iter()
            .zip(of(self.soak))
            .map(|(channel, of)| (channel.channel.name.clone(), of.clone()))
            .collect()
    }
}

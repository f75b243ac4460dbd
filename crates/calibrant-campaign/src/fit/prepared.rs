//! What is known of the soaks before the least squares, and the result that follows.

use super::branch::Solved;
use super::check::open;
use super::entry::{AtReference, Entry, Means};
use super::least_squares::{Measurement, Prediction, Problem, Solution};
use super::model::{CampaignModel, constant, name_of};
use super::result::{FittedCampaign, FittedChannel, FittedSoak};
use super::scatter::{AxisData, SoakScatter, scatter};
use super::soak::{SoakCalibration, SoakPath, paths};
use super::verdicts::ChannelData;
use crate::Channel;
use calibrant_core::error::Result;
use calibrant_core::sensor::{CalibratedImu, CovarianceDegrees, ImuQuantity, SharedErrors};
use nalgebra::DVector;

/// Everything that is known before the least squares.
pub(super) struct Prepared<'a> {
    pub(super) model: &'a CampaignModel,
    pub(super) soaks: &'a [SoakCalibration],
    pub(super) paths: Vec<SoakPath>,
    means: Means,
    /// Channels that follow temperature, then the constants.
    pub(super) channels: Vec<Channel>,
    pub(super) entries: Vec<Entry>,
    pub(super) measurements: Vec<Measurement>,
    pub(super) scatters: Vec<SoakScatter>,
}

impl<'a> Prepared<'a> {
    pub(super) fn of(
        model: &'a CampaignModel,
        soaks: &'a [SoakCalibration],
        one_by_one: &[Option<SoakCalibration>],
        quantities: &[ImuQuantity],
    ) -> Result<Self> {
        let campaign = &model.campaign;
        let means = Means::of(&soaks.iter().map(|soak| &soak.imu).collect::<Vec<_>>());
        let (channels, entries) = layout(model, quantities);
        let paths = paths(campaign, soaks.iter().map(|soak| soak.temperature));
        let both = soaks.iter().zip(one_by_one.iter().map(Option::as_ref));
        let measurements: Vec<Measurement> =
            both.filter_map(|soak| Measurement::of(soak, quantities, &means)).collect();
        let mut prepared =
            Self { model, soaks, paths, means, channels, entries, measurements, scatters: Vec::new() };
        prepared.scatters = prepared.scattered()?;
        Ok(prepared)
    }

    /// The measurements of a channel, for each of its axes.
    pub(super) fn axes(&self, channel: usize) -> Vec<AxisData> {
        let of_channel = (0..self.entries.len()).filter(|k| self.entries[*k].channel == channel);
        let of = |k: usize, of: fn(&Measurement, usize) -> f64| {
            DVector::from_iterator(self.measurements.len(), self.measurements.iter().map(|one| of(one, k)))
        };
        of_channel
            .map(|k| AxisData {
                values: of(k, |one, k| one.one_by_one.0[k]),
                variances: of(k, |one, k| one.one_by_one.1[k]),
            })
            .collect()
    }

    fn problem(&self) -> Problem<'_> {
        let (campaign, channels) = (&self.model.campaign, &self.channels);
        Problem { campaign, channels, entries: &self.entries, scatters: &self.scatters }
    }

    /// The coefficients of all soaks.
    pub(super) fn solve(&self) -> Option<Solution> {
        self.problem().solve(&self.measurements, &self.paths)
    }

    /// The same without a soak; `None` where coefficients stay open.
    pub(super) fn without(&self, soak: usize) -> Option<Prepared<'a>> {
        let kept = |k: &usize| *k != soak;
        let places: Vec<usize> = (0..self.measurements.len()).filter(kept).collect();
        let mut others = Prepared {
            paths: places.iter().map(|k| self.paths[*k]).collect(),
            measurements: places.iter().map(|k| self.measurements[*k].clone()).collect(),
            channels: self.channels.clone(),
            entries: self.entries.clone(),
            means: self.means.clone(),
            scatters: Vec::new(),
            ..*self
        };
        others.scatters = others.scattered().ok()?;
        Some(others)
    }

    /// What these soaks predict of another.
    pub(super) fn prediction(&self, measurement: &Measurement, path: &SoakPath) -> Option<Prediction> {
        self.problem().prediction(&self.solve()?, measurement, path)
    }

    fn scattered(&self) -> Result<Vec<SoakScatter>> {
        let of_channel = |channel| {
            let found =
                scatter(&self.model.campaign, &self.channels[channel], &self.axes(channel), &self.paths);
            found.ok_or_else(|| open(&self.channels, &self.paths))
        };
        (0..self.channels.len()).map(of_channel).collect()
    }

    pub(super) fn result(&self, solution: &Solution) -> FittedCampaign {
        let followed = self.model.campaign.channels.len();
        let channels: Vec<FittedChannel> =
            (0..followed).filter_map(|channel| self.channel(channel, solution)).collect();
        let soaks = (0..self.soaks.len()).map(|soak| self.soak(soak, solution)).collect();
        let warnings = self.warnings(&channels, solution);
        let solved = Solved {
            campaign: self.model.campaign.clone(),
            channels: self.channels.clone(),
            entries: self.entries.clone(),
            means: self.means.clone(),
            scatters: self.scatters.clone(),
            coefficients: solution.coefficients.clone(),
            covariance: solution.covariance.clone(),
        };
        FittedCampaign { imu: self.imu(solution), channels, soaks, warnings, with_gain: None, solved }
    }

    fn imu(&self, solution: &Solution) -> CalibratedImu {
        let first = &self.soaks[0].imu;
        let campaign = &self.model.campaign;
        let (range_c, reference_c) = (campaign.range_c, self.model.reference_c);
        let mean = |entry: &Entry| self.channels[entry.channel].on_branch(0.0, 0.0);
        let of_range = (range_c, reference_c);
        let at = AtReference::of(&self.entries, &self.means, &solution.coefficients, mean, of_range);
        let mut parameters = first.parameters;
        let temperatures = self.paths.iter().map(|path| path.temperature_c);
        parameters.thermal.reference_c = reference_c;
        // to 10 mK, as people read it
        let rounded = temperatures.map(|t| (100.0 * t).round() / 100.0);
        parameters.thermal.range_c =
            rounded.map(|t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)]);
        at.set(&mut parameters);
        let root = &at.jacobian * &solution.shared;
        let covariance =
            &at.jacobian * &solution.covariance * at.jacobian.transpose() + &root * root.transpose();
        let shared =
            first.shared.as_ref().map(|shared| SharedErrors { sources: shared.sources.clone(), root });
        CalibratedImu {
            parameters,
            quantities: at.quantities,
            covariance: Some(0.5 * (&covariance + covariance.transpose())),
            degrees_of_freedom: Some(self.degrees()),
            shared,
            ..first.clone()
        }
    }

    /// Those of the polynomials' variances; infinite where the scatter between soaks is as stated.
    fn degrees(&self) -> CovarianceDegrees {
        let of = |names: &[&str]| {
            let these = self
                .channels
                .iter()
                .zip(&self.scatters)
                .filter(|(channel, _)| names.contains(&&*channel.name));
            these.map(|(_, scatter)| scatter.degrees).fold(f64::INFINITY, f64::min)
        };
        CovarianceDegrees {
            accelerometer: of(&["accelerometer.bias", "accelerometer.scale"]),
            gyroscope_at_rest: of(&["gyroscope.bias"]),
            gyroscope_matrix: of(&["gyroscope.scale"]),
        }
    }

    /// `None` for a channel without parameters.
    fn channel(&self, channel: usize, solution: &Solution) -> Option<FittedChannel> {
        let entries: Vec<&Entry> = self.entries.iter().filter(|entry| entry.channel == channel).collect();
        let covariance = &solution.covariance;
        let axes = self.axes(channel);
        let data = self.data(channel, &axes);
        (!entries.is_empty()).then(|| FittedChannel {
            channel: self.channels[channel].clone(),
            order: self.model.orders[channel],
            scatter: self.scatters[channel],
            relative_to: entries.iter().map(|entry| self.means.relative_to(entry.quantity)).collect(),
            coefficients: entries
                .iter()
                .map(|entry| solution.coefficients.rows_range(entry.places.clone()).into_owned())
                .collect(),
            covariances: entries
                .iter()
                .map(|entry| covariance.view_range(entry.places.clone(), entry.places.clone()).into_owned())
                .collect(),
            left_out_ratio: self.left_out_ratio(channel, solution),
            hysteresis: data.hysteresis_test(),
            lag: data.lag_test(),
        })
    }

    fn left_out_ratio(&self, channel: usize, solution: &Solution) -> Option<f64> {
        let of_channel = |of: &DVector<f64>| -> Vec<f64> {
            let these = self.entries.iter().zip(of.iter()).filter(|(entry, _)| entry.channel == channel);
            these.map(|(_, deviation)| deviation * deviation).collect()
        };
        let squares: Vec<f64> = solution.left_out.iter().flatten().flat_map(of_channel).collect();
        (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    }

    pub(super) fn data<'b>(&'b self, channel: usize, axes: &'b [AxisData]) -> ChannelData<'b> {
        ChannelData {
            campaign: &self.model.campaign,
            channel: &self.channels[channel],
            axes,
            paths: &self.paths,
            scatter: &self.scatters[channel],
        }
    }

    fn soak(&self, soak: usize, solution: &Solution) -> FittedSoak {
        let (residuals, sds) = &solution.residuals[soak];
        let of_channels = |of: &DVector<f64>| -> Vec<Vec<f64>> {
            let of_channel = |channel| {
                let these = self.entries.iter().zip(of.iter()).filter(|(entry, _)| entry.channel == channel);
                these.map(|(_, value)| *value).collect()
            };
            (0..self.model.campaign.channels.len()).map(of_channel).collect()
        };
        FittedSoak {
            name: self.soaks[soak].name.clone(),
            path: self.paths[soak],
            values: of_channels(&self.measurements[soak].values),
            sds: of_channels(&self.measurements[soak].covariance.diagonal().map(f64::sqrt)),
            residuals: of_channels(residuals),
            residual_sds: of_channels(sds),
        }
    }
}

/// Channels and entries of these parameters.
fn layout(model: &CampaignModel, quantities: &[ImuQuantity]) -> (Vec<Channel>, Vec<Entry>) {
    let mut channels = model.channels();
    let mut entries: Vec<Entry> = Vec::new();
    let mut end = 0;
    for quantity in quantities {
        let followed = name_of(*quantity);
        let named =
            |name: &str, channels: &[Channel]| channels.iter().position(|channel| channel.name == name);
        let channel = followed.and_then(|name| named(&name, &channels)).unwrap_or_else(|| {
            let constant = constant(*quantity);
            named(&constant.name, &channels).unwrap_or_else(|| {
                channels.push(constant);
                channels.len() - 1
            })
        });
        let of = &channels[channel];
        let places = end..end + of.coefficients();
        end = places.end;
        entries.push(Entry { quantity: *quantity, channel, places });
    }
    (channels, entries)
}

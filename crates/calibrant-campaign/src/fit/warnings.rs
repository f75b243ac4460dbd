//! What was noticed in the soaks.

use super::least_squares::Solution;
use super::prepared::Prepared;
use super::result::FittedChannel;
use super::soak::{CHANGES, SoakPath};
use calibrant_core::diagnostic::campaign::{
    Aged, DirectionUnknown, HysteresisLarge, HysteresisSeen, LagSeen, NotSettled, OneDirection, OrderTooHigh,
    OrderTooLow, RangeNotCovered, SEEN, ScatterStated, SoakDisagrees,
};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::estimate::f_p_value;
use calibrant_core::sensor::HIGHEST_ORDER;

/// What speaks against a result must be less probable.
const RARE: f64 = 1e-3;

impl Prepared<'_> {
    pub(super) fn warnings(&self, channels: &[FittedChannel], solution: &Solution) -> Vec<Diagnostic> {
        let mut found: Vec<Diagnostic> = Vec::new();
        for (number, channel) in channels.iter().enumerate() {
            self.of_channel(number, channel, &mut found);
        }
        found.extend(self.disagreement(solution));
        found.extend(self.one_direction(channels));
        found.extend(self.range());
        found.extend(self.not_settled());
        let stated = channels.iter().filter(|channel| !channel.scatter.found);
        let quantities: Vec<String> = stated.map(|channel| channel.channel.name.clone()).collect();
        if !quantities.is_empty() {
            found.push(ScatterStated { quantities }.into());
        }
        let unknown = self.soaks.iter().zip(&self.paths).filter(|(_, path)| path.direction == 0.0);
        let soaks: Vec<String> = unknown.map(|(soak, _)| soak.name.clone()).collect();
        if !soaks.is_empty() {
            found.push(DirectionUnknown { soaks }.into());
        }
        found
    }

    /// The soaks whose temperature still changes, where no channel has a lag.
    fn not_settled(&self) -> Option<Diagnostic> {
        if self.channels.iter().any(|channel| !channel.lag_sd.is_empty()) {
            return None;
        }
        let changing = || self.soaks.iter().zip(&self.paths).filter(|(_, path)| path.lag_left > CHANGES);
        let soaks: Vec<String> = changing().map(|(soak, _)| soak.name.clone()).collect();
        let rates = changing().map(|(soak, _)| soak.temperature.rate_k_per_min.abs());
        let rate_k_per_min = rates.fold(0.0, f64::max);
        (!soaks.is_empty()).then(|| NotSettled { soaks, rate_k_per_min }.into())
    }

    fn of_channel(&self, number: usize, channel: &FittedChannel, found: &mut Vec<Diagnostic>) {
        let axes = self.axes(number);
        let data = self.data(number, &axes);
        let quantity = Phrase(channel.channel.name.clone());
        let (unit, goal) = (channel.channel.unit, channel.channel.goal_sd);
        if channel.hysteresis.as_ref().is_some_and(|test| test.p_value < SEEN) {
            let half_difference = data.half_difference(&channel.coefficients);
            found.push(match half_difference > goal {
                true => HysteresisLarge { quantity: quantity.clone(), unit, half_difference, goal }.into(),
                false => HysteresisSeen { quantity: quantity.clone(), unit, half_difference, goal }.into(),
            });
        }
        if let Some(test) = channel.lag.as_ref().filter(|test| test.p_value < SEEN) {
            let (at_ramp, lag_s) = (data.at_ramp(&channel.coefficients), data.lag_s(test));
            found.push(LagSeen { quantity: quantity.clone(), unit, at_ramp, lag_s }.into());
        }
        if data.beyond_p_value(channel.order).is_some_and(|p| p < RARE) && channel.order < HIGHEST_ORDER {
            let (order, next) = (channel.order, channel.order + 1);
            found.push(OrderTooLow { quantity: quantity.clone(), order, next }.into());
        } else if self.is_unseen(number, channel) && data.is_better_without(channel.order) == Some(true) {
            let (order, lower) = (channel.order, channel.order - 1);
            found.push(OrderTooHigh { quantity: quantity.clone(), order, lower }.into());
        }
        // in one direction alone, time is temperature
        let drift = self.both_directions().then(|| data.drift_test()).flatten();
        if let Some(test) = drift.filter(|test| test.p_value < RARE) {
            let drift = test
                .estimates
                .iter()
                .map(|of| of[0])
                .fold(0.0, |most: f64, of| if of.abs() > most.abs() { of } else { most });
            found.push(Aged { quantity, unit, drift }.into());
        }
    }

    /// Are the coefficients of the order within 1 sd of 0 on all axes, where one of the size that is known beforehand would be more?
    fn is_unseen(&self, number: usize, channel: &FittedChannel) -> bool {
        /// Of a coefficient that is twice its standard deviation, three axes are all within one in 4 % of sensors.
        const WOULD_BE_SEEN: f64 = 2.0;
        let order = channel.order;
        let known = self.model.campaign.channels[number].spread.get(order).copied().flatten();
        order > 0
            && channel.coefficients.iter().zip(&channel.covariances).all(|(c, covariance)| {
                let sd = covariance[(order, order)].sqrt();
                c[order].abs() < sd && known.is_none_or(|known| known > WOULD_BE_SEEN * sd)
            })
    }

    /// The soak that is farthest from what the others say of it, where it is too far among so many. A soak that is off widens the scatter that is found with it: so the
    /// others are fitted without it.
    fn disagreement(&self, solution: &Solution) -> Option<Diagnostic> {
        let (mut worst, mut count) = (0.0_f64, 0);
        let mut soak = None;
        for (k, (residuals, sds)) in solution.residuals.iter().enumerate() {
            for entry in 0..residuals.len() {
                // a soak that alone determines something has no residual
                if sds[entry] > 1e-6 * self.measurements[k].covariance[(entry, entry)].sqrt() {
                    count += 1;
                    let off = (residuals[entry] / sds[entry]).abs();
                    if off > worst {
                        (worst, soak) = (off, Some(k));
                    }
                }
            }
        }
        let soak = soak?;
        let name =
            |entry: usize| (Phrase(self.soaks[soak].name.clone()), self.entries[entry].quantity.name());
        let others = self.without(soak)?;
        let prediction = others.prediction(&self.measurements[soak], &self.paths[soak])?;
        let (entry, deviations) = prediction
            .deviations
            .iter()
            .copied()
            .enumerate()
            .max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
        // Student's t: the scatter is found from the others
        let scatter = &others.scatters[self.entries[entry].channel];
        let behind = if scatter.found { scatter.residuals } else { f64::INFINITY };
        let p = f_p_value(deviations * deviations, 1, behind)? * f64::from(count);
        if p > RARE {
            return None;
        }
        let change = &prediction.coefficients - &solution.coefficients;
        let moved =
            change.iter().zip(prediction.variances.iter()).map(|(of, variance)| of.abs() / variance.sqrt());
        let (soak, parameter) = name(entry);
        Some(SoakDisagrees { soak, parameter, deviations, moves: moved.fold(0.0, f64::max) }.into())
    }

    /// Is a temperature reached in both directions?
    fn both_directions(&self) -> bool {
        let near = |one: &SoakPath, other: &SoakPath| {
            (one.temperature_c - other.temperature_c).abs() <= self.model.campaign.spacing_c
        };
        let opposite = |one: &SoakPath, other: &SoakPath| one.direction * other.direction < 0.0;
        self.paths.iter().any(|one| self.paths.iter().any(|other| near(one, other) && opposite(one, other)))
    }

    /// The quantities whose hysteresis and lag count, where every temperature is reached in one direction.
    fn one_direction(&self, channels: &[FittedChannel]) -> Option<Diagnostic> {
        let most_left = self.paths.iter().map(|path| path.lag_left).fold(0.0, f64::max);
        let counts = |channel: &&FittedChannel| {
            let of = &channel.channel;
            let half = of.hysteresis_sd.first().map_or(0.0, |sd| 0.5 * sd);
            let lag = of.lag_sd.first().map_or(0.0, |sd| sd * most_left);
            half.hypot(lag) > of.goal_sd
        };
        let quantities: Vec<String> =
            channels.iter().filter(counts).map(|channel| channel.channel.name.clone()).collect();
        (!self.both_directions() && !quantities.is_empty()).then(|| OneDirection { quantities }.into())
    }

    /// Do the soaks cover the range, and not more?
    fn range(&self) -> Option<Diagnostic> {
        /// A part of the range that may be missing at an end, or lie beyond it.
        const PART: f64 = 0.1;
        let [low, high] = self.model.campaign.range_c;
        let temperatures = self.paths.iter().map(|path| path.temperature_c);
        let [coldest_c, hottest_c] =
            temperatures.map(|t| [t, t]).reduce(|[l, h], [t, _]| [l.min(t), h.max(t)])?;
        let off = (coldest_c - low).abs().max((hottest_c - high).abs());
        (off > PART * (high - low))
            .then(|| RangeNotCovered { coldest_c, hottest_c, low_c: low, high_c: high }.into())
    }
}

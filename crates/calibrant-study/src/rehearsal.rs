//! A rehearsal of a machine: simulated sensors, calibrated on a plain routine and again on the best trajectory.

use super::Improvement;
use super::summary::{Triple, compare};
use calibrant_core::json_object;
use calibrant_core::sensor::Parameter;
use schemars::JsonSchema;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Sensors that were calibrated on a plain routine of a machine, and again on its best trajectory. All is drawn anew for each: the sensor, its mount, the clocks, gravity
/// and the geometry of the machine.
#[derive(Debug, Clone)]
pub struct Rehearsal {
    /// Seed of the first sensor; each later one has the next.
    pub seed: u64,
    /// Duration of both motions, s.
    pub duration_s: f64,
    /// The parameters, in the order of all lists of values.
    pub parameters: Vec<Parameter>,
    /// What the first motion is.
    pub routine: &'static str,
    /// Standard deviations that were designed: with the plain routine, and with the best trajectory.
    pub designed_sd: [Vec<f64>; 2],
    /// One entry for each sensor.
    pub sensors: Vec<RehearsedSensor>,
    /// Summary over the sensors, one entry for each parameter; initial is the plain routine.
    pub summary: Vec<Improvement>,
}

/// One sensor with both calibrations.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RehearsedSensor {
    /// Its seed: `calibrant simulate --seed` makes it again.
    pub seed: u64,
    /// True values.
    pub truth: Vec<f64>,
    /// The calibration on the plain routine.
    pub plain: RehearsedCalibration,
    /// The calibration on the best trajectory.
    pub optimal: RehearsedCalibration,
}

/// A calibration of a rehearsal.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RehearsedCalibration {
    /// Estimates.
    #[serde(rename = "value")]
    pub values: Vec<f64>,
    /// Their standard deviations, as the calibration states them.
    pub sd: Vec<f64>,
    /// May the result be used: `ok`, `doubtful` or `bad`.
    pub verdict: &'static str,
    /// Codes of the warnings.
    pub codes: Vec<&'static str>,
}

/// A parameter that is not as it was designed, by more than chance explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departure {
    /// Its place among the parameters.
    pub parameter: usize,
    /// On the plain routine, or on the best trajectory?
    pub is_plain: bool,
    /// Is it the error that departs, not the stated standard deviation?
    pub is_realised: bool,
    /// Root mean square over the sensors, over the standard deviation that was designed.
    pub factor: f64,
}

/// Probability of a departure by chance, for all parameters on both motions together.
const BY_CHANCE: f64 = 0.01;

impl Rehearsal {
    /// The parameter that departs the most from what was designed for its motion; `None` where all are as designed, up to chance. Stated standard deviations may be
    /// neither larger nor smaller, errors not larger.
    ///
    /// # Formula
    /// A mean square of `n` errors over its variance is `χ²_n/n`. So are its bounds, at `0.01/8p` on each side for the two numbers of each of `p` parameters on two motions
    /// (Bonferroni).
    #[must_use]
    pub fn departure(&self) -> Option<Departure> {
        let n = self.sensors.len() as f64;
        let tail = BY_CHANCE / (8 * self.summary.len().max(1)) as f64;
        let chi2 = ChiSquared::new(n).ok()?;
        let [least, most] = [tail, 1.0 - tail].map(|p| (chi2.inverse_cdf(p) / n).sqrt());
        let of = |(is_plain, parameter, designed): (bool, usize, &f64)| {
            let entry = self.summary.get(parameter)?;
            let found = if is_plain { &entry.initial } else { &entry.optimal };
            let departure = |is_realised, found: f64| {
                let factor = found / designed;
                Departure { parameter, is_plain, is_realised, factor }
            };
            let stated = departure(false, found.predicted_sd);
            let realised = departure(true, found.realised_rms);
            let all = [(stated, (least..=most)), (realised, (0.0..=most))];
            let departs = all.into_iter().filter(|(of, chance)| !chance.contains(&of.factor));
            designed.is_finite().then(|| departs.map(|(of, _)| of))
        };
        let by_size =
            |one: &Departure, other: &Departure| one.factor.ln().abs().total_cmp(&other.factor.ln().abs());
        let motions = self.designed_sd.iter().zip([true, false]);
        let all =
            motions.flat_map(|(sds, is_plain)| sds.iter().enumerate().map(move |(k, sd)| (is_plain, k, sd)));
        all.filter_map(of).flatten().max_by(by_size)
    }

    /// Of these sensors, with the summary.
    #[must_use]
    pub fn of(
        (seed, duration_s): (u64, f64),
        parameters: Vec<Parameter>,
        routine: &'static str,
        designed_sd: [Vec<f64>; 2],
        sensors: Vec<RehearsedSensor>,
    ) -> Self {
        fn triple<'a>(of: &'a RehearsedSensor, by: &'a RehearsedCalibration) -> Triple<'a> {
            (&of.truth, &by.values, &by.sd)
        }
        let plain: Vec<_> = sensors.iter().map(|of| triple(of, &of.plain)).collect();
        let optimal: Vec<_> = sensors.iter().map(|of| triple(of, &of.optimal)).collect();
        let summary = compare(&parameters, &plain, &optimal);
        Self { seed, duration_s, summary, parameters, routine, designed_sd, sensors }
    }
}

json_object! {
    /// Simulated sensors on a machine, calibrated on a plain routine and again on the best trajectory.
    Rehearsal as of {
        /// Of the first sensor; each later one has the next.
        seed: of.seed,
        /// Duration of both motions, s.
        duration_s: of.duration_s,
        /// The order of all lists of values.
        parameters: &of.parameters,
        /// What the plain routine is: `six poses` or `joints in turn`.
        routine: of.routine,
        /// Standard deviations that the design states for the plain routine.
        designed_sd_plain: &of.designed_sd[0],
        /// Standard deviations that the design states for the best trajectory.
        designed_sd_optimal: &of.designed_sd[1],
        /// Of each parameter; initial is the plain routine.
        summary: &of.summary,
        /// Each sensor with both calibrations.
        sensors: &of.sensors,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, ReadingUnit, SensorKind};
    use calibrant_core::simulate::{Purpose, stream};
    use rand_distr::{Distribution, StandardNormal};

    /// Two parameters of sensors with these standard deviations of their errors, which state 1 and this.
    fn rehearsed(errors: [f64; 2], stated: f64, designed: [f64; 2]) -> Option<Departure> {
        let mut rng = stream(3, Purpose::Sensor, 0);
        let sensors = (0..60).map(|seed| {
            let values = errors.map(|sd| -> f64 {
                let draw: f64 = StandardNormal.sample(&mut rng);
                sd * draw
            });
            let of = RehearsedCalibration {
                values: values.to_vec(),
                sd: vec![1.0, stated],
                verdict: "ok",
                codes: Vec::new(),
            };
            RehearsedSensor { seed, truth: vec![0.0; 2], plain: of.clone(), optimal: of }
        });
        let parameter = |axis| {
            let of = ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(axis));
            Parameter::undescribed(of, ReadingUnit::RadianPerSecond)
        };
        let parameters = vec![parameter(Axis::X), parameter(Axis::Y)];
        let designed = [designed.to_vec(), designed.to_vec()];
        Rehearsal::of((0, 20.0), parameters, "six poses", designed, sensors.collect()).departure()
    }

    #[test]
    fn a_departure_from_the_design_is_one_beyond_chance() {
        assert_eq!(rehearsed([1.0, 1.0], 1.0, [1.0, 1.0]), None);
        assert_eq!(rehearsed([1.0, 1.0], 1.0, [1.0, f64::INFINITY]), None, "not determined");
        // promised 1.8 times better than stated
        let found = rehearsed([1.0, 1.0], 1.0, [1.0, 1.0 / 1.8]).expect("beyond chance");
        assert_eq!(found.parameter, 1);
        assert!((found.factor / 1.8 - 1.0).abs() < 0.3, "{found:?}");
        let found = rehearsed([2.0, 1.0], 1.0, [1.0, 1.0]).expect("beyond chance");
        assert!(found.parameter == 0 && found.is_realised, "{found:?}");
        // errors may be smaller, statements not
        assert_eq!(rehearsed([0.5, 1.0], 1.0, [1.0, 1.0]), None);
        let found = rehearsed([1.0, 0.5], 0.5, [1.0, 1.0]).expect("beyond chance");
        assert_eq!(found, Departure { parameter: 1, is_plain: false, is_realised: false, factor: 0.5 });
    }
}

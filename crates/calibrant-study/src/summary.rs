//! Summaries over the sensors of a study: truth against estimate in a few numbers.

use super::{DesignOutcome, Factor, Improvement, MotionOutcome, ParameterSummary, TraceRange, TraceSummary};
use calibrant_core::sensor::Parameter;

/// Half-width of a 95 % interval in standard deviations.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Truth, estimates and their standard deviations of one sensor.
pub(super) type Triple<'a> = (&'a [f64], &'a [f64], &'a [f64]);

/// One entry for each parameter.
pub(super) fn summarise(parameters: &[Parameter], sensors: &[Triple<'_>]) -> Vec<ParameterSummary> {
    let mean = |f: &dyn Fn(&Triple<'_>) -> f64| sensors.iter().map(f).sum::<f64>() / sensors.len() as f64;
    parameters
        .iter()
        .enumerate()
        .map(|(k, parameter)| ParameterSummary {
            name: parameter.name.clone(),
            unit: parameter.unit,
            predicted_sd: mean(&|(_, _, sd)| sd[k].powi(2)).sqrt(),
            realised_rms: mean(&|(truth, value, _)| (value[k] - truth[k]).powi(2)).sqrt(),
            mean_error: mean(&|(truth, value, _)| value[k] - truth[k]),
            coverage_95: mean(&|(truth, value, sd)| {
                f64::from((value[k] - truth[k]).abs() <= NORMAL_95 * sd[k])
            }),
        })
        .collect()
}

/// The results of both motions for each parameter.
pub(super) fn compare(
    parameters: &[Parameter],
    before: &[Triple<'_>],
    after: &[Triple<'_>],
) -> Vec<Improvement> {
    let squares =
        |of: &[Triple<'_>], square: &dyn Fn(&Triple<'_>) -> f64| of.iter().map(square).collect::<Vec<_>>();
    let summaries = summarise(parameters, before).into_iter().zip(summarise(parameters, after));
    let one = |(k, (initial, optimal)): (usize, (ParameterSummary, ParameterSummary))| {
        let error = |(truth, value, _): &Triple<'_>| (value[k] - truth[k]).powi(2);
        let stated = |(_, _, sd): &Triple<'_>| sd[k].powi(2);
        Improvement {
            initial,
            optimal,
            predicted: factor(&squares(before, &stated), &squares(after, &stated)),
            realised: factor(&squares(before, &error), &squares(after, &error)),
        }
    };
    summaries.enumerate().map(one).collect()
}

/// Truth, estimates and standard deviations of sensors, on one of their motions.
pub(super) fn triples(
    outcomes: &[DesignOutcome],
    motion: fn(&DesignOutcome) -> &MotionOutcome,
) -> Vec<Triple<'_>> {
    let one = |outcome| -> Triple<'_> {
        let of: &MotionOutcome = motion(outcome);
        (&outcome.truth, &of.values, &of.sd)
    };
    outcomes.iter().map(one).collect()
}

/// The ratio of two root mean squares, from the squares of each sensor.
///
/// Its standard error is that of `ln r = ½ (ln mean p − ln mean q)` to first order, from the scatter of the
/// pairs: `½ sd(p/mean p − q/mean q)/√n`. It does not assume a normal distribution, because the sensors'
/// initial motions differ.
fn factor(before: &[f64], after: &[f64]) -> Factor {
    let n = before.len() as f64;
    let (p, q) = (before.iter().sum::<f64>() / n, after.iter().sum::<f64>() / n);
    let value = (p / q).sqrt();
    let scatter: f64 = before.iter().zip(after).map(|(b, a)| (b / p - a / q).powi(2)).sum();
    let error = value * 0.5 * (scatter / (n - 1.0) / n).sqrt();
    Factor { value, standard_error: (before.len() > 1).then_some(error) }
}

/// The summaries of the traces over the sensors.
pub(super) fn traces(outcomes: &[DesignOutcome]) -> TraceSummary {
    TraceSummary {
        initial: range(outcomes.iter().map(|outcome| outcome.initial.trace).collect()),
        optimal: range(outcomes.iter().map(|outcome| outcome.optimal.trace).collect()),
    }
}

fn range(mut values: Vec<f64>) -> TraceRange {
    values.sort_by(f64::total_cmp);
    let at = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
    let last = values.len().saturating_sub(1);
    TraceRange { least: at(0), median: 0.5 * (at(last / 2) + at(last.div_ceil(2))), most: at(last) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::simulate::{Purpose, stream};
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn a_range_knows_its_median() {
        assert_eq!(range(vec![3.0, 1.0, 2.0]), TraceRange { least: 1.0, median: 2.0, most: 3.0 });
        assert_eq!(range(vec![4.0, 1.0, 2.0, 3.0]).median, 2.5);
        assert_eq!(range(vec![7.0]), TraceRange { least: 7.0, median: 7.0, most: 7.0 });
    }

    #[test]
    fn the_standard_error_of_a_factor_is_the_scatter_between_repetitions() {
        let n = 30;
        let mut rng = stream(4, Purpose::Sensor, 0);
        let mut squares = |sd: f64| -> Vec<f64> {
            let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
            (0..n).map(|_| (sd * draw()).powi(2)).collect()
        };
        let repetitions = 2000;
        let factors: Vec<_> = (0..repetitions).map(|_| factor(&squares(6.0), &squares(2.0))).collect();
        let logs: Vec<f64> = factors.iter().map(|factor| factor.value.ln()).collect();
        let mean = logs.iter().sum::<f64>() / f64::from(repetitions);
        let scatter = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / f64::from(repetitions - 1);
        let relative = |factor: &Factor| factor.standard_error.expect("many") / factor.value;
        let stated =
            factors.iter().map(|factor| relative(factor).powi(2)).sum::<f64>() / f64::from(repetitions);
        assert!((mean - 3.0_f64.ln()).abs() < 5.0 * (scatter / f64::from(repetitions)).sqrt());
        // first order in 1/√n: 30 sensors leave a few percent
        assert!((stated / scatter).sqrt() > 0.88 && (stated / scatter).sqrt() < 1.05, "{stated} {scatter}");
        assert_eq!(factor(&[4.0], &[1.0]), Factor { value: 2.0, standard_error: None });
    }
}

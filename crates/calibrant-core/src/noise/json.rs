//! The noise of a sensor as JSON: units stand beside the coefficients, points of the Allan deviation are columns.
//! And as the line of an experiment file.

use super::{
    AllanDeviation, AllanPoint, AxisNoise, Coefficient, CoefficientUnit, PowerLaw, SensorNoise,
    coefficient_units,
};
use crate::json_object;
use crate::sensor::{ReadingUnit, SensorKind};
use schemars::JsonSchema;
use serde::Serialize;

json_object! {
    /// The noise of one sensor at rest.
    SensorNoise as noise {
        /// Which sensor it is.
        sensor: noise.sensor_kind,
        /// Unit of the readings, and of all coefficients but for seconds and hertz.
        reading_unit: noise.unit,
        /// The first sample of the segment, from 0.
        first_sample: noise.segment.first,
        /// One past the last sample.
        end_sample: noise.segment.end,
        start_s: noise.segment.start_s,
        end_s: noise.segment.end_s,
        interval_s: noise.segment.interval_s,
        /// Largest deviation of a step from the interval, as a share of it.
        interval_jitter: noise.segment.jitter,
        missing_share: noise.segment.missing,
        axes: noise.axes.iter().map(|axis| AxisOf { noise, axis }).collect::<Vec<_>>(),
        /// The line of an experiment that states the white noise; none where it is not determined.
        experiment: noise_line(noise),
        /// Why the white noise is not that of a sensor at rest.
        caveat: noise.caveat.as_ref(),
        /// What the user should know of it.
        warnings: noise.warnings.as_slice(),
    }
}

struct AxisOf<'a> {
    noise: &'a SensorNoise,
    axis: &'a AxisNoise,
}

impl<'a> AxisOf<'a> {
    fn coefficient(&self, process: PowerLaw) -> CoefficientOf<'a> {
        CoefficientOf {
            coefficient: self.axis.fit.model.coefficient(process),
            units: coefficient_units(self.noise.sensor_kind, process, self.noise.unit),
        }
    }
}

json_object! {
    /// The noise of one axis.
    AxisOf<'_> as of {
        /// Which axis it is.
        axis: of.axis.axis,
        /// Standard deviation of the white noise of one sample.
        white_noise_per_sample: of.axis.fit.model.white_noise_per_sample(of.noise.segment.rate_hz()),
        /// Standard deviation of the samples about their mean.
        sample_sd: of.axis.sample_sd,
        random_walk: of.coefficient(PowerLaw::White),
        bias_instability: of.coefficient(PowerLaw::Flicker),
        rate_random_walk: of.coefficient(PowerLaw::RandomWalk),
        quantisation: of.coefficient(PowerLaw::Quantisation),
        /// Where flicker noise has its largest share of the Allan variance.
        bias_instability_tau_s: of.axis.fit.flat_tau_s,
        /// The slope of the readings.
        drift: of.axis.fit.drift,
        fit: FitOf(of),
        /// Lines in the spectrum.
        vibration: of.axis.fit.vibration.as_ref(),
        allan: &of.axis.allan,
    }
}

struct CoefficientOf<'a> {
    coefficient: &'a Coefficient,
    units: Vec<CoefficientUnit>,
}

#[derive(Serialize, JsonSchema)]
struct InCustomaryUnit {
    /// The unit of a datasheet.
    unit: &'static str,
    /// The estimate.
    value: f64,
    /// Its standard deviation.
    sd: f64,
}

json_object! {
    /// A coefficient with its 95 % interval, or what keeps it from being determined.
    CoefficientOf<'_> as of {
        /// Does the recording determine it?
        determined: of.coefficient.estimate().is_some(),
        /// Its unit, by that of the readings.
        unit: of.units[0].symbol,
        /// The estimate.
        value: of.coefficient.value(),
        /// Its standard deviation.
        sd: of.coefficient.estimate().map(|found| found.sd),
        /// Lower end of its 95 % interval.
        low: of.coefficient.estimate().map(|found| found.low),
        /// Upper end of its 95 % interval.
        high: of.coefficient.estimate().map(|found| found.high),
        /// The same in the units of datasheets.
        customary: of.customary(),
        /// The upper limit, where it is not determined.
        upper_limit: of.coefficient.limit(),
        /// Why it is not determined.
        reason: of.coefficient.reason(),
    }
}

impl CoefficientOf<'_> {
    fn customary(&self) -> Vec<InCustomaryUnit> {
        let Some(found) = self.coefficient.estimate() else { return Vec::new() };
        let scaled = |unit: &CoefficientUnit| {
            let estimate = found.scaled(unit.factor);
            InCustomaryUnit { unit: unit.symbol, value: estimate.value, sd: estimate.sd }
        };
        self.units[1..].iter().map(scaled).collect()
    }
}

struct FitOf<'a>(&'a AxisOf<'a>);

json_object! {
    /// How well the processes explain the Allan deviation.
    FitOf<'_> as of {
        /// Do the samples show a filter?
        filtered: of.0.axis.fit.filtered,
        shortest_tau_s: of.0.axis.fit.shortest_tau_s,
        longest_tau_s: of.0.axis.fit.longest_tau_s,
        /// χ² of the Allan deviation about the model.
        chi2: of.0.axis.fit.chi2,
        /// Its degrees of freedom.
        degrees_of_freedom: of.0.axis.fit.degrees_of_freedom,
        /// Probability of a χ² at least this large if the model is right.
        p_value: of.0.axis.fit.p_value,
    }
}

json_object! {
    super::Drift as drift {
        /// Slope, in the unit of the readings per second.
        per_s: drift.per_s,
        /// Its standard deviation if the noise is as estimated.
        sd: drift.sd,
        /// Is it larger than the noise explains?
        significant: drift.is_significant(),
    }
}

json_object! {
    /// The overlapping Allan deviation with its 95 % bounds, in the unit of the readings.
    AllanDeviation as allan {
        /// Samples in a cluster.
        cluster_samples: allan.points.iter().map(|point| point.cluster).collect::<Vec<_>>(),
        tau_s: column(allan, |point| point.tau_s),
        /// The deviation at each cluster time.
        deviation: column(allan, |point| point.deviation),
        /// Its lower 95 % bound.
        low: column(allan, |point| point.low),
        /// Its upper 95 % bound.
        high: column(allan, |point| point.high),
        /// Equivalent degrees of freedom of its square.
        degrees_of_freedom: column(allan, |point| point.degrees_of_freedom),
    }
}

fn column(allan: &AllanDeviation, of: fn(&AllanPoint) -> f64) -> Vec<f64> {
    allan.points.iter().map(of).collect()
}

/// The line of an experiment file that states a sensor's white noise, and its section.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct NoiseLine {
    /// `sensor` for an accelerometer, `gyroscope` for a gyroscope.
    pub section: &'static str,
    /// The line: `noise_counts = [26.3, 27.1, 25.8]`.
    pub line: String,
}

/// The line to paste into an experiment file, in the unit of the readings. `None` where the white noise is
/// not determined on an axis, or is not that of a sensor at rest.
#[must_use]
pub fn noise_line(noise: &SensorNoise) -> Option<NoiseLine> {
    if noise.caveat.is_some() {
        return None;
    }
    let sigma = noise.white_noise_of_readings()?;
    let counts = noise.unit == ReadingUnit::Counts || noise.gain.is_some();
    let unit = if counts { ReadingUnit::Counts } else { noise.unit };
    let section = match noise.sensor_kind {
        SensorKind::Accelerometer => "sensor",
        SensorKind::Gyroscope => "gyroscope",
    };
    // TOML recognises a float by its point
    let digits = |value: f64| format!("{value:.3e}").parse::<f64>().map(|rounded| format!("{rounded:?}"));
    let values: Vec<String> =
        noise.axes.iter().filter_map(|axis| digits(sigma[axis.axis.index()]).ok()).collect();
    Some(NoiseLine { section, line: format!("noise_{} = [{}]", unit.suffix(), values.join(", ")) })
}

//! The temperatures of a recording with temperature terms, and whether they differ enough.

use crate::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use crate::estimate::imu::estimated::set_fixed;
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::temperature_rate::temperature_rates;
use crate::motion::Hold;
use crate::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, Recording, SensorKind, SensorParameters, Temperatures, Thermal,
    ThermalTerm,
};

/// Least difference between distinct temperatures of holds, K. Smaller ones are noise and rounding of the thermometer.
const LEVEL_K: f64 = 0.5;

/// The temperatures of a recording with temperature terms.
pub(in crate::estimate) fn needed_temperatures(recording: &ImuRecording) -> Result<Temperatures<'_>> {
    Temperatures::of(recording)?.ok_or_else(|| {
        Error::recording(InputError::new(Refusal::TemperatureMissing,
            "the calibration is to follow temperature, and the recording has none",
            "name its column with temperature = \"…\" in [columns], or take [temperature] (or [campaign]) out of the experiment",
        ))
    })
}

/// The temperatures of the sensor, by those of a thermometer that lags it: `T + t_l dT/dt`, °C.
pub(in crate::estimate) fn at_sensor(shown: &Temperatures<'_>, lag_s: f64) -> Vec<f64> {
    if lag_s == 0.0 {
        return shown.values_c.to_vec();
    }
    let rates = temperature_rates(shown.times_s, shown.values_c);
    shown.values_c.iter().zip(rates).map(|(shown, rate)| shown + lag_s * rate).collect()
}

/// The temperatures of a problem with temperature terms.
pub(crate) struct RecordingTemperature<'a> {
    recorded: Option<Recorded<'a>>,
    /// Only the fixed terms.
    pub(crate) start: Thermal,
}

/// Temperatures of the sensor, and what the thermometer shows of their rate, K/s.
struct Recorded<'a> {
    times_s: &'a [f64],
    values_c: Vec<f64>,
    rates: Vec<f64>,
}

impl Recorded<'_> {
    fn temperatures(&self) -> Temperatures<'_> {
        Temperatures { times_s: self.times_s, values_c: &self.values_c }
    }
}

impl<'a> RecordingTemperature<'a> {
    /// The temperatures of a problem with these holds. Without temperature terms, the temperature is always the reference.
    pub(crate) fn of(problem: &ImuProblem<'a>, holds: &[Hold]) -> Result<Self> {
        let model = problem.setup.thermal;
        let mut start = Thermal::none();
        if model.is_none() {
            return Ok(Self { recorded: None, start });
        }
        let shown = needed_temperatures(problem.recording)?;
        let recorded = Recorded {
            times_s: shown.times_s,
            values_c: at_sensor(&shown, problem.setup.thermometer.lag_s),
            rates: temperature_rates(shown.times_s, shown.values_c),
        };
        let temperatures = recorded.temperatures();
        let of_holds: Vec<f64> =
            holds.iter().map(|hold| temperatures.mean(hold.start_s, hold.end_s)).collect();
        let mean = of_holds.iter().sum::<f64>() / of_holds.len().max(1) as f64;
        start.reference_c = model.reference_c.unwrap_or(mean.round());
        start.range_c =
            of_holds.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)]);
        let mut imu = ImuParameters { thermal: start, ..ImuParameters::identity() };
        set_fixed(&mut imu, problem.setup);
        let temperature = Self { recorded: Some(recorded), start: imu.thermal };
        temperature.enough(problem, &of_holds)?;
        Ok(temperature)
    }

    /// Mean temperature between two times.
    pub(crate) fn mean(&self, start_s: f64, end_s: f64) -> f64 {
        let recorded = self.recorded.as_ref();
        recorded.map_or(self.start.reference_c, |recorded| recorded.temperatures().mean(start_s, end_s))
    }

    /// Mean rate that the thermometer shows between these times, K/s; `None` where nothing follows temperature.
    pub(crate) fn rates(&self, spans: impl Iterator<Item = (f64, f64)>) -> Option<Vec<f64>> {
        let recorded = self.recorded.as_ref()?;
        let rates = Temperatures { times_s: recorded.times_s, values_c: &recorded.rates };
        Some(spans.map(|(start_s, end_s)| rates.mean(start_s, end_s)).collect())
    }

    /// Mean temperature of a hold.
    pub(crate) fn of_hold(&self, hold: &Hold) -> f64 {
        self.mean(hold.start_s, hold.end_s)
    }

    /// Lowest and highest temperature of the whole recording.
    pub(crate) fn of_recording(&self) -> Option<[f64; 2]> {
        let values = self.recorded.as_ref()?.values_c.iter();
        values.map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)])
    }

    /// Are the temperatures of the holds different enough for the terms without a prior?
    fn enough(&self, problem: &ImuProblem<'_>, of_holds: &[f64]) -> Result<()> {
        let mut sorted = of_holds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (mut levels, mut last) = (0, f64::NEG_INFINITY);
        for t in &sorted {
            if *t >= last + LEVEL_K {
                (levels, last) = (levels + 1, *t);
            }
        }
        let known =
            |quantity: &ImuQuantity| problem.setup.known_terms().any(|term| term.quantity == *quantity);
        let unknown: Vec<ImuQuantity> =
            problem.setup.thermal.quantities().into_iter().filter(|quantity| !known(quantity)).collect();
        // the terms of one polynomial, which need one temperature more than there are
        let siblings = |quantity: &ImuQuantity| {
            let family = |quantity: &ImuQuantity| match quantity {
                ImuQuantity::Thermal(sensor_kind, ThermalTerm { part, axis, .. }) => {
                    Some((*sensor_kind, *part, *axis))
                }
                _ => None,
            };
            unknown.iter().filter(|other| family(other) == family(quantity)).count()
        };
        let most = unknown.iter().map(siblings).max().unwrap_or(0);
        if levels > most || most == 0 {
            return Ok(());
        }
        let short: Vec<&ImuQuantity> =
            unknown.iter().filter(|quantity| siblings(quantity) >= levels).collect();
        let span = sorted.last().zip(sorted.first()).map_or(0.0, |(high, low)| high - low);
        let reason = match levels {
            0 | 1 => format!("the temperature of the holds changed by {span:.1} K only"),
            _ => format!(
                "the holds have {levels} temperatures that differ by {LEVEL_K} K or more, and polynomials of order {most} need {}",
                most + 1
            ),
        };
        Err(Error::NotIdentifiable(Box::new(NotIdentifiable {
            groups: vec![UndeterminedGroup {
                parameters: short.iter().map(|quantity| quantity.name()).collect(),
                free_combinations: short.len(),
                reason,
                remedy: "record over a wider range of temperatures, with holds all along it; or lower the order in [temperature], or give the terms in [known]"
                    .into(),
            }],
        })))
    }
}

/// The readings of a sensor, converted to the reference temperature.
pub(crate) fn at_reference(
    recording: &Recording,
    sensor_kind: SensorKind,
    sensor: &SensorParameters,
    thermal: &Thermal,
    temperature: &RecordingTemperature<'_>,
) -> Recording {
    let mut adjusted = recording.clone();
    let Some(recorded) = &temperature.recorded else { return adjusted };
    let temperatures = recorded.temperatures();
    let terms = thermal.sensor(sensor_kind);
    for (k, (reading, &time_s)) in adjusted.readings.iter_mut().zip(&recording.times_s).enumerate() {
        let tau_k = thermal.tau_k(temperatures.near(time_s, k));
        let excess = *reading - sensor.bias - terms.bias_change(tau_k);
        *reading = sensor.bias + excess.component_div(&terms.gain_factor(tau_k));
    }
    adjusted
}

//! The temperatures of a recording: checked, averaged and interpolated.

use super::{ImuRecording, interpolated};
use crate::error::{Error, InputError, Refusal, Result};

/// Temperatures at which an inertial sensor works, °C, with room to spare.
pub const WORKING_C: std::ops::RangeInclusive<f64> = -100.0..=250.0;
/// A value outside the working range and in this range is in kelvin.
const KELVIN: std::ops::RangeInclusive<f64> = 250.0..=500.0;

/// Temperature over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperatures<'a> {
    /// Sample times, s.
    pub times_s: &'a [f64],
    /// Temperature at these times, °C.
    pub values_c: &'a [f64],
}

impl<'a> Temperatures<'a> {
    /// The temperatures of a recording; `None` where it has none.
    ///
    /// # Errors
    /// [`Error::Recording`] where no sensor has such a temperature ([`WORKING_C`]), as in kelvin. Also where
    /// there is not one temperature for each sample.
    pub fn of(recording: &'a ImuRecording) -> Result<Option<Self>> {
        let sensor = recording.sensors().next().map(|(_, sensor)| sensor);
        let (Some(values_c), Some(sensor)) = (&recording.temperature_c, sensor) else { return Ok(None) };
        let times_s = sensor.times_s.as_slice();
        if times_s.len() != values_c.len() {
            return Err(Error::recording(InputError::new(
                Refusal::RecordingsUnlike,
                format!("there are {} temperatures for {} samples", values_c.len(), times_s.len()),
                "each sample needs its temperature",
            )));
        }
        if let Some(k) = values_c.iter().position(|value| !WORKING_C.contains(value)) {
            return Err(Error::recording(InputError::new(
                Refusal::ValueOutOfRange,
                format!("the temperature is {} °C at {} s", values_c[k], times_s[k]),
                Self::question(values_c[k]),
            )));
        }
        Ok(Some(Self { times_s, values_c }))
    }

    /// Least and greatest temperature, °C; `None` without any.
    #[must_use]
    pub fn range_c(&self) -> Option<[f64; 2]> {
        let first = *self.values_c.first()?;
        let wider = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
        Some(self.values_c.iter().fold([first; 2], wider))
    }

    /// Does it change between two samples by more than a sensor's can?
    #[must_use]
    pub fn jumps(&self) -> bool {
        /// Of one sample, K, and most of a second, K: a pause may be long.
        const JUMP_K: f64 = 5.0;
        const MOST_K_PER_S: f64 = 1.0;
        let steps = self.times_s.windows(2).zip(self.values_c.windows(2));
        steps.into_iter().any(|(t, of)| (of[1] - of[0]).abs() > JUMP_K.max(MOST_K_PER_S * (t[1] - t[0])))
    }

    /// Smallest difference between two of the temperatures, K; `None` of a constant one.
    #[must_use]
    pub fn step_k(&self) -> Option<f64> {
        /// Smaller ones are rounding.
        const SAME_K: f64 = 1e-6;
        let mut values = self.values_c.to_vec();
        values.dedup();
        values.sort_by(f64::total_cmp);
        let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > SAME_K);
        steps.reduce(f64::min)
    }

    /// The question to the user about a temperature that is implausible for a sensor.
    #[must_use]
    pub fn question(value: f64) -> String {
        let (low, high) = (WORKING_C.start(), WORKING_C.end());
        let asked = if KELVIN.contains(&value) {
            "is the column in kelvin? then subtract 273.15 from it"
        } else {
            "is this another column, or counts?"
        };
        format!("temperatures are in °C, a sensor's from {low} to {high}: {asked}")
    }

    /// The temperature at a time, linear between samples, the nearest one outside; 0 where there is no
    /// sample.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        self.near(time_s, 0)
    }

    /// The same; `sample` is where the time is sought first.
    pub(crate) fn near(&self, time_s: f64, sample: usize) -> f64 {
        interpolated(self.times_s, |k| self.values_c[k], time_s, sample).unwrap_or(0.0)
    }

    /// Mean temperature between two times. Where no sample lies between them, the temperature of the middle.
    #[must_use]
    pub fn mean(&self, start_s: f64, end_s: f64) -> f64 {
        let first = self.times_s.partition_point(|&t| t < start_s);
        let end = self.times_s.partition_point(|&t| t <= end_s);
        match self.values_c.get(first..end).filter(|values| !values.is_empty()) {
            Some(values) => values.iter().sum::<f64>() / values.len() as f64,
            None => self.at(0.5 * (start_s + end_s)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{ReadingUnit, Recording};
    use nalgebra::Vector3;

    fn recording(values: &[f64]) -> ImuRecording {
        let times_s: Vec<f64> = (0..3).map(f64::from).collect();
        let sensor = Recording {
            readings: vec![Vector3::zeros(); 3],
            times_s,
            axes: 3,
            unit: ReadingUnit::MetrePerSecondSquared,
        };
        ImuRecording { sensors: [Some(sensor), None].into(), temperature_c: Some(values.to_vec()) }
    }

    #[test]
    fn no_sensor_warms_by_6_k_from_one_second_to_the_next() {
        let jumps =
            |values: &[f64]| Temperatures::of(&recording(values)).expect("plausible").map(|of| of.jumps());
        assert_eq!(jumps(&[20.0, 20.0, 26.0]), Some(true));
        assert_eq!(jumps(&[20.0, 24.0, 28.0]), Some(false));
    }

    #[test]
    fn it_is_linear_between_samples_and_constant_outside() {
        let recording = recording(&[20.0, 22.0, 30.0]);
        let temperatures = Temperatures::of(&recording).expect("possible").expect("there");
        let found = [-1.0, 0.5, 1.0, 1.25, 9.0].map(|t| temperatures.at(t));
        assert_eq!(found, [20.0, 21.0, 22.0, 24.0, 30.0]);
        assert_eq!(temperatures.mean(0.0, 1.0), 21.0);
        assert_eq!(temperatures.mean(1.2, 1.8), 26.0, "between samples");
    }

    #[test]
    fn a_step_is_the_smallest_difference_that_is_no_rounding() {
        let step = |values: &[f64]| Temperatures { times_s: &[], values_c: values }.step_k();
        assert_eq!(step(&[20.0, 22.0, 22.0, 21.0, 22.0]), Some(1.0));
        assert_eq!(step(&[20.0, 20.0 + 1e-9, 20.5]).map(|step| (2.0 * step).round()), Some(1.0));
        assert_eq!(step(&[20.0, 20.0]), None);
    }

    #[test]
    fn what_is_no_temperature_is_refused() {
        let stated = |values: &[f64]| Temperatures::of(&recording(values)).expect_err("refused").to_string();
        assert!(stated(&[20.0, 2931.0, 20.0]).contains("2931 °C at 1 s"));
        assert!(stated(&[20.0, f64::NAN, 20.0]).contains("from -100 to 250: is this another column"));
        assert!(stated(&[293.15, 293.2, 295.0]).contains("is the column in kelvin? then subtract 273.15"));
        assert!(stated(&[20.0]).contains("1 temperatures for 3 samples"));
    }
}

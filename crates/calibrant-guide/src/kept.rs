//! The samples of the session in memory: those of a fast sensor, or of a long session, as means of several.

use crate::layout::Sample;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuRecording, PerSensor, ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;

/// Samples of a faster sensor are averaged, Hz.
const MOST_HZ: f64 = 110.0;
/// Most samples that are kept, those of a quarter of an hour: beyond them each two are averaged into one.
const MOST_KEPT: usize = 100_000;
/// Samples by which the rate is known.
const FIRST: usize = 20;

/// The samples.
#[derive(Debug, Default)]
pub(crate) struct KeptSamples {
    first: Vec<Sample>,
    /// So many are one.
    every: Option<usize>,
    /// Samples farther apart than this have others missing between them, s.
    longest_s: f64,
    sum: Vec<Sample>,
    kept: Vec<Sample>,
    erased: Vec<(f64, f64)>,
}

impl KeptSamples {
    pub(crate) fn push(&mut self, sample: Sample) {
        let Some(every) = self.every else {
            self.first.push(sample);
            let count = self.first.len();
            let seconds = self.first[count - 1].t_s - self.first[0].t_s;
            // rows of one block have the times of one
            if count >= FIRST && seconds >= 1.0 {
                let rate_hz = (count - 1) as f64 / seconds;
                self.every = Some((rate_hz / MOST_HZ).ceil().max(1.0) as usize);
                self.longest_s = 5.0 / rate_hz;
                std::mem::take(&mut self.first).into_iter().for_each(|sample| self.push(sample));
            }
            return;
        };
        // samples of two sensors may be in rows of their own; a mean across a gap is none
        let gap = self.sum.last().is_some_and(|last| sample.t_s - last.t_s > self.longest_s.max(0.05));
        if gap {
            self.sum.clear();
        }
        self.sum.push(sample);
        if self.sum.len() >= every {
            self.kept.push(mean(&self.sum));
            self.sum.clear();
        }
        if self.kept.len() >= MOST_KEPT {
            self.halve(every);
        }
    }

    /// Two samples become one: the memory and the time of an estimate stay what they are.
    fn halve(&mut self, every: usize) {
        let seconds = |samples: &[Sample]| samples[samples.len() - 1].t_s - samples[0].t_s;
        let longest_s = 5.0 * seconds(&self.kept) / self.kept.len() as f64;
        let pairs = self.kept.chunks(2);
        // across a gap the first stays
        let one = |pair: &[Sample]| if seconds(pair) > longest_s { pair[0] } else { mean(pair) };
        self.kept = pairs.map(one).collect();
        self.every = Some(2 * every);
    }

    /// Leaves the accelerometer's readings between two times out.
    pub(crate) fn erase(&mut self, span: (f64, f64)) {
        self.erased.push(span);
    }

    /// The recording, of sensors with these units.
    pub(crate) fn recording(&self, units: [ReadingUnit; 2]) -> Result<ImuRecording> {
        let samples =
            || self.kept.iter().chain(if self.every.is_none() { self.first.as_slice() } else { &[] });
        let mut sensors: PerSensor<Option<Recording>> = PerSensor::default();
        let mut temperature_c = Vec::new();
        for kind in SensorKind::ALL {
            let number = kind as usize;
            let erased = |t_s: f64| {
                number == 0 && self.erased.iter().any(|(start, end)| (*start..=*end).contains(&t_s))
            };
            let of = samples().filter(|sample| sample.readings[number].is_some() && !erased(sample.t_s));
            let times_s: Vec<f64> = of.clone().map(|sample| sample.t_s).collect();
            if times_s.len() < 2 {
                continue;
            }
            let readings =
                of.clone().filter_map(|sample| sample.readings[number].map(Vector3::from)).collect();
            if number == 0 {
                // before the first one it is that
                let mut last = of.clone().find_map(|sample| sample.temperature_c);
                temperature_c = of
                    .map(|sample| *last.insert(sample.temperature_c.or(last).unwrap_or(f64::NAN)))
                    .collect();
            }
            sensors[kind] = Some(Recording::new(times_s, readings, 3, units[number])?);
        }
        let known = !temperature_c.is_empty() && temperature_c.iter().all(|of| of.is_finite());
        Ok(ImuRecording { sensors, temperature_c: known.then_some(temperature_c) })
    }
}

fn mean(samples: &[Sample]) -> Sample {
    let count = samples.len() as f64;
    let readings = [0, 1].map(|sensor| {
        let these: Vec<[f64; 3]> = samples.iter().filter_map(|sample| sample.readings[sensor]).collect();
        let of = |axis: usize| these.iter().map(|reading| reading[axis]).sum::<f64>() / these.len() as f64;
        (!these.is_empty()).then(|| [of(0), of(1), of(2)])
    });
    Sample {
        t_s: samples.iter().map(|sample| sample.t_s).sum::<f64>() / count,
        readings,
        temperature_c: samples.iter().rev().find_map(|sample| sample.temperature_c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_session_two_samples_become_one() {
        let mut kept = KeptSamples::default();
        let sample = |t_s: f64| Sample { t_s, readings: [Some([t_s, 1.0, 9.8]), None], temperature_c: None };
        (0..1000).for_each(|k| kept.push(sample(k as f64 * 0.01)));
        (0..1000).for_each(|k| kept.push(sample(20.005 + k as f64 * 0.01)));
        kept.halve(1);
        (0..1000).for_each(|k| kept.push(sample(40.0 + k as f64 * 0.01)));
        assert_eq!(kept.kept.len(), 1500);
        assert!(
            kept.kept
                .iter()
                .all(|of| of.readings[0].is_some_and(|reading| (reading[0] - of.t_s).abs() < 1e-9))
        );
    }

    #[test]
    fn a_fast_sensor_is_averaged_and_a_slow_one_is_not() {
        for (rate_hz, expected) in [(100.0, 1000), (2000.0, 1053)] {
            let mut kept = KeptSamples::default();
            for k in 0..(10.0 * rate_hz) as usize {
                let t_s = k as f64 / rate_hz;
                kept.push(Sample { t_s, readings: [Some([t_s, 1.0, 9.8]), None], temperature_c: Some(20.0) });
            }
            kept.erase((2.0, 3.0));
            let units = [ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond];
            let recording = kept.recording(units).expect("increasing");
            let accelerometer = recording[SensorKind::Accelerometer].as_ref().expect("there");
            assert!(
                (accelerometer.len() as f64 / (0.9 * f64::from(expected)) - 1.0).abs() < 0.01,
                "{}",
                accelerometer.len()
            );
            for (t_s, reading) in accelerometer.times_s().iter().zip(accelerometer.readings()) {
                assert!((t_s - reading.x).abs() < 1e-9, "a mean is at its time");
            }
        }
    }
}

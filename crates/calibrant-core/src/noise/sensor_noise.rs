//! The noise of a sensor of three axes.

use super::outliers::Outliers;
use super::series::Series;
use super::{AllanDeviation, Moments, NoiseFit, Segment, outliers};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::noise::{
    NoiseBeyondWhite, NoiseDrifts, NoiseFiltered, NoiseInParts, NoiseOfSpikes, NoiseOfVibration,
    NoiseOutliers, NoiseUnexplained, NoiseVibration, ResolutionCoarse, SampleTimesVary, SamplesMissing,
    ShortTimesUnexplained,
};
use crate::error::{Error, InputError, Refusal, Result};
use crate::interruption::Interruption;
use crate::sensor::{Axis, ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// A sample's standard deviation that exceeds the white noise by this factor is worth a word: not all of it averages out.
const BEYOND_WHITE: f64 = 1.15;
/// Probability of the misfit below which the processes do not explain the Allan deviation. Its χ² has a heavier tail than the distribution.
const HOPELESS: f64 = 1e-9;
/// Jitter of the sample times that is worth a word.
const JITTER: f64 = 0.2;

/// The noise of one sensor at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorNoise {
    /// Which sensor.
    pub sensor_kind: SensorKind,
    /// Unit of the readings, and of all coefficients but for seconds and hertz.
    pub unit: ReadingUnit,
    /// The gain that turned readings in counts into this unit, counts per unit; `None` where the unit is that of the readings.
    pub gain: Option<Vector3<f64>>,
    /// The samples that were examined.
    pub segment: Segment,
    /// A result for each axis.
    pub axes: Vec<AxisNoise>,
    /// Why the white noise is not that of a sensor at rest: too many outliers, no process explains it, or the caller states that the sensor moves.
    pub caveat: Option<Diagnostic>,
    /// What the user should know.
    pub warnings: Vec<Diagnostic>,
}

/// The noise of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisNoise {
    /// Which axis.
    pub axis: Axis,
    /// Its Allan deviation.
    pub allan: AllanDeviation,
    /// The coefficients.
    pub fit: NoiseFit,
    /// Standard deviation of the samples about their mean, in the unit of the readings.
    pub sample_sd: f64,
    /// Outliers. They are removed, unless there are too many. `None` without any.
    pub outliers: Option<Outliers>,
}

impl SensorNoise {
    /// The noise of a recording within a segment at rest.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) if the segment is too short, or an axis never changes.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::noise::{PowerLaw, Segment, SensorNoise};
    /// use calibrant_core::sensor::{ReadingUnit, Recording, SensorKind};
    /// use calibrant_core::simulate::{Purpose, simulate_noise, stream};
    /// use nalgebra::Vector3;
    ///
    /// let mut rng = stream(1, Purpose::Sensor, 0);
    /// let axis: Vec<_> = (0..3).map(|_| simulate_noise(PowerLaw::White, 1e-3, 0.01, 6000, &mut rng)).collect();
    /// let times_s = (0..6000).map(|k| f64::from(k) * 0.01).collect();
    /// let readings = (0..6000).map(|k| Vector3::new(axis[0][k], axis[1][k], 9.8 + axis[2][k])).collect();
    /// let recording = Recording::new(times_s, readings, 3, ReadingUnit::MetrePerSecondSquared)?;
    /// let noise = SensorNoise::of(SensorKind::Accelerometer, &recording, Segment::between(&recording, 0.0, 60.0)?)?;
    /// let sigma = noise.white_noise_per_sample().expect("determined");
    /// assert!((sigma - Vector3::repeat(0.01)).amax() < 5e-4);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn of(sensor_kind: SensorKind, recording: &Recording, segment: Segment) -> Result<Self> {
        let moments = Moments::of(segment.samples());
        Self::with_moments(sensor_kind, recording, segment, &moments)
    }

    /// The same with [`Moments`] at hand: those of the number of samples, which several sensors may have in common.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    ///
    /// # Panics
    /// If `moments` are those of another number of samples.
    pub fn with_moments(
        sensor_kind: SensorKind,
        recording: &Recording,
        segment: Segment,
        moments: &Moments,
    ) -> Result<Self> {
        Self::until(&Interruption::default(), sensor_kind, recording, segment, moments)
    }

    /// The same, unless it is interrupted.
    ///
    /// # Errors
    /// As [`of`](Self::of), and [`Refusal::Interrupted`].
    ///
    /// # Panics
    /// As [`with_moments`](Self::with_moments).
    pub fn until(
        interruption: &Interruption,
        sensor_kind: SensorKind,
        recording: &Recording,
        segment: Segment,
        moments: &Moments,
    ) -> Result<Self> {
        let readings = &recording.readings[segment.first..segment.end];
        let axis = |&axis: &Axis| {
            interruption.check()?;
            let recorded: Vec<f64> = readings.iter().map(|reading| reading[axis.index()]).collect();
            let recorded = Series::of(recorded);
            let fit = |series: &Series| NoiseFit::of_series(series, segment.interval_s, moments);
            let (series, outliers) = match outliers::find(&recorded.values, &recorded.steps) {
                None => (recorded, None),
                Some(found) => {
                    let white = |fit: NoiseFit| fit.model.white_noise_per_sample(segment.rate_hz());
                    let outliers = Outliers {
                        left_out: found.without.is_some(),
                        samples: found.samples,
                        time_s: recording.times_s[segment.first + found.farthest],
                        largest: recorded.values[found.farthest],
                        deviations: found.deviations,
                        white_with_them: fit(&recorded).ok().and_then(white),
                    };
                    (found.without.map_or(recorded, Series::of), Some(outliers))
                }
            };
            interruption.check()?;
            let (allan, fit) = rayon::join(
                || {
                    let Series { values, phase, .. } = &series;
                    AllanDeviation::with_confidence(values, phase, segment.interval_s, moments.confidence())
                },
                || fit(&series).map_err(|error| about(error, axis)),
            );
            let noise = AxisNoise { axis, allan: allan?, fit: fit?, sample_sd: series.sd(), outliers };
            let caveat = noise.caveat(sensor_kind, series.steps.reach_far());
            Ok((noise, caveat))
        };
        let axes: Vec<Result<_>> = recording.active_axes().par_iter().map(axis).collect();
        // the error names the first axis without noise, in any order of the threads
        let axes: Vec<(AxisNoise, Option<Diagnostic>)> = axes.into_iter().collect::<Result<_>>()?;
        let caveat = axes.iter().find_map(|(_, caveat)| caveat.clone());
        let axes: Vec<AxisNoise> = axes.into_iter().map(|(axis, _)| axis).collect();
        let unit = recording.unit;
        let mut noise = Self { sensor_kind, unit, gain: None, segment, axes, caveat, warnings: Vec::new() };
        noise.warnings = noise.remarks(readings);
        Ok(noise)
    }

    /// Standard deviation of the white noise of one sample, `σ_ν = N √f_s`, per axis, in the unit of the readings: what a calibration needs where its
    /// datasheet gives no noise. `None` where N is not determined on an axis. Axes that were not recorded are zero.
    #[must_use]
    pub fn white_noise_per_sample(&self) -> Option<Vector3<f64>> {
        let mut sigma = Vector3::zeros();
        for axis in &self.axes {
            sigma[axis.axis.index()] = axis.fit.model.white_noise_per_sample(self.segment.rate_hz())?;
        }
        Some(sigma)
    }

    /// The same noise in the stimulus' unit, for a sensor of these gains in counts per stimulus unit. `recording` is the one that it was found in.
    ///
    /// Readings that are not in counts stay as they are.
    ///
    /// # Errors
    /// [`Error::Experiment`](crate::Error::Experiment) for a gain that is not above zero.
    pub fn with_gain(mut self, recording: &Recording, gain: &Vector3<f64>) -> Result<Self> {
        if self.unit != ReadingUnit::Counts {
            return Ok(self);
        }
        if !gain.iter().all(|gain| gain.is_finite() && *gain > 0.0) {
            return Err(Error::experiment(InputError::new(
                Refusal::ValueInvalid,
                format!(
                    "the gains of the {} are {}, {} and {} counts/({})",
                    self.sensor_kind,
                    gain.x,
                    gain.y,
                    gain.z,
                    self.sensor_kind.stimulus_unit().symbol()
                ),
                "a gain is above zero",
            )));
        }
        let readings = &recording.readings[self.segment.first..self.segment.end];
        let physical: Vec<_> = readings.iter().map(|reading| reading.component_div(gain)).collect();
        self.axes.iter_mut().for_each(|axis| axis.scale(1.0 / gain[axis.axis.index()]));
        self.unit = self.sensor_kind.stimulus_unit();
        self.gain = Some(*gain);
        self.warnings = self.remarks(&physical);
        Ok(self)
    }

    /// The white noise of one sample as the readings have it: in counts also where the noise itself is stated with a gain. `None` where it is not determined.
    #[must_use]
    pub fn white_noise_of_readings(&self) -> Option<Vector3<f64>> {
        let sigma = self.white_noise_per_sample()?;
        Some(self.gain.map_or(sigma, |gain| sigma.component_mul(&gain)))
    }

    /// Its caveat and its warnings, each once.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        let caveat = self.caveat.iter().filter(|caveat| !self.warnings.contains(caveat));
        caveat.chain(&self.warnings)
    }

    /// Do the processes explain the Allan deviation of every axis?
    #[must_use]
    pub fn explains(&self) -> bool {
        self.axes.iter().all(|axis| axis.fit.explains())
    }

    /// The warnings about outliers, by axis. [`warnings`](Self::warnings) includes them.
    #[must_use]
    pub fn of_outliers(&self) -> Vec<Diagnostic> {
        self.axes.iter().filter_map(|axis| Some(self.of_outliers_on(axis, axis.outliers.as_ref()?))).collect()
    }

    fn of_outliers_on(&self, axis: &AxisNoise, found: &Outliers) -> Diagnostic {
        let (sensor_kind, unit, samples) = (self.sensor_kind, self.unit, self.segment.samples());
        let (outliers, reading, time_s) = (found.samples.len(), found.largest, found.time_s);
        let (axis, deviations, fit) = (axis.axis, found.deviations, &axis.fit);
        let white = fit.model.white_noise_per_sample(self.segment.rate_hz());
        let white_noise_ratio = white.zip(found.white_with_them).map(|(without, with)| with / without);
        Diagnostic::from(NoiseOutliers {
            sensor_kind,
            axis,
            unit,
            outliers,
            samples,
            reading,
            time_s,
            deviations,
            left_out: found.left_out,
            white_noise_ratio: white_noise_ratio.filter(|_| found.left_out),
        })
    }

    fn remarks(&self, readings: &[Vector3<f64>]) -> Vec<Diagnostic> {
        let mut remarks = self.of_outliers();
        if self.segment.missing > 0.0 {
            remarks.push(SamplesMissing { missing_share: self.segment.missing }.into());
        } else if self.segment.jitter > JITTER {
            remarks.push(SampleTimesVary { jitter: self.segment.jitter }.into());
        }
        if self.segment.parts > 1 {
            let (parts, longest_s) = (self.segment.parts, self.segment.duration_s());
            remarks.push(NoiseInParts { parts, longest_s }.into());
        }
        // of spikes the noise is what it is
        let explicable = |axis: &&AxisNoise| axis.outliers.as_ref().is_none_or(|outliers| outliers.left_out);
        self.axes.iter().filter(explicable).for_each(|axis| self.remarks_on(axis, readings, &mut remarks));
        remarks
    }

    fn remarks_on(&self, noise: &AxisNoise, readings: &[Vector3<f64>], remarks: &mut Vec<Diagnostic>) {
        let (sensor_kind, unit, interval_s) = (self.sensor_kind, self.unit, self.segment.interval_s);
        let (axis, fit) = (noise.axis, &noise.fit);
        if fit.drift.is_significant() {
            let deviations = fit.drift.per_s.abs() / fit.drift.most_sd;
            let drift_per_s = fit.drift.per_s;
            remarks.push(NoiseDrifts { sensor_kind, axis, unit, drift_per_s, deviations }.into());
        }
        if !fit.explains() {
            let (chi2, degrees_of_freedom) = (fit.chi2, fit.degrees_of_freedom);
            remarks.push(NoiseUnexplained { sensor_kind, axis, chi2, degrees_of_freedom }.into());
        } else if fit.filtered {
            let correlated_s = fit.shortest_tau_s.max(2.0 * interval_s);
            remarks.push(NoiseFiltered { sensor_kind, axis, correlated_s }.into());
        } else if fit.shortest_tau_s > 1.5 * interval_s {
            let shortest_tau_s = fit.shortest_tau_s;
            remarks.push(ShortTimesUnexplained { sensor_kind, axis, shortest_tau_s }.into());
        }
        if let Some(line) = fit.vibration.as_ref().filter(|line| line.left_out) {
            remarks.push(
                NoiseVibration {
                    sensor_kind,
                    axis,
                    frequency_hz: line.frequency_hz,
                    share: line.share,
                    of_white: line.of_white,
                }
                .into(),
            );
        }
        let white = fit.model.white_noise_per_sample(self.segment.rate_hz());
        if let Some(white_noise) = white
            && noise.sample_sd > BEYOND_WHITE * white_noise
        {
            let sample_sd = noise.sample_sd;
            remarks.push(NoiseBeyondWhite { sensor_kind, axis, unit, sample_sd, white_noise }.into());
        }
        let index = axis.index();
        let step = readings
            .windows(2)
            .map(|pair| (pair[1][index] - pair[0][index]).abs())
            .filter(|step| *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        if step.is_finite() && step > noise.sample_sd {
            remarks.push(ResolutionCoarse { sensor_kind, axis, unit, step }.into());
        }
    }
}

impl AxisNoise {
    /// Why its white noise is not that of a sensor at rest, where it is not. `reach_far`: do a few samples far off make most of it?
    fn caveat(&self, sensor_kind: SensorKind, reach_far: bool) -> Option<Diagnostic> {
        let (axis, fit) = (self.axis, &self.fit);
        let are_many = self.outliers.as_ref().is_some_and(|outliers| !outliers.left_out);
        if are_many || reach_far {
            return Some(NoiseOfSpikes { sensor_kind, axis, are_many }.into());
        }
        let line = fit.vibration.as_ref().filter(|line| !line.left_out);
        let frequency_hz = line.map(|line| line.frequency_hz);
        let unexplained = frequency_hz.is_some() || fit.p_value.is_some_and(|p| p < HOPELESS);
        unexplained.then(|| NoiseOfVibration { sensor_kind, axis, frequency_hz }.into())
    }
}

/// Names the axis in an error.
fn about(error: crate::Error, axis: Axis) -> crate::Error {
    match error {
        crate::Error::Recording(mut input_error) => {
            input_error.message = format!("axis {axis}: {}", input_error.message);
            crate::Error::Recording(input_error)
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::{Coefficient, PowerLaw};
    use crate::simulate::{Purpose, simulate_noise, stream};

    /// Scaling the result is scaling the readings.
    #[test]
    fn a_gain_gives_what_the_scaled_readings_give() {
        let mut rng = stream(5, Purpose::Sensor, 0);
        let axis: Vec<Vec<f64>> = (0..3)
            .map(|_| {
                let white = simulate_noise(PowerLaw::White, 2.0, 0.01, 4000, &mut rng);
                let walk = simulate_noise(PowerLaw::RandomWalk, 1.0, 0.01, 4000, &mut rng);
                white.iter().zip(walk).map(|(w, k)| w + k).collect()
            })
            .collect();
        let counts = Recording {
            times_s: (0..4000).map(|k| f64::from(k) * 0.01).collect(),
            readings: (0..4000).map(|k| Vector3::new(axis[0][k], axis[1][k], axis[2][k])).collect(),
            axes: 3,
            unit: ReadingUnit::Counts,
        };
        let gain = Vector3::new(4778.0, 4764.0, 4773.0);
        let mut physical = counts.clone();
        physical.unit = ReadingUnit::RadianPerSecond;
        physical.readings.iter_mut().for_each(|reading| *reading = reading.component_div(&gain));
        let of = |recording: &Recording| {
            let segment = Segment::between(recording, 0.0, 40.0).expect("long enough");
            SensorNoise::of(SensorKind::Gyroscope, recording, segment).expect("noisy")
        };
        let found = of(&counts).with_gain(&counts, &gain).expect("positive gains");
        let expected = of(&physical);
        assert_eq!(found.unit, expected.unit);
        let near = |one: f64, other: f64| assert!((one - other).abs() <= 1e-6 * other.abs(), "{one} {other}");
        assert_eq!(found.warnings.len(), expected.warnings.len());
        for (one, other) in found.warnings.iter().zip(&expected.warnings) {
            assert_eq!((one.code(), one.subject()), (other.code(), other.subject()));
            let numbers = one.numbers().into_iter().zip(other.numbers());
            numbers.for_each(|((_, one), (_, other))| near(one, other));
        }
        for (found, expected) in found.axes.iter().zip(&expected.axes) {
            near(found.sample_sd, expected.sample_sd);
            near(found.fit.drift.per_s, expected.fit.drift.per_s);
            near(found.fit.drift.sd, expected.fit.drift.sd);
            for (one, other) in found.allan.points.iter().zip(&expected.allan.points) {
                near(one.deviation, other.deviation);
                near(one.low, other.low);
                near(one.high, other.high);
                near(found.fit.model.deviation(one.tau_s), expected.fit.model.deviation(one.tau_s));
            }
            for process in PowerLaw::ALL {
                let pair = [found, expected].map(|axis| axis.fit.model.coefficient(process).clone());
                match pair {
                    [Coefficient::Determined(one), Coefficient::Determined(other)] => {
                        near(one.value, other.value);
                        near(one.sd, other.sd);
                        near(one.high, other.high);
                    }
                    [one, other] => match (one.limit(), other.limit()) {
                        (Some(one), Some(other)) => near(one, other),
                        (one, other) => assert_eq!(one, other),
                    },
                }
            }
        }
        let back = found.white_noise_of_readings().expect("white noise is there");
        let raw = of(&counts).white_noise_per_sample().expect("white noise is there");
        assert!((back - raw).amax() < 1e-9 * raw.amax());
        let error = of(&counts).with_gain(&counts, &Vector3::zeros()).expect_err("no gain").to_string();
        assert!(error.contains("a gain is above zero"), "{error}");
    }
}

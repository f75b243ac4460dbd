//! The noise of a sensor of three axes.

use super::heavy_tails::Tails;
use super::outliers::{self, Outliers};
use super::words::{short_time, three_digits, two_digits};
use super::{AllanDeviation, Moments, NoiseFit, Segment};
use crate::error::{Error, InputError, Result};
use crate::sensor::{Axis, ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// A sample's standard deviation that exceeds the white noise by this factor is worth a word: not all of it averages out.
const BEYOND_WHITE: f64 = 1.15;
/// Below this probability of its misfit, Allan deviations of noise, whose χ² has a heavier tail than that of the distribution, are out of the question.
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
    /// Why the white noise is not that of a sensor at rest, where it is not: there are too many outliers, no process explains it, or whoever knows better says that the sensor moves.
    pub caveat: Option<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
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
    /// Samples that were left out of all this, or are too many to be; `None` without any.
    pub outliers: Option<Outliers>,
}

impl SensorNoise {
    /// The noise of a recording within a stretch in which the sensor is at rest.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) where the stretch is too short or an axis never changes.
    ///
    /// # Examples
    /// ```
    /// use calibrant::noise::{PowerLaw, Segment, SensorNoise};
    /// use calibrant::sensor::{ReadingUnit, Recording, SensorKind};
    /// use calibrant::simulate::{Purpose, simulate_noise, stream};
    /// use nalgebra::Vector3;
    ///
    /// let mut rng = stream(1, Purpose::Sensor, 0);
    /// let axis: Vec<_> = (0..3).map(|_| simulate_noise(PowerLaw::White, 1e-3, 0.01, 6000, &mut rng)).collect();
    /// let recording = Recording {
    ///     times_s: (0..6000).map(|k| f64::from(k) * 0.01).collect(),
    ///     readings: (0..6000).map(|k| Vector3::new(axis[0][k], axis[1][k], 9.8 + axis[2][k])).collect(),
    ///     axes: 3,
    ///     unit: ReadingUnit::MetrePerSecondSquared,
    /// };
    /// let noise = SensorNoise::of(SensorKind::Accelerometer, &recording, Segment::between(&recording, 0.0, 60.0)?)?;
    /// let sigma = noise.white_noise_per_sample().expect("determined");
    /// assert!((sigma - Vector3::repeat(0.01)).amax() < 5e-4);
    /// # Ok::<(), calibrant::Error>(())
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
        let readings = &recording.readings[segment.first..segment.end];
        let axis = |&axis: &Axis| {
            let recorded: Vec<f64> = readings.iter().map(|reading| reading[axis.index()]).collect();
            let fit = |values: &[f64]| NoiseFit::of(values, segment.interval_s, moments);
            let (values, outliers) = match outliers::find(&recorded) {
                None => (recorded, None),
                Some(found) => {
                    let white = |fit: NoiseFit| fit.model.white_noise_per_sample(segment.rate_hz());
                    let outliers = Outliers {
                        left_out: found.without.is_some(),
                        samples: found.samples,
                        time_s: recording.times_s[segment.first + found.farthest],
                        largest: recorded[found.farthest],
                        deviations: found.deviations,
                        white_with_them: fit(&recorded).ok().and_then(white),
                    };
                    (found.without.unwrap_or(recorded), Some(outliers))
                }
            };
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let squares: f64 = values.iter().map(|y| (y - mean).powi(2)).sum();
            let (allan, fit) = rayon::join(
                || AllanDeviation::with_confidence(&values, segment.interval_s, moments.confidence()),
                || fit(&values).map_err(|error| about(error, axis)),
            );
            let noise = AxisNoise {
                axis,
                allan: allan?,
                fit: fit?,
                sample_sd: (squares / (n - 1.0)).sqrt(),
                outliers,
            };
            let caveat = noise.caveat(&values);
            Ok((noise, caveat))
        };
        let axes: Vec<Result<_>> = recording.active_axes().par_iter().map(axis).collect();
        // the first axis of which there is no noise is named, whichever is tried first
        let axes: Vec<(AxisNoise, Option<String>)> = axes.into_iter().collect::<Result<_>>()?;
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
        self.axes.iter_mut().for_each(|axis| *axis = axis.scaled(1.0 / gain[axis.axis.index()]));
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

    /// Do the processes explain the Allan deviation of every axis?
    #[must_use]
    pub fn explains(&self) -> bool {
        self.axes.iter().all(|axis| axis.fit.explains())
    }

    /// A warning for each axis with outliers; they are among the [`warnings`](Self::warnings), too.
    #[must_use]
    pub fn of_outliers(&self) -> Vec<String> {
        self.axes.iter().filter_map(|axis| Some(self.of_outliers_on(axis, axis.outliers.as_ref()?))).collect()
    }

    fn of_outliers_on(&self, axis: &AxisNoise, outliers: &Outliers) -> String {
        let (unit, count) = (self.unit.symbol(), outliers.samples.len());
        let white = axis.fit.model.white_noise_per_sample(self.segment.rate_hz());
        let farthest = format!(
            "the farthest {} {unit} at {:.3} s, {:.0} times the usual difference of two samples off those beside it",
            three_digits(outliers.largest),
            outliers.time_s,
            outliers.deviations
        );
        let what =
            format!("{} {}: {count} of {} samples", self.sensor_kind, axis.axis, self.segment.samples());
        if !outliers.left_out {
            return format!(
                "{what} are sparks ({farthest}): single samples far off, too many to be left out, which one in fifty would be; what is stated is their noise, not that of the \
                 others. Look for their cause: a loose contact, bits lost on the way?"
            );
        }
        let with_them = match white.zip(outliers.white_with_them) {
            Some((without, with)) => format!(
                "with {} N would be {:.2} times as large",
                if count == 1 { "it" } else { "them" },
                with / without
            ),
            None => "the noise is that of the others".to_owned(),
        };
        format!(
            "{what} {} ({farthest}): a spark, a lost bit or a knock is no noise that averages out, and was left out; {with_them}",
            if count == 1 { "is an outlier" } else { "are outliers" }
        )
    }

    fn remarks(&self, readings: &[Vector3<f64>]) -> Vec<String> {
        let unit = self.unit.symbol();
        let mut remarks = self.of_outliers();
        if self.segment.missing > 0.0 {
            remarks.push(format!(
                "{:.1} % of the samples are missing; the others are taken as if they followed one another: N is that of what was recorded, {:.1} % above the sensor's",
                100.0 * self.segment.missing,
                100.0 * ((1.0 - self.segment.missing).sqrt().recip() - 1.0)
            ));
        } else if self.segment.jitter > JITTER {
            remarks.push(format!(
                "the sample times vary by up to {:.0} % of the interval: short cluster times are less certain than stated",
                100.0 * self.segment.jitter
            ));
        }
        if self.segment.parts > 1 {
            remarks.push(format!(
                "gaps cut the hold into {} parts; the longest, {}, was examined",
                self.segment.parts,
                short_time(self.segment.duration_s())
            ));
        }
        // of spikes the noise is what it is
        let explicable = |axis: &&AxisNoise| axis.outliers.as_ref().is_none_or(|outliers| outliers.left_out);
        for axis in self.axes.iter().filter(explicable) {
            let (name, fit) = (axis.axis, &axis.fit);
            if fit.drift.is_significant() {
                remarks.push(format!(
                    "{} {name} drifts by {} {unit} per hour ({:.1} standard deviations of the most that its noise explains): warming up? The drift was \
                     subtracted; it is no random walk",
                    self.sensor_kind,
                    three_digits(3600.0 * fit.drift.per_s),
                    fit.drift.per_s.abs() / fit.drift.most_sd
                ));
            }
            if !fit.explains() {
                remarks.push(format!(
                    "{} {name}: no sum of the processes explains the Allan deviation (χ² {} with {} degrees of freedom): vibration, or a sensor that was \
                     touched? Do not trust the intervals",
                    self.sensor_kind,
                    three_digits(fit.chi2),
                    fit.degrees_of_freedom
                ));
            } else if fit.filtered {
                remarks.push(format!(
                    "{} {name}: samples less than {} apart are correlated (filtered in the sensor?); what is stated is the noise before the filter, which means of many \
                     samples have",
                    self.sensor_kind,
                    short_time(fit.shortest_tau_s.max(2.0 * self.segment.interval_s))
                ));
            } else if fit.shortest_tau_s > 1.5 * self.segment.interval_s {
                remarks.push(format!(
                    "{} {name}: no sum of the processes explains cluster times below {}: they were not fitted",
                    self.sensor_kind,
                    short_time(fit.shortest_tau_s)
                ));
            }
            if let Some(line) = fit.vibration.as_ref().filter(|line| line.left_out) {
                remarks.push(format!(
                    "{} {name}: a line at {} Hz has {} % of the samples' variance: a vibration, or the hum of the mains? What is stated is the noise beside it; with it N would be \
                     {:.1} % larger",
                    self.sensor_kind,
                    three_digits(line.frequency_hz),
                    two_digits(100.0 * line.share),
                    50.0 * line.of_white.max(0.0)
                ));
            }
            let white = fit.model.white_noise_per_sample(self.segment.rate_hz());
            if let Some(white) = white
                && axis.sample_sd > BEYOND_WHITE * white
            {
                remarks.push(format!(
                    "{} {name}: the samples' standard deviation, {} {unit}, exceeds the white noise, {} {unit}: part of it does not average out like \
                     independent samples",
                    self.sensor_kind,
                    three_digits(axis.sample_sd),
                    three_digits(white)
                ));
            }
            let index = name.index();
            let step = readings
                .windows(2)
                .map(|pair| (pair[1][index] - pair[0][index]).abs())
                .filter(|step| *step > 0.0)
                .fold(f64::INFINITY, f64::min);
            if step.is_finite() && step > axis.sample_sd {
                remarks.push(format!(
                    "{} {name}: its resolution, {} {unit}, is coarser than its noise: what is stated is rounding as much as noise",
                    self.sensor_kind,
                    three_digits(step)
                ));
            }
        }
        remarks
    }
}

impl AxisNoise {
    /// Why its white noise is not that of a sensor at rest, where it is not.
    fn caveat(&self, values: &[f64]) -> Option<String> {
        let spikes = self.outliers.as_ref().is_some_and(|outliers| !outliers.left_out);
        if spikes {
            return Some("there are too many sparks".into());
        }
        if Tails::of(values).reach_far() {
            return Some(format!(
                "a few samples far off the others make most of that of axis {}: sparks?",
                self.axis
            ));
        }
        if let Some(line) = self.fit.vibration.as_ref().filter(|line| !line.left_out) {
            let hertz = three_digits(line.frequency_hz);
            return Some(format!(
                "axis {} has a line at {hertz} Hz: a vibration, or the hum of the mains?",
                self.axis
            ));
        }
        let unexplained = self.fit.p_value.is_some_and(|p| p < HOPELESS);
        unexplained.then(|| {
            format!(
                "no sum of the processes explains the Allan deviation of axis {}: a vibration?",
                self.axis
            )
        })
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
        assert_eq!((found.unit, &found.warnings), (expected.unit, &expected.warnings));
        let near = |one: f64, other: f64| assert!((one - other).abs() <= 1e-6 * other.abs(), "{one} {other}");
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

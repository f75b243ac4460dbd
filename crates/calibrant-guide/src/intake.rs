//! What arrives: bytes become lines, lines rows, rows samples.

use crate::arrival::Arrival;
use crate::fields::Fields;
use crate::force::KnownForce;
use crate::input::Input;
use crate::layout::Sample;
use crate::lines::Lines;
use crate::run::Run;
use crate::shown::Kind;
use crate::stream::Taken;
use calibrant_core::error::Result;
use calibrant_core::sensor::ReadingUnit;
use std::time::Instant;

impl Run<'_> {
    /// Takes what arrived. Has the input ended?
    pub(crate) fn arrival(&mut self, arrival: Arrival) -> Result<bool> {
        match arrival {
            Arrival::Bytes { bytes, at_s } => {
                for line in self.lines.push(&bytes) {
                    self.line(&line, at_s)?;
                }
                if !bytes.is_empty() {
                    self.came = Instant::now();
                }
            }
            Arrival::Lost(why) => {
                self.say(
                    Kind::Error,
                    format!("The board is gone: {why}. The recording is safe; plug it in again."),
                )?;
                self.lost = Some(why);
                // half a line and the rest of another are none
                self.lines = Lines::default();
                self.may_be_half = matches!(self.options.input, Input::Serial { .. });
            }
            Arrival::Back => {
                self.lost = None;
                self.say(Kind::Good, "The board is there again.".to_owned())?;
            }
            Arrival::End => return Ok(true),
        }
        Ok(false)
    }

    pub(crate) fn line(&mut self, line: &str, at_s: f64) -> Result<()> {
        if std::mem::take(&mut self.may_be_half)
            && !line.starts_with('{')
            && !matches!(Fields::of(line), Fields::Names(_))
        {
            return Ok(());
        }
        let taken = self.stream.take(line, at_s);
        self.taken(taken)
    }

    /// What came of lines.
    pub(crate) fn taken(&mut self, taken: Vec<Taken>) -> Result<()> {
        for taken in taken {
            match taken {
                Taken::Header(header) => {
                    self.log.row(&header)?;
                    self.known();
                }
                Taken::Row(row, sample) => {
                    self.log.row(&row)?;
                    self.live.lines += 1;
                    self.problem = None;
                    self.unfit.row();
                    self.sample(&sample)?;
                }
                Taken::Dropped(why) => self.dropped(why)?,
                Taken::Restarted => {
                    for decision in self.gate.interrupt() {
                        self.decide(decision)?;
                    }
                    self.say(Kind::Warning, "The board began anew; what was recorded stays.".to_owned())?;
                }
                Taken::Problem(problem) => {
                    // it changes with the values: once is enough
                    if self.problem.is_none() {
                        self.say(Kind::Error, problem.clone())?;
                    }
                    self.problem = Some(problem);
                }
            }
        }
        Ok(())
    }

    /// The columns are known, and with them the units.
    pub(crate) fn known(&mut self) {
        for (unit, known) in self.units.iter_mut().zip(self.stream.units()) {
            *unit = known.unwrap_or(*unit);
        }
        self.force = KnownForce::new(&self.options.experiment.sensor, self.units[0]);
        if self.units[0] == ReadingUnit::Counts {
            // a range is in m/s²
            self.gate.limits.range[..3].fill(None);
        }
        let gain = self.options.experiment.imu.as_ref().and_then(|imu| imu.gyroscope.gain);
        self.gate.limits.gyroscope_floor = gain.map_or(2.0, |gain| 0.03 * gain.abs().mean());
        for (sensor, largest) in self.stream.largest().into_iter().enumerate() {
            for range in &mut self.gate.limits.range[3 * sensor..3 * sensor + 3] {
                *range = range.or(largest);
            }
        }
        self.gate.limits.gravity = self.force.gravity();
        self.gate.limits.in_si = self.units.map(|unit| unit != ReadingUnit::Counts);
    }

    pub(crate) fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.first_s.get_or_insert(sample.t_s);
        self.last_s = sample.t_s;
        // the gyroscope may have rows of its own
        if sample.readings[0].is_some() {
            self.rate.count(sample.t_s);
        }
        self.live.temperature_c = sample.temperature_c.or(self.live.temperature_c);
        self.kept.push(*sample);
        for decision in self.gate.take(sample) {
            self.decide(decision)?;
        }
        Ok(())
    }

    /// Counts a line that is no row, and says so where there are many.
    fn dropped(&mut self, why: &'static str) -> Result<()> {
        self.live.dropped += 1;
        match self.unfit.dropped(why) {
            Some(share) => {
                let text =
                    format!("{:.0} % of the lines are not recorded; of the last, {why}.", 100.0 * share);
                self.say(Kind::Warning, text)
            }
            None => Ok(()),
        }
    }
}

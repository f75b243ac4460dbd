//! Times of packets in place of times of samples: a radio sends several samples at once, a logger's clock has
//! coarse steps.
//!
//! A reader would drop rows that repeat a time, and with them most of the recording. A rotation integrated
//! over the steps between packets would be wrong. So the user must decide: a given sample rate replaces such
//! times.

use super::column_values::Samples;
use super::options::USUAL_RATE_SD_PPM;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::number_format::{counted, plain};
use calibrant_core::sensor::SensorKind;

/// Fewer samples are not judged.
const FEWEST: usize = 100;
/// One row in this number with the time of the one before is too many.
const SAME: usize = 10;
/// Steps shorter than this share of their mean are within a packet, if most steps are.
const WITHIN: f64 = 1.0 / 3.0;
/// One step in this number must be longer than the mean. A logger that pauses has long segments between
/// pauses.
const LONGEST_PACKET: usize = 50;

/// Samples that come in packets.
pub(super) struct Packets {
    samples: usize,
    same: usize,
    rate_hz: f64,
    /// The longest step over the duration: the rate is known to this share of it.
    rate_share: f64,
}

impl Packets {
    /// `None` where a sensor's times are those of its samples. A row that repeats the whole row before it
    /// does not count.
    pub(super) fn of(times: &[f64], samples: &Samples, sensor_kind: SensorKind) -> Option<Self> {
        let holds = |row: &usize| !times[*row].is_nan() && samples.holds(sensor_kind, *row);
        let (mut found, mut same, mut before) = (Vec::with_capacity(times.len()), 0, None);
        for row in (0..times.len()).filter(holds) {
            if let Some(other) = before.replace(row)
                && times[row] == times[other]
            {
                if samples.repeats(row, other) {
                    continue;
                }
                same += 1;
            }
            found.push(times[row]);
        }
        let (first, last) = (found.first()?, found.last()?);
        let mean = (last - first) / (found.len() - 1).max(1) as f64;
        let (mut within, mut between, mut longest) = (0, 0, 0.0_f64);
        for [one, next] in found.array_windows() {
            within += usize::from(next - one < WITHIN * mean);
            between += usize::from(next - one > mean);
            longest = longest.max(next - one);
        }
        let burst = 2 * within > found.len() && LONGEST_PACKET * between > found.len();
        (found.len() >= FEWEST && mean > 0.0 && (burst || SAME * same > found.len())).then(|| Self {
            samples: found.len(),
            same,
            rate_hz: 1.0 / mean,
            rate_share: longest / (last - first),
        })
    }

    /// Standard deviation, ppm, of a given rate, which the times must confirm; an error where they do not.
    pub(super) fn rate_sd_ppm(&self, given_hz: f64) -> Checked<f64> {
        let (off, least) = ((given_hz / self.rate_hz - 1.0).abs(), 1e-6 * USUAL_RATE_SD_PPM);
        if off > self.rate_share.max(least) {
            let [given, by_times] = [given_hz, self.rate_hz].map(|rate_hz| plain(rate_hz, 6));
            let message = format!(
                "the rate was given as {given} Hz, but the samples and their times show {by_times} Hz"
            );
            let help = format!("say option `rate_hz` {by_times}, or cut the recording where it pauses");
            return refuse(Refusal::RateContradicted, message, help);
        }
        Ok(1e6 * self.rate_share.max(least))
    }

    /// The question to the user about them.
    pub(super) fn question(&self, sensor_kind: SensorKind) -> InputError {
        let what = match SAME * self.same > self.samples {
            true => format!(
                "{} of {} have the time of the one before: the steps of the clock are coarser than those of the samples, or these come in packets",
                self.same,
                counted(self.samples, "sample")
            ),
            false => "the samples come in packets: most follow each other in less than a third of the mean step, and then there is none for long".to_owned(),
        };
        let help = format!(
            "if the sensor samples evenly, say its rate, option `rate_hz`, or rate_hz in [columns] (about {} Hz by the times): the rows are then taken at equal steps, and lost samples do not \
             show; otherwise give a file with the time of each sample",
            plain(self.rate_hz, 6)
        );
        InputError::new(Refusal::RateUnknown, format!("{sensor_kind}: {what}"), help)
            .answered_by(TaskOption::RateHz, [])
    }
}

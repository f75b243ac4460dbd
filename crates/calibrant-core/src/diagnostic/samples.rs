//! Checks of the samples of a recording: spikes, coarse readings, lost samples, temperatures.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{counted, plain, significant, without_trailing_zeros};
use crate::sensor::{Axis, ReadingUnit, SensorKind, Thermal};

checks! {
    /// Spikes were replaced, or invalid samples were removed.
    Spikes "spikes" Warning {
        sensor_kind: SensorKind,
        unit: ReadingUnit,
        /// Number of samples that were replaced.
        replaced: usize,
        /// Number of samples that were removed.
        cut: usize,
        /// Axis of the sample that is farthest from its neighbours.
        axis: Axis,
        /// Its reading.
        reading: f64,
        /// Its time, s.
        time_s: f64,
        /// Its distance from its neighbours, in standard deviations of a sample's noise. Infinite where the
        /// noise is zero.
        deviations: f64,
    }
    decided "A spike is far from the median of nine neighbouring samples. The limit is 7 robust standard deviations \
        of the difference of two samples, and 12 in a movement."
    remedy "Look for a loose contact, or for bytes that are lost on the way."
    says {
        let (reading, deviations) = (ten_digits(*reading), *deviations);
        let off = match deviations {
            off if !off.is_finite() => String::new(),
            off if off < 1e4 => format!(", {off:.0} standard deviations of the noise from its neighbours"),
            off => format!(", {off:.1e} standard deviations of the noise from its neighbours"),
        };
        format!(
            "{sensor_kind}: {}. The farthest reads {reading:?} {} at {time_s:.3} s on axis {axis}{off}. Look for a loose \
             contact, or for bytes lost on the way.",
            taken_out(*replaced, *cut),
            unit.symbol()
        )
    };

    /// The sensor is stuck at times: its readings repeat bit by bit while the times go on.
    ReadingsStuck "readings-stuck" Warning {
        sensor_kind: SensorKind,
        /// The axis; without it, all.
        axis: Option<Axis>,
        /// Number of the samples, which are left out.
        samples: usize,
        /// The same as a share of the recording.
        share: f64,
        /// Number of the runs.
        runs: usize,
        /// Begin of the longest, s.
        start_s: f64,
        /// Its end, s.
        end_s: f64,
    }
    decided "By the noise of the other readings, so long a run of equal ones is not expected once in a thousand recordings. More than 1 % of the samples are in such runs."
    remedy "Look for a sensor or logger that stops, or for a bus that fails. The samples are left out."
    says stuck(*sensor_kind, *axis, (*samples, *share), *runs, (*start_s, *end_s));

    /// The sensor is stuck for a few samples, which are left out.
    ReadingsStuckBriefly "readings-stuck-briefly" Note {
        sensor_kind: SensorKind,
        /// The axis; without it, all.
        axis: Option<Axis>,
        /// Number of the samples, which are left out.
        samples: usize,
        /// The same as a share of the recording.
        share: f64,
        /// Number of the runs.
        runs: usize,
        /// Begin of the longest, s.
        start_s: f64,
        /// Its end, s.
        end_s: f64,
    }
    decided "As `readings-stuck`, of at most 1 % of the samples."
    remedy "Look for a sensor or logger that stops, or for a bus that fails."
    says stuck(*sensor_kind, *axis, (*samples, *share), *runs, (*start_s, *end_s));

    /// The sensor is read more often than it measures: each reading occurs several times. One of each is used.
    ReadingsPolled "readings-polled" Note {
        sensor_kind: SensorKind,
        /// How often each reading occurs, in the mean.
        times_each: f64,
        /// Rate of the sensor, Hz.
        rate_hz: f64,
    }
    decided "Nearly all runs of equal readings have one length, and the readings show noise."
    remedy "Record at the rate of the sensor."
    says format!(
        "{sensor_kind}: each reading occurs {} times: the sensor gives {} Hz. The repeats are left out.",
        without_trailing_zeros(&significant(*times_each, 3)),
        without_trailing_zeros(&significant(*rate_hz, 4))
    );

    /// Samples of the gyroscope look like spikes, but are knocks: with them the rotations meet gravity better.
    KnocksKept "knocks-kept" Note {
        /// Number of the samples.
        samples: usize,
        /// Rotation error with them, rad.
        kept_rad: f64,
        /// Rotation error without them, rad.
        cut_rad: f64,
    }
    decided "The calibration was made with them and without them. The one with the smaller rotation error stays."
    says format!(
        "gyroscope: {} in movements may be spikes or knocks. The rotation error is {:.3}° with them and {:.3}° without: they stay",
        counted(*samples, "sample"),
        kept_rad.to_degrees(),
        cut_rad.to_degrees()
    );

    /// What was left out or replaced is too little to matter. Its diagnostics do not count for the verdict.
    LeftOutNegligible "left-out-negligible" Note {
        /// The codes that do not count.
        codes: Vec<String>,
        /// How many of what.
        what: Phrase,
    }
    decided "At most one sample in a thousand is a spike, or at most one in twenty of the holds or rotations is left out, or one of twelve or more. No sensor saturates there. \
        Of holds that were found, the gyroscope turns in fewer than half, and six others tell its bias. Of twelve holds and more, at most half as many stretches are too short."
    says format!("{} do not count: what was left out is too little to move the result ({})", codes.join(", "), what.0);

    /// The recording of an IMU has no gyroscope. Only the accelerometer was calibrated.
    GyroscopeMissing "gyroscope-missing" Warning {}
    decided "The file has no columns of a gyroscope, and no other file gives it."
    remedy "Give its file with option `gyroscope`, name its columns in [columns], or leave `kind = \"imu\"` out of the \
        experiment file."
    says "the recording has no gyroscope, so only the accelerometer is calibrated. Give the gyroscope's file with \
     option `gyroscope`, or name its columns in [columns].";

    /// The readings come in steps of more than twice their noise. The mean of a hold has an error, however
    /// long the hold is.
    CoarseSteps "coarse-steps" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        unit: ReadingUnit,
        /// The step.
        step: f64,
        /// The noise before rounding, or 0 where it is too small to be seen.
        noise: f64,
        /// Error of the mean of a hold.
        mean_sd: f64,
    }
    decided "Rounding moves the mean of a hold by more than a quarter of the standard deviation that noise gives it."
    remedy "Choose a smaller range, or write more digits to the file."
    says format!(
        "the readings of axis {axis} of the {sensor_kind} come in steps of {step:.3e} {unit}, more than twice {}. The mean \
         of a hold has an error of about {mean_sd:.1e} {unit}, however long the hold is.{} Choose a smaller range, or \
         write more digits to the file.",
        match *noise > 0.0 {
            true => format!("the noise of about {noise:.1e} {}", unit.symbol()),
            false => "the noise, which hardly shows".to_owned(),
        },
        match sensor_kind {
            SensorKind::Accelerometer => "",
            SensorKind::Gyroscope => " The standard deviations of a calibration include this error.",
        },
        unit = unit.symbol()
    );

    /// Samples are lost, and the times do not show it. The rotations look too small.
    SamplesLost "samples-lost" Warning {
        /// Share of the samples.
        lost_share: f64,
        /// Jumps by one whole step.
        jumps: usize,
    }
    decided "Between two samples the gyroscope often changes by twice the step before and after."
    remedy "Record without losses, or with times of the sensor's own clock. The gyroscope's gains are too small by \
        the share of lost samples."
    says format!(
        "about {:.1} % of the samples are lost, and the times do not show it: in motion, {jumps} steps of the \
         gyroscope are twice as long as their neighbours. Its gains are too small by that share. Record without \
         losses, or with times of the sensor's own clock.",
        100.0 * lost_share
    );

    /// The thermometer lags the sensor. The standard deviations carry the lag as far as it is not stated.
    ThermometerLags "thermometer-lags" Note {
        /// The lag, s.
        lag_s: f64,
        /// Its standard deviation, s.
        sd_s: f64,
    }
    decided "Another lag than the stated one lowers χ² by more than 25."
    remedy "State temperature.lag_s, or record the temperature of the sensor's own chip, or let it change slowly."
    says format!(
        "the thermometer seems to {} the sensor by {:.0} ± {sd_s:.0} s. The standard deviations carry a lag of the usual \
         size. With temperature.lag_s = {lag_s:.0} the temperatures are the sensor's: T + ({lag_s:.0} s) dT/dt. `apply` \
         takes temperatures as recorded, and is right where they change slowly.",
        if *lag_s > 0.0 { "lag" } else { "be ahead of" },
        lag_s.abs()
    );

    /// The thermometer shows coarse steps, and something follows temperature.
    ThermometerCoarse "thermometer-coarse" Note {
        /// The smallest difference between two temperatures, K.
        step_k: f64,
    }
    decided "No two temperatures differ by less than 0.5 K. Some sensors report whole degrees."
    remedy "Record more digits where the thermometer has them. Otherwise nothing: what steps do differs between holds and between soaks, and is part of their scatter."
    says format!(
        "the temperature comes in steps of {} K: one that stays within a step is known to {} K (sd), and rates are averaged over several steps",
        plain(*step_k, 2),
        plain(step_k / 12.0_f64.sqrt(), 2)
    );

    /// The recording goes beyond the temperatures of its holds. The polynomials extrapolate there.
    TemperatureExtrapolated "temperature-extrapolated" Warning {
        /// Lowest temperature of the recording, °C.
        coldest_c: f64,
        /// Highest temperature of the recording, °C.
        hottest_c: f64,
        /// Coldest of the holds, °C.
        holds_coldest_c: f64,
        /// Hottest of the holds, °C.
        holds_hottest_c: f64,
    }
    decided "The coldest or the hottest sample lies far outside."
    remedy "Make holds over the whole range of temperatures."
    says format!(
        "the recording goes from {coldest_c:.1} to {hottest_c:.1} °C, but its holds only from {holds_coldest_c:.1} to \
         {holds_hottest_c:.1} °C. Beyond these, the temperature polynomials extrapolate."
    );

    /// A recording lies far beyond the temperatures of the calibration that corrects it.
    CalibrationExtrapolated "calibration-extrapolated" Warning {
        /// Coldest of the calibration, °C.
        low_c: f64,
        /// Hottest of the calibration, °C.
        high_c: f64,
        /// Coldest of what it corrects, °C.
        coldest_c: f64,
        /// Hottest of what it corrects, °C.
        hottest_c: f64,
    }
    decided "The coldest or the hottest temperature lies far outside those of the calibration."
    remedy "Calibrate over the temperatures of use."
    says format!(
        "the calibration was made at {low_c:.1} to {high_c:.1} °C: its polynomials are extrapolated to {} °C",
        match coldest_c == hottest_c {
            true => format!("{coldest_c:.1}"),
            false => format!("{coldest_c:.1} to {hottest_c:.1}"),
        }
    );

    /// The reference temperature lies beyond the temperatures of the holds.
    ReferenceExtrapolated "reference-extrapolated" Warning {
        /// The reference, °C.
        reference_c: f64,
        /// Coldest of the holds, °C.
        holds_coldest_c: f64,
        /// Hottest of the holds, °C.
        holds_hottest_c: f64,
    }
    decided "It lies far outside."
    remedy "Choose another reference, or record at that temperature."
    says format!(
        "biases and gains are stated at the reference temperature of {reference_c:.1} °C. The holds cover \
         {holds_coldest_c:.1} to {holds_hottest_c:.1} °C, and the values are extrapolated. Choose a reference within the holds."
    );
}

impl Spikes {
    /// What was found in the readings of a sensor. `unit`: that of its readings.
    #[must_use]
    pub fn of(found: &crate::sensor::Spikes, sensor_kind: SensorKind, unit: ReadingUnit) -> Self {
        Self {
            sensor_kind,
            unit,
            replaced: found.samples.len(),
            cut: found.cut.len(),
            axis: found.axis,
            reading: found.reading,
            time_s: found.time_s,
            deviations: found.deviations,
        }
    }
}

impl CalibrationExtrapolated {
    /// Temperatures far beyond those at which a calibration was made; `None` where they are not.
    #[must_use]
    pub fn of(thermal: &Thermal, [coldest_c, hottest_c]: [f64; 2]) -> Option<Self> {
        let [low_c, high_c] = thermal.range_c?;
        let is_beyond = thermal.extrapolates_to(coldest_c) || thermal.extrapolates_to(hottest_c);
        is_beyond.then_some(Self { low_c, high_c, coldest_c, hottest_c })
    }
}

/// Where a sensor is stuck, in words.
fn stuck(
    sensor_kind: SensorKind,
    axis: Option<Axis>,
    (samples, share): (usize, f64),
    runs: usize,
    (start_s, end_s): (f64, f64),
) -> String {
    let what = axis
        .map_or_else(|| "its readings repeat".to_owned(), |axis| format!("axis {axis} repeats its reading"));
    let longest = if runs == 1 { "" } else { "the longest " };
    format!(
        "the {sensor_kind} is stuck in {}: {what} bit by bit while the times go on, {longest}from {start_s:.2} to {end_s:.2} s. {} ({} %) are left out.",
        counted(runs, "place"),
        counted(samples, "sample"),
        significant(100.0 * share, 2)
    )
}

/// The number that a reading was written with: the largest integer of 32 bits has ten digits.
fn ten_digits(reading: f64) -> f64 {
    format!("{reading:.9e}").parse().unwrap_or(reading)
}

/// How many samples were replaced or removed.
fn taken_out(replaced: usize, cut: usize) -> String {
    let counted = |count: usize| if count == 1 { "1 sample".to_owned() } else { format!("{count} samples") };
    let invalid = |counted: &str| match cut {
        1 => format!("{counted} is invalid and was removed"),
        _ => format!("{counted} are invalid and were removed"),
    };
    let (are, were) = if replaced == 1 { ("is a spike", "was") } else { ("are spikes", "were") };
    let spikes =
        format!("{} {are} and {were} replaced by the line between the neighbours", counted(replaced));
    match (replaced, cut) {
        (0, _) => invalid(&counted(cut)),
        (_, 0) => spikes,
        _ => format!("{spikes}; {}", invalid(&format!("{cut} more"))),
    }
}

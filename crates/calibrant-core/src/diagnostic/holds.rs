//! Checks of the holds of a recording, and of gravity in them.

use super::check::checks;
use super::faces::FacePointing;
use super::hold_span::{HoldReason, HoldSpan};
use super::parts::{Phrase, listed};
use crate::number_format::{plain, significant};
use crate::sensor::{Axis, NonlinearTerm, ReadingUnit, SensorKind};

/// What to do about a term that is missing.
fn estimate_it(term: NonlinearTerm, is_told: bool) -> String {
    let words = match (is_told, term) {
        (true, NonlinearTerm::SecondOrder) => "\"second-order\"",
        (true, NonlinearTerm::GainBySign) => "\"gain-by-sign\"",
        (false, _) => "\"second-order\", \"gain-by-sign\"",
    };
    let both = if is_told { "" } else { ": the holds do not tell which of the two it is" };
    format!("Write nonlinearity = [{words}] in [holds]{both}; or is the sensor near the end of its range?")
}

checks! {
    /// A hold is not used.
    HoldLeftOut "hold-left-out" Warning {
        hold: HoldSpan,
        /// Why.
        why: HoldReason,
    }
    decided "The accelerometer saturates in it, or the magnitude of its mean has too large an error, in standard \
        deviations."
    remedy "Look at the hold in the report. Record with a larger range, or hold the sensor still."
    says format!("{hold} is not used: {why}");

    /// Several consecutive holds are not used. This is not by chance.
    HoldsLeftOutInARow "holds-left-out-in-a-row" Warning {
        /// Number of holds.
        holds: usize,
        /// Begin of the first, s.
        start_s: f64,
        /// End of the last, s.
        end_s: f64,
    }
    decided "So long a run of unused holds is improbable, and no change of the sensor explains it."
    remedy "Calibrate these holds separately (holds.intervals_s) and compare."
    says format!(
        "the {holds} consecutive holds from {start_s:.1} to {end_s:.1} s are not used. This is not by chance: the sensor \
         changed there, or it was not at rest. Calibrate these holds separately (holds.intervals_s), and compare."
    );

    /// Of several recordings that are calibrated together, no hold of one is used.
    RecordingUnused "recording-unused" Warning {
        /// Its number, from 1.
        recording: usize,
    }
    decided "No hold was found in it, or all were left out."
    remedy "Look at it by itself: is its unit that of the others, and does the sensor rest in it? If nothing can be done, leave it out."
    says format!(
        "no hold of recording {recording} is used: it adds nothing. Is its unit that of the others, and does the sensor rest in it?"
    );

    /// A given hold reaches beyond the recording.
    HoldBeyondRecording "hold-beyond-recording" Warning {
        /// Its number, from 1.
        hold: usize,
        /// Its begin as given, s.
        start_s: f64,
        /// Its end as given, s.
        end_s: f64,
        /// First sample of the recording, s.
        recording_start_s: f64,
        /// Last sample of the recording, s.
        recording_end_s: f64,
        /// Duration within the recording, s.
        common_s: f64,
    }
    decided "More of it lies outside than rounding of the times explains."
    remedy "Correct holds.intervals_s."
    says format!(
        "hold {hold} is given from {start_s} to {end_s} s, but the recording lasts from {recording_start_s} to \
         {recording_end_s} s. Only {common_s:.1} s of the hold count. Correct holds.intervals_s."
    );

    /// The gyroscope turns in some holds. Its readings there are not used for its bias.
    HoldMoved "hold-moved" Warning {
        /// The holds.
        holds: Vec<HoldSpan>,
        /// Root mean square of the rate in the fastest.
        rate_rms: f64,
        /// Unit of the rate.
        unit: ReadingUnit,
        /// Are the intervals of the holds given?
        are_given: bool,
    }
    decided "Its mean rate in the hold differs from that in the others by more than their scatter."
    remedy "Put the sensor down, and do not hold it by hand. If holds.intervals_s is given, correct or remove it."
    says format!(
        "the gyroscope turns in {}, by up to {rate_rms:.2e} {} rms. Its readings there are not used for its bias. An \
         accelerometer does not see a rotation about the vertical. {}",
        listed(holds, ", "),
        unit.symbol(),
        match are_given {
            true => "Correct holds.intervals_s, or remove that key: the program then finds the holds.",
            false => "Put the sensor down for each hold.",
        }
    );

    /// Neighbouring samples are strongly correlated, as behind a slow low-pass filter. This breaks up
    /// holds.
    HoldsLostToFilter "holds-lost-to-filter" Warning {
        /// Holds that were found.
        holds: usize,
        /// Other segments that look stationary.
        stretches: usize,
        /// Shortest hold, s.
        minimum_s: f64,
    }
    decided "Several segments look stationary but are too short for holds. Samples four apart differ much more than \
        neighbours."
    remedy "Give holds.intervals_s, hold longer, or record with a wider bandwidth."
    says format!(
        "{} found. {stretches} other segments look stationary, but not for {minimum_s} s without interruption: {}. Remedy: {}.",
        match holds {
            1 => "1 hold is".to_owned(),
            count => format!("{count} holds are"),
        },
        Self::REASON,
        Self::HELP
    );

    /// Accelerometer and gyroscope may stand in each other's place.
    SensorsSwapped "sensors-swapped" Warning {}
    decided "The gyroscope rests at several values, as an accelerometer does in several orientations. The \
        accelerometer does not."
    remedy "Give each file, or the columns, to the sensor that they are of."
    says "the gyroscope rests at values that differ, as an accelerometer does, and the accelerometer does not: are their \
        files or columns exchanged?";

    /// The holds of a recording do not determine the accelerometer.
    HoldsUndetermined "holds-undetermined" Note {
        why: Phrase,
    }
    decided "A calibration is foretold from the holds that were found, and is not possible."
    remedy "Hold the sensor still in more orientations, where the accelerometer is to be calibrated."
    says format!("the holds do not determine the accelerometer: {}", why.0);

    /// The directions of the holds are too similar. The data hardly separate some parameters.
    HoldsSpreadLittle "holds-spread-little" Warning {
        /// Condition number.
        condition_number: f64,
        /// The parameters that the data hardly separate.
        parameters: Vec<String>,
    }
    decided "The condition number of the scaled information is above 100, and two of these parameters are \
        correlated by more than 0.9."
    remedy "Add holds in other directions."
    says format!(
        "the directions of the holds are too similar (condition number {condition_number:.0}). The data hardly \
         separate {}. Add holds in other directions.",
        parameters.join(", ")
    );

    /// The holds scatter far beyond their noise. The cause is movement, drift, saturation, or a force other
    /// than gravity.
    HoldsScatter "holds-scatter" Warning {
        /// Standard deviation between holds, m/s².
        between_holds_sd_mps2: f64,
    }
    decided "The standard deviation between holds is more than 20 mm/s²."
    remedy "Hold the sensor still, let it warm up, and check its range."
    says format!(
        "the holds scatter by {:.0} mm/s² beyond their noise. Look for movement, drift, saturation, or a force other \
         than gravity.",
        1e3 * between_holds_sd_mps2
    );

    /// The samples within the holds scatter far more than the given noise. The sensor trembles or vibrates there, or the given noise is wrong.
    HoldsTremble "holds-tremble" Warning {
        sensor_kind: SensorKind,
        /// The axis with the largest ratio.
        axis: Axis,
        /// The scatter over the given noise.
        ratio: f64,
    }
    decided "They scatter by more than ten times the given noise. The result rests on the scatter that was found."
    remedy "Lay the sensor down for each hold, where nothing vibrates. If it was still, correct the noise in the experiment file."
    says format!(
        "the samples of the {sensor_kind} scatter within the holds by {} times the noise in the experiment file (axis {axis}): \
         it trembles or vibrates, or that noise is wrong. Lay the sensor down for each hold, or correct the noise.",
        significant(*ratio, 3)
    );

    /// The accelerometer has another gain for positive forces than for negative ones. Bias and gain do not describe it.
    GainDependsOnSign "gain-depends-on-sign" Warning {
        /// The axis with the largest difference.
        axis: Axis,
        /// Gain for positive forces less that for negative ones, over the gain.
        difference: f64,
        /// How far a bias would move, in its standard deviations.
        moved_sds: f64,
        /// Do the holds tell it from a second-order response?
        is_told: bool,
    }
    decided "With two gains for each axis the holds fit better; such a difference occurs by chance once in a thousand times, and would move a \
        bias by more than two of its standard deviations."
    remedy "Write nonlinearity = [\"gain-by-sign\"] in [holds], which estimates the two gains from some three dozen holds; with \"second-order\" beside it where the \
        holds do not tell the two apart. Else choose a larger range, or another sensor."
    says format!(
        "axis {axis} of the accelerometer seems to have a gain that is {:+.2} % larger for positive forces than for negative ones: with such \
         gains the holds fit far better, and a bias would move by {moved_sds:.1} standard deviations. {}",
        100.0 * difference,
        estimate_it(NonlinearTerm::GainBySign, *is_told)
    );

    /// The accelerometer's response is bent like a parabola. Bias and gain do not describe it.
    SecondOrderResponse "second-order-response" Warning {
        /// The axis with the largest coefficient.
        axis: Axis,
        /// Its second-order coefficient, (m/s²)⁻¹.
        second_order_per_mps2: f64,
        /// How far a bias would move, in its standard deviations.
        moved_sds: f64,
        /// Do the holds tell it from a gain that depends on the sign?
        is_told: bool,
    }
    decided "With a second-order coefficient for each axis the holds fit better than with two gains; such coefficients occur by chance once in a thousand \
        times, and would move a bias by more than two of its standard deviations."
    remedy "Write nonlinearity = [\"second-order\"] in [holds], which estimates the coefficients from some three dozen holds; with \"gain-by-sign\" beside it where \
        the holds do not tell the two apart. Else choose a larger range, or another sensor."
    says format!(
        "axis {axis} of the accelerometer seems to have a second-order coefficient of {} mg/g²: with such terms the holds fit far better, and a \
         bias would move by {moved_sds:.1} standard deviations. {}",
        plain(1e3 * 9.806_65 * second_order_per_mps2, 2),
        estimate_it(NonlinearTerm::SecondOrder, *is_told)
    );

    /// A term that bends the accelerometer's response was estimated, and another one fits the holds as well.
    ResponseTermOpen "response-term-open" Warning {
        /// The term that was estimated.
        estimated: NonlinearTerm,
        /// The other one.
        rival: NonlinearTerm,
        /// How far a bias would move with the other one, in its standard deviations.
        moved_sds: f64,
    }
    decided "The holds do not make the term that was estimated 1000 times as likely as the other one in its place, and a bias would move by more than two of its \
        standard deviations."
    remedy "Estimate both: nonlinearity = [\"second-order\", \"gain-by-sign\"] in [holds]. Holds near all six faces and between them tell the two apart."
    says format!(
        "the holds fit {} as well as {}, with which a bias would be {moved_sds:.1} standard deviations elsewhere. Estimate both: \
         nonlinearity = [\"second-order\", \"gain-by-sign\"]",
        rival.name(),
        estimated.name()
    );

    /// No hold has an axis pointing up, or down.
    OrientationMissing "orientation-missing" Warning {
        /// The directions.
        missing: Vec<FacePointing>,
    }
    decided "No hold is within 60° of that direction."
    remedy "Add a hold there."
    says format!("no hold has {}. Add one.", listed(missing, " or "));

    /// The given gravity occurs nowhere on the Earth. All gains of the accelerometer are wrong by the same
    /// ratio.
    GravityOffEarth "gravity-off-earth" Warning {
        /// Gravity as given, m/s².
        gravity_mps2: f64,
        /// The least on the Earth's surface, m/s².
        least_mps2: f64,
        /// The most on the Earth's surface, m/s².
        most_mps2: f64,
    }
    decided "The value lies outside the range of the Earth's surface."
    remedy "Correct holds.gravity_mps2."
    says format!(
        "gravity is given as {gravity_mps2} m/s², but on the Earth's surface it is {least_mps2} to {most_mps2}. \
         Correct holds.gravity_mps2. Otherwise all gains of the accelerometer are wrong by this ratio."
    );

    /// The given gravity is not that of the Earth. Results are in the unit that makes it true.
    GravityUnusual "gravity-unusual" Warning {
        /// Gravity as given, m/s².
        gravity_mps2: f64,
    }
    decided "The value is below 9.7 or above 9.9 m/s²."
    remedy "Correct holds.gravity_mps2, or read the results in that unit."
    says format!(
        "gravity is given as {gravity_mps2} m/s². The results are in the unit that makes this true."
    );
}

impl HoldsLostToFilter {
    /// Why the holds are broken up.
    pub(crate) const REASON: &'static str =
        "neighbouring samples are strongly correlated, as behind a low-pass filter far below the sample rate";
    /// What to do about it.
    pub(crate) const HELP: &'static str =
        "give holds.intervals_s, hold longer, or record with a wider bandwidth";
}

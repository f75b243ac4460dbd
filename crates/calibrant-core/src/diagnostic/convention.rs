//! Checks of calibrations in the formats of other programs.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::plain;
use crate::sensor::{ReadingUnit, SensorKind};

checks! {
    /// A format of calibrations has no place for a part of it.
    FormatLoses "format-loses" Warning {
        /// The format.
        format: &'static str,
        /// What it has no place for: `the biases`.
        what: &'static str,
        /// How it is in the file nevertheless: `under the key …, which only calibrant reads`.
        kept: Option<&'static str>,
    }
    decided "The format has no key for it."
    remedy "Keep the JSON of calibrant beside it."
    says match kept {
        Some(kept) => format!("{format} has no place for {what}, kept {kept}"),
        None => format!("{format} has no place for {what}: keep the calibrant JSON"),
    };

    /// A format of calibrations has no place for the terms that bend the accelerometer's response.
    ResponseStraightened "response-straightened" Warning {
        /// The format.
        format: &'static str,
        /// What it errs by at ±1 g along an axis, at most, m/s².
        largest_mps2: f64,
    }
    decided "The format has a matrix and a bias only. The error is that of the terms at ±1 g along each axis."
    remedy "Take the C header or the JSON of calibrant, or calibrate without `nonlinearity` for the best straight line."
    says format!(
        "{format} has no place for the terms that bend the accelerometer's response: what it corrects errs by up to {} mm/s² at ±1 g. Take the C header or the calibrant JSON",
        plain(1e3 * largest_mps2, 2)
    );

    /// A format of calibrations has polynomials of temperature of a lower order.
    PolynomialShortened "polynomial-shortened" Warning {
        /// The format.
        format: &'static str,
        /// Its highest order.
        order: usize,
        /// What each sensor errs by over the range, at most: `the accelerometer by up to 0.002 m/s²`.
        errors: Vec<String>,
    }
    decided "The bias has a higher order than the format has powers."
    remedy "Calibrate with this order, or take the C header or the JSON of calibrant."
    says format!(
        "{format} has biases up to order {order} in the temperature. The nearest polynomials of that order are written, which err: {}",
        errors.join(", ")
    );

    /// A format of calibrations needs what the calibration does not have.
    FormatNeeds "format-needs" Warning {
        /// The format.
        format: &'static str,
        /// What it needs.
        fields: Vec<String>,
        /// How to give it.
        how: Phrase,
    }
    decided "The programs that read the format stop without it, or do not use the file."
    remedy "Complete the file by hand, or give what is missing as the sentence says."
    says format!("{format} needs {} as well: {}, or complete the file by hand", fields.join(", "), how.0);

    /// The true frame of a calibration is not that of the format.
    FrameTurned "frame-turned" Warning {
        /// The format.
        format: &'static str,
        /// The angle by which the frame is turned into the format's, °; none where the file holds the rotation.
        angle_deg: Option<f64>,
    }
    decided "The accelerometer's matrix is not lower triangular."
    remedy "Rotate the frame: option `gauge` lower."
    says match angle_deg {
        Some(angle_deg) => format!(
            "the true frame is turned by {}° into that of {format}, which has x along the accelerometer's x axis (option `gauge` lower): poses of cameras refer to it",
            plain(*angle_deg, 3)
        ),
        None => "the true frame is not Kalibr's: T_i_b holds the rotation, which many readers ignore; option `gauge` lower \
            makes it the identity".into(),
    };

    /// The noise of two sensors was measured at different rates, and a format has one rate.
    RatesDiffer "rates-differ" Warning {
        /// The sensor whose rate is not written.
        sensor_kind: SensorKind,
        /// Its rate, Hz.
        measured_hz: f64,
        /// The rate that is written, Hz.
        written_hz: f64,
    }
    decided "The rates of the noise are compared with the one that is written."
    remedy "Bring both sensors to one rate."
    says format!(
        "update_rate is one number: {written_hz} Hz is written, but the {sensor_kind} has {measured_hz} Hz. Kalibr takes \
         the noise of a sample for the density times √update_rate, {:.2} times that of the {sensor_kind}: bring both \
         sensors to one rate",
        (written_hz / measured_hz).sqrt()
    );

    /// A file does not state something, and a reader supposes it.
    FormatSupposed "format-supposed" Note {
        /// What the file does not state: `biases`.
        what: &'static str,
        /// What is supposed.
        supposed: Phrase,
    }
    decided "The format has no key for it, or the file does not use it."
    remedy "Check it."
    says format!("the file does not say {what}: {}", supposed.0);

    /// The verdict on a calibration that is read forbids its use.
    VerdictBad "verdict-bad" Warning {
        /// The codes that decide it.
        codes: Vec<String>,
    }
    decided "The file says its verdict."
    remedy "Read the codes in its report, and calibrate again."
    says format!("the verdict on this calibration is bad ({}): calibrate again before you use it", codes.join(", "));

    /// A random walk is written that some axes of a sensor do not show: a format has one number for three axes.
    WalkOfSomeAxes "walk-of-some-axes" Note {
        sensor_kind: SensorKind,
        /// The axes on which it is not determined: `x`.
        axes: String,
        /// Is the number that is written an upper limit of these?
        is_limit: bool,
    }
    decided "Of each axis that determines it the value is taken, of the others the upper limit; the largest is written."
    remedy "Record at rest for longer where the limit decides."
    says match is_limit {
        true => format!("the random walk of the {sensor_kind} is an upper limit: {axes} does not determine it, and could have that much"),
        false => format!("the random walk of the {sensor_kind} is that of the axes that show one; {axes} has less"),
    };

    /// A lever arm in a calibration is left out.
    LeverArmIgnored "lever-arm-ignored" Note {
        /// Where it stands.
        what: &'static str,
    }
    decided "The file has it, and the correction of a reading does not need it."
    says format!("{what}, a lever arm, is left out");

    /// A unit is given for a file that states another one.
    UnitGiven "unit-given" Note {
        sensor_kind: SensorKind,
        /// The unit in the file, which counts.
        stated: ReadingUnit,
        /// The unit that is given.
        given: ReadingUnit,
    }
    decided "Both are compared."
    remedy "Leave the unit away."
    says format!(
        "the readings of the {sensor_kind} are in {}, as the file says: the unit {} is given for files that do not say it",
        stated.symbol(),
        given.symbol()
    );

    /// A calibration is the truth of a simulation.
    ValuesExact "values-exact" Note {
        /// The seed of the simulation.
        seed: Option<usize>,
    }
    decided "The file is a truth.json."
    says {
        let seed = seed.map_or_else(String::new, |seed| format!(", seed {seed}"));
        format!("the truth of a simulation{seed}: its values are exact")
    };
}

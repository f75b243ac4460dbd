//! Checks of a calibration over temperature, from several soaks.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{plain, significant};
use crate::sensor::Axis;

/// A number with its unit, which may be 1.
fn with_unit(value: f64, unit: &str) -> String {
    if unit == "1" { significant(value, 2) } else { format!("{} {unit}", significant(value, 2)) }
}

/// The probability of a false alarm below which hysteresis, lag and drift count as seen.
pub const SEEN: f64 = 0.01;

checks! {
    /// A quantity differs by the direction in which a temperature is reached: hysteresis.
    HysteresisSeen "hysteresis-seen" Note {
        /// The quantity: `accelerometer.bias`.
        quantity: Phrase,
        /// Unit of what follows.
        unit: &'static str,
        /// The greatest half difference of the branches.
        half_difference: f64,
        /// The wanted standard deviation.
        goal: f64,
    }
    decided "A Wald test of the half difference, without its prior, over the axes: p < 0.01."
    remedy "Add it to the uncertainty of the correction: in use nobody knows the direction."
    says format!(
        "{}: the branches from below and from above differ. Half the difference is up to {} (goal {}); the correction is the mean of both: add it to its uncertainty",
        quantity.0, with_unit(*half_difference, unit), plain(*goal, 3)
    );

    /// Hysteresis is larger than the goal.
    HysteresisLarge "hysteresis-large" Warning {
        /// The quantity.
        quantity: Phrase,
        /// Unit of what follows.
        unit: &'static str,
        /// The greatest half difference of the branches.
        half_difference: f64,
        /// The wanted standard deviation.
        goal: f64,
    }
    decided "It is seen, and the greatest half difference of the branches exceeds the goal."
    remedy "No polynomial of temperature corrects it: take it into the uncertainty, set a wider goal in campaign.goals, or choose another sensor."
    says format!(
        "{}: half the difference of the branches is up to {}, more than the goal of {}: no polynomial of temperature corrects that",
        quantity.0, with_unit(*half_difference, unit), plain(*goal, 3)
    );

    /// The thermometer and the sense element are not at one temperature after a ramp.
    LagSeen "lag-seen" Note {
        /// The quantity.
        quantity: Phrase,
        /// Unit of the error.
        unit: &'static str,
        /// The greatest error at the rate of the ramp.
        at_ramp: f64,
        /// By how much the thermometer lags, where the quantity determines it, s.
        lag_s: Option<f64>,
    }
    decided "A Wald test of the lag, without its prior, over the axes: p < 0.01."
    remedy "Nothing: the coefficients carry it. In use, the correction errs by that while the temperature changes so fast."
    says {
        let by = lag_s.map_or_else(String::new, |lag_s| format!(", as of a thermometer that lags by {} s", significant(lag_s, 2)));
        format!("{}: the sensor lags its thermometer{by}. At the rate of the ramps the correction errs by up to {}", quantity.0, with_unit(*at_ramp, unit))
    };

    /// No temperature is reached in both directions.
    OneDirection "one-direction" Warning {
        /// The quantities whose hysteresis and lag count more than their goals.
        quantities: Vec<String>,
    }
    decided "No two soaks within campaign.spacing_c are reached in different directions. Hysteresis and lag are then what their priors say, which exceeds the goals."
    remedy "Reach some temperatures from above as well; `design` with directions = \"both\" says which."
    says format!(
        "every temperature is reached in one direction: hysteresis and lag are only what is supposed of them ([campaign], or usual sensors), which matters for {}. Reach some from the other side, too",
        quantities.join(", ")
    );

    /// The temperature still changes in soaks, and nothing is allowed for a lag.
    NotSettled "not-settled" Warning {
        /// The soaks.
        soaks: Vec<String>,
        /// Greatest rate over the holds of one, K/min.
        rate_k_per_min: f64,
    }
    decided "Its rate is more than a twentieth of the ramp's, and lag_sd is empty for every quantity of campaign."
    remedy "Wait longer, or allow for a lag: lag_sd of the quantities in [campaign]."
    says format!(
        "not settled, with up to {} K/min, and no quantity of [campaign] has a lag_sd: {}",
        significant(*rate_k_per_min, 2), soaks.join(", ")
    );

    /// A polynomial of the order does not follow a quantity.
    OrderTooLow "order-too-low" Warning {
        /// The quantity.
        quantity: Phrase,
        /// The order that is reported.
        order: usize,
        /// The next one.
        next: usize,
    }
    decided "The coefficients above the order are more than beyond_sd of campaign allows: χ² with p < 0.001 over the axes."
    remedy "Raise the order in [temperature] by one, up to 5."
    says format!(
        "{}: what lies above order {order} is more than beyond_sd allows, which then bends the fit. Set order {next} in [temperature]",
        quantity.0
    );

    /// The highest coefficient of a quantity is not seen.
    OrderTooHigh "order-too-high" Note {
        /// The quantity.
        quantity: Phrase,
        /// The order that is reported.
        order: usize,
        /// The one below.
        lower: usize,
    }
    decided "Its coefficients of that order lie within 1 sd of 0 on all axes, where the soaks would see one of the size that is known beforehand; and without them the other soaks predict each soak better."
    remedy "Lower the order in [temperature] by one."
    says format!(
        "{}: nothing is seen of order {order}, and without it the other soaks predict each soak better. Set order {lower} in [temperature]",
        quantity.0
    );

    /// A soak does not agree with the others.
    SoakDisagrees "soak-disagrees" Warning {
        /// The soak.
        soak: Phrase,
        /// The parameter that is farthest off.
        parameter: String,
        /// By how many standard deviations.
        deviations: f64,
        /// By how many standard deviations of the result leaving it out moves a parameter, at most.
        moves: f64,
    }
    decided "What the other soaks predict of it, over its standard deviation, with p < 0.001 over all residuals."
    remedy "Look at its own report. Leave it out where that explains it: a knock, a loose mount, a wrong temperature."
    says format!(
        "{} does not agree with the others: {parameter} is {} sd off; leaving it out moves the result by up to {} sd",
        soak.0, significant(*deviations, 2), significant(*moves, 2)
    );

    /// The soaks do not cover the range of use, or lie outside it.
    RangeNotCovered "range-not-covered" Warning {
        /// The coldest soak, °C.
        coldest_c: f64,
        /// The hottest soak, °C.
        hottest_c: f64,
        /// The range of use, °C.
        low_c: f64,
        /// Its upper end, °C.
        high_c: f64,
    }
    decided "The coldest or the hottest soak is more than a tenth of the range from its end."
    remedy "Soak at the ends of the range, or set campaign.range_c to what was soaked. Is the temperature in °C?"
    says {
        let near = |of: f64, to: f64| ((of - 32.0) / 1.8 - to).abs() < 0.1 * (high_c - low_c);
        let asked = match near(*coldest_c, *low_c) && near(*hottest_c, *high_c) {
            true => "Is the temperature in °F? Then convert it",
            false => "Soak at its ends, or set it to what was soaked",
        };
        format!(
            "the soaks are from {} to {} °C, and campaign.range_c is from {} to {}: goals and standard deviations are of the latter. {asked}",
            plain(*coldest_c, 3), plain(*hottest_c, 3), plain(*low_c, 3), plain(*high_c, 3)
        )
    };

    /// A quantity drifts from the first soak to the last.
    Aged "aged" Warning {
        /// The quantity.
        quantity: Phrase,
        /// Unit of the drift.
        unit: &'static str,
        /// From the first soak to the last, of the axis that drifts most.
        drift: f64,
    }
    decided "A Wald test of a drift in the order of the soaks, over the axes: p < 0.001."
    remedy "Repeat the first soak at the end, and find out what changed: a drift over the campaign is not temperature."
    says format!("{} drifts by up to {} from the first soak to the last, which is not temperature: the sensor changed", quantity.0, with_unit(*drift, unit));

    /// The scatter between soaks is stated, not found.
    ScatterStated "scatter-stated" Note {
        /// The quantities.
        quantities: Vec<String>,
    }
    decided "There are fewer than three soaks more than coefficients."
    remedy "Add soaks, or state soak_sd of campaign as earlier campaigns found it."
    says format!("too few soaks to find the scatter between them: soak_sd of [campaign] is taken for {}", quantities.join(", "));

    /// The direction in which a soak was reached is not known.
    DirectionUnknown "direction-unknown" Note {
        /// The soaks.
        soaks: Vec<String>,
    }
    decided "Its temperature does not change, and the soak before it was as warm."
    remedy "Nothing: what hysteresis may do there is part of its standard deviation."
    says format!("nobody knows from where {} came to its temperature: the prior of hysteresis is added to its variance", soaks.join(", "));

    /// Soaks that leave parameters open, with what the others say of these.
    SoaksTogether "soaks-together" Note {
        /// The soaks.
        soaks: Vec<String>,
    }
    decided "They do not determine all parameters by themselves, and other soaks do."
    remedy "Nothing: the fit over all soaks takes from each what it measured. Their own folders rest on the others."
    says format!("do not determine all parameters by themselves, and are fitted together with the others: {}", soaks.join(", "));

    /// A recording goes over more temperatures than a soak.
    RampCut "ramp-cut" Note {
        /// The recording.
        recording: String,
        /// Lowest temperature, °C.
        from_c: f64,
        /// Highest temperature, °C.
        to_c: f64,
        /// Number of pieces.
        pieces: usize,
    }
    decided "Its temperature goes over more than 0.2 of the range of use."
    remedy "Nothing: each piece is fitted as a soak at its temperature. Pieces with no hold, or only one, are not used."
    says format!("{recording} goes from {from_c:.0} to {to_c:.0} °C: it is cut into {pieces} pieces, and each is a soak");

    /// Soaks are not used.
    SoakLeftOut "soak-left-out" Warning {
        /// The soaks.
        soaks: Vec<String>,
        /// Why.
        why: Phrase,
    }
    decided "Its own calibration failed, is bad, or has no temperature."
    remedy "Look at its own report; mend it and calibrate again."
    says format!("left out: {}: {}", soaks.join(", "), why.0);

    /// In one pose, the bias of the axis that is up and its gain are one number.
    GainInBias "gain-in-bias" Note {
        axis: Axis,
    }
    decided "The recording is in one pose: gravity acts along one axis all the time."
    remedy "Correct a recording of several orientations at one temperature by the result, calibrate from it, and put both together (option `after`). For gains over \
        temperature, hold the sensor in several orientations at each: `calibrant init campaign`."
    says format!(
        "one pose: what temperature does to the bias of {axis} contains what it does to its gain, at 1 g. Gains over temperature stay open, and the accelerometer's biases at the reference: calibrate those at one temperature"
    );
}

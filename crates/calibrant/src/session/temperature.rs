//! Temperatures at which a calibration was not made.

use calibrant_core::sensor::Thermal;

/// Says that temperatures lie far beyond those at which a calibration was made; `None` where they do not.
#[must_use]
pub fn extrapolation_in_words(thermal: &Thermal, [coldest, hottest]: [f64; 2]) -> Option<String> {
    let [low, high] = thermal.range_c?;
    let given = match coldest == hottest {
        true => format!("{coldest:.1}"),
        false => format!("{coldest:.1} to {hottest:.1}"),
    };
    (thermal.extrapolates_to(coldest) || thermal.extrapolates_to(hottest)).then(|| {
        format!(
            "the calibration was made at {low:.1} to {high:.1} °C: its polynomials are extrapolated to {given} °C"
        )
    })
}

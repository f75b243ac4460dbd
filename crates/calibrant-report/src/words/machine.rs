//! The sentences of diagnostics of a sensor on a machine.

use calibrant_core::diagnostic::Diagnostic;

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::MachineResiduals { sensor_kind, ratio } => format!(
            "the residuals of the {sensor_kind} are {ratio:.1} times its noise: the machine does not move as its model and its log say. \
             Model the geometry, trust the log less, fasten the sensor, or look for vibration in the spectrum of the report."
        ),
        Diagnostic::ResidualsCorrelated { parameter, factor } => format!(
            "the residuals are correlated in time, and standard deviations are wider by this: that of {parameter} by a factor of {factor:.1}. \
             Look at the spectrum of the residuals."
        ),
        Diagnostic::PriorContradicted { parameter, deviations } => format!(
            "{parameter} is {deviations:.1} prior standard deviations from what was expected. Correct the nominal value or its standard deviation in [machine]."
        ),
        Diagnostic::LogOutliers { outliers, samples } => format!(
            "{outliers} of {samples} samples of the log are outliers. They have little weight. Look for lost markers, or jumps of the tracker."
        ),
        Diagnostic::LogCoversPart { used_share } => format!(
            "{:.0} % of the sensor's samples are used: the log begins later, ends earlier, or has gaps.",
            100.0 * used_share
        ),
        _ => return None,
    })
}

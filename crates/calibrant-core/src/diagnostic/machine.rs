//! Checks of a sensor on a machine.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{counted, significant};
use crate::sensor::{Axis, SensorKind};

checks! {
    /// The residuals of a sensor on a machine are larger than its noise. The machine does not move as its
    /// model and its log say.
    MachineResiduals "machine-residuals" Warning {
        sensor_kind: SensorKind,
        /// The noise that the residuals show, in parts of that of neighbouring samples.
        ratio: f64,
    }
    decided "The noise that the residuals show exceeds that of neighbouring samples by 10 %; by 25 % where the log \
        is trusted."
    remedy "Model the geometry ([machine.geometry]), trust the log less (trust = \"noisy\"), fasten the sensor, or \
        look for vibration in the report."
    says format!(
        "the residuals of the {sensor_kind} are {ratio:.1} times its noise: the machine does not move as its model and \
         its log say. Model the geometry, trust the log less, fasten the sensor, or look for vibration in the spectrum \
         of the report."
    );

    /// Residuals are correlated in time, as with a tracker's error. The stated standard deviations take it
    /// into account.
    ResidualsCorrelated "residuals-correlated" Note {
        /// The parameter that it widens most.
        parameter: String,
        /// The factor of its standard deviation.
        factor: f64,
    }
    decided "The scores of blocks of time scatter more than independent residuals would let them."
    remedy "Look at the spectrum of the residuals in the report. Model what moves, or improve the reference."
    says format!(
        "the residuals are correlated in time, and standard deviations are wider by this: that of {parameter} by a \
         factor of {factor:.1}. Look at the spectrum of the residuals."
    );

    /// The errors of the reference are mostly not noise, and the model does not have them. How uncertain the result is
    /// hangs on a few blocks of time.
    ReferenceUndermodelled "reference-undermodelled" Warning {
        /// The parameter that it widens most.
        parameter: String,
        /// The factor of its standard deviation.
        factor: f64,
    }
    decided "Correlation of the residuals widens the standard deviation of a parameter of the sensor by more than a factor \
        of three: the reference's errors are ten times as much as noise would be."
    remedy "Look at the spectrum of the residuals in the report. Model what moves, or improve the reference."
    says format!(
        "most of the uncertainty of {parameter} is from errors of the reference that are no noise: its standard deviation \
         is {factor:.1} times that of noise alone. Look at the spectrum of the residuals, model what moves, or improve \
         the reference."
    );

    /// What carries the sensor is not rigid: its readings follow the motion as those of a sensor on something that gives way.
    /// Gains are then wrong by the same amount in every part of the recording.
    MountGivesWay "mount-gives-way" Warning {
        /// What gives way, and with what.
        how: Phrase,
        /// The parameter that it moves most.
        parameter: String,
        /// By how many of its standard deviations.
        deviations: f64,
        /// Probability of such residuals of a rigid mount.
        p_value: f64,
    }
    decided "Terms of a sensor that is displaced or turned with the specific force, the angular acceleration or the square of the rate \
        explain the residuals (F-test by the scatter of blocks of time, p below 0.0001), and move a parameter by more than its standard deviation."
    remedy "Fasten the sensor to what is logged: screws or stiff glue, no foam or tape. Or move more slowly, and compare: \
        option `validate` with a slower recording."
    says format!(
        "the residuals follow {}: the mount gives way, or the machine bends (p-value {p_value:.0e}). That would move {parameter} by \
         {deviations:.1} standard deviations. Fasten the sensor, or record again more slowly.",
        how.0
    );

    /// The residuals of a tracked body are no noise alone, and show no mount that gives way. What one may do within them is in the standard deviations.
    MountAllowedFor "mount-allowed-for" Note {
        /// The codes that it answers.
        codes: Vec<String>,
        /// The parameter that it widens most.
        parameter: String,
        /// The factor of its standard deviation.
        factor: f64,
    }
    decided "A tracked body, whose log is not trusted: residuals are at most twice the noise, at most 2 % of the log are outliers, and none of the \
        terms of `mount-gives-way` is significant. What these terms are, and how uncertain, is added to the covariance."
    says format!(
        "the errors of the tracker are no noise ({}). What the whole recording shares of them is not in their scatter, so the standard deviations \
         include what a mount that gives way could do unseen: that of {parameter} is {factor:.1} times wider.",
        codes.join(", ")
    );

    /// Bias and gain of an axis are one number: the specific force along it hardly varies.
    GainNotSeparable "gain-not-separable" Warning {
        axis: Axis,
        /// Root mean square variation of the specific force along the axis, m/s².
        variation_mps2: f64,
        /// Mean specific force along it, m/s².
        mean_mps2: f64,
        /// The reading at that force, m/s².
        reading_mps2: f64,
        /// Its standard deviation, m/s².
        reading_sd_mps2: f64,
    }
    decided "The specific force along an axis of a tracked body varies by less than a tenth of its mean. An error of the reference then moves bias and gain against \
        each other by more than ten times itself."
    remedy "Turn the sensor so that the axis points up, sideways and down. Until then use bias and gain together only, near this force."
    says format!(
        "bias and gain of the accelerometer's axis {axis} are not separable: the specific force along it is {} m/s² and varies by {} m/s². \
         Well determined is the reading there, {reading_mps2:.4} ± {reading_sd_mps2:.1e} m/s². Turn the sensor so that the axis points \
         up, sideways and down.",
        significant(*mean_mps2, 3),
        significant(*variation_mps2, 2)
    );

    /// The data contradict what was known of the machine beforehand.
    PriorContradicted "prior-contradicted" Warning {
        /// The quantity.
        parameter: String,
        /// Its distance from what was expected, in prior standard deviations.
        deviations: f64,
    }
    decided "A quantity is more than four of its prior standard deviations from what was expected."
    remedy "Correct the nominal value or its standard deviation in [machine]. Check the urdf, the mount and the \
        clocks."
    says format!(
        "{parameter} is {deviations:.1} prior standard deviations from what was expected. Correct the nominal value or \
         its standard deviation in [machine]."
    );

    /// The data refute what was known of the machine beforehand: the result is of another machine or mount than the
    /// one that is described.
    PriorRefuted "prior-refuted" Error {
        /// The quantity.
        parameter: String,
        /// Its distance from what was expected, in prior standard deviations.
        deviations: f64,
    }
    decided "A quantity is more than thirty of its prior standard deviations from what was expected."
    remedy "Correct the nominal value in [machine]. Check the urdf, the mount, the direction up and the clocks."
    says format!(
        "{parameter} is {deviations:.0} prior standard deviations from what was expected: the machine is not the one \
         that [machine] describes. Correct the nominal value. Check the urdf, the mount, the direction up and the clocks."
    );

    /// Recording and log fit where a joint counts the other way.
    JointReversed "joint-reversed" Error {
        /// The joint.
        joint: String,
    }
    decided "Recording and log contradict each other, and with the axis of the joint reversed the residuals are less \
        than half as large."
    remedy "Reverse the axis of the joint in the URDF, or the sign of its column in the log."
    says format!(
        "recording and log fit if the joint {joint} turns or slides the other way. Reverse its axis in the URDF, or the \
         sign of its column in the log."
    );

    /// Recording and log fit where the poses are of another convention.
    PosesOtherwise "poses-otherwise" Error {
        /// The convention, in words.
        convention: Phrase,
    }
    decided "Recording and log contradict each other, and with the poses in one of the usual other conventions the \
        residuals are less than half as large."
    remedy "Write the poses as x, y, z of the body in the world, and the quaternion that turns its axes into the \
        world's, with names of the columns."
    says format!(
        "recording and poses fit if {}. A log has the position of the body in a right-handed world, and the quaternion \
         that turns its axes into the world's.",
        convention.0
    );

    /// Recording and log fit where another direction is up.
    UpOtherwise "up-otherwise" Error {
        /// The value of `up` with which they fit.
        up: Phrase,
    }
    decided "With another axis as `up` the residuals are less than half as large; or they are the same, and the bias of \
        the accelerometer is less than half of gravity and not more."
    remedy "Correct `up` in [machine]."
    says format!(
        "recording and log fit if the direction up is \"{}\". Correct `up` in [machine].",
        up.0
    );

    /// All gains of a sensor are off by one factor: it is of the machine's description, not of the sensor.
    GainsShareFactor "gains-share-factor" Warning {
        sensor_kind: SensorKind,
        /// The factor.
        factor: f64,
    }
    decided "All three gains are more than 5 % off, and differ from each other by less than a third of that. Gains of one \
        sensor are off by per cents, each by its own."
    remedy "Check lever_m in [machine.mount], gravity, the scale of the log, and the unit of the recording."
    says format!(
        "all gains of the {sensor_kind} are {factor:.3} times what they should be: one cause, which is not the sensor. {}, \
         and the unit of the recording.",
        match sensor_kind {
            SensorKind::Accelerometer => "Check lever_m in [machine.mount], gravity, the scale of the log",
            SensorKind::Gyroscope => "Check the scale of the log, the clock's rate",
        }
    );

    /// The matrices of the sensors are turned as a mounting that is wrong would turn them.
    MountingOtherwise "mounting-otherwise" Warning {
        /// Angle between the mounting that was given and the one of the data, rad.
        angle_rad: f64,
        /// The rotation with which the matrices are not turned, as [machine.mount] writes it.
        rotation: Phrase,
        /// Do both sensors show it?
        is_of_both: bool,
    }
    decided "The turn that the matrices share exceeds what the other misalignments of the axes, or the usual ones of 1 %, and \
        the stated mounting explain (p below 0.001)."
    remedy "Correct rotation in [machine.mount], or its rotation_sd_deg. Or give rotation = \"unknown\"."
    says format!(
        "{} turned by {:.2}° against the mounting in [machine.mount], as a wrong mounting turns {}. With rotation = {} \
         it is not. Correct it, or give rotation = \"unknown\".",
        if *is_of_both { "both sensors are" } else { "the sensor is" },
        angle_rad.to_degrees(),
        if *is_of_both { "both" } else { "it" },
        rotation.0
    );

    /// The poses of a log are interpolated. The measured ones take their place.
    PosesInterpolated "poses-interpolated" Note {
        /// Rate of the measured poses, Hz.
        rate_hz: f64,
        /// Their number.
        samples: usize,
    }
    decided "Most poses lie on straight lines between two others, at even steps."
    says format!(
        "the poses are a linear interpolation of a stream at {} Hz. Its {} take their place",
        significant(*rate_hz, 7),
        counted(*samples, "sample")
    );

    /// The log of the machine has outliers. They have little weight.
    LogOutliers "log-outliers" Warning {
        /// Number of outliers.
        outliers: usize,
        /// Number of samples.
        samples: usize,
    }
    decided "More than one sample in a thousand is farther from the spline than eight of its robust standard \
        deviations."
    remedy "Look for lost markers, jumps of the tracker, or a controller that skips."
    says format!(
        "{outliers} of {samples} samples of the log are outliers. They have little weight. Look for lost markers, or \
         jumps of the tracker."
    );

    /// A part of the recording is not used, since the log has no samples there.
    LogCoversPart "log-covers-part" Note {
        /// Share of the sensor's samples that are used.
        used_share: f64,
    }
    decided "The log covers less than 95 % of the sensor's samples: it begins later, ends earlier, or has gaps."
    remedy "Log the whole motion. Samples without a log are lost to the calibration."
    says format!(
        "{:.0} % of the sensor's samples are used: the log begins later, ends earlier, or has gaps.",
        100.0 * used_share
    );
}

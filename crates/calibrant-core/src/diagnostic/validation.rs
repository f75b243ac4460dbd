//! Checks of a validation.

use super::check::checks;
use super::parts::Phrase;
use super::reader::Span;
use crate::number_format::significant;
use nalgebra::Vector3;

checks! {
    /// The errors on data that were not used are larger than predicted.
    ValidationDoubts "validation-doubts" Warning {
        /// What the errors are of.
        what: String,
        /// Errors over prediction.
        factor: f64,
    }
    decided "A validation finds the covariance too small: the 99 % interval of the factor lies above 1, and the \
        factor above 1.25."
    remedy "Read the validation in the report. Multiply the standard deviations by the factor that it names, or \
        find the cause."
    says format!(
        "the validation doubts the covariance: {what} are {} times as large as predicted. Read the validation.",
        significant(*factor, 3)
    );

    /// The calibration is not validated by folds.
    FoldsImpossible "folds-impossible" Warning {
        why: Phrase,
    }
    decided "Without one of the blocks, the recording does not determine the parameters."
    remedy "Ask for fewer folds, or record more."
    says format!("not validated by folds: {}", why.0);

    /// A calibration without temperature terms is tried at another temperature. This is a likely cause of errors that are
    /// larger than predicted.
    TemperatureDiffers "temperature-differs" Note {
        /// Mean temperature of the recording that was calibrated from, °C.
        calibrated_mean_c: f64,
        /// That of the other one, °C.
        mean_c: f64,
    }
    decided "The means differ by 3 K or more, and errors are larger than predicted, or a bias has moved."
    remedy "Calibrate over the temperatures of use, with [temperature]."
    says format!(
        "this recording was made at a mean of {mean_c:.1} °C, the calibration at {calibrated_mean_c:.1} °C and without \
         temperature terms. This is the likely cause of the differences. Calibrate over the temperatures of use, with \
         [temperature]."
    );

    /// The accelerometer has changed since the calibration, which explains that errors are larger than predicted.
    AccelerometerMoved "accelerometer-moved" Note {
        /// Change of the bias, as a specific force, m/s²; `None` where that of the gains alone explains the errors.
        shift_mps2: Option<Vector3<f64>>,
        /// Its predicted standard deviation, m/s².
        shift_sd_mps2: Option<Vector3<f64>>,
        /// Change of the gains, as shares of themselves; `None` where that of the bias alone explains the errors.
        change: Option<Vector3<f64>>,
        /// Its predicted standard deviation.
        change_sd: Option<Vector3<f64>>,
    }
    decided "With another bias, other gains or both, the magnitudes of gravity are as predicted."
    remedy "Calibrate it again."
    says {
        let bias = moved("bias", shift_mps2.zip(*shift_sd_mps2), (1e3, "mm/s²"));
        let gains = moved("gains", change.zip(*change_sd), (100.0, "%"));
        format!(
            "the accelerometer has changed since the calibration: {}. That explains the gravity residuals. Calibrate it again.",
            bias.into_iter().chain(gains).collect::<Vec<_>>().join(" and ")
        )
    };

    /// The gyroscope's gains have changed since the calibration, which explains that errors are larger than predicted.
    GyroscopeGainsMoved "gyroscope-gains-moved" Note {
        /// The change, as shares of themselves.
        change: Vector3<f64>,
        /// Its predicted standard deviation.
        change_sd: Vector3<f64>,
    }
    decided "With other gains, the rotations are as predicted."
    remedy "Calibrate it again."
    says format!(
        "the gyroscope has changed since the calibration (or its clock): {}. That explains the rotation errors. Calibrate it again.",
        moved("gains", Some((*change, *change_sd)), (100.0, "%")).unwrap_or_default()
    );

    /// The gyroscope's readings are most likely in another unit than the stated one.
    AngularUnitWrong "angular-unit-wrong" Note {
        /// Readings times this are in the stated unit: π/180 where they are in deg/s, 180/π where they are in rad/s.
        factor: f64,
    }
    decided "In the other unit, errors of rotations are a tenth or less."
    remedy "Correct the unit."
    says {
        let (size, really, stated) =
            if *factor < 1.0 { ("large", "deg/s", "rad/s") } else { ("small", "rad/s", "deg/s") };
        format!(
            "the gyroscope's readings are 57.3 times too {size}: they are likely in {really}, but stated in {stated}. In \
             {really}, the propagated gravity is right."
        )
    };

    /// Errors as large as predicted confirm nothing: many are left out, and not by chance.
    ErrorsLeftOut "errors-left-out" Note {
        /// What they are of.
        what: &'static str,
        /// Their number.
        count: usize,
        /// When, where they follow each other.
        times: Option<Span>,
        /// Does the calibration leave them out, not the validation?
        by_calibration: bool,
    }
    decided "Three or more follow each other, or more than one in twenty are left out."
    remedy "Look at what happened there. The calibration holds only for the others."
    says format!(
        "{count} {what}s{} are left out{}. They are too many for chance. Did the sensor change there?",
        times.map_or_else(String::new, |of| format!(" in a row, from {:.1} to {:.1} s,", of.start_s, of.end_s)),
        if *by_calibration { " of the calibration" } else { "" }
    );

    /// Errors as large as predicted confirm nothing: the clocks of the two sensors run at different rates.
    GainsOfClock "gains-of-clock" Note {
        /// By how much faster the gyroscope's clock runs.
        skew: f64,
        /// Its standard deviation.
        skew_sd: f64,
    }
    decided "The skew is significant, and larger than that of good clocks."
    remedy "Correct the gyroscope's times: see `clock-skew`."
    says format!(
        "the clocks of the sensors run at different rates, by {:.4} ± {:.4} %. The gains are wrong by this percentage in \
         all rotations alike.",
        100.0 * skew.abs(),
        100.0 * skew_sd
    );
}

/// By how much something has moved, and its standard deviation: `its bias by 1.2, −0.1, 0.3 mm/s² (up to 8 standard deviations)`.
fn moved(
    what: &str,
    moved: Option<(Vector3<f64>, Vector3<f64>)>,
    (scale, unit): (f64, &str),
) -> Option<String> {
    let (by, sd) = moved?;
    let amounts: Vec<String> = by.iter().map(|value| significant(scale * value, 2)).collect();
    let most = significant(by.component_div(&sd).amax(), 2);
    Some(format!("its {what} by {} {unit} (up to {most} standard deviations)", amounts.join(", ")))
}

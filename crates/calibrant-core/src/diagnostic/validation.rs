//! Checks of a validation.

use super::check::checks;
use super::parts::Phrase;
use super::reader::Span;
use crate::number_format::significant;
use crate::sensor::{ReadingUnit, SensorKind};
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

    /// The residuals exceed the noise, and another recording finds the stated standard deviations right all the same.
    ResidualsConfirmed "residuals-confirmed" Note {
        /// The codes that the other recording answers.
        codes: Vec<String>,
        /// The other recording.
        recording: Phrase,
        /// Movements of the parameters over prediction.
        factor: f64,
        /// Speed of the other recording over that of this one.
        speed_ratio: f64,
    }
    decided "On another recording the parameters of every sensor move as far as predicted. `mount-gives-way` is answered only by one \
        whose rms rate or force is at least a third larger or smaller."
    says format!(
        "on {} the parameters move {} times as far as predicted, at {} times the speed. So the standard deviations hold, whatever {} say \
         of the residuals.",
        recording.0,
        significant(*factor, 2),
        significant(*speed_ratio, 2),
        codes.join(", ")
    );

    /// The folds of the same recording agree. That answers no warning.
    FoldsAgree "folds-agree" Note {
        /// The codes that stay.
        codes: Vec<String>,
        /// Movements of the parameters over prediction.
        factor: f64,
    }
    decided "Without each block of time the parameters of every sensor move as far as predicted, no other recording is given, and warnings of the \
        residuals stay."
    remedy "Record again at another speed, and validate with that recording."
    says format!(
        "the folds agree ({} times the predicted movement); a bias that all share is not seen. So {} stay. Record again at another \
         speed, and validate with that recording.",
        significant(*factor, 2),
        codes.join(", ")
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
        let bias = shift_mps2.as_ref().zip(shift_sd_mps2.as_ref()).map(|of| moved(of, (1e3, "mm/s²")));
        let gains = change.as_ref().zip(change_sd.as_ref()).map(|of| moved(of, (100.0, "%")));
        let changes = [("its bias", bias), ("its gains", gains)];
        let changes = changes.into_iter().filter_map(|(what, by)| Some(format!("{what} {}", by?)));
        format!(
            "the accelerometer has changed since the calibration: {}. That explains the gravity residuals. Calibrate it again.",
            changes.collect::<Vec<_>>().join(" and ")
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
        "the gyroscope's gains have changed since the calibration (or its clock) {}. That explains the rotation errors. \
         Calibrate it again.",
        moved((change, change_sd), (100.0, "%"))
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

    /// The noise is another than in the recording that was calibrated from. It is no reason to distrust the calibration.
    NoiseUnlike "noise-unlike" Note {
        sensor_kind: SensorKind,
        /// The scatter of the samples over that in the calibration's recording.
        ratio: f64,
        /// The step of the readings, where it is coarser than their noise.
        step: Option<f64>,
        /// Unit of the step.
        step_unit: Option<ReadingUnit>,
    }
    decided "The ratio is below 0.8 or above 1.25."
    says {
        let differs = match step.zip(*step_unit) {
            Some((step, unit)) => format!(
                "the {sensor_kind}'s readings come in steps of {} {} here, coarser than their noise (a wider range, or \
                 rounded?). They scatter {} times as much as in the calibration's recording. The prediction includes that.",
                significant(step, 2),
                unit.symbol(),
                significant(*ratio, 2)
            ),
            None => format!(
                "the {sensor_kind}'s noise is {} times that of the calibration's recording (another range, bandwidth or \
                 filter?). The prediction uses the noise of this recording.",
                significant(*ratio, 2)
            ),
        };
        format!("{differs} It is no reason to distrust the calibration.")
    };

    /// The gyroscope's bias has moved since the calibration. Rates and rotations are judged with the new one.
    GyroscopeBiasMoved "gyroscope-bias-moved" Note {
        /// By how much, rad/s.
        shift_radps: Vector3<f64>,
        /// Its predicted standard deviation, rad/s.
        shift_sd_radps: Vector3<f64>,
    }
    decided "One so far off would be seen in fewer than one of a hundred recordings."
    remedy "Estimate it again where the gyroscope is used."
    says format!(
        "the gyroscope's bias has moved {} since the calibration. Estimate it again where the gyroscope is used. Rates and \
         rotations are judged with the new bias.",
        moved((shift_radps, shift_sd_radps), (1_f64.to_degrees(), "°/s"))
    );

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

/// By how much something has moved, and its standard deviation: `by 1.2, −0.1, 0.3 mm/s² (up to 8 standard deviations)`.
fn moved((by, sd): (&Vector3<f64>, &Vector3<f64>), (scale, unit): (f64, &str)) -> String {
    let amounts: Vec<String> = by.iter().map(|value| significant(scale * value, 2)).collect();
    let most = significant(by.component_div(sd).amax(), 2);
    format!("by {} {unit} (up to {most} standard deviations)", amounts.join(", "))
}

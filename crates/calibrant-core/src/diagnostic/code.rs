//! The codes of all diagnostics. One table states what each means, how it is decided, and what to do.
//!
//! `docs/diagnostics.md` is made from this table.

use crate::diagnostic::severity::Severity;

/// The entry of a code in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CodeEntry {
    /// Its name, which never changes: `hold-moved`.
    pub name: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// What it means.
    pub meaning: &'static str,
    /// How it is decided.
    pub decided: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

macro_rules! codes {
    ($($code:ident $name:literal $severity:ident $meaning:literal $decided:literal $remedy:literal;)*) => {
        /// The stable name of a diagnostic, like a linter's rule.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = $meaning] $code,)*
        }

        impl Code {
            /// All codes, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$code,)*];

            /// Its entry in the table.
            #[must_use]
            pub fn entry(self) -> CodeEntry {
                match self {
                    $(Self::$code => CodeEntry {
                        name: $name,
                        severity: Severity::$severity,
                        meaning: $meaning,
                        decided: $decided,
                        remedy: $remedy,
                    },)*
                }
            }
        }
    };
}

impl Code {
    /// Its name, which never changes: `hold-moved`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// How much it matters.
    #[must_use]
    pub fn severity(self) -> Severity {
        self.entry().severity
    }

    /// The code of this name.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }
}

codes! {
    NotConverged "not-converged" Error
        "The iteration did not converge. The numbers are the best that it found, not the optimum."
        "The status of the result is not `converged`."
        "Look at the other diagnostics. Record more holds or rotations.";
    Spikes "spikes" Warning
        "Spikes were replaced, or invalid samples were removed."
        "A spike is far from the median of nine neighbouring samples. The limit is 7 robust standard deviations of the difference of two samples, and 12 in a movement."
        "Look for a loose contact, or for bytes that are lost on the way.";
    GyroscopeMissing "gyroscope-missing" Warning
        "The recording of an IMU has no gyroscope. Only the accelerometer was calibrated."
        "The file has no columns of a gyroscope, and no other file gives it."
        "Give its file with --gyroscope, name its columns in [columns], or leave `kind = \"imu\"` out of the experiment file.";
    CoarseSteps "coarse-steps" Warning
        "The readings come in steps of more than twice their noise. The mean of a hold has an error, however long the hold is."
        "Rounding moves the mean of a hold by more than a quarter of the standard deviation that noise gives it."
        "Choose a smaller range, or write more digits to the file.";
    GravityOffEarth "gravity-off-earth" Warning
        "The given gravity occurs nowhere on the Earth. All gains of the accelerometer are wrong by the same ratio."
        "The value lies outside the range of the Earth's surface."
        "Correct holds.gravity_mps2.";
    GravityUnusual "gravity-unusual" Warning
        "The given gravity is not that of the Earth. Results are in the unit that makes it true."
        "The value is below 9.7 or above 9.9 m/s²."
        "Correct holds.gravity_mps2, or read the results in that unit.";
    HoldLeftOut "hold-left-out" Warning
        "A hold is not used."
        "The accelerometer saturates in it, or the magnitude of its mean has too large an error, in standard deviations."
        "Look at the hold in the report. Record with a larger range, or hold the sensor still.";
    HoldsLeftOutInARow "holds-left-out-in-a-row" Warning
        "Several consecutive holds are not used. This is not by chance."
        "So long a run of unused holds is improbable, and no change of the sensor explains it."
        "Calibrate these holds separately (holds.intervals_s) and compare.";
    HoldBeyondRecording "hold-beyond-recording" Warning
        "A given hold reaches beyond the recording."
        "More of it lies outside than rounding of the times explains."
        "Correct holds.intervals_s.";
    HoldMoved "hold-moved" Warning
        "The gyroscope turns in some holds. Its readings there are not used for its bias."
        "Its mean rate in the hold differs from that in the others by more than their scatter."
        "Put the sensor down, and do not hold it by hand. If holds.intervals_s is given, correct or remove it.";
    HoldsLostToFilter "holds-lost-to-filter" Warning
        "Neighbouring samples are strongly correlated, as behind a slow low-pass filter. This breaks up holds."
        "Several segments look stationary but are too short for holds. Samples four apart differ much more than neighbours."
        "Give holds.intervals_s, hold longer, or record with a wider bandwidth.";
    HoldsSpreadLittle "holds-spread-little" Warning
        "The directions of the holds are too similar. The data hardly separate some parameters."
        "The condition number of the scaled information is above 100, and two of these parameters are correlated by more than 0.9."
        "Add holds in other directions.";
    HoldsScatter "holds-scatter" Warning
        "The holds scatter far beyond their noise. The cause is movement, drift, saturation, or a force other than gravity."
        "The standard deviation between holds is more than 20 mm/s²."
        "Hold the sensor still, let it warm up, and check its range.";
    OrientationMissing "orientation-missing" Warning
        "No hold has an axis pointing up, or down."
        "No hold is within 60° of that direction."
        "Add a hold there.";
    NothingToCheck "nothing-to-check" Warning
        "There are as many unknowns as data. No data are left to check the fit."
        "The fit has no degrees of freedom."
        "Add holds, or record more samples.";
    FewDegreesOfFreedom "few-degrees-of-freedom" Warning
        "There are hardly more holds than parameters. The standard deviations themselves are uncertain."
        "The fit has fewer than 5 degrees of freedom."
        "Add holds.";
    NoiseNotAsGiven "noise-not-as-given" Warning
        "The noise within the holds differs from the given noise."
        "Their ratio is below 0.5 or above 2."
        "Correct the noise in the experiment file.";
    ParameterImplausible "parameter-implausible" Error
        "A parameter is far from its nominal value. A mistake is more likely than a rare sensor."
        "The difference exceeds 6 standard deviations of datasheet and estimate together."
        "Check the unit of the recording, gravity, and the order and direction of the axes.";
    FacesTurned "faces-turned" Error
        "All given directions of the holds differ from the accelerometer's by one rotation."
        "Readings in SI show a different axis up than the given one."
        "Correct the directions, unless the sensor is mounted that way.";
    FaceBrief "face-brief" Warning
        "A face was held for only a few samples."
        "It has too few samples for a hold of seconds."
        "Correct its times.";
    FacesScatter "faces-scatter" Warning
        "The faces scatter far beyond their noise."
        "The scatter exceeds that of faces set by hand."
        "Correct directions and times of the holds.";
    TiltContradicted "tilt-contradicted" Warning
        "The face alignment differs from the given one."
        "The χ² of the faces is too large or too small for the given alignment."
        "Correct holds.face_sd_deg.";
    TiltAssumed "tilt-assumed" Warning
        "The faces are too few to estimate their alignment. The program assumes a value."
        "No degrees of freedom are left for it."
        "Give holds.face_sd_deg, or hold more faces.";
    SensorChanged "sensor-changed" Warning
        "A sensor changes within the recording. The estimates are a mean of before and after."
        "A score test of the residuals in the order of time finds a step, a drift or an episode."
        "Calibrate the parts separately (holds.intervals_s) and compare. Let the sensor warm up.";
    SamplesOutsideMotion "samples-outside-motion" Warning
        "Samples lie outside the commanded motion. They are not used."
        "Their times are before its begin or after its end."
        "Check that both clocks start together.";
    MotionNotRecorded "motion-not-recorded" Warning
        "Parts of the commanded motion were not recorded."
        "Intervals without a sample make up more than a tenth of the motion."
        "Record the whole motion.";
    FitWorseThanNoise "fit-worse-than-noise" Warning
        "The fit is worse than the noise explains. The standard deviations are too small."
        "The p-value of χ² is below 0.001."
        "Check the clocks, the commanded motion, and the noise.";
    NoiseImplausible "noise-implausible" Error
        "The noise is far larger than the given noise. The sensor, its unit or the given noise is wrong."
        "The residuals, or the samples within the holds, scatter by more than ten times the given noise."
        "Check the sensor and the unit of the recording. Correct the noise in the experiment file.";
    ModelContradicted "model-contradicted" Error
        "The residuals are far larger than the noise, and systematic. The sensor did not do what the model says."
        "Of a motion, the residuals are more than ten times the given noise, and not white. On a machine, they are more than ten times the noise of neighbouring samples. In holds, the scatter between them exceeds 0.2 m/s²."
        "Check that the motion was the commanded one, both clocks, and the order and direction of the axes.";
    FitBetterThanNoise "fit-better-than-noise" Warning
        "The fit is better than the noise explains. The standard deviations are too large."
        "The p-value of χ² is above 0.999."
        "Correct the noise in the experiment file.";
    ResidualsNotWhite "residuals-not-white" Warning
        "The residuals of an axis are correlated. The model does not explain all of the signal."
        "The p-value of the Ljung–Box test is below 0.0001."
        "Check clocks and motion.";
    EstimateBiased "estimate-biased" Warning
        "An estimate is biased, since the motion is estimated with it."
        "The second-order bias exceeds 0.3 standard deviations."
        "Calibrate on a shorter motion, or with less process noise.";
    WeakerThanDatasheet "weaker-than-datasheet" Warning
        "The recording determines a parameter less well than the datasheet."
        "Its standard deviation exceeds the datasheet's spread."
        "Record for longer, or use a motion that excites the parameter.";
    ScaleNegative "scale-negative" Error
        "A scale factor is negative."
        "The estimate is below zero."
        "Check the direction of the axis.";
    TimeOffset "time-offset" Warning
        "The gyroscope shows movements earlier or later than the accelerometer."
        "The offset is significant, and exceeds both 5 ms and 1.5 sample intervals."
        "Correct the gyroscope's times by the offset.";
    ClockSkew "clock-skew" Warning
        "The clocks of the two sensors run at different rates."
        "The skew is significant, and large enough to affect the result."
        "Correct the gyroscope's times by offset and skew.";
    AxesInOtherOrder "axes-in-other-order" Error
        "The gyroscope's axes are in another order than the accelerometer's."
        "The rotations or turns fit only with that order."
        "Correct the columns, or keep the order in mind.";
    GyroscopeTurned "gyroscope-turned" Warning
        "The gyroscope is mounted with a rotation against the accelerometer."
        "The rotations fit with that mounting, and not with the axes as recorded."
        "Correct the columns, or keep the mounting in mind.";
    RotationLeftOut "rotation-left-out" Warning
        "A rotation is not used."
        "It cannot be integrated, or its rotation error has too many standard deviations."
        "Look at the rotation in the report. Record with a larger range, without pauses.";
    RotationsLeftOutInARow "rotations-left-out-in-a-row" Warning
        "Several consecutive rotations are not used. This is not by chance."
        "So long a run of unused rotations is improbable, and no change of a sensor explains it."
        "Check whether the gyroscope saturates there, or a sensor changes.";
    SamplesLost "samples-lost" Warning
        "Samples are lost, and the times do not show it. The rotations look too small."
        "Between two samples the gyroscope often changes by twice the step before and after."
        "Record without losses, or with times of the sensor's own clock. The gyroscope's gains are too small by the share of lost samples.";
    TurnShare "turn-share" Warning
        "The gyroscope shows the same share of the angle of every turn."
        "The share differs from 1 by more than a quarter, and is the same for all turns."
        "Correct the angle of the turns, the sample rate, or the gyroscope's unit.";
    TurnUnlikeGiven "turn-unlike-given" Warning
        "The gyroscope shows a different turn from the given one."
        "The difference in angle or axis exceeds any error of a sensor."
        "Correct its angle, its axis or its times.";
    TurnContradicted "turn-contradicted" Warning
        "A turn of known angle contradicts the other data."
        "The difference exceeds 4.5 standard deviations."
        "Correct its times, axis and angle.";
    KnownContradicted "known-contradicted" Warning
        "The data contradict the value of a parameter in `[known]`."
        "The difference exceeds 6 standard deviations of the fit without the given values."
        "Correct the value or its unit, or remove it.";
    ChiSquaredLarge "chi-squared-large" Warning
        "The data contradict a given value. The standard deviations are too small."
        "χ² exceeds its degrees of freedom by 6 standard deviations."
        "Check terms in [known], directions, turns and noise.";
    GainImplausible "gain-implausible" Error
        "A gain of readings in SI is far from 1."
        "It is below 0.8 or above 1.25, and the datasheet does not allow for it."
        "Check unit, sample rate, order and direction of the axes, turns and faces.";
    TemperatureExtrapolated "temperature-extrapolated" Warning
        "The recording goes beyond the temperatures of its holds. The polynomials extrapolate there."
        "The coldest or the hottest sample lies far outside."
        "Make holds over the whole range of temperatures.";
    ReferenceExtrapolated "reference-extrapolated" Warning
        "The reference temperature lies beyond the temperatures of the holds."
        "It lies far outside."
        "Choose another reference, or record at that temperature.";
    ValidationDoubts "validation-doubts" Warning
        "The errors on data that were not used are larger than predicted."
        "A validation finds the covariance too small: the 99 % interval of the factor lies above 1, and the factor above 1.25."
        "Read the validation in the report. Multiply the standard deviations by the factor that it names, or find the cause.";
    LimitBroken "limit-broken" Error
        "A limit of `[accept]` is broken."
        "The value lies beyond the limit by more than 1.645 of its standard deviations, or a standard deviation exceeds the largest that is accepted."
        "Do not ship the sensor. Where the standard deviation is too large, record more.";
    LimitTooClose "limit-too-close" Warning
        "A value is too close to a limit of `[accept]` to decide."
        "The value lies within 1.645 of its standard deviations of the limit, on either side (ISO 14253-1)."
        "Record more, so that the standard deviation becomes smaller.";
    LimitNotChecked "limit-not-checked" Warning
        "A limit of `[accept]` is not checked, since the result does not have the value."
        "The calibration does not estimate it, or no validation gives it."
        "Take the limit out, estimate the parameter, or give --validate.";
    NoiseOutliers "noise-outliers" Warning
        "Outliers were removed before the noise was estimated. Or they are too many to remove, and the noise includes them."
        "They are more than 8 robust standard deviations from the median of nine neighbouring samples. Up to one sample in fifty is removed."
        "Look for a loose contact, a lost bit, or a knock.";
    SamplesMissing "samples-missing" Warning
        "Samples are missing. The others are treated as consecutive samples."
        "The sample times have gaps of one or a few intervals."
        "Find the part of the data path that loses samples.";
    SampleTimesVary "sample-times-vary" Warning
        "The sample times vary. Short cluster times are less certain than stated."
        "They vary by more than a fifth of the interval."
        "Take the times from the sensor's clock.";
    NoiseInParts "noise-in-parts" Warning
        "Gaps cut the hold into parts. The longest was examined."
        "A gap is longer than five usual sample intervals."
        "Record without gaps.";
    NoiseDrifts "noise-drifts" Warning
        "An axis drifts. The drift is subtracted."
        "The drift is larger than the noise explains."
        "Let the sensor warm up.";
    NoiseUnexplained "noise-unexplained" Warning
        "No combination of the noise processes explains the Allan deviation."
        "The χ² of the fit is too large."
        "Look for vibration. Do not trust the intervals.";
    NoiseFiltered "noise-filtered" Warning
        "Neighbouring samples are correlated, as behind a filter in the sensor. The stated noise is that before the filter."
        "The noise at short cluster times is below that of white noise."
        "Nothing, if you use means of many samples.";
    ShortTimesUnexplained "short-times-unexplained" Warning
        "No combination of the noise processes explains short cluster times. They are not fitted."
        "The fit is good without them, and not with them."
        "Look for vibration or a filter.";
    NoiseVibration "noise-vibration" Warning
        "The spectrum has a line. The stated noise excludes it."
        "A peak is significant, and has at least a hundredth of the variance of the samples."
        "Look for vibration, or for mains hum.";
    NoiseBeyondWhite "noise-beyond-white" Warning
        "Part of the noise does not average out like independent samples."
        "The standard deviation of the samples exceeds the white noise by 15 %."
        "Take the noise from the Allan deviation, not from the samples.";
    ResolutionCoarse "resolution-coarse" Warning
        "The resolution is coarser than the noise. The stated noise is partly rounding."
        "The smallest step exceeds the standard deviation of the samples."
        "Choose a smaller range, or write more digits to the file.";
    NoiseHoldMoves "noise-hold-moves" Warning
        "The sensor moves in the interval that --hold gives."
        "The holds found in it do not cover all of it."
        "Omit --hold, or choose an interval at rest.";
    ColumnsIgnored "columns-ignored" Note
        "Columns of a recording are not used."
        "They hold nothing that is needed, or they are those of the other file's sensor."
        "Nothing. Name them in [columns] where they are needed.";
    UnitUnexpected "unit-unexpected" Note
        "The recording states another unit than the experiment."
        "The header's unit is compared with that of the experiment."
        "Correct sensor.unit, where the header is right.";
    ValuesMissing "values-missing" Note
        "Rows without a time or a reading were dropped."
        "A field is empty or NaN."
        "Look for what loses values.";
    RowsRepeated "rows-repeated" Note
        "Rows that repeat the one before were dropped."
        "All values are the same."
        "Look at what writes the file.";
    TimesRepeated "times-repeated" Note
        "Rows with the time of the one before were dropped."
        "The time is the same, the readings are not."
        "Write times with more digits.";
    LineTruncated "line-truncated" Note
        "The last line was cut off and was dropped."
        "It has no line end, and too few fields or digits."
        "Nothing.";
    FileUnfinished "file-unfinished" Warning
        "A bag has no end. The later part of the recording may be missing."
        "The container lacks its footer."
        "Copy it again, or use `mcap recover`.";
    SamplingGap "sampling-gap" Note
        "Samples are missing: the time makes a jump."
        "A step of time is longer than five usual ones."
        "Look for what loses samples.";
    SamplingIrregular "sampling-irregular" Note
        "The time steps vary."
        "A step is off the usual one by more than a hundredth."
        "Take the times from the sensor's clock.";
    AxisStuck "axis-stuck" Note
        "An axis never changes."
        "All its readings are the same."
        "Check its connection.";
    AxesEqual "axes-equal" Note
        "Two axes have the same reading in every sample."
        "All readings are compared."
        "Look for a column that was written twice.";
    MachineResiduals "machine-residuals" Warning
        "The residuals of a sensor on a machine are larger than its noise. The machine does not move as its model and its log say."
        "The noise that the residuals show exceeds that of neighbouring samples by 10 %; by 25 % where the log is trusted."
        "Model the geometry ([machine.geometry]), trust the log less (trust = \"noisy\"), fasten the sensor, or look for vibration in the report.";
    ResidualsCorrelated "residuals-correlated" Warning
        "Residuals are correlated in time, as with a tracker's error. The stated standard deviations take it into account."
        "The scores of blocks of time scatter more than independent residuals would let them."
        "Look at the spectrum of the residuals in the report. Model what moves, or improve the reference.";
    PriorContradicted "prior-contradicted" Warning
        "The data contradict what was known of the machine beforehand."
        "A quantity is more than four of its prior standard deviations from what was expected."
        "Correct the nominal value or its standard deviation in [machine]. Check the urdf, the mount and the clocks.";
    LogOutliers "log-outliers" Warning
        "The log of the machine has outliers. They have little weight."
        "More than one sample in a thousand is farther from the spline than eight of its robust standard deviations."
        "Look for lost markers, jumps of the tracker, or a controller that skips.";
    LogCoversPart "log-covers-part" Warning
        "A part of the recording is not used, since the log has no samples there."
        "The log covers less than 95 % of the sensor's samples: it begins later, ends earlier, or has gaps."
        "Log the whole motion. Samples without a log are lost to the calibration.";
    ReadingsClipped "readings-clipped" Note
        "Readings may be saturated."
        "Several in a row have the largest or the smallest value."
        "Record with a larger range.";
    ClockSource "clock-source" Note
        "The sample times are not simply those of a column of seconds."
        "They follow from a counter, a rate or a large time stamp."
        "Check the rate that the message names.";
    ClockDoubtful "clock-doubtful" Warning
        "The times are most likely in another unit."
        "The sample rate would be below 2.5 Hz."
        "Give --time-unit, or correct the name of the column.";
    FileShorter "file-shorter" Note
        "A sensor of a pair of files was recorded for a part of the other's time only."
        "Both cover less than 0.9 of the longer recording."
        "Give the files of one recording.";
    FilesApart "files-apart" Warning
        "The sensors of a pair of files were never recorded at the same time."
        "Their times have nothing in common."
        "Give the files of one recording, with times of one clock.";
    TemperatureGaps "temperature-gaps" Note
        "The temperature is missing in some rows. It is interpolated."
        "It is missing for 30 s at most."
        "Nothing.";
    TemperatureDoubtful "temperature-doubtful" Warning
        "The temperature is missing for long, or implausible."
        "It is missing for more than 30 s, or no sensor works at it."
        "Check the column of the temperature and its unit.";
}

crate::json_name!(Code, Code::ALL);

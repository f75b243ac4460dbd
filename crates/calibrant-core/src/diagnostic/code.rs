//! The codes of all diagnostics: one table of what each means, how it is decided, and what to do.
//!
//! `docs/diagnostics.md` is made from this table.

use crate::diagnostic::severity::Severity;

/// What the table says of a code.
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

            /// What the table says of it.
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
    NotConverged "not-converged" Warning
        "The iteration did not converge. The numbers are the best found, not the optimum."
        "The status of the result is not `converged`."
        "Look at the other diagnostics. Record more holds or rotations.";
    Spikes "spikes" Warning
        "Single samples far off those beside them, or invalid readings, were taken out."
        "A sample is off the median of the nine about it by more than 7 robust standard deviations of the difference of two samples; of a movement by 12."
        "Look for a loose contact, or for bytes that are lost on the way.";
    SkewedSpikes "skewed-spikes" Warning
        "Single samples in the holds are off to one side. They move the means and the bias."
        "The samples beyond 4 standard deviations are far more on one side, and in nearly all holds."
        "Look for a loose contact, or for bytes that are lost on the way.";
    CoarseSteps "coarse-steps" Warning
        "The readings come in steps coarser than twice their noise. The mean of a hold is off, however long it is."
        "The error of a mean by rounding exceeds a quarter of what noise leaves of it."
        "Choose a smaller range, or write more digits to the file.";
    GravityOffEarth "gravity-off-earth" Warning
        "Gravity is given as the Earth has it nowhere. All gains of the accelerometer are off by as much."
        "The value lies outside what the Earth's surface has."
        "Correct holds.gravity_mps2.";
    GravityUnusual "gravity-unusual" Warning
        "Gravity is given as another value than that of the Earth. Results are in its unit."
        "The value is below 9.7 or above 9.9 m/s²."
        "Correct holds.gravity_mps2, or read the results in that unit.";
    HoldLeftOut "hold-left-out" Warning
        "A hold was left out."
        "The accelerometer saturates in it, or the magnitude of its mean is off by too many standard deviations."
        "Look at the hold in the report. Record with a larger range, or hold the sensor still.";
    HoldsLeftOutInARow "holds-left-out-in-a-row" Warning
        "Several holds were left out one after another. That is no chance."
        "So long a run of holds left out is improbable, and no change of the sensor explains it."
        "Calibrate these holds apart (holds.intervals_s) and compare.";
    HoldBeyondRecording "hold-beyond-recording" Warning
        "An interval that was given as a hold reaches beyond the recording."
        "More than a rounding of its times lies outside."
        "Correct holds.intervals_s.";
    HoldMoved "hold-moved" Warning
        "The gyroscope turns in a hold. Its readings there are not taken for its bias."
        "Its mean rate in the hold differs from that in the others by more than their scatter."
        "Correct holds.intervals_s, or leave them away so that holds are looked for.";
    HoldsLostToFilter "holds-lost-to-filter" Warning
        "Neighbouring samples are strongly correlated, as behind a slow low-pass filter. That breaks holds up."
        "Several stretches look still but are no holds, and samples four apart differ much more than neighbours."
        "Give holds.intervals_s, hold longer, or record with a wider bandwidth.";
    HoldsSpreadLittle "holds-spread-little" Warning
        "The orientations of the holds do not spread enough to tell some parameters apart."
        "The condition number of the scaled information is large."
        "Add holds in other orientations.";
    HoldsScatter "holds-scatter" Warning
        "The holds scatter much beyond their noise: something moves, drifts, clips or is not gravity."
        "The standard deviation between holds is more than 20 mm/s²."
        "Hold the sensor still, let it warm up, and check its range.";
    OrientationMissing "orientation-missing" Warning
        "No hold has an axis pointing up, or down."
        "No hold is within 60° of that direction."
        "Add a hold there.";
    NothingToCheck "nothing-to-check" Warning
        "There are as many unknowns as data. Nothing is left to check the fit with."
        "The fit has no degrees of freedom."
        "Add holds, or record more samples.";
    FewDegreesOfFreedom "few-degrees-of-freedom" Warning
        "There are few more holds than parameters. The standard deviations themselves are not well known."
        "The fit has fewer than 5 degrees of freedom."
        "Add holds.";
    NoiseNotAsGiven "noise-not-as-given" Warning
        "The noise within the holds is not the one that was given."
        "The ratio of both is below 0.5 or above 2."
        "Correct the noise in the experiment file.";
    ParameterImplausible "parameter-implausible" Warning
        "A parameter is far from its nominal value. A mistake is more likely than a rare sensor."
        "It is more than 10 datasheet standard deviations off."
        "Check the unit of the recording, gravity, the order and the direction of the axes.";
    FacesTurned "faces-turned" Warning
        "All directions of the holds are turned alike against what the accelerometer shows."
        "Readings in SI show another axis up than was given."
        "Correct the directions, unless the sensor is mounted so.";
    FaceBrief "face-brief" Warning
        "A face was held for a few samples only."
        "It has fewer samples than a face that is held for seconds."
        "Correct its times.";
    FacesScatter "faces-scatter" Warning
        "The faces scatter far beyond their noise."
        "The scatter exceeds what faces by hand have."
        "Correct directions and times of the holds.";
    TiltContradicted "tilt-contradicted" Warning
        "The faces show another tilt than was given."
        "Their χ² with the given tilt is too large or too small by chance."
        "Correct holds.face_sd_deg.";
    TiltAssumed "tilt-assumed" Warning
        "The faces are too few to tell how well they were aligned. A tilt is assumed."
        "The faces leave no degrees of freedom for it."
        "Give holds.face_sd_deg, or hold more faces.";
    SensorChanged "sensor-changed" Warning
        "A sensor changes within the recording. The estimates are a mean of before and after."
        "A score test of the residuals in the order of time finds a step, a drift or an episode."
        "Calibrate the parts apart (holds.intervals_s) and compare. Let the sensor warm up.";
    SamplesOutsideMotion "samples-outside-motion" Warning
        "Samples lie outside the commanded motion. They were not used."
        "Their times are before its begin or after its end."
        "Check that both clocks start together.";
    MotionNotRecorded "motion-not-recorded" Warning
        "Parts of the commanded motion were not recorded."
        "Intervals without a sample make up more than a tenth of the motion."
        "Record the whole motion.";
    FitWorseThanNoise "fit-worse-than-noise" Warning
        "The fit is worse than the noise explains. The standard deviations are too small."
        "The p-value of χ² is below 0.001."
        "Check that both clocks run alike, that the motion was the commanded one, and the noise.";
    FitBetterThanNoise "fit-better-than-noise" Warning
        "The fit is better than the noise explains. The standard deviations are too large."
        "The p-value of χ² is above 0.999."
        "Correct the noise in the experiment file.";
    ResidualsNotWhite "residuals-not-white" Warning
        "The residuals of an axis are correlated. Something is left unmodelled."
        "The p-value of the Ljung–Box test is below 0.0001."
        "Check clocks and motion.";
    EstimateBiased "estimate-biased" Warning
        "The joint estimate of motion and parameters is biased."
        "The second-order bias exceeds 0.3 standard deviations."
        "Calibrate on a shorter motion, or with less process noise.";
    WeakerThanDatasheet "weaker-than-datasheet" Warning
        "The recording says less of a parameter than the datasheet."
        "Its standard deviation exceeds the datasheet's spread."
        "Record longer, or a motion that excites it.";
    ScaleNegative "scale-negative" Warning
        "A scale factor is negative."
        "The estimate is below zero."
        "Check the direction of the axis.";
    TimeOffset "time-offset" Warning
        "The gyroscope shows movements earlier or later than the accelerometer."
        "The offset is certain, and more than 5 ms and 1.5 sample intervals."
        "Correct the gyroscope's times by the offset.";
    ClockSkew "clock-skew" Warning
        "The clocks of the two sensors go at different rates."
        "The skew is certain, and larger than what matters."
        "Correct the gyroscope's times by offset and skew.";
    AxesInOtherOrder "axes-in-other-order" Warning
        "The gyroscope's axes are the accelerometer's in another order."
        "The rotations or turns fit with that order alone."
        "Correct the columns, or keep the order in mind.";
    GyroscopeTurned "gyroscope-turned" Warning
        "The gyroscope is turned against the accelerometer."
        "The rotations fit with that mounting, and not with the axes as recorded."
        "Correct the columns, or keep the mounting in mind.";
    RotationLeftOut "rotation-left-out" Warning
        "A rotation was left out."
        "It cannot be integrated, or it misses gravity by too many standard deviations."
        "Look at the rotation in the report. Record with a larger range, without pauses.";
    RotationsLeftOutInARow "rotations-left-out-in-a-row" Warning
        "Several rotations were left out one after another. That is no chance."
        "So long a run is improbable, and no change of a sensor explains it."
        "Did the gyroscope saturate there, or one of the sensors change?";
    TurnShare "turn-share" Warning
        "The gyroscope shows the same share of the angle of every turn."
        "The share differs from 1 by more than a quarter, and is the same for all turns."
        "Correct the angle of the turns, the sample rate, or the gyroscope's unit.";
    TurnUnlikeGiven "turn-unlike-given" Warning
        "The gyroscope shows another turn than was given."
        "Angle or axis are off by far more than any sensor is."
        "Correct its angle, its axis or its times.";
    TurnContradicted "turn-contradicted" Warning
        "A turn of known angle does not fit the other data."
        "It is off by more than 4.5 standard deviations."
        "Correct its times, axis and angle.";
    KnownContradicted "known-contradicted" Warning
        "The data contradict what `[known]` says of a parameter."
        "It is off by more than 4.5 of its standard deviations, or by 6 of the fit without it."
        "Correct the value and its unit, or leave it out.";
    ChiSquaredLarge "chi-squared-large" Warning
        "The data contradict what was given. The standard deviations are too small."
        "χ² exceeds its degrees of freedom by 6 standard deviations."
        "Check terms in [known], directions, turns and noise.";
    GravityMissedMore "gravity-missed-more" Warning
        "Gravity after a rotation is missed by more than before the calibration."
        "The root mean square of the angles is larger."
        "Check what was given: turns, directions, [known].";
    GainImplausible "gain-implausible" Warning
        "A gain of readings in SI is far from 1."
        "It is below 0.8 or above 1.25."
        "Check unit, sample rate, order and direction of the axes, turns and faces.";
    TemperatureExtrapolated "temperature-extrapolated" Warning
        "The recording goes beyond the temperatures of its holds. There the polynomials extrapolate."
        "The coldest or the hottest sample is far outside."
        "Hold the sensor still over the whole range of temperatures.";
    ReferenceExtrapolated "reference-extrapolated" Warning
        "The reference temperature lies beyond the temperatures of the holds."
        "It is far outside."
        "Choose another reference, or record at that temperature.";
    LatitudeUnknown "latitude-unknown" Warning
        "The Earth's rate is not known without the latitude. Standard deviations become larger."
        "They are more than 1.15 times as large."
        "Give holds.latitude_deg.";
    NoiseOutliers "noise-outliers" Warning
        "Samples far off the others were left out of the noise."
        "They are off the median of the nine about them by more than 8 robust standard deviations."
        "Look for a loose contact, a lost bit, or a knock.";
    NoiseSpikes "noise-spikes" Warning
        "There are too many spikes to leave them out. The noise is theirs."
        "More than one sample in fifty is an outlier."
        "Look for a loose contact, or for bits that are lost on the way.";
    SamplesMissing "samples-missing" Warning
        "Samples are missing. The others are taken as if they followed one another."
        "The sample times have holes of one or a few intervals."
        "Look for what loses samples.";
    SampleTimesVary "sample-times-vary" Warning
        "The sample times vary. Short cluster times are less certain than stated."
        "They vary by more than a fifth of the interval."
        "Take the times from the sensor's clock.";
    NoiseInParts "noise-in-parts" Warning
        "Gaps cut the hold into parts. The longest was examined."
        "A step of time is longer than five usual ones."
        "Record without gaps.";
    NoiseDrifts "noise-drifts" Warning
        "An axis drifts. The drift was subtracted."
        "It is more than its noise explains."
        "Let the sensor warm up.";
    NoiseUnexplained "noise-unexplained" Warning
        "No sum of the processes explains the Allan deviation."
        "The χ² of the fit is too large."
        "Look for vibration. Do not trust the intervals.";
    NoiseFiltered "noise-filtered" Warning
        "Neighbouring samples are correlated, as behind a filter in the sensor. The noise is that before the filter."
        "Short cluster times have less noise than white noise gives."
        "Nothing, where means of many samples are used.";
    ShortTimesUnexplained "short-times-unexplained" Warning
        "No sum of the processes explains short cluster times. They were not fitted."
        "The fit is good only without them."
        "Look for vibration or a filter.";
    NoiseVibration "noise-vibration" Warning
        "The spectrum has a line. The noise is that beside it."
        "A peak is beyond chance, and has a hundredth of the variance of the samples."
        "Look for vibration, or the hum of the mains.";
    NoiseBeyondWhite "noise-beyond-white" Warning
        "Part of the noise does not average out like independent samples."
        "The standard deviation of the samples exceeds the white noise by 15 %."
        "Take the noise from the Allan deviation, not from the samples.";
    ResolutionCoarse "resolution-coarse" Warning
        "The resolution is coarser than the noise. What is stated is rounding as much as noise."
        "The smallest step exceeds the standard deviation of the samples."
        "Choose a smaller range, or write more digits to the file.";
    NoiseHoldMoves "noise-hold-moves" Warning
        "The sensor moves in the interval that was given as at rest."
        "Holds that are found in it leave part of it uncovered."
        "Leave --hold away, or choose an interval at rest.";
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

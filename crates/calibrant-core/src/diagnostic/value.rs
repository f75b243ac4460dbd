//! What a user should know about a result, as values.
//!
//! A diagnostic has a code, a subject and numbers. Its sentence is made by `calibrant_report::message`.

use crate::diagnostic::change::Change;
use crate::diagnostic::code::Code;
use crate::diagnostic::faces::{FaceMismatch, FacePointing};
use crate::diagnostic::hold_span::{HoldLeftOut, HoldSpan};
use crate::diagnostic::known::KnownMismatch;
use crate::diagnostic::limit_miss::LimitMiss;
use crate::diagnostic::lost_holds::LostHolds;
use crate::diagnostic::parts::{Part, Parts};
use crate::diagnostic::rotation_reason::RotationReason;
use crate::diagnostic::severity::Severity;
use crate::diagnostic::turn::{TurnMismatch, TurnSpan, UnitMistake};
use crate::sensor::{Axis, ReadingUnit, SensorKind};

macro_rules! diagnostics {
    ($($(#[$meta:meta])* $code:ident { $($field:ident: $kind:ty = $doc:literal),* $(,)? })*) => {
        /// What a user should know about a result.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub enum Diagnostic {
            $(
                $(#[$meta])*
                $code {
                    $(#[doc = $doc] $field: $kind,)*
                },
            )*
        }

        impl Diagnostic {
            /// Its code.
            #[must_use]
            pub fn code(&self) -> Code {
                match self {
                    $(Self::$code { .. } => Code::$code,)*
                }
            }

            fn parts(&self) -> Parts {
                let mut parts = Parts::default();
                match self {
                    $(Self::$code { $($field),* } => { $($field.add_to(&mut parts, stringify!($field));)* })*
                }
                parts
            }
        }
    };
}

impl Diagnostic {
    /// How much it matters.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.code().severity()
    }

    /// Its subject, such as `gyroscope axis x` or `hold 3`. `None`: the whole result.
    #[must_use]
    pub fn subject(&self) -> Option<String> {
        let subject = self.parts().subject;
        (!subject.is_empty()).then(|| subject.join(" "))
    }

    /// Its numbers by name. Names end in the unit where there is one.
    #[must_use]
    pub fn numbers(&self) -> Vec<(&'static str, f64)> {
        self.parts().numbers
    }
}

diagnostics! {
    /// The iteration did not converge.
    NotConverged { status: &'static str = "The status." }
    /// Spikes were replaced, or invalid samples removed.
    Spikes {
        sensor_kind: SensorKind = "The sensor.",
        unit: ReadingUnit = "Unit of its readings.",
        replaced: usize = "Number of samples that were replaced.",
        cut: usize = "Number of samples that were removed.",
        axis: Axis = "Axis of the sample that is farthest from its neighbours.",
        reading: f64 = "Its reading.",
        time_s: f64 = "Its time, s.",
        deviations: f64 = "Its distance from its neighbours, in standard deviations of a sample's noise. Infinite where the noise is zero.",
    }
    /// The recording of an IMU has no gyroscope.
    GyroscopeMissing {}
    /// Readings come in coarse steps.
    CoarseSteps {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        step: f64 = "The step.",
        noise: f64 = "The noise before rounding, or 0 where it is too small to be seen.",
        mean_sd: f64 = "Error of the mean of a hold.",
    }
    /// The given gravity occurs nowhere on the Earth.
    GravityOffEarth {
        gravity_mps2: f64 = "Gravity as given, m/s².",
        least_mps2: f64 = "The least on the Earth's surface, m/s².",
        most_mps2: f64 = "The most on the Earth's surface, m/s².",
    }
    /// The given gravity is unusual.
    GravityUnusual { gravity_mps2: f64 = "Gravity as given, m/s²." }
    /// A hold is not used.
    HoldLeftOut { hold: HoldSpan = "The hold.", why: HoldLeftOut = "Why." }
    /// Consecutive holds are not used.
    HoldsLeftOutInARow {
        holds: usize = "Number of holds.",
        start_s: f64 = "Begin of the first, s.",
        end_s: f64 = "End of the last, s.",
    }
    /// A hold reaches beyond the recording.
    HoldBeyondRecording {
        hold: usize = "Its number, from 1.",
        start_s: f64 = "Its begin as given, s.",
        end_s: f64 = "Its end as given, s.",
        recording_start_s: f64 = "First sample of the recording, s.",
        recording_end_s: f64 = "Last sample of the recording, s.",
        common_s: f64 = "Duration within the recording, s.",
    }
    /// The gyroscope turns in holds.
    HoldMoved {
        holds: Vec<HoldSpan> = "The holds.",
        rate_rms: f64 = "Root mean square of the rate in the fastest.",
        unit: ReadingUnit = "Unit of the rate.",
        are_given: bool = "Are the intervals of the holds given?",
    }
    /// A low-pass filter breaks up holds.
    HoldsLostToFilter { lost: LostHolds = "Their number." }
    /// The directions of the holds are too similar.
    HoldsSpreadLittle { condition_number: f64 = "Condition number.", parameters: Vec<String> = "The parameters that the data hardly separate." }
    /// The holds scatter beyond their noise.
    HoldsScatter { between_holds_sd_mps2: f64 = "Standard deviation between holds, m/s²." }
    /// No hold has these directions.
    OrientationMissing { missing: Vec<FacePointing> = "The directions." }
    /// No data are left to check the fit.
    NothingToCheck {
        holds: Option<usize> = "Number of holds, where the recording consists of holds.",
        parameters: usize = "Number of parameters.",
    }
    /// The fit has few degrees of freedom.
    FewDegreesOfFreedom { degrees_of_freedom: usize = "Their number." }
    /// The noise within holds differs from the given noise.
    NoiseNotAsGiven {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis with the largest difference.",
        ratio: f64 = "Noise within the holds over the given noise.",
    }
    /// A parameter is far from its nominal value.
    ParameterImplausible { parameter: String = "Its name.", deviations: f64 = "The difference, in standard deviations of datasheet and estimate together." }
    /// All given directions of the holds differ by one rotation from the accelerometer's.
    FacesTurned { faces: Vec<FaceMismatch> = "The holds." }
    /// A face was held for only a few samples.
    FaceBrief { hold: HoldSpan = "The hold.", samples: usize = "Its samples." }
    /// The faces scatter.
    FacesScatter {
        tilt_rad: f64 = "Scatter of their directions, rad.",
        along_mps2: f64 = "Scatter along gravity, m/s².",
        worst_rad: f64 = "Largest error, rad.",
        worst: Vec<HoldSpan> = "The faces with the largest error.",
    }
    /// The face alignment differs from the given one.
    TiltContradicted { shown_rad: f64 = "Standard deviation of the tilt that the faces show, rad.", given_rad: f64 = "Given standard deviation of the tilt, rad." }
    /// The face alignment is assumed.
    TiltAssumed { faces: usize = "Number of faces.", tilt_rad: f64 = "Standard deviation of the tilt, rad." }
    /// A sensor changes within the recording.
    SensorChanged {
        change: Change = "The change.",
        coldest_c: Option<f64> = "The coldest sample, °C. `None`: the temperature is unknown, or the model follows it.",
        hottest_c: Option<f64> = "The hottest sample, °C.",
    }
    /// Samples lie outside the motion.
    SamplesOutsideMotion {
        outside: usize = "Number of samples outside.",
        samples: usize = "Number of samples.",
        motion_start_s: f64 = "Begin of the motion, s.",
        motion_end_s: f64 = "End of the motion, s.",
    }
    /// Parts of the motion were not recorded.
    MotionNotRecorded { empty_s: f64 = "Duration of the intervals without a sample, s.", motion_s: f64 = "Duration of the motion, s." }
    /// The fit is worse than the noise explains.
    FitWorseThanNoise {
        p_value: f64 = "p-value of χ².",
        noise_ratio: f64 = "Residual noise over the assumed one.",
        is_white: bool = "Are the residuals white?",
    }
    /// The noise is far larger than the given one.
    NoiseImplausible {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis with the largest ratio.",
        ratio: f64 = "The noise that was found over the given noise.",
    }
    /// The residuals refuse the model.
    ModelContradicted {
        sensor_kind: SensorKind = "The sensor.",
        ratio: f64 = "The residuals over the noise, or over what holds may scatter.",
    }
    /// The fit is better than the noise explains.
    FitBetterThanNoise { p_value: f64 = "p-value of χ².", noise_ratio: f64 = "Residual noise over the assumed one." }
    /// Residuals are not white.
    ResidualsNotWhite { axis: Axis = "The axis.", p_value: f64 = "p-value of the Ljung–Box test." }
    /// An estimate is biased, since the motion is estimated with it.
    EstimateBiased { parameter: String = "The parameter with the largest bias.", deviations: f64 = "The bias, in standard deviations." }
    /// The recording determines parameters less well than the datasheet.
    WeakerThanDatasheet { parameters: Vec<String> = "The parameters." }
    /// A scale factor is negative.
    ScaleNegative { axis: Axis = "The axis." }
    /// The gyroscope's times have an offset.
    TimeOffset {
        offset_s: f64 = "By how much the gyroscope is late, s.",
        offset_sd_s: f64 = "Its standard deviation, s.",
    }
    /// The clocks run at different rates.
    ClockSkew {
        first_offset_s: f64 = "By how much the gyroscope is late at its first sample, s.",
        last_offset_s: f64 = "By how much the gyroscope is late at its last sample, s.",
        skew: f64 = "How much later it becomes with each second.",
        skew_sd: f64 = "Its standard deviation.",
    }
    /// The gyroscope's axes are in another order.
    AxesInOtherOrder {
        order: [String; 3] = "The gyroscope's axis along each of the accelerometer's.",
        by_turns: bool = "Do turns of known angle show it?",
    }
    /// The gyroscope is mounted with a rotation against the accelerometer.
    GyroscopeTurned {
        angle_rad: f64 = "Angle of the rotation, rad.",
        about_x: f64 = "Axis of the rotation, along x.",
        about_y: f64 = "Axis of the rotation, along y.",
        about_z: f64 = "Axis of the rotation, along z.",
        is_mirrored: bool = "Do its axes point the opposite way?",
    }
    /// A rotation is not used.
    RotationLeftOut {
        from_hold: usize = "Number of the hold before it, from 1.",
        to_hold: usize = "Number of the hold after it, from 1.",
        start_s: f64 = "Begin, s.",
        end_s: f64 = "End, s.",
        error_rad: Option<f64> = "Rotation error, rad, where the rotation can be integrated.",
        deviations: Option<f64> = "The rotation error in its expected standard deviations.",
        reason: RotationReason = "Why.",
    }
    /// Consecutive rotations are not used.
    RotationsLeftOutInARow {
        rotations: usize = "Their number.",
        start_s: f64 = "Begin of the first, s.",
        end_s: f64 = "End of the last, s.",
    }
    /// Samples are lost, and the times do not show it.
    SamplesLost { lost_share: f64 = "Share of the samples.", jumps: usize = "Jumps by one whole step." }
    /// The residuals of a sensor on a machine are larger than its noise.
    MachineResiduals { sensor_kind: SensorKind = "The sensor.", ratio: f64 = "The noise that the residuals show, in parts of that of neighbouring samples." }
    /// Residuals on a machine are correlated in time.
    ResidualsCorrelated { parameter: String = "The parameter that it widens most.", factor: f64 = "The factor of its standard deviation." }
    /// The data contradict what was known of the machine.
    PriorContradicted { parameter: String = "The quantity.", deviations: f64 = "Its distance from what was expected, in prior standard deviations." }
    /// The log of the machine has outliers.
    LogOutliers { outliers: usize = "Number of outliers.", samples: usize = "Number of samples." }
    /// The log covers a part of the recording only.
    LogCoversPart { used_share: f64 = "Share of the sensor's samples that are used." }
    /// All turns show the same share of their angle.
    TurnShare { share: f64 = "The share.", mistake: Option<UnitMistake> = "The mistake of units that explains the share." }
    /// The gyroscope shows a different turn from the given one.
    TurnUnlikeGiven { turn: TurnMismatch = "The turn.", mistake: Option<UnitMistake> = "The mistake of units that explains the difference." }
    /// A turn contradicts the other data.
    TurnContradicted {
        turn: TurnSpan = "The turn.",
        angle_rad: f64 = "Its angle as given, rad.",
        deviations: f64 = "The difference, in standard deviations.",
    }
    /// The data contradict the given value of a parameter.
    KnownContradicted { known: KnownMismatch = "The parameter." }
    /// The data contradict a given value.
    ChiSquaredLarge { chi2: f64 = "χ².", degrees_of_freedom: f64 = "Degrees of freedom." }
    /// A gain is implausible.
    GainImplausible {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        gain: f64 = "The gain along the axis.",
        unit: ReadingUnit = "Unit of the readings.",
    }
    /// The errors of a validation are larger than predicted.
    ValidationDoubts { what: String = "What the errors are of.", factor: f64 = "Errors over prediction." }
    /// A limit of `[accept]` is broken.
    LimitBroken { limit: LimitMiss = "The limit." }
    /// A value is too close to a limit of `[accept]`.
    LimitTooClose { limit: LimitMiss = "The limit." }
    /// A limit of `[accept]` is not checked.
    LimitNotChecked { name: String = "Its name." }
    /// The recording goes beyond the temperatures of its holds.
    TemperatureExtrapolated {
        coldest_c: f64 = "Lowest temperature of the recording, °C.",
        hottest_c: f64 = "Highest temperature of the recording, °C.",
        holds_coldest_c: f64 = "Coldest of the holds, °C.",
        holds_hottest_c: f64 = "Hottest of the holds, °C.",
    }
    /// The reference temperature lies beyond those of the holds.
    ReferenceExtrapolated {
        reference_c: f64 = "The reference, °C.",
        holds_coldest_c: f64 = "Coldest of the holds, °C.",
        holds_hottest_c: f64 = "Hottest of the holds, °C.",
    }
    /// Outliers were removed before the noise was estimated, or are too many for that.
    NoiseOutliers {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        outliers: usize = "Their number.",
        samples: usize = "Number of samples.",
        reading: f64 = "Reading of the sample that is farthest from its neighbours.",
        time_s: f64 = "Its time, s.",
        deviations: f64 = "Its distance from its neighbours, in usual differences of two samples.",
        left_out: bool = "Were they removed? They are not where they are too many.",
        white_noise_ratio: Option<f64> = "White noise with the outliers over white noise without them.",
    }
    /// Samples are missing.
    SamplesMissing { missing_share: f64 = "Share of the samples." }
    /// The sample times vary.
    SampleTimesVary { jitter: f64 = "Largest variation, as a share of the interval." }
    /// Gaps cut the hold.
    NoiseInParts { parts: usize = "Number of parts.", longest_s: f64 = "Duration of the longest part, s." }
    /// An axis drifts.
    NoiseDrifts {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        drift_per_s: f64 = "Drift in one second.",
        deviations: f64 = "The drift, in standard deviations of the drift that its noise explains.",
    }
    /// No combination of the noise processes explains the Allan deviation.
    NoiseUnexplained {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        chi2: f64 = "χ².",
        degrees_of_freedom: usize = "Degrees of freedom.",
    }
    /// Neighbouring samples are correlated.
    NoiseFiltered {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        correlated_s: f64 = "Samples closer in time than this are correlated, s.",
    }
    /// Short cluster times are not fitted.
    ShortTimesUnexplained {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        shortest_tau_s: f64 = "Shortest cluster time of the fit, s.",
    }
    /// The spectrum has a line.
    NoiseVibration {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        frequency_hz: f64 = "Its frequency, Hz.",
        share: f64 = "Its share of the variance of the samples.",
        of_white: f64 = "Its share of N².",
    }
    /// Part of the noise does not average out.
    NoiseBeyondWhite {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        sample_sd: f64 = "Standard deviation of the samples.",
        white_noise: f64 = "The white noise.",
    }
    /// The resolution is coarser than the noise.
    ResolutionCoarse {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        step: f64 = "The smallest step.",
    }
    /// The sensor moves in the given interval.
    NoiseHoldMoves { moving_s: f64 = "For how long it moves, s.", given_s: f64 = "Duration of the interval, s." }
}

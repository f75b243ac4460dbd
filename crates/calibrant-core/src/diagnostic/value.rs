//! What a user should know about a result, as values.
//!
//! A diagnostic has a code, what it is about, and numbers. It has no sentence: `calibrant_report::message` makes that.

use crate::diagnostic::change::Change;
use crate::diagnostic::code::Code;
use crate::diagnostic::faces::{FaceMismatch, FacePointing};
use crate::diagnostic::hold_span::{HoldLeftOut, HoldSpan};
use crate::diagnostic::known::KnownMismatch;
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

    /// What it is about: `gyroscope axis x`, `hold 3`; `None` where that is the whole result.
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
    /// Spikes and invalid readings were taken out.
    Spikes {
        sensor_kind: SensorKind = "The sensor.",
        unit: ReadingUnit = "Unit of its readings.",
        replaced: usize = "Samples that were replaced.",
        cut: usize = "Samples that were cut out.",
        axis: Axis = "Axis of the one that is farthest off.",
        reading: f64 = "Its reading.",
        time_s: f64 = "Its time, s.",
        deviations: f64 = "How far it is off, in standard deviations of a sample's noise; infinite where there is none.",
    }
    /// Readings come in coarse steps.
    CoarseSteps {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        step: f64 = "The step.",
        noise: f64 = "The noise before rounding; 0 where it is too small to be seen.",
        mean_sd: f64 = "By how much the mean of a hold is off.",
    }
    /// Gravity is given as the Earth has it nowhere.
    GravityOffEarth {
        gravity_mps2: f64 = "Gravity as given, m/s².",
        least_mps2: f64 = "The least on the Earth's surface, m/s².",
        most_mps2: f64 = "The most on the Earth's surface, m/s².",
    }
    /// Gravity is given as an unusual value.
    GravityUnusual { gravity_mps2: f64 = "Gravity as given, m/s²." }
    /// A hold was left out.
    HoldLeftOut { hold: HoldSpan = "The hold.", why: HoldLeftOut = "Why." }
    /// Holds were left out one after another.
    HoldsLeftOutInARow {
        holds: usize = "How many.",
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
        common_s: f64 = "What counts of it, s.",
    }
    /// The gyroscope turns in a hold.
    HoldMoved { hold: HoldSpan = "The hold.", rate_rms: f64 = "Root mean square of its rate.", unit: ReadingUnit = "Unit of the rate." }
    /// A low-pass filter breaks holds up.
    HoldsLostToFilter { lost: LostHolds = "How many." }
    /// The holds do not spread enough.
    HoldsSpreadLittle { condition_number: f64 = "Condition number.", parameters: Vec<String> = "What can hardly be told apart." }
    /// The holds scatter beyond their noise.
    HoldsScatter { between_holds_sd_mps2: f64 = "Standard deviation between holds, m/s²." }
    /// No hold has these orientations.
    OrientationMissing { missing: Vec<FacePointing> = "The orientations." }
    /// Nothing is left to check the fit with.
    NothingToCheck {
        holds: Option<usize> = "How many holds, where there are holds.",
        parameters: usize = "How many parameters.",
    }
    /// The fit has few degrees of freedom.
    FewDegreesOfFreedom { degrees_of_freedom: usize = "How many." }
    /// The noise within holds is not the one that was given.
    NoiseNotAsGiven {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        ratio: f64 = "Noise within the holds over that which was given.",
    }
    /// A parameter is far from its nominal value.
    ParameterImplausible { parameter: String = "Its name.", deviations: f64 = "By how many datasheet standard deviations." }
    /// All directions of the holds are turned alike.
    FacesTurned { faces: Vec<FaceMismatch> = "The holds." }
    /// A face was held for a few samples only.
    FaceBrief { hold: HoldSpan = "The hold.", samples: usize = "Its samples." }
    /// The faces scatter.
    FacesScatter {
        tilt_rad: f64 = "Scatter of their directions, rad.",
        along_mps2: f64 = "Scatter along gravity, m/s².",
        worst_rad: f64 = "By how much the worst is off, rad.",
        worst: Vec<HoldSpan> = "Those that fit least.",
    }
    /// The faces show another tilt than was given.
    TiltContradicted { shown_rad: f64 = "The tilt that they show, rad.", given_rad: f64 = "The tilt that was given, rad." }
    /// A tilt is assumed.
    TiltAssumed { faces: usize = "How many faces.", tilt_rad: f64 = "The tilt, rad." }
    /// A sensor changes within the recording.
    SensorChanged {
        change: Change = "The change.",
        coldest_c: Option<f64> = "The coldest sample, °C, where temperatures are known and nothing follows them.",
        hottest_c: Option<f64> = "The hottest sample, °C.",
    }
    /// Samples lie outside the motion.
    SamplesOutsideMotion {
        outside: usize = "How many.",
        samples: usize = "How many there are.",
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
    /// The fit is better than the noise explains.
    FitBetterThanNoise { p_value: f64 = "p-value of χ².", noise_ratio: f64 = "Residual noise over the assumed one." }
    /// Residuals are not white.
    ResidualsNotWhite { axis: Axis = "The axis.", p_value: f64 = "p-value of the Ljung–Box test." }
    /// The joint estimate is biased.
    EstimateBiased { parameter: String = "The parameter that is biased most.", deviations: f64 = "By how many standard deviations." }
    /// The recording says less than the datasheet.
    WeakerThanDatasheet { parameters: Vec<String> = "Of these parameters." }
    /// A scale factor is negative.
    ScaleNegative { axis: Axis = "The axis." }
    /// The gyroscope's times are off.
    TimeOffset {
        offset_s: f64 = "By how much the gyroscope is late, s.",
        offset_sd_s: f64 = "Its standard deviation, s.",
    }
    /// The clocks go at different rates.
    ClockSkew {
        first_offset_s: f64 = "By how much the gyroscope is late at its first sample, s.",
        last_offset_s: f64 = "By how much it is late at its last sample, s.",
        skew: f64 = "How much later it becomes with each second.",
        skew_sd: f64 = "Its standard deviation.",
    }
    /// The gyroscope's axes are in another order.
    AxesInOtherOrder {
        order: [String; 3] = "The gyroscope's axis along each of the accelerometer's.",
        by_turns: bool = "Do turns of known angle show it?",
    }
    /// The gyroscope is turned against the accelerometer.
    GyroscopeTurned {
        angle_rad: f64 = "By this angle, rad.",
        about_x: f64 = "Axis of the turn, along x.",
        about_y: f64 = "Axis of the turn, along y.",
        about_z: f64 = "Axis of the turn, along z.",
        is_mirrored: bool = "Do its axes point the other way?",
    }
    /// A rotation was left out.
    RotationLeftOut {
        from_hold: usize = "Number of the hold before it, from 1.",
        to_hold: usize = "Number of the hold after it, from 1.",
        start_s: f64 = "Begin, s.",
        end_s: f64 = "End, s.",
        error_rad: Option<f64> = "By how much it misses gravity, rad, where it can be integrated.",
        deviations: Option<f64> = "The same in standard deviations expected of it.",
        reason: RotationReason = "Why.",
    }
    /// Rotations were left out one after another.
    RotationsLeftOutInARow {
        rotations: usize = "How many.",
        start_s: f64 = "Begin of the first, s.",
        end_s: f64 = "End of the last, s.",
    }
    /// All turns show the same share of their angle.
    TurnShare { share: f64 = "The share.", mistake: Option<UnitMistake> = "The mistake of units that the share tells." }
    /// A turn is another one than was given.
    TurnUnlikeGiven { turn: TurnMismatch = "The turn.", mistake: Option<UnitMistake> = "The mistake of units that tells why." }
    /// A turn does not fit the other data.
    TurnContradicted {
        turn: TurnSpan = "The turn.",
        angle_rad: f64 = "Its angle as given, rad.",
        deviations: f64 = "By how many standard deviations it is off.",
    }
    /// The data contradict what is known of a parameter.
    KnownContradicted { known: KnownMismatch = "The parameter." }
    /// The data contradict what was given.
    ChiSquaredLarge { chi2: f64 = "χ².", degrees_of_freedom: f64 = "Degrees of freedom." }
    /// A gain is implausible.
    GainImplausible {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        gain: f64 = "The gain along the axis.",
        unit: ReadingUnit = "Unit of the readings.",
    }
    /// The recording goes beyond the temperatures of its holds.
    TemperatureExtrapolated {
        coldest_c: f64 = "Coldest of the recording, °C.",
        hottest_c: f64 = "Hottest of the recording, °C.",
        holds_coldest_c: f64 = "Coldest of the holds, °C.",
        holds_hottest_c: f64 = "Hottest of the holds, °C.",
    }
    /// The reference temperature lies beyond those of the holds.
    ReferenceExtrapolated {
        reference_c: f64 = "The reference, °C.",
        holds_coldest_c: f64 = "Coldest of the holds, °C.",
        holds_hottest_c: f64 = "Hottest of the holds, °C.",
    }
    /// An unknown latitude makes standard deviations larger.
    LatitudeUnknown {
        earth_rate_radps: f64 = "The Earth's rate, rad/s.",
        of_g_sensitivity: bool = "Is it the g-sensitivity that suffers most, and not the gyroscope's matrix?",
        times: f64 = "How many times larger they are.",
    }
    /// Outliers are in the noise, or were left out of it.
    NoiseOutliers {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        outliers: usize = "How many.",
        samples: usize = "Of how many samples.",
        reading: f64 = "The one that is farthest off.",
        time_s: f64 = "Its time, s.",
        deviations: f64 = "How far it is off, in usual differences of two samples.",
        left_out: bool = "Were they left out? Not where they are too many.",
        white_noise_ratio: Option<f64> = "White noise with them over that without.",
    }
    /// Samples are missing.
    SamplesMissing { missing_share: f64 = "Their share." }
    /// The sample times vary.
    SampleTimesVary { jitter: f64 = "By this share of the interval." }
    /// Gaps cut the hold.
    NoiseInParts { parts: usize = "How many parts.", longest_s: f64 = "The longest, s." }
    /// An axis drifts.
    NoiseDrifts {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        unit: ReadingUnit = "Unit of its readings.",
        drift_per_s: f64 = "By how much in a second.",
        deviations: f64 = "The same in standard deviations of what its noise explains.",
    }
    /// No sum of the processes explains the Allan deviation.
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
        correlated_s: f64 = "Samples less apart than this are correlated, s.",
    }
    /// Short cluster times were not fitted.
    ShortTimesUnexplained {
        sensor_kind: SensorKind = "The sensor.",
        axis: Axis = "The axis.",
        shortest_tau_s: f64 = "The shortest that was, s.",
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
    /// The sensor moves in the interval that was given.
    NoiseHoldMoves { moving_s: f64 = "For how long it moves, s.", given_s: f64 = "Duration of the interval, s." }
}

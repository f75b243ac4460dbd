//! The codes of all refusals: one table of what each means, and what to do.
//!
//! `docs/diagnostics.md` is made from this table.

macro_rules! refusals {
    ($($code:ident $name:literal $meaning:literal $remedy:literal;)*) => {
        /// The stable name of a refusal. Each asks for one action of the user; the message says more.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Refusal {
            $(#[doc = $meaning] $code,)*
        }

        impl Refusal {
            /// All refusals, in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$code,)*];

            /// Its name, which never changes: `column-missing`.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$code => $name,)*
                }
            }

            /// What it means.
            #[must_use]
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$code => $meaning,)*
                }
            }

            /// What to do.
            #[must_use]
            pub fn remedy(self) -> &'static str {
                match self {
                    $(Self::$code => $remedy,)*
                }
            }
        }
    };
}

refusals! {
    FileUnreadable "file-unreadable"
        "A file is missing, is a directory, is too large, or may not be read."
        "Check its name, and who may read it.";
    FileEmpty "file-empty"
        "A file has no content."
        "Look for what should have written it.";
    FileDamaged "file-damaged"
        "A file is damaged or not whole."
        "Copy or write it again.";
    FileTaken "file-taken"
        "A result would replace a file that is read or kept, or another run writes into its directory."
        "Give another place.";
    OutputUnwritable "output-unwritable"
        "A result could not be written."
        "Choose another place.";
    EncodingUnknown "encoding-unknown"
        "A file is no plain text: compressed, binary, or in another encoding than UTF-8."
        "Unpack it, or save it as UTF-8.";
    FormatUnsupported "format-unsupported"
        "The format of a file, or a part of it, is not read by this build."
        "Convert the file.";
    FormatUnknown "format-unknown"
        "The content of a file does not show its format, or it is not of the kind that is asked for."
        "Give the right file, or say its format.";
    FormatContradicted "format-contradicted"
        "A file is not of the format that was given."
        "Leave option `format` away.";
    SyntaxInvalid "syntax-invalid"
        "A file breaks the rules of its format, such as TOML or JSON."
        "Correct it at the place that the message names.";
    KeyUnknown "key-unknown"
        "A key, a section or a name is not known."
        "Correct its spelling.";
    KeyMissing "key-missing"
        "A key or a field is missing that is needed."
        "Add it.";
    KeyRepeated "key-repeated"
        "A key or a name is there twice."
        "Keep one of them.";
    ValueInvalid "value-invalid"
        "A value has the wrong type, or makes no sense."
        "Correct it.";
    OptionsContradict "options-contradict"
        "Two options, or two keys, contradict each other."
        "Leave one of them away.";
    WorkTooLarge "work-too-large"
        "The work would take more memory or time than it is worth."
        "Ask for less, as the message says, or add option `force`.";
    Interrupted "interrupted"
        "The work was ended before it had a result."
        "Begin it again.";
    ExperimentUnsuited "experiment-unsuited"
        "The command needs another kind of experiment, or more of it."
        "Take one of the presets of `calibrant init`.";
    HeaderMissing "header-missing"
        "Nothing says what the columns of a file hold."
        "Add a header, or name the columns in [columns].";
    ColumnMissing "column-missing"
        "A column is missing that is needed."
        "Export it, or name it in [columns].";
    ColumnRepeated "column-repeated"
        "Two columns hold the same."
        "Rename one, or say which in [columns].";
    RowMalformed "row-malformed"
        "A row has another number of columns than the header, or another line end."
        "Correct the row.";
    NumberMalformed "number-malformed"
        "A field is not a number."
        "Correct the field. A missing value is an empty field or NaN.";
    ValueOutOfRange "value-out-of-range"
        "A number is too large to be a reading, a time or a temperature."
        "Check the unit of its column, and look for damage.";
    TimesNotIncreasing "times-not-increasing"
        "The times of a file go backwards or stand still."
        "Sort the rows, or split files that were put together.";
    RecordingShort "recording-short"
        "A recording has too few samples."
        "Record for longer. Look at what was dropped.";
    UnitUnknown "unit-unknown"
        "Nothing says the unit of readings or times."
        "Say it with the option that the message names, or in [columns].";
    UnitContradicted "unit-contradicted"
        "The unit that was given is not the one that the file states, or not one of the sensor."
        "Leave the unit away, or correct it.";
    UnitImplausible "unit-implausible"
        "The readings show that their stated unit is wrong."
        "Correct the unit.";
    RateUnknown "rate-unknown"
        "A file has no sample times, and nothing says its sample rate."
        "Give option `rate_hz`.";
    RateContradicted "rate-contradicted"
        "The sample rate that was given is not the one that the file states."
        "Leave option `rate_hz` away.";
    SensorUnnamed "sensor-unnamed"
        "A file of one sensor does not say which sensor it is of."
        "Give the gyroscope's file with option `gyroscope`, or name the columns in [columns].";
    SensorMissing "sensor-missing"
        "A recording lacks a sensor that is needed, or an axis of it has no values."
        "Give a recording of that sensor.";
    TopicUnknown "topic-unknown"
        "A bag has no messages of an IMU on the topic, or such messages on several topics."
        "Say option `topic`.";
    GravityRemoved "gravity-removed"
        "Gravity has been removed from the acceleration."
        "Export the sensor's own readings.";
    GravityContradicted "gravity-contradicted"
        "The readings on a commanded motion contain gravity that was not given, or lack gravity that was."
        "Correct gravity_mps2 in [motion], as the message says.";
    SignLost "sign-lost"
        "Negative numbers were written as positive ones."
        "Subtract the range from the large readings.";
    AxisConstant "axis-constant"
        "The readings of an axis never change."
        "Check its connection.";
    ReadingsSaturated "readings-saturated"
        "A sensor saturates where its readings are needed."
        "Record with a larger range.";
    TemperatureMissing "temperature-missing"
        "The temperature of a sensor is needed, and the recording has none."
        "Say it, or name its column.";
    RecordingsUnlike "recordings-unlike"
        "The files do not belong together: their clocks or their lengths differ."
        "Give the files of one recording.";
    RecordingRepeated "recording-repeated"
        "A recording is used twice where two different ones are needed, two files of a batch are the same, or the records have it of another sensor."
        "Give another recording.";
    RecordingCorrected "recording-corrected"
        "A recording has been corrected with a calibration already."
        "Give the recording that the sensor made.";
    MachineInvalid "machine-invalid"
        "The links of a machine form no tree: a joint closes a loop, or a link has two parents."
        "Correct the parent or the child of the joint that the message names.";
    ChainUnknown "chain-unknown"
        "Nothing says from which link to which the chain goes, or no joints lead there."
        "Name the link that carries the sensor, and the link that does not move.";
    JointUnsupported "joint-unsupported"
        "A joint between base and tip moves in a way that is not modelled, such as a mimic or floating joint."
        "Choose another tip, or replace the joint.";
    MotionInvalid "motion-invalid"
        "The commanded motion makes no sense, or the recording does not cover it."
        "Correct its nodes and its times.";
    HoldsInvalid "holds-invalid"
        "Holds or turns that were given overlap, are out of order, or lie outside the recording."
        "Correct their times.";
    HoldsMissing "holds-missing"
        "Too few holds are found in a recording."
        "Hold the sensor still for longer, or give the times of the holds.";
    HoldsContradict "holds-contradict"
        "The holds do not look like gravity."
        "Check that the sensor was still in them, and its unit.";
    FacesContradicted "faces-contradicted"
        "The readings contradict the directions that were given."
        "Correct the directions, or the signs of the columns.";
    TurnsContradicted "turns-contradicted"
        "The gyroscope contradicts the turns that were given."
        "Correct their axes and angles.";
    KnownContradicted "known-contradicted"
        "The readings contradict a value that was given as known."
        "Correct it, or leave it out.";
    GravityMissed "gravity-missed"
        "The rotations of the gyroscope do not turn gravity from hold to hold."
        "Check that both files belong together, the axes, and saturation.";
    GyroscopeScaled "gyroscope-scaled"
        "The gyroscope reads a multiple of the turns that gravity shows."
        "Correct its sample rate, its range (sensitivity) or its unit.";
    FitFailed "fit-failed"
        "The fit breaks down or does not converge."
        "Check the units and the holds.";
    NotIdentifiable "not-identifiable"
        "The data cannot determine some of the parameters."
        "Record more orientations or movements, as the message says.";
    NoiseUndetermined "noise-undetermined"
        "The samples do not determine the noise."
        "Record the sensor at rest for minutes.";
    MotionInfeasible "motion-infeasible"
        "The limits admit no motion, or do not bound it; the time of a campaign does not suffice."
        "Change the limits that the message names.";
    ValidationImpossible "validation-impossible"
        "A validation with these data says nothing."
        "Record the sensor held still in several orientations.";
    CalibrationInvalid "calibration-invalid"
        "A file is no calibration, or not a whole one."
        "Give the file that a calibration program wrote.";
    CalibrationUnusable "calibration-unusable"
        "A calibration cannot correct readings: it did not converge, or its matrix is singular."
        "Calibrate again.";
    CalibrationUnsuited "calibration-unsuited"
        "A calibration is of another sensor, unit or model than is needed."
        "Give that of this sensor.";
    MachineUnsuited "machine-unsuited"
        "The log of a machine's motion is not of the machine that the experiment describes."
        "Log every joint between base and tip, or name the right base and tip.";
    MachineUnsolved "machine-unsolved"
        "A recording and the log of the machine do not fit together."
        "Give a recording and a log of the same motion, and check units, mounting and delay.";
    ConversionImpossible "conversion-impossible"
        "A convention or a gauge cannot hold a calibration."
        "Choose another.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_refusal_is_its_own() {
        for (k, one) in Refusal::ALL.iter().enumerate() {
            assert!(Refusal::ALL[..k].iter().all(|other| other.name() != one.name()), "{}", one.name());
        }
    }
}

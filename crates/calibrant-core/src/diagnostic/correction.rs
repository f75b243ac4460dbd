//! Checks of the correction of readings with a calibration.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{counted, plain, short};
use crate::sensor::SensorKind;

checks! {
    /// The recording lacks a sensor of the calibration. Only the other is corrected.
    SensorAbsent "sensor-absent" Note {
        sensor_kind: SensorKind,
    }
    decided "The recording has no readings of it."
    says format!("the recording has no {sensor_kind}; only the other sensor is corrected");

    /// The calibration lacks a sensor of the recording. Its readings are not written.
    SensorUncalibrated "sensor-uncalibrated" Warning {
        sensor_kind: SensorKind,
    }
    decided "The calibration has no parameters of it."
    remedy "Give a calibration of both sensors."
    says format!("the calibration has no {sensor_kind}; its readings are not written");

    /// A calibration does not state the biases of a sensor that is corrected: they count as zero.
    BiasesSupposed "biases-supposed" Warning {
        sensor_kind: SensorKind,
    }
    decided "The file has gains of the sensor and no biases, as Kalibr's."
    remedy "Give a calibration with biases, or write them into the file (`b` below accelerometers and gyroscopes)."
    says format!(
        "the calibration does not state the biases of the {sensor_kind}: zeros are supposed, and the corrected values are off by what \
         they are"
    );

    /// Readings that are corrected have spikes.
    SpikesCorrected "spikes-corrected" Warning {
        sensor_kind: SensorKind,
        /// Their number.
        spikes: usize,
        /// Time of the farthest, s.
        time_s: f64,
    }
    decided "As the spikes of a recording that is calibrated: see `spikes`."
    remedy "Look for a loose contact, or for bytes that are lost on the way."
    says format!(
        "{sensor_kind}: {} ({} s). The correction is applied as usual, but these samples do not correct the g-sensitivity. \
         Look for a loose contact, or for bytes lost on the way.",
        match spikes {
            1 => "1 sample is a spike".to_owned(),
            count => format!("{} are spikes", counted(*count, "sample")),
        },
        short(*time_s)
    );

    /// Parts of a calibration are omitted.
    PartsOmitted "parts-omitted" Warning {
        sensor_kind: SensorKind,
        /// What is omitted.
        parts: Vec<String>,
        /// Largest error of an axis of a corrected value, m/s² or rad/s.
        largest_error: f64,
        /// The stimuli and temperatures over which it is the largest.
        over: Phrase,
    }
    decided "Somebody asks for it, or for one temperature, and they are not zero. The error is the largest over all directions, and over the temperatures of the calibration."
    remedy "Keep them, in a format that has them."
    says format!(
        "{}: {} omitted. Corrected values err by up to {} {}{}.",
        sensor_kind,
        match parts.as_slice() {
            [one] => format!("{one} is"),
            parts => format!("{} are", parts.join(", ")),
        },
        plain(*largest_error, 3),
        sensor_kind.stimulus_unit().symbol(),
        over.0
    );

    /// A calibration is fixed at a temperature.
    TemperatureFixed "temperature-fixed" Note {
        /// The temperature, °C.
        temperature_c: f64,
    }
    decided "Somebody asks for the calibration at one temperature."
    says format!(
        "biases and gains are those at {temperature_c} °C. At other temperatures, the correction changes."
    );
}

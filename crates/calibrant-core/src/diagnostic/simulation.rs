//! Remarks on a simulation.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::significant;
use crate::sensor::SensorKind;

checks! {
    /// The experiment does not state the noise of the accelerometer. A simulation or a design of poses takes a usual one.
    NoiseAssumed "noise-assumed" Note {
        /// Standard deviation of one sample, m/s².
        noise_mps2: f64,
    }
    decided "Neither noise_mps2 nor noise_counts is in [sensor]."
    remedy "State noise_mps2 in [sensor], as the datasheet says it or `calibrant noise` finds it."
    says format!("the experiment does not state the noise of one sample (noise_mps2 in [sensor]): a simulation or a design takes {noise_mps2} m/s²");

    /// All axes of a sensor are simulated with one noise.
    NoisiestAxis "noisiest-axis" Note {
        sensor_kind: SensorKind,
    }
    decided "Its axes have different noise, and the simulation has one for all."
    says format!("the noise of the {sensor_kind} is simulated with that of its noisiest axis");

    /// A simulated recording does not have the columns of the experiment.
    ColumnsOfAnother "columns-of-another" Note {}
    decided "The experiment has [columns], which describe a file of another program."
    remedy "Calibrate the simulated recording with a copy of the experiment without [columns] and gyroscope.unit."
    says "recording.csv says its columns and units itself: to calibrate it take a copy of the experiment without [columns] \
        and gyroscope.unit, which are about another file";

    /// The simulated motion is a spline through a log.
    MotionThroughLog "motion-through-log" Note {
        /// The file of the log.
        file: Phrase,
        /// Time between knots, s.
        knot_step_s: f64,
        /// Largest standard deviation of the log about the spline, rad or m.
        scatter: f64,
    }
    decided "A log is given."
    says format!(
        "the motion is a spline through {}, with knots every {} s; the log scatters about it by at most {} rad or m",
        file.0,
        significant(*knot_step_s, 2),
        significant(*scatter, 2)
    );
}

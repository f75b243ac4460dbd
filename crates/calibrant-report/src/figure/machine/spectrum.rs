//! Residuals by frequency: their density, and their coherence with the readings.

use crate::figure::panel::{Mark, Panel, Series};
use crate::figure::{Figure, colour};
use calibrant_core::sensor::Axis;
use calibrant_machine::estimate::ResidualSpectrum;
use nalgebra::Vector3;

/// Amplitude densities of residuals and readings beside that of white noise. `unit` is that of the readings.
pub(crate) fn residual_densities(spectrum: &ResidualSpectrum, unit: &str) -> Figure {
    let frequencies = &spectrum.frequencies_hz;
    let label = format!("amplitude density ({unit}/√Hz)");
    let panels = Axis::ALL
        .iter()
        .map(|axis| {
            let k = axis.index();
            let of = |powers: &[Vector3<f64>]| {
                frequencies.iter().zip(powers).map(|(f, power)| (*f, power[k].sqrt())).collect::<Vec<_>>()
            };
            let white = ends(frequencies).map(|f| (f, spectrum.white_noise[k].sqrt())).to_vec();
            let thin = Mark::Line { width: 1.0, dashes: "" };
            Panel { log_x: true, log_y: true, ..Panel::new(format!("axis {axis}"), "frequency (Hz)", label.as_str()) }
                .with(Series::new("readings", colour::GREY, thin, of(&spectrum.readings)))
                .with(Series::new("residuals", colour::BLUE, thin, of(&spectrum.residuals)))
                .with(Series::dashed("the sensor’s white noise", colour::VERMILLION, white))
        })
        .collect();
    let caption = format!(
        "Mean of {} half-overlapping segments under a Hann window. Good: the residuals lie on the dashed line. Above it at low frequencies: an error of the model or \
         a wandering bias. Above it at a higher frequency: noise of the reference, or vibration that the reference does not see. Below it: the noisy reference follows the sensor’s noise.",
        spectrum.segments
    );
    Figure::new("Residuals by frequency", panels, caption)
}

/// The part of the residuals that follows the readings, by frequency.
pub(crate) fn residual_coherence(spectrum: &ResidualSpectrum) -> Figure {
    let frequencies = &spectrum.frequencies_hz;
    let panels = Axis::ALL
        .iter()
        .map(|axis| {
            let k = axis.index();
            let points = frequencies.iter().zip(&spectrum.coherence).map(|(f, of)| (*f, of[k])).collect();
            let level = ends(frequencies).map(|f| (f, spectrum.unrelated)).to_vec();
            let thin = Mark::Line { width: 1.0, dashes: "" };
            Panel {
                log_x: true,
                y_includes: vec![0.0, 1.0],
                ..Panel::new(format!("axis {axis}"), "frequency (Hz)", "coherence")
            }
            .with(Series::new("residual with reading", colour::BLUE, thin, points))
            .with(Series::dashed("unrelated signals exceed this at one frequency in twenty", colour::VERMILLION, level))
        })
        .collect();
    let caption = "The part of the residual’s power that follows the same axis’ reading linearly, from 0 to 1. Good: below the dashed line where the motion is. Large at the \
                   frequencies of the motion: a gain, a delay or the geometry is wrong there. At frequencies without motion, the reading is its noise, and so is the residual: the coherence is near 1.";
    Figure::new("Coherence of residual and reading", panels, caption)
}

/// The first and the last frequency.
fn ends(frequencies: &[f64]) -> [f64; 2] {
    let first = frequencies.first().copied().unwrap_or(f64::NAN);
    [first, frequencies.last().copied().unwrap_or(first)]
}

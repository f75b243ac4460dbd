//! Residuals by frequency: their density, and their coherence with the reference.

use crate::figure::panel::{Panel, Points, Series};
use crate::figure::unit::DisplayUnit;
use crate::figure::{Figure, colour};
use calibrant_core::sensor::Axis;
use calibrant_machine::estimate::ResidualSpectrum;
use nalgebra::Vector3;

/// The reference is drawn up to where it falls below this part of the white noise for good.
const SHOWN: f64 = 0.1;

/// Amplitude densities of residuals and reference beside that of white noise. `unit` is that of the readings.
pub(crate) fn residual_densities(spectrum: &ResidualSpectrum, unit: &'static str) -> Figure {
    let frequencies = &spectrum.frequencies_hz;
    let unit = DisplayUnit::suited_to(unit, spectrum.white_noise.iter().map(|power| power.sqrt()));
    let label = format!("density ({}/√Hz)", unit.symbol);
    let panels = Panel::by_axis(&Axis::ALL, "frequency (Hz)", &label, |axis, panel| {
        let k = axis.index();
        let of = |powers: &[Vector3<f64>]| -> Points {
            let densities = powers.iter().map(|power| unit.factor * power[k].sqrt());
            frequencies.iter().copied().zip(densities).collect()
        };
        let mut reference = of(&spectrum.reference);
        let noise = unit.factor * spectrum.white_noise[k].sqrt();
        let last = reference.iter().rposition(|(_, density)| *density > SHOWN * noise);
        reference.truncate(last.map_or(0, |last| last + 1));
        let white = ends(frequencies).map(|f| (f, noise)).to_vec();
        Panel { log_x: true, log_y: true, ..panel }
            .with(Series::stroke("what the reference says", colour::GREY, (1.0, ""), reference))
            .with(Series::stroke("residuals", colour::BLUE, (1.0, ""), of(&spectrum.residuals)))
            .with(Series::dashed("the sensor’s white noise", colour::VERMILLION, white))
    });
    let caption = format!(
        "Amplitude density, the root of the power density: mean of {} half-overlapping segments under a Hann window. Good: the residuals lie on the dashed line. Above it at low frequencies: an error of the model or \
         a wandering bias. Above it at a higher frequency: noise of the reference, or vibration that the reference does not see. Below it: the noisy reference follows the sensor’s noise.",
        spectrum.segments
    );
    Figure::new("Residuals by frequency", panels, caption)
}

/// The part of the residuals that follows the reference, by frequency.
pub(crate) fn residual_coherence(spectrum: &ResidualSpectrum) -> Figure {
    let frequencies = &spectrum.frequencies_hz;
    let panels = Panel::by_axis(&Axis::ALL, "frequency (Hz)", "coherence", |axis, panel| {
        let of = spectrum.coherence.iter().map(|of| of[axis.index()]);
        let points = frequencies.iter().copied().zip(of).collect();
        let level = ends(frequencies).map(|f| (f, spectrum.unrelated)).to_vec();
        let unrelated = "unrelated signals exceed this at one frequency in twenty";
        Panel { log_x: true, y_includes: vec![0.0, 1.0], ..panel }
            .with(Series::stroke("residual with reference", colour::BLUE, (1.0, ""), points))
            .with(Series::dashed(unrelated, colour::VERMILLION, level))
    });
    let caption = "The part of the residual’s power that follows what the reference says on the same axis, from 0 to 1. Good: below the dashed line. Large at the frequencies of the motion: a gain, \
                   a delay or the geometry is wrong. Large where the reference says nothing but noise: a noisy reference follows the sensor there, and no error is meant.";
    Figure::new("Coherence of residual and reference", panels, caption)
}

/// The first and the last frequency.
fn ends(frequencies: &[f64]) -> [f64; 2] {
    let first = frequencies.first().copied().unwrap_or(f64::NAN);
    [first, frequencies.last().copied().unwrap_or(first)]
}

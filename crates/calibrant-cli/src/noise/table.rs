//! The table of a sensor's noise.

use crate::console;
use calibrant::noise::noise_line;
use calibrant::noise::{Coefficient, CoefficientUnit, PowerLaw, SensorNoise, coefficient_units};
use calibrant::report::{coefficient_name, number_format};

/// Coefficients, noise of one sample, and why a coefficient is not determined. `examined` names the examined part of
/// the recording.
pub(super) fn noise_table(noise: &SensorNoise, examined: Option<&str>) -> String {
    let segment = &noise.segment;
    let mut text = format!(
        "  {}: {} samples, {:.2} to {:.2} s, {} Hz\n",
        noise.sensor_kind,
        number_format::count(segment.samples()),
        segment.start_s,
        segment.end_s,
        number_format::significant(segment.rate_hz(), 5)
    );
    if let Some(examined) = examined {
        text.push_str(&format!("  {examined}\n"));
    }
    text.push('\n');
    let mut rows = Vec::new();
    let mut reasons: Vec<(String, String)> = Vec::new();
    for process in [PowerLaw::White, PowerLaw::Flicker, PowerLaw::RandomWalk, PowerLaw::Quantisation] {
        let units = coefficient_units(noise.sensor_kind, process, noise.unit);
        for axis in &noise.axes {
            let name = format!("{} {}", coefficient_name(noise, process), axis.axis);
            let unit = units[0].symbol.to_owned();
            let shown = |value: f64| number_format::significant(value, 3);
            rows.push(match axis.fit.model.coefficient(process) {
                Coefficient::Determined(found) => {
                    let mut customary: Vec<String> = units[1..]
                        .iter()
                        .map(|unit| format!("{} {}", shown(unit.factor * found.value), unit.symbol))
                        .collect();
                    if let (PowerLaw::Flicker, Some(tau)) = (process, axis.fit.flat_tau_s) {
                        customary.push(format!("at {} s", number_format::significant(tau, 2)));
                    }
                    let interval = format!("{} to {}", shown(found.low), shown(found.high));
                    vec![
                        name,
                        number_format::with_sd(found.value, found.sd),
                        interval,
                        unit,
                        customary.join(", "),
                    ]
                }
                Coefficient::NotDetermined { limit, reason } => {
                    let what = coefficient_name(noise, process);
                    match reasons.iter_mut().find(|(known, names)| known == reason && names.starts_with(what))
                    {
                        Some((_, names)) => names.push_str(&format!(", {}", axis.axis)),
                        None => reasons.push((reason.clone(), name.clone())),
                    }
                    let customary: Vec<String> = limit.map_or_else(Vec::new, |limit| {
                        let below = |unit: &CoefficientUnit| {
                            format!(
                                "< {} {}",
                                number_format::significant(unit.factor * limit, 2),
                                unit.symbol
                            )
                        };
                        units[1..].iter().map(below).collect()
                    });
                    let limit = limit.map_or_else(
                        || "–".to_owned(),
                        |limit| format!("< {}", number_format::significant(limit, 2)),
                    );
                    vec![name, "not determined".to_owned(), limit, unit, customary.join(", ")]
                }
            });
        }
    }
    text.push_str(&console::table(&["coefficient", "value ± sd", "95 %", "unit", "customary"], &rows));
    for (reason, names) in reasons {
        text.push_str(&format!("  {names} not determined: {reason}\n"));
    }
    let list = |values: &dyn Fn(usize) -> Option<f64>| {
        let shown =
            |k| values(k).map_or_else(|| "–".to_owned(), |value| number_format::significant(value, 3));
        (0..noise.axes.len()).map(shown).collect::<Vec<_>>().join(", ")
    };
    let rate = segment.rate_hz();
    text.push_str(&format!(
        "  one sample: white noise N √rate {} {unit}; standard deviation {} {unit}\n",
        list(&|k| noise.axes[k].fit.model.white_noise_per_sample(rate)),
        list(&|k| Some(noise.axes[k].sample_sd)),
        unit = noise.unit.symbol()
    ));
    text.push_str(&match (noise_line(noise), &noise.caveat) {
        (_, Some(caveat)) => format!("  no noise for an experiment file: {caveat}\n\n"),
        (None, None) => {
            "  no noise for an experiment file: white noise is not determined on all axes\n\n".to_owned()
        }
        (Some(found), None) => {
            let but = if noise.explains() {
                ""
            } else {
                "\n  (the model does not explain the noise: read the warnings before you use it)"
            };
            format!("  for an experiment file, in [{}]: {}{but}\n\n", found.section, found.line)
        }
    });
    text
}

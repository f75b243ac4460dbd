//! Are these soaks of one sensor, and do they determine the coefficients?

use super::soak::{SoakCalibration, SoakPath};
use crate::{Campaign, Channel};
use calibrant_core::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use calibrant_core::number_format::{plain, significant};
use calibrant_core::sensor::{Gauge, ImuQuantity, Quantity, ReadingUnit};

/// Biases that differ by so many standard deviations at one temperature are of two sensors.
const OF_TWO_SENSORS: f64 = 20.0;

fn unlike(soak: &SoakCalibration, message: String, help: &str) -> Error {
    Error::recording(InputError::new(Refusal::RecordingsUnlike, format!("{}: {message}", soak.name), help))
}

/// Checks that the soaks are alike. Gives the parameters that all have.
pub(super) fn check(campaign: &Campaign, soaks: &[SoakCalibration]) -> Result<Vec<ImuQuantity>> {
    let Some(first) = soaks.first() else { return Ok(Vec::new()) };
    let quantities = |soak: &SoakCalibration| -> Vec<ImuQuantity> {
        let of = soak.imu.quantities.iter().copied();
        of.filter(|quantity| !matches!(quantity, ImuQuantity::Thermal(..))).collect()
    };
    let wanted = quantities(first);
    for soak in soaks {
        let (imu, other) = (&soak.imu, &first.imu);
        if imu.covariance.is_none() {
            return Err(unlike(
                soak,
                "this calibration has no covariance".into(),
                "give what `calibrate` wrote",
            ));
        }
        if imu.units != other.units {
            let help = "calibrate all soaks with one experiment file";
            return Err(unlike(
                soak,
                format!("its readings are in other units than those of {}", first.name),
                help,
            ));
        }
        let gauge = imu.gauge();
        if gauge == Some(Gauge::Symmetric) || gauge != other.gauge() {
            let message = match gauge {
                Some(Gauge::Symmetric) => {
                    "its gauge is symmetric, which gains that follow temperature do not keep".to_owned()
                }
                _ => format!("its gauge is another than that of {}", first.name),
            };
            return Err(unlike(soak, message, "calibrate all soaks with gauge = \"lower\" in [holds]"));
        }
        if quantities(soak) != wanted {
            let message = format!("it has other parameters than {}", first.name);
            return Err(unlike(soak, message, "calibrate all soaks with one experiment file"));
        }
        let sources = |soak: &SoakCalibration| soak.imu.shared.as_ref().map(|shared| shared.sources.clone());
        if sources(soak) != sources(first) {
            let message = format!(
                "its gravity, or what else it shares with other calibrations, is not that of {}",
                first.name
            );
            return Err(unlike(soak, message, "calibrate all soaks with one experiment file"));
        }
    }
    one_sensor(campaign, soaks)?;
    Ok(wanted)
}

/// Refuses soaks at one temperature whose biases differ by more than hysteresis, lag and slope can explain.
fn one_sensor(campaign: &Campaign, soaks: &[SoakCalibration]) -> Result<()> {
    for (k, soak) in soaks.iter().enumerate() {
        for other in &soaks[..k] {
            let apart_c = soak.temperature.mean_c - other.temperature.mean_c;
            if apart_c.abs() > campaign.spacing_c {
                continue;
            }
            for channel in campaign.channels.iter().filter(|channel| channel.name.ends_with(".bias")) {
                let first_sd = |of: &[f64]| of.first().copied().unwrap_or_default();
                let [low, high] = campaign.range_c;
                let slope = channel.spread.iter().skip(1).flatten().map(|sd| sd.powi(2)).sum::<f64>().sqrt();
                let by_slope = slope * 2.0 * apart_c / (high - low);
                let by_path = first_sd(&channel.hysteresis_sd).hypot(2.0 * first_sd(&channel.lag_sd));
                for (quantity, of) in biases(soak, &channel.name) {
                    let Some((_, before)) =
                        biases(other, &channel.name).into_iter().find(|(q, _)| *q == quantity)
                    else {
                        continue;
                    };
                    let variance = of[1]
                        + before[1]
                        + by_slope.powi(2)
                        + by_path.powi(2)
                        + 2.0 * channel.soak_sd.powi(2);
                    let apart = (of[0] - before[0]).abs();
                    if apart > OF_TWO_SENSORS * variance.sqrt() {
                        let message = format!(
                            "{} is {} {} from that of {}, at {} °C both: these are two sensors",
                            quantity.name(),
                            significant(apart, 3),
                            channel.unit,
                            other.name,
                            plain(soak.temperature.mean_c, 3)
                        );
                        return Err(unlike(soak, message, "give the soaks of one sensor"));
                    }
                }
            }
        }
    }
    Ok(())
}

/// The biases of a channel in its stimulus, each with its variance.
fn biases(soak: &SoakCalibration, channel: &str) -> Vec<(ImuQuantity, [f64; 2])> {
    let imu = &soak.imu;
    let of = |(k, quantity): (usize, &ImuQuantity)| {
        let ImuQuantity::Of(kind, Quantity::Bias(axis)) = *quantity else { return None };
        if format!("{kind}.bias") != channel {
            return None;
        }
        let counts = imu.unit(kind) == Some(ReadingUnit::Counts);
        let gain =
            if counts { imu.parameters.sensor(kind).matrix[(axis.index(), axis.index())] } else { 1.0 };
        let variance = imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(k, k)]);
        Some((*quantity, [quantity.value(&imu.parameters) / gain, variance / gain.powi(2)]))
    };
    imu.quantities.iter().enumerate().filter_map(of).collect()
}

/// A soak without terms of its own over temperature.
pub(super) fn at_its_temperature(soak: &SoakCalibration) -> Result<SoakCalibration> {
    let mut soak = soak.clone();
    if soak.imu.follows_temperature() {
        soak.imu = soak.imu.at(soak.temperature.mean_c)?;
    }
    Ok(soak)
}

fn counted(temperatures: usize) -> String {
    if temperatures == 1 { "one temperature".into() } else { format!("{temperatures} temperatures") }
}

/// The error about coefficients that stay open.
pub(super) fn open(channels: &[Channel], paths: &[SoakPath]) -> Error {
    /// Temperatures that differ by less are the same, K.
    const SAME_K: f64 = 1.0;
    let mut temperatures: Vec<f64> = paths.iter().map(|path| path.temperature_c).collect();
    temperatures.sort_by(f64::total_cmp);
    temperatures.dedup_by(|one, other| (*one - *other).abs() < SAME_K);
    let free = |channel: &Channel| channel.spread.iter().filter(|sd| sd.is_none()).count();
    let open: Vec<String> = channels
        .iter()
        .filter(|channel| free(channel) > temperatures.len())
        .flat_map(|channel| {
            (temperatures.len()..free(channel)).map(|m| format!("{} of order {m}", channel.name))
        })
        .collect();
    Error::NotIdentifiable(Box::new(NotIdentifiable {
        groups: vec![UndeterminedGroup {
            free_combinations: open.len(),
            parameters: open,
            reason: format!(
                "the soaks have {} that differ by {SAME_K} K or more",
                counted(temperatures.len())
            ),
            remedy: format!(
                "soak at more temperatures, or lower the orders in [temperature] to {}",
                temperatures.len().saturating_sub(1)
            ),
        }],
        ..NotIdentifiable::default()
    }))
}

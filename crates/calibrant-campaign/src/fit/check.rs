//! Are these soaks of one sensor, and do they determine the coefficients?

use super::model::{CampaignModel, constant, name_of};
use super::soak::{SoakCalibration, SoakPath};
use crate::{Campaign, Channel};
use calibrant_core::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use calibrant_core::number_format::{plain, significant};
use calibrant_core::sensor::{CalibratedImu, Gauge, ImuQuantity, Quantity, ReadingUnit};

/// Biases that differ by so many standard deviations at one temperature are of two sensors.
const OF_TWO_SENSORS: f64 = 20.0;

fn unlike(soak: &SoakCalibration, message: String, help: &str) -> Error {
    Error::recording(InputError::new(Refusal::RecordingsUnlike, format!("{}: {message}", soak.name), help))
}

/// Checks that the soaks are alike. Gives the parameters that all have.
pub(super) fn check(model: &CampaignModel, soaks: &[SoakCalibration]) -> Result<Vec<ImuQuantity>> {
    let Some(first) = soaks.first() else { return Err(open(&model.channels(), &[])) };
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
    if !model.one_recording {
        one_sensor(&model.campaign, soaks)?;
    }
    Ok(wanted)
}

/// Refuses soaks whose angles between axes differ, and soaks at one temperature whose biases differ by more than hysteresis, lag and slope can explain.
fn one_sensor(campaign: &Campaign, soaks: &[SoakCalibration]) -> Result<()> {
    for (k, soak) in soaks.iter().enumerate() {
        for other in &soaks[..k] {
            let apart_c = (soak.temperature.mean_c - other.temperature.mean_c).abs();
            for (place, quantity) in soak.imu.quantities.iter().enumerate() {
                let Some(before) = other.imu.quantities.iter().position(|of| of == quantity) else {
                    continue;
                };
                let Some((unit, soak_sd, allowed)) = differs_by(campaign, *quantity, apart_c) else {
                    continue;
                };
                // counts become what their sensors feel
                let gain = gain_of(&soak.imu, *quantity);
                let of = |soak: &SoakCalibration, place: usize| {
                    let variance = soak.imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(place, place)]);
                    (quantity.value(&soak.imu.parameters) / gain, variance / gain.powi(2))
                };
                let ((here, variance), (there, other_variance)) = (of(soak, place), of(other, before));
                // by their own slopes, too
                let slopes = [soak, other].map(|of| slope(&of.imu, *quantity).abs() / gain);
                let allowed = allowed + apart_c * slopes.iter().sum::<f64>();
                let sd = (variance + other_variance + 2.0 * soak_sd.powi(2)).sqrt();
                let apart = (here - there).abs();
                if apart > OF_TWO_SENSORS * sd + allowed {
                    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
                    let message = format!(
                        "{} is {}{unit} from that of {}, at {} and {} °C: these are two sensors",
                        quantity.name(),
                        significant(apart, 3),
                        other.name,
                        plain(soak.temperature.mean_c, 3),
                        plain(other.temperature.mean_c, 3)
                    );
                    return Err(unlike(soak, message, "give the soaks of one sensor"));
                }
            }
        }
    }
    Ok(())
}

/// Unit and scatter of a parameter that tells sensors apart, and what one sensor may differ by between two soaks; `None` for what does not tell.
fn differs_by(campaign: &Campaign, quantity: ImuQuantity, apart_c: f64) -> Option<(&'static str, f64, f64)> {
    /// So many standard deviations of what is known of sensors: their slopes have heavy tails.
    const BY_PATH: f64 = 4.0;
    const BY_SLOPE: f64 = 12.0;
    match quantity {
        ImuQuantity::Of(_, Quantity::CrossAxis(..)) => {
            let constant = constant(quantity);
            Some((constant.unit, constant.soak_sd, 0.0))
        }
        ImuQuantity::Of(_, Quantity::Bias(_)) if apart_c <= campaign.spacing_c => {
            let name = name_of(quantity)?;
            let channel = campaign.channels.iter().find(|channel| channel.name == name)?;
            let first_sd = |of: &[f64]| of.first().copied().unwrap_or_default();
            let by_slope = campaign.power_sd(channel, 1) * apart_c;
            let by_path = first_sd(&channel.hysteresis_sd).hypot(2.0 * first_sd(&channel.lag_sd));
            Some((channel.unit, channel.soak_sd, (BY_SLOPE * by_slope).hypot(BY_PATH * by_path)))
        }
        _ => None,
    }
}

/// The slope of a bias by temperature.
fn slope(imu: &CalibratedImu, quantity: ImuQuantity) -> f64 {
    match quantity {
        ImuQuantity::Of(kind, Quantity::Bias(axis)) => {
            imu.parameters.thermal.sensor(kind).bias[0][axis.index()]
        }
        _ => 0.0,
    }
}

/// By what a parameter of readings in counts is divided.
fn gain_of(imu: &CalibratedImu, quantity: ImuQuantity) -> f64 {
    let kind = quantity.sensor_kind();
    let row = match quantity {
        ImuQuantity::Of(_, Quantity::Bias(axis) | Quantity::CrossAxis(axis, _)) => axis.index(),
        _ => return 1.0,
    };
    let counts = imu.unit(kind) == Some(ReadingUnit::Counts);
    if counts { imu.parameters.sensor(kind).matrix[(row, row)].abs() } else { 1.0 }
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
    match temperatures {
        0 => "there is no soak".into(),
        1 => "all soaks are at one temperature".into(),
        count => format!("the soaks have {count} temperatures that differ by 1 K or more"),
    }
}

/// The error about coefficients that stay open.
pub(super) fn open(channels: &[Channel], paths: &[SoakPath]) -> Error {
    /// Temperatures that differ by less are the same, K.
    const SAME_K: f64 = 1.0;
    let mut temperatures: Vec<f64> = paths.iter().map(|path| path.temperature_c).collect();
    temperatures.sort_by(f64::total_cmp);
    temperatures.dedup_by(|one, other| (*one - *other).abs() < SAME_K);
    let open: Vec<String> = channels
        .iter()
        .filter(|channel| channel.free() > temperatures.len())
        .flat_map(|channel| {
            (temperatures.len()..channel.free()).map(|m| format!("{} of order {m}", channel.name))
        })
        .collect();
    // otherwise all are, together
    let all = || channels.iter().map(|channel| channel.name.clone()).collect();
    let open: Vec<String> = if open.is_empty() { all() } else { open };
    Error::NotIdentifiable(Box::new(NotIdentifiable {
        groups: vec![UndeterminedGroup {
            free_combinations: open.len(),
            parameters: open,
            reason: counted(temperatures.len()),
            remedy: format!(
                "soak at more temperatures, or lower the orders in [temperature] to {}",
                temperatures.len().saturating_sub(1)
            ),
        }],
    }))
}

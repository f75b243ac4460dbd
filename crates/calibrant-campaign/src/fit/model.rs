//! What is fitted to the soaks: the channels with the orders that are reported.

use crate::{Campaign, Channel};
use calibrant_core::sensor::{HIGHEST_ORDER, ImuQuantity, Quantity, SensorKind};

/// The model of a calibration over temperature.
#[derive(Debug, Clone)]
pub struct CampaignModel {
    /// Chamber and range, and what is known of the channels beforehand.
    pub campaign: Campaign,
    /// The order of each channel whose coefficients are free.
    pub orders: Vec<usize>,
    /// The temperature at which biases and gains are given, °C.
    pub reference_c: f64,
    /// Are the soaks pieces of one recording? They are then of one sensor.
    pub one_recording: bool,
}

impl CampaignModel {
    /// The channels as they are fitted: nothing is known of the coefficients up to the order, for the spread of published sensors has heavy tails. Priors stay on
    /// what lies above, on hysteresis and on lag.
    pub(super) fn channels(&self) -> Vec<Channel> {
        let free = |(channel, order): (&Channel, &usize)| {
            let mut spread = channel.spread.clone();
            spread.resize(spread.len().max(order + 1).min(HIGHEST_ORDER + 1), None);
            spread[..=*order].fill(None);
            Channel { spread, ..channel.clone() }
        };
        self.campaign.channels.iter().zip(&self.orders).map(free).collect()
    }
}

/// The channel of a parameter that follows temperature.
pub(super) fn name_of(quantity: ImuQuantity) -> Option<String> {
    match quantity {
        ImuQuantity::Of(kind, Quantity::Bias(_)) => Some(format!("{kind}.bias")),
        ImuQuantity::Of(kind, Quantity::Scale(_)) => Some(format!("{kind}.scale")),
        _ => None,
    }
}

/// The channel of a parameter that does not follow temperature: a constant with a scatter between soaks.
pub(super) fn constant(quantity: ImuQuantity) -> Channel {
    /// Usual scatter of an entry off the diagonal, and of the g-sensitivity, (rad/s)/(m/s²).
    const OFF_DIAGONAL: f64 = 1e-4;
    const G_SENSITIVITY: f64 = 1e-5;
    let (name, unit, soak_sd) = match quantity {
        ImuQuantity::GSensitivity(..) => {
            ("gyroscope.g_sensitivity".to_owned(), "(rad/s)/(m/s²)", G_SENSITIVITY)
        }
        _ if quantity.sensor_kind() == SensorKind::Accelerometer => {
            ("accelerometer.matrix".to_owned(), "1", OFF_DIAGONAL)
        }
        _ => ("gyroscope.matrix".to_owned(), "1", OFF_DIAGONAL),
    };
    Channel {
        name,
        unit,
        spread: vec![None],
        hysteresis_sd: Vec::new(),
        lag_sd: Vec::new(),
        lag_scatter: 0.0,
        soak_sd,
        block_sd: 0.0,
        goal_sd: f64::INFINITY,
    }
}

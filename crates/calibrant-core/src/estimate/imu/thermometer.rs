//! What is known of the thermometer.

/// By how much the thermometer lags the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermometerLag {
    /// `t_l`, s.
    pub lag_s: f64,
    /// Its standard deviation, s; 0 for none.
    pub sd_s: f64,
}

/// What is supposed of a thermometer: it is the chip's own (no lag), or another one on the board, which lags by 10 to 40 s.
impl Default for ThermometerLag {
    fn default() -> Self {
        Self { lag_s: 0.0, sd_s: 20.0 }
    }
}

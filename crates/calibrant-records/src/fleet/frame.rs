//! One true frame and one reference temperature for all sensors of a fleet: without them, their parameters are not the same quantities.
//!
//! The matrices of one sensor in two gauges differ by a rotation, and biases at two temperatures by what temperature does. The first calibration decides: its gauge, and its
//! reference temperature. Calibrations that all have one frame of another kind, such as that of a machine, stay in it.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{CalibratedImu, Gauge, SensorKind};

/// What all calibrations are brought to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FleetFrame {
    /// The gauge; `None` where all have one frame that is no gauge.
    pub(super) gauge: Option<Gauge>,
    /// The reference temperature, where any follow temperature, °C.
    pub(super) reference_c: Option<f64>,
    /// The sensor whose matrix fixes the frame of the gyroscopes, where there are any.
    frame_of_gyroscopes: Option<SensorKind>,
}

/// The gauge of an IMU; `None` where its frame is of another kind, or its matrix has the form of every gauge.
fn gauge_of(imu: &CalibratedImu) -> Option<Gauge> {
    Gauge::of(&imu.parameters.sensor(imu.reference()).matrix)
}

impl FleetFrame {
    /// That of these IMUs, by the first of them.
    pub(super) fn of<'i>(imus: impl Iterator<Item = &'i CalibratedImu> + Clone) -> Self {
        let mut frames = imus.clone().filter(|imu| !has_every_gauge(imu));
        let first = frames.next();
        let is_other = |imu: &CalibratedImu| first.is_some_and(|first| imu.frame != first.frame);
        let gauge = match imus.clone().find_map(gauge_of) {
            Some(gauge) => Some(gauge),
            None if frames.any(is_other) => Some(Gauge::Lower),
            None => None,
        };
        let with_gyroscope = |imu: &&CalibratedImu| imu.unit(SensorKind::Gyroscope).is_some();
        Self {
            gauge,
            reference_c: imus
                .clone()
                .find(|imu| imu.follows_temperature())
                .map(|imu| imu.parameters.thermal.reference_c),
            frame_of_gyroscopes: imus.clone().find(with_gyroscope).map(CalibratedImu::reference),
        }
    }

    /// An IMU in this frame.
    pub(super) fn bring(&self, imu: CalibratedImu) -> Result<CalibratedImu> {
        if imu.unit(SensorKind::Gyroscope).is_some() && Some(imu.reference()) != self.frame_of_gyroscopes {
            let message = format!("the {} fixes its frame, and not that of the first", imu.reference());
            let help = "ask for the sensors of one kind";
            return Err(Error::experiment(InputError::new(Refusal::ConversionImpossible, message, help)));
        }
        let imu = match self.reference_c.filter(|_| imu.follows_temperature()) {
            Some(reference_c) => imu.at_reference_temperature(reference_c)?,
            None => imu,
        };
        match self.gauge.filter(|gauge| !gauge.is_form_of(&imu.parameters.sensor(imu.reference()).matrix)) {
            Some(gauge) => imu.in_gauge(gauge),
            None => Ok(imu),
        }
    }
}

/// Has its matrix the form of every gauge?
fn has_every_gauge(imu: &CalibratedImu) -> bool {
    let matrix = &imu.parameters.sensor(imu.reference()).matrix;
    Gauge::ALL.iter().all(|gauge| gauge.is_form_of(matrix))
}

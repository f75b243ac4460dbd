//! A sample rate that nobody measured is uncertain, and with it the gains of the gyroscope.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, normal, retimed, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::ImuSetup;
use calibrant::sensor::{ReadingUnit, SensorKind};
use calibrant::simulate::{Purpose, stream};
use rayon::prelude::*;

#[test]
fn the_gains_of_the_gyroscope_carry_the_uncertainty_of_the_rate() {
    const RATE_SD: f64 = 2e-3;
    let one = |number: u64| {
        let mut rng = stream(94, Purpose::Sensor, number);
        let imu = draw_imu(&mut rng);
        let mut recording = ByHand::default().record(&imu, &mut rng);
        let faster = 1.0 + RATE_SD * normal(&mut rng);
        for sensor in recording.sensors.values_mut() {
            *sensor = sensor.take().map(|sensor| retimed(&sensor, |t| t * faster));
        }
        let setup = ImuSetup { rate_sd: RATE_SD, ..steady_imu() };
        let found = run_imu(&recording, &unfeeling_gyroscope(), &setup, ReadingUnit::MetrePerSecondSquared);
        let found = found.expect("determined");
        let z = |k: usize| (found.values[k] - found.quantities[k].value(&imu)) / found.sd()[k];
        let scales = (0..found.values.len()).filter(|&k| {
            let quantity = found.quantities[k];
            quantity.sensor_kind() == SensorKind::Gyroscope && quantity.name().contains("scale")
        });
        scales.map(z).map(|z| z * z).sum::<f64>() / 3.0
    };
    let squares: f64 = (0..100).into_par_iter().map(one).sum::<f64>() / 100.0;
    // 100 clocks: the mean of χ² with one degree of freedom has a standard deviation of 0.14
    assert!((0.6..1.4).contains(&squares), "{squares}");
}

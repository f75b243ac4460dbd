//! Draws what differs from the experiment's file, from what the file says is known beforehand.

use super::drawn_motion::any_rotation;
use crate::estimate::{MachineParameters, MachineQuantity, MachineSetup, MountingPrior};
use calibrant_core::sensor::{ImuParameters, SensorKind};
use calibrant_core::simulate::Rng;
use rand_distr::{Distribution, StandardNormal};

/// A machine and the sensor on it, as they are.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnMachine {
    /// All parameters.
    pub parameters: MachineParameters,
    /// The quantities that were drawn, but for those of the sensor, and their values. A mounting is a turn against the nominal one.
    pub drawn: Vec<(MachineQuantity, f64)>,
}

/// A machine with this number of joints, drawn from the priors, and this sensor on it.
///
/// A mounting that is unknown is any rotation.
#[must_use]
pub fn draw_machine(
    setup: &MachineSetup,
    imu: ImuParameters,
    sensors: &[SensorKind],
    joints: usize,
    rng: &mut Rng,
) -> DrawnMachine {
    let mut normal = || -> f64 { StandardNormal.sample(rng) };
    let nominal = MachineParameters::nominal(setup, imu, joints);
    let mut parameters = nominal.clone();
    // the mean of both delays, and half their difference
    let common_s = setup.delay_sd_s * normal();
    let half_s = if sensors.len() > 1 { 0.5 * setup.delay_difference_sd_s * normal() } else { 0.0 };
    let mut quantities = Vec::new();
    for quantity in MachineQuantity::of_machine(sensors, joints) {
        let sd = setup.prior_sd(quantity, sensors.len());
        if !(sd > 0.0 && sd.is_finite()) {
            continue;
        }
        let error = match quantity {
            MachineQuantity::Delay(SensorKind::Accelerometer) => common_s + half_s,
            MachineQuantity::Delay(SensorKind::Gyroscope) => common_s - half_s,
            _ => sd * normal(),
        };
        parameters.add(quantity, error);
        quantities.push(quantity);
    }
    if setup.mounting == MountingPrior::Unknown {
        parameters.mount.tip_from_sensor = any_rotation(rng);
    }
    let drawn = quantities.into_iter().map(|of| (of, parameters.value(of, &nominal))).collect();
    DrawnMachine { drawn, parameters }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::simulate::{Purpose, stream};

    #[test]
    fn what_is_drawn_scatters_as_the_priors_say() {
        let setup = MachineSetup { delay_s: 0.3, zero_sd: 0.0, ..MachineSetup::default() };
        let (sensors, count) = (SensorKind::ALL, 2000);
        let draws: Vec<DrawnMachine> = (0..count)
            .map(|seed| {
                let mut rng = stream(seed, Purpose::Sensor, 0);
                draw_machine(&setup, ImuParameters::identity(), &sensors, 2, &mut rng)
            })
            .collect();
        // lever, mounting, tilt, delays, clock, geometry
        assert_eq!(draws[0].drawn.len(), 3 + 3 + 2 + 2 + 1 + 12);
        let scatter = |of: &dyn Fn(&DrawnMachine) -> f64| {
            (draws.iter().map(|draw| of(draw).powi(2)).sum::<f64>() / count as f64).sqrt()
        };
        let within = |found: f64, sd: f64| {
            // four standard deviations of a standard deviation
            assert!((found / sd - 1.0).abs() < 4.0 / (2.0 * count as f64).sqrt(), "{found} {sd}");
        };
        for k in 0..draws[0].drawn.len() {
            let (quantity, _) = draws[0].drawn[k];
            let offset = if matches!(quantity, MachineQuantity::Delay(_)) { 0.3 } else { 0.0 };
            within(scatter(&|draw| draw.drawn[k].1 - offset), setup.prior_sd(quantity, 2));
        }
        let difference = |draw: &DrawnMachine| {
            let [one, other] = SensorKind::ALL.map(|kind| draw.parameters.delays_s[kind]);
            one - other
        };
        within(scatter(&difference), setup.delay_difference_sd_s);
    }
}

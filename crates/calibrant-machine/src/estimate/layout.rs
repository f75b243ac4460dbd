//! The unknowns of a problem in their order, and what is known of them beforehand.

use super::parameters::AXES;
use super::{MachineParameters, MachineQuantity, MachineSetup, MountingPrior};
use calibrant_core::sensor::{ImuQuantity, SensorKind};
use nalgebra::{DMatrix, DVector};

/// The unknowns, and the information of their priors.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub(super) quantities: Vec<MachineQuantity>,
    /// Information of the priors.
    pub(super) prior: DMatrix<f64>,
    /// What is expected beforehand.
    pub(super) nominal: MachineParameters,
}

impl Layout {
    /// The unknowns of these sensors on this machine.
    pub(super) fn new(
        setup: &MachineSetup,
        sensors: &[SensorKind],
        imu: &[ImuQuantity],
        nominal: MachineParameters,
    ) -> Self {
        let mut known: Vec<(MachineQuantity, f64)> =
            imu.iter().map(|of| (MachineQuantity::Imu(*of), f64::INFINITY)).collect();
        let joints = nominal.corrections.joints.len();
        known.extend(AXES.map(|axis| (MachineQuantity::Lever(axis), setup.lever_sd_m)));
        let mounting_sd = match setup.mounting {
            MountingPrior::Within(sd) => sd,
            MountingPrior::Exact | MountingPrior::Unknown => 0.0,
        };
        known.extend(AXES.map(|axis| (MachineQuantity::Mounting(axis), mounting_sd)));
        let tilt_sd = if setup.gravity_mps2 == 0.0 { 0.0 } else { setup.tilt_sd_rad };
        known.extend([0, 1].map(|k| (MachineQuantity::Tilt(k), tilt_sd)));
        known.push((MachineQuantity::Gravity, setup.gravity_sd_mps2));
        known.extend(sensors.iter().map(|&sensor| (MachineQuantity::Delay(sensor), setup.delay_sd_s)));
        known.push((MachineQuantity::ClockRate, setup.clock_rate_sd));
        known.extend((0..joints).map(|j| (MachineQuantity::Zero(j), setup.zero_sd)));
        for j in 0..joints {
            let sd = |k| if k < 3 { setup.geometry_translation_sd_m } else { setup.geometry_rotation_sd_rad };
            known.extend((0..6).map(|k| (MachineQuantity::Geometry(j, k), sd(k))));
        }
        known.retain(|(_, sd)| *sd > 0.0);
        let information = |sd: f64| if sd.is_finite() { 1.0 / (sd * sd) } else { 0.0 };
        let mut prior = DMatrix::from_diagonal(&DVector::from_iterator(
            known.len(),
            known.iter().map(|(_, sd)| information(*sd)),
        ));
        let quantities: Vec<MachineQuantity> = known.into_iter().map(|(quantity, _)| quantity).collect();
        let delay = |sensor| quantities.iter().position(|of| *of == MachineQuantity::Delay(sensor));
        if let (Some(a), Some(g)) = (delay(SensorKind::Accelerometer), delay(SensorKind::Gyroscope)) {
            let common = 0.25 * information(setup.delay_sd_s);
            let difference = information(setup.delay_difference_sd_s.max(1e-9));
            for (i, j) in [(a, a), (a, g), (g, a), (g, g)] {
                prior[(i, j)] = common + if i == j { difference } else { -difference };
            }
        }
        Self { quantities, prior, nominal }
    }

    pub(super) fn len(&self) -> usize {
        self.quantities.len()
    }

    /// How far the unknowns are from what was expected.
    pub(super) fn deviation(&self, parameters: &MachineParameters) -> DVector<f64> {
        let of = |quantity: &MachineQuantity| {
            parameters.value(*quantity, &self.nominal) - self.nominal.value(*quantity, &self.nominal)
        };
        DVector::from_iterator(self.len(), self.quantities.iter().map(of))
    }

    /// Moves the unknowns.
    pub(super) fn step(&self, parameters: &mut MachineParameters, step: &DVector<f64>) {
        for (quantity, step) in self.quantities.iter().zip(step.iter()) {
            parameters.add(*quantity, *step);
        }
    }
}

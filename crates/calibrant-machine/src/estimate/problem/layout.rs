//! The unknowns of a problem in their order, and what is known of them beforehand.

use crate::estimate::problem::parameters::AXES;
use crate::estimate::{MachineParameters, MachineQuantity, MachineSetup, MountingPrior};
use calibrant_core::sensor::{ImuQuantity, SensorKind, SensorModel};
use nalgebra::{DMatrix, DVector};

/// The unknowns, and the information of their priors.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub(crate) quantities: Vec<MachineQuantity>,
    /// Information of the priors.
    pub(crate) prior: DMatrix<f64>,
    /// What is expected beforehand.
    pub(crate) nominal: MachineParameters,
}

impl Layout {
    /// The unknowns of these sensors on this machine.
    pub(crate) fn new(
        setup: &MachineSetup,
        sensors: &[SensorKind],
        imu: &[ImuQuantity],
        nominal: MachineParameters,
    ) -> Self {
        let joints = 0..nominal.corrections.joints.len();
        let mut quantities: Vec<MachineQuantity> = imu.iter().map(|of| MachineQuantity::Imu(*of)).collect();
        quantities.extend(AXES.map(MachineQuantity::Lever));
        quantities.extend(AXES.map(MachineQuantity::Mounting));
        quantities.extend([0, 1].map(MachineQuantity::Tilt));
        quantities.push(MachineQuantity::Gravity);
        quantities.extend(sensors.iter().map(|&sensor| MachineQuantity::Delay(sensor)));
        quantities.push(MachineQuantity::ClockRate);
        quantities.extend(joints.clone().map(MachineQuantity::Zero));
        quantities.extend(joints.flat_map(|j| (0..6).map(move |k| MachineQuantity::Geometry(j, k))));
        if setup.mounting == MountingPrior::Unknown {
            quantities.retain(|quantity| in_gauge(*quantity, sensors[0]));
        }
        let sd = |quantity: &MachineQuantity| setup.prior_sd(*quantity, sensors.len());
        quantities.retain(|quantity| sd(quantity) > 0.0);
        let information = |sd: f64| if sd.is_finite() { 1.0 / (sd * sd) } else { 0.0 };
        let of_each = quantities.iter().map(|quantity| information(sd(quantity)));
        let mut prior = DMatrix::from_diagonal(&DVector::from_iterator(quantities.len(), of_each));
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

    pub(crate) fn len(&self) -> usize {
        self.quantities.len()
    }

    /// How far the unknowns are from what was expected.
    pub(crate) fn deviation(&self, parameters: &MachineParameters) -> DVector<f64> {
        let of = |quantity: &MachineQuantity| {
            parameters.value(*quantity, &self.nominal) - self.nominal.value(*quantity, &self.nominal)
        };
        DVector::from_iterator(self.len(), self.quantities.iter().map(of))
    }

    /// Moves the unknowns.
    pub(crate) fn step(&self, parameters: &mut MachineParameters, step: &DVector<f64>) {
        for (quantity, step) in self.quantities.iter().zip(step.iter()) {
            parameters.add(*quantity, *step);
        }
    }
}

/// Is a quantity estimated where nothing is known of the mounting? `S R` and the mounting turned by `R` read the same for every rotation `R`.
/// The gauge of the `first` sensor picks one.
fn in_gauge(quantity: MachineQuantity, first: SensorKind) -> bool {
    match quantity {
        MachineQuantity::Imu(ImuQuantity::Of(sensor, of)) if sensor == first => {
            MountingPrior::GAUGE.parameter_list(SensorModel::Full).quantities().contains(&of)
        }
        _ => true,
    }
}

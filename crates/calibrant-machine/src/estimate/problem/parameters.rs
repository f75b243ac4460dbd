//! The values of all unknowns but the motion.

use crate::chain::{ChainCorrections, SensorMount};
use crate::estimate::{MachineQuantity, MachineSetup, MountingPrior};
use calibrant_core::sensor::{ImuParameters, ImuQuantity, PerSensor, SensorKind, SensorModel};
use nalgebra::{DMatrix, DVector, Matrix3x2, UnitQuaternion, Vector2, Vector3};

/// The sensor, its mount, gravity, clocks and joints.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineParameters {
    /// The sensor.
    pub imu: ImuParameters,
    /// Where it is on the tip.
    pub mount: SensorMount,
    /// Tilt of gravity against the base, rad.
    pub tilt_rad: Vector2<f64>,
    /// Magnitude of gravity, m/s².
    pub gravity_mps2: f64,
    /// Delay of the accelerometer and of the gyroscope, s.
    pub delays_s: PerSensor<f64>,
    /// Rate of the reference's clock against the IMU's, less 1.
    pub clock_rate: f64,
    /// Corrections of the joints.
    pub corrections: ChainCorrections,
}

impl MachineParameters {
    /// What is known beforehand, with this sensor.
    #[must_use]
    pub fn nominal(setup: &MachineSetup, mut imu: ImuParameters, joints: usize) -> Self {
        for known in &setup.known {
            let away = known.value - known.quantity.value(&imu);
            known.quantity.add_to(&mut imu, away);
        }
        Self {
            imu,
            mount: SensorMount { lever_m: setup.lever_m, tip_from_sensor: setup.tip_from_sensor },
            tilt_rad: Vector2::zeros(),
            gravity_mps2: setup.gravity_mps2,
            delays_s: PerSensor::from_fn(|_| setup.delay_s),
            clock_rate: 0.0,
            corrections: ChainCorrections::none(joints),
        }
    }

    /// Moves one unknown.
    pub(crate) fn add(&mut self, quantity: MachineQuantity, step: f64) {
        match quantity {
            MachineQuantity::Imu(of) => of.add_to(&mut self.imu, step),
            MachineQuantity::Lever(axis) => self.mount.lever_m[axis.index()] += step,
            MachineQuantity::Mounting(axis) => {
                let mut turn = Vector3::zeros();
                turn[axis.index()] = step;
                self.mount.tip_from_sensor *= UnitQuaternion::from_scaled_axis(turn);
            }
            MachineQuantity::Tilt(k) => self.tilt_rad[k] += step,
            MachineQuantity::Gravity => self.gravity_mps2 += step,
            MachineQuantity::Delay(sensor) => self.delays_s[sensor] += step,
            MachineQuantity::ClockRate => self.clock_rate += step,
            MachineQuantity::Zero(j) => self.corrections.joints[j].zero += step,
            MachineQuantity::Geometry(j, k) if k < 3 => self.corrections.joints[j].translation_m[k] += step,
            MachineQuantity::Geometry(j, k) => self.corrections.joints[j].rotation_rad[k - 3] += step,
        }
    }

    /// The value of an unknown; the mounting's is its turn against `nominal`.
    pub(crate) fn value(&self, quantity: MachineQuantity, nominal: &Self) -> f64 {
        match quantity {
            MachineQuantity::Imu(of) => of.value(&self.imu),
            MachineQuantity::Lever(axis) => self.mount.lever_m[axis.index()],
            MachineQuantity::Mounting(axis) => self.turn(nominal)[axis.index()],
            MachineQuantity::Tilt(k) => self.tilt_rad[k],
            MachineQuantity::Gravity => self.gravity_mps2,
            MachineQuantity::Delay(sensor) => self.delays_s[sensor],
            MachineQuantity::ClockRate => self.clock_rate,
            MachineQuantity::Zero(j) => self.corrections.joints[j].zero,
            MachineQuantity::Geometry(j, k) if k < 3 => self.corrections.joints[j].translation_m[k],
            MachineQuantity::Geometry(j, k) => self.corrections.joints[j].rotation_rad[k - 3],
        }
    }

    /// Rotation of the sensor against the nominal mounting, rad.
    #[must_use]
    pub fn turn(&self, nominal: &Self) -> Vector3<f64> {
        (nominal.mount.tip_from_sensor.inverse() * self.mount.tip_from_sensor).scaled_axis()
    }

    /// Time of the motion at which a sensor took a sample, s. `middle_s` is that of the recording, about which the clock's rate counts.
    #[must_use]
    pub fn motion_time(&self, sensor: SensorKind, time_s: f64, middle_s: f64) -> f64 {
        time_s + self.clock_rate * (time_s - middle_s) + self.delays_s[sensor]
    }
}

/// Gravity in the base frame, tilted about two axes perpendicular to the direction up.
#[derive(Debug, Clone, Copy)]
pub struct TiltedGravity {
    up: Vector3<f64>,
    /// The axes of the tilt.
    axes: Matrix3x2<f64>,
}

impl TiltedGravity {
    /// For this direction up. Tilts are about the axes of the base where up is one of them.
    #[must_use]
    pub fn new(up: &Vector3<f64>) -> Self {
        let up = up.normalize();
        let largest = up.iamax();
        let mut first = Vector3::zeros();
        first[(largest + 1) % 3] = 1.0;
        let first = (first - up * up.dot(&first)).normalize();
        Self { up, axes: Matrix3x2::from_columns(&[first, up.cross(&first)]) }
    }

    /// `γ = −g exp(tilt) up`.
    #[must_use]
    pub fn vector(&self, parameters: &MachineParameters) -> Vector3<f64> {
        self.direction(parameters) * -parameters.gravity_mps2
    }

    fn direction(&self, parameters: &MachineParameters) -> Vector3<f64> {
        UnitQuaternion::from_scaled_axis(self.axes * parameters.tilt_rad) * self.up
    }

    /// Derivative of `γ` by the two tilts (exact at none, and of second order in them otherwise) and by the magnitude.
    #[must_use]
    pub fn derivatives(&self, parameters: &MachineParameters) -> [Vector3<f64>; 3] {
        let gravity = self.vector(parameters);
        let tilt = self.axes * parameters.tilt_rad;
        let left = crate::spline::right_jacobian(&tilt).transpose();
        let by = |k: usize| (left * self.axes.column(k)).cross(&gravity);
        [by(0), by(1), -self.direction(parameters)]
    }
}

/// The unknowns in their order, and the information of their priors. A quantity that is known exactly is none of them.
#[derive(Debug, Clone)]
pub struct Layout {
    /// The unknowns: those of the sensor, then those of the machine.
    pub quantities: Vec<MachineQuantity>,
    /// Information of the priors.
    pub prior: DMatrix<f64>,
    /// What is expected beforehand.
    pub nominal: MachineParameters,
}

impl Layout {
    /// The unknowns of these sensors on this machine.
    #[must_use]
    pub fn new(
        setup: &MachineSetup,
        sensors: &[SensorKind],
        imu: &[ImuQuantity],
        nominal: MachineParameters,
    ) -> Self {
        let mut quantities: Vec<MachineQuantity> = imu.iter().map(|of| MachineQuantity::Imu(*of)).collect();
        quantities.extend(MachineQuantity::of_machine(sensors, nominal.corrections.joints.len()));
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

//! Draws sensors and whole IMUs at random from the datasheet.

use super::Rng;
use super::recording::normal;
use crate::sensor::{
    ImuParameters, ImuQuantity, Quantity, Sensor, SensorKind, SensorModel, SensorParameters, Thermal,
    ThermalPart,
};
use nalgebra::{Matrix3, Vector3};

/// Spread of the bias where the datasheet gives none, m/s² and rad/s.
const BIAS_SD: [f64; 2] = [0.1, 0.02];
/// Spread of the entries of the matrix over the gain where the datasheet gives none: that of common MEMS sensors.
pub const MATRIX_SD: f64 = 0.01;
/// Spread of the g-sensitivity, (rad/s)/(m/s²).
const G_SENSITIVITY_SD: f64 = 2e-4;
/// Spread of the temperature coefficient of an accelerometer bias, m/s²/K.
const ACCELEROMETER_BIAS_PER_K: f64 = 1e-3;
/// Spread of the temperature coefficient of a gyroscope bias, rad/s/K.
const GYROSCOPE_BIAS_PER_K: f64 = 1e-4;
/// Spread of the temperature coefficient of a gain, 1/K.
const SCALE_PER_K: f64 = 5e-5;

/// The gyroscope that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroscopeToDraw {
    /// Which errors it has.
    pub model: SensorModel,
    /// Nominal gain in the unit of the readings per rad/s; 1 for readings in rad/s.
    pub gain: Vector3<f64>,
    /// Has it g-sensitivity?
    pub g_sensitivity: bool,
}

/// An IMU drawn from the accelerometer's datasheet and the gyroscope's gain. Spreads that no datasheet gives
/// are those of common MEMS sensors. Biases have 0.1 m/s² and 0.02 rad/s, gains and misalignments 1 %, and
/// the g-sensitivity 2e-4 (rad/s)/(m/s²).
#[must_use]
pub fn draw_imu(accelerometer: &Sensor, gyroscope: &GyroscopeToDraw, rng: &mut Rng) -> ImuParameters {
    let spread = Sensor {
        bias_sd_mps2: Some(accelerometer.bias_sd_mps2.unwrap_or_else(|| Vector3::repeat(BIAS_SD[0]))),
        scale_sd: Some(accelerometer.scale_sd.unwrap_or_else(|| Vector3::repeat(MATRIX_SD))),
        cross_axis_sd: Some(accelerometer.cross_axis_sd.unwrap_or(MATRIX_SD)),
        ..accelerometer.clone()
    };
    let of_accelerometer = draw_sensor(&spread, rng);
    let mut draw = |sd: f64| sd * normal(rng);
    let gain = Matrix3::from_diagonal(&gyroscope.gain);
    let bias = gain * Vector3::from_fn(|_, _| draw(BIAS_SD[1]));
    let errors = Matrix3::from_fn(|row, column| {
        let error = draw(MATRIX_SD);
        if row == column || gyroscope.model == SensorModel::Full { error } else { 0.0 }
    });
    let felt = Matrix3::from_fn(|_, _| draw(G_SENSITIVITY_SD));
    ImuParameters {
        sensors: [of_accelerometer, SensorParameters::linear(bias, gain * (Matrix3::identity() + errors))]
            .into(),
        g_sensitivity: if gyroscope.g_sensitivity { gain * felt } else { Matrix3::zeros() },
        thermal: Thermal::none(),
    }
}

/// Draws the temperature terms among these quantities. `gains` are the nominal gains of accelerometer and
/// gyroscope, in the unit of the readings. Over 25 K a bias moves by some 25 mm/s² or 0.15 °/s, and a gain
/// changes by 0.1 %. A MEMS IMU of the middle class is about as sensitive. Each further order has a twentieth
/// of that per K.
pub fn draw_thermal(
    imu: &mut ImuParameters,
    quantities: &[ImuQuantity],
    gains: [Vector3<f64>; 2],
    rng: &mut Rng,
) {
    for quantity in quantities {
        let ImuQuantity::Thermal(sensor_kind, term) = *quantity else { continue };
        let first = match (term.part, sensor_kind) {
            (ThermalPart::Bias, SensorKind::Accelerometer) => {
                ACCELEROMETER_BIAS_PER_K * gains[0][term.axis.index()]
            }
            (ThermalPart::Bias, SensorKind::Gyroscope) => GYROSCOPE_BIAS_PER_K * gains[1][term.axis.index()],
            (ThermalPart::Scale, _) => SCALE_PER_K,
        };
        quantity.add_to(imu, first * normal(rng) / 20f64.powi(term.order as i32 - 1));
    }
}

/// Gives a known quantity the value at which it is fixed, or draws it from its prior: a normal distribution.
pub fn draw_known(
    imu: &mut ImuParameters,
    quantity: ImuQuantity,
    value: f64,
    sd: Option<f64>,
    rng: &mut Rng,
) {
    let error = sd.map_or(0.0, |sd| sd * normal(rng));
    let before = quantity.value(imu);
    quantity.add_to(imu, value + error - before);
}

/// A sensor drawn from the datasheet: each parameter `N(nominal, spread²)`, or the nominal value without a
/// spread. Where the datasheet gives no gain or offset, they count as 1 and 0.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::Sensor;
/// use calibrant_core::simulate::{Purpose, draw_sensor, stream};
/// let sensor = draw_sensor(&Sensor::memsic_mxd2020u(), &mut stream(1, Purpose::Sensor, 0));
/// assert!(sensor.bias.norm() > 0.0 && (sensor.matrix[(0, 0)] - 1.0).abs() < 0.05);
/// ```
pub fn draw_sensor(datasheet: &Sensor, rng: &mut Rng) -> SensorParameters {
    let mut sensor = SensorParameters {
        bias: datasheet.offset.unwrap_or_else(Vector3::zeros),
        matrix: Matrix3::from_diagonal(&datasheet.gain.unwrap_or_else(|| Vector3::repeat(1.0))),
        ..SensorParameters::identity()
    };
    let list = datasheet.parameter_list();
    let spreads = list.describe(datasheet, &sensor);
    for (quantity, parameter) in list.quantities().iter().zip(spreads) {
        Quantity::add_to(*quantity, &mut sensor, normal(rng) * parameter.spread.unwrap_or(0.0));
    }
    sensor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Purpose, stream};

    #[test]
    fn what_is_known_scatters_by_its_uncertainty() {
        let mut rng = stream(1, Purpose::Sensor, 0);
        let mut imu = ImuParameters::identity();
        let quantity = ImuQuantity::full_list(true, true, true)[16];
        draw_known(&mut imu, quantity, 0.25, None, &mut rng);
        assert!((quantity.value(&imu) - 0.25).abs() < 1e-15);
        let n = 10_000;
        let draws: Vec<f64> = (0..n)
            .map(|_| {
                draw_known(&mut imu, quantity, 3.0, Some(0.1), &mut rng);
                quantity.value(&imu)
            })
            .collect();
        // four standard deviations of a mean and of a standard deviation
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        assert!((mean - 3.0).abs() < 4.0 * 0.1 / 100.0, "{mean}");
        let sd = (draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n)).sqrt();
        assert!((sd / 0.1 - 1.0).abs() < 4.0 / 20_000.0_f64.sqrt(), "{sd}");
    }
}

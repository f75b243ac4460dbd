//! The rotation between two holds, integrated from the gyroscope's readings on SO(3), with its derivatives and its noise.
//!
//! With `M = S_g⁻¹` the corrected rate is `ω = M (y − b − Γ f)`. `R(t)`, from the sensor's frame at time t to that at the start, follows `Ṙ = R ω^`.
//! The rate is linear between two samples. The Magnus expansion then gives `R_{k+1} = R_k exp(Ω^)` with `Ω = h (ω_k + ω_{k+1})/2 + h²/12 ω_k × ω_{k+1}`.
//! The second term is the coning, which a sum of rates lacks.
//!
//! A small change `δω(t)` turns the end by `δθ` (in the frame of the start): `R(T) → exp(δθ^) R(T)`, `δθ = ∫ R(t) δω(t) dt`. So three sums over the samples
//! give all derivatives: `∫ R ω_cᵀ`, `∫ R`, `∫ R f_c`. White noise of covariance `Σ_ν` for each sample adds `Σ_k w_k² R_k M Σ_ν Mᵀ R_kᵀ`, with `w_k` the
//! weight of sample k in s.
//!
//! The gain is that at the mean temperature of the holds before and after. The bias is linear in time, from its value in the hold before to that in the
//! hold after.
//!
//! # References
//! `iserles1999`, `tedaldi2014`

use crate::estimate::imu::least_squares::angular_rate::Rates;
use crate::estimate::imu::model::{IntegratedRotation, LocalBias, Samples, mean_temperature_c};
use crate::sensor::{ImuParameters, ImuQuantity, Quantity, SensorKind, ThermalPart, times};
use nalgebra::{Matrix3, Matrix3xX, Quaternion, UnitQuaternion, Vector3};

/// The factor of the coning term.
const TWELFTH: f64 = 1.0 / 12.0;

impl Samples<'_> {
    /// Integrates the samples for an IMU. `None` if the gyroscope's matrix is singular. `noise`: standard deviation of one sample.
    pub(crate) fn integrate(&self, imu: &ImuParameters, noise: &Vector3<f64>) -> Option<IntegratedRotation> {
        let rates = Rates::of(self, imu)?;
        let correction = rates.correction;
        let noise_root = correction * Matrix3::from_diagonal(noise);
        let mut attitude = UnitQuaternion::identity();
        let mut sums = Sums::default();
        let (mut before, mut part, mut felt) = (0.0, 0.0, rates.force(0));
        let mut here = rates.at(0, 0.0, &felt);
        for k in 0..self.times_s.len() {
            let after = rates.step_after(k);
            let weight = 0.5 * (before + after);
            sums.add(&matrix(&attitude), weight, &here, part, &felt, &noise_root);
            if k + 1 < self.times_s.len() {
                (before, part, felt) = (after, rates.part(k + 1), rates.force(k + 1));
                let next = rates.at(k + 1, part, &felt);
                let turn = (here + next) * (0.5 * after) + here.cross(&next) * (after * after * TWELFTH);
                attitude *= exponential(&turn);
                here = next;
            }
        }
        let (by_start, by_end) = (sums.integral(3), sums.integral(4));
        let mut covariance = sums.covariance();
        // the noise of the two means
        for (by_bias, end) in [(by_start, &self.drift[0]), (by_end, &self.drift[1])] {
            let noise = end.share.component_mul(&end.share).component_mul(&end.variance);
            let by_mean = by_bias * correction;
            covariance += by_mean * Matrix3::from_diagonal(&noise) * by_mean.transpose();
        }
        Some(IntegratedRotation {
            start_from_end: matrix(&attitude),
            by_rate: [0, 1, 2].map(|scalar| sums.integral(scalar)),
            by_start,
            by_end,
            drift: self.drift,
            by_force: [5, 6, 7].map(|scalar| sums.integral(scalar)),
            correction,
            covariance,
        })
    }

    /// The integral of the readings less a bias over each `step` samples: the coarse rotation.
    pub(crate) fn cut_down(&self, bias: &Vector3<f64>, step: usize) -> Vec<Vector3<f64>> {
        let last = self.times_s.len() - 1;
        (0..last)
            .step_by(step)
            .map(|k| {
                let next = (k + step).min(last);
                let mean = self.readings[k..=next].iter().sum::<Vector3<f64>>() / (next - k + 1) as f64;
                (mean - bias) * (self.times_s[next] - self.times_s[k])
            })
            .collect()
    }
}

/// A vector of the start's frame, in the frame at the end of a [coarse rotation](Samples::cut_down).
pub(crate) fn propagated_back(
    turns: &[Vector3<f64>],
    correction: &Matrix3<f64>,
    vector: &Vector3<f64>,
) -> Vector3<f64> {
    let mut attitude = UnitQuaternion::identity();
    for turn in turns {
        attitude *= exponential(&times(correction, turn));
    }
    attitude.inverse() * vector
}

/// The sums over the samples, entry by entry. A calibration spends most of its time here.
#[derive(Default)]
struct Sums {
    /// `∫ R_rc s dt` in `[c][r]` for s = ω_x, ω_y, ω_z, 1 − x, x, f_x, f_y, f_z: eight at once, for vector instructions.
    of_attitude: [[[f64; 8]; 3]; 3],
    /// `Σ w² (R N)(R N)ᵀ` with N Nᵀ the covariance of a rate: xx, yy, zz, xy, xz, yz.
    squares: [f64; 6],
}

impl Sums {
    #[inline]
    fn add(
        &mut self,
        r: &Matrix3<f64>,
        weight: f64,
        rate: &Vector3<f64>,
        part: f64,
        force: &Vector3<f64>,
        noise_root: &Matrix3<f64>,
    ) {
        let scalars = [rate.x, rate.y, rate.z, 1.0 - part, part, force.x, force.y, force.z];
        for (sums, column) in self.of_attitude.iter_mut().zip(&r.data.0) {
            for (sums, entry) in sums.iter_mut().zip(column) {
                let weighted = entry * weight;
                for i in 0..8 {
                    sums[i] += weighted * scalars[i];
                }
            }
        }
        // rows of w R N
        let [x, y, z] = [0, 1, 2].map(|row| {
            let r = [r[(row, 0)] * weight, r[(row, 1)] * weight, r[(row, 2)] * weight];
            noise_root.data.0.map(|n| r[0] * n[0] + r[1] * n[1] + r[2] * n[2])
        });
        let pairs = [(&x, &x), (&y, &y), (&z, &z), (&x, &y), (&x, &z), (&y, &z)];
        for (sum, (a, b)) in self.squares.iter_mut().zip(pairs) {
            *sum += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        }
    }

    /// `∫ R s dt` of the scalar in this place.
    fn integral(&self, scalar: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.of_attitude[column][row][scalar])
    }

    fn covariance(&self) -> Matrix3<f64> {
        let [xx, yy, zz, xy, xz, yz] = self.squares;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }
}

#[inline]
fn matrix(attitude: &UnitQuaternion<f64>) -> Matrix3<f64> {
    attitude.to_rotation_matrix().into_inner()
}

/// The rotation by a vector, rad.
///
/// # Numerics
/// The angle between two samples is small. Five terms of the series of `cos` and `sin(x)/x` at half the angle have an error below 1e-16.
#[inline]
pub(crate) fn exponential(turn: &Vector3<f64>) -> UnitQuaternion<f64> {
    const SMALL: f64 = 0.01;
    let half = turn * 0.5;
    let h = half.norm_squared();
    if h > SMALL {
        return UnitQuaternion::from_scaled_axis(*turn);
    }
    let h2 = h * h;
    // in pairs, which are independent of each other
    let cos = (1.0 - h / 2.0) + h2 * ((1.0 / 24.0 - h * (1.0 / 720.0)) + h2 * (1.0 / 40_320.0));
    let sinc = (1.0 - h * (1.0 / 6.0)) + h2 * ((1.0 / 120.0 - h * (1.0 / 5040.0)) + h2 * (1.0 / 362_880.0));
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cos, half * sinc))
}

impl IntegratedRotation {
    /// Derivative of `δθ` with respect to a common error of all readings.
    pub(crate) fn by_reading(&self) -> Matrix3<f64> {
        (self.by_start + self.by_end) * self.correction
    }

    /// Derivative of `δθ` with respect to readings in the holds before and after, which contribute to the bias.
    pub(crate) fn by_readings_at_ends(&self, readings: &[Matrix3xX<f64>; 2]) -> Matrix3xX<f64> {
        let [start, end] = self.drift.map(|end| self.correction * Matrix3::from_diagonal(&end.share));
        self.by_start * start * &readings[0] + self.by_end * end * &readings[1]
    }

    /// Derivative of `δθ` with respect to a g-sensitivity that does not affect the bias of the holds.
    pub(crate) fn by_g_sensitivity(&self, entries: &Matrix3<f64>) -> Vector3<f64> {
        let rates = self.correction * entries;
        -(0..3).map(|column| self.by_force[column] * rates.column(column)).sum::<Vector3<f64>>()
    }

    /// Covariance of `δθ` with that of the rotation before. Both use the bias from the hold between them, and share the noise of its mean.
    pub(crate) fn noise_with(&self, before: &Self) -> Matrix3<f64> {
        let common = &self.drift[0];
        let noise = common.share.component_mul(&common.share).component_mul(&common.variance);
        let (here, there) = (self.by_start * self.correction, before.by_end * before.correction);
        here * Matrix3::from_diagonal(&noise) * there.transpose()
    }

    /// Derivative of `δθ` with respect to a quantity of an IMU; zero for those of the accelerometer.
    pub(crate) fn derivative(&self, quantity: ImuQuantity, imu: &ImuParameters) -> Vector3<f64> {
        let thermal = &imu.thermal;
        let tau_k = thermal.tau_k(mean_temperature_c(&self.drift));
        let factor = thermal[SensorKind::Gyroscope].gain_factor(tau_k);
        // a reading larger by δy means a rate smaller by M δy, less the part that the holds attribute to the bias
        let own =
            |sums: &[Matrix3<f64>; 3], row: usize, column: usize, still: fn(&LocalBias) -> &Vector3<f64>| {
                let [start, end] = [0, 1].map(|k| self.drift[k].share[row] * still(&self.drift[k])[column]);
                -((sums[column] - self.by_start * start - self.by_end * end) * self.correction.column(row))
            };
        let entry =
            |row: usize, column: usize| own(&self.by_rate, row, column, |end| &end.rate) * factor[row];
        // a bias larger by the first in the hold before, and by the second in the hold after
        let bias = |axis: usize, by: [f64; 2]| {
            let [start, end] = self.drift.map(|end| end.share[axis]);
            let left = self.by_start * ((1.0 - start) * by[0]) + self.by_end * ((1.0 - end) * by[1]);
            -(left * self.correction.column(axis))
        };
        match quantity {
            ImuQuantity::Of(SensorKind::Accelerometer, _)
            | ImuQuantity::Thermal(SensorKind::Accelerometer, _) => Vector3::zeros(),
            ImuQuantity::Thermal(SensorKind::Gyroscope, term) => {
                let axis = term.axis.index();
                match term.part {
                    ThermalPart::Bias => {
                        bias(axis, self.drift.map(|end| term.power(thermal.tau_k(end.temperature_c))))
                    }
                    ThermalPart::Scale => {
                        let row = imu[SensorKind::Gyroscope].matrix.row(axis);
                        let along: Vector3<f64> =
                            (0..3).map(|column| entry(axis, column) * row[column]).sum();
                        along * (term.power(tau_k) / factor[axis])
                    }
                }
            }
            ImuQuantity::Of(SensorKind::Gyroscope, quantity) => match quantity {
                Quantity::Bias(axis) => bias(axis.index(), [1.0; 2]),
                Quantity::Scale(axis) => entry(axis.index(), axis.index()),
                Quantity::CrossAxis(row, column) => entry(row.index(), column.index()),
                Quantity::Symmetric(row, column) => {
                    entry(row.index(), column.index()) + entry(column.index(), row.index())
                }
                // terms bend the response of accelerometers only
                Quantity::Nonlinear(..) => Vector3::zeros(),
            },
            ImuQuantity::GSensitivity(row, column) => {
                own(&self.by_force, row.index(), column.index(), |end| &end.force)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{Axis, ParameterList, SensorModel, SensorParameters};

    fn imu() -> ImuParameters {
        ImuParameters {
            g_sensitivity: Matrix3::new(1.0, 0.5, -0.3, 0.2, -0.8, 0.1, 0.4, 0.3, 0.6) * 1e-3,
            ..ImuParameters::identity().with(
                SensorKind::Gyroscope,
                SensorParameters {
                    bias: Vector3::new(0.02, -0.03, 0.01),
                    matrix: Matrix3::new(1.05, 0.02, -0.01, 0.03, 0.97, 0.02, -0.02, 0.01, 1.02),
                    ..SensorParameters::identity()
                },
            )
        }
    }

    struct Coning {
        times: Vec<f64>,
        readings: Vec<Vector3<f64>>,
        forces: Vec<Vector3<f64>>,
        exact: Matrix3<f64>,
    }

    impl Coning {
        fn samples(&self) -> Samples<'_> {
            Samples {
                times_s: &self.times,
                readings: &self.readings,
                forces: Some(&self.forces),
                drift: [LocalBias::none(25.0); 2],
            }
        }
    }

    /// A motion whose attitude is known in closed form: coning, `R(t) = exp(φ t e_z) exp(β e_x) exp(−φ t e_z)`.
    fn coning(rate_hz: f64) -> Coning {
        let (phi, beta, end) = (3.0, 0.4, 1.7);
        let n = (end * rate_hz) as usize;
        let attitude = |t: f64| {
            let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
            about(Vector3::z(), phi * t) * about(Vector3::x(), beta) * about(Vector3::z(), -phi * t)
        };
        let times: Vec<f64> = (0..=n).map(|k| end * k as f64 / n as f64).collect();
        let forces: Vec<_> =
            times.iter().map(|t| attitude(*t).inverse() * Vector3::new(0.0, 0.0, 9.8)).collect();
        let imu = imu();
        let readings = times
            .iter()
            .zip(&forces)
            .map(|(t, force)| {
                let h = 1e-5;
                let step = (attitude(t - h).inverse() * attitude(t + h)).scaled_axis() / (2.0 * h);
                imu[SensorKind::Gyroscope].reading(&step) + imu.g_sensitivity * force
            })
            .collect();
        let exact = (attitude(0.0).inverse() * attitude(end)).to_rotation_matrix().into_inner();
        Coning { times, readings, forces, exact }
    }

    #[test]
    fn coning_is_followed_where_a_sum_of_rates_is_not_enough() {
        let error = |rate: f64| {
            let coning = coning(rate);
            let rotation = coning.samples().integrate(&imu(), &Vector3::zeros()).expect("regular");
            (rotation.start_from_end - coning.exact).norm()
        };
        let (coarse, fine) = (error(50.0), error(100.0));
        // linear interpolation of the rate is of second order
        assert!(coarse < 1e-3, "{coarse:e}");
        assert!((3.8..4.2).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
        // the sum of rates, whatever the sample rate
        let coning = coning(400.0);
        let imu = imu();
        let correction = imu[SensorKind::Gyroscope].matrix.try_inverse().expect("regular");
        let rates = coning.readings.iter().zip(&coning.forces).map(|(reading, force)| {
            correction * (reading - imu[SensorKind::Gyroscope].bias - imu.g_sensitivity * force)
        });
        let step = coning.times[1] - coning.times[0];
        let sum = UnitQuaternion::from_scaled_axis(rates.sum::<Vector3<f64>>() * step);
        let naive = (sum.to_rotation_matrix().into_inner() - coning.exact).norm();
        assert!(naive > 0.05, "{naive:e}");
    }

    #[test]
    fn the_exponential_is_exact_for_small_and_large_angles() {
        for angle in [0.0, 1e-9, 1e-3, 0.1, 0.199, 0.201, 2.0] {
            let turn = Vector3::new(0.6, -0.48, 0.64) * angle;
            let exact = UnitQuaternion::from_axis_angle(
                &nalgebra::Unit::new_normalize(Vector3::new(0.6, -0.48, 0.64)),
                angle,
            );
            let error = (exponential(&turn).coords - exact.coords).amax();
            assert!(error < 3e-16, "{angle}: {error:e}");
        }
    }

    #[test]
    fn derivatives_equal_differences() {
        let coning = coning(400.0);
        let end = |temperature_c: f64, share: f64| LocalBias {
            mean: Vector3::new(0.05, 0.02, -0.04),
            force: Vector3::new(1.0, -2.0, 9.0),
            share: Vector3::repeat(share),
            ..LocalBias::none(temperature_c)
        };
        let samples = Samples { drift: [end(28.0, 0.4), end(37.0, 0.7)], ..coning.samples() };
        let mut at = imu();
        for quantity in ImuQuantity::thermal_list(SensorKind::Gyroscope, 2, 2) {
            quantity.add_to(&mut at, 1e-4);
        }
        let rotation = samples.integrate(&at, &Vector3::zeros()).expect("regular");
        let mut quantities: Vec<ImuQuantity> = ParameterList::new(3, SensorModel::Full)
            .quantities()
            .iter()
            .map(|quantity| ImuQuantity::Of(SensorKind::Gyroscope, *quantity))
            .collect();
        quantities.extend(
            Axis::ALL
                .iter()
                .flat_map(|row| Axis::ALL.iter().map(|column| ImuQuantity::GSensitivity(*row, *column))),
        );
        quantities.extend(ImuQuantity::thermal_list(SensorKind::Gyroscope, 2, 2));
        for quantity in quantities {
            let step = 1e-5;
            let moved = |by: f64| {
                let mut imu = at;
                quantity.add_to(&mut imu, by);
                samples.integrate(&imu, &Vector3::zeros()).expect("regular").start_from_end
            };
            let change = (moved(step) - moved(-step)) / (2.0 * step) * rotation.start_from_end.transpose();
            let turn = Vector3::new(change[(2, 1)], change[(0, 2)], change[(1, 0)]);
            let error = (turn - rotation.derivative(quantity, &at)).norm();
            // the sums are of second order in the sample step, enough for a search direction
            assert!(error < 1e-4 * turn.norm().max(1.0), "{}: {error:e}", quantity.name());
        }
    }
}

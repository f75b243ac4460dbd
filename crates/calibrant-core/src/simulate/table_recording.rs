//! Simulated recordings of an IMU on a table: put down on faces, turned by known angles.

use super::imu_setup::Stimuli;
use super::recording::normal;
use super::{ImuSimulation, Rng};
use crate::motion::turn_axis_sd_rad;
use crate::sensor::{ImuParameters, ImuRecording};
use nalgebra::{Unit, UnitQuaternion, Vector3};

/// The recording begins and ends this long before and after the listed steps, s.
const MARGIN_S: f64 = 1.0;

/// One step on the table and its times, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableStep {
    /// Start, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
    /// The action.
    pub action: TableAction,
}

/// An action with the IMU on a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TableAction {
    /// Kept still, with the specific force (up) along this unit vector of the true frame.
    Hold(Vector3<f64>),
    /// Turned about this unit vector of the true frame by an angle, rad. The turn begins and ends at rest.
    /// The actual axis and angle scatter with this standard deviation.
    Turn {
        /// The axis.
        axis: Vector3<f64>,
        /// The angle.
        angle_rad: f64,
        /// Standard deviation of the actual angle, rad.
        angle_sd_rad: f64,
        /// That of the actual axis, rad; without it, as [`Turn::axis_sd_rad`](crate::estimate::Turn::axis_sd_rad).
        axis_sd_rad: Option<f64>,
    },
}

/// The recording of an IMU that is put down and turned as listed, in order of time. In between it is turned
/// over from each face to the next. `setup` gives rate, gravity, noise, units and temperature.
///
/// Attitudes between samples are exact. Rates are the mean over a sample step, so the sum of the gyroscope's
/// rates is the actual angle.
pub fn simulate_table(
    imu: &ImuParameters,
    steps: &[TableStep],
    setup: &ImuSimulation,
    rng: &mut Rng,
) -> ImuRecording {
    let step_s = 1.0 / setup.rate_hz;
    let from_s = steps.first().map_or(0.0, |step| step.start_s).min(MARGIN_S) - MARGIN_S;
    let until_s = steps.last().map_or(0.0, |step| step.end_s) + MARGIN_S;
    let samples = ((until_s - from_s) / step_s).round() as usize;
    let mut normal = || normal(rng);
    let up = Vector3::new(0.0, 0.0, setup.gravity_mps2);
    // attitudes: where each step starts and ends
    let mut world_from_sensor = first_face(steps);
    let mut path: Vec<(f64, f64, UnitQuaternion<f64>, Vector3<f64>)> = Vec::new();
    let mut end_s = from_s;
    for step in steps {
        match step.action {
            TableAction::Hold(direction) => {
                let mut over = turn_over(&world_from_sensor, &direction);
                if setup.face_sd_rad > 0.0 {
                    let tilt = Vector3::from_fn(|_, _| setup.face_sd_rad * normal());
                    let met = UnitQuaternion::from_scaled_axis(over) * UnitQuaternion::from_scaled_axis(tilt);
                    over = met.scaled_axis();
                }
                path.push((end_s, step.start_s, world_from_sensor, over));
                world_from_sensor *= UnitQuaternion::from_scaled_axis(over);
            }
            TableAction::Turn { axis, angle_rad, angle_sd_rad, axis_sd_rad } => {
                let missed = Vector3::from_fn(|_, _| normal());
                let along = axis * axis.dot(&missed);
                let axis_sd_rad = turn_axis_sd_rad(angle_rad, angle_sd_rad, axis_sd_rad);
                let made =
                    axis * angle_rad + along * angle_sd_rad + (missed - along) * (axis_sd_rad * angle_rad);
                path.push((step.start_s, step.end_s, world_from_sensor, made));
                world_from_sensor *= UnitQuaternion::from_scaled_axis(made);
            }
        }
        end_s = step.end_s;
    }
    let attitude = |t: f64| {
        let last = path.iter().rev().find(|(start, ..)| t >= *start).or(path.first());
        last.map_or_else(UnitQuaternion::identity, |(start, end, from, turn)| {
            let x = ((t - start) / (end - start).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let share = x - (std::f64::consts::TAU * x).sin() / std::f64::consts::TAU;
            from * UnitQuaternion::from_scaled_axis(turn * share)
        })
    };
    let mut stimuli = Stimuli::default();
    for k in 0..=samples {
        let t = from_s + k as f64 * step_s;
        let (before, here, after) = (attitude(t - 0.5 * step_s), attitude(t), attitude(t + 0.5 * step_s));
        let rate = (before.inverse() * after).scaled_axis() / step_s;
        let sensor_from_world = here.inverse();
        let of_earth = sensor_from_world * setup.earth_rate_radps;
        stimuli.push(t, sensor_from_world * up, rate + of_earth);
    }
    let holds = steps.iter().filter(|step| matches!(step.action, TableAction::Hold(_)));
    let holds = holds.map(|step| (step.start_s, step.end_s));
    stimuli.disturb(holds, setup.between_holds_sd_mps2, rng);
    stimuli.record(imu, setup, rng)
}

/// The attitude on the first face, where the recording begins.
fn first_face(steps: &[TableStep]) -> UnitQuaternion<f64> {
    let first = steps.iter().find_map(|step| match step.action {
        TableAction::Hold(direction) => Some(direction),
        TableAction::Turn { .. } => None,
    });
    let turn =
        first.map_or_else(Vector3::zeros, |direction| turn_over(&UnitQuaternion::identity(), &direction));
    UnitQuaternion::from_scaled_axis(turn)
}

/// The rotation vector, in the sensor's frame, that brings a direction of the sensor up.
fn turn_over(world_from_sensor: &UnitQuaternion<f64>, direction: &Vector3<f64>) -> Vector3<f64> {
    let up_now = world_from_sensor.inverse() * Vector3::z();
    // a turn by R of the sensor's frame turns the up direction by R⁻¹
    let (sine, cosine) = (direction.cross(&up_now), direction.dot(&up_now));
    match Unit::try_new(sine, 1e-12) {
        // from sine and cosine, as rounding may take the cosine of opposite faces beyond -1
        Some(axis) => axis.into_inner() * sine.norm().atan2(cosine),
        None if cosine > 0.0 => Vector3::zeros(),
        None => {
            let across = direction.cross(&if direction.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() });
            Unit::new_normalize(across).into_inner() * std::f64::consts::PI
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorKind;
    use crate::simulate::{Purpose, stream};

    /// The turn is exact but for a rounding error and the error of a turn of known angle.
    #[test]
    fn opposite_faces_are_turned_over_to() {
        let face = Vector3::new(0.0, 0.6, 0.8);
        for k in 0..1000 {
            let tilt = Vector3::new(1.0, 0.3, -0.2) * (f64::from(k) * 1e-9);
            let attitude = UnitQuaternion::from_scaled_axis(turn_over(&UnitQuaternion::identity(), &-face))
                * UnitQuaternion::from_scaled_axis(tilt);
            let over = turn_over(&attitude, &face);
            let up = (attitude * UnitQuaternion::from_scaled_axis(over)).inverse() * Vector3::z();
            assert!((up - face).amax() < 1e-11, "{k}: {over} {up}");
        }
    }

    #[test]
    fn faces_point_up_and_turns_add_up_to_their_angle() {
        let axes = [Vector3::x(), -Vector3::x(), Vector3::new(0.6, 0.0, 0.8), -Vector3::z()];
        let mut steps: Vec<TableStep> = (0..4)
            .map(|k| {
                let start_s = 6.0 * f64::from(k);
                TableStep { start_s, end_s: start_s + 4.0, action: TableAction::Hold(axes[k as usize]) }
            })
            .collect();
        let action =
            TableAction::Turn { axis: -Vector3::z(), angle_rad: 7.0, angle_sd_rad: 0.0, axis_sd_rad: None };
        steps.push(TableStep { start_s: 23.0, end_s: 27.0, action });
        let setup =
            ImuSimulation { accelerometer_noise: 0.0, gyroscope_noise: 0.0, ..ImuSimulation::default() };
        let imu = ImuParameters::identity();
        let recording = simulate_table(&imu, &steps, &setup, &mut stream(1, Purpose::Sensor, 0));
        let accelerometer = recording[SensorKind::Accelerometer].clone().expect("there");
        let gyroscope = recording[SensorKind::Gyroscope].clone().expect("there");
        for step in &steps[..4] {
            let TableAction::Hold(direction) = step.action else { continue };
            for (t, force) in accelerometer.times_s.iter().zip(&accelerometer.readings) {
                if (step.start_s..=step.end_s).contains(t) {
                    assert!((force - direction * setup.gravity_mps2).amax() < 1e-9, "{t}: {force}");
                }
            }
        }
        let sum: Vector3<f64> = gyroscope
            .times_s
            .iter()
            .zip(&gyroscope.readings)
            .filter(|(t, _)| **t > 22.5)
            .map(|(_, rate)| rate / setup.rate_hz)
            .sum();
        assert!((sum + Vector3::z() * 7.0).amax() < 1e-9, "{sum}");
    }
}

//! What the sensor on a machine reads.

use crate::estimate::{MachineParameters, MachineSetup, TiltedGravity, predicted};
use crate::log::{JointLog, PoseLog, ReferenceLog};
use crate::reference::Motion;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuRecording, ReadingUnit, Recording, SensorKind};
use calibrant_core::simulate::Rng;
use nalgebra::{UnitQuaternion, Vector3};
use rand_distr::{Distribution, StandardNormal};

/// When the sensors are sampled, on the clock of the IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorSampling {
    /// First sample, s.
    pub start_s: f64,
    /// Number of samples.
    pub samples: usize,
    /// Sample rate, Hz.
    pub rate_hz: f64,
}

/// A sensor's unit and its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorErrors {
    /// The sensor.
    pub sensor: SensorKind,
    /// Unit of its readings.
    pub unit: ReadingUnit,
    /// Standard deviation of one sample at rest, per axis, in that unit.
    pub noise: Vector3<f64>,
    /// Noise that vibration adds in the mean over the recording, in parts of `noise`. It follows the rate and the specific force of the motion.
    pub vibration: f64,
}

/// The recording of these sensors in this motion. A sample at `t` shows the motion at `t + ε (t − middle) + δ`, with a delay `δ` for each sensor.
///
/// # Errors
/// As [`Recording::new`]: the sample rate is above 0.
pub fn record_sensors(
    motion: &Motion,
    truth: &MachineParameters,
    setup: &MachineSetup,
    sampling: &SensorSampling,
    sensors: &[SensorErrors],
    rng: &mut Rng,
) -> Result<ImuRecording> {
    let times_s: Vec<f64> =
        (0..sampling.samples).map(|k| sampling.start_s + k as f64 / sampling.rate_hz).collect();
    let middle_s = 0.5 * (times_s.first().unwrap_or(&0.0) + times_s.last().unwrap_or(&0.0));
    let gravity = TiltedGravity::new(&setup.up).vector(truth);
    let carrier = motion.carrier(gravity, truth.mount, &truth.corrections);
    let mut joints = Default::default();
    let mut recording = ImuRecording { sensors: [None, None].into(), temperature_c: None };
    for of in sensors {
        let stimuli: Vec<[Vector3<f64>; 2]> = times_s
            .iter()
            .map(|&time_s| {
                let weights = motion.knots().weights(truth.motion_time(of.sensor, time_s, middle_s));
                let felt = motion.sensor(&weights, &carrier, &mut joints);
                [felt.specific_force, felt.rate]
            })
            .collect();
        let activity = activity(&stimuli, gravity.norm());
        let readings = stimuli.iter().zip(&activity).map(|([force, rate], activity)| {
            let clean = predicted(of.sensor, force, rate, truth);
            let grown = (1.0 + of.vibration * of.vibration * activity).sqrt();
            clean + Vector3::from_fn(|axis, _| normal(rng) * grown * of.noise[axis])
        });
        let readings = readings.collect();
        recording[of.sensor] = Some(Recording::new(times_s.clone(), readings, 3, of.unit)?);
    }
    Ok(recording)
}

fn normal(rng: &mut Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// How lively the motion is: the squares of the rate and of the force beside gravity, each in parts of its mean. The mean is 1, or 0 where nothing moves.
fn activity(stimuli: &[[Vector3<f64>; 2]], gravity: f64) -> Vec<f64> {
    let of_force = |[force, _]: &[Vector3<f64>; 2]| (force.norm() - gravity).powi(2);
    let of_rate = |[_, rate]: &[Vector3<f64>; 2]| rate.norm_squared();
    let mean = |of: &dyn Fn(&[Vector3<f64>; 2]) -> f64| {
        stimuli.iter().map(of).sum::<f64>() / stimuli.len().max(1) as f64
    };
    let means = [mean(&of_force), mean(&of_rate)];
    let moving = means.iter().filter(|mean| **mean > f64::EPSILON).count().max(1) as f64;
    let part = |square: f64, mean: f64| if mean > f64::EPSILON { square / mean / moving } else { 0.0 };
    stimuli.iter().map(|at| part(of_force(at), means[0]) + part(of_rate(at), means[1])).collect()
}

/// Rate and errors of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogErrors {
    /// Sample rate, Hz. It is rounded so that the steps fit into the motion.
    pub rate_hz: f64,
    /// Standard deviation of one sample: of each joint, rad or m, or of three axes of position, m, and three of orientation, rad.
    pub noise: Vec<f64>,
    /// Step of the encoders, rad or m; 0 for none.
    pub resolution: f64,
}

/// The log of a whole motion.
#[must_use]
pub fn record_log(motion: &Motion, errors: &LogErrors, rng: &mut Rng) -> ReferenceLog {
    let (knots, LogErrors { rate_hz, noise, resolution }) = (motion.knots(), errors);
    let duration_s = knots.end_s() - knots.start_s;
    let steps = (duration_s * rate_hz).round().max(1.0);
    let times_s: Vec<f64> =
        (0..=steps as usize).map(|k| knots.start_s + duration_s * (k as f64 / steps)).collect();
    let mut normal = |k: usize| -> f64 {
        let z: f64 = StandardNormal.sample(rng);
        z * noise[k]
    };
    match motion {
        Motion::Joints(joints) => {
            let n = joints.positions.dimension;
            let names = joints.chain.joints.iter().map(|joint| joint.name.clone()).collect();
            let mut positions = Vec::with_capacity(n * times_s.len());
            for time_s in &times_s {
                let read = |(j, position): (usize, f64)| {
                    let position = position + normal(j);
                    let step = *resolution;
                    // a zero without a sign
                    if step > 0.0 { (position / step).round() * step + 0.0 } else { position }
                };
                positions.extend(joints.positions.at(*time_s, 0).into_iter().enumerate().map(read));
            }
            ReferenceLog::Joints(JointLog { names, times_s, positions, velocities: None })
        }
        Motion::Poses(poses) => {
            let mut log = PoseLog {
                positions_m: Vec::with_capacity(times_s.len()),
                world_from_body: Vec::with_capacity(times_s.len()),
                times_s: Vec::new(),
            };
            for time_s in &times_s {
                let position = Vector3::from_vec(poses.position.at(*time_s, 0));
                let orientation = poses.orientation.at(*time_s).world_from_body;
                log.positions_m.push(Some(position + Vector3::from_fn(|k, _| normal(k))));
                let turn = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|k, _| normal(3 + k)));
                log.world_from_body.push(Some(orientation * turn));
            }
            ReferenceLog::Poses(PoseLog { times_s, ..log })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MotionToDraw, draw_body_motion, draw_joint_motion};
    use super::*;
    use crate::chain::chains_for_tests::{Numbers, mixed_chain};
    use crate::chain::{Joint, JointKind, JointLimits, KinematicChain};
    use crate::estimate::MountingPrior;
    use crate::reference::JointMotion;
    use crate::spline::{Degree, UniformKnots, VectorSpline};
    use calibrant_core::sensor::ImuParameters;
    use calibrant_core::simulate::{Purpose, stream};
    use nalgebra::{Isometry3, Unit};

    const GRAVITY: f64 = 9.8;

    fn joint(kind: JointKind, axis: Unit<Vector3<f64>>) -> Joint {
        let limits = JointLimits::default();
        Joint { name: "joint".into(), kind, axis, origin: Isometry3::identity(), limits }
    }

    /// Joints whose positions are these functions of time.
    fn moved(joints: Vec<Joint>, at: &dyn Fn(f64) -> Vec<f64>) -> Motion {
        let knots = UniformKnots::covering(0.0, 10.0, 0.1, Degree::Cubic);
        let chain = KinematicChain {
            base: "base".into(),
            tip: "tip".into(),
            joints,
            tip_transform: Isometry3::identity(),
        };
        let controls = (0..knots.controls()).flat_map(|i| at(knots.centre_s(i))).collect();
        let positions = VectorSpline { knots, dimension: chain.joints.len(), controls };
        Motion::Joints(JointMotion { chain, positions })
    }

    fn setup() -> MachineSetup {
        MachineSetup { gravity_mps2: GRAVITY, mounting: MountingPrior::Exact, ..MachineSetup::default() }
    }

    fn of(sensor: SensorKind, noise: f64, vibration: f64) -> SensorErrors {
        SensorErrors { sensor, unit: sensor.stimulus_unit(), noise: Vector3::repeat(noise), vibration }
    }

    fn record(motion: &Motion, truth: &MachineParameters, sensors: &[SensorErrors]) -> ImuRecording {
        let sampling = SensorSampling { start_s: 1.0, samples: 4000, rate_hz: 500.0 };
        record_sensors(motion, truth, &setup(), &sampling, sensors, &mut stream(1, Purpose::Sensor, 0))
            .expect("a rate")
    }

    fn gantry() -> Vec<Joint> {
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        axes.map(|axis| joint(JointKind::Prismatic, axis)).to_vec()
    }

    /// A parabola `½ a t²` is a spline whose control points lie on a parabola.
    #[test]
    fn a_gantry_reads_its_acceleration_and_gravity() {
        let acceleration = Vector3::new(0.5, -0.3, 0.2);
        let motion = moved(gantry(), &|t| acceleration.iter().map(|a| 0.5 * a * t * t).collect());
        let mut imu = ImuParameters::identity();
        imu[SensorKind::Accelerometer].bias = Vector3::new(0.1, 0.2, 0.3);
        imu[SensorKind::Accelerometer].matrix[(0, 2)] = 0.01;
        let truth = MachineParameters::nominal(&setup(), imu, 3);
        let force = acceleration + Vector3::z() * GRAVITY;
        let expected = force + Vector3::new(0.1 + 0.01 * force.z, 0.2, 0.3);
        let recording = record(&motion, &truth, &[of(SensorKind::Accelerometer, 0.0, 0.0)]);
        assert!(recording[SensorKind::Gyroscope].is_none());
        for reading in recording[SensorKind::Accelerometer].clone().expect("there").readings() {
            assert!((reading - expected).norm() < 1e-9, "{reading}");
        }
    }

    /// At `ω t`, a sensor at `r` feels `r ω²` towards the axis. One that is mounted askew feels it along other axes.
    #[test]
    fn a_rate_table_reads_its_rate_and_the_centripetal_force() {
        let (rate, radius) = (3.0, 0.12);
        let motion = moved(vec![joint(JointKind::Continuous, Vector3::z_axis())], &|t| vec![rate * t]);
        let mut truth = MachineParameters::nominal(&setup(), ImuParameters::identity(), 1);
        truth.mount.lever_m = Vector3::new(0.0, radius, 0.05);
        // x of the sensor is up: -z, y, x of the plate are its axes
        truth.mount.tip_from_sensor =
            nalgebra::UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -std::f64::consts::FRAC_PI_2);
        truth.imu[SensorKind::Gyroscope].bias = Vector3::new(0.01, 0.0, -0.02);
        truth.imu.g_sensitivity[(2, 0)] = 1e-3;
        let kinds = SensorKind::ALL.map(|sensor| of(sensor, 0.0, 0.0));
        let recording = record(&motion, &truth, &kinds);
        let force = Vector3::new(GRAVITY, -radius * rate * rate, 0.0);
        for reading in recording[SensorKind::Accelerometer].clone().expect("there").readings() {
            assert!((reading - force).norm() < 1e-9, "{reading}");
        }
        for reading in recording[SensorKind::Gyroscope].clone().expect("there").readings() {
            let expected = Vector3::new(rate + 0.01, 0.0, -0.02 + 1e-3 * GRAVITY);
            assert!((reading - expected).norm() < 1e-9, "{reading}");
        }
    }

    /// The acceleration `a t` of a joint shows the time of a sample.
    #[test]
    fn a_sample_shows_the_motion_at_its_own_time() {
        let motion = moved(gantry(), &|t| vec![t * t * t / 6.0 - 0.01 * t / 6.0, 0.0, 0.0]);
        let mut truth = MachineParameters::nominal(&setup(), ImuParameters::identity(), 3);
        truth.delays_s = [0.25, 0.0].into();
        truth.clock_rate = 0.01;
        let recording = record(&motion, &truth, &[of(SensorKind::Accelerometer, 0.0, 0.0)]);
        let recording = recording[SensorKind::Accelerometer].clone().expect("there");
        let last = recording.len() - 1;
        let middle = 0.5 * (recording.times_s()[0] + recording.times_s()[last]);
        for k in [0, 100, last] {
            let t = recording.times_s()[k];
            let expected = t + 0.25 + 0.01 * (t - middle);
            assert!((recording.readings()[k].x - expected).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn noise_is_as_stated_and_grows_where_it_moves() {
        // at rest until 5 s
        let motion = moved(gantry(), &|t| vec![if t < 5.0 { 0.0 } else { (3.0 * t).sin() }, 0.0, 0.0]);
        let truth = MachineParameters::nominal(&setup(), ImuParameters::identity(), 3);
        let clean = record(&motion, &truth, &[of(SensorKind::Accelerometer, 0.0, 0.0)]);
        let noisy = record(&motion, &truth, &[of(SensorKind::Accelerometer, 0.01, 2.0)]);
        let [clean, noisy] = [clean, noisy].map(|recording| {
            recording[SensorKind::Accelerometer].clone().expect("there").readings().to_vec()
        });
        let errors: Vec<Vector3<f64>> = noisy.iter().zip(&clean).map(|(a, b)| a - b).collect();
        let sd = |errors: &[Vector3<f64>]| {
            (errors.iter().map(Vector3::norm_squared).sum::<f64>() / (3 * errors.len()) as f64).sqrt()
        };
        let [rest, all] = [sd(&errors[..1500]), sd(&errors)];
        assert!((rest / 0.01 - 1.0).abs() < 0.05, "{rest}");
        assert!((all / 0.01 - 5.0_f64.sqrt()).abs() < 0.1, "{all}");
    }

    const WANTED: MotionToDraw =
        MotionToDraw { duration_s: 20.0, rest_s: 1.0, acceleration: 5.0, knot_step_s: None };

    #[test]
    fn joints_are_logged_with_noise_and_in_steps() {
        let chain = mixed_chain(3, &mut Numbers(2));
        let mut rng = stream(1, Purpose::Motion, 0);
        let motion = draw_joint_motion(&chain, &WANTED, &mut rng);
        let Motion::Joints(truth) = &motion else { panic!("of joints") };
        let errors = |noise: f64, resolution| LogErrors { rate_hz: 250.0, noise: vec![noise; 3], resolution };
        for (errors, sd) in [(errors(1e-3, 0.0), 1e-3), (errors(0.0, 1e-3), 1e-3 / 12.0_f64.sqrt())] {
            let ReferenceLog::Joints(log) = record_log(&motion, &errors, &mut rng) else { panic!("joints") };
            assert_eq!(log.times_s.len(), 5001);
            let moving = 400..4600;
            let mut squares = 0.0;
            for k in moving.clone() {
                let positions = truth.positions.at(log.times_s[k], 0);
                for (read, position) in log.row(k).iter().zip(positions) {
                    squares += (read - position).powi(2);
                    let steps = read / 1e-3;
                    assert!(errors.resolution == 0.0 || (steps - steps.round()).abs() < 1e-6);
                }
            }
            let found = (squares / (3 * moving.len()) as f64).sqrt();
            assert!((found / sd - 1.0).abs() < 0.1, "{found} {sd}");
        }
    }

    #[test]
    fn a_body_is_turned_to_all_sides_and_its_poses_scatter() {
        let mut rng = stream(4, Purpose::Motion, 0);
        let motion = draw_body_motion(&MotionToDraw { duration_s: 60.0, ..WANTED }, &mut rng);
        let errors =
            LogErrors { rate_hz: 100.0, noise: vec![1e-3, 1e-3, 1e-3, 5e-3, 5e-3, 5e-3], resolution: 0.0 };
        let ReferenceLog::Poses(log) = record_log(&motion, &errors, &mut rng) else { panic!("poses") };
        let (mut squares, mut up) = ([0.0; 2], [[false; 2]; 3]);
        let postures = motion.postures(&log.times_s, &crate::chain::ChainCorrections::none(0));
        for (k, posture) in postures.iter().enumerate() {
            let tip = posture.tip();
            let position = log.positions_m[k].expect("seen");
            let orientation = log.world_from_body[k].expect("seen");
            squares[0] += (position - tip.translation.vector).norm_squared();
            squares[1] += orientation.angle_to(&tip.rotation).powi(2);
            assert!((tip.translation.vector - Vector3::z() * 1.2).amax() < 0.55);
            let vertical = tip.rotation.inverse() * Vector3::z();
            for axis in 0..3 {
                up[axis][0] |= vertical[axis] > 0.7;
                up[axis][1] |= vertical[axis] < -0.7;
            }
        }
        assert_eq!(up, [[true; 2]; 3], "each axis points up and down");
        for (squares, sd) in squares.iter().zip([1e-3, 5e-3]) {
            let found = (squares / (3 * postures.len()) as f64).sqrt();
            assert!((found / sd - 1.0).abs() < 0.05, "{found} {sd}");
        }
    }
}

//! The physical ranges of the numbers of an experiment file.

use super::number::{Bounds, Range};
use calibrant_core::sensor::WORKING_C;

macro_rules! ranges {
    ($($(#[$doc:meta])* pub struct $name:ident: $bounds:expr;)*) => {
        $($(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name;

        impl Range for $name {
            const BOUNDS: Bounds = $bounds;
        })*
    };
}

/// Least magnitude of gravity, m/s².
pub(super) const LEAST_GRAVITY: f64 = 0.1;
/// Largest magnitude of gravity, m/s².
pub(super) const LARGEST_GRAVITY: f64 = 100.0;

ranges! {
    /// Noise of a sample of an accelerometer.
    pub struct NoiseMps2: Bounds::from(1e-7, 1e6, "m/s²");
    /// Noise of a sample of a gyroscope.
    pub struct NoiseRadps: Bounds::from(1e-9, 1e3, "rad/s");
    /// Noise of a sample in counts.
    pub struct NoiseCounts: Bounds::from(1e-9, 1e9, "counts");
    /// Datasheet spread of a bias.
    pub struct BiasSpread: Bounds::from(0.0, 1e6, "m/s²");
    /// Datasheet spread of scale factors or cross-axis sensitivities, relative.
    pub struct RelativeSpread: Bounds::from(0.0, 10.0, "");
    /// Nominal gain of an accelerometer.
    pub struct AccelerometerGain: Bounds::above(0.0, 1e12, "counts/(m/s²)");
    /// Nominal gain of a gyroscope.
    pub struct GyroscopeGain: Bounds::above(0.0, 1e12, "counts/(rad/s)");
    /// Noise density of an accelerometer.
    pub struct NoiseUg: Bounds::from(1e-2, 1e9, "µg/√Hz");
    /// Noise density of a gyroscope.
    pub struct NoiseMdps: Bounds::from(1e-4, 1e7, "mdps/√Hz");
    /// Bandwidth of the noise.
    pub struct NoiseBandwidth: Bounds::from(1e-3, 1e6, "Hz");
    /// Sensitivity of an accelerometer.
    pub struct SensitivityPerG: Bounds::above(0.0, 1e12, "LSB/g");
    /// Sensitivity of a gyroscope.
    pub struct SensitivityPerDps: Bounds::above(0.0, 1e12, "LSB/(deg/s)");
    /// Nominal offset.
    pub struct Offset: Bounds::from(-1e12, 1e12, "counts");
    /// A limit of an acceleration.
    pub struct Acceleration: Bounds::above(0.0, 1e9, "m/s²");
    /// A prescribed acceleration, of either sign or zero.
    pub struct SignedAcceleration: Bounds::from(-1e9, 1e9, "m/s²");
    /// A limit of a jerk.
    pub struct Jerk: Bounds::above(0.0, 1e9, "m/s³");
    /// A limit of a velocity.
    pub struct Velocity: Bounds::above(0.0, 1e9, "m/s");
    /// A limit of a displacement.
    pub struct Displacement: Bounds::above(0.0, 1e9, "m");
    /// Constant part of the process noise.
    pub struct JerkNoise: Bounds::from(0.0, 1e9, "m/s³");
    /// Process noise relative to the jerk.
    pub struct JerkRatio: Bounds::from(0.0, 1e3, "");
    /// Magnitude of gravity.
    pub struct GravityMps2: Bounds::from(LEAST_GRAVITY, LARGEST_GRAVITY, "m/s²");
    /// A component of gravity.
    pub struct GravityComponent: Bounds::from(-LARGEST_GRAVITY, LARGEST_GRAVITY, "m/s²");
    /// Standard uncertainty of gravity.
    pub struct GravitySd: Bounds::from(0.0, 1.0, "m/s²");
    /// Lag of a thermometer.
    pub struct Lag: Bounds::from(-600.0, 600.0, "s");
    /// Standard deviation of a lag.
    pub struct LagSd: Bounds::from(0.0, 600.0, "s");
    /// A geographic latitude.
    pub struct Latitude: Bounds::from(-90.0, 90.0, "degrees");
    /// A height above the sea.
    pub struct Height: Bounds::from(-12_000.0, 100_000.0, "m");
    /// A component of a direction.
    pub struct DirectionComponent: Bounds::from(-1e3, 1e3, "");
    /// The tilt of faces or of an arm. What is tilted further is not level.
    pub struct SmallTilt: Bounds::from(0.0, 10.0, "degrees");
    /// The tilt of a machine's base.
    pub struct BaseTilt: Bounds::from(0.0, 45.0, "degrees");
    /// The angle around an allowed direction.
    pub struct Cone: Bounds::from(0.0, 90.0, "degrees");
    /// A time.
    pub struct Time: Bounds::from(-1e12, 1e12, "s");
    /// A duration.
    pub struct Duration: Bounds::above(0.0, 1e6, "s");
    /// A sample rate.
    pub struct Rate: Bounds::above(0.0, 1e6, "Hz");
    /// The sample rate of a file.
    pub struct FileRate: Bounds::from(1e-6, 1e9, "Hz");
    /// Standard deviation of the rate of a clock.
    pub struct RateSd: Bounds::from(0.0, 1e5, "ppm");
    /// Standard deviation of the drift of a bias, or of the scatter between holds.
    pub struct HoldSd: Bounds::from(0.0, 100.0, "m/s²");
    /// The angle of a turn.
    pub struct TurnAngle: Bounds::from(-1e6, 1e6, "degrees");
    /// Standard uncertainty of it. It is above 0: no turn is exact, and nothing in the recording shows its error.
    pub struct TurnSd: Bounds::above(0.0, 360.0, "degrees");
    /// A value of any quantity.
    pub struct Value: Bounds::from(-1e12, 1e12, "");
    /// Standard deviation of a prior. A smaller one leaves the other data no digits.
    pub struct PriorSd: Bounds::from(1e-12, 1e12, "");
    /// A limit of a standard deviation.
    pub struct SdLimit: Bounds::above(0.0, 1e12, "");
    /// A weight of criterion c.
    pub struct Weight: Bounds::from(0.0, 1e30, "");
    /// A temperature.
    pub struct Celsius: Bounds::from(*WORKING_C.start(), *WORKING_C.end(), "°C");
    /// The time of a campaign.
    pub struct Minutes: Bounds::above(0.0, 1e5, "min");
    /// The wait before the first hold of a soak.
    pub struct Wait: Bounds::from(0.0, 1e4, "min");
    /// The rate of a chamber.
    pub struct Ramp: Bounds::above(0.0, 1e3, "K/min");
    /// The time constant between a chamber and a sense element.
    pub struct TimeConstant: Bounds::above(0.0, 1e3, "min");
    /// The distance of soaks.
    pub struct Spacing: Bounds::from(0.5, 200.0, "K");
    /// Standard deviation of a quantity from one block of holds.
    pub struct BlockSd: Bounds::above(0.0, 100.0, "");
    /// The share of a lag's error that differs from soak to soak.
    pub struct LagScatter: Bounds::from(0.0, 10.0, "");
    /// A component of a lever arm. A longer one is hardly in m.
    pub struct Lever: Bounds::from(-20.0, 20.0, "m");
    /// Standard deviation of a lever arm.
    pub struct LeverSd: Bounds::from(0.0, 10.0, "m");
    /// A component of a rotation vector or of a quaternion.
    pub struct RotationComponent: Bounds::from(-360.0, 360.0, "degrees");
    /// A component of a quaternion.
    pub struct QuaternionComponent: Bounds::from(-1.0, 1.0, "");
    /// Standard deviation of the mounting. One that is known less well is unknown.
    pub struct MountingSd: Bounds::from(0.0, 20.0, "degrees");
    /// A delay.
    pub struct Delay: Bounds::from(-1e6, 1e6, "s");
    /// Standard deviation of a delay.
    pub struct DelaySd: Bounds::from(0.0, 10.0, "s");
    /// Standard deviation of a joint's translation. More is no geometry that is known.
    pub struct JointTranslationSd: Bounds::from(0.0, 0.1, "m");
    /// Standard deviation of a joint's rotation.
    pub struct JointRotationSd: Bounds::from(0.0, 0.1, "rad (0.1 rad is 5.7°)");
    /// Standard deviation of a joint's zero offset.
    pub struct JointZeroSd: Bounds::from(0.0, 0.1, "rad or m (0.1 rad is 5.7°)");
    /// Noise of one sample of a log.
    pub struct SampleOfLog: Bounds::above(0.0, 1.0, "rad or m");
    /// The distance of knots.
    pub struct KnotStep: Bounds::from(1e-4, 100.0, "s");
    /// Duration of a simulated motion of a machine. In a shorter time it hardly comes home.
    pub struct MachineDuration: Bounds::from(10.0, 1e5, "s");
    /// Acceleration of a joint.
    pub struct JointAcceleration: Bounds::above(0.0, 1e3, "rad/s² or m/s²");
    /// Position of a joint.
    pub struct JointPosition: Bounds::from(-1e3, 1e3, "rad or m");
    /// Speed of a joint.
    pub struct JointSpeed: Bounds::above(0.0, 1e3, "rad/s or m/s");
    /// Jerk of a joint.
    pub struct JointJerk: Bounds::above(0.0, 1e6, "rad/s³ or m/s³");
    /// Speed of a tip.
    pub struct TipSpeed: Bounds::above(0.0, 100.0, "m/s");
    /// A coordinate near a machine. A larger one is hardly in m.
    pub struct Coordinate: Bounds::from(-100.0, 100.0, "m");
    /// Half of an edge of a box.
    pub struct BoxHalf: Bounds::above(0.0, 100.0, "m");
    /// Radius of a body.
    pub struct BodyRadius: Bounds::above(0.0, 5.0, "m");
    /// A distance that is kept. The design looks no farther than 0.3 m.
    pub struct Clearance: Bounds::from(0.0, 0.2, "m");
    /// Noise in motion over noise at rest.
    pub struct MovingNoise: Bounds::from(1.0, 1e3, "");
    /// Duration of a trajectory of a machine.
    pub struct TrajectoryDuration: Bounds::from(1.0, 3600.0, "s");
    /// Distance of its knots. Shorter ones are smoothed by the controllers of arms.
    pub struct TrajectoryKnot: Bounds::from(0.01, 10.0, "s");
    /// Range of a gyroscope.
    pub struct RangeRadps: Bounds::above(0.0, 1e4, "rad/s");
    /// Range of a gyroscope in degrees.
    pub struct RangeDegps: Bounds::above(0.0, 1e6, "deg/s");
    /// Step of an encoder.
    pub struct Resolution: Bounds::from(0.0, 0.1, "rad or m");
    /// Noise by vibration over the noise at rest.
    pub struct Vibration: Bounds::from(0.0, 1e3, "");
}

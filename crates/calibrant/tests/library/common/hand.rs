//! Simulated recordings of an IMU that is turned by hand: knocks where it is set down, a filter before the
//! samples, a gyroscope that is late, holds that turn slowly, times of a host.

use calibrant::sensor::{ImuParameters, ImuRecording, ReadingUnit, Recording, SensorKind};
use calibrant::simulate::Rng;
use nalgebra::{UnitQuaternion, Vector3};
use rand::RngExt;

use super::normal;

/// Steps of the simulation for each sample.
const FINE: usize = 16;
/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;

/// A recording by hand.
#[derive(Debug, Clone)]
pub(crate) struct ByHand {
    pub(crate) poses: usize,
    pub(crate) rate_hz: f64,
    pub(crate) accelerometer_noise: f64,
    pub(crate) gyroscope_noise: f64,
    /// Does each turn end with a knock in both sensors: half-sines of 5 to 30 ms, 5 to 20 rad/s and 20 to
    /// 100 m/s²?
    pub(crate) knocks: bool,
    /// Are both sensors filtered at half the sample rate?
    pub(crate) filtered: bool,
    /// How much later the gyroscope's times are, s.
    pub(crate) gyroscope_late_s: f64,
    /// Largest rate in a hold, rad/s. The rate rises and falls once.
    pub(crate) turn_in_hold_radps: f64,
    /// The step of the host's clock, s, with which the samples are logged.
    pub(crate) host_tick_s: Option<f64>,
}

impl Default for ByHand {
    fn default() -> Self {
        Self {
            poses: 24,
            rate_hz: 100.0,
            accelerometer_noise: 0.01,
            gyroscope_noise: 2e-3,
            knocks: false,
            filtered: false,
            gyroscope_late_s: 0.0,
            turn_in_hold_radps: 0.0,
            host_tick_s: None,
        }
    }
}

/// A half-sine.
#[derive(Clone, Copy)]
struct Pulse {
    start_s: f64,
    length_s: f64,
    height: Vector3<f64>,
}

impl Pulse {
    fn at(&self, t: f64) -> Vector3<f64> {
        let part = (t - self.start_s) / self.length_s;
        if (0.0..1.0).contains(&part) {
            self.height * (std::f64::consts::PI * part).sin()
        } else {
            Vector3::zeros()
        }
    }
}

impl ByHand {
    /// The recording of an IMU.
    pub(crate) fn record(&self, imu: &ImuParameters, rng: &mut Rng) -> ImuRecording {
        let fine_s = 1.0 / (self.rate_hz * FINE as f64);
        let direction = |rng: &mut Rng| Vector3::from_fn(|_, _| normal(rng)).normalize();
        let (mut rates, mut hand) = (Vec::new(), Vec::new());
        for pose in 0..self.poses {
            let hold = (rng.random_range(2.0..3.5) / fine_s) as usize;
            let slow = direction(rng) * self.turn_in_hold_radps * rng.random::<f64>();
            for k in 0..hold {
                let bell = 0.5 - 0.5 * (std::f64::consts::TAU * k as f64 / hold as f64).cos();
                rates.push(slow * bell);
                hand.push(Vector3::zeros());
            }
            if pose + 1 == self.poses {
                break;
            }
            let turn_s = rng.random_range(1.2..2.5);
            let turn = (turn_s / fine_s) as usize;
            let axis = direction(rng);
            let wobble = axis.cross(&direction(rng)) * 0.4;
            let angle = rng.random_range(1.0..3.0);
            let push = [direction(rng) * 1.0, direction(rng) * 1.0];
            // a knock is over when the hold begins
            let length_s = rng.random_range(0.005..0.03);
            let start_s = turn_s - rng.random_range(length_s..0.2);
            let [gyroscope, accelerometer] = [(5.0, 20.0), (20.0, 100.0)].map(|(least, most)| Pulse {
                start_s,
                length_s,
                height: direction(rng) * rng.random_range(least..most),
            });
            for k in 0..turn {
                let (t, x) = (k as f64 * fine_s, std::f64::consts::TAU * k as f64 / turn as f64);
                let bell = (1.0 - x.cos()).powi(2) * 2.0 / 3.0;
                let mut rate = (axis * bell + wobble * ((2.0 * x).sin() * bell)) * (angle / turn_s);
                let mut pushed = (push[0] * x.sin() + push[1] * (3.0 * x).sin()) * (0.5 * bell);
                if self.knocks {
                    rate += gyroscope.at(t);
                    pushed += accelerometer.at(t);
                }
                rates.push(rate);
                hand.push(pushed);
            }
        }
        self.sampled(imu, &rates, hand, rng)
    }

    fn sampled(
        &self,
        imu: &ImuParameters,
        rates: &[Vector3<f64>],
        mut forces: Vec<Vector3<f64>>,
        rng: &mut Rng,
    ) -> ImuRecording {
        let fine_s = 1.0 / (self.rate_hz * FINE as f64);
        let mut attitude =
            UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| rng.random_range(-3.0..3.0)));
        let up = Vector3::new(0.0, 0.0, GRAVITY);
        for k in 0..rates.len() {
            forces[k] += attitude.inverse() * up;
            let next = rates[(k + 1).min(rates.len() - 1)];
            attitude *= UnitQuaternion::from_scaled_axis(0.5 * (rates[k] + next) * fine_s);
        }
        let filtered = |stimuli: &[Vector3<f64>]| match self.filtered {
            true => low_pass(stimuli, 1.0 / (2.0 * FINE as f64)),
            false => stimuli.to_vec(),
        };
        let (rates, forces) = (filtered(rates), filtered(&forces));
        let noisy = |reading: Vector3<f64>, sd: f64, rng: &mut Rng| {
            reading + Vector3::from_fn(|_, _| sd * normal(rng))
        };
        let (mut accelerometer, mut gyroscope) = (Vec::new(), Vec::new());
        let mut times_s = Vec::new();
        let late = (self.gyroscope_late_s / fine_s).round() as usize;
        for k in (0..rates.len()).step_by(FINE) {
            times_s.push(k as f64 * fine_s);
            let force =
                noisy(imu[SensorKind::Accelerometer].reading(&forces[k]), self.accelerometer_noise, rng);
            accelerometer.push(force);
            let rate = rates[k.saturating_sub(late)];
            gyroscope.push(noisy(imu[SensorKind::Gyroscope].reading(&rate), self.gyroscope_noise, rng));
        }
        if let Some(tick_s) = self.host_tick_s {
            // the host takes a sample some time after it was made
            let mut last: f64 = 0.0;
            for t in &mut times_s {
                last = last.max(((*t + rng.random_range(0.0..tick_s)) / tick_s).floor() * tick_s);
                *t = last;
            }
        }
        let recording = |readings, unit| {
            Some(Recording::new(times_s.clone(), readings, 3, unit).expect("samples in order"))
        };
        ImuRecording {
            sensors: [
                recording(accelerometer, ReadingUnit::MetrePerSecondSquared),
                recording(gyroscope, ReadingUnit::RadianPerSecond),
            ]
            .into(),
            temperature_c: None,
        }
    }
}

/// A Butterworth filter of second order; `cutoff` over the rate of the values.
fn low_pass(values: &[Vector3<f64>], cutoff: f64) -> Vec<Vector3<f64>> {
    let w = (std::f64::consts::PI * cutoff).tan();
    let (root, scale) = (std::f64::consts::SQRT_2, 1.0 / (1.0 + std::f64::consts::SQRT_2 * w + w * w));
    let (b, a1, a2) = (w * w * scale, 2.0 * (w * w - 1.0) * scale, (1.0 - root * w + w * w) * scale);
    let first = values.first().copied().unwrap_or_default();
    let (mut x, mut y) = ([first; 2], [first; 2]);
    values
        .iter()
        .map(|value| {
            let next = (value + 2.0 * x[0] + x[1]) * b - y[0] * a1 - y[1] * a2;
            (x, y) = ([*value, x[0]], [next, y[0]]);
            next
        })
        .collect()
}

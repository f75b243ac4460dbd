//! A simulated board in a simulated hand, which takes the poses that the guide advises.

use crate::arrival::Arrival;
use calibrant_core::simulate::{Purpose, Rng, normal, stream};
use nalgebra::{Rotation3, Unit, Vector3};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The direction that the hand is to take next.
#[derive(Debug, Clone, Default)]
pub(crate) struct Advice(Arc<Mutex<Option<Vector3<f64>>>>);

impl Advice {
    pub(crate) fn give(&self, up: Option<Vector3<f64>>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = up;
    }

    fn take(&self) -> Option<Vector3<f64>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Samples in a second, and how long the hand holds and turns, s.
const RATE_HZ: f64 = 100.0;
const HOLD_S: f64 = 4.0;
const TURN_S: f64 = 1.5;
/// How much longer it waits for advice, s.
const PATIENCE_S: f64 = 8.0;
/// Samples that go together.
const TOGETHER: usize = 10;
const GRAVITY: f64 = 9.806_65;

/// The board: what it makes of force and rate.
struct Board {
    rng: Rng,
}

impl Board {
    fn row(&mut self, t_s: f64, force: &Vector3<f64>, rate: &Vector3<f64>) -> String {
        let a = Vector3::new(
            1.012 * force.x + 0.21,
            0.994 * force.y + 0.013 * force.x - 0.33,
            1.021 * force.z - 0.008 * force.x + 0.005 * force.y + 0.47,
        );
        let g = Vector3::new(
            0.991 * rate.x + 0.004 * rate.z + 0.031,
            1.006 * rate.y - 0.007 * rate.x - 0.018,
            1.013 * rate.z + 0.006 * rate.y + 0.009,
        );
        let a = a.map(|value| value + 0.02 * normal(&mut self.rng));
        let g = g.map(|value| value + 0.002 * normal(&mut self.rng));
        let celsius = 31.0 + 2.0 * (1.0 - (-t_s / 300.0).exp());
        format!("{t_s:.3},{:.5},{:.5},{:.5},{:.6},{:.6},{:.6},{celsius:.2}\n", a.x, a.y, a.z, g.x, g.y, g.z)
    }
}

/// Plays it, three times as fast as a person would.
pub(crate) fn start(to: SyncSender<Arrival>, advice: Advice, speed: f64) {
    thread::spawn(move || {
        let begin = Instant::now();
        let mut board = Board { rng: stream(1, Purpose::Recording, 1) };
        let mut up = Vector3::z();
        let mut text = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps,temp_c\n".to_owned();
        let (mut t_s, mut count) = (0.0, 0_usize);
        let mut send = |board: &mut Board, up: &Vector3<f64>, rate: &Vector3<f64>| -> bool {
            text.push_str(&board.row(t_s, &(up * GRAVITY), rate));
            t_s += 1.0 / RATE_HZ;
            count += 1;
            if count.is_multiple_of(TOGETHER) {
                let due = Duration::from_secs_f64(t_s / speed);
                thread::sleep(due.saturating_sub(begin.elapsed()));
                let bytes = std::mem::take(&mut text).into_bytes();
                return to.send(Arrival::Bytes { bytes, at_s: t_s }).is_ok();
            }
            true
        };
        loop {
            // what was advised on the way here is old
            advice.take();
            let mut next = None;
            for k in 0..((HOLD_S + PATIENCE_S) * RATE_HZ) as usize {
                if !send(&mut board, &up, &Vector3::zeros()) {
                    return;
                }
                next = next.or_else(|| advice.take());
                if next.is_some() && k >= (HOLD_S * RATE_HZ) as usize {
                    break;
                }
            }
            let next = next.unwrap_or(-up);
            let angle = up.angle(&next);
            let axis = Unit::try_new(up.cross(&next), 1e-6).unwrap_or_else(|| {
                Unit::new_normalize(if up.x.abs() < 0.9 {
                    up.cross(&Vector3::x())
                } else {
                    up.cross(&Vector3::y())
                })
            });
            let from = up;
            let steps = (TURN_S * RATE_HZ) as usize;
            for k in 0..steps {
                let s = (k as f64 + 0.5) / steps as f64;
                // a hand: rate and acceleration begin and end at nothing
                let share = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
                let slope = 30.0 * s.powi(2) * (1.0 - s).powi(2) / TURN_S;
                up = Rotation3::from_axis_angle(&axis, angle * share) * from;
                // up turns the other way than the board does
                if !send(&mut board, &up, &(-axis.into_inner() * angle * slope)) {
                    return;
                }
            }
            up = next.normalize();
        }
    });
}

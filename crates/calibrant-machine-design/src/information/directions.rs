//! The nuisances as directions of the recursion: what each of them changes.

use super::Sensing;
use crate::recursion::{Contraction, Sweep, V, carried};
use calibrant_machine::estimate::MachineQuantity;
use nalgebra::{Matrix3, Vector3};

/// What a nuisance changes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Direction {
    /// Shift of a frame along a vector in its axes.
    Shift(usize, V),
    /// Turn of a frame about a vector in its axes.
    Turn(usize, V),
    /// Specific force of the base.
    Base(V),
    /// Time of a sensor.
    Delay(usize),
    /// Time of both sensors, in proportion to that after the middle.
    Clock,
}

/// All nuisances.
#[derive(Debug, Clone)]
pub(crate) struct Directions {
    all: Vec<Direction>,
}

impl Directions {
    /// `tip` is the rotation of the tip behind the last joint: the sensor's shift is in its axes.
    pub(crate) fn new(sensing: &Sensing, tip: &Matrix3<f64>) -> Self {
        let n = sensing.links.len();
        let unit = |i: usize| V::of(&Vector3::ith(i, 1.0));
        let of_tip =
            |i: usize| sensing.links.fixed[n].c.transposed_times(&V::of(&tip.column(i).into_owned()));
        let of = |quantity: &MachineQuantity| {
            Some(match *quantity {
                MachineQuantity::Imu(_) => return None,
                MachineQuantity::Lever(axis) => Direction::Shift(n, of_tip(axis.index())),
                MachineQuantity::Mounting(axis) => Direction::Turn(n, unit(axis.index())),
                MachineQuantity::Tilt(k) => Direction::Base(-V::of(&sensing.by_gravity[k])),
                MachineQuantity::Gravity => Direction::Base(-V::of(&sensing.by_gravity[2])),
                MachineQuantity::Delay(sensor) => Direction::Delay(sensor as usize),
                MachineQuantity::ClockRate => Direction::Clock,
                MachineQuantity::Zero(j) => {
                    let joint = &sensing.links.joints[j];
                    if joint.turns { Direction::Turn(j, joint.u) } else { Direction::Shift(j, joint.u) }
                }
                MachineQuantity::Geometry(j, k) if k < 3 => Direction::Shift(j, unit(k)),
                MachineQuantity::Geometry(j, k) => Direction::Turn(j, unit(k - 3)),
            })
        };
        Self { all: sensing.layout.quantities.iter().filter_map(of).collect() }
    }

    /// Number of nuisances.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// The derivatives of specific force and rate by all of them, in the sensor's axes. The motion has its third derivatives.
    pub(crate) fn columns(&self, sweep: &Sweep, after_middle_s: f64, mut write: impl FnMut(usize, [V; 2])) {
        let sensor = sweep.sensor();
        let w = &sensor.moving.w;
        let change = [sensor.third[0] - w.cross(&sensor.moving.a), sensor.moving.wd];
        for (place, direction) in self.all.iter().enumerate() {
            let column = match *direction {
                Direction::Shift(k, axis) => {
                    let frame = &sweep.frames[k];
                    [carried(&frame.turn.times(&axis), &frame.moving)[1], V::ZERO]
                }
                Direction::Turn(k, axis) => {
                    let frame = &sweep.frames[k];
                    let z = frame.turn.times(&axis);
                    let [zd, zdd] = carried(&z, &frame.moving);
                    let [force, _, _, rate, _] = sweep.of_turn(k, &[z, zd, zdd]);
                    [force, rate]
                }
                Direction::Base(force) => [force, V::ZERO],
                Direction::Delay(0) => [change[0], V::ZERO],
                Direction::Delay(_) => [V::ZERO, change[1]],
                Direction::Clock => change.map(|change| change * after_middle_s),
            };
            let [force, rate] = column;
            write(place, [sensor.turn.transposed_times(&force), sensor.turn.transposed_times(&rate)]);
        }
    }

    /// The combinations of the nuisances, one for each row of a reading. `factors` has those of nuisance `place`.
    pub(crate) fn combine(
        &self,
        factors: impl Fn(usize) -> [f64; 6],
        after_middle_s: f64,
        out: &mut Contraction,
    ) {
        out.clear();
        for (place, direction) in self.all.iter().enumerate() {
            let factors = factors(place);
            let add = |rows: &mut [V], axis: V| {
                for (row, factor) in rows.iter_mut().zip(factors) {
                    *row += axis * factor;
                }
            };
            match *direction {
                Direction::Shift(k, axis) => add(&mut out.shifts[k], axis),
                Direction::Turn(k, axis) => add(&mut out.turns[k], axis),
                Direction::Base(force) => add(&mut out.base, force),
                Direction::Delay(s) => {
                    for (time, factor) in out.times_s.iter_mut().zip(factors).skip(3 * s).take(3) {
                        *time += factor;
                    }
                }
                Direction::Clock => {
                    for (time, factor) in out.times_s.iter_mut().zip(factors) {
                        *time += factor * after_middle_s;
                    }
                }
            }
        }
    }
}

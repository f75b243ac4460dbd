//! The nuisances as directions of the recursion: what each of them changes.

use super::Sensing;
use crate::recursion::{Dual, FixedStep, JointAt, Links, M, Number, Six, V};
use calibrant_core::sensor::SensorKind;
use calibrant_machine::chain::ChainSensitivity;
use calibrant_machine::estimate::MachineQuantity;
use nalgebra::{Matrix3, Vector3, Vector6};

/// What a nuisance changes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Direction {
    /// Shift of fixed step `k` along axis `i` of the given axes: the joint's own, or the tip's for the sensor.
    Shift(usize, usize),
    /// Turn of fixed step `k` about axis `i` behind it.
    Turn(usize, usize),
    /// Gravity in the base, by derivative `i`.
    Gravity(usize),
    /// Position of a joint.
    Zero(usize),
    /// Time of a sensor.
    Delay(usize),
    /// Time of both sensors, in proportion to that after the middle.
    Clock,
}

/// All nuisances.
#[derive(Debug, Clone)]
pub(crate) struct Directions {
    all: Vec<Direction>,
    /// The axes along which each fixed step is shifted, in those before it.
    axes: Vec<Matrix3<f64>>,
    /// The turn of each fixed step.
    turns: Vec<Matrix3<f64>>,
    by_gravity: [Vector3<f64>; 3],
}

impl Directions {
    pub(crate) fn new(sensing: &Sensing, tip: &Matrix3<f64>) -> Self {
        let n = sensing.links.len();
        let of = |quantity: &MachineQuantity| {
            Some(match *quantity {
                MachineQuantity::Imu(_) => return None,
                MachineQuantity::Lever(axis) => Direction::Shift(n, axis.index()),
                MachineQuantity::Mounting(axis) => Direction::Turn(n, axis.index()),
                MachineQuantity::Tilt(k) => Direction::Gravity(k),
                MachineQuantity::Gravity => Direction::Gravity(2),
                MachineQuantity::Delay(sensor) => {
                    Direction::Delay(usize::from(sensor == SensorKind::Gyroscope))
                }
                MachineQuantity::ClockRate => Direction::Clock,
                MachineQuantity::Zero(j) => Direction::Zero(j),
                MachineQuantity::Geometry(j, k) if k < 3 => Direction::Shift(j, k),
                MachineQuantity::Geometry(j, k) => Direction::Turn(j, k - 3),
            })
        };
        let all = sensing.layout.quantities.iter().filter_map(of).collect();
        let turns: Vec<Matrix3<f64>> =
            (sensing.links.fixed.iter()).map(|step| Matrix3::from_fn(|i, j| step.c.0[i].0[j])).collect();
        let axes = turns[..n].iter().chain([tip]).copied().collect();
        Self { all, axes, turns, by_gravity: sensing.by_gravity }
    }

    /// Number of nuisances.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// The derivatives of a reading by all of them. `change` is that of the reading in time.
    pub(crate) fn columns(
        &self,
        of: &ChainSensitivity,
        change: &Vector6<f64>,
        after_middle_s: f64,
        mut write: impl FnMut(usize, Vector6<f64>),
    ) {
        let n = self.axes.len() - 1;
        let gravity = of.gravity();
        for (place, direction) in self.all.iter().enumerate() {
            let column = match *direction {
                Direction::Shift(k, i) if k == n => of.mount.lever.column(i).into_owned(),
                Direction::Turn(k, i) if k == n => of.mount.mounting.column(i).into_owned(),
                Direction::Shift(k, i) => of.geometry.column(6 * k + i).into_owned(),
                Direction::Turn(k, i) => of.geometry.column(6 * k + 3 + i).into_owned(),
                Direction::Gravity(i) => gravity * self.by_gravity[i],
                Direction::Zero(j) => of.positions.column(j).into_owned(),
                Direction::Delay(s) => {
                    Vector6::from_fn(|row, _| if row / 3 == s { change[row] } else { 0.0 })
                }
                Direction::Clock => change * after_middle_s,
            };
            write(place, column);
        }
    }

    /// Six combinations of the nuisances, one for each row of a reading, as slopes of the chain and its joints. `combination` has the factors of nuisance `place`.
    pub(crate) fn combined(
        &self,
        combination: impl Fn(usize) -> Six,
        after_middle_s: f64,
        links: &mut Links<Dual<Six>>,
        positions: &mut [Six],
    ) -> Six {
        let zero = Six::of(0.0);
        let mut shifts = [[zero; 3]; LARGEST];
        let mut turns = [[zero; 3]; LARGEST];
        let mut base = [zero; 3];
        let mut time = zero;
        positions.fill(zero);
        for (place, direction) in self.all.iter().enumerate() {
            let factors = combination(place);
            match *direction {
                Direction::Shift(k, i) => shifts[k][i] += factors,
                Direction::Turn(k, i) => turns[k][i] += factors,
                Direction::Gravity(i) => {
                    for (axis, base) in base.iter_mut().enumerate() {
                        *base -= factors * Six::of(self.by_gravity[i][axis]);
                    }
                }
                Direction::Zero(j) => positions[j] += factors,
                Direction::Delay(s) => {
                    time += Six(std::array::from_fn(|row| if row / 3 == s { factors.0[row] } else { 0.0 }));
                }
                Direction::Clock => time += factors * Six::of(after_middle_s),
            }
        }
        for (k, FixedStep { rho, c }) in links.fixed.iter_mut().enumerate() {
            let shift = M::<Six>::of(&self.axes[k]).times(&V(shifts[k]));
            // C exp(δ) = C + C [δ]×: its rows are those of C, crossed with δ
            let turn = V(turns[k]);
            for i in 0..3 {
                rho.0[i].slope = shift.0[i];
                let row = V(std::array::from_fn(|j| Six::of(self.turns[k][(i, j)]))).cross(&turn);
                for j in 0..3 {
                    c.0[i].0[j].slope = row.0[j];
                }
            }
        }
        for (axis, base) in base.into_iter().enumerate() {
            links.base.0[axis].slope = base;
        }
        time
    }
}

/// Most fixed steps of a chain: that of each joint, and that to the sensor.
pub(crate) const LARGEST: usize = 101;

/// A joint whose state moves along a direction: by `zero` in position, and by `time` along its motion.
pub(crate) fn moved(at: &JointAt<f64>, jerk: f64, zero: Six, time: Six) -> JointAt<Dual<Six>> {
    let dual = |value: f64, slope: Six| Dual::new(Six::of(value), slope);
    let by_time = |rate: f64| time * Six::of(rate);
    let q = zero + by_time(at.qd);
    JointAt {
        q: dual(at.q, q),
        qd: dual(at.qd, by_time(at.qdd)),
        qdd: dual(at.qdd, by_time(jerk)),
        cos: dual(at.cos, q * Six::of(-at.sin)),
        sin: dual(at.sin, q * Six::of(at.cos)),
    }
}

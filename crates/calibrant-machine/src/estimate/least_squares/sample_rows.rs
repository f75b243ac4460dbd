//! The rows of a sample in the least-squares problem: residual and derivatives, divided by the standard deviation.

use super::huber;
use crate::estimate::problem::{Layout, TiltedGravity};
use crate::estimate::{MachineParameters, MachineQuantity};
use crate::reference::{Felt, MotionColumns};
use calibrant_core::sensor::{Axis, ImuQuantity, SensorKind};
use nalgebra::{Vector3, Vector6};

/// How an unknown enters the readings.
#[derive(Debug, Clone, Copy)]
enum Entry {
    /// Entry of a sensor's matrix or bias: axis, and column of `[s; 1]`.
    Sensor(SensorKind, usize, usize),
    /// Entry of the g-sensitivity.
    GSensitivity(usize, usize),
    /// A column of what is felt.
    Motion(usize),
    /// A tilt (0, 1) or the magnitude (2) of gravity.
    Gravity(usize),
    /// The delay of a sensor.
    Delay(SensorKind),
    ClockRate,
}

/// Writes rows for one set of unknowns.
pub(crate) struct RowWriter {
    columns: MotionColumns,
    entries: Vec<Entry>,
    gravity: [Vector3<f64>; 3],
}

/// A sample of a sensor.
pub(crate) struct Sample<'a> {
    pub(crate) sensor: SensorKind,
    pub(crate) reading: &'a Vector3<f64>,
    pub(crate) sd: Vector3<f64>,
    /// Time after the middle of the recording, s.
    pub(crate) after_middle_s: f64,
}

impl RowWriter {
    pub(crate) fn new(
        layout: &Layout,
        columns: MotionColumns,
        gravity: &TiltedGravity,
        parameters: &MachineParameters,
    ) -> Self {
        let of = |quantity: &MachineQuantity| match *quantity {
            MachineQuantity::Imu(of) => sensor_entry(of),
            MachineQuantity::Lever(axis) => Entry::Motion(columns.lever() + axis.index()),
            MachineQuantity::Mounting(axis) => Entry::Motion(columns.mounting() + axis.index()),
            MachineQuantity::Tilt(k) => Entry::Gravity(k),
            MachineQuantity::Gravity => Entry::Gravity(2),
            MachineQuantity::Delay(sensor) => Entry::Delay(sensor),
            MachineQuantity::ClockRate => Entry::ClockRate,
            MachineQuantity::Zero(j) => Entry::Motion(columns.zeros() + j),
            MachineQuantity::Geometry(j, k) => Entry::Motion(columns.geometry() + 6 * j + k),
        };
        Self {
            columns,
            entries: layout.quantities.iter().map(of).collect(),
            gravity: gravity.derivatives(parameters),
        }
    }

    /// Length of a row: control points, unknowns, residual.
    pub(crate) fn length(&self) -> usize {
        self.columns.controls + self.entries.len() + 1
    }

    /// Writes the three rows of a sample, one after the other. Returns their part of the cost `2ρ`.
    pub(crate) fn write(
        &self,
        sample: &Sample<'_>,
        felt: &Felt,
        at: &MachineParameters,
        rows: &mut [f64],
    ) -> f64 {
        let by_gravity: [Vector6<f64>; 3] = self
            .gravity
            .map(|change| (0..3).map(|k| felt.columns[self.columns.gravity() + k] * change[k]).sum());
        let predicted = predicted(sample.sensor, &felt.force, &felt.rate, at);
        let mut cost = 0.0;
        for (axis, row) in rows.chunks_exact_mut(self.length()).take(3).enumerate() {
            let whitened = (sample.reading[axis] - predicted[axis]) / sample.sd[axis];
            let (weight, part) = huber(whitened);
            cost += part;
            let scale = weight / sample.sd[axis];
            // dy = S_i · (df or dw) + Γ_i · df
            let gains = gains(sample.sensor, axis, at) * scale;
            let (controls, rest) = row.split_at_mut(self.columns.controls);
            for (value, column) in controls.iter_mut().zip(&felt.columns) {
                *value = gains.dot(column);
            }
            let stimulus = match sample.sensor {
                SensorKind::Accelerometer => felt.force,
                SensorKind::Gyroscope => felt.rate,
            };
            for (value, entry) in rest.iter_mut().zip(&self.entries) {
                *value = match *entry {
                    Entry::Sensor(sensor, of, column) if sensor == sample.sensor && of == axis => {
                        scale * if column < 3 { stimulus[column] } else { 1.0 }
                    }
                    Entry::GSensitivity(of, column)
                        if sample.sensor == SensorKind::Gyroscope && of == axis =>
                    {
                        scale * felt.force[column]
                    }
                    Entry::Sensor(..) | Entry::GSensitivity(..) => 0.0,
                    Entry::Motion(column) => gains.dot(&felt.columns[column]),
                    Entry::Gravity(k) => gains.dot(&by_gravity[k]),
                    Entry::Delay(sensor) if sensor == sample.sensor => gains.dot(&felt.change),
                    Entry::Delay(_) => 0.0,
                    Entry::ClockRate => sample.after_middle_s * gains.dot(&felt.change),
                };
            }
            rest[self.entries.len()] = weight * whitened;
        }
        cost
    }
}

/// The reading of a perfect recording: `S f + b`, or `S w + b + Γ f`.
pub(crate) fn predicted(
    sensor: SensorKind,
    force: &Vector3<f64>,
    rate: &Vector3<f64>,
    at: &MachineParameters,
) -> Vector3<f64> {
    match sensor {
        SensorKind::Accelerometer => at.imu[SensorKind::Accelerometer].reading(force),
        SensorKind::Gyroscope => at.imu[SensorKind::Gyroscope].reading(rate) + at.imu.g_sensitivity * force,
    }
}

/// Derivative of one axis of a reading by force and rate.
fn gains(sensor: SensorKind, axis: usize, at: &MachineParameters) -> Vector6<f64> {
    let mut gains = Vector6::zeros();
    match sensor {
        SensorKind::Accelerometer => {
            gains
                .fixed_rows_mut::<3>(0)
                .copy_from(&at.imu[SensorKind::Accelerometer].matrix.row(axis).transpose());
        }
        SensorKind::Gyroscope => {
            gains.fixed_rows_mut::<3>(0).copy_from(&at.imu.g_sensitivity.row(axis).transpose());
            gains
                .fixed_rows_mut::<3>(3)
                .copy_from(&at.imu[SensorKind::Gyroscope].matrix.row(axis).transpose());
        }
    }
    gains
}

fn sensor_entry(quantity: ImuQuantity) -> Entry {
    let index = |axis: Axis| axis.index();
    match quantity {
        ImuQuantity::Of(sensor, of) => match of.entry() {
            Some((row, column)) => Entry::Sensor(sensor, index(row), index(column)),
            None => Entry::Sensor(sensor, index(of.axis()), 3),
        },
        ImuQuantity::GSensitivity(row, column) => Entry::GSensitivity(index(row), index(column)),
        // a machine's recording is calibrated at one temperature
        ImuQuantity::Thermal(sensor, _) => Entry::Sensor(sensor, 0, 3),
    }
}

//! What was expected of each quantity, and the units that tables show.

use calibrant_core::sensor::Axis;
use calibrant_machine::chain::JointKind;
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup};
use calibrant_machine::reference::Motion;

/// Factor and symbol of the unit in which tables show a quantity: mm, mrad, ms, ppm.
pub(super) fn machine_unit(
    calibration: &MachineCalibration,
    quantity: MachineQuantity,
) -> (f64, &'static str) {
    match quantity {
        MachineQuantity::Imu(of) => (1.0, calibration.sensors.unit_of(of)),
        MachineQuantity::Lever(_) => (1e3, "mm"),
        MachineQuantity::Mounting(_) | MachineQuantity::Tilt(_) => (1e3, "mrad"),
        MachineQuantity::Gravity => (1.0, "m/s²"),
        MachineQuantity::Delay(_) => (1e3, "ms"),
        MachineQuantity::ClockRate => (1e6, "ppm"),
        MachineQuantity::Zero(joint) => (1e3, if turns(calibration, joint) { "mrad" } else { "mm" }),
        MachineQuantity::Geometry(_, k) => (1e3, if k < 3 { "mm" } else { "mrad" }),
    }
}

fn turns(calibration: &MachineCalibration, joint: usize) -> bool {
    match &calibration.motion {
        Motion::Joints(joints) => {
            joints.chain.joints.get(joint).is_none_or(|of| of.kind != JointKind::Prismatic)
        }
        Motion::Poses(_) => true,
    }
}

/// What was expected of a quantity beside the sensor's.
pub(super) fn expected(setup: &MachineSetup, quantity: MachineQuantity) -> f64 {
    match quantity {
        MachineQuantity::Lever(axis) => setup.lever_m[axis.index()],
        MachineQuantity::Gravity => setup.gravity_mps2,
        MachineQuantity::Delay(_) => setup.delay_s,
        _ => 0.0,
    }
}

/// The quantities of mount, gravity and clock that a machine has, estimated or held.
pub(super) fn of_mount(calibration: &MachineCalibration) -> Vec<MachineQuantity> {
    let mut quantities: Vec<MachineQuantity> = Axis::ALL.map(MachineQuantity::Lever).into();
    quantities.extend(Axis::ALL.map(MachineQuantity::Mounting));
    quantities.extend(calibration.noise.iter().map(|of| MachineQuantity::Delay(of.sensor)));
    quantities.push(MachineQuantity::ClockRate);
    quantities.extend([0, 1].map(MachineQuantity::Tilt));
    quantities.push(MachineQuantity::Gravity);
    quantities
}

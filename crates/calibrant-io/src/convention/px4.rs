//! PX4's parameters, as a file that QGroundControl loads: vehicle, component, name, value and type, separated by tabs.
//!
//! The direction is raw → true: `a = (y − t(T) − o) ∘ k`, `ω = y − t(T) − o`, in the sensor's frame, before the rotation of the board.
//! The polynomial `t` about `TREF` has the powers 1 to 3 and no constant, for `t` and `o` are both subtracted. `T` counts within `TMIN` and
//! `TMAX` only.
//!
//! The numbers are those of the first sensor of each kind. PX4 uses a group only if its `_ID` is that of the device: a vehicle that was
//! calibrated has it, and the file leaves it.

use super::autopilot::{AXES, POWERS, gains, range, single};
use super::file::CalibratedImuFile;
use super::format::ImuFormat;
use super::words::written_by;
use calibrant_core::diagnostic::convention::FormatNeeds;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::sensor::SensorKind;
use calibrant_recording::text::decoding::Checked;

pub(super) fn write(file: &CalibratedImuFile, warnings: &mut Vec<Diagnostic>) -> Checked<String> {
    let imu = &file.imu;
    let thermal = &imu.parameters.thermal;
    let range_c = range(thermal, ImuFormat::Px4.title())?;
    let mut out = format!("# {}\n# vehicle-id component-id name value type\n", written_by());
    let mut put = |name: String, value: String, kind: u8| out += &format!("1\t1\t{name}\t{value}\t{kind}\n");
    let (float, integer) = (9, 6);
    let mut ids = Vec::new();
    for (sensor_kind, _) in imu.units.present() {
        let sensor = imu.parameters.sensor(sensor_kind);
        let (name, letter) = match sensor_kind {
            SensorKind::Accelerometer => ("ACC", "A"),
            SensorKind::Gyroscope => ("GYRO", "G"),
        };
        // a warm-up in one pose has no offset of the accelerometer, and no gain
        let has_bias = imu.has_bias(sensor_kind);
        if has_bias {
            ids.push(format!("CAL_{name}0_ID"));
        }
        for (axis, bias) in AXES.iter().zip(&sensor.bias).filter(|_| has_bias) {
            put(format!("CAL_{name}0_{axis}OFF"), single(*bias), float);
        }
        if sensor_kind == SensorKind::Accelerometer && has_bias {
            for (axis, gain) in AXES.iter().zip(&gains(imu, ImuFormat::Px4.title(), 0.1..=3.0)?) {
                put(format!("CAL_{name}0_{axis}SCALE"), single(*gain), float);
            }
        }
        let terms = thermal.sensor(sensor_kind);
        let Some([low, high]) = range_c.filter(|_| !terms.is_none()) else { continue };
        put(format!("TC_{letter}_ENABLE"), "1".into(), integer);
        ids.push(format!("TC_{letter}0_ID"));
        for (name, value) in [("TREF", thermal.reference_c), ("TMIN", low), ("TMAX", high)] {
            put(format!("TC_{letter}0_{name}"), single(value), float);
        }
        for axis in 0..3 {
            for power in 0..=POWERS {
                let value = power.checked_sub(1).and_then(|m| terms.bias.get(m)).map_or(0.0, |of| of[axis]);
                put(format!("TC_{letter}0_X{power}_{axis}"), single(value), float);
            }
        }
    }
    let how = Phrase("a vehicle that was calibrated has them: keep them".into());
    warnings.push(FormatNeeds { format: "PX4", fields: ids, how }.into());
    Ok(out)
}

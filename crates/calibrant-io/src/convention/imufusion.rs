//! imufusion's calibration (xioTechnologies' Fusion) as Python: writes three arrays for each sensor.
//!
//! The direction is raw → true, as `imufusion.model_inertial(raw, misalignment, sensitivity, offset)` corrects:
//! `s = M ((y − o) ∘ k)`. So `o = b`, `k_j = C_jj`, `M_ij = C_ij/C_jj`: imu_tk's `T` and `K`. The unit of readings is any.

use super::file::CalibratedImuFile;
use super::words::{invalid, written_by};
use calibrant_core::sensor::Correction;
use calibrant_recording::text::decoding::Checked;

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    let imu = &file.imu;
    let mut out = format!(
        "# {}: raw to true, as imufusion.model_inertial takes it:\n\
         # imufusion.model_inertial(raw, accelerometer_misalignment, accelerometer_sensitivity, accelerometer_offset)\n\
         # frame: {}\n\
         # imufusion.Ahrs takes g and deg/s: divide accelerometer_sensitivity by 9.80665, and take np.degrees of gyroscope_sensitivity.\n\
         import numpy as np\n",
        written_by(),
        imu.frame.replace(['\n', '\r'], " ").trim()
    );
    for (sensor_kind, unit) in imu.units.present() {
        let correction = Correction::of(imu.parameters.sensor(sensor_kind));
        let Some(of) = correction.filter(|of| of.scale().iter().all(|&k| k != 0.0)) else {
            let message = format!(
                "the correction of the {sensor_kind} has a zero on its diagonal, which imufusion's cannot have"
            );
            return Err(invalid(message, "turn the frame with option `gauge` symmetric"));
        };
        let (unit, si) = (unit.symbol(), sensor_kind.stimulus_unit().symbol());
        let misalignment = of.misalignment();
        let rows: Vec<String> = misalignment.row_iter().map(|row| list(row.iter())).collect();
        out += &format!(
            "\n# readings in {unit}, corrected in {si}\n\
             {sensor_kind}_misalignment = np.array([\n    {},\n])\n\
             {sensor_kind}_sensitivity = np.array({})\n\
             {sensor_kind}_offset = np.array({})\n",
            rows.join(",\n    "),
            list(of.scale().iter()),
            list(of.bias.iter()),
        );
    }
    Ok(out)
}

/// Numbers in brackets, which read back to the same bits.
fn list<'a>(values: impl Iterator<Item = &'a f64>) -> String {
    let values: Vec<_> = values.map(|value| format!("{:?}", value + 0.0)).collect();
    format!("[{}]", values.join(", "))
}

//! ArduPilot's parameters, a name and a value a line, as its ground stations load them.
//!
//! The direction is raw → true: `a = (y − p(T) + p(T_cal) − o) ∘ k`, `ω = y − p(T) + p(T_cal) − o`, after the sensor's own rotation and
//! before the board's. `p(T) = 10⁻⁶ Σ_m c_m δ^m`, m from 1 to 3, with `δ = T − 35 °C`. Both temperatures count within `TMIN` and `TMAX`
//! only. So the polynomial is moved to 35 °C, its constant falls away, and `o` is the bias at `T_cal`, which lies in the range.
//!
//! The numbers are those of the first IMU. ArduPilot measures `INS_GYROFFS` anew at each boot unless `INS_GYR_CAL` is 0.

use super::autopilot::{AXES, POWERS, gains, range, single};
use super::file::CalibratedImuFile;
use super::format::ImuFormat;
use super::words::{input_error, written_by};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::SensorKind;
use calibrant_core::sensor::reference_temperature::moved;
use calibrant_recording::text::decoding::Checked;

/// The reference of the polynomials, °C.
const REFERENCE_C: f64 = 35.0;
/// The temperatures that it takes, °C, and the least range, K.
const LIMITS_C: [f64; 2] = [-70.0, 80.0];
const LEAST_RANGE_K: f64 = 10.0;

pub(super) fn write(file: &CalibratedImuFile) -> Checked<String> {
    let imu = &file.imu;
    let (thermal, title) = (&imu.parameters.thermal, ImuFormat::ArduPilot.title());
    let range_c = range(thermal, title)?;
    if let Some([low, high]) = range_c
        && !(high - low >= LEAST_RANGE_K && low >= LIMITS_C[0] && high <= LIMITS_C[1])
    {
        return Err(input_error(
            Refusal::ConversionImpossible,
            format!(
                "{title} takes temperatures from {} to {} °C that are at least {LEAST_RANGE_K} K apart, and those of the calibration are {low} to {high} °C",
                LIMITS_C[0], LIMITS_C[1]
            ),
            "take the values at one temperature with option `temperature` CELSIUS",
        ));
    }
    let mut out = format!(
        "# {}\n# the gyroscope's offsets are measured anew at each boot, unless INS_GYR_CAL is 0\n",
        written_by()
    );
    let mut put = |name: String, value: f64| out += &format!("{name},{}\n", single(value));
    let calibrated_c = range_c.map(|[low, high]| thermal.reference_c.clamp(low, high));
    if let Some([low, high]) = range_c {
        for (name, value) in [("ENABLE", 1.0), ("TMIN", low), ("TMAX", high)] {
            put(format!("INS_TCAL1_{name}"), value);
        }
    }
    for (sensor_kind, _) in imu.units.present() {
        let name = match sensor_kind {
            SensorKind::Accelerometer => "ACC",
            SensorKind::Gyroscope => "GYR",
        };
        let here = imu.parameters.at(calibrated_c.unwrap_or(thermal.reference_c));
        // a warm-up in one pose has no offset of the accelerometer, and no gain
        let has_bias = imu.has_bias(sensor_kind);
        for (axis, bias) in AXES.iter().zip(&here.sensor(sensor_kind).bias).filter(|_| has_bias) {
            put(format!("INS_{name}OFFS_{axis}"), *bias);
        }
        if sensor_kind == SensorKind::Accelerometer && has_bias {
            for (axis, gain) in AXES.iter().zip(&gains(imu, title, 0.8..=1.2)?) {
                put(format!("INS_ACCSCAL_{axis}"), *gain);
            }
        }
        let Some(calibrated_c) = calibrated_c else { continue };
        put(format!("INS_{name}1_CALTEMP"), calibrated_c);
        let moved = moved(&thermal.sensor(sensor_kind).bias, REFERENCE_C - thermal.reference_c);
        for (power, coefficients) in (1..).zip(&moved[..POWERS]) {
            for (axis, value) in AXES.iter().zip(coefficients) {
                put(format!("INS_TCAL1_{name}{power}_{axis}"), 1e6 * value);
            }
        }
    }
    Ok(out)
}

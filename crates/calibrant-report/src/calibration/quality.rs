//! The data and the quality of a calibration, in words.

use crate::gravity::{advice, known_to};
use crate::number_format::{
    count, counted, missed_angle, probability, significant, with_sd, with_sd_or_exact,
};
use crate::sheet::Table;
use calibrant_core::estimate::{
    Calibration, FaceTilt, RecordingBiases, Recovered, RecoveredMotion, TimeOffset, UncertainGravity,
};
use calibrant_core::sensor::{ReadingUnit, SensorKind, SensorThermal, ThermalPart};

/// A parameter with more than this share of its information from the prior is the prior.
const ALL_PRIOR: f64 = 0.99;

/// Below this, a probability counts as evidence against the model.
const SIGNIFICANT: f64 = 0.001;

/// The data of a calibration: `14 of 14 holds, 12 of 13 rotations (not used: 3 → 4) between them and 1 turn of known angle`.
pub(super) fn used_in_words(calibration: &Calibration) -> String {
    let holds = match &calibration.recovered {
        Recovered::Motion(motion) => {
            let intervals = counted(motion.motion.intervals(), "interval");
            return format!("{} samples of a motion of {intervals}", count(motion.residuals.len()));
        }
        Recovered::OnMachine(_) => return "the motion of a machine".to_owned(),
        Recovered::Holds(holds) => holds,
    };
    let used = |all: usize, what: &str, left_out: Vec<String>| {
        let from = format!("{} of {}", all - left_out.len(), counted(all, what));
        match left_out.as_slice() {
            [] => from,
            some => format!("{from} (not used: {})", some.join(", ")),
        }
    };
    let bad = (0..holds.holds.len()).filter(|&k| !holds.holds[k].used).map(|k| (k + 1).to_string());
    let mut from = vec![used(holds.holds.len(), "hold", bad.collect())];
    let (rotations, turns) = (calibration.rotations(), calibration.turns());
    if !rotations.is_empty() {
        let bad = rotations.iter().filter(|rotation| !rotation.used);
        let bad = bad.map(|rotation| format!("{} → {}", rotation.from_hold + 1, rotation.to_hold + 1));
        from.push(used(rotations.len(), "rotation", bad.collect()) + " between them");
    }
    if !turns.is_empty() {
        from.push(counted(turns.len(), "turn") + " of known angle");
    }
    let last = from.pop().unwrap_or_default();
    if from.is_empty() { last } else { format!("{} and {last}", from.join(", ")) }
}

/// Rotation errors, errors of known turns, gravity residuals, and whether the assumed noise explains the data.
/// Rotation errors before the calibration are named too. Each is a sentence without its full stop.
pub(super) fn calibration_quality(calibration: &Calibration) -> Vec<String> {
    let mut parts = Vec::new();
    if calibration.used_rotations().next().is_some() {
        parts.push(format!(
            "the rotation error is {} rms ({} before)",
            missed_angle(calibration.rotation_rms_rad()),
            missed_angle(calibration.rotation_rms_before_rad())
        ));
    }
    if !calibration.turns().is_empty() && !calibration.turns_check_the_gains() {
        parts.push("the known turns determine the gains, and no data are left to check these".into());
    } else if !calibration.turns().is_empty() {
        let squares =
            calibration.turns().iter().map(|turn| (turn.measured_rad - turn.angle_rad).norm_squared());
        let rms = (squares.sum::<f64>() / calibration.turns().len() as f64).sqrt();
        parts.push(format!("the error of the known turns is {} rms", missed_angle(rms)));
    }
    if let Some(holds) = calibration.holds() {
        parts.extend(holds.tilt.as_ref().map(face_alignment));
        parts.push(match holds.degrees_of_freedom {
            0 if calibration.datasheet_prior
                && calibration.prior_share.iter().any(|share| *share > ALL_PRIOR) =>
            {
                "with the gains of the datasheet gravity gives the bias, and no data are left to check it"
                    .into()
            }
            0 => "gravity in the holds determines the accelerometer, and no data are left to check it".into(),
            _ => format!(
                "the gravity residual in the holds is {} mm/s² rms",
                significant(1e3 * holds.magnitude_residual_rms_mps2, 2)
            ),
        });
    }
    parts.extend(calibration.fit.p_value.map(noise_explains));
    parts
}

/// A time offset with its standard deviation: `+11.4 ± 0.7 ms`.
pub(super) fn milliseconds(time: &TimeOffset) -> String {
    let sign = if time.offset_s > 0.0 { "+" } else { "" };
    format!("{sign}{} ms", with_sd(1e3 * time.offset_s, 1e3 * time.sd_s))
}

/// What is unknown, or was taken out of the readings: the latitude, gravity beside a motion, the clock of the recording.
pub(super) fn nuisances_in_words(calibration: &Calibration) -> Vec<String> {
    let latitude = calibration.unknown_latitude().map(|unknown| {
        format!(
            "without holds.latitude_deg, the Earth's rate about the vertical makes standard deviations up to {:.1} times larger ({})",
            unknown.times,
            unknown.parameter.name()
        )
    });
    latitude.into_iter().chain(tilt(calibration)).chain(clock(calibration)).collect()
}

/// The part of the gains' uncertainty that is gravity's, and what would make it smaller.
pub(super) fn uncertain_gravity(calibration: &Calibration) -> Option<String> {
    let UncertainGravity { gravity, parameter, sd, sd_without } = calibration.uncertain_gravity()?;
    Some(format!(
        "gravity is known to {} only, an error that all gains of the accelerometer share: it makes the standard deviation of {} {} in place of {}; {}",
        known_to(&gravity),
        parameter.name(),
        significant(sd, 2),
        significant(sd_without, 2),
        advice(&gravity)
    ))
}

/// The reference temperature, the polynomials and the temperatures of the holds; `None` without temperature terms.
pub(super) fn temperature_in_words(calibration: &Calibration) -> Option<String> {
    calibration.holds()?.temperatures_c.as_ref()?;
    let thermal = &calibration.imu.thermal;
    let celsius = |t: f64| significant(t, 3);
    let beyond = |(_, of): (SensorKind, &SensorThermal)| {
        of.order(ThermalPart::Bias).max(of.order(ThermalPart::Scale)) > 2
    };
    let more = if thermal.sensors.iter().any(beyond) { " + …" } else { "" };
    let range = thermal.range_c.map_or_else(String::new, |[low, high]| {
        format!(". The holds were at {} to {} °C", celsius(low), celsius(high))
    });
    let lag = calibration.holds()?.thermometer.map_or_else(String::new, |lag| {
        format!(
            ". The thermometer may lag the sensor: {} s, which the standard deviations carry; temperature.lag_sd_s = 0 says that it is the sensor's own",
            with_sd(lag.lag_s, lag.sd_s)
        )
    });
    Some(format!(
        "Biases and gains are those at T₀ = {} °C. With τ = T − T₀, a bias increases by bias_per_k τ + bias_per_k2 τ²{more}, and a gain is multiplied by \
         1 + scale_per_k τ + scale_per_k2 τ²{more}{range}{lag}.",
        celsius(thermal.reference_c)
    ))
}

/// The clock of the recording beside that of a commanded motion.
fn clock(calibration: &Calibration) -> Option<String> {
    let Recovered::Motion(RecoveredMotion { clock, .. }) = &calibration.recovered else { return None };
    if clock.given.is_exact() {
        return None;
    }
    Some(format!(
        "the time of the motion is that of the recording plus {} ms, and the rates of both clocks differ by {} ppm; the standard deviations contain both",
        with_sd_or_exact(1e3 * clock.delay_s, 1e3 * clock.delay_sd_s),
        with_sd_or_exact(1e6 * clock.rate, 1e6 * clock.rate_sd)
    ))
}

/// The tilt of the sensor against gravity beside a commanded motion.
fn tilt(calibration: &Calibration) -> Option<String> {
    let Recovered::Motion(RecoveredMotion { gravity: Some(recovered), .. }) = &calibration.recovered else {
        return None;
    };
    let force = recovered.gravity.force_mps2.map(|f| significant(f, 6));
    let given =
        format!("gravity of ({}, {}, {}) m/s² was taken out of the readings", force.x, force.y, force.z);
    let tilts = recovered.tilts();
    if tilts.is_empty() {
        return Some(format!("{given}; its direction counts as exact"));
    }
    let degrees = |(name, value, sd): &(String, f64, f64)| {
        format!("{name} {}°", with_sd(value.to_degrees(), sd.to_degrees()))
    };
    let all: Vec<String> = tilts.iter().map(degrees).collect();
    Some(format!("{given}; the sensor's tilt against it is {}, which the biases carry", all.join(", ")))
}

/// The biases of a sensor in earlier recordings less that in the last, with their standard deviations.
pub(super) fn earlier_biases(
    table: &mut Table,
    (sensor_kind, unit): (SensorKind, ReadingUnit),
    biases: Option<&RecordingBiases>,
) {
    let Some(biases) = biases else { return };
    for (r, (value, sd)) in biases.values.iter().zip(biases.sds()).enumerate() {
        let axes = [0, 1, 2].map(|axis| with_sd(value[axis], sd[axis]));
        table.explain(
            &format!("{sensor_kind} bias {} − {} (x, y, z)", r + 1, biases.values.len() + 1),
            format!("{} {}", axes.join(", "), unit.symbol()),
            "The bias in this recording less that in the last. The data are freed from it: the biases are those of the last recording. Its \
             uncertainty is part of the standard deviations.",
        );
    }
}

/// The drift of the accelerometer's bias about each axis with its standard deviation, and its unit.
pub(super) fn bias_drift(calibration: &Calibration) -> Option<(String, &'static str)> {
    let drift = calibration.holds()?.drift.as_deref()?;
    let sd = drift.sd();
    let axes = [0, 1, 2].map(|axis| with_sd(drift.value[axis], sd[axis]));
    Some((axes.join(", "), calibration.unit(SensorKind::Accelerometer).symbol()))
}

/// How well the sensor was placed on its faces.
fn face_alignment(tilt: &FaceTilt) -> String {
    let shown = if tilt.sd_rad == 0.0 && tilt.degrees_of_freedom > 0 {
        "noise alone explains the scatter of the faces, so no tilt shows".into()
    } else {
        let sd = significant(tilt.sd_rad.to_degrees(), 2);
        format!("the face alignment is {sd}° about each axis, {}", tilt.source_in_words())
    };
    [Some(shown), tilt.assumed_in_words()].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// Whether model and assumed noise explain the data.
pub(crate) fn noise_explains(p: f64) -> String {
    let p_value = probability(p);
    if p < SIGNIFICANT {
        format!(
            "model and assumed noise do not explain the data (χ² p-value {p_value}): the noise is larger than assumed, or the model misses something"
        )
    } else if p > 1.0 - SIGNIFICANT {
        format!(
            "the residuals are smaller than the assumed noise allows (χ² p-value {p_value}): the assumed noise and the standard deviations are too large"
        )
    } else {
        format!("model and assumed noise explain the data (χ² p-value {p_value})")
    }
}

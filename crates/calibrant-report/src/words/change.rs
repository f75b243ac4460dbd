//! Sentences about a sensor that changes within a recording.

use calibrant_core::diagnostic::{Change, Changed, Course};
use calibrant_core::number_format::fixed;
use calibrant_core::sensor::{Axis, SensorKind};
use nalgebra::Vector3;

/// Range of temperatures in a recording that can explain a change, K.
const TEMPERATURE_RANGE_K: f64 = 1.0;

/// What changes, when, by how much, and what to do.
///
/// `temperature_c`: lowest and highest of the recording, °C. `None` where they are unknown, or where the model follows the temperature.
pub(super) fn change(change: &Change, temperature_c: Option<(f64, f64)>) -> String {
    let reason = match (temperature_c, change.course) {
        (Some((low, high)), _) if high - low >= TEMPERATURE_RANGE_K => {
            format!(
                "The temperature goes from {low:.1} to {high:.1} °C, and the model ignores it: set [temperature]. Or"
            )
        }
        (_, Course::Drift) => "Let the sensor warm up before the recording. Or".to_owned(),
        (_, Course::Episode { .. }) => {
            "Was the sensor touched, warmed or clamped then, or did its supply change? If so, record again. To use this recording,".to_owned()
        }
        (_, Course::Step { .. }) => format!(
            "Was the sensor knocked, did its mounting slip, did it saturate, was it still warming up? If so, record again. {}To use this recording,",
            if change.of == Changed::Bias { "Or its bias walks at random. " } else { "" }
        ),
    };
    let remedy = match change.course {
        Course::Drift => "calibrate the first and the second half separately",
        Course::Episode { .. } => "calibrate without the data in between",
        Course::Step { .. } => "calibrate the data before and after separately",
    };
    format!(
        "{}: {}. The estimates are a mean over the change, and their standard deviations do not include it. {reason} {remedy} (holds.intervals_s), and compare.",
        headline(change),
        amounts(change)
    )
}

/// Which sensor changes, and when.
pub(crate) fn headline(change: &Change) -> String {
    match change.course {
        Course::Drift => format!("the {} drifts through the recording", change.sensor_kind),
        Course::Episode { first, last, start_s, end_s } => format!(
            "the {} changes at about {start_s:.0} s and back at about {end_s:.0} s (hold {} to hold {})",
            change.sensor_kind,
            first + 1,
            last + 1
        ),
        Course::Step { before, after, time_s } => {
            let place = match before == after {
                true => format!("in hold {}", after + 1),
                false => format!("between hold {} and hold {}", before + 1, after + 1),
            };
            format!("the {} changes at about {time_s:.0} s ({place})", change.sensor_kind)
        }
    }
}

/// What changes and by how much: `its bias steps by 3.1, −0.2, 0.4 mm/s², up to 12 standard deviations`.
fn amounts(change: &Change) -> String {
    let what = match change.instead {
        Some(instead) => format!("its {} (or its {})", name(change.of), name(instead)),
        None => format!("its {}", name(change.of)),
    };
    let ending = if change.of == Changed::Bias { "s" } else { "" };
    let moves = match change.course {
        Course::Step { .. } => format!("step{ending} by"),
        Course::Drift => format!("change{ending} from beginning to end by"),
        Course::Episode { .. } => format!("differ{ending} in between by"),
    };
    let (scale, unit) = match (change.of, change.sensor_kind) {
        (Changed::Bias, SensorKind::Accelerometer) => (1e3, "mm/s²"),
        (Changed::Bias, SensorKind::Gyroscope) => (1_f64.to_degrees(), "°/s"),
        (Changed::Gain, _) => (100.0, "%"),
        (Changed::Axes, _) => (1_f64.to_degrees(), "°"),
    };
    let known: Vec<Axis> = Axis::ALL.into_iter().filter(|axis| change.sd[axis.index()] > 0.0).collect();
    let listed = rounded(&change.amount, &change.sd, &known, scale);
    let on = match known.as_slice() {
        [_, _, _] => String::new(),
        some => format!(" on {}", some.iter().map(Axis::to_string).collect::<Vec<_>>().join(", ")),
    };
    format!("{what} {moves} {listed} {unit}{on}, up to {:.0} standard deviations", change.in_sd())
}

fn name(changed: Changed) -> &'static str {
    match changed {
        Changed::Bias => "bias",
        Changed::Gain => "gains",
        Changed::Axes => "axes (against the accelerometer's)",
    }
}

/// The amounts, rounded to the first digit of their standard deviations.
fn rounded(amount: &Vector3<f64>, sd: &Vector3<f64>, axes: &[Axis], scale: f64) -> String {
    let one = |axis: &Axis| {
        let (amount, sd) = (scale * amount[axis.index()], scale * sd[axis.index()]);
        let decimals = (-sd.log10().floor()).clamp(0.0, 9.0) as usize;
        fixed(amount, decimals)
    };
    axes.iter().map(one).collect::<Vec<_>>().join(", ")
}

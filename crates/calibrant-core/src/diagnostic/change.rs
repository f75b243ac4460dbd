//! The check for a sensor that changes within a recording: what changes, when, and by how much.

use super::check::checks;
use super::parts::{Part, Parts, listed, neither};
use crate::number_format::{fixed, significant};
use crate::sensor::{Axis, ReadingUnit, SensorKind};
use nalgebra::Vector3;
use std::fmt;

/// Range of temperatures in a recording that can explain a change, K.
const TEMPERATURE_RANGE_K: f64 = 1.0;

checks! {
    /// A sensor changes within the recording. The estimates are a mean of before and after.
    SensorChanged "sensor-changed" Warning {
        /// The change.
        change: Change,
        /// The coldest sample, °C. `None`: the temperature is unknown, or the model follows it.
        coldest_c: Option<f64>,
        /// The hottest sample, °C.
        hottest_c: Option<f64>,
    }
    decided "A score test of the residuals in the order of time finds a step, a drift or an episode."
    remedy "Calibrate the parts separately (holds.intervals_s) and compare. Let the sensor warm up."
    says change.in_words(coldest_c.zip(*hottest_c));

    /// The accelerometer's bias drifts by more than was allowed for. The biases are those in the middle of the recording.
    BiasDrifts "bias-drifts" Warning {
        /// The drift from the first hold to the last, in the unit of the readings.
        drift: Vector3<f64>,
        unit: ReadingUnit,
        /// That of the worst axis, in the standard deviations that were expected.
        deviations: f64,
        /// Middle of the first hold, s.
        start_s: f64,
        /// Middle of the last hold, s.
        end_s: f64,
        /// The time of which the biases are, s.
        biases_at_s: f64,
    }
    decided "The drift of an axis is more than three times holds.bias_drift_sd_mps2."
    remedy "Let the sensor warm up, and record again. To use this recording, take the biases as those of the middle of the \
        recording, or set holds.bias_drift_sd_mps2 to the drift that is usual for this sensor."
    says {
        let amounts: Vec<String> = drift.iter().map(|value| significant(*value, 2)).collect();
        format!(
            "the accelerometer's bias drifts by {} {} from the first hold to the last, {deviations:.0} times what \
             holds.bias_drift_sd_mps2 expects. The biases are those at {biases_at_s:.0} s, and half the drift away at the \
             ends. Let the sensor warm up, or set that key to what is usual for it.",
            amounts.join(", "),
            unit.symbol()
        )
    };

    /// A sensor on a machine drifts through the recording. The estimates are a mean over it.
    SensorDrifts "sensor-drifts" Warning {
        sensor_kind: SensorKind,
        /// What drifts: its bias or its gains.
        of: Changed,
        /// By how much from begin to end, per axis: in the unit of the readings, or as a share.
        drift: Vector3<f64>,
        unit: ReadingUnit,
        /// p-value of no drift.
        p_value: f64,
    }
    decided "Residuals follow the time, or the readings times the time (p below 0.0001, from the scatter of blocks). The \
        result is doubtful and the drift larger than usual; or it is three times the usual one, and half of it is more than \
        three standard deviations of the parameter."
    remedy "Let the sensor and the machine warm up. Split the recording, and compare the halves."
    says {
        let share = *of == Changed::Gain;
        let amounts: Vec<String> =
            drift.iter().map(|value| significant(if share { 100.0 * value } else { *value }, 2)).collect();
        format!(
            "the {sensor_kind} drifts through the recording: its {of} {} from begin to end by {} {}. The estimates are \
             those of the middle. Or the log drifts against it. Let both warm up; split the recording, and compare the \
             halves.",
            if share { "change" } else { "changes" },
            amounts.join(", "),
            if share { "%" } else { unit.symbol() }
        )
    };
}

/// A sensor that changes within a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The sensor.
    pub sensor_kind: SensorKind,
    /// The property that changes.
    pub of: Changed,
    /// Another property whose change explains the residuals nearly as well.
    pub instead: Option<Changed>,
    /// When.
    pub course: Course,
    /// The difference of after and before, or of end and begin. For each axis, in the unit of [`Changed`].
    pub amount: Vector3<f64>,
    /// Its standard deviation, or zero for an axis that the data do not determine.
    pub sd: Vector3<f64>,
    /// p-value of the change, over all times at which it might occur.
    pub p_value: f64,
}

/// The property of a sensor that changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// Its bias, m/s² or rad/s.
    Bias,
    /// Its gains, as shares of themselves.
    Gain,
    /// The directions of its axes against those of the accelerometer, rad about each.
    Axes,
}

/// The course of a change in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// All at once.
    Step {
        /// Number of the last hold before it, from 0.
        before: usize,
        /// Number of the first hold after it. It equals `before` if the change lies within that hold.
        after: usize,
        /// About when, s.
        time_s: f64,
    },
    /// Proportional to time.
    Drift,
    /// There and back. The amount is that of the holds in between, against those before and after.
    Episode {
        /// Number of the first hold of it, from 0.
        first: usize,
        /// Number of the last hold of it, from 0.
        last: usize,
        /// About when it begins, s.
        start_s: f64,
        /// About when it ends, s.
        end_s: f64,
    },
}

impl Change {
    /// The largest amount of an axis, in its standard deviations.
    #[must_use]
    pub fn in_sd(&self) -> f64 {
        let ratio = |(amount, sd): (&f64, &f64)| if *sd > 0.0 { amount.abs() / sd } else { 0.0 };
        self.amount.iter().zip(&self.sd).map(ratio).fold(0.0, f64::max)
    }
}

impl Part for Change {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.sensor_kind.name().to_owned());
        match self.course {
            Course::Step { before, after, time_s } => {
                let holds = [("before_hold", before), ("after_hold", after)];
                parts.numbers.extend(holds.map(|(key, hold)| (key, hold as f64 + 1.0)));
                parts.numbers.push(("time_s", time_s));
            }
            Course::Drift => {}
            Course::Episode { first, last, start_s, end_s } => {
                let holds = [("first_hold", first), ("last_hold", last)];
                parts.numbers.extend(holds.map(|(key, hold)| (key, hold as f64 + 1.0)));
                parts.numbers.extend([("start_s", start_s), ("end_s", end_s)]);
            }
        }
        let amount = ["amount_x", "amount_y", "amount_z"].into_iter().zip(self.amount.iter().copied());
        parts.numbers.extend(amount);
        parts.numbers.extend([("deviations", self.in_sd()), ("p_value", self.p_value)]);
    }
}

impl Change {
    /// Which sensor changes, and when.
    #[must_use]
    pub fn headline(&self) -> String {
        let sensor = self.sensor_kind;
        match self.course {
            Course::Drift => format!("the {sensor} drifts through the recording"),
            Course::Episode { first, last, start_s, end_s } => format!(
                "the {sensor} changes at about {start_s:.0} s and back at about {end_s:.0} s (hold {} to hold {})",
                first + 1,
                last + 1
            ),
            Course::Step { before, after, time_s } => {
                let place = match before == after {
                    true => format!("in hold {}", after + 1),
                    false => format!("between hold {} and hold {}", before + 1, after + 1),
                };
                format!("the {sensor} changes at about {time_s:.0} s ({place})")
            }
        }
    }

    /// What changes, when, by how much, and what to do. `temperature_c`: lowest and highest of the recording, °C.
    fn in_words(&self, temperature_c: Option<(f64, f64)>) -> String {
        let reason = match (temperature_c, self.course) {
            (Some((low, high)), _) if high - low >= TEMPERATURE_RANGE_K => format!(
                "The temperature goes from {low:.1} to {high:.1} °C, and the model ignores it: set [temperature]. Or"
            ),
            (_, Course::Drift) => "Let the sensor warm up before the recording. Or".to_owned(),
            (_, Course::Episode { .. }) => "Was the sensor touched, warmed or clamped then, or did its supply change? If so, record again. \
                 To use this recording,"
                .to_owned(),
            (_, Course::Step { .. }) => format!(
                "Was the sensor knocked, did its mounting slip, did it saturate, was it still warming up? If so, record \
                 again. {}To use this recording,",
                if self.of == Changed::Bias { "Or its bias walks at random. " } else { "" }
            ),
        };
        let remedy = match self.course {
            Course::Drift => "calibrate the first and the second half separately",
            Course::Episode { .. } => "calibrate without the data in between",
            Course::Step { .. } => "calibrate the data before and after separately",
        };
        format!(
            "{}: {}. The estimates are a mean over the change, and their standard deviations do not include it. {reason} \
             {remedy} (holds.intervals_s), and compare.",
            self.headline(),
            self.amounts()
        )
    }

    /// What changes and by how much: `its bias steps by 3.1, −0.2, 0.4 mm/s², up to 12 standard deviations`.
    fn amounts(&self) -> String {
        let what = match self.instead {
            Some(instead) => format!("its {} (or its {instead})", self.of),
            None => format!("its {}", self.of),
        };
        let ending = if self.of == Changed::Bias { "s" } else { "" };
        let moves = match self.course {
            Course::Step { .. } => format!("step{ending} by"),
            Course::Drift => format!("change{ending} from beginning to end by"),
            Course::Episode { .. } => format!("differ{ending} in between by"),
        };
        let (scale, unit) = match (self.of, self.sensor_kind) {
            (Changed::Bias, SensorKind::Accelerometer) => (1e3, "mm/s²"),
            (Changed::Bias, SensorKind::Gyroscope) => (1_f64.to_degrees(), "°/s"),
            (Changed::Gain, _) => (100.0, "%"),
            (Changed::Axes, _) => (1_f64.to_degrees(), "°"),
        };
        let known: Vec<Axis> = Axis::ALL.into_iter().filter(|axis| self.sd[axis.index()] > 0.0).collect();
        // rounded to the first digit of their standard deviations
        let amount = |axis: &Axis| {
            let (amount, sd) = (scale * self.amount[axis.index()], scale * self.sd[axis.index()]);
            fixed(amount, (-sd.log10().floor()).clamp(0.0, 9.0) as usize)
        };
        let amounts: Vec<String> = known.iter().map(amount).collect();
        let on = match known.as_slice() {
            [_, _, _] => String::new(),
            some => format!(" on {}", listed(some, ", ")),
        };
        format!(
            "{what} {moves} {} {unit}{on}, up to {:.0} standard deviations",
            amounts.join(", "),
            self.in_sd()
        )
    }
}

neither!(Changed);

impl fmt::Display for Changed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bias => "bias",
            Self::Gain => "gains",
            Self::Axes => "axes (against the accelerometer's)",
        })
    }
}

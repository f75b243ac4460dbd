//! What is shown: on the page as events, in the terminal as lines.

use crate::estimate::{Estimate, Known};
use calibrant::report::pose_in_words;
use calibrant_core::diagnostic::Usability;
use calibrant_core::number_format::significant;
use nalgebra::Vector3;
use serde_json::{Value, json};

/// Most messages on the page.
const MESSAGES: usize = 50;

/// How a message is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Good,
    Info,
    Warning,
    Error,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A message.
#[derive(Debug, Clone)]
pub(crate) struct Message {
    pub(crate) at_s: f64,
    pub(crate) kind: Kind,
    pub(crate) text: String,
}

/// The state of the stream.
#[derive(Debug, Clone, Default)]
pub(crate) struct Live {
    pub(crate) phase: &'static str,
    pub(crate) word: String,
    pub(crate) reason: String,
    pub(crate) progress: Option<f64>,
    pub(crate) up: Option<[f64; 3]>,
    pub(crate) rate_hz: f64,
    pub(crate) age_s: f64,
    pub(crate) temperature_c: Option<f64>,
    pub(crate) seconds: f64,
    pub(crate) lines: u64,
    pub(crate) dropped: u64,
}

impl Live {
    pub(crate) fn json(&self) -> String {
        json!({
            "phase": self.phase,
            "word": self.word,
            "reason": self.reason,
            "progress": self.progress,
            "up": self.up,
            "rate_hz": rounded(self.rate_hz, 1),
            "age_s": rounded(self.age_s, 2),
            "temperature_c": self.temperature_c.map(|of| rounded(of, 1)),
            "seconds": rounded(self.seconds, 1),
            "lines": self.lines,
            "dropped": self.dropped,
        })
        .to_string()
    }
}

fn rounded(value: f64, digits: i32) -> f64 {
    let size = 10_f64.powi(digits);
    (value * size).round() / size
}

/// What the holds tell.
#[derive(Debug, Clone, Default)]
pub(crate) struct Told {
    pub(crate) sensor: String,
    pub(crate) path: String,
    pub(crate) estimate: Estimate,
    /// Number of holds by the gate.
    pub(crate) held: usize,
    pub(crate) now: Option<Vector3<f64>>,
    pub(crate) good_enough: bool,
    pub(crate) finished: bool,
    pub(crate) sentence: String,
    pub(crate) messages: Vec<Message>,
}

impl Told {
    pub(crate) fn say(&mut self, at_s: f64, kind: Kind, text: String) {
        if self.messages.len() == MESSAGES {
            self.messages.remove(0);
        }
        self.messages.push(Message { at_s, kind, text });
    }

    /// The next pose, in words: which way, and how far to turn.
    pub(crate) fn next_in_words(&self) -> Option<(Vector3<f64>, String, String)> {
        let next = self.estimate.next.as_ref()?;
        let turn = self.now.map_or_else(String::new, |now| turn(&now, &next.up));
        Some((next.up, words(&next.up), turn))
    }

    pub(crate) fn json(&self) -> String {
        let used = self.estimate.holds.iter().filter(|hold| hold.left_out.is_none()).count();
        // as much as the others, before there is a calibration
        let shares = self.estimate.next.as_ref().map_or(&[][..], |next| &next.shares);
        let mut shares = shares.iter().copied().chain(std::iter::repeat(1.0 / used.max(1) as f64));
        let holds: Vec<Value> = self
            .estimate
            .holds
            .iter()
            .enumerate()
            .map(|(number, hold)| {
                let share = if hold.left_out.is_none() { shares.next() } else { None };
                json!({
                    "number": number + 1,
                    "up": <[f64; 3]>::from(hold.up),
                    "seconds": rounded(hold.end_s - hold.start_s, 1),
                    "share": rounded(share.unwrap_or(0.0), 4),
                    "used": hold.left_out.is_none(),
                    "why": hold.left_out.as_deref().unwrap_or(""),
                })
            })
            .collect();
        let next = self
            .next_in_words()
            .map(|(up, words, turn)| json!({"up": <[f64; 3]>::from(up), "words": words, "turn": turn}));
        let table: Vec<Value> = self.estimate.parameters.iter().map(row).collect();
        let messages: Vec<Value> = self
            .messages
            .iter()
            .map(|of| json!({"at_s": rounded(of.at_s, 1), "kind": of.kind.name(), "text": of.text}))
            .collect();
        let verdict = self.estimate.usability.map(|of| match of {
            Usability::Ok => "ok",
            Usability::Doubtful => "doubtful",
            Usability::Bad => "bad",
        });
        json!({
            "sensor": self.sensor,
            "path": self.path,
            "good_enough": self.good_enough,
            "finished": self.finished,
            "sentence": self.sentence,
            "verdict": verdict,
            "held": self.held,
            "holds": holds,
            "next": next,
            "table": table,
            "messages": messages,
        })
        .to_string()
    }
}

/// Units as people read them, with the factor on SI.
pub(crate) fn shown_unit(unit: &'static str) -> (&'static str, f64) {
    match unit {
        "m/s²" => ("mm/s²", 1e3),
        "rad/s" => ("mrad/s", 1e3),
        "1" => ("10⁻³", 1e3),
        // as datasheets state it
        "(rad/s)/(m/s²)" => ("(°/s)/g", 9.806_65_f64.to_degrees()),
        other => (other, 1.0),
    }
}

fn row(known: &Known) -> Value {
    let (unit, factor) = shown_unit(known.unit);
    let two = |value: f64| significant(factor * value, 2);
    let ratio = known.ratio();
    json!({
        "name": known.name,
        "unit": unit,
        "value": significant(factor * known.value, 4),
        "sd": two(known.sd),
        "goal": known.goal.map(two),
        "after": known.after.map(two),
        "reached": ratio.map(|ratio| ratio <= 1.0),
        "ratio": ratio.map(|ratio| rounded(ratio, 3)),
    })
}

/// A direction in words: a face, an edge or a corner where it is one.
fn words(up: &Vector3<f64>) -> String {
    let parts: Vec<(usize, f64)> =
        up.iter().copied().enumerate().filter(|(_, part)| part.abs() > 0.1).collect();
    let even = parts.iter().all(|(_, part)| (part.abs() - parts[0].1.abs()).abs() < 1e-6);
    let name = |(axis, part): &(usize, f64)| {
        format!("{}{}", if *part < 0.0 { "−" } else { "" }, ["x", "y", "z"][*axis])
    };
    match parts.as_slice() {
        [one] if one.1 > 0.0 => format!("{} up", name(one)),
        [one] => format!("{} down", ["x", "y", "z"][one.0]),
        [one, two] if even => format!("the edge between {} and {} up", name(one), name(two)),
        [one, two, three] if even => {
            format!("the corner of {}, {} and {} up", name(one), name(two), name(three))
        }
        _ => pose_in_words(up),
    }
}

/// How to turn the sensor so that another direction is up.
fn turn(now: &Vector3<f64>, next: &Vector3<f64>) -> String {
    let angle = now.angle(next).to_degrees();
    if angle < 5.0 {
        return "as it lies".to_owned();
    }
    let axis = now.cross(next);
    let main = axis.iamax();
    if axis[main].abs() > 0.8 * axis.norm() && axis.norm() > 1e-3 {
        return format!("turn it by {angle:.0}° about {}", ["x", "y", "z"][main]);
    }
    format!("turn it by {angle:.0}°")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_edges_and_corners_have_words() {
        assert_eq!(words(&-Vector3::y()), "y down");
        assert_eq!(words(&Vector3::new(1.0, -1.0, 0.0).normalize()), "the edge between x and −y up");
        assert_eq!(words(&Vector3::new(-1.0, -1.0, 1.0).normalize()), "the corner of −x, −y and z up");
    }

    #[test]
    fn a_turn_names_its_axis_where_there_is_one() {
        assert_eq!(turn(&Vector3::z(), &Vector3::x()), "turn it by 90° about y");
        assert_eq!(turn(&Vector3::z(), &Vector3::z()), "as it lies");
        assert_eq!(turn(&Vector3::z(), &-Vector3::z()), "turn it by 180°");
    }
}

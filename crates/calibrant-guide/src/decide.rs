//! What follows from a decision of the gate, and from an estimate.

use crate::advice::{faces, is_on_faces_alone};
use crate::decision::Decision;
use crate::estimate::{Answer, Estimate, KnownHold};
use crate::run::Run;
use crate::shown::{Kind, shown_unit};
use calibrant_core::diagnostic::Usability;
use calibrant_core::error::Result;
use calibrant_core::number_format::{counted, significant};
use calibrant_core::sensor::{Axis, ReadingUnit};
use nalgebra::Vector3;
use serde_json::json;

/// A pose within this angle of one that was held is known, cosine.
const KNOWN: f64 = 0.985;
/// At the end of a hold there is another estimate if the hold is longer than at the first one by this factor.
const LONGER: f64 = 1.5;
/// If a doubt is left after this many holds with all goals reached, more holds do not remove it.
const ENOUGH: usize = 6;
/// A known pose that improves the result by less than this share is said to.
const LITTLE: f64 = 0.02;

impl Run<'_> {
    pub(crate) fn decide(&mut self, decision: Decision) -> Result<()> {
        let one = |value: f64| format!("{value:.1}");
        match decision {
            Decision::Held { start_s, seconds, mean } => {
                let mean = Vector3::from(mean);
                let up = self.force.up(&mean);
                let is_near = |held: &Vector3<f64>| {
                    self.force.up(held).zip(up).is_some_and(|(held, up)| held.dot(&up) > KNOWN)
                };
                let is_known = self.held.iter().any(|(.., held)| is_near(held));
                self.held.push((start_s, start_s + seconds, mean));
                self.ratio_before = if is_known { self.told.estimate.worst_ratio() } else { None };
                self.say(Kind::Good, format!("Got it: {} s.", one(seconds)))?;
                if self.held.len() == 1 && self.units[0] != ReadingUnit::Counts && up.is_none() {
                    let text = format!(
                        "At rest it shows {} m/s², and gravity is 9.8: is the unit right that its columns state?",
                        significant(mean.norm(), 2)
                    );
                    self.say(Kind::Warning, text)?;
                }
                self.question(true)?;
            }
            Decision::Ended { start_s, end_s } => {
                let Some(last) = self.held.last_mut().filter(|last| last.0 == start_s) else { return Ok(()) };
                let was_s = last.1 - last.0;
                last.1 = end_s;
                // what is hardly longer tells hardly more
                if end_s - last.0 > LONGER * was_s {
                    self.question(false)?;
                }
            }
            Decision::Cut => self.say(Kind::Info, "A knock or a gap was cut out.".to_owned())?,
            Decision::Short { seconds, needed_s } => {
                let text =
                    format!("Too short: {} s of {} s. Hold it a little longer.", one(seconds), one(needed_s));
                self.say(Kind::Warning, text)?;
            }
            Decision::Slides { by } => {
                let unit = if self.units[0] == ReadingUnit::Counts { "counts" } else { "m/s²" };
                self.say(Kind::Warning, format!("It slides, by {} {unit} within the hold: put it down, or lean it on something. What is still counts on.", significant(by, 2)))?;
            }
            Decision::Clips { axis } => {
                self.put_off();
                self.say(
                    Kind::Error,
                    format!(
                        "Refused: {} is at the end of its range. Take another pose, or a larger range.",
                        Axis::ALL[axis % 3]
                    ),
                )?;
            }
            Decision::Fast { axis } => {
                self.say(
                    Kind::Warning,
                    format!(
                        "Turned too fast about {}: that rotation may not count. Turn more slowly.",
                        Axis::ALL[axis % 3]
                    ),
                )?;
            }
            Decision::Gap { seconds } => {
                self.say(Kind::Warning, format!("Samples are missing, for {} s.", significant(seconds, 2)))?;
            }
        }
        Ok(())
    }

    /// A hold in none of the known directions does not count.
    fn says_if_on_no_face(&mut self, estimate: &Estimate) -> Result<()> {
        let Some((start_s, end_s, _)) = self.held.last().copied() else { return Ok(()) };
        let counts = |hold: &KnownHold| hold.start_s < end_s && hold.end_s > start_s;
        let is_told = estimate.missing.is_some() || !estimate.of_new_hold;
        if is_told || faces(&self.options.experiment).is_none() || estimate.holds.iter().any(counts) {
            return Ok(());
        }
        self.say(Kind::Warning, "It is on no face, by more than 20°: it does not count.".to_owned())
    }

    pub(crate) fn answer(&mut self, answer: Answer) -> Result<()> {
        match answer {
            Answer::First(number, _, _) if number < self.asked => Ok(()),
            Answer::First(_, parameters, took) => {
                let (took_ms, holds) = (took.as_millis() as u64, self.held.len());
                self.told.estimate.parameters = parameters;
                self.show_result();
                self.log.event(
                    &json!({"at_s": self.last_s, "kind": "estimate", "holds": holds, "took_ms": took_ms}),
                )
            }
            Answer::Whole(estimate) => self.whole(*estimate),
        }
    }

    fn whole(&mut self, estimate: Estimate) -> Result<()> {
        // an older answer knows nothing of what was held, or taken back, since
        if estimate.number < self.asked {
            return Ok(());
        }
        self.waits_for_answer = false;
        let holds_before = self.told.estimate.holds.len();
        self.refused(&estimate)?;
        self.says_if_on_no_face(&estimate)?;
        if let (Some(before), Some(now)) = (self.ratio_before.take(), estimate.worst_ratio()) {
            let gain = 1.0 - now / before;
            if gain < LITTLE {
                self.say(
                    Kind::Info,
                    format!("Known: this pose improves the result by {:.1} % only.", 100.0 * gain.max(0.0)),
                )?;
            }
        }
        let is_new = estimate.holds.len() > holds_before;
        let reaches = estimate.reaches_all();
        self.reached = match (reaches, is_new) {
            (false, _) => 0,
            (true, true) => self.reached + 1,
            (true, false) => self.reached.max(1),
        };
        self.folds_agree = estimate.folds_agree.or(self.folds_agree.filter(|_| reaches));
        // each face once is what that procedure asks for; otherwise a second hold confirms, and folds, which faces do not have, do
        let experiment = &self.options.experiment;
        let folds_agree = faces(experiment).is_some() || self.folds_agree == Some(true);
        let is_confirmed = reaches && is_on_faces_alone(experiment) || self.reached >= 2 && folds_agree;
        let is_good = is_confirmed && estimate.usability == Some(Usability::Ok);
        self.advice.give(estimate.next.as_ref().map(|next| next.up));
        self.force.calibrated = estimate.accelerometer.or(self.force.calibrated);
        self.told.now = self.up();
        let was_good = self.told.good_enough;
        let first_good = is_good && !was_good;
        self.told.good_enough = is_good;
        self.told.sentence = self.sentence(&estimate, reaches);
        self.told.estimate = estimate;
        if was_good && !is_good {
            let text = self.told.sentence.clone();
            self.say(Kind::Warning, format!("No longer good enough: {text}"))?;
        }
        // more holds do not mend what is doubtful for another reason
        let is_enough = reaches && self.reached >= ENOUGH;
        self.finish |= is_enough && self.options.stop_when_good;
        if first_good {
            let text = self.told.sentence.clone();
            self.say(Kind::Good, text)?;
            self.finish |= self.options.stop_when_good;
        }
        if self.told.estimate.of_new_hold {
            self.terminal.table(&self.told);
        }
        self.show_result();
        Ok(())
    }

    /// Says which holds this calibration leaves out that the one before used.
    pub(crate) fn refused(&mut self, estimate: &Estimate) -> Result<()> {
        let before = &self.told.estimate.holds;
        let was_out = |start_s: f64| {
            before.iter().any(|hold| hold.left_out.is_some() && (hold.start_s - start_s).abs() < 0.5)
        };
        let new: Vec<(usize, String)> = estimate
            .holds
            .iter()
            .enumerate()
            .filter_map(|(number, hold)| {
                let why = hold.left_out.clone()?;
                (!was_out(hold.start_s)).then_some((number, why))
            })
            .collect();
        for (number, why) in new {
            self.put_off.push(estimate.holds[number].up);
            self.say(
                Kind::Warning,
                format!("Hold {} does not count: {why}. A magnet, vibration, or a slip?", number + 1),
            )?;
        }
        Ok(())
    }

    pub(crate) fn sentence(&self, estimate: &Estimate, reaches: bool) -> String {
        // counts whose gain nobody knows do not show a face at first
        let are_shown = estimate.missing.is_none() || estimate.holds.len() == self.held.len();
        if let Some((held, all)) = estimate.faces.filter(|(held, all)| are_shown && held < all) {
            return format!("{held} of {all} faces so far.");
        }
        if let Some(missing) = &estimate.missing {
            return format!("{} so far: {missing}.", counted(self.held.len(), "hold"));
        }
        let gain = estimate.next.as_ref().and_then(|next| next.three_gain);
        let more =
            gain.map_or_else(String::new, |gain| format!("; 3 more holds would gain {:.0} %", 100.0 * gain));
        let usual = self.said_of_goals;
        if self.told.good_enough {
            return format!("Good enough{more}.{usual}");
        }
        if reaches {
            let why = estimate.warnings.first().cloned();
            let folds = (self.folds_agree == Some(false))
                .then(|| "parts of the recording disagree by more than they should".to_owned());
            return match folds.or(why) {
                Some(why) if self.reached >= ENOUGH => {
                    format!("More holds change little. Finish, or look into this: {why}")
                }
                Some(why) => format!("All goals are reached, but: {why}"),
                None => format!("All goals are reached; one more hold confirms it.{usual}"),
            };
        }
        let worst = estimate.parameters.iter().filter_map(|of| Some((of, of.ratio()?)));
        match worst.max_by(|one, other| one.1.total_cmp(&other.1)) {
            Some((of, _)) if of.goal.is_some_and(|goal| of.floor > goal) => format!(
                "No hold brings {} below {} {}: {}",
                of.name,
                significant(shown_unit(of.unit).1 * of.floor, 2),
                shown_unit(of.unit).0,
                if of.floor_is_of_faces {
                    "the faces are not known to be more square. Measure the box, and give holds.face_sd_deg."
                } else {
                    "gravity is not known better. Give holds.gravity_mps2, or your latitude and height."
                }
            ),
            Some((of, ratio)) if is_on_faces_alone(&self.options.experiment) => format!(
                "{} is {} times its goal, and a face that is held again tells little more. Measure how square the box is (holds.face_sd_deg), or add directions.",
                of.name,
                significant(ratio, 2)
            ),
            Some((of, ratio)) => {
                format!("{} is {} times its goal{more}.{usual}", of.name, significant(ratio, 2))
            }
            None => "Go on.".to_owned(),
        }
    }
}

//! The state in a word, with its reason.

use crate::gate::Phase;
use crate::run::Run;

/// Nothing came for so long, s.
const SILENT_S: f64 = 1.0;

impl Run<'_> {
    /// The state as it is now.
    pub(crate) fn picture(&mut self) {
        let age_s = self.came.elapsed().as_secs_f64();
        let up = self.up();
        let is_unfit = self.is_unfit();
        let live = &mut self.live;
        live.age_s = age_s;
        live.rate_hz = self.rate.hz;
        live.seconds = self.last_s - self.first_s.unwrap_or(self.last_s);
        live.up = up.map(Into::into);
        let is_held = self.gate.phase == Phase::Held;
        live.progress = self
            .gate
            .progress()
            .map(|(seconds, needed)| if is_held { 1.0 } else { (seconds / needed).min(1.0) });
        let next =
            self.told.next_in_words().map_or_else(String::new, |(_, words, turn)| match turn.as_str() {
                "" => format!("Next: {words}."),
                turn => format!("Next: {words}; {turn}."),
            });
        let (phase, word, reason) = if let Some(why) = &self.lost {
            ("silent", "The board is gone", format!("{why}; it is tried again"))
        } else if age_s > SILENT_S {
            (
                "silent",
                "No data",
                format!("nothing came for {age_s:.0} s: is the board plugged in, and does it send?"),
            )
        } else if self.lines.is_noise {
            (
                "silent",
                "No text",
                "what arrives is no text: is the baud rate that of the board (115200 is usual)?".to_owned(),
            )
        } else if let Some(problem) = &self.problem {
            ("silent", "Not understood", problem.clone())
        } else if let Some(why) = self.unfit.why.filter(|_| is_unfit) {
            ("silent", "Not understood", format!("lines come, but none is recorded: of the last, {why}"))
        } else if !self.stream.is_known() {
            ("waiting", "Waiting", "the first samples are awaited".to_owned())
        } else {
            match self.gate.phase {
                Phase::Waiting => ("waiting", "Waiting", String::new()),
                Phase::Moving => (
                    "moving",
                    "Moving",
                    match (next.as_str(), self.gate.why().as_str()) {
                        (_, "") => next,
                        ("", why) => format!("hold still: {why}."),
                        (next, why) => format!("{next} Then hold still: {why}."),
                    },
                ),
                Phase::Settling => ("settling", "Settling", "nearly still".to_owned()),
                Phase::Holding => (
                    "holding",
                    "Hold still",
                    self.gate.progress().map_or_else(String::new, |(seconds, needed)| {
                        format!("{seconds:.1} of {needed:.1} s")
                    }),
                ),
                // the pose that was advised before is the one that it has
                Phase::Held if self.waits_for_answer => ("held", "Got it", "calibrating".to_owned()),
                Phase::Held => ("held", "Got it", next),
                Phase::Refused => {
                    ("refused", "Refused", "an axis is at the end of its range: take another pose".to_owned())
                }
            }
        };
        live.phase = phase;
        live.word = word.to_owned();
        live.reason = reason;
        self.terminal.state(phase, word, &live.reason, live.seconds);
        let is_new = std::mem::replace(&mut self.shown_phase, phase) != phase;
        if self.options.listen.is_some() {
            self.board.live(live.json());
        }
        if is_new {
            // how far to turn is from where it lies now
            self.told.now = up.or(self.told.now);
            self.show_result();
        }
    }

    /// Do lines come of which none is a row?
    fn is_unfit(&self) -> bool {
        self.unfit.row_came.is_none_or(|came| came.elapsed().as_secs_f64() > SILENT_S)
    }
}

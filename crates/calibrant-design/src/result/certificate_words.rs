//! A design's certificate in words, for a reader who sees one for the first time.

use crate::{AT_BEST, Certificate, Design, DesignStatus};
use calibrant_core::information::Criterion;
use calibrant_core::number_format::{self, significant};

impl Design {
    /// How good the motion is, and how that was found, in one or two sentences.
    ///
    /// With a certificate: the value that no admissible motion can beat, and how close this one is. Without
    /// one: how many starts agree.
    #[must_use]
    pub fn statement(&self) -> String {
        if self.optimal.covariance.is_none() {
            return "This motion does not determine the parameters.".into();
        }
        let found = match &self.certificate {
            Some(certificate) => self.certified(certificate),
            None => self.uncertified(),
        };
        let mut found = format!("{found}{}", self.tilt());
        if let Some(goal) = self.gap_statement() {
            found = format!("{found} {goal}");
        }
        match self.status {
            DesignStatus::Converged => found,
            DesignStatus::IterationLimit | DesignStatus::Stalled => {
                format!("The search ended before it converged: a better motion may be near. {found}")
            }
            DesignStatus::Interrupted => {
                format!("The search was interrupted: a better motion may be near. {found}")
            }
        }
    }

    /// The gap that was asked for, and the gap that there is; `None` where none was asked for.
    #[must_use]
    pub fn gap_statement(&self) -> Option<String> {
        let goal = self.gap_goal?;
        let shown = |gap: f64| match self.criterion {
            Criterion::D(_) => format!("{} nats", significant(gap.max(0.0), 4)),
            _ if gap < 1.0 => percent(gap),
            _ => format!("{} %", significant(100.0 * gap, 4)),
        };
        let starts = format!("{} of {} starts", self.starts.len(), goal.most_starts);
        Some(match (&self.certificate, self.gap_is_reached()) {
            (Some(certificate), Some(true)) => format!(
                "The gap of {} that was asked for is proved: it is {}, reached after {starts}.",
                shown(goal.gap),
                shown(certificate.gap)
            ),
            (Some(certificate), _) => format!(
                "The gap of {} that was asked for is NOT reached: it is {} after {starts}. Either a better motion exists, or the bound is loose.",
                shown(goal.gap),
                shown(certificate.gap)
            ),
            (None, _) => {
                format!("The gap of {} that was asked for is NOT proved: there is no bound.", shown(goal.gap))
            }
        })
    }

    /// What the tilt of gravity gives to the biases.
    fn tilt(&self) -> String {
        let name = |k: usize| {
            let parameter = &self.parameters[k];
            format!("{} {}{}", parameter.name, significant(self.floor_sd[k], 4), unit(parameter.unit))
        };
        let named: Vec<String> =
            (0..self.floor_sd.len()).filter(|&k| self.floor_sd[k] > 0.0).map(name).collect();
        match named.as_slice() {
            [] => String::new(),
            all => format!(
                " Whatever the motion, the tilt and the magnitude of gravity alone give an sd of {}.",
                all.join(", ")
            ),
        }
    }

    fn certified(&self, certificate: &Certificate) -> String {
        let (letter, value) = (self.criterion.letter(), self.optimal.value - self.floor);
        let criterion = if let Criterion::D(_) = self.criterion {
            // a typical sd is exp(Φ_D / 2p)
            let sd = (certificate.gap / (2.0 * self.parameters.len() as f64)).exp_m1();
            let typical =
                if sd < 1.0 { percent(sd) } else { format!("a factor of {}", significant(1.0 + sd, 4)) };
            format!(
                "No admissible motion can bring criterion D below {}; this motion is within {} nats of the bound, {typical} in a typical standard deviation",
                significant(certificate.lower_bound, 4),
                significant(certificate.gap.max(0.0), 4),
            )
        } else {
            let gap = certificate.gap;
            let near =
                if gap < 1.0 { format!("within {} of the bound", percent(gap)) } else { times(1.0 + gap) };
            let above = if self.floor > 0.0 { ", above the share of the tilt," } else { "" };
            format!(
                "No admissible motion can bring criterion {letter}{above} below {}; this motion has {}, {near}",
                significant(certificate.lower_bound - self.floor, 4),
                significant(value, 4),
            )
        };
        format!("{criterion}. {}", self.certified_sd(certificate)).trim_end().to_owned()
    }

    /// A statement on all standard deviations, from the parameter that is furthest above its bound.
    fn certified_sd(&self, certificate: &Certificate) -> String {
        let sd = self.optimal.sd();
        let excess = |k: usize| sd[k] / certificate.sd_lower_bound[k] - 1.0;
        let worst = (0..sd.len())
            .filter(|&k| k < certificate.sd_lower_bound.len() && excess(k).is_finite())
            .max_by(|&one, &other| excess(one).total_cmp(&excess(other)));
        let Some(k) = worst else { return String::new() };
        let (name, least) = (&self.parameters[k].name, significant(certificate.sd_lower_bound[k], 4));
        let bound = format!(
            "No admissible motion can give {name} an sd below {least}{}",
            unit(self.parameters[k].unit)
        );
        if excess(k) < 5e-4 {
            return format!(
                "{bound}; this motion reaches that bound, and the bounds of all other parameters."
            );
        }
        let others = if sd.len() > 1 { ". All other parameters are closer to their bounds" } else { "" };
        let more = if excess(k) < 1.0 { percent(excess(k)) + " more" } else { times(1.0 + excess(k)) };
        format!("{bound}; this motion gives {}, {more}{others}.", significant(sd[k], 4))
    }

    fn uncertified(&self) -> String {
        match self.starts.len() {
            0 => "No lower bound was computed, so a better motion cannot be ruled out.".into(),
            starts => format!(
                "This is the best of {starts} starts, {} of which ended there (within {}). No lower bound was computed, so a better motion cannot be \
                 ruled out.",
                self.starts_at_best(),
                match self.criterion {
                    Criterion::D(_) => format!("{AT_BEST} nats"),
                    _ => format!("{} %", 100.0 * AT_BEST),
                }
            ),
        }
    }
}

/// A multiple: `3.4 times the bound`.
fn times(factor: f64) -> String {
    let number = match factor {
        f if f < 9.95 => format!("{f:.1}"),
        f if f < 999.5 => format!("{f:.0}"),
        f => significant(f, 4),
    };
    format!("{number} times the bound")
}

/// A relative difference below one, with two decimals at most: at least 0.01 %.
fn percent(relative: f64) -> String {
    let is_small = relative < 1e-3;
    if is_small { format!("{:.2} %", 100.0 * relative.max(1e-4)) } else { number_format::percent(relative) }
}

/// A unit behind a number; a pure number has none.
fn unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            (percent(0.0), percent(0.0032), percent(0.25)),
            ("0.01 %".into(), "0.32 %".into(), "25 %".into())
        );
        // a loose bound is a matter of factors: a reader cannot use 51489740 %
        assert_eq!(
            (times(2.04), times(14.2), times(514_898.4)),
            ("2.0 times the bound".into(), "14 times the bound".into(), "514898 times the bound".into())
        );
    }
}

//! Checks of options of a command, and of keys of an experiment.

use super::check::checks;
use super::parts::Phrase;

checks! {
    /// An option or a key is not used.
    SettingUnused "setting-unused" Warning {
        /// Its name, or their names.
        settings: Vec<String>,
        why: Phrase,
    }
    decided "What the option or the key is for is not in the experiment or in the files."
    remedy "Leave it away."
    says format!(
        "{} {} not used: {}",
        settings.join(" and "),
        if settings.len() == 1 { "is" } else { "are" },
        why.0
    );

    /// The number of threads cannot be set.
    ThreadsUnset "threads-unset" Note {
        why: Phrase,
    }
    decided "The system refuses it."
    remedy "Leave the option away."
    says format!("cannot set the number of threads: {}", why.0);

    /// The program was asked to end. It writes what it has first.
    Interrupted "interrupted" Note {}
    decided "A signal asks it to end, and what it does can keep what it has."
    remedy "Wait, or interrupt it again: then it ends at once."
    says "interrupted: what is finished, or the best so far, will be written; a second interruption ends at once";
}

impl SettingUnused {
    /// Options or keys that are not used, and why.
    #[must_use]
    pub fn of(settings: &[&str], why: &str) -> Self {
        Self { settings: settings.iter().map(ToString::to_string).collect(), why: Phrase(why.into()) }
    }
}

//! Checks of options of a command, and of keys of an experiment.

use super::check::checks;
use super::parts::Phrase;

checks! {
    /// An option or a key is not used.
    SettingUnused "setting-unused" Warning {
        /// Its name, or their names.
        settings: Vec<String>,
        /// Why.
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
}

impl SettingUnused {
    /// Options or keys that are not used, and why.
    #[must_use]
    pub fn of(settings: &[&str], why: &str) -> Self {
        Self { settings: settings.iter().map(ToString::to_string).collect(), why: Phrase(why.into()) }
    }
}

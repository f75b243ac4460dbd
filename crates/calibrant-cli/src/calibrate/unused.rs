//! Options that the experiment does not use.

use super::arguments::Arguments;
use crate::diagnostics::{tell, tell_in};
use calibrant::diagnostic::settings::SettingUnused;
use calibrant::io::Experiment;
use calibrant::session::Given;

/// Warns about options for another kind of experiment.
pub(super) fn warn(arguments: &Arguments, experiment: &Experiment) {
    if arguments.resume && (arguments.together || arguments.recordings.len() == 1) {
        tell(SettingUnused::of(&["--resume"], "it continues a batch of several recordings"));
    }
    let given = Given {
        motion: arguments.motion.is_some(),
        validate_motion: arguments.validate_motion.is_some(),
        gyroscope: !arguments.gyroscope.is_empty(),
        sections: arguments.sections.is_some(),
    };
    given.unused_by(experiment).iter().for_each(|found| tell_in(found, None));
}

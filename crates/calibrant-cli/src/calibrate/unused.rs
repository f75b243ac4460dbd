//! Options that the experiment does not use.

use super::arguments::Arguments;
use crate::diagnostics::tell;
use calibrant::diagnostic::settings::SettingUnused;
use calibrant::io::{Experiment, Plan};

/// Warns about options for another kind of experiment.
pub(super) fn warn(arguments: &Arguments, experiment: &Experiment) {
    let motion = arguments.motion.is_some();
    if arguments.resume && (arguments.together || arguments.recordings.len() == 1) {
        tell(SettingUnused::of(&["--resume"], "it continues a batch of several recordings"));
    }
    let on_machine = matches!(experiment.plan, Plan::Machine(_));
    if !on_machine && arguments.validate_motion.is_some() {
        tell(SettingUnused::of(&["--validate-motion"], "it is for a [machine] experiment"));
    }
    if on_machine && arguments.sections.is_some() {
        tell(SettingUnused::of(&["--sections"], "a [machine] experiment has no faces and turns"));
    }
    if experiment.imu.is_some() {
        if motion && !on_machine {
            tell(SettingUnused::of(
                &["--motion"],
                "an IMU is calibrated from holds and the rotations between them",
            ));
        }
        return;
    }
    if !arguments.gyroscope.is_empty() || (arguments.sections.is_some() && !on_machine) {
        tell(SettingUnused::of(&["--gyroscope", "--sections"], "they are for kind = \"imu\""));
    }
    if motion && matches!(experiment.plan, Plan::Holds(_)) {
        tell(SettingUnused::of(&["--motion"], "a [holds] experiment needs no motion"));
    }
}

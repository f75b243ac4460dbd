//! What is given for another kind of experiment.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::settings::SettingUnused;
use calibrant_core::error::TaskOption;
use calibrant_io::{Experiment, Plan};

/// Which of these are given beside an experiment and a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Given {
    /// The commanded motion, or the log of a machine.
    pub motion: bool,
    /// The log of the machine during the recording that validates.
    pub validate_motion: bool,
    /// A file of the gyroscope.
    pub gyroscope: bool,
    /// A list of faces and turns.
    pub sections: bool,
}

impl Given {
    /// What of it the experiment does not use, and why.
    #[must_use]
    pub fn unused_by(self, experiment: &Experiment) -> Vec<Diagnostic> {
        let (is_imu, on_machine) = (experiment.imu.is_some(), matches!(experiment.plan, Plan::Machine(_)));
        let on_holds = matches!(experiment.plan, Plan::Holds(_));
        let of_imu = "it is for kind = \"imu\"";
        let mut found = Vec::new();
        let mut unused = |is_unused: bool, option: TaskOption, why: &str| {
            if is_unused {
                found.push(SettingUnused::of(&[&option.to_string()], why).into());
            }
        };
        unused(
            self.validate_motion && !on_machine,
            TaskOption::ValidateMotion,
            "it is for a [machine] experiment",
        );
        unused(
            self.sections && on_machine,
            TaskOption::Sections,
            "a [machine] experiment has no faces and turns",
        );
        unused(self.sections && !is_imu && !on_machine, TaskOption::Sections, of_imu);
        unused(self.gyroscope && !is_imu, TaskOption::Gyroscope, of_imu);
        let of_holds = "an IMU is calibrated from holds and the rotations between them";
        unused(self.motion && is_imu && !on_machine, TaskOption::Motion, of_holds);
        unused(
            self.motion && on_holds && !is_imu,
            TaskOption::Motion,
            "a [holds] experiment needs no motion",
        );
        found
    }
}

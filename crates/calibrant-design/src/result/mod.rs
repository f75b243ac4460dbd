//! What a design gives: motions, covariances, the certificate, and the assessment of a motion of the user.

mod design;
mod motion_assessment;

pub use design::{AT_BEST, Certificate, Design, DesignStatus, Evaluation, GapGoal, StartOutcome};
pub use motion_assessment::{Assessment, OtherSetting, assess, evaluate};

//! Checks that a simulated recording fits into the budget.

use crate::budget;
use calibrant::budget::Budget;
use calibrant::io::HoldsPlan;
use calibrant::motion::JerkControlledMotion;
use calibrant::simulate::{TURN_S, TableStep};

pub(super) fn check_motion(motion: &JerkControlledMotion, rate_hz: f64) -> calibrant::Result<()> {
    let times = motion.times_s();
    check(times[times.len() - 1] - times[0], rate_hz, "lower motion.rate_hz, or shorten the motion")
}

pub(super) fn check_holds(plan: &HoldsPlan) -> calibrant::Result<()> {
    let duration_s = plan.poses as f64 * (plan.hold_s + TURN_S);
    check(duration_s, plan.rate_hz, "lower holds.poses, hold_s or rate_hz")
}

pub(super) fn check_table(steps: &[TableStep], rate_hz: f64) -> calibrant::Result<()> {
    let from_s = steps.iter().map(|step| step.start_s).fold(0.0, f64::min);
    let duration_s = steps.iter().map(|step| step.end_s).fold(0.0, f64::max) - from_s;
    let less = "a recording begins at 0 s: bring holds.intervals_s and gyroscope.turns closer together, or lower holds.rate_hz";
    check(duration_s, rate_hz, less)
}

pub(super) fn check(duration_s: f64, rate_hz: f64, less: &str) -> calibrant::Result<()> {
    let samples = duration_s * rate_hz;
    let what = format!("{samples:.1e} samples ({duration_s} s at {rate_hz} Hz)");
    budget::check(Budget::of_samples(samples), &what, less)
}

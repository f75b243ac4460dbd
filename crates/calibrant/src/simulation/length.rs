//! Checks that a simulated recording fits into the budget.

use calibrant_core::budget::Budget;
use calibrant_core::error::{Error, Result};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::simulate::{TURN_S, TableStep};
use calibrant_io::HoldsPlan;

pub(super) fn check_motion(motion: &JerkControlledMotion, rate_hz: f64, budget: Budget) -> Result<()> {
    let times = motion.times_s();
    check(times[times.len() - 1] - times[0], rate_hz, "lower motion.rate_hz, or shorten the motion", budget)
}

pub(super) fn check_holds(plan: &HoldsPlan, budget: Budget) -> Result<()> {
    let duration_s = plan.poses as f64 * (plan.hold_s + TURN_S);
    check(duration_s, plan.rate_hz, "lower holds.poses, hold_s or rate_hz", budget)
}

pub(super) fn check_table(steps: &[TableStep], rate_hz: f64, budget: Budget) -> Result<()> {
    let from_s = steps.iter().map(|step| step.start_s).fold(0.0, f64::min);
    let duration_s = steps.iter().map(|step| step.end_s).fold(0.0, f64::max) - from_s;
    let less = "a recording begins at 0 s: bring holds.intervals_s and gyroscope.turns closer together, or lower holds.rate_hz";
    check(duration_s, rate_hz, less, budget)
}

pub(super) fn check(duration_s: f64, rate_hz: f64, less: &str, budget: Budget) -> Result<()> {
    let samples = duration_s * rate_hz;
    let what = format!("{samples:.1e} samples ({duration_s} s at {rate_hz} Hz)");
    budget.check(Budget::of_samples(samples), &what, less).map_err(Error::Experiment)
}

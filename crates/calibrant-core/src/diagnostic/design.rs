//! Checks of the search for a motion or for poses, and of what it begins with.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::{counted, significant};

checks! {
    /// The time was over before the search converged.
    SearchOutOfTime "search-out-of-time" Warning {}
    decided "The time that was given ends before the best start converged."
    remedy "Give it more time."
    says "the time was over before the best start converged. The motion is the best so far, and a better one may be near \
        (give it more option `seconds`)";

    /// The search was interrupted. Its result is the best so far.
    SearchInterrupted "search-interrupted" Warning {
        /// Are poses searched for, not a motion?
        are_poses: bool,
    }
    decided "Somebody interrupted the program."
    remedy "Let it run to its end."
    says match are_poses {
        true => "the search was interrupted. The poses are the best so far, and better ones may be near",
        false => "the search was interrupted. The motion is the best so far, and a better one may be near",
    };

    /// The shape of links is not known. Capsules from joint to joint stand for them, and the machine may be wider.
    LinksWithoutShapes "links-without-shapes" Warning {
        /// The links; empty: all.
        links: Vec<String>,
    }
    decided "The URDF file has no shape of a link, or its mesh is not found or not read."
    remedy "Give the meshes (`packages` in [machine]), or capsules of the links (`capsules` in [machine.world])."
    says format!(
        "the shape of {} is not known: a capsule from joint to joint stands for each, and the machine may be wider. Give the meshes \
         (`packages` in [machine]) or capsules (`capsules` in [machine.world]), or watch the first run closely",
        if links.is_empty() { "the links".to_owned() } else { links.join(", ") }
    );

    /// A limit of a joint is wider than a file of the machine says.
    LimitWidened "limit-widened" Warning {
        /// The joint, its limits with their numbers, and the file's.
        of: Phrase,
    }
    decided "A position, speed, acceleration or jerk that [machine.limits] gives lies beyond that of the URDF file or of joint_limits.yaml, \
        or joint_limits.yaml beyond the URDF file."
    remedy "Compare both with the manual of the machine, and correct the wrong one before the trajectory is run."
    says format!(
        "{}. The trajectory may use all of it, and is run on a machine: compare both with its manual, and correct the wrong one",
        of.0
    );

    /// MoveIt plans more slowly than the limits of joint_limits.yaml allow, and so does the design.
    ScalingFactorsApplied "scaling-factors-applied" Note {
        /// Of speeds.
        velocity: f64,
        /// Of accelerations.
        acceleration: f64,
    }
    decided "joint_limits.yaml has `default_velocity_scaling_factor` or `default_acceleration_scaling_factor`."
    remedy "Where the machine may move faster, set the factors to 1."
    says format!(
        "the factors of joint_limits.yaml are applied, as MoveIt does: {} of each speed, {} of each acceleration. Where the machine may \
         move faster, set default_velocity_scaling_factor and default_acceleration_scaling_factor to 1",
        significant(*velocity, 3),
        significant(*acceleration, 3)
    );

    /// An SRDF file is of another machine, or of more than this one.
    SrdfOfAnother "srdf-of-another" Warning {
        /// What it names.
        why: Phrase,
    }
    decided "The SRDF file names another robot than the URDF file, or pairs of links that the URDF file has not."
    remedy "Give the SRDF file of this machine."
    says format!("the SRDF file {}: is it of this machine? A pair counts where both of its links are there by name", why.0);

    /// Nothing keeps the machine from itself.
    CollisionsUnknown "collisions-unknown" Warning {}
    decided "No shape of any link is known, and no capsules stand for them."
    remedy "Give the meshes (`packages` in [machine]), or capsules of the links (`capsules` in [machine.world])."
    says "nothing is known of the machine's links, so that nothing keeps it from itself and from its surroundings, but for the \
        sensor's body. Watch the first run closely, slowed down (option `slow`)";

    /// The search ended before it converged. A better motion may be near.
    SearchNotConverged "search-not-converged" Warning {
        /// The value of a sweep, where it is one.
        at: Option<Phrase>,
        /// The status.
        status: &'static str,
    }
    decided "The status of the design is not `converged`."
    remedy "Take more starts, or loosen very tight limits."
    says match at {
        Some(at) => {
            format!("{}: the search ended with the status \"{status}\"; a better motion may be near", at.0)
        }
        None => format!(
            "the search ended with the status \"{status}\". The motion is admissible, but a better one may be near (increase \
             option `starts`, or loosen very tight limits)"
        ),
    };

    /// A motion does not determine some parameters.
    MotionUndetermined "motion-undetermined" Warning {
        /// The motion, or its file.
        motion: Phrase,
        parameters: Vec<String>,
        /// Why.
        reason: Phrase,
        /// What to do.
        remedy: Phrase,
    }
    decided "The information of the motion is singular."
    remedy "Move the axes that the message names, or give a prior."
    says format!("{} leaves {} undetermined: {} ({})", motion.0, parameters.join(", "), reason.0, remedy.0);

    /// A given motion is not compared with the best one.
    MotionNotCompared "motion-not-compared" Warning {
        why: Phrase,
    }
    decided "The search for the best motion ends with an error."
    remedy "Read the error."
    says format!("the motion is not compared with the best one: {}", why.0);

    /// A sweep, a study or a batch was interrupted.
    SeriesInterrupted "series-interrupted" Warning {
        /// What it is: `sweep`.
        series: &'static str,
        /// What it consists of: `values`.
        items: &'static str,
        /// Items that are finished.
        finished: usize,
        /// All items.
        all: usize,
    }
    decided "Somebody interrupted the program."
    remedy "Let it run to its end. A batch continues with option `resume`."
    says format!("the {series} was interrupted: {finished} of {all} {items} are finished");

    /// Simulated sensors of a rehearsal were not calibrated. What it says is of the others.
    SensorsNotCalibrated "sensors-not-calibrated" Warning {
        /// How many.
        number: usize,
        /// All sensors.
        all: usize,
        /// The seed of the first, and why it was not calibrated.
        why: Phrase,
    }
    decided "The calibration of a simulated sensor ends with an error."
    remedy "Read the error. Simulate the sensor of this seed to look at its recording."
    says format!(
        "{number} of {all} simulated sensors {} not calibrated, and what is said is of the others. {}",
        if *number == 1 { "was" } else { "were" },
        why.0
    );

    /// A study compares no optimal motion.
    MotionNotDesigned "motion-not-designed" Note {
        /// Is it the motion with process noise, of `[study.noisy]`?
        is_noisy: bool,
        why: Phrase,
    }
    decided "Of the motion only the ends are known, or no motion is the best within the limits."
    remedy "Choose another trust, or complete the limits."
    says format!(
        "no motion{} was designed: {}",
        if *is_noisy { " with process noise ([study.noisy])" } else { "" },
        why.0
    );

    /// A given motion breaks limits that the optimal one keeps. The comparison is unfair.
    GivenBreaksLimits "given-breaks-limits" Note {
        /// The limits: `velocity of axis x`.
        limits: Vec<String>,
    }
    decided "The use of each limit is computed."
    remedy "Compare with a motion that keeps the limits."
    says format!("the given motion breaks limits that the optimal one keeps: {}", limits.join(", "));

    /// A value of a sweep has no design.
    SweepValueFailed "sweep-value-failed" Warning {
        /// The value.
        at: Phrase,
        why: Phrase,
    }
    decided "The search for its best motion ends with an error."
    remedy "Read the error."
    says format!("{}: {}", at.0, why.0);

    /// A value of a sweep is not a whole number of intervals. The nearest one is taken.
    SweepValueRounded "sweep-value-rounded" Note {
        /// The value that was asked for.
        asked: Phrase,
        /// The value that is taken.
        taken: Phrase,
        /// Its intervals.
        intervals: usize,
    }
    decided "The duration is no multiple of the interval."
    says format!(
        "{} is not a whole number of intervals: {}, {}, instead",
        asked.0,
        taken.0,
        counted(*intervals, "interval")
    );

    /// Two earlier calibrations are equal.
    CalibrationsEqual "calibrations-equal" Warning {
        /// The one.
        one: Phrase,
        /// The other.
        other: Phrase,
    }
    decided "Values and covariances are equal to the last digit."
    remedy "Name each calibration once."
    says format!(
        "{} and {} are equal to the last digit. If they are of one recording, its information counts twice. Name it once.",
        one.0,
        other.0
    );

    /// Two earlier calibrations differ by more than their uncertainty.
    CalibrationsApart "calibrations-apart" Warning {
        /// The one.
        one: Phrase,
        /// The other.
        other: Phrase,
        /// χ² of the difference.
        chi2: f64,
        /// Number of parameters.
        parameters: usize,
    }
    decided "χ² of the difference exceeds the number of parameters by 6 standard deviations."
    remedy "Name calibrations of one sensor only."
    says format!(
        "{} and {} differ by more than their uncertainty (χ² {} for {parameters} parameters). Are they of the same sensor?",
        one.0,
        other.0,
        significant(*chi2, 3)
    );

    /// A limit counts from rest at the start, so the motion starts at rest.
    RestAssumed "rest-assumed" Note {
        /// The limit.
        limit: &'static str,
    }
    decided "A limit of velocity or displacement is given, and `rest` in [limits] is not."
    remedy "Give `rest`: \"both\" ends the motion at rest, too."
    says format!(
        "the limit of {limit} counts from rest at the start, so the motion starts at rest. It may end in motion: rest = \
         \"both\" in [limits] ends it at rest, too; rest = \"start\" silences this note"
    );
}

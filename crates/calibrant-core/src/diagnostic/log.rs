//! Checks of a log of a machine's motion.

use super::check::checks;
use crate::number_format::{counted, short, significant};

checks! {
    /// The angles of a log jump by a full turn, as those of an encoder that counts one turn. They are continued.
    AnglesContinued "angles-continued" Note {
        /// The joints.
        joints: Vec<String>,
        /// Number of jumps.
        jumps: usize,
    }
    decided "All angles of a joint are within one turn, and two that follow each other are more than half a turn apart."
    says format!(
        "the angles of {} jump by a full turn {}. They are continued",
        joints.join(", "),
        match jumps {
            1 => "once".to_owned(),
            jumps => format!("{jumps} times"),
        }
    );

    /// The quaternions of a log do not have the norm 1. They are normalised.
    QuaternionNorm "quaternion-norm" Note {
        /// The largest difference of a norm from 1.
        off: f64,
    }
    decided "A norm is more than 1 % from 1. More than 10 % is refused."
    remedy "Write the quaternions with more decimals."
    says format!("quaternions have norms that are up to {} % off 1. They are normalised", significant(100.0 * off, 2));

    /// Columns of a log hold an orientation, and their names do not say in which form. The usual one was taken.
    OrientationAssumed "orientation-assumed" Note {
        /// The columns.
        columns: Vec<String>,
        /// What they were taken as.
        form: String,
    }
    decided "Columns `rx`, `ry`, `rz` are taken as a rotation vector, as Universal Robots' controllers give it, and `q1` to `q4` (or `q0` to `q3`) as a quaternion with w first, as \
        ABB's give it."
    remedy "Write orientation_is in [machine.log.columns], and the note is gone."
    says format!(
        "the columns {} are taken as {form}. Are they? orientation_is = \"{form}\", or what they are, in [machine.log.columns]",
        columns.join(", ")
    );

    /// Rows of a log hold zeros, or no rotation at the origin, as a tracker's bridge writes them while the body is hidden. They are taken as missing.
    PosesBlank "poses-blank" Note {
        /// Number of rows.
        rows: usize,
        /// Their share of all.
        share: f64,
    }
    decided "A quaternion is 0, 0, 0, 0; or rows repeat no rotation at the origin, and the motion jumps there and back: it goes three times as far as \
        nine in ten of the other rows do."
    remedy "Log nothing, or NaN, while a body is not seen."
    says format!(
        "{} of the log ({} %) hold zeros, or no rotation at the origin: placeholders for a body that is hidden. They are taken as missing",
        counted(*rows, "row"),
        significant(100.0 * share, 2)
    );

    /// Rows of a log repeat the one before while the machine moves: the log holds its last values. They are left out.
    RowsHeld "rows-held" Note {
        /// Number of rows that are left out.
        rows: usize,
        /// Their share of all.
        share: f64,
    }
    decided "One row in a hundred is the same as the one before it, between changes of three steps of the values or more; \
        more than eight in a row if the motion then goes on with a jump."
    remedy "Log each sample once, with its own time, and nothing while a body is not seen."
    says format!(
        "{} of the log ({:.0} %) repeat the one before while the machine moves: the log holds its last values. They are \
         left out",
        counted(*rows, "row"),
        100.0 * share
    );

    /// Positions of a log that have no orientation beside them are smoother than the others: a program filled them in. They are left out.
    PositionsFilled "positions-filled" Note {
        /// Number of rows whose position is left out.
        rows: usize,
        /// Their share of all.
        share: f64,
    }
    decided "Between orientations that were not seen, the noise of the positions is less than half that of the others, by divided differences of the fourth \
        order; or there are too few to tell."
    remedy "Export the log without filled gaps."
    says format!(
        "{} of the log ({} %) have a position and no orientation, and no noise: a program filled them in where markers were lost. These positions are left out",
        counted(*rows, "row"),
        significant(100.0 * share, 2)
    );

    /// The body of a log moves faster than any machine or hand. Its positions may be in another unit.
    BodyTooFast "body-too-fast" Warning {
        /// The speed that one step in ten exceeds, m/s.
        speed_mps: f64,
    }
    decided "One step in ten between two poses is faster than 50 m/s. Millimetres that are read as metres are."
    remedy "If the positions are in mm, say so: position_unit = \"mm\" in [machine.log.columns], or in the columns' names (px_mm)."
    says format!(
        "by the log the body moves at {} m/s and more. Are its positions in mm? Then write position_unit = \"mm\" in \
         [machine.log.columns], or name the columns so (px_mm)",
        significant(*speed_mps, 2)
    );

    /// The log has positions that the machine's file does not allow.
    BeyondLimits "beyond-limits" Warning {
        /// The joint.
        joint: String,
        /// Its least position in the log.
        least: f64,
        /// Its largest.
        most: f64,
        /// Its lower limit.
        lower: f64,
        /// Its upper limit.
        upper: f64,
        /// Their unit.
        position_unit: &'static str,
    }
    decided "A position is beyond a limit of the URDF by more than a hundredth of the range, whatever number of full \
        turns is added."
    remedy "Check the unit of the column, the zero of the joint, and the limits in the URDF."
    says format!(
        "{joint} is logged from {} to {} {position_unit}, its limits in the URDF are {} to {} {position_unit}. Check the \
         unit of its column, and its zero",
        significant(*least, 3),
        significant(*most, 3),
        short(*lower),
        short(*upper)
    );
}

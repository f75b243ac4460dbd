//! The joints of a log in the order of a kinematic chain.

use super::file::ReferenceLogFile;
use super::format::ReferenceFormat;
use crate::text::decoding::{Checked, refuse};
use crate::text::similar_word::nearest;
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::log::{JointLog, ReferenceLog};
use std::path::Path;

impl ReferenceLogFile {
    /// The log of the joints of a chain, in its order. Other joints of the log are left out. The columns of RTDE,
    /// which have no names of joints, are those of the chain in their order.
    ///
    /// # Errors
    /// [`Error::Recording`] where the log holds poses, or lacks a joint: the message has the nearest name. Or the
    /// number of RTDE's columns is not that of the joints.
    ///
    /// # Examples
    /// ```
    /// use calibrant_recording::{ReferenceLogOptions, parse_reference_log};
    ///
    /// let text = b"t_s,elbow_rad,shoulder_rad\n0,1,2\n1,3,4\n";
    /// let file = parse_reference_log(text, &ReferenceLogOptions::default())?;
    /// let joints = file.joints_in_order(&["shoulder", "elbow"])?;
    /// assert_eq!(joints.row(1), [4.0, 3.0]);
    /// let missing = file.joints_in_order(&["sholder"]).expect_err("misspelt").to_string();
    /// assert!(missing.contains("is `shoulder` meant?"), "{missing}");
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn joints_in_order(&self, names: &[&str]) -> Result<JointLog> {
        let columns = self.columns_of(names).map_err(Error::Recording)?;
        let log = self.joints().ok_or_else(|| Error::recording(no_joints()))?;
        let width = log.names.len();
        let picked = |values: &[f64]| -> Vec<f64> {
            values.chunks_exact(width).flat_map(|row| columns.iter().map(|&column| row[column])).collect()
        };
        Ok(JointLog {
            names: names.iter().map(|name| (*name).to_owned()).collect(),
            times_s: log.times_s.clone(),
            positions: picked(&log.positions),
            velocities: log.velocities.as_deref().map(picked),
        })
    }

    /// The log of a machine: the joints of its chain in their order, or the poses of a body without a chain. Errors name the file at `path`.
    ///
    /// # Errors
    /// - [`Error::Recording`]: joints of the chain are missing.
    /// - [`Error::Experiment`]: a log of joints, or of positions alone, and no chain.
    pub fn of_machine(&self, chain: Option<&KinematicChain>, path: &Path) -> Result<ReferenceLog> {
        let unsuited = |message: &str, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::MachineUnsuited, message, help).in_file(path)))
        };
        match (chain, self.poses()) {
            (Some(chain), _) => {
                let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
                let joints = self.joints_in_order(&names).map_err(|error| error.in_recording(path))?;
                self.check_units(chain).map_err(|error| error.in_recording(path))?;
                Ok(ReferenceLog::Joints(joints))
            }
            (None, Some(poses)) if poses.world_from_body.iter().all(Option::is_none) => unsuited(
                "the log has positions without orientations, and [machine] names no machine",
                "log the orientation of the body, too; where these are joints, give urdf, base and tip in [machine]",
            ),
            (None, Some(poses)) => Ok(ReferenceLog::Poses(poses.clone())),
            (None, None) => unsuited(
                "the log is of joints, and [machine] names no machine",
                "give urdf, base and tip in [machine]",
            ),
        }
    }

    /// A joint that turns is logged in an angle, one that slides in a length.
    ///
    /// # Errors
    /// [`Error::Recording`] names the joint whose column says otherwise.
    pub(crate) fn check_units(&self, chain: &KinematicChain) -> Result<()> {
        let names = self.joints().map_or(&[][..], |log| &log.names);
        for (name, turns) in names.iter().zip(&self.turns) {
            let Some(joint) = chain.joints.iter().find(|joint| joint.name == *name) else { continue };
            let (kind, units) = match joint.kind.turns() {
                true => ("turns", "rad or deg"),
                false => ("slides", "m or mm"),
            };
            if turns.is_some_and(|turns| turns != joint.kind.turns()) {
                let message = format!("the joint `{name}` {kind}, and its column is not in {units}");
                let help = "correct the unit in the name of the column, or the type of the joint in the URDF";
                return Err(Error::recording(InputError::new(Refusal::UnitContradicted, message, help)));
            }
        }
        Ok(())
    }

    /// The column of each joint.
    fn columns_of(&self, names: &[&str]) -> Checked<Vec<usize>> {
        let log = self.joints().ok_or_else(no_joints)?;
        if self.format == ReferenceFormat::Rtde {
            if log.names.len() == names.len() {
                return Ok((0..names.len()).collect());
            }
            let message =
                format!("the log has {} joints, and the chain has {}", log.names.len(), names.len());
            let help = "RTDE does not name its joints, so each must be one of the chain";
            return refuse(Refusal::ColumnMissing, message, help);
        }
        let column = |name: &str| log.names.iter().position(|known| known == name);
        let missing: Vec<&str> = names.iter().copied().filter(|name| column(name).is_none()).collect();
        if missing.is_empty() {
            return Ok(names.iter().filter_map(|name| column(name)).collect());
        }
        let is_free = |known: &&str| !names.contains(known);
        let with_nearest =
            |name: &&str| match nearest(name, log.names.iter().map(String::as_str).filter(is_free)) {
                Some(near) => format!("`{name}` (is `{near}` meant?)"),
                None => format!("`{name}`"),
            };
        let listed: Vec<String> = missing.iter().map(with_nearest).collect();
        let joints = if missing.len() == 1 { "joint" } else { "joints" };
        let message = format!("the log lacks the {joints} {}", listed.join(", "));
        let help = format!("give them the names of the chain; the log has {}", quoted(&log.names, 20));
        refuse(Refusal::ColumnMissing, message, help)
    }
}

fn no_joints() -> InputError {
    InputError::new(
        Refusal::ColumnMissing,
        "the log holds poses, not positions of joints",
        "a log of joints has a header such as t_s,elbow_rad",
    )
}

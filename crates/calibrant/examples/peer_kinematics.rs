//! What the tip of a machine feels in given states, as CSV: `peer_kinematics URDF BASE TIP < STATES`.
//!
//! A row of the states has the positions of all joints, then their velocities, then their accelerations. A row of the answer has the specific
//! force, the rate and the angular acceleration, in the axes of the tip, at a gravity of 9.81 m/s² along −z of the base.
//! `peers/kinematics/compare.py` compares them with Pinocchio's and MuJoCo's.

use calibrant::io::Urdf;
use calibrant::machine::chain::{FrameMotion, JointState};
use nalgebra::Vector3;
use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [urdf, base, tip] = arguments.as_slice() else {
        return Err("usage: peer_kinematics URDF BASE TIP < STATES".into());
    };
    let chain = Urdf::read(Path::new(urdf))?.chain(Some(base), Some(tip))?.nominal();
    let at_rest = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.81));
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for line in std::io::stdin().lines() {
        let row: Vec<f64> = line?.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let n = chain.joints();
        if row.len() != 3 * n {
            return Err(format!("a row has {} numbers, not {}", row.len(), 3 * n).into());
        }
        let (positions, derivatives) = row.split_at(n);
        let (velocities, accelerations) = derivatives.split_at(n);
        let tip = chain.tip_motion(JointState { positions, velocities, accelerations }, &at_rest);
        let numbers = [tip.specific_force, tip.rate, tip.angular_acceleration];
        let words: Vec<String> =
            numbers.iter().flat_map(|of| of.iter()).map(|number| format!("{number:e}")).collect();
        writeln!(out, "{}", words.join(","))?;
    }
    Ok(())
}

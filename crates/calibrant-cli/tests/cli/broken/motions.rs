//! Tests of broken commanded motions: exit status 2, the line in the message.

use super::{CALIBRATE, bench};

/// The bytes of a motion and the message about it.
const CASES: &[(&[u8], &str)] = &[
    (b"", ": the file is empty"),
    (b"t_s,ax_mps2,ay_mps2,az_mps2\n", ": a motion needs at least two nodes, this one has 0"),
    (b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n", ": a motion needs at least two nodes, this one has 1"),
    (b"0,1,2,3\n1,2,3,4\n", ":1:1: there is no header, the first field is 0"),
    (b"t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n", ":1:5: column `ax` is not known"),
    (b"t_s,ax_mps2,ay_mps2\n0,1,2\n1,2,3\n", ":1: column az_mps2 is missing"),
    (b"t_s,ax_mps2\n0,1\n1,2\n", ":1: columns ay_mps2, az_mps2 are missing"),
    (b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,nan,3,4\n", ":3:3: \"nan\" for axis x is not a usable number"),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,2,1e300,4\n",
        ":3:5: \"1e300\" for axis y is not a usable number",
    ),
    (
        b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n0,2,3,4\n",
        ":3: node times must increase: 0.0 s comes after 0.0 s",
    ),
    (b"t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,2,3\n", ":3: 3 columns where the header has 4"),
    (b"t_s\0", ": this is binary data, not text"),
];

#[test]
fn every_broken_motion_is_refused_at_its_line() {
    let bench = bench();
    for (bytes, says) in CASES {
        bench.write("motion.csv", bytes);
        let says = format!("error: motion.csv{says}");
        bench.refuses(CALIBRATE, 2, &[&says]);
        bench.refuses("simulate experiment.toml --motion motion.csv -o result", 2, &[&says]);
        bench.refuses("study experiment.toml --motion motion.csv -o result", 2, &[&says]);
    }
}

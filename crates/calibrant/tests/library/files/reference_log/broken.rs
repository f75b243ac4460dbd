//! Tests of logs that cannot be used: every message word for word.

use super::in_unit;
use calibrant::io::{ReferenceLogOptions, TimeUnit, parse_reference_log};

#[test]
fn every_complaint_says_what_is_wrong_and_what_to_do() {
    let mut wrong = Vec::new();
    for (text, expected) in CASES {
        let error = parse_reference_log(text, &ReferenceLogOptions::default()).expect_err("refused");
        assert!(error.is_invalid_recording());
        if error.to_string() != *expected {
            wrong.push(format!("{:?}\n  {:?}", String::from_utf8_lossy(text), error.to_string()));
        }
    }
    assert!(wrong.is_empty(), "{} of {} say something else:\n{}", wrong.len(), CASES.len(), wrong.join("\n"));
}

#[test]
fn a_log_of_too_many_columns_is_refused_at_once() {
    let names: String = (0..100_000).map(|k| format!(",j{k}_rad")).collect();
    let text = format!("t_s{names}\n0{0}\n1{0}\n", ",0".repeat(100_000));
    let error = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect_err("too many");
    assert!(error.to_string().contains("the log has 100001 columns, more than 4096"), "{error}");
}

#[test]
fn a_unit_that_contradicts_the_file_is_refused() {
    for (text, unit, expected) in [
        (
            "t_s,a_rad\n0,1\n1,2\n",
            TimeUnit::Millisecond,
            "the times are in s, but their unit was given as ms (leave option `time_unit` away)",
        ),
        (
            "t,a_rad\n0,1\n1,2\n",
            TimeUnit::Sample,
            "a log of a motion has times, not numbers of samples (leave option `time_unit` away)",
        ),
    ] {
        let error = parse_reference_log(text.as_bytes(), &in_unit(unit)).expect_err("refused");
        assert_eq!(error.to_string(), expected);
    }
}

/// The content of a file, and the message about it.
const CASES: &[(&[u8], &str)] = &[
    (
        b"",
        "the file is empty (a log of a motion has a row for each sample, below a header such as t_s,elbow_rad or t_s,px_m,py_m,pz_m,qw,qx,qy,qz)",
    ),
    (
        b"# nothing\n\n",
        "the file has only comments (a log of a motion has a row for each sample, below a header such as t_s,elbow_rad or t_s,px_m,py_m,pz_m,qw,qx,qy,qz)",
    ),
    (
        b"t_s,a_rad\n",
        "line 1: there is no row of numbers (a log needs two rows with a time and a position at least)",
    ),
    (
        b"t_s,a_rad\n0,1\n",
        "line 2: there is only one row (a log needs two rows with a time and a position at least)",
    ),
    (
        b"t_s,a_rad\n0,nan\n1,nan\n2,\n",
        "the joint `a` has no position in any row (was it recorded? leave its column out)",
    ),
    (
        b"t_s,a_rad,b_rad\n0,1,nan\n1,1,nan\n",
        "the joint `b` has no position in any row (was it recorded? leave its column out)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,2,3\n2,3\n",
        "line 3: 3 columns where the header has 2 (numbers need a decimal point, not a comma; columns need one delimiter, and a name each: R writes row names without one (row.names = FALSE))",
    ),
    (
        b"t_s,a_rad\n0,1\n1\n2,3\n",
        "line 3: 1 columns where the header has 2 (was the line cut off, or written while the file was read?)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,left\n2,3\n",
        "line 3, column 3: \"left\" in column `a_rad` is not a number (numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,inf\n2,3\n",
        "line 3, column 3: \"inf\" in column `a_rad` is out of range (is the unit right? is the file damaged?)",
    ),
    (
        b"t_s,a_rad\n0,1\ninf,1\n2,3\n",
        "line 3, column 1: \"inf\" in column `t_s` is out of range (times are in seconds)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,1e15\n2,3\n",
        "line 3, column 3: \"1e15\" in column `a_rad` is out of range (is the unit right? is the file damaged?)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,2\n0.5,3\n",
        "line 4: time goes backwards, from 1.0 s to 0.5 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (b"t_s,a_rad\n5,1\n5,2\n5,3\n", "the time is 5.0 s in every row (did the clock stand still?)"),
    (
        b"t_s,a_rad\nnan,1\nnan,2\n3,3\n",
        "line 4: only one row has a time (a log needs two rows with a time and a position at least)",
    ),
    (
        b"t_s,a_rad,a_deg\n0,1,2\n1,2,3\n",
        "line 1: two columns hold the same: `a_rad` and `a_deg` (rename one of them in the file, or say which in [machine.log.columns])",
    ),
    (
        b"t_s,a_radps\n0,1\n1,2\n",
        "line 1: no column is known to be of a joint or of a pose; the columns are `t_s`, `a_radps` (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"a_rad,b_rad\n0,1\n1,2\n",
        "line 1: there is no column of times (name it t_s (or t_ms, t_us, t_ns), or say time = \"…\" in [machine.log.columns])",
    ),
    (
        b"time,a_rad\n0,1\n1,2\n",
        "the time column `time` has no unit: steps of 1 suggest ms (say option `time_unit` s, ms, us or ns (time_unit in [machine.log.columns]), or end its name in _s, _ms, _us or _ns)",
    ),
    (
        b"t_s,t_ms,a_rad\n0,1,1\n1,2,1\n",
        "line 1: two columns hold the time: `t_s` and `t_ms` (rename one of them in the file, or say which in [machine.log.columns])",
    ),
    (
        b"t_s,elbow\n0,1\n1,2\n",
        "line 1: no column is known to be of a joint or of a pose; the columns are `t_s`, `elbow` (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,2,3,4\n",
        "line 1: the columns are those of a recording of an IMU: there is no joint and no pose (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"timestamp target_q_0 target_q_1\n0 1 2\n1 2 3\n",
        "line 1: the log holds where the joints should have been (target_q), not where they were (record actual_q, too)",
    ),
    (
        b"timestamp actual_q_0 actual_q_2\n0 1 2\n1 2 3\n",
        "line 1: the column `actual_q_1` is missing (record actual_q with all of its joints)",
    ),
    (
        b"t_s,qw,qx,qy\n0,1,0,0\n1,1,0,0\n",
        "line 1: the orientation has no column for z (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"t_s,px_m,py_m,qw,qx,qy,qz\n0,1,2,1,0,0,0\n1,1,2,1,0,0,0\n",
        "line 1: the position has no column for z (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"t_s,qw,qx,qy,qz,qw\n0,1,0,0,0,1\n1,1,0,0,0,1\n",
        "line 1: two columns hold the same: `qw` and `qw` (rename one of them in the file, or say which in [machine.log.columns])",
    ),
    (
        b"t_s,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0.5,0,0\n",
        "line 3: the norm of the quaternion is 1.1180, not 1 (are its columns in the order of the format, w first or last? a body that was not seen is NaN)",
    ),
    (
        b"t_s,qw,qx,qy,qz\n0,1,0,0,0\n1,0,0,0,0\n",
        "line 3: only one row has a pose (a log needs two rows with a time and a position at least)",
    ),
    (
        b"t_s,px_m,py_m,pz_m\n0,nan,1,2\n1,1,nan,2\n",
        "line 3: no row has a pose: every value is NaN, or a placeholder (a log needs two rows with a time and a position at least)",
    ),
    (
        b"0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n2 1 2 3 0 0 0\n3 1 2 3 0 0 0 1\n",
        "line 3: 7 columns where the first row has 8 (was the line cut off, or written while the file was read?)",
    ),
    (
        b"0 1 2 3 0 0 0 1\n1 1 2 x 0 0 0 1\n",
        "line 2, column 7: \"x\" in column 4 is not a number (numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN)",
    ),
    (
        b"0 1 2 3 0 0 0 1\n",
        "line 1: there is only one row (a log needs two rows with a time and a position at least)",
    ),
    (
        b"0 1 2 3 0 0 0 9\n1 1 2 3 0 0 0 9\n",
        "line 1: the norm of the quaternion is 9.0000, not 1 (are its columns in the order of the format, w first or last? a body that was not seen is NaN)",
    ),
    (
        b"0 1 2 3 4 5 6 7 8 9 10 11\n0 1 2 3 4 5 6 7 8 9 10 11\n",
        "line 1: 12 columns without a header (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"0,1;2\n",
        "line 1: 2 columns without a header (name joints like t_s,elbow_rad,rail_m and poses like t_s,px_m,py_m,pz_m,qw,qx,qy,qz, or say which is which in [machine.log.columns] of an experiment file; without a header a trajectory is t x y z qx qy qz qw)",
    ),
    (
        b"1 2 3 4 5 6 7 inf\n1 2 3 4 5 6 7 8\n",
        "line 1, column 15: \"inf\" in column 8 is out of range (is the unit right? is the file damaged?)",
    ),
    (
        b"#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n20,1,2,3\n10,1,2,3\n",
        "line 3: time goes backwards, from 2e-8 s to 1e-8 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        b"t_s,a_rad\n0,1\n1,0\x002\n",
        "this is binary data, not text: NUL byte at offset 17 (export the data as text)",
    ),
    (
        b"t_s,a_rad\n0,\xff\n",
        "line 2: not UTF-8 text: byte 0xff at offset 12 (save it as UTF-8 (or plain ASCII))",
    ),
    (
        b"{\"a\": 1}",
        "line 1: this is JSON, not a recording (a recording is a table: a header such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        b"MATLAB 5.0 MAT-file, Platform: GLNXA64, Created on: Mon Jan  1 00:00:00 2024     \0\0\0\x01\0IM",
        "this is a binary file of MATLAB (MAT-file 5), which is not read (save its table as CSV: in MATLAB `writetable(T, 'log.csv')`; in Python `pandas.DataFrame(scipy.io.loadmat('FILE')['NAME'], columns=[…]).to_csv('log.csv', index=False)`)",
    ),
    (
        b"MATLAB 7.3 MAT-file, Platform: GLNXA64",
        "this is a binary file of MATLAB (MAT-file 7.3, HDF5), which is not read (save its table as CSV: in MATLAB `writetable(T, 'log.csv')`; in Python `pandas.DataFrame(h5py.File('FILE')['NAME'][()].T, columns=[…]).to_csv('log.csv', index=False)`)",
    ),
    (
        b"\x89HDF\r\n\x1a\n\0\0\0\0",
        "this is a binary file of MATLAB (MAT-file 7.3, HDF5), which is not read (save its table as CSV: in MATLAB `writetable(T, 'log.csv')`; in Python `pandas.DataFrame(h5py.File('FILE')['NAME'][()].T, columns=[…]).to_csv('log.csv', index=False)`)",
    ),
    (b"\xff\xfet\0", "the text is encoded in UTF-16 (save it as UTF-8 (or plain ASCII))"),
    (
        b"#ROSBAG V2.0\n",
        "the bag is damaged: it ends before any message (copy it again, or try `rosbag reindex FILE.bag`)",
    ),
    (
        b"\x89MCAP0\r\n\0\x01",
        "the bag was cut off: it ends at byte 10, without an end of its container, before any message of a motion (is it a whole copy? was the recorder stopped before it had written anything?)",
    ),
];

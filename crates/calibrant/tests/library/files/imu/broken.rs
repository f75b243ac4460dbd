//! Tests of files that cannot be used, and why: every message word for word.

use super::{refused, units};
use calibrant::io::{
    ColumnMapping, FileFormat, ImuReadOptions, ImuUnit, TimeUnit, parse_imu_pair, parse_imu_recording,
};

fn plain() -> ImuReadOptions {
    ImuReadOptions::default()
}

fn rate() -> ImuReadOptions {
    ImuReadOptions { rate_hz: Some(100.0), ..plain() }
}

fn mapped() -> ImuReadOptions {
    let names = ["1", "2", "3"].map(|number| format!("c{number}"));
    ImuReadOptions {
        columns: ColumnMapping { accelerometer: Some(names), ..ColumnMapping::default() },
        ..plain()
    }
}

fn format(format: FileFormat) -> ImuReadOptions {
    ImuReadOptions { format: Some(format), ..plain() }
}

fn counts() -> ImuReadOptions {
    units(ImuUnit::Counts, ImuUnit::Counts)
}

/// The text of a file, the options of its reading, and the message about it.
type Case = (&'static str, fn() -> ImuReadOptions, &'static str);

#[test]
fn every_complaint_says_what_is_wrong_and_what_to_do() {
    let mut wrong = Vec::new();
    for (text, options, expected) in CASES {
        let message = refused(text, &options());
        if message != *expected {
            wrong.push(format!("{text:?}\n  {message:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {} say something else:\n{}", wrong.len(), CASES.len(), wrong.join("\n"));
}

#[test]
fn what_is_no_text_is_named() {
    for (bytes, expected) in [
        (&b"t_s,ax\0"[..], "this is binary data, not text: NUL byte at offset 6 (export the data as text)"),
        (b"\xff\xfet\0_\0", "the text is encoded in UTF-16 (save it as UTF-8 (or plain ASCII))"),
        (
            b"t_s,ax\n\xff",
            "line 2: not UTF-8 text: byte 0xff at offset 7 (save it as UTF-8 (or plain ASCII))",
        ),
    ] {
        let error = parse_imu_recording(bytes, &plain()).expect_err("no text");
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn a_pair_says_which_of_its_files_is_at_fault() {
    for (accelerometer, gyroscope, options, expected) in PAIRS {
        let error =
            parse_imu_pair(accelerometer.as_bytes(), gyroscope.as_bytes(), &options()).expect_err(expected);
        assert_eq!(error.to_string(), *expected);
    }
}

/// Two files, the options of their reading, and the message about them.
type Pair = (&'static str, &'static str, fn() -> ImuReadOptions, &'static str);

/// The broken pairs of files.
const PAIRS: &[Pair] = &[
    (
        "0 1 2 3\n1 2 3 4\n",
        "",
        counts,
        "gyroscope: the file is empty (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        "0 1 2\n1 2 3\n",
        "0 1 2 3\n1 2 3 4\n",
        counts,
        "line 1: accelerometer: 3 columns where 4 are needed (without a header the columns are t x y z; where each row is the mean of a hold, say option `rows_are_holds`; or say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as rate_hz = 100, accelerometer = [\"1\", \"2\", \"3\"], accelerometer_unit = \"m/s²\")",
    ),
    (
        "0 1 2 3\n1 2 3 4\n",
        "0 1 2 3\n0.5 1 2 3\n0.4 2 3 4\n",
        counts,
        "line 3: gyroscope: time goes backwards, from 0.5 s to 0.4 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        "0 1 2 9.8\n1 2 1 9.8\n",
        "0 1 2 90\n1 2 1 80\n",
        plain,
        "accelerometer: the accelerometer's columns have no unit: magnitudes around 10.1 suggest m/s²; gyroscope: the gyroscope's columns have no unit: magnitudes up to 90 suggest deg/s \
         (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]); option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]))",
    ),
];

/// The broken files.
const CASES: &[Case] = &[
    (
        "",
        plain,
        "the file is empty (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        "// Update Rate: 100.0Hz\n// nothing\n",
        plain,
        "the file has only comments (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    (
        "sep=,\nDeviceTag:,Xsens DOT 1\n",
        plain,
        "there is no header with the names of the columns (a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample)",
    ),
    // nothing to read
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tMat[1][1]\tMat[2][1]\n1\t0.1\t0.2\n2\t0.1\t0.2\n",
        plain,
        "line 2: the file holds orientation only (`Mat[1][1]`, `Mat[2][1]`): no reading of a sensor (export accelerometer and gyroscope (Acc_X, …, Gyr_X, …): orientation is computed from them, and they do not follow from it)",
    ),
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tQuat_q0\tQuat_q1\n1\t0.1\t0.2\n",
        plain,
        "line 2: the file holds orientation only (`Quat_q0`, `Quat_q1`): no reading of a sensor (export accelerometer and gyroscope (Acc_X, …, Gyr_X, …): orientation is computed from them, and they do not follow from it)",
    ),
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tRoll\tPitch\tYaw\n1\t0.1\t0.2\t3\n",
        plain,
        "line 2: the file holds orientation only (`Roll`, `Pitch`, `Yaw`): no reading of a sensor (export accelerometer and gyroscope (Acc_X, …, Gyr_X, …): orientation is computed from them, and they do not follow from it)",
    ),
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tVelInc_X\tVelInc_Y\tVelInc_Z\n1\t0.1\t0.2\t3\n",
        plain,
        "line 2: the file holds increments only (`VelInc_X`, `VelInc_Y`, `VelInc_Z`), not readings (export accelerometer and gyroscope (Acc_X, …, Gyr_X, …))",
    ),
    (
        "t_s,a,b,c\n0,1,2,3\n",
        plain,
        "line 1: no column is known to be an accelerometer's or a gyroscope's; the columns are `t_s`, `a`, `b`, `c` (name them like t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, or say which is which in [columns] of an experiment file)",
    ),
    (
        "t_s,mag_x,mag_y,mag_z\n0,1,2,3\n",
        plain,
        "line 1: no column is known to be an accelerometer's or a gyroscope's; the columns are `t_s`, `mag_x`, `mag_y`, `mag_z` (name them like t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, or say which is which in [columns] of an experiment file)",
    ),
    (
        "0 1 2 3 4 5 6\n1 1 2 3 4 5 6\n",
        plain,
        "line 1: 7 columns without a header: nothing says what they hold (begin the file with a line like t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps; or say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as time = \"1\", time_unit = \"s\", accelerometer = [\"2\", \"3\", \"4\"], accelerometer_unit = \"m/s²\", gyroscope = [\"5\", \"6\", \"7\"], gyroscope_unit = \"rad/s\")",
    ),
    // gravity removed
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tFreeAcc_E\tFreeAcc_N\tFreeAcc_U\tGyr_X\tGyr_Y\tGyr_Z\n1\t0.1\t0.2\t3\t1\t2\t3\n",
        plain,
        "line 2: gravity has been removed from the acceleration (column `FreeAcc_E`): what the sensor read cannot be got back, and gravity is what calibrates it (export the accelerometer's own readings (Acc_X, Acc_Y, Acc_Z))",
    ),
    (
        "sep=,\nDeviceTag:,1\nPacketCounter,SampleTimeFine,FreeAcc_X,FreeAcc_Y,FreeAcc_Z\n1,1,0,0,0\n2,2,0,0,0\n",
        plain,
        "line 3: gravity has been removed from the acceleration (column `FreeAcc_X`): what the sensor read cannot be got back, and gravity is what calibrates it (export the accelerometer's own readings (Acc_X, Acc_Y, Acc_Z))",
    ),
    (
        "t_s,userAcceleration.x,userAcceleration.y,userAcceleration.z\n0,1,2,3\n",
        plain,
        "line 1: gravity has been removed from the acceleration (column `userAcceleration.x`): what the sensor read cannot be got back, and gravity is what calibrates it (export the accelerometer's own readings (Acc_X, Acc_Y, Acc_Z))",
    ),
    (
        "t_s,linear_acceleration_x_mps2,linear_acceleration_y_mps2,linear_acceleration_z_mps2\n0,0.1,0,0\n1,0,0.2,0\n2,0,0,0.3\n",
        plain,
        "gravity has been removed from the accelerometer: its magnitude is 0.2 m/s² half of the time or less (export the sensor's own readings; is it really an acceleration, in the unit that is stated?)",
    ),
    (
        "t_s,ax_g,ay_g,az_g\n0,0.01,0,0\n1,0,0.02,0\n2,0,0,0.03\n",
        plain,
        "gravity has been removed from the accelerometer: its magnitude is 0.02 g half of the time or less (export the sensor's own readings; is it really an acceleration, in the unit that is stated?)",
    ),
    // implausible units
    (
        "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,0,0\n1,0,1,0.01\n2,0.02,0,1\n",
        plain,
        "the accelerometer is said to be in m/s², but its magnitude is 1 most of the time: is it in g? (give the unit g; in a text a column's name may end in _g, or accelerometer_unit = \"g\" stands in [columns] beside the names of the columns)",
    ),
    (
        "t_s,ax_mps2,ay_mps2,az_mps2\n0,33000,32000,36000\n1,33001,32000,36000\n2,33000,32001,36000\n",
        plain,
        "the accelerometer is said to be in m/s², but its magnitude is 58400 half of the time or more: is it in mg, or are these counts? (correct the unit: accelerometer_unit = \"mg\" in [columns], or accelerometer_lsb_per_g for counts of a known sensitivity; for counts of an unknown one, see `calibrant init --list`)",
    ),
    // units that the user must give
    (
        "t_s,ax,ay,az\n0,0,0.1,9.8\n1,0,9.8,0.1\n2,9.8,0,0\n",
        plain,
        "the accelerometer's columns have no unit: magnitudes around 9.8 suggest m/s² (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]))",
    ),
    (
        "t_s,ax,ay,az\n0,0,0.1,1\n1,0,1,0.1\n2,1,0,0\n",
        plain,
        "the accelerometer's columns have no unit: magnitudes around 1 suggest g (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]))",
    ),
    (
        "t_s,ax,ay,az\n0,0,1,16384\n1,0,16384,1\n2,16384,0,0\n",
        plain,
        "the accelerometer's columns have no unit: magnitudes around 16400 suggest counts (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]; counts of a sensitivity, as 16384 LSB/g, are read in m/s²))",
    ),
    (
        "t_s,ax,ay,az\n0,0,1,4.2\n1,0,4.2,1\n2,4.2,0,0\n",
        plain,
        "the accelerometer's columns have no unit: magnitudes around 4.32 do not tell (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]))",
    ),
    (
        "t_s,gx,gy,gz\n0,0,1,360\n1,0,360,1.5\n2,0,0,0\n",
        plain,
        "the gyroscope's columns have no unit: magnitudes up to 360 suggest deg/s (say option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]))",
    ),
    (
        "t_s,gx,gy,gz\n0,0,1,3\n1,0,3,1.5\n2,0,0,0\n",
        plain,
        "the gyroscope's columns have no unit: magnitudes up to 3 may be rad/s, or deg/s of slow turns (say option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]))",
    ),
    (
        "time,gx_radps,gy_radps,gz_radps\n0,0,1,3\n10,0,3,1.5\n20,0,0,0\n",
        plain,
        "the time column `time` has no unit: steps of 10 suggest ms (say option `time_unit` s, ms, us or ns (time_unit in [columns]), or end its name in _s, _ms, _us or _ns)",
    ),
    (
        "time,gx_radps,gy_radps,gz_radps\n0,0,1,3\n0.3,0,3,1.5\n0.6,0,0,0\n",
        plain,
        "the time column `time` has no unit: steps of 0.3 suggest ms (say option `time_unit` s, ms, us or ns (time_unit in [columns]), or end its name in _s, _ms, _us or _ns)",
    ),
    (
        "timestamp,gx,gy,gz\n0,0,1,3\n10000000,0,3,1.5\n20000000,0,0,0\n",
        plain,
        "the gyroscope's columns have no unit: magnitudes up to 3 may be rad/s, or deg/s of slow turns; the time column `timestamp` has no unit: steps of 10000000 suggest ns (say option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]); option `time_unit` s, ms, us or ns (time_unit in [columns]), or end its name in _s, _ms, _us or _ns)",
    ),
    (
        "n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n0,1,2,3,0,0,9.8\n1,1,360,3,0,0,9.8\n",
        plain,
        "the accelerometer's columns have no unit: magnitudes around 9.8 suggest m/s²; the gyroscope's columns have no unit: magnitudes up to 360 suggest deg/s; the file has no sample times, and nothing in it says the sample rate (say option `accelerometer_unit` m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]); option `gyroscope_unit` rad/s, deg/s, mdps or counts (gyroscope_unit in [columns]); option `rate_hz`, or rate_hz in [columns]: the sample rate in Hz, as it was measured, or as it was set; then how well it is known, option `rate_sd_ppm`)",
    ),
    (
        "0 1 2 3\n1 2 3 4\n",
        plain,
        "line 1: imu_tk keeps each sensor in a file of its own, t x y z: this one does not say which it is (give the accelerometer's file as the recording, the gyroscope's with option `gyroscope`, and their units with option `accelerometer_unit` and option `gyroscope_unit`; or say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as time = \"1\", time_unit = \"s\", accelerometer = [\"2\", \"3\", \"4\"], accelerometer_unit = \"m/s²\")",
    ),
    (
        "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z\n1,1,1,2,3\n",
        plain,
        "line 1: the columns are those of an MT Manager and of a Movella DOT export, whose units differ (rad/s and 0.1 ms; deg/s and µs), and nothing above the header tells which it is (say option `format` mt-manager or movella-dot)",
    ),
    // a rate that the user must give
    (
        "// DeviceId: 1\nPacketCounter\tGyr_X\tGyr_Y\tGyr_Z\n1\t1\t2\t3\n2\t1\t2\t3\n",
        plain,
        "the file has no sample times, and nothing in it says the sample rate (say option `rate_hz`, or rate_hz in [columns]: the sample rate in Hz, as it was measured, or as it was set; then how well it is known, option `rate_sd_ppm`)",
    ),
    (
        "// DeviceId: 1\nPacketCounter\tSampleTimeFine\tGyr_X\tGyr_Y\tGyr_Z\n1\t\t1\t2\t3\n2\tNaN\t1\t2\t3\n",
        plain,
        "its sample times are missing, and nothing in it says the sample rate (say option `rate_hz`, or rate_hz in [columns]: the sample rate in Hz, as it was measured, or as it was set; then how well it is known, option `rate_sd_ppm`)",
    ),
    (
        "gx_radps,gy_radps,gz_radps\n0,1,2\n1,2,3\n",
        plain,
        "the file has no sample times, and nothing in it says the sample rate (say option `rate_hz`, or rate_hz in [columns]: the sample rate in Hz, as it was measured, or as it was set; then how well it is known, option `rate_sd_ppm`)",
    ),
    // contradictions
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tGyr_X\tGyr_Y\tGyr_Z\n1\t1\t2\t3\n2\t1\t2\t3\n",
        rate,
        "the file says `Update Rate` 40 Hz, but the rate was given as 100 Hz (leave option `rate_hz` away)",
    ),
    (
        "gx_radps,gy_radps,gz_radps\n0,1,2\n1,2,3\n",
        || ImuReadOptions { rate_hz: Some(f64::NAN), ..plain() },
        "a sample rate of NaN Hz makes no sense (give it in Hz)",
    ),
    (
        "t_s,ax_g,ay_g,az_g\n0,0,0,1\n1,0,1,0\n",
        || units(ImuUnit::MetrePerSecondSquared, ImuUnit::Counts),
        "line 1: the accelerometer's columns are in g, but the unit was given as m/s² (leave option `accelerometer_unit` (or option `unit`) away: the file decides (name the columns in [columns] to overrule it))",
    ),
    (
        "t_s,gx,gy,gz\n0,0,0,1\n1,0,1,0\n",
        || units(ImuUnit::Counts, ImuUnit::StandardGravity),
        "g is no unit of the gyroscope (say rad/s, deg/s, mdps or counts, also of a sensitivity (131 LSB/dps, 8.75 mdps/LSB))",
    ),
    (
        "t_s,gx_radps,gy_degps,gz_radps\n0,0,0,1\n1,0,1,0\n",
        plain,
        "line 1: the axes of the gyroscope have different units: `gx_radps` has rad/s, `gy_degps` has deg/s (all axes need the same)",
    ),
    (
        "t_s,gx,gy,gz_radps\n0,0,0,1\n1,0,1,0\n",
        plain,
        "line 1: the axes of the gyroscope have different units: `gx` has no stated unit, `gz_radps` has rad/s (all axes need the same)",
    ),
    (
        "t_ms,gx_radps,gy_radps,gz_radps\n0,0,0,1\n1,0,1,0\n",
        || ImuReadOptions { time_unit: Some(TimeUnit::Second), ..plain() },
        "line 1: column `t_ms` is in ms, but the time's unit was given as s (leave option `time_unit` away)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,0,0,1\n1,0,1,0\n",
        || format(FileFormat::Mcap),
        "the format was given as mcap, but this is text (leave option `format` away, and `format` in [columns]: the format is recognised by the content)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,0,0,1\n1,0,1,0\n",
        || format(FileFormat::ImuTk),
        "line 1: imu_tk's files have no header, and this one has (leave option `format` away, and `format` in [columns]: the format is recognised by the content)",
    ),
    (
        "0 1 2\n1 2 3\n",
        || format(FileFormat::ImuTk),
        "line 1: 3 columns where 4 are needed (without a header the columns are t x y z; where each row is the mean of a hold, say option `rows_are_holds`; or say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as rate_hz = 100, accelerometer = [\"1\", \"2\", \"3\"], accelerometer_unit = \"m/s²\")",
    ),
    // columns
    (
        "t_s,ax_mps2,az_mps2\n0,0,9.8\n1,0,9.8\n",
        plain,
        "line 1: the accelerometer has no column for axis y (three axes are needed; or leave its columns out altogether)",
    ),
    (
        "t_s,gx_radps\n0,0\n1,0\n",
        plain,
        "line 1: the gyroscope has no column for axis y, z (three axes are needed; or leave its columns out altogether)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps,wx_radps\n0,0,0,1,2\n1,0,1,0,3\n",
        plain,
        "line 1: two columns hold the gyroscope x: `gx_radps` and `wx_radps` (say which in [columns] of an experiment file)",
    ),
    (
        "t_s,time_ms,gx_radps,gy_radps,gz_radps\n0,0,0,0,1\n1,0,0,1,0\n",
        plain,
        "line 1: two columns hold the time: `t_s` and `time_ms` (say which in [columns] of an experiment file)",
    ),
    (
        "t_s,gx_radps,gy_radps,gx_radps\n0,1,2,3\n1,1,2,3\n",
        plain,
        "line 1: two columns hold the gyroscope x: `gx_radps` and `gx_radps` (rename one of them in the file)",
    ),
    (
        "t_s,c1,c2\n0,1,2\n",
        mapped,
        "line 1: [columns] names `c3`, which the file does not have; it has `t_s`, `c1`, `c2` (names count letter by letter, capitals too)",
    ),
    (
        "t_s,c1,c2,c3,c3\n0,1,2,3,3\n",
        mapped,
        "line 1: [columns] names `c3`, which the file has twice (rename one of them in the file)",
    ),
    // rows
    (
        "t_s,gx_radps,gy_radps,gz_radps\n",
        plain,
        "line 1: there is a header but no sample below it (a recording needs two samples at least)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n",
        plain,
        "line 2: only 1 usable sample of the gyroscope in 1 row (a recording needs two samples at least)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,NaN,2,3\n2,,2,3\n",
        plain,
        "line 4: only 1 usable sample of the gyroscope in 3 rows (a recording needs two samples at least; line 3: gyroscope: 2 samples with a missing or NaN value dropped (first here))",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,,2,3\n1,NaN,2,3\n",
        plain,
        "the columns of the gyroscope are empty (were they recorded, and exported?)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,1,2\n2,1,2,3\n",
        plain,
        "line 3: 3 columns where the header has 4 (was the line cut off, or written while the file was read?)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,1,2,3,4\n2,1,2,3\n",
        plain,
        "line 3: 5 columns where the header has 4 (numbers need a decimal point, not a comma; columns need one delimiter)",
    ),
    (
        "t_s;gx_radps;gy_radps;gz_radps\n0;1,500;2;3\n1;1;2;3\n",
        plain,
        "line 2, column 3: \"1,500\" in column `gx_radps` is not a number (numbers need a decimal point, not a comma)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,x\n1,1,2,3\n",
        plain,
        "line 2, column 7: \"x\" in column `gz_radps` is not a number (numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,inf\n1,1,2,3\n",
        plain,
        "line 2, column 7: \"inf\" in column `gz_radps` is out of range (is the unit right? is the file damaged?)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,1e13\n1,1,2,3\n",
        plain,
        "line 2, column 7: \"1e13\" in column `gz_radps` is out of range (is the unit right? is the file damaged?)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n1e13,1,2,1\n1,1,2,3\n",
        plain,
        "line 2, column 1: \"1e13\" in column `t_s` is out of range (times are in seconds)",
    ),
    (
        "t_ms,gx_radps,gy_radps,gz_radps\n1e300,1,2,1\n1,1,2,3\n",
        plain,
        "line 3: the time -1e297 s in `t_ms` is out of range (is the unit of the time right?)",
    ),
    (
        "t_ns,gx_radps,gy_radps,gz_radps\n1e300,1,2,1\n1763690000000000000,1,2,3\n",
        plain,
        "line 3: the time -1e291 s in `t_ns` is out of range (is the unit of the time right?)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,1,2,3\n0.5,1,2,4\n",
        plain,
        "line 4: time goes backwards, from 1.0 s to 0.5 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        "t_ns,gx_radps,gy_radps,gz_radps\n1403636579758555392,1,2,3\n1403636579758555391,1,2,4\n",
        plain,
        "line 3: time goes backwards, from 0.0 s to -1e-9 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        "t_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n1,1,2,3\nt_s,gx_radps,gy_radps,gz_radps\n0,1,2,3\n",
        plain,
        "line 4, column 1: \"t_s\" in column `t_s` is not a number (a second header: are these files put together? keep one of them)",
    ),
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tGyr_X\tGyr_Y\tGyr_Z\n10\t1\t2\t3\n9\t1\t2\t3\n",
        plain,
        "line 4: time goes backwards, from 0.0 s to -0.025 s (are these files put together, or did a counter wrap? split the file here)",
    ),
    (
        "// Update Rate: 40.0Hz\nPacketCounter\tGyr_X\tGyr_Y\tGyr_Z\n10\t\t\t\n11\t\t\t\n",
        plain,
        "the columns of the gyroscope are empty (were they recorded, and exported?)",
    ),
];

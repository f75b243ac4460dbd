//! Tests of files that can be used, in every format.

use super::{findings, read, units, used};
use calibrant::diagnostic::Check;
use calibrant::io::{
    ColumnMapping, ColumnUnit, FileFormat, ImuReadOptions, ImuUnit, TimeUnit, parse_imu_pair,
};
use calibrant::sensor::{ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;

/// Options with nothing given.
const PLAIN: ImuReadOptions = ImuReadOptions {
    format: None,
    columns: ColumnMapping {
        time: None,
        rest_of_second: None,
        accelerometer: None,
        gyroscope: None,
        temperature: None,
    },
    time_unit: None,
    accelerometer_unit: None,
    gyroscope_unit: None,
    counts_unless_stated: [false; 2],
    rate_hz: None,
    rate_sd_ppm: None,
    times: None,
    instance: None,
    topic: None,
    rows_are_holds: false,
    accelerometer_only: None,
    budget: None,
};

fn accelerometer(text: &str, options: &ImuReadOptions) -> Recording {
    read(text, options).recording[SensorKind::Accelerometer].clone().expect("an accelerometer")
}

fn gyroscope(text: &str, options: &ImuReadOptions) -> Recording {
    read(text, options).recording[SensorKind::Gyroscope].clone().expect("a gyroscope")
}

/// Rows of an Xsens file: counter, time, accelerometer, gyroscope.
const MT: [[&str; 8]; 4] = [
    ["65534", "", "0.1", "0.2", "9.8", "0.1", "0.2", "0.3"],
    ["65535", "", "0.2", "9.8", "0.1", "0.2", "0.1", "0.4"],
    ["00000", "", "9.8", "0.3", "0.2", "0.3", "0.3", "0.5"],
    ["00003", "", "0.3", "0.4", "9.8", "0.4", "0.4", "0.6"],
];
/// The names of the columns of an MT Manager's export.
const MT_HEADER: [&str; 8] =
    ["PacketCounter", "SampleTimeFine", "Acc_X", "Acc_Y", "Acc_Z", "Gyr_X", "Gyr_Y", "Gyr_Z"];

fn mt(preamble: &str, delimiter: &str) -> String {
    let rows: Vec<String> = MT.iter().map(|row| row.join(delimiter)).collect();
    format!("{preamble}{}\n{}\n", MT_HEADER.join(delimiter), rows.join("\n"))
}

#[test]
fn mt_manager_reads_the_same_with_every_delimiter_and_comment() {
    let expected = gyroscope(&mt("// Update Rate: 50.0Hz\n", "\t"), &PLAIN);
    assert_eq!(expected.times_s(), [0.0, 0.02, 0.04, 0.1], "the counter begins anew, two samples are lost");
    assert_eq!(expected.readings()[1].as_slice(), [0.2, 0.1, 0.4]);
    for delimiter in ["\t", ",", ";", " "] {
        for preamble in [
            "// Start Time: Unknown\n// Update Rate: 50.0Hz\n// Filter Profile: human\n// Firmware Version: 4.4.0\n",
            "// General information: \n//  MT Manager version: 2022.2.0 \n// Device information: \n//  DeviceId: 00B42D4B\n//  Update Rate: 50 Hz\n",
        ] {
            let file = read(&mt(preamble, delimiter), &PLAIN);
            assert_eq!(file.format, FileFormat::MtManager);
            assert_eq!(file.recording[SensorKind::Gyroscope].as_ref(), Some(&expected), "{delimiter:?}");
            assert_eq!(
                findings(&file)[0],
                "its sample times are missing: they are computed from the counter `PacketCounter` and 50 Hz (its `Update Rate`); its uncertainty is 100 ppm (option `rate_sd_ppm`, or rate_sd_ppm in [columns])"
            );
        }
    }
    let given = ImuReadOptions { rate_hz: Some(50.0), ..PLAIN };
    assert_eq!(gyroscope(&mt("//  DeviceId: 00B42D4B\n", "\t"), &given), expected);
    let reported = ImuReadOptions { format: Some(FileFormat::MtManager), ..given };
    assert_eq!(gyroscope(&mt("", "\t"), &reported), expected);
}

#[test]
fn sample_time_fine_is_in_tenths_of_a_millisecond_and_begins_anew() {
    let mut text = "// DeviceId: 1\nPacketCounter,SampleTimeFine,Gyr_X,Gyr_Y,Gyr_Z,Temperature\n".to_owned();
    for k in 0..4_u64 {
        let ticks = (4_294_967_196 + 100 * k) % (1 << 32);
        text += &format!(
            "{k},{ticks},0.{k},0.1,0.{k},{}\n",
            if k % 3 == 0 { format!("2{k}.5") } else { String::new() }
        );
    }
    let file = read(&text, &PLAIN);
    let gyroscope = file.recording[SensorKind::Gyroscope].as_ref().expect("there");
    assert_eq!(gyroscope.times_s(), [0.0, 0.01, 0.02, 0.03]);
    assert!(file.recording[SensorKind::Accelerometer].is_none());
    let temperature = file.recording.temperature_c.as_ref().expect("there");
    let expected = [20.5, 21.5, 22.5, 23.5];
    assert!(temperature.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12));
    assert_eq!(
        findings(&file)[..2],
        [
            "`SampleTimeFine` begins anew 1 time: counted on",
            "the temperature is missing in 2 of 4 rows, for up to 0.03 s: it is interpolated between those that have it, and kept constant before the first and after the last"
        ]
    );
    let counter = &file.columns[0];
    assert_eq!(
        (counter.name.as_str(), counter.unused.as_deref()),
        ("PacketCounter", Some("there are sample times"))
    );
}

/// A Movella DOT export.
const DOT: &str = "sep=,\nDeviceTag:,Xsens DOT 1\nFirmwareVersion:,2.0.0\nAppVersion:,2021.0\nSyncStatus:,Synced\nOutputRate:,60Hz\n\
    FilterProfile:,General\nMeasurement Mode:,Rate quantities (with mag)\nStartTime:,2021-01-01_00:00:00_000\n© Movella. All rights reserved.\n\n";

#[test]
fn movella_dot_is_in_degrees_and_microseconds() {
    let text = format!(
        "{DOT}PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,FreeAcc_X,FreeAcc_Y,FreeAcc_Z,Gyr_X,Gyr_Y,Gyr_Z,\n\
         1,4294950629,0.1,0.2,9.8,0,0,0,180,0,90,\n2,4294967296,0.1,0.2,9.8,0,0,0,90,1,0,\n3,16667,0.2,0.1,9.7,0,0,0,0,2,-90,\n"
    )
    .replace("4294967296", "0");
    let file = read(&text, &PLAIN);
    assert_eq!(file.format, FileFormat::MovellaDot);
    let gyroscope = file.recording[SensorKind::Gyroscope].as_ref().expect("there");
    assert_eq!(gyroscope.readings()[0].as_slice(), [std::f64::consts::PI, 0.0, std::f64::consts::FRAC_PI_2]);
    assert_eq!(gyroscope.times_s(), [0.0, 0.016667, 0.033334]);
    let free = file.columns.iter().find(|column| column.name == "FreeAcc_X").expect("there");
    assert_eq!(free.unused.as_deref(), Some("gravity has been removed: no reading of a sensor"));
    // without times, the counter and the output rate
    let text = text.replace("4294950629", "").replace(",0,0.1", ",,0.1").replace(",16667,", ",,");
    let times =
        read(&text, &PLAIN).recording[SensorKind::Gyroscope].clone().expect("there").times_s().to_vec();
    assert_eq!(times, [0.0, 1.0 / 60.0, 2.0 / 60.0]);
}

/// The header of a EuRoC file.
const EUROC: &str = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
/// Rows of a EuRoC file.
const EUROC_ROWS: &str = "1403636579758555392,-0.099134701513277898,0.14730578886832138,0.02722713633111154,8.1476917083333333,-0.37592158333333331,-2.4026292499999999\n\
    1403636579763555584,-0.099134701513277898,0.14032447186034408,0.029321531433504733,8.033280791666666,-0.40861041666666664,-2.4026292499999999\n\
    1403636579768555520,-0.098436569812480182,0.12775810124598494,0.037699111843077518,7.8861810416666662,-0.42495483333333334,-2.4353180833333332\n";

#[test]
fn euroc_keeps_every_nanosecond() {
    let reported = ImuReadOptions { format: Some(FileFormat::Euroc), ..PLAIN };
    for (text, options) in [(EUROC.to_owned() + EUROC_ROWS, &PLAIN), (EUROC_ROWS.to_owned(), &reported)] {
        let file = read(&text, options);
        assert_eq!(file.format, FileFormat::Euroc);
        let (accelerometer, gyroscope) = (
            file.recording[SensorKind::Accelerometer].as_ref().expect("there"),
            file.recording[SensorKind::Gyroscope].as_ref().expect("there"),
        );
        assert_eq!(accelerometer.times_s(), [0.0, 0.005_000_192, 0.010_000_128]);
        assert_eq!(accelerometer.readings()[2].x, 7.886_181_041_666_666);
        assert_eq!(gyroscope.readings()[2].z, 0.037_699_111_843_077_52);
        assert_eq!(gyroscope.unit(), ReadingUnit::RadianPerSecond);
        let name = if options.format.is_none() { "timestamp [ns]" } else { "1" };
        assert_eq!(
            findings(&file)[0],
            format!("times are counted from the first sample, where `{name}` is 1403636579758555392 ns")
        );
    }
}

#[test]
fn a_csv_says_units_by_name_in_many_ways() {
    let rows = "0,90,0,45,1,0,0\n10,0,90,1,0,1,0\n20,45,0,90,0,0,1\n";
    let expected = read(&format!("t_ms,gx_degps,gy_degps,gz_degps,ax_g,ay_g,az_g\n{rows}"), &PLAIN);
    let accelerometer = expected.recording[SensorKind::Accelerometer].as_ref().expect("there");
    assert_eq!(accelerometer.times_s(), [0.0, 0.01, 0.02]);
    assert_eq!(accelerometer.readings()[2].z, 9.80665);
    assert_eq!(
        expected.recording[SensorKind::Gyroscope].as_ref().expect("there").readings()[0].x,
        std::f64::consts::FRAC_PI_2
    );
    for header in [
        "Timestamp [ms],GyroX [deg/s],GyroY [deg/s],GyroZ [deg/s],AccX [g],AccY [g],AccZ [g]",
        "time (ms),gyro_x_dps,gyro_y_dps,gyro_z_dps,acc_x_g,acc_y_g,acc_z_g",
        "# t_ms, angular_velocity.x [dps], angular_velocity.y [dps], angular_velocity.z [dps], accel x [g], accel y [g], accel z [g]",
    ] {
        assert_eq!(read(&format!("{header}\n{rows}"), &PLAIN).recording, expected.recording, "{header}");
    }
    let options = ImuReadOptions {
        time_unit: Some(TimeUnit::Millisecond),
        ..units(ImuUnit::StandardGravity, ImuUnit::DegreePerSecond)
    };
    for text in [
        format!("time,gx,gy,gz,ax,ay,az\n{rows}"),
        format!("sep=,\ntime,gx,gy,gz,ax,ay,az\n{rows}"),
        format!("time;gx;gy;gz;ax;ay;az;\n{rows}").replace(',', ";"),
    ] {
        let file = read(&text, &options);
        assert_eq!(file.recording, expected.recording, "{text}");
        assert_eq!(file.columns[4].unit, Some(ColumnUnit::Reading(ImuUnit::StandardGravity)));
    }
}

/// Units of ST's sensors and of Arduino's libraries.
#[test]
fn thousandths_are_units() {
    let rows = "0,0,980,17,90000,0,-500\n0.01,1000,0,0,0,180000,0\n0.02,0,0,-1000,0,0,0\n";
    let named = read(&format!("t_s,ax_mg,ay_mg,az_mg,gx_mdps,gy_mdps,gz_mdps\n{rows}"), &PLAIN).recording;
    let given = units(ImuUnit::MilliGravity, ImuUnit::MilliDegreePerSecond);
    assert_eq!(read(&format!("t_s,ax,ay,az,gx,gy,gz\n{rows}"), &given).recording, named);
    let (accelerometer, gyroscope) = (
        named[SensorKind::Accelerometer].clone().expect("there"),
        named[SensorKind::Gyroscope].clone().expect("there"),
    );
    assert!((accelerometer.readings()[0] - Vector3::new(0.0, 0.98, 0.017) * 9.80665).amax() < 1e-14);
    let expected = Vector3::new(std::f64::consts::FRAC_PI_2, 0.0, -0.5_f64.to_radians());
    assert!((gyroscope.readings()[0] - expected).amax() < 1e-14);
}

#[test]
fn columns_are_mapped_by_name_or_number() {
    let rows = "7,0,90,0,45,1,0,0,20\n7,10,0,90,1,0,1,0,21\n7,20,45,0,90,0,0,1,22\n";
    let names = |names: [&str; 3]| Some(names.map(str::to_owned));
    let options = |time: &str, acc, gyr, temperature: &str| ImuReadOptions {
        columns: ColumnMapping {
            time: Some(time.into()),
            accelerometer: names(acc),
            gyroscope: names(gyr),
            temperature: Some(temperature.into()),
            rest_of_second: None,
        },
        time_unit: Some(TimeUnit::Millisecond),
        ..units(ImuUnit::StandardGravity, ImuUnit::DegreePerSecond)
    };
    let by_number = read(rows, &options("2", ["6", "7", "8"], ["3", "4", "5"], "9"));
    assert_eq!(by_number.recording.temperature_c, Some(vec![20.0, 21.0, 22.0]));
    let by_name = options("clock", ["fx", "fy", "fz"], ["p", "q", "r"], "T");
    let named = read(&format!("ax,clock,p,q,r,fx,fy,fz,T\n{rows}"), &by_name);
    assert_eq!(named.recording, by_number.recording);
    assert_eq!(
        named.recording[SensorKind::Accelerometer].as_ref().expect("there").times_s(),
        [0.0, 0.01, 0.02]
    );
    assert_eq!(named.columns[0].unused.as_deref(), Some("other columns are named in [columns]"));
    // a mapped column's given unit takes precedence over its name
    let text = "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,0,0\n1,0,1,0.1\n2,0,0.1,1\n";
    let overruled = ImuReadOptions {
        columns: ColumnMapping {
            accelerometer: names(["ax_mps2", "ay_mps2", "az_mps2"]),
            ..ColumnMapping::default()
        },
        accelerometer_unit: Some(ImuUnit::StandardGravity),
        ..PLAIN
    };
    assert_eq!(accelerometer(text, &overruled).readings()[0].x, 9.80665);
    // a counter in place of a time
    let counted = ImuReadOptions {
        columns: ColumnMapping {
            time: Some("1".into()),
            accelerometer: names(["2", "3", "4"]),
            ..ColumnMapping::default()
        },
        time_unit: Some(TimeUnit::Sample),
        rate_hz: Some(10.0),
        accelerometer_unit: Some(ImuUnit::MetrePerSecondSquared),
        ..PLAIN
    };
    assert_eq!(accelerometer("5 1 2 9.8\n6 2 9.8 1\n8 1 3 9.8\n", &counted).times_s(), [0.0, 0.1, 0.3]);
}

#[test]
fn rows_without_times_take_the_given_rate() {
    let options = ImuReadOptions { rate_hz: Some(4.0), ..PLAIN };
    let file = read("ax_mps2,ay_mps2,az_mps2\n0,1,9.8\n1,0,9.8\n2,1,9.7\n", &options);
    assert_eq!(
        file.recording[SensorKind::Accelerometer].as_ref().expect("there").times_s(),
        [0.0, 0.25, 0.5]
    );
    assert_eq!(
        findings(&file)[0],
        "the file has no sample times and no counter: each row is taken as one sample at 4 Hz (as given), so lost samples do not show; its uncertainty is 5 % (option `rate_sd_ppm`, or rate_sd_ppm in [columns])"
    );
}

#[test]
fn sensors_of_different_rates_may_share_a_file() {
    let text = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n\
        0.000,0,1,9.8,0.1,0.2,0.3\n0.005,,,,0.2,0.1,0.3\n0.010,1,0,9.7,0.1,0.3,0.2\n0.015,,,,0.3,0.2,0.1\n0.02,1,2,9.8,0.1,0.2,0.4\n";
    let file = read(text, &PLAIN);
    assert_eq!(
        file.recording[SensorKind::Accelerometer].as_ref().expect("there").times_s(),
        [0.0, 0.01, 0.02]
    );
    assert_eq!(file.recording[SensorKind::Gyroscope].as_ref().expect("there").len(), 5);
    assert_eq!(findings(&file), ["line 3: accelerometer: 2 rows without a reading (first here)"]);
}

#[test]
fn what_is_missing_twice_or_cut_off_is_dropped_with_a_word() {
    use calibrant::diagnostic::reader::{
        LineTruncated, RowsRepeated, SamplingGap, TimesRepeated, ValuesMissing,
    };
    let header = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n";
    let row = |t: f64, k: usize| format!("{t},{},{},9.{k},0.{},0.{},0.1{k}\n", k % 3, k % 5, k % 7, k % 4);
    let plain: Vec<String> = (0..20).map(|k| row(0.01 * k as f64, k)).collect();
    for (change, kind, message) in [
        (
            ",1,1,9.1",
            ValuesMissing::CODE,
            "line 3: accelerometer: 1 sample with a missing or NaN value dropped",
        ),
        ("\n0.01,", ValuesMissing::CODE, "line 3: 1 row without a time dropped"),
    ] {
        let text = header.to_owned() + &plain.concat();
        let text = if kind == ValuesMissing::CODE && change.starts_with(',') {
            text.replacen(change, ",1,NaN,9.1", 1)
        } else {
            text.replacen(change, "\n,", 1)
        };
        let file = read(&text, &PLAIN);
        assert_eq!((file.findings[0].code(), findings(&file)[0].as_str()), (kind, message));
    }
    let twice = header.to_owned() + &plain[..3].concat() + &plain[2..].concat();
    let file = read(&twice, &PLAIN);
    assert_eq!((file.findings[0].code(), file.rows), (RowsRepeated::CODE, 21));
    assert_eq!(findings(&file), ["line 5: 1 row equal to the one before dropped"]);
    let same_time = header.to_owned() + &plain[..3].concat() + &row(0.02, 9) + &plain[3..].concat();
    assert_eq!(read(&same_time, &PLAIN).findings[0].code(), TimesRepeated::CODE);
    let cut = header.to_owned() + &plain.concat() + "0.2,1,2";
    assert_eq!(read(&cut, &PLAIN).findings[0].code(), LineTruncated::CODE);
    let gap = header.to_owned() + &plain.concat() + &row(5.0, 3);
    let file = read(&gap, &PLAIN);
    assert_eq!(file.findings[0].code(), SamplingGap::CODE);
    assert!(findings(&file)[0].starts_with("line 22: gap of 4.81 s after t = 0.19 s"), "{:?}", file.findings);
}

#[test]
fn the_time_of_a_pair_may_be_named() {
    let names = ["ax", "ay", "az"].map(str::to_owned);
    let columns = ColumnMapping { time: Some("elapsed".into()), accelerometer: Some(names), ..PLAIN.columns };
    let both = units(ImuUnit::Counts, ImuUnit::Counts);
    let options = ImuReadOptions { columns, time_unit: Some(TimeUnit::Millisecond), ..both };
    let read = |second: &[u8]| parse_imu_pair(b"elapsed,x,y,z\n0,1,2,4\n10,1,2,3\n", second, &options);
    let file = read(b"elapsed,x,y,z\n5,1,2,4\n15,1,2,3\n").expect("good");
    assert_eq!(file.recording[SensorKind::Accelerometer].clone().expect("there").times_s(), [0.0, 0.01]);
    assert_eq!(file.recording[SensorKind::Gyroscope].clone().expect("there").times_s(), [0.005, 0.015]);
    // a file without that name has its own time
    let own = read(b"t_ms,x,y,z\n5,1,2,4\n15,1,2,3\n").expect("good");
    assert_eq!(own.recording[SensorKind::Gyroscope].clone().expect("there").times_s(), [0.005, 0.015]);
}

#[test]
fn a_pair_may_have_headers_and_different_times() {
    let both = units(ImuUnit::Counts, ImuUnit::Counts);
    let file = parse_imu_pair(
        b"t_s,x,y,z\n0,1000,2000,4000\n1,1001,2002,4003\n",
        b"0.5 10 20 40\n1.5 11 22 43\n2.5 12 21 47\n",
        &both,
    )
    .expect("good");
    let (accelerometer, gyroscope) = (
        file.recording[SensorKind::Accelerometer].clone().expect("there"),
        file.recording[SensorKind::Gyroscope].clone().expect("there"),
    );
    assert_eq!((accelerometer.times_s(), gyroscope.times_s()), (&[0.0, 1.0][..], &[0.5, 1.5, 2.5][..]));
    // the same file twice: each is read for its own sensor
    let whole = b"t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n0,0,1,9.8,0.1,0.2,0.3\n1,1,0,9.8,0.2,0.1,0.4\n";
    let file = parse_imu_pair(whole, whole, &PLAIN).expect("good");
    assert_eq!(
        used(&file),
        ["t_s", "ax_mps2", "ay_mps2", "az_mps2", "t_s", "gx_radps", "gy_radps", "gz_radps"]
    );
}

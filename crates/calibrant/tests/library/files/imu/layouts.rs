//! One recording in the layouts of many loggers: each is read as the same readings.

use super::findings;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::reader::UnitOverruled;
use calibrant::io::{ImuFile, ImuReadOptions, ImuUnit, TimeUnit, parse_imu_pair, parse_imu_recording};
use calibrant::sensor::{Recording, SensorKind};
use nalgebra::Vector3;

const G: f64 = 9.806_65;
const ROWS: usize = 200;

/// Time, s, accelerometer, m/s², gyroscope, rad/s, of a sensor that turns slowly.
fn row(k: usize) -> (f64, [f64; 3], [f64; 3]) {
    let t = 0.01 * k as f64;
    let (x, y) = ((0.9 * t).sin(), (0.7 * t).cos());
    let up = Vector3::new(x, y, 1.2).normalize() * G;
    (t, up.into(), [0.3 * x, 0.4 * y, 0.1 + 0.05 * x])
}

/// A text: what stands above the rows, and a row of what it is given.
fn text(above: &str, row_of: impl Fn(f64, [f64; 3], [f64; 3]) -> String) -> String {
    (0..ROWS).fold(above.to_owned(), |text, k| {
        let (t, a, w) = row(k);
        text + &row_of(t, a, w) + "\n"
    })
}

fn cells(values: &[f64], delimiter: &str) -> String {
    values.iter().map(|value| format!("{value:.6}")).collect::<Vec<_>>().join(delimiter)
}

fn times(by: f64, values: [f64; 3]) -> [f64; 3] {
    values.map(|value| value * by)
}

/// Are these the readings, at even times?
fn assert_read(name: &str, file: &ImuFile, within: f64) {
    let whole = |sensor_kind: SensorKind| -> &Recording {
        file.recording
            .sensor(sensor_kind)
            .unwrap_or_else(|| panic!("{name}: no {sensor_kind}: {:?}", file.columns))
    };
    for sensor_kind in SensorKind::ALL {
        let found = whole(sensor_kind);
        assert_eq!(found.len(), ROWS, "{name}");
        for (k, reading) in found.readings().iter().enumerate() {
            let (_, a, w) = row(k);
            let expected = Vector3::from(if sensor_kind == SensorKind::Accelerometer { a } else { w });
            assert!((reading - expected).amax() < within, "{name}, {sensor_kind} {k}: {reading} {expected}");
        }
        let steps = found.times_s().windows(2).map(|pair| pair[1] - pair[0]);
        assert!(
            steps.into_iter().all(|step| (step - 0.01).abs() < 1e-6),
            "{name}: {:?}",
            &found.times_s()[..3]
        );
    }
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// A program that writes recordings.
struct Logger {
    name: &'static str,
    /// Its file, and that of the gyroscope where each sensor has one.
    files: Vec<String>,
    /// What is typed to read it: options of the command line, or `[columns]`.
    typed: &'static str,
    /// Largest error of a reading that its digits make, m/s² and rad/s.
    within: f64,
}

const SI: &str = "--accelerometer-unit m/s2 --gyroscope-unit rad/s";
const EPOCH_S: f64 = 1_718_030_736.0;

/// A logger whose file has these lines above rows like this.
fn logger(
    name: &'static str,
    typed: &'static str,
    above: &str,
    row_of: impl Fn(f64, [f64; 3], [f64; 3]) -> String,
) -> Logger {
    Logger { name, files: vec![text(above, row_of)], typed, within: 2e-3 }
}

/// In g and deg/s.
fn in_g(a: [f64; 3], w: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    (times(1.0 / G, a), times(DEGREES, w))
}

fn nanoseconds(from: i64, t: f64) -> i64 {
    from + (1e7 * (100.0 * t).round()) as i64
}

fn loggers() -> Vec<Logger> {
    let si = |a: [f64; 3], w: [f64; 3]| format!("{},{}", cells(&a, ","), cells(&w, ","));
    let degrees = |a, w| {
        let (a, w) = in_g(a, w);
        format!("{},{}", cells(&a, ","), cells(&w, ","))
    };
    let mut loggers = vec![
        logger(
            "Arduino sketch with the library of Jeff Rowberg (MPU-6050), counts at ±2 g and ±250 °/s",
            "--accelerometer-lsb-per-g 16384 --gyroscope-lsb-per-dps 131 --time-unit ms",
            "t,AcX,AcY,AcZ,GyX,GyY,GyZ\n",
            |t, a, w| {
                let (a, w) = in_g(a, w);
                let counts = |values: [f64; 3], by: f64| {
                    times(by, values).map(|value| format!("{value:.0}")).join(",")
                };
                format!("{:.0},{},{}", 1e3 * t, counts(a, 16384.0), counts(w, 131.0))
            },
        ),
        logger(
            "Arduino sketch that prints a banner and no header, s, m/s², rad/s",
            "[columns]\ntime = \"1\"\ntime_unit = \"s\"\naccelerometer = [\"2\", \"3\", \"4\"]\naccelerometer_unit = \"m/s²\"\ngyroscope = [\"5\", \"6\", \"7\"]\ngyroscope_unit = \"rad/s\"",
            "Initializing I2C devices...\nMPU6050 connection successful\n",
            |t, a, w| format!("{t:.2},{}", si(a, w)),
        ),
        logger(
            "OpenLog Artemis",
            "--accelerometer-unit mg --gyroscope-unit deg/s",
            "rtcDate,rtcTime,aX,aY,aZ,gX,gY,gZ,imu_degC,output_Hz,\n",
            |t, a, w| {
                let (a, w) = in_g(times(1e3, a), w);
                format!(
                    "03/05/2024,13:35:{:05.2},{},{},31.2,100.0,",
                    38.0 + t,
                    cells(&a, ","),
                    cells(&w, ",")
                )
            },
        ),
        logger(
            "x-IMU3, NGIMU",
            "",
            "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n",
            |t, a, w| {
                let (a, w) = in_g(a, w);
                format!("{t:.6},{},{}", cells(&w, ","), cells(&a, ","))
            },
        ),
        logger(
            "Shimmer Consensys",
            "",
            "\"sep=\t\"\nS_40AC_Timestamp_Unix_CAL\tS_40AC_Accel_LN_X_CAL\tS_40AC_Accel_LN_Y_CAL\tS_40AC_Accel_LN_Z_CAL\tS_40AC_Gyro_X_CAL\tS_40AC_Gyro_Y_CAL\tS_40AC_Gyro_Z_CAL\t\nms\tm/(s^2)\tm/(s^2)\tm/(s^2)\tdeg/s\tdeg/s\tdeg/s\t\n",
            |t, a, w| {
                format!(
                    "{:.0}\t{}\t{}\t",
                    1e3 * (EPOCH_S + t),
                    cells(&a, "\t"),
                    cells(&times(DEGREES, w), "\t")
                )
            },
        ),
        logger(
            "ST Unico, MEMS Studio",
            "",
            "STEVAL-MKI197V1 (LSM6DSOX)\n\nt [ms]\tA_X [mg]\tA_Y [mg]\tA_Z [mg]\tG_X [mdps]\tG_Y [mdps]\tG_Z [mdps]\n",
            |t, a, w| {
                let (a, w) = in_g(times(1e3, a), times(1e3, w));
                format!("{:.0}\t{}\t{}", 1e3 * t, cells(&a, "\t"), cells(&w, "\t"))
            },
        ),
        logger(
            "PicoQuake",
            "--accelerometer-unit g --gyroscope-unit deg/s --rate-hz 100",
            "# PLab PicoQuake Data\ncount,a_x,a_y,a_z,g_x,g_y,g_z\n",
            |t, a, w| format!("{:.0},{}", 100.0 * t, degrees(a, w)),
        ),
        logger(
            "phyphox",
            "",
            "\"Time (s)\",\"Acceleration x (m/s^2)\",\"Acceleration y (m/s^2)\",\"Acceleration z (m/s^2)\",\"Absolute acceleration (m/s^2)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\",\"Absolute (rad/s)\"\n",
            |t, a, w| {
                let all: Vec<String> = [&[t][..], &a, &[G], &w, &[0.1]]
                    .concat()
                    .iter()
                    .map(|value| format!("{value:.9E}"))
                    .collect();
                all.join(",")
            },
        ),
        logger(
            "ROS 1, rostopic echo -p",
            SI,
            "%time,field.header.seq,field.header.stamp,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z\n",
            |t, a, w| {
                let ns = nanoseconds(1_718_030_736_768_428_032, t);
                format!("{},{:.0},{ns},{}", ns + 400_000, 100.0 * t, si(w, a))
            },
        ),
        logger(
            "ROS 2, messages in columns",
            SI,
            "header.stamp.sec,header.stamp.nanosec,ax,ay,az,gx,gy,gz\n",
            |t, a, w| {
                let t = t + 0.5;
                format!("{:.0},{:.0},{}", EPOCH_S + t.floor(), 1e9 * t.fract(), si(a, w))
            },
        ),
        logger(
            "Kalibr's CSV",
            "",
            "timestamp,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z\n",
            |t, a, w| format!("{},{}", nanoseconds(1_385_030_208_736_607_488, t), si(w, a)),
        ),
        logger(
            "PX4, ulog2csv -m sensor_combined",
            "--time-unit us",
            "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_timestamp_relative,accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2]\n",
            |t, a, w| format!("{:.0},{},10000,0,{}", 2_170_001.0 + 1e6 * t, cells(&w, ","), cells(&a, ",")),
        ),
        logger(
            "ArduPilot, mavlogdump.py --format csv --types IMU",
            "--instance 0 --accelerometer-unit m/s2 --gyroscope-unit rad/s",
            "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T\n",
            |t, a, w| {
                let at = |number: i32| format!("{:.0},{number},{},38.5", 65_645_398.0 + 1e6 * t, si(w, a));
                format!("{}\n{}", at(0), at(1))
            },
        ),
        logger(
            "a spreadsheet with a decimal comma",
            "",
            "time_ms;ax_g;ay_g;az_g;gx_dps;gy_dps;gz_dps\n",
            |t, a, w| {
                let (a, w) = in_g(a, w);
                format!("{:.0};{};{}", 1e3 * t, cells(&a, ";"), cells(&w, ";")).replace('.', ",")
            },
        ),
        logger(
            "a table in mm/s²",
            "--accelerometer-unit mm/s2 --gyroscope-unit rad/s",
            "t_s,ax,ay,az,gx,gy,gz\n",
            |t, a, w| format!("{t:.2},{}", si(times(1e3, a), w)),
        ),
        Logger {
            within: 1e-2,
            ..logger(
                "Betaflight, blackbox_decode; 2048 counts are 1 g",
                "--accelerometer-unit \"2048 LSB/g\" --gyroscope-unit deg/s",
                "loopIteration, time (us), gyroADC[0], gyroADC[1], gyroADC[2], accSmooth[0], accSmooth[1], accSmooth[2], motor[0], flightModeFlags (flags)\n",
                |t, a, w| {
                    let (a, w) = in_g(times(2048.0, a), w);
                    let whole = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
                    format!(
                        "{:.0}, {:.0}, {}, {}, 1000, ANGLE_MODE",
                        3200.0 * t,
                        55_158_008.0 + 1e6 * t,
                        whole(w),
                        whole(a)
                    )
                },
            )
        },
    ];
    let pair =
        |name, typed, above: [&str; 2], row_of: &dyn Fn(f64, [f64; 3]) -> String, by: [f64; 2]| Logger {
            name,
            files: vec![
                text(above[0], |t, a, _| row_of(t, times(by[0], a))),
                text(above[1], |t, _, w| row_of(t, times(by[1], w))),
            ],
            typed,
            within: 2e-3,
        };
    let metawear =
        |unit: &str| format!("epoc (ms),elapsed (s),x-axis ({unit}),y-axis ({unit}),z-axis ({unit})\n");
    loggers.push(pair(
        "MetaWear, a file for each sensor",
        "",
        [&metawear("g"), &metawear("deg/s")],
        &|t, values| format!("{:.0},{t:.3},{}", 1_709_670_938_420.0 + 1e3 * t, cells(&values, ",")),
        [1.0 / G, DEGREES],
    ));
    loggers.push(pair(
        "Sensor Logger (phone), TotalAcceleration.csv --gyroscope Gyroscope.csv",
        SI,
        ["time,seconds_elapsed,z,y,x\n"; 2],
        &|t, [x, y, z]| {
            format!("{},{t:.6},{}", nanoseconds(1_718_030_736_872_695_300, t), cells(&[z, y, x], ","))
        },
        [1.0, 1.0],
    ));
    loggers
}

/// The options of a command line, or `[columns]`, as the library takes them.
fn typed(text: &str) -> ImuReadOptions {
    if text.starts_with("[columns]") {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), text).expect("written");
        return calibrant::io::read_columns(file.path()).unwrap_or_else(|error| panic!("{error}"));
    }
    let mut options = ImuReadOptions::default();
    for option in text.split("--").skip(1) {
        let (name, value) = option.trim().split_once(' ').expect("a value");
        let value = value.trim_matches('"');
        let number = || value.parse().expect("a number");
        let unit = || Some(ImuUnit::parse(value).expect("a unit"));
        match name {
            "accelerometer-unit" => options.accelerometer_unit = unit(),
            "gyroscope-unit" => options.gyroscope_unit = unit(),
            "accelerometer-lsb-per-g" => {
                options.accelerometer_unit = ImuUnit::of_counts(number(), ImuUnit::StandardGravity)
            }
            "gyroscope-lsb-per-dps" => {
                options.gyroscope_unit = ImuUnit::of_counts(number(), ImuUnit::DegreePerSecond)
            }
            "time-unit" => options.time_unit = TimeUnit::parse(value),
            "rate-hz" => options.rate_hz = Some(number()),
            "instance" => options.instance = Some(value.into()),
            other => panic!("--{other}"),
        }
    }
    options
}

#[test]
fn each_logger_is_read_by_what_the_guide_says() {
    for Logger { name, files, typed: text, within } in loggers() {
        let options = typed(text);
        let file = match &files[..] {
            [one] => parse_imu_recording(one.as_bytes(), &options),
            [one, other] => parse_imu_pair(one.as_bytes(), other.as_bytes(), &options),
            _ => unreachable!("one file or two"),
        };
        let file = file.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_read(name, &file, within);
    }
}

/// A unit that is given is that of the other clock.
#[test]
fn the_unit_of_the_times_chooses_among_clocks() {
    let phone = loggers().pop().expect("the last");
    let options = ImuReadOptions { time_unit: Some(TimeUnit::Nanosecond), ..typed(phone.typed) };
    let [a, g] = [0, 1].map(|k| phone.files[k].as_bytes());
    let file = parse_imu_pair(a, g, &options).unwrap_or_else(|error| panic!("{error}"));
    assert_read(phone.name, &file, phone.within);
}

/// The guide is made of these tests. To write it anew, set `CALIBRANT_WRITE_GUIDE`.
#[test]
fn the_guide_of_loggers_says_what_is_tested() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/loggers.md");
    let guide = guide();
    if std::env::var_os("CALIBRANT_WRITE_GUIDE").is_some() {
        std::fs::write(&path, &guide).expect("written");
    }
    let found = std::fs::read_to_string(&path).expect("the guide");
    assert!(
        found == guide,
        "docs/loggers.md is not that of the tests: CALIBRANT_WRITE_GUIDE=1 cargo test --test library loggers"
    );
}

fn guide() -> String {
    let mut guide = "# Loggers\n\nWhat to type to read the files of each logger, beside `calibrant calibrate imu.toml FILE -o result`, `inspect`, `noise` or `apply`. The tests read each of them so.\n\
        Where nothing is to be typed, the file says everything. Sensitivities are those of the range in which was recorded.\n\
        What other files need, `inspect` asks for; [files and conventions](files-and-conventions.md#recordings) says how names, units and clocks are read.\n"
        .to_owned();
    for Logger { name, files, typed, .. } in loggers() {
        guide += &format!("\n## {name}\n\n");
        for file in &files {
            let first: Vec<&str> = file.lines().take(4).collect();
            guide += &format!("```text\n{}\n```\n\n", first.join("\n").replace('\t', " → ").trim_end());
        }
        guide += &match typed {
            "" => "Nothing.\n".to_owned(),
            columns if columns.starts_with('[') => {
                format!("In the experiment file:\n\n```toml\n{columns}\n```\n")
            }
            options => format!("`{options}`\n"),
        };
    }
    guide
}

/// `x-axis (g)` says its sensor by the unit; `[columns]` counts for each file of a pair.
#[test]
fn each_file_of_a_pair_has_its_own_columns() {
    let of = |unit: &str, by: f64, is_gyroscope: bool| {
        let header = format!("epoc (ms),elapsed (s),x-axis ({unit}),y-axis ({unit}),z-axis ({unit})\n");
        text(&header, |t, a, w| {
            let values = times(by, if is_gyroscope { w } else { a });
            format!("{:.0},{t:.3},{}", 1_709_670_938_420.0 + 1e3 * t, cells(&values, ","))
        })
    };
    let (a, w) = (of("g", 1.0 / G, false), of("deg/s", DEGREES, true));
    let read = |a: &str, w: &str, options: &ImuReadOptions| {
        parse_imu_pair(a.as_bytes(), w.as_bytes(), options).unwrap_or_else(|error| panic!("{error}"))
    };
    assert_read("units", &read(&a, &w, &ImuReadOptions::default()), 2e-3);
    // the same names in both
    let plain = |text: &str, unit: &str| text.replace(&format!("-axis ({unit})"), "");
    let names = || Some(["x", "y", "z"].map(Into::into));
    let options = ImuReadOptions {
        columns: calibrant::io::ColumnMapping {
            time: Some("elapsed (s)".into()),
            accelerometer: names(),
            gyroscope: names(),
            temperature: None,
            rest_of_second: None,
        },
        accelerometer_unit: Some(ImuUnit::StandardGravity),
        gyroscope_unit: Some(ImuUnit::DegreePerSecond),
        ..ImuReadOptions::default()
    };
    assert_read("x, y, z", &read(&plain(&a, "g"), &plain(&w, "deg/s"), &options), 2e-3);
}

/// A row of one sensor each, with names and without.
#[test]
fn a_column_may_name_the_sensor_of_each_row() {
    let rows = |t: f64, a: [f64; 3], w: [f64; 3]| {
        let ms = 1e3 * (1_577_145_769.0 + t);
        format!("Accel,0,{ms:.0},{}\nGyro,0,{ms:.0},{}\nMag,0,{ms:.0},1,2,3", cells(&a, ","), cells(&w, ","))
    };
    let units = ImuReadOptions {
        accelerometer_unit: Some(ImuUnit::MetrePerSecondSquared),
        gyroscope_unit: Some(ImuUnit::RadianPerSecond),
        ..ImuReadOptions::default()
    };
    let named = text("sensor,device,timestamp,x,y,z\n", rows);
    let read = |text: &str, options: &ImuReadOptions| {
        parse_imu_recording(text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}"))
    };
    assert_read("named", &read(&named, &units), 2e-3);
    let axes = || Some(["4", "5", "6"].map(Into::into));
    let columns = calibrant::io::ColumnMapping {
        time: Some("3".into()),
        accelerometer: axes(),
        gyroscope: axes(),
        temperature: None,
        rest_of_second: None,
    };
    assert_read("numbers", &read(&text("", rows), &ImuReadOptions { columns, ..units }), 2e-3);
}

/// What a type says of the unit may be wrong: a lidar's messages hold g.
#[test]
fn the_unit_of_a_container_can_be_overruled() {
    let readings: Vec<[f64; 3]> = (0..ROWS).map(|k| times(1.0 / G, row(k).1)).collect();
    let column = |axis: usize| readings.iter().map(|of| of[axis]).collect::<Vec<f64>>();
    let [t, x, y, z] = [(0..ROWS).map(|k| row(k).0).collect(), column(0), column(1), column(2)];
    let columns: [(&str, &[f64]); 4] = [("t_s", &t), ("ax_mps2", &x), ("ay_mps2", &y), ("az_mps2", &z)];
    let read = |unit| {
        let options = ImuReadOptions { accelerometer_unit: unit, ..ImuReadOptions::default() };
        calibrant::io::imu_from_columns(&columns, &options)
    };
    let error = read(None).expect_err("1 m/s²").to_string();
    assert!(error.contains("is it in g?") && error.contains("give the unit g"), "{error}");
    let file = read(Some(ImuUnit::StandardGravity)).unwrap_or_else(|error| panic!("{error}"));
    let found = file.recording.sensor(SensorKind::Accelerometer).expect("there");
    assert!((found.readings()[7] - Vector3::from(row(7).1)).amax() < 1e-9);
    assert!(
        findings(&file).iter().any(|said| said.contains("is in m/s² by the file, but read in g")),
        "{:?}",
        findings(&file)
    );
    assert!(file.findings.iter().any(|found| found.code() == UnitOverruled::CODE));
}

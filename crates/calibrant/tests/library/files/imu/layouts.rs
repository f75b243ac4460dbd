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
fn assert_read(name: &str, file: &ImuFile) {
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
            assert!((reading - expected).amax() < 2e-3, "{name}, {sensor_kind} {k}: {reading} {expected}");
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

#[test]
fn each_logger_is_read_as_it_is() {
    let (plain, epoch) = (ImuReadOptions::default, 1_718_030_736.0_f64);
    let both = |a, g| ImuReadOptions {
        accelerometer_unit: Some(a),
        gyroscope_unit: Some(g),
        ..ImuReadOptions::default()
    };
    let si = || both(ImuUnit::MetrePerSecondSquared, ImuUnit::RadianPerSecond);
    let in_si = |t: f64, a: [f64; 3], w: [f64; 3]| (t, cells(&a, ","), cells(&w, ","));
    let layouts: Vec<(&str, String, ImuReadOptions)> = vec![
        (
            "a title, an empty line, a header with units",
            text(
                "STEVAL-MKI197V1 (LSM6DSOX)\n\nt [ms]\tA_X [mg]\tA_Y [mg]\tA_Z [mg]\tG_X [mdps]\tG_Y [mdps]\tG_Z [mdps]\n",
                |t, a, w| {
                    let (a, w) = (times(1e3 / G, a), times(1e3 * DEGREES, w));
                    format!("{:.0}\t{}\t{}", 1e3 * t, cells(&a, "\t"), cells(&w, "\t"))
                },
            ),
            plain(),
        ),
        (
            "a line with the delimiter, a row of units, a word before each name and one behind it",
            text(
                "\"sep=\t\"\nS_40AC_Timestamp_Unix_CAL\tS_40AC_Accel_LN_X_CAL\tS_40AC_Accel_LN_Y_CAL\tS_40AC_Accel_LN_Z_CAL\tS_40AC_Gyro_X_CAL\tS_40AC_Gyro_Y_CAL\tS_40AC_Gyro_Z_CAL\t\nms\tm/(s^2)\tm/(s^2)\tm/(s^2)\tdeg/s\tdeg/s\tdeg/s\t\n",
                |t, a, w| {
                    let w = times(DEGREES, w);
                    format!("{:.0}\t{}\t{}\t", 1e3 * (epoch + t), cells(&a, "\t"), cells(&w, "\t"))
                },
            ),
            plain(),
        ),
        (
            "a prefix that the six names share, and two stamps",
            text(
                "%time,field.header.seq,field.header.stamp,field.angular_velocity.x,field.angular_velocity.y,field.angular_velocity.z,field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z\n",
                |t, a, w| {
                    let ns = 1_718_030_736_768_428_032 + (1e7 * (100.0 * t).round()) as i64;
                    format!("{},{:.0},{ns},{},{}", ns + 400_000, 100.0 * t, cells(&w, ","), cells(&a, ","))
                },
            ),
            si(),
        ),
        (
            "Kalibr's",
            text("timestamp,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z\n", |t, a, w| {
                let ns = 1_385_030_208_736_607_488 + (1e7 * (100.0 * t).round()) as i64;
                format!("{ns},{},{}", cells(&w, ","), cells(&a, ","))
            }),
            plain(),
        ),
        (
            "PX4's",
            text(
                "timestamp,gyro_rad[0],gyro_rad[1],gyro_rad[2],gyro_integral_dt,accelerometer_timestamp_relative,accelerometer_m_s2[0],accelerometer_m_s2[1],accelerometer_m_s2[2]\n",
                |t, a, w| {
                    format!("{:.0},{},10000,0,{}", 2_170_001.0 + 1e6 * t, cells(&w, ","), cells(&a, ","))
                },
            ),
            ImuReadOptions { time_unit: Some(TimeUnit::Microsecond), ..plain() },
        ),
        (
            "a_x beside g_x",
            text("count,a_x,a_y,a_z,g_x,g_y,g_z\n", |t, a, w| {
                let (a, w) = (times(1.0 / G, a), times(DEGREES, w));
                format!("{:.0},{},{}", 100.0 * t, cells(&a, ","), cells(&w, ","))
            }),
            ImuReadOptions {
                rate_hz: Some(100.0),
                ..both(ImuUnit::StandardGravity, ImuUnit::DegreePerSecond)
            },
        ),
        (
            "a decimal comma",
            text("time_ms;ax_g;ay_g;az_g;gx_dps;gy_dps;gz_dps\n", |t, a, w| {
                let (a, w) = (times(1.0 / G, a), times(DEGREES, w));
                format!("{:.0};{};{}", 1e3 * t, cells(&a, ";"), cells(&w, ";")).replace('.', ",")
            }),
            plain(),
        ),
        (
            "AcX and GyX, ms since 1970",
            text("t,AcX,AcY,AcZ,GyX,GyY,GyZ\n", |t, a, w| {
                let (t, a, w) = in_si(t, a, w);
                format!("{:.0},{a},{w}", 1e3 * (epoch + t))
            }),
            si(),
        ),
        (
            "seconds and nanoseconds in two columns",
            text("header.stamp.sec,header.stamp.nanosec,ax,ay,az,gx,gy,gz\n", |t, a, w| {
                let (t, a, w) = in_si(t + 0.5, a, w);
                format!("{:.0},{:.0},{a},{w}", epoch + t.floor(), 1e9 * t.fract())
            }),
            si(),
        ),
        (
            "a banner, then rows",
            text("Initializing I2C devices...\nMPU6050 connection successful\n", |t, a, w| {
                format!("{t:.2},{},{}", cells(&a, ","), cells(&w, ","))
            }),
            ImuReadOptions {
                time_unit: Some(TimeUnit::Second),
                columns: calibrant::io::ColumnMapping {
                    time: Some("1".into()),
                    accelerometer: Some(["2", "3", "4"].map(Into::into)),
                    gyroscope: Some(["5", "6", "7"].map(Into::into)),
                    temperature: None,
                    rest_of_second: None,
                },
                ..si()
            },
        ),
        (
            "mm/s²",
            text("t_s,ax,ay,az,gx,gy,gz\n", |t, a, w| {
                format!("{t:.2},{},{}", cells(&times(1e3, a), ","), cells(&w, ","))
            }),
            both(ImuUnit::MillimetrePerSecondSquared, ImuUnit::RadianPerSecond),
        ),
    ];
    for (name, text, options) in layouts {
        let file =
            parse_imu_recording(text.as_bytes(), &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_read(name, &file);
    }
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
    assert_read("units", &read(&a, &w, &ImuReadOptions::default()));
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
    assert_read("x, y, z", &read(&plain(&a, "g"), &plain(&w, "deg/s"), &options));
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
    assert_read("named", &read(&named, &units));
    let axes = || Some(["4", "5", "6"].map(Into::into));
    let columns = calibrant::io::ColumnMapping {
        time: Some("3".into()),
        accelerometer: axes(),
        gyroscope: axes(),
        temperature: None,
        rest_of_second: None,
    };
    assert_read("numbers", &read(&text("", rows), &ImuReadOptions { columns, ..units }));
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

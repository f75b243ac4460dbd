//! Tests of invalid samples, numbers that no sensor gives. A few are removed; many mean a file of another
//! kind.

use super::{read, refused};
use calibrant::io::ImuReadOptions;
use calibrant::sensor::{ReadingUnit, SensorKind};

/// A sensor at rest in 200 rows, with other cells in some of them.
fn text(other: &[(usize, usize, &str)]) -> String {
    let row = |row: usize| {
        let noise = |axis: usize| format!("{}", 0.01 * ((row * 7919 + axis * 104_729) % 101) as f64);
        let mut cells: Vec<String> = std::iter::once(format!("{row}")).chain((0..3).map(noise)).collect();
        other
            .iter()
            .filter(|(at, ..)| *at == row)
            .for_each(|(_, cell, value)| cells[*cell] = (*value).into());
        cells.join(",") + "\n"
    };
    (0..200).map(row).collect()
}

#[test]
fn one_absurd_number_is_a_invalid_sample_whatever_its_size() {
    let plain = ImuReadOptions::accelerometer(3, ReadingUnit::MetrePerSecondSquared);
    for value in ["1e12", "1e13", "-1e15", "1e155", "-1e300"] {
        let body = text(&[(120, 2, value)]);
        let imu = read(&format!("t_s,gx_degps,gy_degps,gz_degps\n{body}"), &ImuReadOptions::default());
        let alone = read(&format!("t_s,ax,ay,az\n{body}"), &plain);
        let found = [
            imu.recording[SensorKind::Gyroscope].clone(),
            alone.recording[SensorKind::Accelerometer].clone(),
        ]
        .map(|found| found.expect("there"));
        for (recording, factor) in found.iter().zip([1.0_f64.to_radians(), 1.0]) {
            let (clean, spikes) = recording.without_spikes(SensorKind::Gyroscope);
            let spikes = spikes.expect(value);
            assert_eq!((spikes.samples.as_slice(), spikes.time_s), (&[120][..], 120.0), "{value}");
            let expected = factor * value.parse::<f64>().expect("a number");
            assert!((spikes.reading / expected - 1.0).abs() < 1e-12, "{value}");
            assert!(clean.readings()[120].y.abs() <= 1.0, "{value}");
        }
    }
}

#[test]
fn many_of_them_and_those_of_no_reading_are_refused_at_the_first() {
    let header = "t_s,gx_radps,gy_radps,gz_radps\n";
    let message = |cells: &[(usize, usize, &str)]| {
        refused(&format!("{header}{}", text(cells)), &ImuReadOptions::default())
    };
    // one in 50 is not many
    let four = [(20, 1, "1e15"), (60, 2, "1e15"), (100, 3, "1e15"), (140, 1, "1e15")];
    read(&format!("{header}{}", text(&four)), &ImuReadOptions::default());
    let five = [&four[..], &[(180, 1, "1e15")]].concat();
    let out = "is out of range (is the unit right? is the file damaged?)";
    assert_eq!(message(&five), format!("line 22, column 4: \"1e15\" in column `gx_radps` {out}"));
    assert!(message(&[(20, 1, "inf")]).contains("\"inf\" in column `gx_radps` is out of range"));
    assert!(message(&[(20, 1, "1e301")]).contains("\"1e301\" in column `gx_radps` is out of range"));
    assert!(message(&[(199, 0, "1e13")]).contains("in column `t_s` is out of range (times are in seconds)"));
    let with_temperature =
        format!("t_s,gx_radps,gy_radps,temp_c,gz_radps\n{}", text(&[(5, 3, "1e15")]).replace('\n', ",0\n"));
    let message = refused(&with_temperature, &ImuReadOptions::default());
    assert!(message.contains("\"1e15\" in column `temp_c` is out of range"), "{message}");
}

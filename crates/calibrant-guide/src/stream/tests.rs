//! Tests of the stream: names, units, clocks.

use super::*;
use calibrant::io::{Experiment, preset};

fn session() -> Session {
    Session::new(Experiment::parse(preset("imu").expect("built in"), None).expect("valid")).expect("of holds")
}

/// What comes of some rows, after these lines.
fn taken(lines: &[&str], row: impl Fn(usize) -> String) -> Vec<Taken> {
    let session = session();
    let mut stream = Stream::new(&session);
    let rows: Vec<String> = (0..40).map(row).collect();
    let all = lines.iter().copied().chain(rows.iter().map(String::as_str)).enumerate();
    all.flat_map(|(number, line)| stream.take(line, number as f64 * 0.01)).collect()
}

fn samples(taken: &[Taken]) -> Vec<Sample> {
    let of = |taken: &Taken| match taken {
        Taken::Row(_, sample) => Some(*sample),
        _ => None,
    };
    taken.iter().filter_map(of).collect()
}

fn row(k: usize) -> String {
    format!("{},0.0{},0.2,1.00{},0.1,0.2,0.{}", 1000 + 10 * k, k % 7, k % 5, k % 3)
}

#[test]
fn units_and_clock_are_those_of_the_reader_and_rows_stay_as_they_came() {
    let header = "millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let taken = taken(&["Hello from board 7", header], row);
    assert_eq!(taken[..2], [Taken::Dropped(OTHER), Taken::Header(header.to_owned())]);
    assert!(matches!(&taken[2], Taken::Row(text, _) if *text == row(0)));
    let samples = samples(&taken);
    assert_eq!(samples.len(), 40);
    assert!((samples[3].t_s - 1.03).abs() < 1e-9, "{:?}", samples[3]);
    let [Some(force), Some(rate)] = samples[3].readings else { panic!("both sensors") };
    assert!((force[2] - 1.003 * 9.806_65).abs() < 1e-9 && (rate[1] - 0.2_f64.to_radians()).abs() < 1e-9);
}

#[test]
fn words_and_damaged_rows_do_not_hide_the_header() {
    let header = "millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let taken = taken(&[header, "Initializing the I2C devices", "a b c d e f g"], |k| match k {
        7 => row(k).replace("0.2,1", "inf,1"),
        _ => row(k),
    });
    assert_eq!(taken[0], Taken::Header(header.to_owned()), "{:?}", taken.first());
    assert_eq!(samples(&taken).len(), 39);
}

#[test]
fn other_names_later_are_of_another_session() {
    let session = session();
    let mut stream = Stream::new(&session);
    stream.take("millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps", 0.0);
    (0..40).for_each(|k| drop(stream.take(&row(k), 0.01 * k as f64)));
    let swapped = stream.take("millis,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g", 1.0);
    assert!(matches!(swapped.as_slice(), [Taken::Problem(_)]));
    assert_eq!(stream.take(&row(50), 1.0), [Taken::Dropped(FOREIGN)]);
    stream.take("millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps", 0.0);
    assert!(matches!(stream.take(&row(51), 1.0).as_slice(), [Taken::Row(..)]));
}

#[test]
fn without_a_clock_times_are_those_of_arrival() {
    let taken = taken(&["ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps"], |k| {
        row(k).split_once(',').expect("there").1.to_owned()
    });
    assert!(matches!(&taken[0], Taken::Header(header) if header.starts_with("t_s,ax_g")), "{:?}", taken[0]);
    let samples = samples(&taken);
    assert!(samples.windows(2).all(|pair| pair[1].t_s > pair[0].t_s));
    assert!((samples[39].t_s - 0.4).abs() < 0.05, "{}", samples[39].t_s);
}

#[test]
fn a_session_without_a_clock_goes_on_later() {
    let session = session();
    let header = "ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let without = |k: usize| row(k).split_once(',').expect("there").1.to_owned();
    let mut stream = Stream::new(&session);
    stream.take(&format!("t_s,{header}"), 0.0);
    (0..40).for_each(|k| drop(stream.take(&format!("{},{}", 0.01 * k as f64, without(k)), 0.0)));
    stream.resumed(Vec::new());
    assert!(stream.take(header, 0.2).is_empty());
    let taken = stream.take(&without(3), 0.2);
    assert!(matches!(&taken[..], [Taken::Row(_, sample)] if (sample.t_s - 1.39).abs() < 1e-6), "{taken:?}");
}

#[test]
fn a_recording_with_a_pause_goes_on_as_it_stands() {
    let session = session();
    let header = "millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let mut stream = Stream::new(&session);
    stream.is_replay = true;
    stream.take(header, 0.0);
    (0..40).for_each(|k| drop(stream.take(&row(k), 0.01 * k as f64)));
    let later = row(41).replacen("1410", "91410", 1);
    let taken = stream.take(&later, 0.41);
    assert!(
        matches!(&taken[..], [Taken::Row(text, sample)] if *text == later && sample.t_s > 90.0),
        "{taken:?}"
    );
    stream.resumed(Vec::new());
    // the board was not switched off: its clock goes on
    let taken = stream.take(&row(42).replacen("1420", "93420", 1), 0.0);
    assert!(matches!(&taken[..], [Taken::Row(_, sample)] if (sample.t_s - 93.42).abs() < 1e-9), "{taken:?}");
    assert_eq!(stream.take("WARN: I2C timeout at 0x68 bus zero", 0.1), []);
    assert!(matches!(&stream.take(&row(43).replacen("1430", "93430", 1), 0.1)[..], [Taken::Row(..)]));
}

#[test]
fn json_and_pairs_name_their_columns() {
    let json = taken(&[], |k| {
        format!(
            r#"{{"t_ms": {}, "accel_mps2": [0.0{}, 0.2, 9.80{}], "gyro_dps": [0.1, 0.2, 0.{}]}}"#,
            10 * k,
            k % 7,
            k % 5,
            k % 3
        )
    });
    assert_eq!(samples(&json).len(), 40, "{:?}", json.first());
    let pairs = taken(&[], |k| format!("t_ms:{} ax_g:0.0{} ay_g:0.2 az_g:1.00{}", 10 * k, k % 7, k % 5));
    assert_eq!(samples(&pairs).len(), 40, "{:?}", pairs.first());
}

#[test]
fn the_sensors_may_have_rows_of_their_own_for_one_time() {
    let header = "millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let taken = taken(&[header], |k| match k % 2 {
        0 => format!("{},0.0{},0.2,1.00{},,,", 10 * k, k % 7, k % 5),
        _ => format!("{},,,,0.1,0.2,0.{}", 10 * (k - 1), k % 3),
    });
    let samples = samples(&taken);
    assert_eq!(samples.len(), 40, "{:?}", taken.first());
    assert!(samples[6].readings[1].is_none() && samples[7].readings[0].is_none());
    let session = session();
    let mut stream = Stream::new(&session);
    stream.take(header, 0.0);
    // a separator at the end of a line is no column
    (0..40).for_each(|k| drop(stream.take(&format!("{},", row(k)), 0.01 * k as f64)));
    assert_eq!(stream.take(&row(39), 0.4), [Taken::Dropped(STANDS)]);
}

#[test]
fn a_clock_that_begins_anew_goes_on_and_half_lines_are_dropped() {
    let header = "millis,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps";
    let session = session();
    let mut stream = Stream::new(&session);
    let mut taken = stream.take(header, 0.0);
    for k in 0..40 {
        taken.extend(stream.take(&row(k), 0.01 * k as f64));
    }
    assert_eq!(stream.take("1400,0.1,0.2", 0.41), [Taken::Dropped(WIDTH)]);
    assert!(stream.take(header, 2.0).is_empty());
    assert_eq!(
        wrapped(4.0, 2.0_f64.powi(30) - 5.0, 2.0_f64.powi(30) - 5.0, 1e6),
        Some(2.0_f64.powi(30) + 4.0)
    );
    assert_eq!(wrapped(4.0, 5e6, 5e6, 1e6), None);
    let anew = stream.take("5,0.01,0.2,1.0,0.1,0.2,0.1", 2.4);
    let [Taken::Restarted, Taken::Row(text, sample)] = anew.as_slice() else { panic!("{anew:?}") };
    assert!(sample.t_s > 2.3 && text.starts_with("3"), "{text}");
}

#[test]
fn units_that_nobody_states_are_a_problem_in_words() {
    let taken =
        taken(&["t_ms,ax,ay,az,gx,gy,gz"], |k| format!("{},{},3000,{},1,2,3", 10 * k, 100 + k, 16_000 + k));
    let problem = taken.iter().find_map(|one| match one {
        Taken::Problem(text) => Some(text.clone()),
        _ => None,
    });
    assert!(problem.as_ref().is_some_and(|text| text.contains("unit")), "{taken:?}");
}

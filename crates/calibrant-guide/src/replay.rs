//! A recording that is played again: its lines at their times.

use crate::arrival::Arrival;
use calibrant::io::read_text;
use calibrant::session::{Readings, Session, Source};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::SensorKind;
use std::path::Path;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::{Duration, Instant};

/// Largest recording that is played, bytes.
const LARGEST: u64 = 1 << 30;
/// Lines that go together are so far apart at most, s of the recording.
const TOGETHER_S: f64 = 0.05;

/// Begins to play a recording, so many times as fast.
///
/// # Errors
/// [`Error::Recording`] where it is no text that the session reads.
pub(crate) fn start(session: &Session, path: &Path, speed: f64, to: SyncSender<Arrival>) -> Result<()> {
    let text = read_text(path, LARGEST, "a recording").map_err(Error::Recording)?;
    let file = session.read(&Source::new(Readings::bytes(path, text.clone().into_bytes())))?;
    let sensor = [SensorKind::Accelerometer, SensorKind::Gyroscope]
        .into_iter()
        .find_map(|kind| file.recording.sensor(kind));
    let times = sensor.map(|of| of.times_s().to_vec()).unwrap_or_default();
    let (Some(first), Some(last)) = (times.first().copied(), times.last().copied()) else {
        let error = InputError::new(Refusal::RecordingShort, "there is nothing to play", "give a recording");
        return Err(Error::recording(error.in_file(path)));
    };
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let head = lines.len().saturating_sub(file.rows);
    let begin = Instant::now();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        let mut sent_s = first;
        for (number, line) in lines.iter().enumerate() {
            let share = number.saturating_sub(head) as f64 / file.rows.max(2).saturating_sub(1) as f64;
            // rows that were dropped hardly move the others
            let t_s = if file.rows == times.len() {
                times[number.saturating_sub(head).min(times.len() - 1)]
            } else {
                first + share * (last - first)
            };
            if t_s - sent_s >= TOGETHER_S {
                let due = Duration::from_secs_f64((t_s - first) / speed);
                thread::sleep(due.saturating_sub(begin.elapsed()));
                if to.send(Arrival::Bytes { bytes: std::mem::take(&mut bytes), at_s: t_s - first }).is_err() {
                    return;
                }
                sent_s = t_s;
            }
            bytes.extend_from_slice(line.as_bytes());
            bytes.push(b'\n');
        }
        let _ = to.send(Arrival::Bytes { bytes, at_s: last - first });
        let _ = to.send(Arrival::End);
    });
    Ok(())
}

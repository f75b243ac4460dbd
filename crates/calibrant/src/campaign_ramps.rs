//! Ramps of a campaign: recordings in which the sensor is turned while the temperature goes over more than a soak's. Each is cut into pieces, which are soaks.

use crate::batch::{Batch, BatchRow, in_parallel};
use crate::campaign_soaks::calibrate_with_the_others;
use crate::session::{Readings, Session, Source};
use calibrant_campaign::Campaign;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::campaign::RampCut;
use calibrant_core::error::{Error, Result};
use calibrant_core::estimate::SoakTemperature;
use calibrant_core::progress::Progress;
use calibrant_core::sensor::ImuRecording;
use calibrant_io::{Experiment, ImuFile, PART, file_name, parse_soak};

/// A soak spans at most this share of the range of use: within, a parabola of the biases and a line of the gains are enough.
const WIDEST: f64 = 0.2;
/// Time over which temperatures are averaged, s.
const STEP_S: f64 = 10.0;

/// Calibrates the soaks of a campaign from what came of each recording by itself: ramps are cut into pieces, and what leaves parameters open is fitted together with the
/// others. `batch` is of one soak; its rows are in the order of its recordings.
///
/// # Errors
/// Where the experiment makes no sense.
pub fn calibrate_soaks(
    experiment: &Experiment,
    batch: Batch,
    rows: Vec<BatchRow>,
    progress: &Progress,
) -> Result<(Vec<BatchRow>, Vec<Diagnostic>)> {
    let Some(campaign) = experiment.campaign()? else { return Ok((rows, Vec::new())) };
    let (mut soaks, mut notes) = Soaks::with_ramps_cut((batch, rows), &campaign, progress)?;
    notes.extend(calibrate_with_the_others(experiment, &soaks.batch, &mut soaks.rows)?);
    Ok((soaks.rows(), notes))
}

/// The soaks of a campaign, pieces of ramps among them.
struct Soaks {
    batch: Batch,
    rows: Vec<BatchRow>,
    is_piece: Vec<bool>,
}

impl Soaks {
    /// Pieces in place of each ramp.
    fn with_ramps_cut(
        (batch, rows): (Batch, Vec<BatchRow>),
        campaign: &Campaign,
        progress: &Progress,
    ) -> Result<(Self, Vec<Diagnostic>)> {
        let ramps = ramps(&batch, &rows, campaign);
        if ramps.iter().all(Option::is_none) {
            let is_piece = vec![false; rows.len()];
            return Ok((Self { batch, rows, is_piece }, Vec::new()));
        }
        let cut: Vec<Source> = ramps.iter().flatten().flat_map(|ramp| ramp.pieces.clone()).collect();
        let mut found = batch.with_sources(cut)?.run(progress).rows.into_iter();
        let (mut all, mut sources, mut is_piece) = (Vec::new(), Vec::new(), Vec::new());
        let mut notes: Vec<Diagnostic> = Vec::new();
        for ((row, source), ramp) in rows.into_iter().zip(batch.sources()).zip(ramps) {
            let Some(Ramp { pieces, range_c: [from_c, to_c], findings }) = ramp else {
                all.push(row);
                sources.push(source.clone());
                is_piece.push(false);
                continue;
            };
            batch.forget(&row);
            let recording = row.recording.display().to_string();
            notes.push(RampCut { recording, from_c, to_c, pieces: pieces.len() }.into());
            notes.extend(findings);
            all.extend(found.by_ref().take(pieces.len()));
            is_piece.extend(pieces.iter().map(|_| true));
            sources.extend(pieces);
        }
        Ok((Self { batch: batch.with_sources(sources)?, rows: all, is_piece }, notes))
    }

    /// All but pieces without holds: between two stops of the chamber the sensor may rest in one pose, or move.
    fn rows(self) -> Vec<BatchRow> {
        let is_empty = |row: &BatchRow| matches!(&row.outcome, Err(Error::NotIdentifiable(of)) if of.has_hardly_a_hold());
        let kept = self.rows.into_iter().zip(self.is_piece);
        kept.filter(|(row, is_piece)| !(*is_piece && is_empty(row))).map(|(row, _)| row).collect()
    }
}

/// The recordings that are ramps, each in its place.
fn ramps(batch: &Batch, rows: &[BatchRow], campaign: &Campaign) -> Vec<Option<Ramp>> {
    in_parallel(rows.len(), |k| {
        // no soak has the name of a piece
        let mut name = format!("{}-part", rows[k].folder);
        while rows.iter().any(|row| row.folder.to_lowercase().starts_with(&name.to_lowercase())) {
            name += "-part";
        }
        is_wide(&rows[k], campaign)
            .then(|| pieces(batch.session(), &batch.sources()[k], (campaign, &name)))?
    })
}

/// A recording whose temperature goes over more than a soak's.
struct Ramp {
    pieces: Vec<Source>,
    /// Lowest and highest temperature, °C.
    range_c: [f64; 2],
    /// What was noticed in its file.
    findings: Vec<Diagnostic>,
}

/// May a recording be a ramp? Its holds say; where it has no result, it is looked at.
fn is_wide(row: &BatchRow, campaign: &Campaign) -> bool {
    let Ok(result) = &row.outcome else { return !row.is_interrupted() };
    let soak = parse_soak(&result.json, &row.folder);
    soak.is_ok_and(|soak| spans_widely(soak.calibration.temperature.range_c, campaign))
}

fn spans_widely([low, high]: [f64; 2], campaign: &Campaign) -> bool {
    high - low > WIDEST * (campaign.range_c[1] - campaign.range_c[0])
}

/// Is the recording a ramp in several poses?
///
/// # Errors
/// Where it cannot be read.
pub fn is_ramp(of_one: &Session, source: &Source) -> Result<bool> {
    let campaign = of_one.experiment().campaign()?;
    Ok(campaign.is_some_and(|campaign| pieces(of_one, source, (&campaign, "")).is_some()))
}

/// The pieces of a recording, with this name and a number; `None` where its temperature stays or cannot be read, and in one pose.
fn pieces(of_one: &Session, source: &Source, (campaign, name): (&Campaign, &str)) -> Option<Ramp> {
    let file = of_one.read(source).ok().filter(|_| source.further.is_empty() && source.sections.is_none())?;
    let temperatures = temperatures(&file.recording)?;
    let range = temperatures.iter().map(|(_, t)| [*t; 2]).reduce(|[a, b], [t, _]| [a.min(t), b.max(t)]);
    let range_c = range.filter(|range| spans_widely(*range, campaign))?;
    let least = (60.0 * campaign.block_min, campaign.spacing_c);
    let spans = spans(&temperatures, least);
    if spans.len() < 2 || of_one.one_pose(source).is_ok_and(|found| found.is_some()) {
        return None;
    }
    let digits = spans.len().to_string().len();
    let path = source.path();
    let piece = |(k, span): (usize, &(f64, f64))| {
        let path = path.with_file_name(format!("{name}-{:0digits$}", k + 1));
        Source::new(Readings::read_already(&path, part(&file, *span)))
    };
    Some(Ramp {
        pieces: spans.iter().enumerate().map(piece).collect(),
        range_c,
        findings: file.findings_in(&file_name(path), None),
    })
}

/// Mean temperatures over equal times, and when each begins.
fn temperatures(recording: &ImuRecording) -> Option<Vec<(f64, f64)>> {
    let times = recording.sensors().next()?.1.times_s();
    let (first, last) = (*times.first()?, *times.last()?);
    let starts = (0..).map(|k| first + STEP_S * f64::from(k)).take_while(|start| start + STEP_S <= last);
    let starts: Vec<f64> = starts.collect();
    let each = SoakTemperature::each(recording, starts.iter().map(|start| (*start, start + STEP_S))).ok()?;
    (!each.is_empty()).then(|| starts.into_iter().zip(each.iter().map(|of| of.mean_c)).collect())
}

/// Pieces in which the temperature goes one way, each over `least` s and K at least: the first begins, and the last ends, with the recording.
fn spans(temperatures: &[(f64, f64)], (least_s, least_k): (f64, f64)) -> Vec<(f64, f64)> {
    let mut cuts = vec![f64::NEG_INFINITY];
    let (mut begin, mut extreme) = (temperatures[0], temperatures[0]);
    for &(time_s, temperature_c) in temperatures {
        let way = extreme.1 - begin.1;
        if (temperature_c - begin.1).abs() >= way.abs() {
            extreme = (time_s, temperature_c);
        }
        let turned = (temperature_c - extreme.1).abs() >= least_k && way.abs() >= 0.5 * least_k;
        let at = if turned { extreme } else { (time_s, temperature_c) };
        let is_far = (temperature_c - begin.1).abs() >= least_k;
        if (turned || is_far) && at.0 - begin.0 >= least_s {
            cuts.push(at.0);
            (begin, extreme) = (at, (time_s, temperature_c));
        }
    }
    let end_s = temperatures[temperatures.len() - 1].0 + STEP_S;
    if cuts.len() > 1 && end_s - begin.0 < least_s {
        cuts.pop();
    }
    cuts.iter().zip(cuts[1..].iter().chain([&f64::INFINITY])).map(|(from, to)| (*from, *to)).collect()
}

/// The samples of a recording within these times, as a recording of its own.
fn part(file: &ImuFile, (from_s, to_s): (f64, f64)) -> ImuFile {
    let within = |time_s: &f64| (from_s..to_s).contains(time_s);
    let times = file.recording.sensors().next().map(|(_, sensor)| sensor.times_s());
    let with_times = times.zip(file.recording.temperature_c.as_ref());
    let temperatures = with_times.map(|(times, values)| {
        let samples = times.iter().zip(values).filter(|(time_s, _)| within(time_s));
        samples.map(|(_, value)| *value).collect()
    });
    let mut recording = ImuRecording { temperature_c: temperatures, ..ImuRecording::default() };
    for (kind, sensor) in file.recording.sensors() {
        recording[kind] = Some(sensor.only(|sample| within(&sensor.times_s()[sample])));
    }
    ImuFile {
        rows: recording.sensors().map(|(_, sensor)| sensor.len()).max().unwrap_or(0),
        recording,
        sha256: file.sha256.iter().map(|sha256| format!("{sha256}{PART}{from_s} to {to_s} s")).collect(),
        findings: Vec::new(),
        second: None,
        format: file.format,
        columns: file.columns.clone(),
        counted_from_ns: file.counted_from_ns,
        rate_sd_ppm: file.rate_sd_ppm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up and down over 44 K at 2 K/min, with a stop of 10 min on top: pieces of 5 K at least, and none goes both ways.
    #[test]
    fn a_ramp_is_cut_by_its_temperature_and_where_it_turns() {
        let at = |minute: f64| match minute {
            m if m < 22.0 => 2.0 * m,
            m if m < 32.0 => 44.0,
            m => 44.0 - 2.0 * (m - 32.0),
        };
        let temperatures: Vec<(f64, f64)> =
            (0..324).map(|k| 10.0 * f64::from(k)).map(|time_s| (time_s, at(time_s / 60.0))).collect();
        let found = spans(&temperatures, (90.0, 5.0));
        let minutes = found.iter().skip(1).map(|(from, _)| (from / 60.0).round());
        let (up, down) = ([3, 5, 8, 10, 13, 15, 18, 20], [35, 37, 40, 42, 45, 47, 50, 52]);
        let expected = up.into_iter().chain([32]).chain(down).map(f64::from);
        assert!(minutes.eq(expected), "{found:?}");
    }
}

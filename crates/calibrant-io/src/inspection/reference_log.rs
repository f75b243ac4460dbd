//! Inspection of a log of a machine's motion: what was recorded of it and how well, as data and as JSON.

use super::sampling::Sampling;
use crate::results::heading::{Heading, JsonFile};
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_machine::log::{JointLog, PoseLog, RecoveredStream, ReferenceLog, recover_interpolated};
use calibrant_recording::ReferenceLogFile;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

/// A step is a jump where it is this many times as large as 99.5 % of all,
const OF_MOST: f64 = 3.0;
const MOST: f64 = 0.995;
/// and this many times as large as the larger step beside it.
const OF_BESIDE: f64 = 5.0;

/// What a log of a motion holds.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceInspection {
    /// Its times; of several samples with one time, one.
    pub sampling: Sampling,
    /// Number of samples with the time of the one before.
    pub repeated: usize,
    /// Each joint of a log of joints.
    pub joints: Vec<JointInspection>,
    /// The poses of a log of poses.
    pub poses: Option<PoseInspection>,
}

/// How often something was recorded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Seen {
    /// Number of samples that have it.
    pub samples: usize,
    /// The same as a share of all.
    pub share: f64,
    /// The longest time without it, s.
    pub longest_without_s: f64,
}

/// Steps from sample to sample that no motion made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Jumps {
    /// How many.
    pub count: usize,
    /// Time of the sample before the largest, s.
    pub largest_after_s: f64,
    /// Size of the largest, in rad or m.
    pub largest: f64,
}

/// What was recorded of one joint; positions in rad or m.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointInspection {
    /// Its name.
    pub name: String,
    /// Its least position.
    pub least: f64,
    /// Its largest position.
    pub most: f64,
    /// How often it has a position.
    pub seen: Seen,
    /// Does it have velocities?
    pub has_velocities: bool,
    /// Jumps of its position.
    pub jumps: Option<Jumps>,
}

/// What was recorded of the poses of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseInspection {
    /// How often the position was seen.
    pub position_seen: Seen,
    /// How often the orientation was seen.
    pub orientation_seen: Seen,
    /// Least and largest coordinates, m; `None` where no position was seen.
    pub range_m: Option<(Vector3<f64>, Vector3<f64>)>,
    /// Jumps of the position, m.
    pub position_jumps: Option<Jumps>,
    /// Jumps of the orientation, rad.
    pub orientation_jumps: Option<Jumps>,
    /// The slower stream whose interpolation the poses are.
    pub interpolated: Option<RecoveredStream>,
}

/// Examines a log: its times, what was seen, jumps, and whether its poses are interpolated.
///
/// # Examples
/// ```
/// use calibrant_io::{ReferenceLogOptions, inspect_reference_log, parse_reference_log};
/// let text = b"t_s,elbow_deg\n0,0\n1,90\n2,nan\n";
/// let file = parse_reference_log(text, &ReferenceLogOptions::default())?;
/// let inspection = inspect_reference_log(&file);
/// assert_eq!(inspection.joints[0].most, std::f64::consts::FRAC_PI_2);
/// assert_eq!(inspection.joints[0].seen.samples, 2);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn inspect_reference_log(file: &ReferenceLogFile) -> ReferenceInspection {
    let times_s = file.log.times_s();
    let mut distinct = times_s.to_vec();
    distinct.dedup();
    let (joints, poses) = match &file.log {
        ReferenceLog::Joints(log) => (JointInspection::all(log), None),
        ReferenceLog::Poses(log) => (Vec::new(), Some(PoseInspection::of(log))),
    };
    let repeated = times_s.len() - distinct.len();
    ReferenceInspection { sampling: Sampling::of(&distinct), repeated, joints, poses }
}

impl JointInspection {
    fn all(log: &JointLog) -> Vec<Self> {
        let of_joint = |(joint, name): (usize, &String)| {
            let position = |k: usize| Some(log.row(k)[joint]).filter(|position| !position.is_nan());
            let positions = (0..log.times_s.len()).filter_map(position);
            Self {
                name: name.clone(),
                least: positions.clone().fold(f64::INFINITY, f64::min),
                most: positions.fold(f64::NEG_INFINITY, f64::max),
                seen: Seen::of(&log.times_s, |k| position(k).is_some()),
                has_velocities: log.velocities.as_ref().is_some_and(|velocities| {
                    velocities.iter().skip(joint).step_by(log.names.len()).any(|velocity| !velocity.is_nan())
                }),
                jumps: Jumps::of(&log.times_s, |k| Some((position(k + 1)? - position(k)?).abs())),
            }
        };
        log.names.iter().enumerate().map(of_joint).collect()
    }
}

impl PoseInspection {
    fn of(log: &PoseLog) -> Self {
        let PoseLog { times_s, positions_m, world_from_body } = log;
        let mut seen = positions_m.iter().flatten();
        let range_m = seen.next().map(|first| {
            seen.fold((*first, *first), |(least, most), position| (least.inf(position), most.sup(position)))
        });
        Self {
            position_seen: Seen::of(times_s, |k| positions_m[k].is_some()),
            orientation_seen: Seen::of(times_s, |k| world_from_body[k].is_some()),
            range_m,
            position_jumps: Jumps::of(times_s, |k| Some((positions_m[k + 1]? - positions_m[k]?).norm())),
            orientation_jumps: Jumps::of(times_s, |k| {
                Some(world_from_body[k + 1]?.angle_to(&world_from_body[k]?))
            }),
            interpolated: recover_interpolated(log),
        }
    }
}

impl Seen {
    fn of(times_s: &[f64], is_seen: impl Fn(usize) -> bool) -> Self {
        let (first, last) = (times_s[0], times_s[times_s.len() - 1]);
        let (mut samples, mut before, mut longest) = (0, first, 0.0_f64);
        for (k, &t) in times_s.iter().enumerate() {
            if is_seen(k) {
                // from one sample to the next nothing is missing
                let is_next = k > 0 && is_seen(k - 1);
                longest = longest.max(if is_next { 0.0 } else { t - before });
                (samples, before) = (samples + 1, t);
            }
        }
        longest = longest.max(last - before);
        Self { samples, share: samples as f64 / times_s.len() as f64, longest_without_s: longest }
    }
}

impl Jumps {
    /// The steps after a sample that are far larger than all others; `None` where there are none.
    fn of(times_s: &[f64], step: impl Fn(usize) -> Option<f64>) -> Option<Self> {
        let steps: Vec<Option<f64>> = (0..times_s.len() - 1).map(step).collect();
        let mut sizes: Vec<f64> = steps.iter().copied().flatten().filter(|size| *size > 0.0).collect();
        let place = (MOST * sizes.len() as f64) as usize;
        if place >= sizes.len() {
            return None;
        }
        let limit = OF_MOST * *sizes.select_nth_unstable_by(place, f64::total_cmp).1;
        let size = |k: Option<usize>| k.and_then(|k| steps.get(k).copied().flatten()).unwrap_or(0.0);
        let is_jump = |k: &usize| {
            let beside = size(k.checked_sub(1)).max(size(Some(k + 1)));
            size(Some(*k)) > limit.max(OF_BESIDE * beside)
        };
        let jumps: Vec<usize> = (0..steps.len()).filter(is_jump).collect();
        let largest =
            jumps.iter().copied().max_by(|one, other| size(Some(*one)).total_cmp(&size(Some(*other))))?;
        Some(Self { count: jumps.len(), largest_after_s: times_s[largest], largest: size(Some(largest)) })
    }
}

/// A log of a motion and its inspection, as `calibrant inspect --json` prints them.
#[derive(Debug, Clone, Copy)]
pub struct ReferenceInspectionFile<'a> {
    /// The log.
    pub file: &'a ReferenceLogFile,
    /// What it contains.
    pub inspection: &'a ReferenceInspection,
}

json_object! {
    /// What a log of a motion contains.
    ReferenceInspectionFile<'_> as of {
        heading: flat(Heading::<Self>::of()),
        /// The format of the file.
        format: of.file.format.name(),
        /// The hash of the file.
        sha256: &of.file.sha256,
        /// Number of rows.
        rows: of.file.rows,
        /// What the reader noticed.
        findings: &of.file.findings,
        sampling: &of.inspection.sampling,
        /// Number of samples with the time of the one before.
        repeated_times: of.inspection.repeated,
        joints: &of.inspection.joints,
        poses: of.inspection.poses.as_ref(),
    }
}

impl JsonFile for ReferenceInspectionFile<'_> {
    const KIND: &'static str = "log";
}

json_object! {
    /// The poses of a body.
    PoseInspection as poses {
        /// In m.
        position: OfBody { seen: poses.position_seen, jumps: poses.position_jumps },
        /// In rad.
        orientation: OfBody { seen: poses.orientation_seen, jumps: poses.orientation_jumps },
        least_m: poses.range_m.map(|(least, _)| <[f64; 3]>::from(least)),
        most_m: poses.range_m.map(|(_, most)| <[f64; 3]>::from(most)),
        /// The slower stream whose interpolation the poses are.
        interpolated: poses.interpolated.as_ref().map(StreamOf),
    }
}

#[derive(Serialize, JsonSchema)]
struct OfBody {
    seen: Seen,
    jumps: Option<Jumps>,
}

struct StreamOf<'a>(&'a RecoveredStream);

json_object! {
    StreamOf<'_> as stream {
        /// Number of samples.
        samples: stream.0.log.positions_m.iter().flatten().count(),
        rate_hz: stream.0.rate_hz(),
        period_s: stream.0.period_s,
        period_sd_s: stream.0.period_sd_s,
        first_s: stream.0.first_s,
        nominal_rate_hz: stream.0.clock().map(|(nominal_hz, _)| nominal_hz),
        clock_fast_ppm: stream.0.clock().map(|(_, faster)| 1e6 * faster),
        rms_m: stream.0.rms_m,
        rms_rad: stream.0.rms_rad,
    }
}

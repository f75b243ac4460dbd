//! Poses that are placeholders: what a tracker's bridge writes while the body is hidden. A pose that recurs to the last bit is no measurement.

use super::orientation_form::OrientationForm;
use super::rows::Rows;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::PosesBlank;
use nalgebra::Vector3;

/// A placeholder is this many times farther than most rows are from the ones before them.
const JUMP: f64 = 3.0;
/// Share of the rows that are most.
const MOST: f64 = 0.9;

/// Takes the placeholders as missing.
pub(super) fn blank_placeholders(
    form: OrientationForm,
    kept: &[usize],
    rows: &mut Rows,
) -> Option<Diagnostic> {
    let width = 3 + form.width();
    let poses: Vec<&[f64]> = kept.iter().map(|&row| &rows.values[row * width..][..width]).collect();
    let zeros = |values: &[f64]| values.iter().all(|value| *value == 0.0);
    // four zeros are no quaternion, nor nine a matrix
    let is_void = |pose: &[f64]| !form.has_unit() && zeros(&pose[3..]);
    let no_turn = |values: &[f64]| zeros(values) || values == form.identity();
    let unseen = |values: &[f64]| values.iter().all(|value| value.is_nan());
    let is_origin = |pose: &[f64]| {
        let (position, orientation) = pose.split_at(3);
        let [no_position, no_orientation] = [position, orientation].map(unseen);
        !(no_position && no_orientation)
            && (no_position || zeros(position))
            && (no_orientation || no_turn(orientation))
    };
    let voids: Vec<bool> = poses.iter().map(|pose| is_void(pose)).collect();
    let mut blank = voids.clone();
    let origins: Vec<usize> = (0..poses.len()).filter(|&k| is_origin(poses[k])).collect();
    let others: Vec<usize> = (0..poses.len())
        .filter(|&k| !voids[k] && !is_origin(poses[k]) && !poses[k].iter().all(|value| value.is_nan()))
        .collect();
    let usual = usual_step(form, &poses, &others);
    if origins.len() > 1 && usual > 0.0 {
        for run in origins.chunk_by(|one, next| one + 1 == *next) {
            let (first, last) = (run[0], run[run.len() - 1]);
            let is_far =
                |k: Option<&usize>| k.is_some_and(|&k| distance(form, poses[first], poses[k]) > JUMP * usual);
            let before = others[..others.partition_point(|&k| k < first)].last().filter(|k| **k + 1 == first);
            let after = others[others.partition_point(|&k| k < last)..].first().filter(|k| **k == last + 1);
            if is_far(before) || is_far(after) {
                blank[first..=last].fill(true);
            }
        }
    }
    let has_position: Vec<bool> = poses.iter().map(|pose| !zeros(&pose[..3])).collect();
    let count = blank.iter().filter(|blank| **blank).count();
    for (k, &row) in kept.iter().enumerate().filter(|(k, _)| blank[*k]) {
        let values = &mut rows.values[row * width..][..width];
        // a position with no quaternion beside it is that of a marker
        values[if has_position[k] { 3 } else { 0 }..].fill(f64::NAN);
    }
    (count > 0).then(|| PosesBlank { rows: count, share: count as f64 / kept.len() as f64 }.into())
}

/// How far nine in ten of the rows that move are from the ones before them, at most.
fn usual_step(form: OrientationForm, poses: &[&[f64]], others: &[usize]) -> f64 {
    let pairs = others.windows(2).filter(|pair| pair[0] + 1 == pair[1]);
    let steps = pairs.map(|pair| distance(form, poses[pair[0]], poses[pair[1]]));
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps.get((MOST * steps.len() as f64) as usize).copied().unwrap_or(0.0)
}

/// How far two poses are apart, in m and rad, in what both have.
fn distance(form: OrientationForm, one: &[f64], next: &[f64]) -> f64 {
    let moved = (Vector3::from_row_slice(&next[..3]) - Vector3::from_row_slice(&one[..3])).norm();
    let turn = |pose: &[f64]| form.orientation(&pose[3..]).ok().flatten().map(|(turn, _)| turn);
    let turned = turn(one).zip(turn(next)).map_or(0.0, |(one, next)| one.angle_to(&next));
    turned + if moved.is_nan() { 0.0 } else { moved }
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::read::parse_reference_log;

    /// Poses at 100 Hz, 1 m from the origin; each tenth of the rows from the second is hidden, as this. Returns the rows that have a position, an
    /// orientation, and the codes.
    fn seen(hidden: &str) -> (usize, usize, String) {
        let row = |k: i32| {
            let angle = f64::from(k) * 0.01;
            let (sin, cos) = (0.5 * angle).sin_cos();
            match k % 100 {
                50..60 => format!("{},{hidden}\n", f64::from(k) / 100.0),
                _ => format!("{},1,{:.9},0.5,{cos:.9},{sin:.9},0,0\n", f64::from(k) / 100.0, angle.sin()),
            }
        };
        let text = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz\n".to_owned() + &(0..500).map(row).collect::<String>();
        read(&text)
    }

    fn read(text: &str) -> (usize, usize, String) {
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("a log");
        let log = file.poses().expect("of poses");
        let codes: Vec<_> = file.findings.iter().map(|found| found.code().name()).collect();
        (
            log.positions_m.iter().flatten().count(),
            log.world_from_body.iter().flatten().count(),
            codes.join(" "),
        )
    }

    #[test]
    fn placeholders_are_missing_whatever_their_quaternion() {
        let blank = "poses-blank".to_owned();
        assert_eq!(seen("0,0,0,0,0,0,0"), (450, 450, blank.clone()));
        assert_eq!(seen("0,0,0,1,0,0,0"), (450, 450, blank.clone()));
        assert_eq!(seen("1,2,3,0,0,0,0"), (500, 450, blank), "a position is kept");
        assert_eq!(seen("nan,nan,nan,nan,nan,nan,nan"), (450, 450, String::new()));
    }

    #[test]
    fn a_body_that_rests_at_the_origin_before_it_moves_is_there() {
        let at = |k: i32| 1e-4 * f64::from((k - 100).max(0)).powi(2);
        let row = |k: i32| format!("{},{},0,0,1,0,0,0\n", f64::from(k) / 100.0, at(k));
        let text = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz\n".to_owned() + &(0..300).map(row).collect::<String>();
        assert_eq!(read(&text), (300, 300, String::new()));
    }
}

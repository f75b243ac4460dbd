//! How fast the body of a log moves: positions in mm that are read as m are a thousand times too fast.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::BodyTooFast;
use calibrant_machine::log::PoseLog;
use nalgebra::Vector3;

/// Neither machine nor hand moves a sensor faster, m/s.
const FASTEST_MPS: f64 = 50.0;
/// Share of the steps that are faster: more than a tracker's jumps.
const SHARE: f64 = 0.1;

/// Doubts the unit of positions whose body is too fast.
pub(super) fn body_too_fast(log: &PoseLog) -> Option<Diagnostic> {
    let times_s = &log.times_s;
    // rows that were logged in a burst lie closer than they were measured
    let usual_s = (times_s.last()? - times_s.first()?) / times_s.len() as f64;
    let seen = times_s.iter().zip(&log.positions_m).filter_map(|(t_s, position)| Some((*t_s, (*position)?)));
    let seen: Vec<(f64, Vector3<f64>)> = seen.collect();
    let steps = seen.array_windows();
    let mut speeds: Vec<f64> =
        steps.map(|[(t, at), (next_t, next)]| (next - at).norm() / (next_t - t).max(usual_s)).collect();
    speeds.sort_by(f64::total_cmp);
    let speed_mps = *speeds.get(((1.0 - SHARE) * speeds.len() as f64) as usize)?;
    (speed_mps > FASTEST_MPS).then(|| BodyTooFast { speed_mps }.into())
}

#[cfg(test)]
mod tests {
    use super::super::log_columns::{LengthUnit, LogColumns};
    use super::super::options::ReferenceLogOptions;
    use super::super::read::parse_reference_log;

    /// The codes of a trajectory over 0.6 m, in this unit, one row in `jump` elsewhere.
    fn codes(per_m: f64, jump: usize, columns: LogColumns) -> Vec<&'static str> {
        let row = |k: usize| {
            let away_m = 0.3 * (k as f64 * 0.02).sin() + if k % jump == jump - 1 { 9.0 } else { 0.0 };
            format!("{} {:.6} 0 {:.6} 0 0 0 1\n", k as f64 / 100.0, per_m * away_m, per_m)
        };
        let text: String = (0..500).map(row).collect();
        let options = ReferenceLogOptions { columns, ..ReferenceLogOptions::default() };
        let file = parse_reference_log(text.as_bytes(), &options).expect("a trajectory");
        file.findings.iter().map(|finding| finding.code().name()).collect()
    }

    #[test]
    fn millimetres_that_are_read_as_metres_are_too_fast_and_jumps_are_not() {
        assert_eq!(codes(1e3, 999, LogColumns::default()), ["body-too-fast"]);
        assert_eq!(codes(1.0, 50, LogColumns::default()), [""; 0]);
        // the remedy
        let millimetres = LogColumns { position_unit: Some(LengthUnit::Mm), ..LogColumns::default() };
        assert_eq!(codes(1e3, 999, millimetres), [""; 0]);
    }
}

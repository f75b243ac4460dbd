//! Holds that pauses between the samples break up.

use crate::error::{Error, NotIdentifiable};
use crate::sensor::Recording;

/// Pauses that are rarer than one in this time leave enough samples between them, s.
const SELDOM_S: f64 = 10.0;

/// Adds the pauses as a reason to an error about too few holds, where the samples pause often.
pub(in crate::estimate) fn with_pauses(error: Error, recording: &Recording) -> Error {
    let Error::NotIdentifiable(mut undetermined) = error else { return error };
    if let Some(stated) = pauses(recording) {
        let NotIdentifiable { groups } = &mut *undetermined;
        groups.iter_mut().for_each(|group| group.reason = format!("{}; {stated}", group.reason));
    }
    Error::NotIdentifiable(undetermined)
}

/// How often and how long the samples pause, in words. `None` if they pause rarely.
fn pauses(recording: &Recording) -> Option<String> {
    let gap_s = recording.gap_s();
    let steps = recording.times_s.array_windows().map(|[one, next]| next - one);
    let (count, longest) = steps
        .filter(|step| *step > gap_s)
        .fold((0, 0.0_f64), |(count, longest), step| (count + 1, longest.max(step)));
    let duration_s = recording.times_s.last()? - recording.times_s.first()?;
    (f64::from(count) * SELDOM_S > duration_s).then(|| {
        format!(
            "the samples pause {count} times for more than {gap_s:.2} s, up to {longest:.2} s, and a pause ends a hold: are samples lost on the way to the file?"
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::error::{Error, NotIdentifiable, UndeterminedGroup};
    use crate::sensor::{ReadingUnit, Recording};

    #[test]
    fn pauses_are_named_where_they_are_many() {
        let stated = |pause: fn(usize) -> f64| {
            let mut t = 0.0;
            let mut time = |k: usize| {
                t += 0.01 + pause(k);
                t
            };
            let times_s: Vec<f64> = (0..6000).map(&mut time).collect();
            let readings = Vec::new();
            let recording = Recording { times_s, readings, axes: 3, unit: ReadingUnit::Counts };
            let group = UndeterminedGroup {
                parameters: Vec::new(),
                free_combinations: 1,
                reason: "3 holds".into(),
                remedy: String::new(),
            };
            let error = Error::NotIdentifiable(Box::new(NotIdentifiable { groups: vec![group] }));
            super::with_pauses(error, &recording).to_string()
        };
        let often = stated(|k| if k % 60 == 7 { 0.2 } else { 0.0 });
        assert!(
            often.contains("3 holds; the samples pause 100 times for more than 0.05 s, up to 0.21 s"),
            "{often}"
        );
        for seldom in [stated(|_| 0.0), stated(|k| if k % 2000 == 7 { 3.0 } else { 0.0 })] {
            assert!(!seldom.contains("pause"), "{seldom}");
        }
    }
}

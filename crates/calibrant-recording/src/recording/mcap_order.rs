//! The order of a bag's messages: that of their log times. In the file they need not be in it, since chunks may overlap and stand in any order.

use super::time_order::late;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::RowsSorted;

/// A message, and when the recorder received it.
pub(crate) struct Logged<M> {
    pub(crate) log_time_ns: u64,
    pub(crate) message: M,
}

/// Messages in the order of log time, and a note where the file has them in another. They stay as they are where their own stamps, `stamp_ns`, say that it
/// is right: the recorder's clock may have been set.
pub(crate) fn by_log_time<M>(
    mut messages: Vec<Logged<M>>,
    stamp_ns: impl Fn(&M) -> i64,
) -> (Vec<M>, Option<Diagnostic>) {
    let late = late(messages.iter().map(|one| one.log_time_ns));
    let mut note = None;
    if late > 0 {
        let mut sorted: Vec<&Logged<M>> = messages.iter().collect();
        sorted.sort_by_key(|one| one.log_time_ns);
        let back = |stamps: Vec<i64>| stamps.array_windows().filter(|[one, next]| next < one).count();
        let in_file = back(messages.iter().map(|one| stamp_ns(&one.message)).collect());
        let by_log = back(sorted.into_iter().map(|one| stamp_ns(&one.message)).collect());
        let is_constant = in_file == 0 && by_log == 0;
        if by_log < in_file || is_constant {
            messages.sort_by_key(|one| one.log_time_ns);
            note = Some(RowsSorted { rows: late, of: messages.len(), by: "their log time".into() }.into());
        }
    }
    (messages.into_iter().map(|one| one.message).collect(), note)
}

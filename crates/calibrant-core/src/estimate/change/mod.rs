//! Does a sensor change within a recording?
//!
//! A knock, a mounting that slips or a sensor that warms up leaves estimates that are a mean of before and after. Their standard deviations come from the scatter, which the change itself makes
//! larger, so that nothing looks wrong; and each part of such a recording is predicted by the rest of it as well as that scatter promises. Only the order of time tells (`score`).

mod left_out_run;
mod score_test;

pub(in crate::estimate) use left_out_run::longest_run;
pub(in crate::estimate) use score_test::Series;

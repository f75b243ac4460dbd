//! Does a sensor change within a recording?
//!
//! After a knock, a slip of the mounting or a warm-up, the estimates are a mean of before and after. Their standard deviations come from the scatter,
//! which the change enlarges. The result then looks consistent, and each part of the recording agrees with its prediction from the rest.
//! Only the order in time shows the change (`score_test`).
//!
//! Pure functions: [`Series`] takes the whitened residuals in order of time and looks for a step, a drift or an episode. [`longest_run`] finds three or more consecutive unused holds or rotations.

mod left_out_run;
mod score_test;

pub(in crate::estimate) use left_out_run::longest_run;
pub(in crate::estimate) use score_test::Series;

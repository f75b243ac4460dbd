//! The sheet of a design: verdict, predicted standard deviations, motion, search.

mod criterion;
mod limits;
mod motions;
mod predicted_sd;
mod sections;
pub(super) mod starts;
mod verdict;

pub(super) use criterion::above;
pub use criterion::gap_in_words;
pub(super) use criterion::{criterion_explained, criterion_in_words, criterion_with_formula};
pub(super) use limits::axes;
#[cfg(feature = "study")]
pub(super) use limits::{limit_table, uses};
#[cfg(feature = "study")]
pub(super) use motions::motion_figures;
pub(super) use motions::{confidence_section, motion_section};
pub(super) use predicted_sd::{promised_table, times};
pub use sections::design_sheet;
pub(super) use starts::{ended, status};
pub(super) use verdict::{broken_limit, undetermined_items};

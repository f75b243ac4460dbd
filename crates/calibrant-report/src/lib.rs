//! Results for people: each is one [`Sheet`], which is printed as text or as an HTML page; no mathematics.
//!
//! A sheet is a verdict and sections of tables, sentences and figures. Cells of tables know their digits ([`number_format`]). Figures are data (`figure`),
//! and are drawn when a page is printed.

mod batch;
mod calibration;
mod comparison;
mod contents;
mod design;
mod evaluation;
mod figure;
mod html;
mod limits;
mod machine;
mod noise;
mod poses;
mod report_context;
mod sheet;
#[cfg(feature = "study")]
mod study;
mod sweep;
mod validation;

pub use calibrant_core::number_format;

#[cfg(test)]
mod tests;

pub use batch::{Batch, BatchParameter, BatchSensor, batch_report};
pub use calibration::calibration_sheet;
pub use comparison::comparison_sheet;
pub use design::design_report;
pub use evaluation::evaluation_report;
pub use machine::machine_sheet;
pub use noise::noise_sheet;
pub use poses::{design_in_words, evaluation_in_words, pose_evaluation_report, pose_in_words, pose_report};
pub use report_context::About;
pub use sheet::{
    Cell, Column, Digits, Grade, Section, Sheet, SheetVerdict, Shown, Table, paragraph, wrapped,
};
#[cfg(feature = "study")]
pub use study::study_report;
pub use sweep::sweep_report;
pub use validation::validation_sentences;

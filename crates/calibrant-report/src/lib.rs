//! Results for people: each is one [`Sheet`], which is printed as text or as an HTML page; no mathematics.
//!
//! A sheet is a verdict and sections of tables, sentences and figures. Cells of tables know their digits ([`number_format`]). Figures are data (`figure`),
//! and are drawn when a page is printed.

mod batch;
mod budget;
mod calibration;
mod campaign;
mod campaign_fit;
mod cited;
mod comparison;
mod design;
mod evaluation;
mod figure;
mod gravity;
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
mod timeline;
mod trajectory;
mod validation;

pub use calibrant_core::number_format;

#[cfg(test)]
mod tests;

pub use batch::{Batch, BatchParameter, BatchSensor, batch_sheet};
pub use calibration::calibration_sheet;
pub use campaign::{campaign_sheet, campaign_study_sheet, campaign_sweep_sheet, usual_name};
pub use campaign_fit::campaign_fit_sheet;
pub use comparison::comparison_sheet;
pub use design::{design_sheet, gap_in_words};
pub use evaluation::evaluation_sheet;
pub use figure::FigureFiles;
pub use machine::machine_sheet;
pub use noise::noise_sheet;
pub use poses::{pose_evaluation_sheet, pose_in_words, pose_sheet};
pub use report_context::About;
pub use sheet::{
    Cell, Column, Digits, Grade, Section, Sheet, SheetVerdict, Shown, Table, paragraph, wrapped,
};
#[cfg(feature = "study")]
pub use study::study_sheet;
pub use sweep::sweep_sheet;
pub use timeline::timeline_section;
pub use trajectory::{trajectory_evaluation_sheet, trajectory_sheet, trajectory_sweep_sheet};
pub use validation::validation_sentences;

//! A result for people, once: a verdict, sections with tables, sentences and figures. Two printers show it.
//!
//! A [`Sheet`] is data. [`Sheet::text`] prints it for a terminal of some width, [`Sheet::html`] as a page. What is too long for a terminal, such as a
//! row for each hold, and what explains a number is marked with [`Shown::OnPage`]. Figures are drawn when a page is printed, and never for a terminal.

mod cell;
mod document;
mod html;
mod section;
mod table;
mod text;

pub use cell::{Cell, Digits};
pub use document::{Grade, Sheet, SheetVerdict};
pub use section::Section;
pub(crate) use table::explained;
pub use table::{Column, Shown, Table};
pub use text::{paragraph, wrapped};
